//! Nodes and elements that are generated.

use super::*;
use stridor_base::bounds::{Origin::*, within};
use stridor_mesh::CellKind;

fn node(deck: &Deck, number: u64) -> [f64; 3] {
    deck.nodes
        .iter()
        .find(|node| node.number == number)
        .unwrap_or_else(|| panic!("no node {number}"))
        .position
}

/// The members of a set by their numbers.
fn sorted(deck: &Deck, name: &str) -> Vec<u64> {
    let mut members = set(deck, name);
    members.sort_unstable();
    members
}

fn same(found: [f64; 3], expected: [f64; 3]) {
    let error = (0..3).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
    assert!(within(error, 1e-12, RoundOff), "{found:?} {expected:?}");
}

#[test]
fn lines_have_their_nodes_at_even_distances() {
    let deck =
        deck("*NODE\n10, 1., 2., 3.\n4, 4., 2., -3.\n*NGEN, NSET=A\n4, 10, 2.0\n10, 4, -2\n4, 10, 3\n");
    assert_eq!(sorted(&deck, "A"), [4, 6, 7, 8, 10]);
    same(node(&deck, 6), [3.0, 2.0, -1.0]);
    same(node(&deck, 7), [2.5, 2.0, 0.0]);
    same(node(&deck, 8), [2.0, 2.0, 1.0]);
    // The second line has the nodes of the first one.
    assert_eq!(notes(&deck), [(Weight::Nothing, "*NGEN", 6)]);
    fault("*NODE\n1, 0.\n4, 3.\n*NGEN\n1, 4, 2\n", 5, "from 1 to 4 by 2");
    fault("*NODE\n1, 0.\n4, 3.\n*NGEN\n1, 5\n", 5, "node 5");
    fault("*NODE\n1, 0.\n4, 3.\n3, 5.\n*NGEN\n1, 4\n", 6, "a second node 3 at another place");
    fault("*NODE\n1, 0.\n4, 3.\n*NGEN, LINE=Q\n1, 4\n", 4, "LINE=Q");
}

/// x(φ) = c + R (cos φ e₁ + sin φ e₂): points of a quarter, of three quarters by their normal, of a full circle.
#[test]
fn arcs_have_their_nodes_on_the_circle() {
    let at = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [1.0 + 60.0 * cos, 2.0, 3.0 - 60.0 * sin]
    };
    let ends = "*NODE\n1, 61., 2., 3.\n10, 1., 2., -57.\n100, 1., 2., 3.\n201, 61., 2., 3.\n";
    let quarter = deck(&format!("{ends}*NGEN, LINE=C\n1, 10, 1, 100\n"));
    (1..=10).for_each(|k| same(node(&quarter, k), at(10.0 * (k - 1) as f64)));
    let by_place = deck(&format!("{ends}*NGEN, LINE=C\n1, 10, 1, , 1., 2., 3.\n"));
    (0..by_place.nodes.len()).for_each(|k| same(by_place.nodes[k].position, quarter.nodes[k].position));
    // The centre at r = √5, θ = atan 2, z = 3.
    let centre = format!("{:?}, {:?}, 3.", 5.0_f64.sqrt(), 2.0_f64.atan().to_degrees());
    let polar = deck(&format!("{ends}*NGEN, LINE=C, SYSTEM=C\n1, 10, 1, , {centre}\n"));
    (0..polar.nodes.len()).for_each(|k| same(polar.nodes[k].position, quarter.nodes[k].position));
    // About −y the end at 90° is at 270°.
    let most = deck(&format!("{ends}*NGEN, LINE=C\n1, 10, 1, 100, , , , 0., -7., 0.\n"));
    (1..=10).for_each(|k| same(node(&most, k), at(-30.0 * (k - 1) as f64)));
    let round = deck(&format!("{ends}*NGEN, LINE=C\n1, 201, 20, 100, , , , 0., 1., 0.\n"));
    (0..=10).for_each(|k| same(node(&round, 1 + 20 * k), at(36.0 * k as f64)));
    for row in ["1, 201, 20, 100", "1, 100, 9, 100"] {
        fault(&format!("{ends}*NGEN, LINE=C\n{row}\n"), 7, "in one line");
    }
    let spiral = deck(&format!("{ends}11, 1., 2., -87.\n*NGEN, LINE=C\n1, 11, 5, 100\n"));
    same(node(&spiral, 6), [1.0 + 75.0 * 0.5_f64.sqrt(), 2.0, 3.0 - 75.0 * 0.5_f64.sqrt()]);
    assert_eq!(notes(&spiral), [(Weight::Perhaps, "*NGEN, LINE=C", 8)]);
}

