//! Fields of all forms, sections of a deck, INCLUDE, faults of fields.

use super::*;

/// The same cube in every form has the same nodes and elements.
#[test]
fn fields_of_all_forms_are_the_same_model() {
    let expected = deck(CUBE);
    assert_eq!(expected.nodes.len(), 8);
    assert_eq!(expected.nodes[6].position, [1.0; 3]);
    let fixed = |text: &str| {
        let line = |line: &str| line.split(',').map(|field| format!("{field:<8}")).collect::<String>();
        text.lines().map(line).collect::<Vec<_>>().join("\n")
    };
    let large = |text: &str| {
        let line = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            let row = |of: &[&str]| of.iter().map(|field| format!("{field:<16}")).collect::<String>();
            let (first, second) = fields[1..].split_at(4.min(fields.len() - 1));
            format!("{:<8}{:<64}*\n*       {}", format!("{}*", fields[0]), row(first), row(second))
        };
        text.lines().map(line).collect::<Vec<_>>().join("\n")
    };
    let forms = [
        fixed(CUBE),
        fixed(CUBE).to_lowercase(),
        fixed(CUBE).replace('\n', "\r\n"),
        CUBE.replace("\n,7", "\n$ between lines of a card: Grüße\n\n+,7"),
        fixed(CUBE).replace("        7       8", "+       7       8       $ and behind them"),
        CUBE.replace(',', "\t").replace("\n\t", "\n+\t"),
        large(CUBE),
        format!("SOL 103\nCEND\nTITLE = a cube\nBEGIN BULK\n{CUBE}ENDDATA\nGRID,9,,x\n"),
    ];
    for text in forms {
        let found = deck(&text);
        let nodes =
            |deck: &Deck| deck.nodes.iter().map(|node| (node.number, node.position)).collect::<Vec<_>>();
        assert_eq!(nodes(&found), nodes(&expected), "{text}");
        assert_eq!(found.elements[0].nodes, expected.elements[0].nodes, "{text}");
        assert_eq!(found.materials, expected.materials, "{text}");
    }
    // Latin-1 in a comment.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deck.nas");
    std::fs::write(&path, [b"$ Gr\xfc\xdfe\n", CUBE.as_bytes()].concat()).unwrap();
    assert_eq!(read(&path, Some(Format::Nastran)).unwrap().nodes.len(), 8);
}

/// Fields that fill their columns touch each other; a label may touch the last field.
#[test]
fn fields_may_touch() {
    let found = deck(
        "GRID     1000145        121.6843309.5861-228.087                        \nGRID    12345678       012.345671.5-3   -1.5+2\n",
    );
    assert_eq!(found.nodes[0].position, [121.6843, 309.5861, -228.087]);
    assert_eq!((found.nodes[1].number, found.nodes[1].position), (12345678, [12.34567, 1.5e-3, -150.0]));
    let text = "GRID           1       1  25.000   0.000   0.000       1\n\
        CORD2C  1               0.0     0.0     0.0     -1.0    0.0     0.0     +MOR1001\n+MOR10010.0     0.0     1.0\n";
    // The third axis is −x, the first one z.
    let found = deck(text);
    assert!((0..3).all(|k| close(found.nodes[0].position[k], [0.0, 0.0, 25.0][k])));
}

#[test]
fn files_are_included_over_lines_and_folders() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("parts")).unwrap();
    std::fs::write(
        at("main.bdf"),
        "CEND\nBEGIN BULK\nINCLUDE 'parts/\n  cube.bdf'\ninclude \"main.bdf\"\nENDDATA\n",
    )
    .unwrap();
    std::fs::write(
        at("parts/cube.bdf"),
        CUBE.replace("MAT1,5,2.1+11,,.3,7850.", "INCLUDE material.inc $ here\nInclude 'last.bdf'"),
    )
    .unwrap();
    std::fs::write(at("parts/material.inc"), "MAT1,5,2.1+11,,.3,7850.\n").unwrap();
    std::fs::write(at("last.bdf"), "GRID,9\n").unwrap();
    let found = read(&at("main.bdf"), None).unwrap();
    assert_eq!((found.nodes.len(), found.materials.len(), found.files.len()), (9, 1, 4));
    assert_eq!(found.words(found.nodes[8].place), format!("{}:1", at("last.bdf").display()));
    assert!(notes(&found, Weight::Nothing, "INCLUDE", "read once"));
    std::fs::write(at("main.bdf"), "GRID,1\nINCLUDE 'none.bdf'\n").unwrap();
    let fault = read(&at("main.bdf"), None).unwrap_err().to_string();
    assert!(fault.contains("main.bdf:2") && fault.contains("none.bdf\": no file there"), "{fault}");
}

