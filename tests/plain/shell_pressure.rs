//! Pressures on shells: their side, and what a plate bends by, of decks whose shells lie either way round.

use std::fmt::Write as _;
use stridor::bounds::{Origin::*, within};
use stridor::case::read_case;
use stridor::decks::{Converted, Format, LoadOn, Units, convert, read_bytes, write};
use stridor::equilibrium::{SteadyOptions, solve_steady};
use stridor::job::{Prepared, deck};
use stridor::mesh::to_msh_exactly;

/// Elements along and across the plate of 100 mm × 40 mm × 2 mm, which is clamped at x = 0.
const N: [usize; 2] = [20, 8];
/// w \[mm\] in the middle of the free edge under 0.01 MPa: CalculiX 2.20, 40 × 16 elements S8R.
const CALCULIX: f64 = 0.853_647_1;

fn place(i: usize, j: usize) -> [f64; 2] {
    [100.0 * i as f64 / N[0] as f64, 40.0 * j as f64 / N[1] as f64]
}

fn node(i: usize, j: usize) -> usize {
    1 + i + (N[0] + 1) * j
}

/// The corners of each element; `turned` says which go round the other way.
fn elements(turned: impl Fn(usize) -> bool) -> Vec<[usize; 4]> {
    let corners = |j: usize, i: usize| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
    let all = (0..N[1]).flat_map(|j| (0..N[0]).map(move |i| corners(j, i)));
    all.enumerate().map(|(k, [a, b, c, d])| if turned(k) { [a, d, c, b] } else { [a, b, c, d] }).collect()
}

fn words(numbers: impl IntoIterator<Item = usize>) -> String {
    numbers.into_iter().map(|k| k.to_string()).collect::<Vec<_>>().join(", ")
}

/// A deck of Abaqus whose elements `turned` are in the set DOWN, the others in UP.
fn abaqus(turned: impl Fn(usize) -> bool, loads: &str) -> String {
    let mut text = "*NODE\n".to_string();
    for (j, i) in (0..=N[1]).flat_map(|j| (0..=N[0]).map(move |i| (j, i))) {
        let [x, y] = place(i, j);
        writeln!(text, "{}, {x:?}, {y:?}, 0.", node(i, j)).unwrap();
    }
    for (k, corners) in elements(&turned).into_iter().enumerate() {
        let set = if turned(k) { "DOWN" } else { "UP" };
        writeln!(text, "*ELEMENT, TYPE=S4, ELSET={set}\n{}, {}", k + 1, words(corners)).unwrap();
    }
    let sets = if (0..N[0] * N[1]).any(&turned) { "UP, DOWN" } else { "UP" };
    let root = (0..=N[1]).map(|j| node(0, j).to_string()).collect::<Vec<_>>().join("\n");
    text + &format!(
        "*ELSET, ELSET=PLATE\n{sets}\n*NSET, NSET=ROOT\n{root}\n*SURFACE, NAME=TOP\nPLATE, SPOS\n*SURFACE, NAME=UNDER\nPLATE, SNEG\n\
         *MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85E-9\n*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL\n2.\n\
         *BOUNDARY\nROOT, 1, 6\n*STEP\n*STATIC\n{loads}*END STEP\n"
    )
}

fn nastran(loads: &str) -> String {
    let mut text = "SOL 101\nCEND\nSPC=1\nLOAD=1\nBEGIN BULK\n".to_string();
    for (j, i) in (0..=N[1]).flat_map(|j| (0..=N[0]).map(move |i| (j, i))) {
        let [x, y] = place(i, j);
        writeln!(text, "GRID,{},,{x:?},{y:?},0.", node(i, j)).unwrap();
    }
    for (k, corners) in elements(|_| false).into_iter().enumerate() {
        writeln!(text, "CQUAD4,{},1,{}", k + 1, words(corners).replace(' ', "")).unwrap();
    }
    for j in 0..=N[1] {
        writeln!(text, "SPC1,1,123456,{}", node(0, j)).unwrap();
    }
    text + loads + "PSHELL,1,1,2.,1,,1\nMAT1,1,210000.,,0.3,7.85-9\nENDDATA\n"
}

