//! Small archives of our own, one for each trap of the format.

use crate::deck::*;
use crate::ledger::Weight;
use crate::text::Files;
use std::io::Write;
use stridor_base::bounds::{Origin, within};
use stridor_mesh::CellKind;

/// The deck of a text, and its faults.
pub(super) fn read(text: &str) -> (Deck, String) {
    read_bytes(text.as_bytes())
}

pub(super) fn read_bytes(bytes: &[u8]) -> (Deck, String) {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    let mut files = Files::default();
    match super::read(file.path(), &mut files) {
        Ok(mut deck) => {
            deck.files.clone_from(&files.paths);
            let faults: Vec<String> = files.faults.0.iter().map(ToString::to_string).collect();
            (deck, faults.join("\n"))
        }
        Err(error) => (Deck::default(), error.to_string()),
    }
}

/// A deck without faults.
fn sound(text: &str) -> Deck {
    let (deck, faults) = read(text);
    assert_eq!(faults, "");
    deck
}

fn notes(deck: &Deck, weight: Weight) -> String {
    let rows = deck.ledger.rows().filter(|row| row.weight == weight);
    rows.map(|row| format!("{}: {}\n", row.what, row.why)).collect()
}

/// A line of columns of eight.
fn eights(numbers: &[i64]) -> String {
    numbers.iter().map(|number| format!("{number:8}")).collect::<String>() + "\n"
}

/// Nodes 1 to 8 of a cube of side 2 and 9 to 20 in the middles of its edges, in fixed columns.
pub(super) fn cube_nodes() -> String {
    let corners = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];
    let edges =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    let middles = edges.map(|[a, b]| [0, 1, 2].map(|k| (corners[a][k] + corners[b][k]) / 2));
    let line = |(k, at): (usize, [i32; 3])| {
        let [x, y, z] = at.map(|x| format!("{:20.13E}", f64::from(x)));
        format!("{:8}{:8}{:8}{x}{y}{z}\n", k + 1, 0, 0)
    };
    let nodes: String = corners.into_iter().chain(middles).enumerate().map(line).collect();
    format!("NBLOCK,6,SOLID,20,20\n(3i8,6e20.13)\n{nodes}N,R5.3,LOC,       -1,\n")
}

/// An EBLOCK of one element of type 1.
pub(super) fn one_element(nodes: &[i64]) -> String {
    let mut head = vec![1, 1, 1, 1, 0, 0, 0, 0, nodes.len() as i64, 0, 5];
    head.extend(&nodes[..nodes.len().min(8)]);
    let rest = if nodes.len() > 8 { eights(&nodes[8..]) } else { String::new() };
    format!("EBLOCK,19,SOLID,5,1\n(19i8)\n{}{rest}      -1\n", eights(&head))
}

fn kind_of(routine: u32, nodes: &[i64]) -> (CellKind, Vec<u64>, Deck) {
    let deck = sound(&format!("ET,1,{routine}\n{}{}", cube_nodes(), one_element(nodes)));
    let element = &deck.elements[0];
    (element.kind, element.nodes.iter().map(|node| deck.nodes[*node].number).collect(), deck)
}

pub(super) const BRICK20: [i64; 20] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20];

#[test]
fn an_element_of_twenty_nodes_has_a_second_line() {
    let (kind, nodes, deck) = kind_of(186, &BRICK20);
    assert_eq!((kind, nodes), (CellKind::Hexahedron20, (1..=20).collect()));
    assert_eq!(deck.nodes[6].position, [2.0, 2.0, 2.0]);
    assert_eq!(deck.elements[0].number, 5);
    assert_eq!(deck.type_names, ["SOLID186"]);
    assert!(notes(&deck, Weight::Matters).contains("MATERIAL_1"), "a material without properties is noted");
}

