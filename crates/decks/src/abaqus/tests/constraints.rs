//! Supports, frames, equations, ties, couplings.

use super::*;
use crate::deck::{CouplingKind, Frame};
use stridor_base::bounds::{Origin::*, within};

#[test]
fn supports_are_named_and_numbered() {
    let deck = bricks(
        "*NSET, NSET=A\n1, 2\n*NSET, NSET=B\n3\n*BOUNDARY\nA, ENCASTRE\nB, 1, 3\n4, 2\n5, 3, , 0\n6, 1, 1, 0.\n6, 3, 3, 0.\n*BOUNDARY\nB, xsymm\n7, PINNED\n8, 11, 11, 20.\n9, 2, 2, 0.5\n",
    );
    let supports: Vec<_> = deck
        .supports
        .iter()
        .map(|support| (support.name.as_deref(), numbers(&deck, &support.nodes), support.held.map(u8::from)))
        .collect();
    let expected = [
        (Some("A"), vec![1, 2], [1, 1, 1, 1, 1, 1]),
        (Some("B"), vec![3], [1, 1, 1, 0, 0, 0]),
        (None, vec![4], [0, 1, 0, 0, 0, 0]),
        (None, vec![5], [0, 0, 1, 0, 0, 0]),
        (None, vec![6], [1, 0, 1, 0, 0, 0]),
        (Some("B"), vec![3], [1, 0, 0, 0, 1, 1]),
        (None, vec![7], [1, 1, 1, 0, 0, 0]),
        (None, vec![9], [0, 1, 0, 0, 0, 0]),
    ];
    assert_eq!(supports, expected);
    assert_eq!(notes(&deck), [(Weight::Perhaps, "*BOUNDARY", 32), (Weight::Nothing, "*BOUNDARY", 31)]);
    fault(&format!("{BRICKS}*BOUNDARY\n1, FREE\n"), 18, "`FREE, `");
    fault(&format!("{BRICKS}*BOUNDARY\n1, 3, 2\n"), 18, "from 3 to 2");
    fault(&format!("{BRICKS}*BOUNDARY\n99, 1\n"), 18, "`99`");
}

/// *TRANSFORM may stand below what uses it. x' along y, y' along −x; and radial, tangential, axial about z.
#[test]
fn frames_turn_supports_equations_and_forces() {
    let deck = bricks(
        "*BOUNDARY\n2, 1\n8, 2\n*EQUATION\n2\n2, 2, 1., 1, 3, -1.\n*CLOAD\n2, 1, 5.\n8, 2, 7.\n3, 1, 4.\n*TRANSFORM, NSET=T\n0., 3., 0., -1., 0., 0.\n*NSET, NSET=T\n2\n*TRANSFORM, TYPE=C, NSET=C\n0., 0., 0., 0., 0., 1.\n*NSET, NSET=C\n8, 3\n",
    );
    assert_eq!(deck.supports[0].frame, Frame::Turned([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]));
    assert_eq!(deck.supports[1].frame, Frame::Cylindrical([[0.0; 3], [0.0, 0.0, 1.0]]));
    assert_eq!(deck.equations[0].terms, [(1, 0, -1.0), (0, 2, -1.0)]);
    // Node 8 stands on the y axis: tangential is −x. Node 3 at 45°.
    let half = 0.5_f64.sqrt();
    for (load, expected) in
        deck.loads.iter().zip([[0.0, 5.0, 0.0], [-7.0, 0.0, 0.0], [4.0 * half, 4.0 * half, 0.0]])
    {
        let crate::deck::LoadOn::Nodes { force, .. } = &load.on else { panic!() };
        (0..3).for_each(|k| assert!(within((force[k] - expected[k]).abs(), 1e-13, RoundOff)));
    }
    let axis = bricks("*TRANSFORM, NSET=ALL, TYPE=C\n0,0,0,0,0,1\n");
    assert_eq!(notes(&axis), [(Weight::Perhaps, "*TRANSFORM, TYPE=C", 17)]);
    let sphere = bricks("*TRANSFORM, NSET=ALL, TYPE=S\n0,0,0,0,0,1\n*TRANSFORM, NSET=ALL\n1,0,0,2,0,0\n");
    assert_eq!(notes(&sphere), [(Weight::Matters, "*TRANSFORM", 17)]);
}

/// Terms over several lines, sets that run alike in the order of the numbers, or as they stand when UNSORTED.
#[test]
fn equations_go_over_lines_and_sets() {
    let sets = "*NSET, NSET=A\n2, 1\n*NSET, NSET=B, UNSORTED\n8, 7\n";
    let deck = bricks(&format!(
        "{sets}*EQUATION\n5\n1, 1, 1., 2, 2, 2., 3, 3, 3., 4, 1, 4.,\n5, 2, 5.\n2\nA, 1, 1., B, 1, -1.\n3\nA, 3, 1.,\n9, 3, 2., 10, 3, 3.\n"
    ));
    let terms: Vec<_> = deck.equations.iter().map(|equation| equation.terms.clone()).collect();
    assert_eq!(terms[0], [(0, 0, 1.0), (1, 1, 2.0), (2, 2, 3.0), (3, 0, 4.0), (4, 1, 5.0)]);
    assert_eq!(terms[1..3], [vec![(0, 0, 1.0), (7, 0, -1.0)], vec![(1, 0, 1.0), (6, 0, -1.0)]]);
    assert_eq!(
        terms[3..],
        [vec![(0, 2, 1.0), (8, 2, 2.0), (9, 2, 3.0)], vec![(1, 2, 1.0), (8, 2, 2.0), (9, 2, 3.0)]]
    );
    assert_eq!(notes(&deck), []);
    fault(&format!("{BRICKS}*EQUATION\n3\n1, 1, 1., 2, 1, 1.\n"), 18, "2 terms of an equation of 3");
    fault(&format!("{BRICKS}*EQUATION\n1\n1, 1, 1., 2, 1, 1.\n"), 18, "2 terms of an equation of 1");
    fault(&format!("{BRICKS}{sets}*EQUATION\n2\nA, 1, 1., ALL, 1, 1.\n"), 22, "different sizes");
    fault(&format!("{BRICKS}*EQUATION\n2\n1, x, 1., 2, 1, 1.\n"), 19, "`x`");
}

