//! Small universal files of our own.

use crate::deck::Deck;
use crate::ledger::Weight;
use crate::text::Files;
use std::io::Write;
use stridor_base::bounds::{Origin, within};
use stridor_mesh::CellKind;

fn read(bytes: &[u8]) -> (Deck, String) {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    let mut files = Files::default();
    match super::read(file.path(), &mut files) {
        Ok(deck) => (deck, files.faults.0.iter().map(|fault| format!("{fault}\n")).collect()),
        Err(error) => (Deck::default(), error.to_string()),
    }
}

fn sound(text: &str) -> Deck {
    let (deck, faults) = read(text.as_bytes());
    assert_eq!(faults, "");
    deck
}

fn notes(deck: &Deck, weight: Weight) -> String {
    let rows = deck.ledger.rows().filter(|row| row.weight == weight);
    rows.map(|row| format!("{}: {}\n", row.what, row.why)).collect()
}

fn tens(numbers: &[i64]) -> String {
    numbers.iter().map(|number| format!("{number:10}")).collect::<String>() + "\n"
}

fn dataset(kind: u32, text: &str) -> String {
    format!("    -1\n{kind:6}\n{text}    -1\n")
}

/// Ten nodes of a tetrahedron of edges 2: corners 1 to 4, then the middles of its edges.
fn nodes() -> String {
    let corners = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]];
    let edges = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let middles = edges.map(|[a, b]| [0, 1, 2].map(|k| (corners[a][k] + corners[b][k]) / 2));
    let line = |(k, at): (usize, [i64; 3])| {
        let [x, y, z] = at.map(|x| format!("{:25}", format!("{:.16E}", x as f64).replace('E', "D+0")));
        format!("{}{x}{y}{z}\n", tens(&[k as i64 + 1, 1, 1, 11]))
    };
    dataset(2411, &corners.into_iter().chain(middles).enumerate().map(line).collect::<String>())
}

fn model() -> String {
    let elements = tens(&[1, 118, 3, 5, 7, 10])
        + &tens(&[1, 5, 2, 6, 3, 7, 8, 9])
        + &tens(&[10, 4])
        + &tens(&[2, 21, 1, 5, 7, 2])
        + &tens(&[0, 1, 1])
        + &tens(&[1, 4])
        + &tens(&[3, 41, 4, 5, 7, 3])
        + &tens(&[1, 2, 3]);
    let groups =
        tens(&[1, 0, 0, 0, 0, 0, 0, 3]) + "Foot\n" + &tens(&[7, 3, 0, 0, 7, 1, 0, 0]) + &tens(&[8, 1, 0, 0]);
    let units = "         1SI: Meter (newton)           2\n   1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D+00\n   2.7315000000000000D+02\n";
    dataset(164, units)
        + &dataset(2467, &groups)
        + &nodes()
        + &dataset(2412, &elements)
        + &dataset(1710, "x\n")
}

#[test]
fn nodes_elements_and_groups_are_read_in_any_order() {
    let deck = sound(&model());
    assert_eq!((deck.nodes.len(), deck.nodes[4].position), (10, [1.0, 0.0, 0.0]));
    let kinds: Vec<CellKind> = deck.elements.iter().map(|element| element.kind).collect();
    assert_eq!(kinds, [CellKind::Tetrahedron10, CellKind::Line2, CellKind::Triangle3]);
    // The file goes round the edges; the kind has corners first.
    assert_eq!(deck.elements[0].nodes, (0..10).collect::<Vec<_>>());
    assert_eq!((deck.node_sets[0].name.as_str(), &deck.node_sets[0].members[..]), ("Foot", &[0, 2][..]));
    assert_eq!(deck.element_sets[0].members, [0]);
    let sections: Vec<_> =
        deck.sections.iter().map(|own| (own.name.as_str(), own.elements.as_slice())).collect();
    let expected =
        [("PROPERTY_1_MATERIAL_5", [1]), ("PROPERTY_3_MATERIAL_5", [0]), ("PROPERTY_4_MATERIAL_5", [2])];
    assert_eq!(sections, expected.each_ref().map(|(name, elements)| (*name, &elements[..])));
    let matters = notes(&deck, Weight::Matters);
    assert!(matters.contains("dataset 1710") && matters.contains("PROPERTY_1_MATERIAL_5"), "{matters}");
    assert!(notes(&deck, Weight::Perhaps).contains("`SI: Meter (newton)`"));
    assert_eq!(deck, sound(&model().replace('\n', "\r\n")));
}

#[test]
fn older_datasets_have_single_precision_and_pairs() {
    let nodes = "         7         0         0         1  1.00000E+00 -2.50000E-01-2.50000E-100\n";
    let groups = tens(&[9, 0, 0, 0, 0, 0, 0, 1]) + "\n" + &tens(&[7, 7]);
    let deck = sound(&(dataset(15, nodes) + &dataset(2417, &groups)));
    assert_eq!((deck.nodes[0].number, deck.nodes[0].position), (7, [1.0, -0.25, -2.5e-100]));
    assert_eq!((deck.node_sets[0].name.as_str(), deck.node_sets[0].members.len()), ("GROUP_9", 1));
}

#[test]
fn nodes_in_a_cylindrical_system_are_placed() {
    let row = |x: [f64; 3]| x.map(|x| format!("{x:25.16E}")).concat() + "\n";
    let systems = tens(&[1])
        + "part\n"
        + &tens(&[4, 1, 8])
        + "CS4\n"
        + &row([1.0, 0.0, 0.0])
        + &row([0.0, 1.0, 0.0])
        + &row([0.0, 0.0, 1.0])
        + &row([10.0, 0.0, 0.0]);
    let node = tens(&[1, 4, 0, 11]) + &row([2.0, 90.0, 5.0]);
    let deck = sound(&(dataset(2411, &node) + &dataset(2420, &systems)));
    let error = (0..3).map(|k| (deck.nodes[0].position[k] - [10.0, 2.0, 5.0][k]).abs()).fold(0.0, f64::max);
    assert!(within(error, 1e-14, Origin::RoundOff), "{:?}", deck.nodes);
}

#[test]
fn faults_have_their_lines() {
    let (_, faults) =
        read((nodes() + &dataset(2412, &(tens(&[1, 111, 1, 1, 7, 4]) + &tens(&[1, 2, 3, 44])))).as_bytes());
    assert!(faults.contains(":26:") && faults.contains("node 44"), "{faults}");
    let (_, faults) = read(nodes().replacen("D+0", "X+0", 1).as_bytes());
    assert!(faults.contains("expected a finite number"), "{faults}");
    let (_, faults) = read(&model().as_bytes()[..700]);
    assert!(faults.contains("which does not end"), "{faults}");
    let twice = tens(&[1, 0, 0, 1]) + "1.0 2.0 3.0\n" + &tens(&[1, 0, 0, 1]) + "1.0 2.0 4.0\n";
    let (_, faults) = read(dataset(2411, &twice).as_bytes());
    assert!(faults.contains(":5:") && faults.contains("than in line 3"), "{faults}");
}

#[test]
fn nothing_panics_on_damaged_files() {
    let text = model().into_bytes();
    for at in 0..text.len() {
        read(&text[..at]);
        for byte in [b'9', b'-', b'\n', b' ', 0xff] {
            let mut bytes = text.clone();
            bytes[at] = byte;
            read(&bytes);
        }
    }
}