#[test]
fn collapsed_bricks_are_the_kinds_of_fewer_nodes() {
    let wedge = [1, 2, 3, 3, 5, 6, 7, 7, 9, 10, 3, 12, 13, 14, 7, 16, 17, 18, 19, 19];
    assert_eq!(kind_of(186, &wedge).0, CellKind::Wedge15);
    let pyramid = [1, 2, 3, 4, 5, 5, 5, 5, 9, 10, 11, 12, 5, 5, 5, 5, 17, 18, 19, 20];
    assert_eq!(kind_of(95, &pyramid).0, CellKind::Pyramid13);
    assert_eq!(kind_of(185, &[1, 2, 3, 3, 5, 5, 5, 5]).0, CellKind::Tetrahedron4);
    assert_eq!(kind_of(45, &[1, 2, 3, 3, 5, 6, 7, 7]).0, CellKind::Wedge6);
    // A wedge whose fallen edges stand in other places of the brick.
    assert_eq!(kind_of(185, &[1, 1, 3, 4, 5, 5, 7, 8]).0, CellKind::Wedge6);
    // A triangle of a shell repeats its third node.
    assert_eq!(kind_of(181, &[1, 2, 3, 3]).0, CellKind::Triangle3);
    assert_eq!(kind_of(187, &[1, 2, 3, 5, 9, 10, 12, 17, 18, 19]).0, CellKind::Tetrahedron10);
}

#[test]
fn corners_that_form_no_shape_are_a_fault() {
    let text = format!("ET,1,185\n{}{}", cube_nodes(), one_element(&[1, 2, 1, 2, 5, 6, 5, 6]));
    let (_, faults) = read(&text);
    assert!(
        faults.contains(":27:") && faults.contains("element 5") && faults.contains("form a shape"),
        "{faults}"
    );
}

/// An edge without a node in the middle has one of its own that is held half way between the ends.
#[test]
fn missing_nodes_of_edges_are_made_and_held() {
    let mut nodes = BRICK20;
    nodes[8] = 0;
    let (kind, _, deck) = kind_of(186, &nodes);
    assert_eq!((kind, deck.nodes.len()), (CellKind::Hexahedron20, 21));
    let made = deck.elements[0].nodes[8];
    assert_eq!((made, deck.nodes[made].number, deck.nodes[made].position), (20, 21, [1.0, 0.0, 0.0]));
    let terms: Vec<_> = deck.equations.iter().map(|own| own.terms.clone()).collect();
    assert_eq!(terms[1], [(20, 1, 2.0), (0, 1, -1.0), (1, 1, -1.0)]);
    assert_eq!(terms.len(), 3);
    assert!(notes(&deck, Weight::Nothing).contains("held half way"));
    // Without any it is an element of the corners.
    let corners: Vec<i64> = BRICK20.iter().map(|node| if *node > 8 { 0 } else { *node }).collect();
    let (kind, _, deck) = kind_of(186, &corners);
    assert_eq!((kind, deck.nodes.len(), deck.equations.len()), (CellKind::Hexahedron8, 20, 0));
    assert!(notes(&deck, Weight::Perhaps).contains("without nodes in the middles"));
}

#[test]
fn a_second_line_of_zeros_may_be_left_out() {
    let text = "ET,1,186\n".to_string() + &cube_nodes() + "EBLOCK,19,SOLID,6,2\n(19i8)\n";
    let head = [1, 1, 1, 1, 0, 0, 0, 0, 20, 0];
    let line = |number: i64| eights(&[&head[..], &[number], &[1, 2, 3, 4, 5, 6, 7, 8]].concat());
    let deck = sound(&(text + &line(5) + &line(6) + "      -1\n"));
    assert_eq!(deck.elements.len(), 2);
}

#[test]
fn formats_of_blocks_are_followed() {
    // Numbers that touch, blanks at the end left out, three exponent digits, node numbers alone.
    let text = "NBLOCK,6,SOLID,4,4\n(3i9,6e21.13e3)\n        1        0        0 1.0000000000000E+000-2.0000000000000E+000 3.0000000000000E-001\n        \
        2        0        0 1.0000000000000E+000\n        3\n        4        0        0                                                                45.00\nN,R5.3,LOC,-1,\n\
        nblock,3,,1\n(1i9,3e20.9e3)\n        7    1.000000000E+000    2.500000000E-003    0.000000000E+000\n-1\n";
    let deck = sound(text);
    let at: Vec<(u64, [f64; 3])> = deck.nodes.iter().map(|node| (node.number, node.position)).collect();
    assert_eq!(at[..3], [(1, [1.0, -2.0, 0.3]), (2, [1.0, 0.0, 0.0]), (3, [0.0; 3])]);
    assert_eq!(at[4], (7, [1.0, 0.0025, 0.0]));
    let (_, faults) = read("NBLOCK,6,SOLID\n       1       0       0  1.0\n");
    assert!(faults.contains(":1:") && faults.contains("a Fortran format"), "{faults}");
}

