use super::*;
use crate::bounds::{Origin::*, within};
use crate::job::frf::frfs;
use crate::job::modes::part_modes;
use crate::job::samples::disc;
use crate::linalg::random::Random;
use crate::measured::uff::{Function, RealShape, functions_file, modes_text};
use std::path::Path;

const MODES: &str = "[modes.disc]\nbelow = \"1.6 kHz\"\n[damping]\nmodal_ratio = 0.003\n";
/// The frame of the test: turned, and away from the mesh's.
const ORIGIN: [f64; 3] = [0.2, -0.1, 0.3];
const X: [f64; 3] = [0.6, 0.8, 0.0];
const Y: [f64; 3] = [0.0, 0.0, -1.0];

fn case(extra: &str, folder: &Path) -> Case {
    Case::parse("disc", &(disc(5, 32) + MODES + extra), folder.into()).unwrap()
}

fn transform(unit: &str) -> String {
    format!("transform = {{ origin = {ORIGIN:?}, x_axis = {X:?}, y_axis = {Y:?}, unit = \"{unit}\" }}\n")
}

/// `x` of the mesh in the frame of the test.
fn seen(x: [f64; 3], point: bool) -> [f64; 3] {
    let frame = Frame::new(ORIGIN, X, Y);
    let origin = if point { frame.point([0.0; 3]) } else { [0.0; 3] };
    let rest = [0, 1, 2].map(|k| x[k] - origin[k]);
    let unit = |axis: usize| [0, 1, 2].map(|k| f64::from(k == axis));
    [0, 1, 2].map(|axis| dot(frame.direction(unit(axis)), rest))
}

#[test]
fn a_test_made_of_the_models_own_modes_is_found_again() {
    let dir = tempfile::tempdir().unwrap();
    let plain = case("", dir.path());
    let prepared = Prepared::new(&plain).unwrap();
    let named = part_modes(&prepared, "disc", &()).unwrap();
    assert!(named.damping_ratio.iter().all(|z| *z == 0.003));
    // Every seventh node, 0.4 mm beside its place along the disc's axis, in mm; noise of 3 % of the largest motion.
    let nodes = &prepared.model.nodes;
    let labels: Vec<usize> = (0..nodes.len()).step_by(7).collect();
    let points = labels.iter().map(|k| {
        let [x, y, z] = nodes[*k];
        (*k as u64 + 100, seen([x + 4e-4, y, z], true).map(|c| 1e3 * c))
    });
    let mut random = Random::new();
    let mut motions = Vec::new();
    for k in 0..named.modes.len() {
        // Of double modes one that lies between them, as a test may find it.
        let partner = if k % 2 == 0 { k } else { k - 1 };
        let double = named.names[k] == named.names[partner];
        let (shape, second) = (named.shape(k), named.shape(partner));
        let largest = shape.iter().map(|u| u[0].abs()).fold(0.0, f64::max);
        let motion: Vec<(u64, [f64; 3])> = labels
            .iter()
            .map(|n| {
                let own = shape[*n];
                let other = if double { second[*n] } else { own };
                let sum = [0, 1, 2].map(|axis| 0.8 * own[axis] + 0.6 * other[axis]);
                let noisy = [sum[0] + 0.03 * largest * random.next(), sum[1], sum[2]];
                (*n as u64 + 100, seen(noisy, false))
            })
            .collect();
        motions.push(motion);
    }
    let modes = motions.into_iter().enumerate().map(|(k, motion)| RealShape {
        number: k + 1,
        frequency_hz: named.modes.frequency_hz(k),
        modal_mass: 1.0,
        damping_ratio: 0.004,
        motion: Box::new(motion.into_iter()),
    });
    let text = modes_text("synthetic", points, std::iter::empty(), modes);
    // Without its units: the case says mm.
    let bare = &text[text.find("    -1\n  2411\n").unwrap()..];
    std::fs::write(dir.path().join("test.uff"), bare).unwrap();
    let measured =
        format!("[measured.own]\nof = \"disc\"\nfile = \"test.uff\"\nreach = \"1 mm\"\n{}", transform("mm"));
    let with = case(&measured, dir.path());
    let prepared = Prepared::new(&with).unwrap();
    let tests = Tests::of_modes(&prepared).unwrap();
    assert!(tests.warnings.is_empty(), "{:?}", tests.warnings);
    let all = tests.modes(&with.modes["disc"], &named);
    let comparison = &all[0];
    let placed = comparison.placed.unwrap();
    assert!(
        within((placed.largest - 4e-4).abs(), 1e-6, Reference)
            && within((placed.mean - 4e-4).abs(), 1e-6, Reference),
        "{placed:?}"
    );
    assert_eq!(placed.points, labels.len());
    assert_eq!(comparison.rows.len(), named.modes.len());
    for (k, row) in comparison.rows.iter().enumerate() {
        let mode = row.mode.unwrap();
        assert_eq!(comparison.level_of(mode), comparison.level_of(k));
        assert!(row.mac.unwrap() > 0.99, "{k}: {row:?}");
        // Written with six digits.
        assert!(within((named.modes.frequency_hz(mode) / row.frequency_hz - 1.0).abs(), 1e-5, Reference));
        assert_eq!((row.damping_ratio, row.deviation), (Some(0.004), Some(0.005)));
    }
    assert!(comparison.computed_alone().is_empty());
    // Shapes of other levels are far from alike.
    let alike = &comparison.mac[0];
    assert!(alike[1..].iter().all(|like| *like < 0.2), "{alike:?}");
    // In metres the points lie off the mesh: each is reported, up to ten, and how many more.
    let far = case(&measured.replace("unit = \"mm\"", "unit = \"m\""), dir.path());
    let far_prepared = Prepared::new(&far).unwrap();
    let said = Tests::of_modes(&far_prepared).err().unwrap().to_string();
    assert!(said.contains("point 100 at") && said.contains("points more beyond"), "{said}");
}

