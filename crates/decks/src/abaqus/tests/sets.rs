//! Sets and surfaces.

use super::*;
use crate::deck::ShellFace;

#[test]
fn sets_hold_numbers_ranges_sets_and_nodes_of_elements() {
    let deck = bricks(
        "*NSET, NSET=A\n3, 1,\n2\n*Nset, nset = \"b 1\"\na, 7\n*NSET, NSET=GEN, GENERATE\n2, 12, 5\n4,4\n1, 2\n\
         *NSET, NSET=OF, ELSET=TOP\n*ELSET, ELSET=TOP\n2\n*NSET, NSET=of2, ELSET=top\n*ELSET, ELSET=EG, GENERATE\n1, 18446744073709551615, 1\n*ELSET, ELSET=NEST\nEG, TOP\n*NSET, NSET=A\n9\n"
            .replace("*NSET, NSET=OF, ELSET=TOP\n", "")
            .as_str(),
    );
    assert_eq!(set(&deck, "a"), [1, 2, 3, 9]);
    assert_eq!(set(&deck, "B 1"), [1, 2, 3, 7]);
    assert_eq!(set(&deck, "gen"), [1, 2, 4, 7, 12]);
    assert_eq!(set(&deck, "OF2"), [5, 6, 7, 8, 9, 10, 11, 12]);
    assert_eq!(elements(&deck, "EG"), [1, 2]);
    assert_eq!(elements(&deck, "nest"), [1, 2]);
    assert_eq!(set(&deck, "ALL").len(), 12);
    assert_eq!(notes(&deck), []);
}

/// One name for a set of nodes, one of elements, a surface and a type.
#[test]
fn sets_of_different_things_share_names() {
    let deck = bricks(
        "*NSET, NSET=C3D8\n1\n*ELSET, ELSET=C3D8, INTERNAL\n2\n*SURFACE, NAME=C3D8\nC3D8, S2\n*BOUNDARY\nC3D8, 1\n",
    );
    assert_eq!((set(&deck, "c3d8"), elements(&deck, "C3D8")), (vec![1], vec![2]));
    assert_eq!(faces(&deck, "C3D8"), [[9, 10, 11, 12]]);
    assert_eq!(numbers(&deck, &deck.supports[0].nodes), [1]);
    assert!(deck.element_set("C3D8").unwrap().internal && !deck.node_set("C3D8").unwrap().internal);
}

#[test]
fn members_that_are_missing_are_noted_and_sets_that_are_missing_are_faults() {
    let deck = bricks("*NSET, NSET=A\n1, 99\n*ELSET, ELSET=B, GENERATE\n5, 9\n");
    assert_eq!(set(&deck, "A"), [1]);
    assert_eq!(notes(&deck), [(Weight::Perhaps, "*ELSET", 20), (Weight::Perhaps, "*NSET", 18)]);
    fault(&format!("{BRICKS}*NSET, NSET=A\nNONE\n"), 18, "`NONE`");
    fault(&format!("{BRICKS}*NSET, NSET=A, GENERATE\n5, 1\n"), 18, "a range from 5 to 1");
    fault(&format!("{BRICKS}*NSET, NSET=A, GENERATE\n1, 5, 0\n"), 18, "`0`");
}

/// Faces by their numbers: those of the bottom, the top and the four sides; then the free ones.
#[test]
fn faces_of_surfaces_are_those_of_the_manual() {
    let corners: [[u64; 4]; 6] =
        [[1, 2, 3, 4], [5, 6, 7, 8], [1, 2, 5, 6], [2, 3, 6, 7], [3, 4, 7, 8], [1, 4, 5, 8]];
    for (k, corners) in corners.iter().enumerate() {
        let deck = bricks(&format!("*Surface, type=ELEMENT, name=S\n 1, s{}\n", k + 1));
        assert_eq!(faces(&deck, "S"), [corners]);
    }
    let deck = bricks(
        "*ELSET, ELSET=LOW\n1\n*SURFACE, NAME=FREE\nLOW,\n*SURFACE, NAME=OTHER\n2\n*SURFACE, NAME=N, TYPE=NODE\nALL\n3, 1.\n*SURFACE, NAME=BOTH, COMBINE=UNION\nFREE, OTHER\n",
    );
    let free = faces(&deck, "FREE");
    assert_eq!(free.len(), 5);
    assert!(!free.contains(&vec![5, 6, 7, 8]));
    assert_eq!(faces(&deck, "OTHER").len(), 5);
    assert_eq!(faces(&deck, "BOTH").len(), 10);
    assert_eq!(deck.surface("n").unwrap().nodes.len(), 12);
    assert_eq!(notes(&deck), []);
}

#[test]
fn shells_have_two_faces() {
    let shells = BRICKS.replace("C3D8", "S8R");
    let of = |face: &str| {
        deck(&format!("{shells}*SURFACE, NAME=S\nEALL, {face}\n")).surface("S").unwrap().shells.clone()
    };
    assert_eq!(of("SPOS"), [(0, ShellFace::Positive), (1, ShellFace::Positive)]);
    assert_eq!(of("SNEG"), [(0, ShellFace::Negative), (1, ShellFace::Negative)]);
    let free = deck(&format!("{shells}*SURFACE, NAME=S\n1\n*SURFACE, NAME=EDGE\n2, E1\n"));
    assert_eq!(free.surface("S").unwrap().shells, [(0, ShellFace::Positive)]);
    assert_eq!(
        notes(&free).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>(),
        [Weight::Matters, Weight::Perhaps]
    );
}

#[test]
fn surfaces_that_are_not_read_are_named() {
    let deck = bricks(
        "*SURFACE, NAME=A\n1, S1\n*SURFACE, NAME=B\n2, S2\n*SURFACE, NAME=C, COMBINE=DIFFERENCE\nA, B\n*SURFACE, NAME=D, TYPE=REVOLUTION\n0,0,0,0,0,1\n",
    );
    assert_eq!(
        notes(&deck).iter().map(|(weight, _, line)| (*weight, *line)).collect::<Vec<_>>(),
        [(Weight::Matters, 21), (Weight::Matters, 23)]
    );
    assert!(deck.surface("C").unwrap().faces.is_empty());
    fault(&format!("{BRICKS}*SURFACE, NAME=A\n1, S7\n"), 18, "face S7");
    fault(&format!("{BRICKS}*SURFACE, NAME=A\n1, S1\n*SURFACE, NAME=A\n1, S2\n"), 19, "a second *SURFACE");
    // CalculiX: one of nodes and one of faces.
    let both = bricks("*SURFACE, NAME=A, TYPE=NODE\nALL\n*SURFACE, NAME=a\n1, S2\n");
    let surface = both.surface("A").unwrap();
    assert_eq!((surface.faces.len(), surface.nodes.len()), (1, 12));
    assert_eq!(notes(&both), [(Weight::Perhaps, "*SURFACE", 19)]);
}