/// y = x², and the same where the part is placed.
#[test]
fn parabolas_and_arcs_are_placed_with_their_part() {
    let own = "*NODE, NSET=N\n1, -1., 1.\n9, 1., 1.\n11, 2.\n19, 0., 2.\n\
               *NGEN, LINE=P, NSET=N\n1, 9, 1, , 0., 0.\n*NGEN, LINE=C, NSET=N\n11, 19, 4, , 0., 0., 0., 0., 0., -1.\n\
               *NCOPY, OLD SET=N, CHANGE NUMBER=100, SHIFT\n1., 2., 3.\n0., 0., 0., 0., 1., 0., 30.\n\
               *NCOPY, OLD SET=N, CHANGE NUMBER=200, REFLECT=POINT\n1., 2., 3.\n";
    let deck_of = |end: &str| {
        deck(&format!("*PART, NAME=P\n{own}*END PART\n*INSTANCE, NAME=I, PART=P\n{end}*END INSTANCE\n"))
    };
    let [plain, placed] = ["", "3., 4., 5.\n0., 0., 0., 1., 2., 3., 40.\n"].map(deck_of);
    for k in 1..=9 {
        let x = (k as f64 - 5.0) / 4.0;
        same(node(&plain, k), [x, x * x, 0.0]);
    }
    let by = crate::abaqus::space::Placement {
        rotation: crate::abaqus::frames::rotation(
            [1.0, 2.0, 3.0].map(|x: f64| x / 14.0_f64.sqrt()),
            40.0_f64.to_radians(),
        ),
        translation: [0.0; 3],
    };
    assert_eq!((plain.nodes.len(), placed.nodes.len()), (36, 36));
    for (x, y) in plain.nodes.iter().zip(&placed.nodes) {
        let shifted = [3.0, 4.0, 5.0];
        same(y.position, by.place(std::array::from_fn(|k| x.position[k] + shifted[k])));
    }
}

/// Lᵢ/Lᵢ₊₁ = b, and ΣLᵢ the distance.
#[test]
fn nodes_between_sets_are_closer_towards_one_of_them() {
    let bounds = "*NODE, NSET=A\n1, 0., 0.\n3, 0., 1.\n*NODE, NSET=B\n100, 15., 0.\n98, 30., 1.\n";
    let fill = |options: &str, row: &str| deck(&format!("{bounds}*NFILL, NSET=C{options}\n{row}\n"));
    // In the order of numbers: 1 and 98, 3 and 100.
    let half = fill(", BIAS=0.5", "A, B, 4, 10");
    assert_eq!(sorted(&half, "C"), [1, 3, 11, 13, 21, 23, 31, 33, 98, 100]);
    for (k, sum) in [(1, 1.0), (2, 3.0), (3, 7.0)] {
        same(node(&half, 1 + 10 * k), [30.0 * sum / 15.0, sum / 15.0, 0.0]);
        same(node(&half, 3 + 10 * k), [sum, 1.0 - sum / 15.0, 0.0]);
    }
    let other = fill(", BIAS=2.", "A, B, 4, 10");
    same(node(&other, 11), [16.0, 8.0 / 15.0, 0.0]);
    let even = fill("", "1, 98, 4, 5");
    same(node(&even, 6), [7.5, 0.25, 0.0]);
    // Every other node is between two that grow.
    let pairs = fill(", BIAS=0.5, TWO STEP", "A, B, 4, 10");
    for (k, part) in [(1, 1.0 / 6.0), (2, 1.0 / 3.0), (3, 2.0 / 3.0)] {
        same(node(&pairs, 1 + 10 * k), [30.0 * part, part, 0.0]);
    }
    for bias in ["1.0000000001", "1e-9", "1e9", "1e-300", "1e300"] {
        let far = fill(&format!(", BIAS={bias}"), "1, 98, 2000, 1000");
        assert!(far.nodes.iter().all(|node| (0.0..=30.0).contains(&node.position[0])), "{bias}");
    }
    let refused = |options: &str, row: &str, line: usize, words: &str| {
        fault(&format!("{bounds}*NFILL{options}\n{row}\n"), line, words);
    };
    refused("", "A, 1, 4", 8, "sets of 2 and 1 nodes");
    refused("", "A, D, 4", 8, "`D`");
    refused("", "A, B, 0", 8, "how many");
    refused(", BIAS=0", "A, B, 2", 7, "BIAS=0");
    refused(", TWO STEP", "A, B, 3", 8, "3 intervals");
    let singular = fill(", SINGULAR=1", "A, B, 4, 10");
    assert_eq!(notes(&singular), [(Weight::Matters, "*NFILL, SINGULAR", 7)]);
}