#[test]
fn lines_may_end_in_cr_lf_and_commands_in_dollars() {
    let text =
        format!("ET,1,185 $ MAT,1 ! steel\n{}{}", cube_nodes(), one_element(&[1, 2, 3, 4, 5, 6, 7, 8]));
    assert_eq!(sound(&text).elements, sound(&text.replace('\n', "\r\n")).elements);
}

#[test]
fn torn_files_are_a_fault_with_a_line() {
    let text = cube_nodes();
    let (_, faults) = read(&text[..600]);
    assert!(faults.contains(":9:") && faults.contains("7 nodes") && faults.contains("20 nodes"), "{faults}");
    let torn = text.replacen("2.0000000000000E0", "2.00000.0000000E0", 1);
    let (_, faults) = read(&torn);
    assert!(faults.contains(":4:") && faults.contains("expected a number"), "{faults}");
    let (_, faults) = read("ET,1,185\nEBLOCK,19,SOLID,5,1\n(19i8)\n       1       1       1\n");
    assert!(faults.contains(":4:") && faults.contains("an element line of 3 numbers"), "{faults}");
    let (_, faults) = read("CMBLOCK,A,NODE,9\n(8i10)\n         1         2\n");
    assert!(faults.contains("2 numbers"), "{faults}");
}

#[test]
fn numbers_twice_and_what_is_not_there_are_faults() {
    let (deck, faults) = read("N,1,0,0,0\nN,1,0,0,0\nN,2,1,0,0\nN,2,2,0,0\n");
    assert!(
        faults.contains(":4:") && faults.contains("than in line 3") && !faults.contains("node 1"),
        "{faults}"
    );
    assert!(notes(&deck, Weight::Nothing).contains("nodes that stand twice"));
    let all = "N,1,0\nET,1,21\nD,9,UX\nEN,1,7\nCMSEL,S,NONESUCH\nTYPE,3\nEN,2,1\nCMOMEGA,TURNING,1\n";
    let (_, faults) = read(all);
    for (line, word) in [(3, "node 9"), (4, "node 7"), (5, "NONESUCH"), (7, "type 3"), (8, "TURNING")] {
        assert!(faults.contains(&format!(":{line}:")) && faults.contains(word), "{word}: {faults}");
    }
}

#[test]
fn components_have_ranges() {
    let text = cube_nodes()
        + "CMBLOCK,NEAR    ,NODE,       4  ! users node component\n(8i10)\n         3        -6        19       -99\n";
    let deck = sound(&text);
    let numbers: Vec<u64> = deck.node_sets[0].members.iter().map(|node| deck.nodes[*node].number).collect();
    assert_eq!((deck.node_sets[0].name.as_str(), numbers), ("NEAR", vec![3, 4, 5, 6, 19, 20]));
    let (_, faults) = read("N,1\nCMBLOCK,A,NODE,1\n(8i10)\n        -3\n");
    assert!(faults.contains("-3 in component"), "{faults}");
}

