//! Nodes, elements, instances.

use super::*;
use stridor_base::bounds::{Origin::*, within};
use stridor_mesh::{CellKind, Program};

#[test]
fn nodes_stand_in_cartesian_cylindrical_and_spherical_coordinates() {
    let deck = deck(
        "*Heading\n A title \n*node\n7,1.5-3,1.D+5,-.5\n 8. , 2.\n*NODE, SYSTEM=C\n1, 2., 90., 3.\n*NODE,SYSTEM = S\n2,2.,180.,30.\n",
    );
    assert_eq!(deck.title, "A title");
    assert_eq!(numbers(&deck, &[0, 1, 2, 3]), [7, 8, 1, 2]);
    assert_eq!(deck.nodes[0].position, [1.5e-3, 1e5, -0.5]);
    assert_eq!(deck.nodes[1].position, [2.0, 0.0, 0.0]);
    // 2 (cos 180° cos 30°, sin 180° cos 30°, sin 30°).
    let expected = [[0.0, 2.0, 3.0], [-(3.0_f64.sqrt()), 0.0, 1.0]];
    for (node, expected) in deck.nodes[2..].iter().zip(expected) {
        (0..3).for_each(|k| assert!(within((node.position[k] - expected[k]).abs(), 1e-13, RoundOff)));
    }
    assert_eq!(notes(&deck), []);
}

/// Every type of the table with its nodes numbered in the order of the file: the kind has them where its own order wants them.
#[test]
fn every_type_has_its_nodes_in_the_order_of_its_kind() {
    let mut types = 0;
    for kind in CellKind::all().filter(|kind| kind.dimension() > 0) {
        for form in kind.named(Program::Abaqus) {
            for name in form.names() {
                let n = kind.n_nodes();
                let nodes: String = (1..=n).map(|k| format!("{k}, {k}., {}., {}.\n", k * k, k % 3)).collect();
                let all: Vec<String> = (1..=n).map(|k| k.to_string()).collect();
                // Fifteen nodes in a line, as Abaqus writes them.
                let lines: Vec<String> = all.chunks(15).map(|line| line.join(", ")).collect();
                let text = format!(
                    "*NODE\n{nodes}*ELEMENT, TYPE={}\n9, {}\n",
                    name.to_lowercase(),
                    lines.join(",\n")
                );
                let deck = deck(&text);
                let file: Vec<usize> = (0..n).collect();
                assert_eq!(deck.elements[0].kind, kind, "{name}");
                assert_eq!(deck.elements[0].nodes, form.order.from_file(&file).unwrap(), "{name}");
                assert_eq!(form.order.to_file(&deck.elements[0].nodes), file, "{name}");
                assert_eq!(deck.type_names, [name]);
                types += 1;
            }
        }
    }
    assert!(types > 60, "{types}");
}

/// Elements coupled with temperature have the same nodes.
#[test]
fn types_with_temperature_are_read() {
    let deck = deck(&BRICKS.replace("C3D8", "C3D8RT"));
    assert_eq!(deck.elements[1].kind, CellKind::Hexahedron8);
    assert_eq!(deck.type_names, ["C3D8RT"]);
}