/// A set by numbers between the lines that generate, in its own order.
#[test]
fn sets_that_are_named_above_are_those_of_that_line() {
    let text = "*NODE\n1, 0.\n2, 1.\n11, 0., 9.\n12, 1., 9.\n*NSET, NSET=A, UNSORTED\n2, 1\n*NSET, NSET=B, GEN\n11, 12\n\
                *NFILL\nA, B, 2, 100\n*NSET, NSET=B\n1\n*NCOPY, OLD SET=A, NEW SET=D, CHANGE NUMBER=-0, SHIFT\n0.,\n0.,\n";
    let deck = deck(text);
    same(node(&deck, 102), [0.5, 4.5, 0.0]);
    assert_eq!(
        (set(&deck, "A"), set(&deck, "B"), set(&deck, "D")),
        (vec![1, 2], vec![1, 11, 12], vec![1, 2])
    );
    assert_eq!(notes(&deck), [(Weight::Nothing, "*NCOPY", 14)]);
    fault("*NODE\n1, 0.\n*NCOPY, OLD SET=A, SHIFT, CHANGE NUMBER=1\n1.\n*NSET, NSET=A\n1\n", 3, "`A`");
}

#[test]
fn nodes_are_shifted_turned_and_reflected() {
    let copy = |options: &str, rows: &str| {
        let text = format!(
            "*NODE, NSET=A\n7, 1., 2., 3.\n*NCOPY, OLD SET=A, CHANGE NUMBER=-2, NEW SET=B, {options}\n{rows}"
        );
        let deck = deck(&text);
        assert_eq!((set(&deck, "B"), notes(&deck)), (vec![5], vec![]));
        node(&deck, 5)
    };
    let to = [
        ("SHIFT", "1., 0., -1.\n\n", [2.0, 2.0, 2.0]),
        ("SHIFT", "1., 0., -1.\n0.,\n", [2.0, 2.0, 2.0]),
        // (2, 2, 2) by 90° about the line x = 1, y = 1 along z.
        ("SHIFT", "1., 0., -1.\n1., 1., 0., 1., 1., 5., 90.\n", [0.0, 2.0, 2.0]),
        ("SHIFT, MULTIPLE=3", "1., 0., -1.\n1., 1., 0., 1., 1., 5., 30.\n", [0.0, 2.0, 2.0]),
        ("REFLECT=POINT", "0., 1., 0.\n", [-1.0, 0.0, -3.0]),
        ("REFLECT=LINE", "0., 0., 1., 5., 0., 1.\n", [1.0, -2.0, -1.0]),
        ("REFLECT=MIRROR", "0., 0., 1., 5., 0., 1.\n2., 3., 1.\n", [1.0, 2.0, -1.0]),
        // The plane x = y.
        ("REFLECT=mirror", "0., 0., 0., 1., 1., 0.\n1., 1., 1.\n", [2.0, 1.0, 3.0]),
    ];
    to.into_iter().for_each(|(options, rows, expected)| same(copy(options, rows), expected));
    let refused = |options: &str, rows: &str, words: &str| {
        let text = format!("*NODE, NSET=A\n7, 1., 2., 3.\n*NCOPY, {options}\n{rows}");
        assert!(faults(&text)[0].contains(words), "{:?}", faults(&text));
    };
    refused("OLD SET=A, CHANGE NUMBER=1", "1.\n", "without a motion");
    refused("OLD SET=A, CHANGE NUMBER=1, REFLECT=LINE", "1., 1., 1., 1., 1., 1.\n", "without a motion");
    refused(
        "OLD SET=A, CHANGE NUMBER=1, REFLECT=MIRROR",
        "1., 1., 1., 2., 1., 1.\n3., 1., 1.\n",
        "without a motion",
    );
    refused("OLD SET=A, CHANGE NUMBER=-7, SHIFT", "1.\n", "a sum that is a number");
    refused("OLD SET=A, SHIFT", "1.\n", "CHANGE NUMBER");
    refused("CHANGE NUMBER=1, SHIFT", "1.\n", "OLD SET");
}