#[test]
fn selections_make_components_and_supports() {
    let text = cube_nodes()
        + "NSEL,S,LOC,Z,0\nNSEL,U,NODE,,9,12\nCM,FLOOR,NODE\nALLSEL\nCMSEL,S,FLOOR\nD,ALL,ALL\nNSEL,ALL\nD,5,UX,0,,7,2,UZ\n";
    let deck = sound(&text);
    let floor = &deck.supports.iter().find(|own| own.held == [true; 6]).unwrap();
    assert_eq!((floor.name.as_deref(), &floor.nodes[..]), (Some("FLOOR"), &[0, 1, 2, 3][..]));
    let others = deck.supports.iter().find(|own| own.held != [true; 6]).unwrap();
    assert_eq!((others.held, &others.nodes[..]), ([true, false, true, false, false, false], &[4, 6][..]));
    let deck = sound("N,1\nN,2\nNSEL,S,S,EQV,1,2\nD,ALL,UX,0\n");
    assert!(
        deck.supports.is_empty() && notes(&deck, Weight::Matters).contains("a selection that is not known")
    );
}

/// Supports, forces and equations of a turned node count in its own frame.
#[test]
fn turned_nodes_turn_what_acts_on_them() {
    let deck = sound("N,1,0,0,0,90\nN,2,1,0,0\nD,1,UX,0\nF,1,FX,5\nCE,1,0,1,UY,1,2,UX,-2\nCP,4,UZ,1,2\n");
    let Frame::Turned([x, y, z]) = deck.supports[0].frame else { panic!("{:?}", deck.supports) };
    let near = |a: [f64; 3], b: [f64; 3]| {
        let error = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
        assert!(within(error, 1e-14, Origin::RoundOff), "{a:?} {b:?}");
    };
    near(x, [0.0, 1.0, 0.0]);
    near(y, [-1.0, 0.0, 0.0]);
    near(z, [0.0, 0.0, 1.0]);
    let LoadOn::Nodes { force, .. } = deck.loads[0].on else { panic!() };
    near(force, [0.0, 5.0, 0.0]);
    // uy of the node is −ux of the coordinates.
    let terms: f64 =
        deck.equations[0].terms.iter().filter(|term| (term.0, term.1) == (0, 0)).map(|term| term.2).sum();
    assert!(within((terms + 1.0).abs(), 1e-14, Origin::RoundOff));
    assert_eq!(deck.equations[1].terms, [(1, 2, 1.0), (0, 2, -1.0)]);
}

#[test]
fn archives_write_equations_in_parts() {
    let deck = sound(
        "N,1\nN,2\nCE,R5.0,DEFI,       2,       1,  0.0\nCE,R5.0,NODE,  1,UX  , 1.0 ,  2,UX , -1.0\nCERIG,1,2,ALL\n",
    );
    assert_eq!(deck.equations[0].terms, [(0, 0, 1.0), (1, 0, -1.0)]);
    let coupling = &deck.couplings[0];
    assert_eq!((coupling.reference, &coupling.nodes[..], coupling.kind), (0, &[1][..], CouplingKind::Rigid));
}

#[test]
fn materials_take_the_first_temperature() {
    let text = "MPTEMP,R5.0, 2, 1, 20.0, 300.0\nMPDATA,R5.0, 2,EX  ,       3, 1, 2.100000000E+11, 1.900000000E+11,\nMPDATA,UNBL, 1,NUXY,       3, 1, 0.3\n\
        MP,DENS,3,7850\nMP,BETD,3,1e-6\nMP,DMPR,3,0.01\nALPHAD,2\nMP,KXX,3,60\nTB,BISO,3\nTBDATA,1,2e8\nMP,EX,4,3e9\nMP,EY,4,1e9\nMP,NUXY,4,0.1\nMP,GXY,4,1.5D9\n";
    let deck = sound(text);
    let steel = &deck.materials[0];
    assert_eq!(steel.name, "MATERIAL_3");
    assert_eq!(steel.elastic, Some(Elastic::Isotropic { youngs_modulus: 2.1e11, poissons_ratio: 0.3 }));
    assert_eq!((steel.density, steel.rayleigh, steel.loss_factor), (Some(7850.0), [2.0, 1e-6], 0.02));
    let Some(Elastic::Orthotropic { youngs_moduli, poissons_ratios, shear_moduli }) =
        deck.materials[1].elastic
    else {
        panic!()
    };
    assert_eq!((youngs_moduli, shear_moduli[0]), ([3e9, 1e9, 3e9], 1.5e9));
    // NUXY is the minor ratio.
    assert!(within((poissons_ratios[0] - 0.3).abs(), 1e-15, Origin::RoundOff));
    assert!(notes(&deck, Weight::Perhaps).contains("MPDATA EX of material 3"));
    let nothing = notes(&deck, Weight::Nothing);
    assert!(
        nothing.contains("MP KXX") && nothing.contains("TB BISO") && nothing.contains("TBDATA"),
        "{nothing}"
    );
}