/// The number of nodes says where an element ends, not the comma at the end of a line; what a line lists beyond the nodes is noted.
#[test]
fn elements_go_on_by_the_number_of_their_nodes() {
    let nodes = &BRICKS[..BRICKS.find("*ELEMENT").unwrap()];
    let text = format!(
        "{nodes}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4\n5, 6, 7, 8\n2, 5, 6, 7, 8, 9,\n10, 11, 12,\n3, 1, 2, 3, 4, 5, 6, 7, 8, 11, 12,\n4,1,2,3,4,9,10,,\n11,12,,\n"
    );
    let deck = deck(&text);
    assert_eq!(numbers(&deck, &deck.elements[0].nodes), [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(numbers(&deck, &deck.elements[1].nodes), [5, 6, 7, 8, 9, 10, 11, 12]);
    assert_eq!(numbers(&deck, &deck.elements[2].nodes), [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(numbers(&deck, &deck.elements[3].nodes), [1, 2, 3, 4, 9, 10, 11, 12]);
    assert_eq!(notes(&deck), [(Weight::Nothing, "*ELEMENT, TYPE=C3D8", 19)]);
    // A line that is torn does not eat the element below.
    fault(
        &format!("{nodes}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4\n2, 1, 2, 3, 4, 5, 6, 7, 8\n"),
        15,
        "13 nodes in 2 lines",
    );
    fault(&format!("{nodes}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4\n"), 15, "4 nodes of an element");
}

/// Bricks on which nodes fall together, in the usual places and turned about.
#[test]
fn collapsed_bricks_are_wedges_pyramids_and_tetrahedra() {
    let nodes = &BRICKS[..BRICKS.find("*ELEMENT").unwrap()];
    let of =
        |list: &str, more: &str| deck(&format!("{nodes}*ELEMENT, TYPE=C3D8, ELSET=E\n1, {list}\n{more}"));
    let volume = |deck: &Deck| {
        let x = |k: usize| deck.nodes[deck.elements[0].nodes[k]].position;
        let d = |a: usize, b: usize| -> [f64; 3] { std::array::from_fn(|k| x(b)[k] - x(a)[k]) };
        let det = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let tetrahedra: &[[usize; 4]] = match deck.elements[0].kind {
            CellKind::Tetrahedron4 => &[[0, 1, 2, 3]],
            CellKind::Pyramid5 => &[[0, 1, 2, 4], [0, 2, 3, 4]],
            CellKind::Wedge6 => &[[0, 1, 2, 3], [1, 2, 3, 4], [2, 4, 5, 3]],
            other => panic!("{other:?}"),
        };
        let each = tetrahedra.iter().map(|[a, b, c, e]| det([d(*a, *b), d(*a, *c), d(*a, *e)]).abs() / 6.0);
        each.sum::<f64>()
    };
    // Edges 3-4 and 7-8 gone, then edges 1-5 and 4-8, then 1-2 and 4-3: half of a cube each.
    for list in ["1, 2, 3, 3, 5, 6, 7, 7", "1, 2, 3, 4, 1, 6, 7, 4", "1, 1, 4, 4, 5, 6, 7, 8"] {
        let wedge = of(list, "");
        assert_eq!(wedge.elements[0].kind, CellKind::Wedge6, "{list}");
        assert!(within((volume(&wedge) - 0.5).abs(), 1e-13, RoundOff));
    }
    for list in ["1, 2, 3, 4, 5, 5, 5, 5", "1, 1, 1, 1, 5, 6, 7, 8"] {
        let pyramid = of(list, "");
        assert_eq!(pyramid.elements[0].kind, CellKind::Pyramid5, "{list}");
        assert!(within((volume(&pyramid) - 1.0 / 3.0).abs(), 1e-13, RoundOff));
    }
    let tetrahedron = of("1, 2, 3, 3, 5, 5, 5, 5", "");
    assert_eq!(tetrahedron.elements[0].kind, CellKind::Tetrahedron4);
    assert!(within((volume(&tetrahedron) - 1.0 / 6.0).abs(), 1e-13, RoundOff));
    // Faces have the numbers of the brick.
    let wedge = "1, 2, 3, 4, 1, 6, 7, 4";
    for (face, corners) in
        [("S1", vec![1, 2, 3, 4]), ("S2", vec![1, 4, 6, 7]), ("S3", vec![1, 2, 6]), ("S5", vec![3, 4, 7])]
    {
        assert_eq!(faces(&of(wedge, &format!("*SURFACE, NAME=S\nE, {face}\n")), "S"), [corners], "{face}");
    }
    let text = format!("{nodes}*ELEMENT, TYPE=C3D8, ELSET=E\n1, {wedge}\n*SURFACE, NAME=S\nE, S6\n");
    fault(&text, 17, "face S6 of 1 elements");
    fault(&format!("{nodes}*ELEMENT, TYPE=C3D8\n1, 1, 1, 1, 1, 1, 1, 1, 1\n"), 15, "fall together");
    fault(&format!("{nodes}*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 3\n"), 15, "fall together");
}

/// A brick of 20 nodes without the edges 3-4 and 7-8: the wedge of 15 has each middle between its corners.
#[test]
fn a_collapsed_brick_of_twenty_nodes_keeps_its_middles() {
    let kind = CellKind::Hexahedron20;
    let places = kind.reference_coordinates();
    for (gone, with) in [([2, 3], [6, 7]), ([0, 4], [3, 7]), ([1, 2], [5, 6])] {
        let first =
            |corner: usize| [gone, with].iter().find(|of| of.contains(&corner)).map_or(corner, |of| of[0]);
        let mut text = String::from("*NODE\n");
        let mut list = Vec::new();
        for middle in kind.table().middles {
            let mut corners: Vec<usize> = middle.iter().map(|corner| first(usize::from(*corner))).collect();
            corners.sort_unstable();
            corners.dedup();
            let number = 1 + corners.iter().fold(0, |sum, corner| sum * 10 + corner);
            let at: [f64; 3] = std::array::from_fn(|k| {
                corners.iter().map(|corner| places[*corner][k]).sum::<f64>() / corners.len() as f64
            });
            // Corner 0 with another has the number of the other one: a hundred more.
            let number = if corners.len() > 1 { number + 100 } else { number };
            text += &format!("{number}, {}, {}, {}\n", at[0], at[1], at[2]);
            list.push(number.to_string());
        }
        text += &format!("*ELEMENT, TYPE=C3D20R\n1, {}\n", list.join(", "));
        let deck = deck(&text);
        assert_eq!(deck.elements[0].kind, CellKind::Wedge15);
        let at = |node: usize| deck.nodes[deck.elements[0].nodes[node]].position;
        for (node, corners) in CellKind::Wedge15.table().middles.iter().enumerate() {
            let mean: [f64; 3] = std::array::from_fn(|k| {
                corners.iter().map(|corner| at(usize::from(*corner))[k]).sum::<f64>() / corners.len() as f64
            });
            assert_eq!(at(node), mean, "{gone:?} {node}");
        }
    }
}

/// A triangle as a quadrilateral.
#[test]
fn a_collapsed_quadrilateral_is_a_triangle() {
    let nodes = &BRICKS[..BRICKS.find("*ELEMENT").unwrap()];
    for (list, expected) in [("1, 2, 3, 3", [1, 2, 3]), ("1, 1, 2, 3", [2, 3, 1]), ("1, 2, 3, 1", [1, 2, 3])]
    {
        let deck = deck(&format!("{nodes}*ELEMENT, TYPE=S4R\n1, {list}\n"));
        assert_eq!(deck.elements[0].kind, CellKind::Triangle3);
        let mut own = numbers(&deck, &deck.elements[0].nodes);
        // Any corner first, and the same way round.
        let turn = own.iter().position(|node| *node == expected[0]).unwrap();
        own.rotate_left(turn);
        assert_eq!(own, expected, "{list}");
    }
}

const PART: &str = "\
*PART, NAME=Pad
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*ELEMENT, TYPE=C3D4, ELSET=Body
1, 1, 2, 3, 4
*NSET, NSET=Tip
4
*SURFACE, NAME=Base
Body, S1
*SOLID SECTION, ELSET=Body, MATERIAL=Steel
*END PART
";

/// An instance is moved, then turned about an axis that need not pass the origin. By hand: node 2 at (1, 0, 0) goes to (11, 0, 0), which
/// lies at (1, −5, 0) from (10, 5, 0); a quarter turn about z takes that to (5, 1, 0): (15, 6, 0).
#[test]
fn instances_are_moved_and_turned() {
    let text = format!(
        "{PART}*ASSEMBLY, NAME=A\n*INSTANCE, NAME=Pad-1, PART=Pad\n*END INSTANCE\n*INSTANCE, NAME=\"Pad-2\", PART=PAD\n10., 0., 0.\n10., 5., 0., 10., 5., 2., 90.\n*END INSTANCE\n\
         *NSET, NSET=Tips, INSTANCE=Pad-1\nTip\n*NSET, NSET=TIPS, INSTANCE=PAD-2\n Tip, 1\n*NSET, NSET=Named\nPad-2.Tip, pad-1.2\n*SURFACE, NAME=All\nPad-1.Body, S2\nPad-2.Body, S3\n\
         *ELEMENT, TYPE=SPRING2, ELSET=Springs\n1, Pad-1.1, Pad-2.1\n*SPRING, ELSET=Springs\n1, 1\n5.\n*END ASSEMBLY\n*MATERIAL, NAME=Steel\n*ELASTIC\n2e11, 0.3\n"
    );
    let deck = deck(&text);
    let expected = [[15.0, 5.0, 0.0], [15.0, 6.0, 0.0], [14.0, 5.0, 0.0], [15.0, 5.0, 1.0]];
    for (node, expected) in deck.nodes[4..].iter().zip(expected) {
        (0..3).for_each(|k| assert!(within((node.position[k] - expected[k]).abs(), 1e-13, RoundOff)));
    }
    assert_eq!(deck.nodes[1].position, [1.0, 0.0, 0.0]);
    assert_eq!(deck.node_set("Tips").unwrap().members, [3, 4, 7]);
    assert_eq!(deck.node_set("Named").unwrap().members, [1, 7]);
    assert_eq!(deck.node_set("pad-2.tip").unwrap().members, [7]);
    assert_eq!(deck.elements[1].nodes, [4, 5, 6, 7]);
    assert_eq!(deck.surface("Pad-2.Base").unwrap().faces.len(), 1);
    assert_eq!(
        deck.surface("All").unwrap().faces.iter().map(|(element, _)| *element).collect::<Vec<_>>(),
        [0, 1]
    );
    assert_eq!(deck.springs[0].ends, [(0, Some(4))]);
    let sections: Vec<_> =
        deck.sections.iter().map(|section| (section.name.as_str(), &section.elements[..])).collect();
    assert_eq!(sections, [("Pad-1.Body", &[0_usize][..]), ("Pad-2.Body", &[1])]);
    assert_eq!(notes(&deck), []);
}

#[test]
fn instances_and_parts_that_are_wrong_are_faults() {
    let lines = PART.lines().count();
    fault(&format!("{PART}*INSTANCE, NAME=A, PART=Disc\n*END INSTANCE\n"), lines + 1, "part `Disc`");
    fault(
        &format!("{PART}{PART}*INSTANCE, NAME=A, PART=Pad\n*END INSTANCE\n").replacen(
            "*PART, NAME=Pad",
            "*PART, NAME=Pad",
            1,
        ),
        lines + 1,
        "a second *PART",
    );
    let twice = "*INSTANCE, NAME=A, PART=Pad\n*END INSTANCE\n".repeat(2);
    fault(&format!("{PART}{twice}"), lines + 3, "a second *INSTANCE");
    fault(
        &format!("{PART}*INSTANCE, NAME=A, PART=Pad\n1,2,3\n1,1,1,1,1,1,90\n*END INSTANCE\n"),
        lines + 3,
        "two points of an axis",
    );
    let unused = deck(&format!("{PART}*NODE\n1,0,0,0\n"));
    assert_eq!(notes(&unused), [(Weight::Perhaps, "*PART", 2)]);
    assert_eq!(unused.nodes.len(), 1);
}

/// Written twice alike: a note; else a fault.
#[test]
fn what_stands_twice_must_be_the_same() {
    let lines = BRICKS.lines().count();
    let same =
        bricks("*NODE\n3, 1., 1., 0.\n*ELEMENT, TYPE=C3D8, ELSET=AGAIN\n2, 5, 6, 7, 8, 9, 10, 11, 12\n");
    assert_eq!((same.nodes.len(), same.elements.len()), (12, 2));
    assert_eq!(elements(&same, "AGAIN"), [2]);
    assert_eq!(notes(&same).len(), 2);
    fault(&format!("{BRICKS}*NODE\n3, 1., 1., 1e-9\n"), lines + 2, "a second node 3");
    fault(
        &format!("{BRICKS}*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 9, 10, 11, 12\n"),
        lines + 2,
        "a second element 2",
    );
    fault(
        &format!("{BRICKS}*ELEMENT, TYPE=C3D8\n3, 1, 2, 3, 4, 9, 10, 11, 13\n"),
        lines + 2,
        "an element on node 13",
    );
}
