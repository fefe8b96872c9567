//! Archives that are damaged, or made to take time and memory.

use super::tests::{BRICK20, cube_nodes, one_element, read, read_bytes, two_cubes};

/// Short lines that stand for many nodes do not take time or memory out of proportion.
#[test]
fn many_selections_of_many_nodes_are_a_fault() {
    let nodes: String = (1..5000).map(|node| format!("N,{node}\n")).collect();
    let (_, faults) = read(&(nodes.clone() + &"NSEL,S,NODE,,1,9999,2\nD,ALL,UX\n".repeat(5000)));
    assert!(faults.contains("fewer of them"), "{faults}");
    let ranges = "CMBLOCK,A,NODE,2\n(2i9)\n        1    -9999\n";
    let blocks: String = (0..5000).map(|k| ranges.replacen('A', &format!("A{k}"), 1)).collect();
    let (_, faults) = read(&(nodes + &blocks));
    assert!(faults.contains("more members in all"), "{faults}");
}

/// Every cut, and every byte made another one, gives a deck or faults.
#[test]
fn nothing_panics_on_damaged_files() {
    let mut texts = vec![
        two_cubes("KEYOPT,2,12,1\n")
            + "SFE,2,6,PRES,0,3.5\nCMBLOCK,A,ELEM,2\n(8i10)\n         1        -2\nCM,B,NODE\nCMOMEGA,A,1,0,0\n",
    ];
    let mut nodes = BRICK20;
    nodes[10] = 0;
    texts.push(format!("ET,1,186\n{}{}", cube_nodes(), one_element(&nodes)));
    texts.push("ETBLOCK,1,1\n(2i9,19a9)\n        1      181        0        2\n       -1\nRLBLOCK,1,1,7,7\n(2i8,6g16.9)\n(7g16.9)\n       1       7  1.0\n  2.0\nSECTYPE,1,SHELL\nSECBLOCK,1\n1,1,0,3\n".into());
    for text in texts {
        for at in 0..text.len() {
            read_bytes(&text.as_bytes()[..at]);
            for byte in [b'9', b'-', b',', b'\n', b' ', 0xff, b'('] {
                let mut bytes = text.clone().into_bytes();
                bytes[at] = byte;
                read_bytes(&bytes);
            }
        }
    }
}