#[test]
fn sections_masses_and_springs_are_read() {
    let text = cube_nodes()
        + "ET,1,181\nET,2,188\nET,3,21\nKEYOPT,3,3,2\nET,4,14\nKEYOPT,4,2,3\nET,5,180\nMP,EX,1,1\n\
        SECTYPE,1,SHELL,,plate\nSECBLOCK,2\n 0.5, 1, 0.0, 3\n 0.25, 1, 0.0, 3\nSECTYPE,2,BEAM,RECT\nSECDATA,2,4\nSECTYPE,3,LINK\nSECDATA,7\n\
        RLBLOCK,1,9,8,7\n(2i8,6g16.9)\n(7g16.9)\n       9       8  2.5             0.0             0.0             0.0             0.0             0.0\n  8.0             9.0\n\
        R,4,100,0.5\nTYPE,1\nSECNUM,1\nEN,1,1,2,3,4\nTYPE,2\nSECNUM,2\nEN,2,1,5,2\nTYPE,3\nREAL,9\nEN,3,7\nTYPE,4\nREAL,4\nEN,4,7,8\nTYPE,5\nSECNUM,3\nEN,5,1,2\n";
    let deck = sound(&text);
    let shapes: Vec<&SectionShape> = deck.sections.iter().map(|section| &section.shape).collect();
    assert_eq!(shapes[0], &SectionShape::Shell { thickness: 0.75 });
    assert_eq!(shapes[2], &SectionShape::Truss { area: 7.0 });
    let SectionShape::Beam { profile: Profile::General { area, second_moments, .. }, first_axis } = shapes[1]
    else {
        panic!()
    };
    // 2 along y and 4 along z, which points to the third node: y is z × x.
    assert_eq!((*area, *second_moments), (8.0, [4.0 * 8.0 / 12.0, 2.0 * 64.0 / 12.0]));
    assert_eq!(*first_axis, Some([0.0, -1.0, 0.0]));
    assert_eq!((deck.masses[0].mass, &deck.masses[0].nodes[..]), (2.5, &[6][..]));
    let spring = &deck.springs[0];
    assert_eq!(
        (spring.stiffness, spring.damping, spring.dof, &spring.ends[..]),
        (100.0, 0.5, Some(2), &[(6, Some(7))][..])
    );
}

/// Two cubes that touch, the upper one with nodes 11 to 18, contact elements on the lower and targets on the upper.
pub(super) fn two_cubes(options: &str) -> String {
    let mut text = "ET,1,185\nET,2,173\nET,3,170\nMP,MU,2,0.4\nMP,EX,1,1\nR,7,,,-1E9\n".to_string() + options;
    for (base, z) in [(0, 0), (10, 2)] {
        for (k, [x, y, up]) in
            [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]]
                .into_iter()
                .enumerate()
        {
            text += &format!("N,{},{x},{y},{}\n", base + k + 1, z + up);
        }
    }
    text + "EN,1,1,2,3,4,5,6,7,8\nEN,2,11,12,13,14,15,16,17,18\nTYPE,2\nMAT,2\nREAL,7\nEN,3,5,6,7,8\nTYPE,3\nEN,4,11,14,13,12\n"
}