#[test]
fn frequencies_of_the_case_are_paired_and_what_is_left_is_told() {
    let text = "[modes.plain]\ncount = 4\nmeasured = [200, 5000]\n[measured.list]\nof = \"disc\"\nfrequencies = [250, 560]\ndamping_ratios = [0.001, 0.002]\n";
    let case = case(text, Path::new("."));
    let prepared = Prepared::new(&case).unwrap();
    let tests = Tests::of_modes(&prepared).unwrap();
    let named = part_modes(&prepared, "disc", &()).unwrap();
    let all = tests.modes(&case.modes["disc"], &named);
    assert!(all.len() == 1 && all[0].set == "disc" && all[0].placed.is_none());
    assert!(all[0].rows.iter().all(|row| row.mode.is_some() && row.mac.is_none()));
    let alone = all[0].computed_alone();
    assert!(
        !alone.is_empty()
            && alone.iter().all(|level| !all[0].rows.iter().any(|r| level.contains(&r.mode.unwrap())))
    );
    let plain = part_modes(&prepared, "plain", &()).unwrap();
    let short = tests.modes(&case.modes["plain"], &plain);
    assert!(short[0].rows[0].mode.is_some() && short[0].rows[1].mode.is_none());
}

#[test]
fn measured_responses_stand_beside_computed_ones_at_their_own_frequencies() {
    let dir = tempfile::tempdir().unwrap();
    let frf = "[frf.hammer]\nexcitation = { at = [0, 0, \"75 mm\"], direction = [1, 0, 0] }\n\
               response.inside = { at = [0, \"40 mm\", 0], direction = [1, 0, 0] }\n\
               response.rim = { at = [0, \"75 mm\", 0], direction = [1, 0, 0] }\nband = [\"50 Hz\", \"1 kHz\"]\n";
    // What the model itself answers, as mobility, with force and motion changed and one of them against its axis.
    let first = case(frf, dir.path());
    let prepared = Prepared::new(&first).unwrap();
    let mut responses = frfs(&prepared).unwrap();
    let hz: Vec<f64> = (0..60).map(|k| 40.0 + 7.0 * f64::from(k)).collect();
    let answer = responses[0].also_at(0, hz.clone());
    let (_, beside) = responses[0].run(&prepared, (None, None), &()).unwrap();
    let values: Vec<c64> =
        hz.iter().zip(&beside[answer]).map(|(hz, h)| -Quantity::Mobility.factor(*hz) * h).collect();
    let force = seen(responses[0].force().at, true);
    let motion = seen(responses[0].seen()[0].1.at, true);
    // A frame in which the mesh's x is one of the axes.
    let points = [(1, motion), (2, force), (3, [0.0; 3])];
    let function = |excitation: (u64, i64), response: (u64, i64)| Function {
        title: ["own", "NONE"],
        quantity: Quantity::Mobility,
        excitation,
        response,
        frequencies_hz: &hz,
        values: &values,
    };
    // Directions that the test does not state are those of the case; the first is turned by its sign below.
    let functions = [function((1, 0), (2, 0)), function((3, 1), (2, 1))];
    let file = functions_file(points.into_iter(), functions.into_iter(), false);
    std::fs::write(dir.path().join("test.unv"), file).unwrap();
    let measured = format!("[measured.own]\nfrf = \"hammer\"\nfile = \"test.unv\"\n{}", transform("m"));
    let with = case(&(frf.to_string() + &measured), dir.path());
    let prepared = Prepared::new(&with).unwrap();
    let mut responses = frfs(&prepared).unwrap();
    let tests = Tests::of_responses(&prepared, &mut responses).unwrap();
    let (computed, beside) = responses[0].run(&prepared, (None, None), &()).unwrap();
    let all = tests.responses(&computed, &beside);
    let [pair] = &all[0].pairs[..] else { panic!("one pair: {:?}", all[0].measured_alone) };
    assert!(pair.swapped && pair.place == "inside" && pair.quantity == Quantity::Mobility);
    // From the band's first frequency on.
    assert_eq!(pair.frequencies_hz[0], 54.0);
    assert!(within((pair.assurance - 1.0).abs(), 1e-9, Reference), "{}", pair.assurance);
    let opposite = pair
        .measured
        .iter()
        .zip(&pair.computed)
        .all(|(a, b)| within((a + b).norm(), 1e-6 * b.norm(), Reference));
    assert!(opposite, "the sign stays where no direction is stated");
    assert_eq!(all[0].computed_alone, ["rim"]);
    assert!(
        all[0].measured_alone.len() == 1 && all[0].measured_alone[0].starts_with("own, 2+x/3+x: no response")
    );
}