#[test]
fn mpcs_are_rigid_or_equations() {
    let deck = bricks(
        "*NSET, NSET=A\n1, 2\n*NODE\n20, 0., 0., 0.\n*MPC\nBEAM, A, 9\nPIN, 3, 4\nTIE, 1, 20\nTIE, 5, 6\nPLANE, 1, 2\nLINK, 1, 2\n",
    );
    let couplings: Vec<_> = deck
        .couplings
        .iter()
        .map(|coupling| {
            (numbers(&deck, &coupling.nodes), deck.nodes[coupling.reference].number, coupling.kind)
        })
        .collect();
    assert_eq!(couplings, [(vec![1, 2], 9, CouplingKind::Rigid), (vec![1], 20, CouplingKind::Rigid)]);
    assert_eq!(deck.equations.len(), 7);
    // Along the line between the nodes.
    assert!(deck.equations[6].terms.iter().all(|(_, dof, _)| *dof == deck.equations[6].terms[0].1));
    assert_eq!(deck.equations[2].terms, [(2, 2, 1.0), (3, 2, -1.0)]);
    assert_eq!(notes(&deck), [(Weight::Matters, "*MPC, PLANE", 26), (Weight::Matters, "*MPC, TIE", 25)]);
}

#[test]
fn ties_are_of_two_surfaces_and_cyclic_ones_are_named() {
    let surfaces = "*SURFACE, NAME=Low\n1, S1\n*SURFACE, NAME=Up\n2, S2\n";
    let deck = bricks(&format!("{surfaces}*TIE, NAME=T, POSITION TOLERANCE=0.5, ADJUST=NO\nlow, \"up\"\n"));
    let tie = &deck.ties[0];
    assert_eq!(
        (tie.name.as_str(), tie.slave.as_str(), tie.master.as_str(), tie.within),
        ("T", "Low", "Up", Some(0.5))
    );
    assert_eq!(notes(&deck), []);
    let cyclic =
        bricks(&format!("{surfaces}*TIE, NAME=T, CYCLIC SYMMETRY\nlow, up\n*CYCLIC SYMMETRY MODEL, N=8\n"));
    assert!(cyclic.ties.is_empty());
    assert_eq!(notes(&cyclic).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>(), [Weight::Matters; 2]);
    fault(&format!("{BRICKS}{surfaces}*TIE, NAME=T\nlow, above\n"), 22, "`above`");
}

#[test]
fn couplings_and_rigid_bodies_follow_a_node() {
    let top = "*NODE\n20, .5, .5, 3.\n*NSET, NSET=REF\n20\n*SURFACE, NAME=Top\n2, S2\n*SURFACE, NAME=TopNodes, TYPE=NODE\n9\n10\n";
    let deck = bricks(&format!(
        "{top}*COUPLING, CONSTRAINT NAME=C1, REF NODE=20, SURFACE=Top\n*KINEMATIC\n1, 6\n*COUPLING, CONSTRAINT NAME=C2, REF NODE=REF, SURFACE=TopNodes\n*DISTRIBUTING\n*KINEMATIC COUPLING, REF NODE=20\nALL, 1, 6\n\
         *ELEMENT, TYPE=DCOUP3D, ELSET=D\n30, 20\n*DISTRIBUTING COUPLING, ELSET=D\n1, 1.\n2, 1.\n*RIGID BODY, REF NODE=20, ELSET=EALL\n*RIGID BODY, REF NODE=20, NSET=ALL\n"
    ));
    let couplings: Vec<_> = deck
        .couplings
        .iter()
        .map(|coupling| (coupling.name.as_str(), numbers(&deck, &coupling.nodes), coupling.kind))
        .collect();
    let all: Vec<u64> = (1..=12).collect();
    let expected = [
        ("C1", vec![9, 10, 11, 12], CouplingKind::Rigid),
        ("C2", vec![9, 10], CouplingKind::Averaging),
        ("", all.clone(), CouplingKind::Rigid),
        ("", vec![1, 2], CouplingKind::Averaging),
        ("", all.clone(), CouplingKind::Rigid),
        ("", all, CouplingKind::Rigid),
    ];
    assert_eq!(couplings, expected);
    assert!(deck.couplings.iter().all(|coupling| coupling.reference == 12));
    assert_eq!(notes(&deck), []);
    let some = bricks(&format!(
        "{top}*COUPLING, REF NODE=20, SURFACE=Top\n*KINEMATIC\n1, 2\n*KINEMATIC COUPLING, REF NODE=20\nALL, 3\n*RIGID BODY, REF NODE=20, NSET=ALL, ROT NODE=9\n"
    ));
    assert_eq!(notes(&some).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>(), [Weight::Matters; 3]);
    fault(&format!("{BRICKS}{top}*COUPLING, REF NODE=ALL, SURFACE=Top\n"), 26, "a set of 12 nodes");
    fault(&format!("{BRICKS}{top}*COUPLING, REF NODE=20, SURFACE=Top\n*KINEMATIC\n0, 3\n"), 28, "`0, 3`");
}