/// A point of a set by its coordinates in a frame: x = 2 e₁ + 0.5 e₂ − e₃ and so on about a = (1, 2, 3).
#[test]
fn nodes_are_mapped_from_a_frame() {
    let map = |own: &str, kind: &str, rows: &str| {
        let text = format!("*NODE, NSET=A\n7, {own}\n*NODE\n8, 9.\n*NMAP, NSET=A, TYPE={kind}\n{rows}\n");
        let deck = deck(&text);
        assert_eq!((node(&deck, 8), notes(&deck)), ([9.0, 0.0, 0.0], vec![]));
        node(&deck, 7)
    };
    same(map("2., 0.5, -1.", "RECTANGULAR", "1., 2., 3."), [3.0, 2.5, 2.0]);
    same(map("2., 0.5, -1.", "RECTANGULAR", "1."), [3.0, 0.5, -1.0]);
    // Axes 1, 2, 3 are y, z, x.
    let frame = "1., 2., 3., 1., 7., 3.\n1., 5., 8.";
    same(map("2., 0.5, -1.", "RECTANGULAR", frame), [0.0, 4.0, 3.5]);
    same(map("2., 0.5, -1.", "RECTANGULAR", &format!("{frame}\n, 4., 2.")), [-1.0, 4.0, 5.0]);
    // Axes 3, 1, 2 are y, z, x: r along z at θ = 0, along x at 90°.
    same(map("2., 90., -1.", "CYLINDRICAL", frame), [3.0, 1.0, 3.0]);
    same(map("2., 0., 30.", "SPHERICAL", frame), [1.0, 3.0, 3.0 + 3.0_f64.sqrt()]);
    let text = "*NODE, NSET=A\n7, 1.\n*NMAP, NSET=A, TYPE=";
    assert_eq!(notes(&deck(&format!("{text}BLENDED\n"))), [(Weight::Matters, "*NMAP", 3)]);
    fault(&format!("{text}CYLINDRICAL\n0., 0., 0., 0., 0., 1.\n0., 0., 5.\n"), 3, "points in one line");
    fault(&format!("{text}RECTANGULAR\n"), 3, "without a set or data");
}

/// Each cell of straight edges is x = x₀ + A ξ; 2³ times det A is the volume of a brick.
fn volumes(deck: &Deck) -> Vec<f64> {
    let volume = |element: &crate::deck::Element| {
        let places = element.kind.reference_coordinates();
        let ends = match element.kind {
            CellKind::Hexahedron8 | CellKind::Hexahedron20 => [1, 3, 4],
            CellKind::Tetrahedron10 => [1, 2, 3],
            other => panic!("{other:?}"),
        };
        let at = |k: usize| deck.nodes[element.nodes[k]].position;
        let [a, b, c] = ends.map(|k| {
            let length: f64 = (0..3).map(|i| (places[k][i] - places[0][i]).abs()).sum();
            let edge: [f64; 3] = std::array::from_fn(|i| (at(k)[i] - at(0)[i]) / length);
            edge
        });
        for (k, xi) in places.iter().enumerate() {
            let xi: [f64; 3] = std::array::from_fn(|i| xi[i] - places[0][i]);
            same(at(k), std::array::from_fn(|i| at(0)[i] + xi[0] * a[i] + xi[1] * b[i] + xi[2] * c[i]));
        }
        let whole = if ends == [1, 2, 3] { 1.0 / 6.0 } else { 8.0 };
        whole * stridor_mesh::quality::dot(a, stridor_mesh::quality::cross(b, c))
    };
    deck.elements.iter().map(volume).collect()
}