#[test]
fn cards_repeat_those_before_them() {
    let found = deck("GRID,1,,0.,1.5,-2.\n=,*(2),=,*(.5),==\n=(3)\nGRID,100,,9.,9.,9.\n=,*1,,8.,=,*-1.\n");
    assert_eq!(found.nodes.iter().map(|node| node.number).collect::<Vec<_>>(), [1, 3, 5, 7, 9, 100, 101]);
    assert_eq!(found.nodes[4].position, [2.0, 1.5, -2.0]);
    assert_eq!(found.nodes[6].position, [8.0, 9.0, 8.0]);
    let fault = faults("GRID,1\n=,*1,==\n=(999999999)\n");
    assert!(fault.contains("deck.bdf:3") && fault.contains("100000"), "{fault}");
}

/// Every fault at once, with its line.
#[test]
fn faults_have_their_lines() {
    let text = "GRID,1,,x,0.,1e999\nGRID,-2\nGRID\nCORD2R,1,,0.,0.,0.,0.,0.,1.\nGRID,3,7\n12,3\nCTRIA3,5,1,1,2\nSPC1,1,7,1\nSPC1,1,1,3,THRU\n";
    let fault = faults(text);
    for (line, words) in [
        (1, "`X` in field 4 of GRID"),
        (1, "`1E999` in field 6 of GRID"),
        (2, "`-2` in field 2 of GRID"),
        (3, "GRID without field 2"),
        (5, "coordinate system 7, which is not there"),
        (6, "`12` in the first field"),
        (7, "CTRIA3 without field 6"),
        (8, "`7` in field 3 of SPC1"),
        (9, "THRU of SPC1"),
    ] {
        assert!(fault.contains(words) && fault.contains(&format!("deck.bdf:{line}")), "{words}\n{fault}");
    }
}

#[test]
fn the_same_card_twice_is_noted_and_another_one_is_a_fault() {
    let found = deck("GRID,1,,1.,0.,0.\nGRID    1               1.0     .0      0.\n");
    assert_eq!(found.nodes.len(), 1);
    assert!(notes(&found, Weight::Nothing, "GRID", "twice"));
    let fault = faults("GRID,1,,1.,0.,0.\nGRID,1,,2.,0.,0.\n");
    assert!(
        fault.contains("deck.bdf:2") && fault.contains("deck.bdf:1") && fault.contains("GRID 1"),
        "{fault}"
    );
}

#[test]
fn what_is_missing_is_a_fault() {
    let fault = faults(&CUBE.replace("GRID,7,,1.,1.,1.\n", ""));
    assert!(fault.contains("deck.bdf:8") && fault.contains("grid point 7 of CHEXA"), "{fault}");
    let fault = faults(&CUBE.replace("MAT1,5", "MAT1,6"));
    assert!(fault.contains("material 5 of PSOLID_3"), "{fault}");
    let fault = faults(&CUBE.replace("PSOLID,3", "PSOLID,4"));
    assert!(fault.contains("CHEXA of property 3"), "{fault}");
    let fault = faults("CORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n");
    assert!(fault.contains("given in itself"), "{fault}");
    assert!(faults("SOL 103\nCEND\nSPC = 1\n").contains("without BEGIN BULK"));
    assert!(faults("$TITLE\n-CONT-   1.0\n").contains("punch file of results"));
}

#[test]
fn what_is_not_read_is_noted() {
    let found = deck(&format!(
        "{CUBE}DMIG,K2GG,0,6,1\nCSHEAR,90,9,1,2,3,4\nPSHEAR,9,5,.1\nTEMPD,1,20.\nXYZ,1\nPARAM,POST,-1\nPARAM,SHIFT,7\n"
    ));
    for (weight, what) in [
        (Weight::Matters, "DMIG"),
        (Weight::Matters, "CSHEAR"),
        (Weight::Matters, "PSHEAR"),
        (Weight::Nothing, "TEMPD"),
        (Weight::Perhaps, "XYZ"),
        (Weight::Nothing, "PARAM POST"),
        (Weight::Perhaps, "PARAM SHIFT"),
    ] {
        assert!(notes(&found, weight, what, ""), "{what}");
    }
    let found = deck(&CUBE.replace("PSOLID,3,5", "PSOLID,3,5,,,,,,9"));
    assert!(notes(&found, Weight::Perhaps, "PSOLID", "field 9 is not read"));
}