#[test]
fn pairs_of_contact_are_surfaces_of_cells() {
    let deck = sound(&two_cubes(""));
    let contact = &deck.contacts[0];
    assert_eq!((contact.friction, contact.stiffness, contact.stick), (0.4, Some(1e9), None));
    let corners = |name: &str| {
        let (element, side) = deck.surface(name).unwrap().faces[0];
        let sides = deck.elements[element].kind.table().sides[side].1;
        let mut numbers: Vec<u64> =
            sides.iter().map(|k| deck.nodes[deck.elements[element].nodes[usize::from(*k)]].number).collect();
        numbers.sort_unstable();
        numbers
    };
    assert_eq!((corners(&contact.slave), corners(&contact.master)), (vec![5, 6, 7, 8], vec![11, 12, 13, 14]));
    let deck = sound(&two_cubes("KEYOPT,2,12,5\n"));
    assert_eq!((deck.ties.len(), deck.contacts.len(), deck.elements.len()), (1, 0, 2));
    let deck = sound(&two_cubes("KEYOPT,2,12,1\nKEYOPT,2,9,1\n"));
    assert!(deck.contacts[0].closed && notes(&deck, Weight::Matters).contains("no slip"));
}

#[test]
fn a_pilot_node_couples_the_nodes_of_contact_elements() {
    let deck = sound(&(two_cubes("") + "N,99,0,0,9\nTYPE,2\nREAL,8\nEN,8,15,16,17,18\nTYPE,3\nEN,9,99\n"));
    let coupling = &deck.couplings[0];
    assert_eq!(
        (deck.nodes[coupling.reference].number, coupling.nodes.len(), coupling.kind),
        (99, 4, CouplingKind::Rigid)
    );
    let deck = sound(
        &(two_cubes("KEYOPT,2,4,1\n") + "N,99,0,0,9\nTYPE,2\nREAL,8\nEN,8,15,16,17,18\nTYPE,3\nEN,9,99\n"),
    );
    assert_eq!(deck.couplings[0].kind, CouplingKind::Averaging);
}

#[test]
fn pressures_are_on_the_faces_of_their_numbers() {
    let deck = sound(
        &(two_cubes("") + "SFE,2,6,PRES,0,3.5\nSFE,       1,   2,PRES,1,R5.0\n  2.0   2.0  2.0  2.0\n"),
    );
    let pressed = |at: usize| {
        let LoadOn::Faces { faces, pressure } = &deck.loads[at].on else { panic!() };
        let (element, side) = faces[0];
        let mut nodes = deck.elements[element].kind.table().sides[side].1.to_vec();
        nodes.sort_unstable();
        (*pressure, element, nodes)
    };
    // Face 6 is M N O P, face 2 is I J N M.
    assert_eq!(pressed(1), (3.5, 1, vec![4, 5, 6, 7]));
    assert_eq!(pressed(0), (2.0, 0, vec![0, 1, 4, 5]));
}

/// Face 1 of a shell is below it, so that a pressure there is along the normal, face 2 above it.
#[test]
fn pressures_on_shells_have_a_side() {
    let deck = sound(
        "ET,1,181\nN,1,0,0\nN,2,1,0\nN,3,1,1\nN,4,0,1\nSECTYPE,1,SHELL\nSECDATA,0.1,1\nMP,EX,1,1\nTYPE,1\nMAT,1\nSECNUM,1\nEN,1,1,2,3,4\nSFE,1,2,PRES,0,3\n",
    );
    assert_eq!(deck.loads[0].on, LoadOn::Shells { shells: vec![0], pressure: -3.0 });
}

#[test]
fn what_is_not_read_is_listed_with_its_weight() {
    let deck = sound(
        "1H,,1H;,,19H\n/INPUT,other,dat\nMP,EX,1,2*3\nFOLLW,1\nET,1,17\nN,1\nEN,1,1\nET,2,200\nTYPE,2\nEN,2,1\nEQSLV,SPARSE\nOMEGA,0,0,3\n",
    );
    let matters = notes(&deck, Weight::Matters);
    for word in ["/INPUT", "`2*3` of MP", "element 17 of type 1", "OMEGA"] {
        assert!(matters.contains(word), "{word}: {matters}");
    }
    assert!(notes(&deck, Weight::Perhaps).contains("FOLLW"));
    let nothing = notes(&deck, Weight::Nothing);
    assert!(
        nothing.contains("EQSLV") && nothing.contains("MESH200") && nothing.contains("lines of data"),
        "{nothing}"
    );
}