/// A block of 2 × 3 × 5 by 4 × 3 × 2 bricks, closer towards one face: 24 elements, 5 · 4 · 3 nodes, of 30 in volume.
#[test]
fn blocks_of_elements_have_their_numbers_and_volume() {
    let text = "*NODE\n1, 0., 0., 0.\n5, 2., 0., 0.\n301, 0., 3., 0.\n305, 2., 3., 0.\n\
                *NGEN, NSET=FRONT\n1, 5\n*NGEN, NSET=BACK\n301, 305\n*NFILL, NSET=LOW, BIAS=0.7\nFRONT, BACK, 3, 100\n\
                *NCOPY, OLD SET=LOW, NEW SET=HIGH, CHANGE NUMBER=2000, SHIFT\n0., 0., 5.\n*NFILL, NSET=ALL\nLOW, HIGH, 2, 1000\n\
                *ELEMENT, TYPE=C3D8, ELSET=FIRST\n7, 1, 2, 102, 101, 1001, 1002, 1102, 1101\n\
                *ELGEN, ELSET=BRICKS\n7, 4, , , 3, 100, 10, 2, 1000, 100\n*NSET, NSET=TOP, ELSET=BRICKS\n";
    let deck = deck(text);
    assert_eq!((deck.nodes.len(), deck.elements.len(), set(&deck, "ALL").len()), (60, 24, 60));
    assert_eq!(set(&deck, "TOP").len(), 60);
    let mut expected: Vec<u64> = (0..24).map(|k| 7 + k % 4 + 10 * (k / 4 % 3) + 100 * (k / 12)).collect();
    expected.sort_unstable();
    assert_eq!(elements(&deck, "BRICKS"), expected);
    let last = deck.elements.last().unwrap();
    assert_eq!(
        (last.number, numbers(&deck, &last.nodes)),
        (130, vec![1204, 1205, 1305, 1304, 2204, 2205, 2305, 2304])
    );
    let volumes = volumes(&deck);
    assert!(volumes.iter().all(|volume| *volume > 0.0));
    assert!(within((volumes.iter().sum::<f64>() - 30.0).abs(), 1e-12, RoundOff));
    assert_eq!(notes(&deck), []);
}

/// Cells of second order on mirrored nodes: the volume of those that they copy, middles between their corners; without REFLECT it is
/// negative. Faces of a brick that fell together are those of its file.
#[test]
fn elements_on_mirrored_nodes_have_their_volume() {
    for (kind, name) in [
        (CellKind::Hexahedron20, "C3D20"),
        (CellKind::Tetrahedron10, "C3D10"),
        (CellKind::Hexahedron8, "C3D8"),
    ] {
        let form = kind.named(stridor_mesh::Program::Abaqus)[0];
        let places = form.order.to_file(&kind.reference_coordinates());
        let nodes: String = places
            .iter()
            .enumerate()
            .map(|(k, [x, y, z])| format!("{}, {x:?}, {:?}, {z:?}\n", k + 1, y + 2.0))
            .collect();
        let numbers: Vec<String> = (1..=places.len()).map(|k| k.to_string()).collect();
        let of = |options: &str| {
            deck(&format!(
                "*NODE, NSET=A\n{nodes}*NCOPY, OLD SET=A, CHANGE NUMBER=50, REFLECT=MIRROR\n0., 0., 0., 1., 0., 0.\n0., 0., 1.\n\
                 *ELEMENT, TYPE={name}, ELSET=E\n1, {}\n*ELCOPY, OLD SET=E, NEW SET=F, ELEMENT SHIFT=6, SHIFT NODES=50{options}\n",
                numbers.join(", ")
            ))
        };
        let [plain, reflected] = ["", ", REFLECT"].map(of);
        let whole = if kind == CellKind::Tetrahedron10 { 1.0 / 6.0 } else { 8.0 };
        for (deck, sign) in [(&plain, -1.0), (&reflected, 1.0)] {
            assert_eq!((elements(deck, "F"), elements(deck, "E")), (vec![7], vec![1]));
            let found = volumes(deck);
            assert!(
                within((found[0] - whole).abs() + (found[1] - sign * whole).abs(), 1e-12, RoundOff),
                "{found:?}"
            );
        }
        assert_eq!(
            notes(&reflected),
            [(Weight::Perhaps, "*ELCOPY, REFLECT", reflected.elements[1].place.line)]
        );
    }
    let collapsed = deck(
        "*NODE, NSET=A\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 0., 1., 1.\n\
         *NCOPY, OLD SET=A, CHANGE NUMBER=10, SHIFT\n0., 0., 3.\n*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 3, 5, 6, 7, 7\n\
         *ELGEN, ELSET=E\n1, 2, 10\n*SURFACE, NAME=S\n1, S3\n2, S2\n2, S3\n",
    );
    assert_eq!(collapsed.elements[1].kind, CellKind::Wedge6);
    assert_eq!(faces(&collapsed, "S"), [vec![1, 2, 5, 6], vec![15, 16, 17], vec![11, 12, 15, 16]]);
}