/// w \[mm\] in the middle of the free edge, and the deck that the case is exported as.
fn deflection(text: &str, format: Format) -> (f64, stridor::decks::Deck) {
    let read = read_bytes("plate", text.as_bytes(), format).unwrap_or_else(|error| panic!("{error}"));
    let made = convert(&read, Units::named("mm").unwrap()).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(Converted::MESH_FILE), to_msh_exactly(&made.mesh).unwrap()).unwrap();
    std::fs::write(folder.path().join("case.toml"), &made.case).unwrap();
    let case = read_case(&folder.path().join("case.toml")).unwrap();
    let prepared = Prepared::new(&case).unwrap_or_else(|error| panic!("{error}\n{}", made.case));
    let steady = solve_steady(&prepared.system, &SteadyOptions::default(), &()).unwrap();
    let places = prepared.geometry().nodes;
    let is_there = |at: &[f64; 3]| (at[0] - 0.1).abs() < 1e-9 && (at[1] - 0.02).abs() < 1e-9;
    let tip = places.iter().position(is_there).expect("the middle of the edge");
    let w = prepared.assembled.dofs.expand(&steady.displacement)[tip][2];
    (1e3 * w, deck(&prepared).unwrap())
}

#[test]
fn a_plate_bends_to_the_side_that_its_deck_says() {
    let every_third = |k: usize| k.is_multiple_of(3);
    let none = |_: usize| false;
    let pload: String =
        elements(none).into_iter().map(|[a, b, c, d]| format!("PLOAD,1,-.01,{a},{d},{c},{b}\n")).collect();
    let all = N[0] * N[1];
    // The same pressure along +z by each card; SPOS is the face that the normal points out of, and a pressure presses upon it.
    let decks = [
        (abaqus(none, "*DLOAD\nPLATE, P, 0.01\n"), Format::Abaqus),
        (abaqus(none, "*DSLOAD\nTOP, P, -0.01\n"), Format::Abaqus),
        (abaqus(none, "*DSLOAD\nUNDER, P, 0.01\n"), Format::Abaqus),
        (abaqus(|_| true, "*DLOAD\nDOWN, P, -0.01\n").replace("UP, DOWN", "DOWN"), Format::Abaqus),
        (abaqus(every_third, "*DLOAD\nUP, P, 0.01\nDOWN, P, -0.01\n"), Format::Abaqus),
        (nastran(&format!("PLOAD2,1,.01,1,THRU,{all}\n")), Format::Nastran),
        (nastran(&format!("PLOAD4,1,1,.01,,,,THRU,{all}\n")), Format::Nastran),
        (nastran(&pload), Format::Nastran),
    ];
    let (w, own) = deflection(&decks[0].0, decks[0].1);
    assert!(within((w - CALCULIX).abs(), 0.01 * CALCULIX, Discretisation), "{w}");
    for (k, (text, format)) in decks.iter().enumerate().skip(1) {
        let (other, _) = deflection(text, *format);
        assert!(within((other - w).abs(), 1e-9 * w, RoundOff), "deck {k}: {other} {w}");
    }
    // What is exported presses to the same side.
    assert!(
        matches!(&own.loads[0].on, LoadOn::Shells { shells, pressure } if shells.len() == all && *pressure > 0.0)
    );
    for format in [Format::Abaqus, Format::Nastran] {
        let text = write(&own, format).unwrap().text;
        let again = read_bytes("again", text.as_bytes(), format).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            again.loads.iter().map(|load| load.on.clone()).collect::<Vec<_>>(),
            [own.loads[0].on.clone()],
            "{text}"
        );
    }
}
