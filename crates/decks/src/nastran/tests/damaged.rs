//! Decks that are cut off or damaged are faults or decks, and nothing else.

use super::*;

/// One of everything.
const ALL: &str = "\
SOL 110
CEND
SPC = 7
LOAD = 3
SUBCASE 1
 METHOD = 1
 CMETHOD(STRUCTURE) = 2
 BCSET = 5
BEGIN BULK
$HMNAME PROP 3\"disc\"
CORD2C,1,,0.,0.,0.,0.,0.,1.
,1.,0.,0.
CORD1R,2,1,2,4
GRDSET,,,,,,1
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID*   3                               1.              1.
*       0.              0
GRID    4               0.      1.      0.
GRID,5,1,1.,90.,1.,2
=,*1,==
=(2)
SPOINT,90,THRU,95
CHEXA,10,3,1,2,3,4,5,6,+A
+A,7,8
CQUAD4,11,4,1,2,3,4
CBAR,12,6,1,2,0.,0.,1.
CBUSH,13,7,1,2,,,,0
CELAS2,14,1.+3,1,1
CONM2,15,8,2,1.5
,.1,0.,.2
PSOLID,3,5
PSHELL,4,5,.01,5,,5
PBARL,6,5,,BAR
,.1,.2
PBUSH,7,K,1.,2.,3.
MAT1,5,2.1+11,,.3,7850.
MAT9,8,1.,.2,.2,0.,0.,0.,1.
,.2,0.,0.,0.,1.,0.,0.,0.
,.3,0.,0.,.3,0.,.3,2.
SPC1,7,123,1,THRU,8,BY,2
SPC,8,2,3,0.
SPCADD,7,8
MPC,1,1,1,1.,2,1,-1.
RBE2,20,5,123,6,7
RBE3,21,,8,123,1.,123,1,2
,UM,5,1
RBAR,22,1,2,123456
FORCE,3,1,0,2.,1.,0.,0.
PLOAD4,3,10,1.,,,,1,3
LOAD,3,1.,2.,3
RFORCE,3,0,0,2.,0.,0.,1.
BSURFS,1,,,,10,1,2,3
BSURF,2,11
BCTSET,5,1,2,.3
BGSET,6,1,2,.1
EIGRL,1,0.,1000.,10
EIGC,2,HESS,MAX
,,,,,,,12
PARAM,WTMASS,2.
ENDDATA
";

/// A deck, or faults: the reader ends.
fn ends(path: &Path, text: &[u8]) {
    std::fs::write(path, text).unwrap();
    if let Err(error) = read(path, None) {
        assert_eq!(error.exit_code(), 2);
    }
}

#[test]
fn decks_that_are_cut_off_or_damaged_end_in_faults() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.dat");
    std::fs::write(&path, ALL.replace("RBE2,20,5,123", "RBE2,20,5,123456")).unwrap();
    let whole = read(&path, None).unwrap();
    assert_eq!((whole.nodes.len(), whole.elements.len(), whole.contacts.len()), (8, 3, 1));
    let all = ALL.as_bytes();
    for at in 0..all.len() {
        ends(&path, &all[..at]);
        let mut damaged = all.to_vec();
        damaged[at] = b"\n,9*=-$\xff"[at % 8];
        ends(&path, &damaged);
        let mut without = all.to_vec();
        without.remove(at);
        ends(&path, &without);
    }
    // Lines in another order, and the bulk data in fixed fields of any alignment.
    let lines: Vec<&str> = ALL.lines().collect();
    for shift in 1..lines.len() {
        let turned: Vec<&str> = (0..lines.len()).map(|k| lines[(k * shift + shift) % lines.len()]).collect();
        ends(&path, turned.join("\n").as_bytes());
        ends(&path, ALL.replace(',', &" ".repeat(shift % 9)).as_bytes());
    }
}

/// Short lines that ask for much are refused, and none takes a time that grows with the square of the file.
#[test]
fn lists_of_overlapping_ranges_are_bounded() {
    let points: String = (1..=2000).map(|k| format!("GRID,{k}\n")).collect();
    let text = format!("{points}{}", "SPC1,1,1,1,THRU,99999999\n".repeat(2000));
    assert!(faults(&text).contains("ranges of more members"));
    let loops = "CORD2R,1,2\nCORD2R,2,3\nCORD2R,3,1\nCORD1R,4,1,2,3\nGRID,1,4\nGRID,2,4\nGRID,3,4\n";
    assert!(faults(loops).contains("given in itself"));
    let chain: String =
        (1..20000).map(|k| format!("CORD2R,{k},{},0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", k + 1)).collect();
    let found = deck(&format!("{chain}CORD2R,20000,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\nGRID,1,1,0.,0.,0.\n"));
    assert_eq!(found.nodes[0].position, [1.0, 0.0, 0.0]);
}