/// Masses and springs too; a row on nodes that are there already; what is not there.
#[test]
fn elements_without_a_shape_are_copied() {
    let nodes = "*NODE\n1, 0.\n9, 8.\n*NGEN\n1, 9\n*ELEMENT, TYPE=MASS\n1, 1\n*ELEMENT, TYPE=SPRINGA\n11, 1, 2\n*ELEMENT, TYPE=AC3D4\n21, 1, 2, 3, 4\n";
    let deck = deck(&format!(
        "{nodes}*ELGEN, ELSET=M\n1, 4, 2\n1, 2, 2\n*ELGEN, ELSET=K\n11, 8\n*ELGEN, ELSET=U\n21, 3\n\
         *ELSET, ELSET=SOME\n12, 13\n*ELCOPY, OLD SET=SOME, NEW SET=K, ELEMENT SHIFT=100, SHIFT NODES=3\n\
         *ELSET, ELSET=X\n1, 4, 23, 113\n*MASS, ELSET=M\n2.\n*SPRING, ELSET=K\n\n5.\n"
    ));
    let masses: Vec<u64> = deck.masses.iter().flat_map(|mass| numbers(&deck, &mass.nodes)).collect();
    assert_eq!((masses, deck.springs[0].ends.len()), (vec![1, 3, 5, 7], 10));
    assert_eq!(
        notes(&deck),
        [(Weight::Matters, "*ELEMENT, TYPE=AC3D4", 10), (Weight::Nothing, "*ELGEN", 14)]
    );
    let refused = |more: &str, words: &str| fault(&format!("{nodes}{more}"), 13, words);
    refused("*ELGEN\n1, 10\n", "element 10 generated on node 10");
    refused("*ELGEN\n2, 2\n", "element 2");
    refused("*ELGEN\n11, 2, 2, -10\n", "a second element 1");
    refused("*ELGEN\n11, 0\n", "how many");
    refused("*ELGEN\n11, 2, 0, -11\n", "from 1");
    fault(&format!("{nodes}*ELCOPY, OLD SET=A, ELEMENT SHIFT=1, SHIFT NODES=1\n"), 12, "`A`");
    fault(&format!("{nodes}*ELCOPY, ELEMENT SHIFT=1, OLD SET=A\n"), 12, "SHIFT NODES");
}

/// A few lines for more than a file may hold: refused before they are made, and all of them together.
#[test]
fn what_is_generated_is_bounded() {
    let ends = "*NODE\n1, 0.\n999999999, 1.\n600001, 3.\n1800003, 7.\n600002, 4.\n1200002, 5.\n*ELEMENT, TYPE=B31\n1, 1, 600001\n";
    let refused = |more: &str, line: usize| {
        let begun = std::time::Instant::now();
        fault(&format!("{ends}{more}"), line, "nodes and elements that are generated");
        assert!(begun.elapsed() < std::time::Duration::from_secs(20));
    };
    refused("*NGEN\n1, 999999999\n", 11);
    refused("*NFILL\n1, 600001, 18446744073709551\n", 11);
    refused("*ELGEN\n1, 9223372036854775807, 1, 1, 9223372036854775807, 1, 1, 9223372036854775807\n", 11);
    // Two lines of 599,999: the second one is too many.
    refused("*NGEN\n1, 600001\n600002, 1200002\n", 12);
    let part = "*PART, NAME=P\n*NODE\n1, 0.\n10000, 1.\n*NGEN\n1, 10000\n*END PART\n";
    let instances: String =
        (0..200).map(|k| format!("*INSTANCE, NAME=I{k}, PART=P\n*END INSTANCE\n")).collect();
    assert!(faults(&format!("{part}{instances}"))[0].contains("that are generated"));
    // Sets of what is generated are named as often as those of what is written.
    let supports: String = (0..10).map(|k| format!("N, {}\n", 1 + k % 6)).collect();
    let many = deck(&format!("*NODE\n1, 0.\n90000, 1.\n*NGEN, NSET=N\n1, 90000\n*BOUNDARY\n{supports}"));
    assert_eq!(many.nodes.len(), 90_000);
}
