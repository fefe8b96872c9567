use super::super::modes::part_modes;
use super::super::samples::disc;
use super::facts::measurements;
use super::model::CaseModel;
use super::*;
use crate::bounds::{Origin::*, within};
use crate::calibration::CalibrationModel;
use crate::linalg::random::Random;
use std::fmt::Write;
use std::path::Path;

const ASKED: &str =
    "[modes.disc]\nbelow = \"3 kHz\"\n[measured.tap]\nof = \"disc\"\nfile = \"tap.toml\"\nreach = \"8 mm\"\n";
const HUB: &str =
    "[calibrate.parameter.hub]\npath = \"mesh.annulus.hub_radius\"\nbetween = [\"10 mm\", \"22 mm\"]\n";
const SCALE: &str = "[calibrate.parameter.scale]\npath = \"modes.disc.frequency_scale\"\nbetween = [0.9, 1.1]\nexpected = 1.0\n";

/// A test of the disc with a hub of 18.5 mm and frequencies 3 % lower than computed, at every seventh node and `away`
/// \[m\] beside it: for each of `modes` (nodal diameters, circles, turn of a double mode \[rad\]) its frequency and its shape,
/// each component with a normally distributed error of `noise` times the root mean square.
fn test_file(modes: &[(usize, usize, f64)], noise: f64, away: f64) -> String {
    let text = disc(5, 32).replace("15 mm", "18.5 mm") + "[modes.disc]\nbelow = \"3 kHz\"\n";
    let case = Case::parse("made.toml", &text, ".".into()).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let named = part_modes(&prepared, "disc", &()).unwrap();
    let shapes: Vec<_> = (0..named.modes.len()).map(|k| named.shape(k)).collect();
    let nodes: Vec<usize> = (0..prepared.model.nodes.len()).step_by(7).collect();
    let mut random = Random::new();
    // A sum of twelve: normal to three standard deviations.
    let mut normal = || (0..12).map(|_| 0.5 * random.next()).sum::<f64>();
    let mut file = String::new();
    for node in &nodes {
        let [x, y, z] = prepared.model.nodes[*node];
        writeln!(file, "point.{} = [{x}, {}, {z}]", node + 1, y + away).unwrap();
    }
    for (k, (n, s, turn)) in modes.iter().enumerate() {
        let own =
            |i: &usize| named.names[*i].is_some_and(|m| (m.nodal_diameters, m.nodal_circles) == (*n, *s));
        let level: Vec<usize> = (0..named.modes.len()).filter(own).collect();
        let part = |node: usize| -> f64 {
            let of = |i: usize| {
                let [ux, _, _, _, _, rz] = shapes[i][node];
                // The point moves along x with the node and its rotation about z.
                ux - rz * away
            };
            match level[..] {
                [i, j] => turn.cos() * of(i) + turn.sin() * of(j),
                _ => of(level[0]),
            }
        };
        let motion: Vec<f64> = nodes.iter().map(|node| part(*node)).collect();
        let size = (motion.iter().map(|u| u * u).sum::<f64>() / motion.len() as f64).sqrt();
        let hz = 0.97 * named.modes.frequency_hz(level[0]);
        writeln!(file, "[mode.m{k}]\nfrequency = {hz}").unwrap();
        for (node, u) in nodes.iter().zip(&motion) {
            writeln!(file, "shape.{} = [{}, 0, 0]", node + 1, u + noise * size * normal()).unwrap();
        }
    }
    file
}

fn case(folder: &Path, file: &str, more: &str) -> Case {
    std::fs::write(folder.join("tap.toml"), file).unwrap();
    Case::parse("case.toml", &format!("{}{ASKED}{more}", disc(5, 32)), folder.into()).unwrap()
}

fn calibrated(case: &Case) -> CalibrationResult {
    let prepared = Prepared::new(case).unwrap();
    Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).unwrap().run(&()).unwrap()
}

#[test]
fn what_a_test_sees_turns_as_differences_do_of_double_modes_too() {
    let dir = tempfile::tempdir().unwrap();
    let file = test_file(&[(2, 0, 0.3), (0, 1, 0.0), (1, 0, 0.7), (3, 0, 1.1)], 0.2, 1e-3);
    let more = format!(
        "[calibrate]\nagainst = \"tap\"\n{HUB}[calibrate.parameter.thickness]\npath = \"shell.disc.thickness\"\n\
         between = [\"0.8 mm\", \"1.2 mm\"]\nlog = true\n[calibrate.parameter.poisson]\n\
         path = \"material.steel.poissons_ratio\"\nbetween = [0.2, 0.4]\n\
         [calibrate.parameter.twist]\npath = \"spring.twist.stiffness\"\nbetween = [0.5, 100.5]\n\
         [spring.twist]\non = \"rim\"\ndirection = [0, 1, 0]\nrotational = true\nstiffness = 1.0\n\
         [spring.push]\non = \"rim\"\ndirection = [1, 0, 0]\nstiffness = \"1 kN/m\"\n"
    );
    let case = case(dir.path(), &file, &more);
    let prepared = Prepared::new(&case).unwrap();
    let coordinates: Vec<Coordinate> =
        case.calibrate.as_ref().unwrap().parameter.values().map(Coordinate::new).collect();
    let measured = measurements(&prepared).unwrap();
    let model = CaseModel::new(&prepared, &coordinates, &measured).unwrap();
    let shapes: Vec<_> = measured.modes[0].modes.iter().filter_map(|mode| mode.shape.clone()).collect();
    // Every shape beside every level that it is somewhat like.
    let rests = |x: &[f64]| -> Vec<Vec<f64>> {
        let levels = model.compute(x).unwrap().levels;
        let spans = levels.iter().flatten().filter_map(|level| level.span.as_ref());
        spans
            .flat_map(|span| shapes.iter().map(|shape| span.apart(shape).rest.iter().copied().collect()))
            .collect()
    };
    let here: Vec<_> = model
        .compute(model.start())
        .unwrap()
        .levels
        .into_iter()
        .flatten()
        .filter_map(|level| level.span)
        .collect();
    assert!(here.len() >= 4 && here.iter().filter(|span| span.dimension() == 2).count() >= 2);
    for (j, name) in ["hub", "poisson", "thickness", "twist"].iter().enumerate() {
        // Far apart: the error of the modes, 1e-9 of the shapes and another on every processor, comes divided by h.
        let h = if j == 3 { 1e-3 } else { 2e-2 };
        let at = |k: f64| {
            let mut x = model.start().to_vec();
            x[j] += k * h;
            rests(&x)
        };
        let around = [1.0, -1.0, 2.0, -2.0].map(at);
        let slopes =
            here.iter().flat_map(|span| shapes.iter().map(|shape| span.apart(shape).slopes[j].clone()));
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        for (k, slope) in slopes.enumerate() {
            let [up, down, up2, down2] = [0, 1, 2, 3].map(|side| &around[side][k]);
            for (i, own) in slope.iter().enumerate() {
                let expected = (8.0 * (up[i] - down[i]) - (up2[i] - down2[i])) / (12.0 * h);
                largest = largest.max(expected.abs());
                worst = worst.max((own - expected).abs());
            }
        }
        assert!(
            largest > 1e-3 && within(worst, 3e-6 * largest, Reference),
            "{name}: {worst:e} of {largest:e}"
        );
    }
}

#[test]
fn a_shape_tells_what_one_frequency_leaves_open() {
    let dir = tempfile::tempdir().unwrap();
    let file = test_file(&[(2, 0, 0.4)], 0.0, 0.0);
    let asked = format!("[calibrate]\nagainst = \"tap\"\nmode_reach = 0.3\nSHAPES\n{HUB}{SCALE}");
    let found = calibrated(&case(dir.path(), &file, &asked.replace("SHAPES", "")));
    assert_eq!(found.data[0].level, "disc (2, 0)");
    // The fit ends where χ² may still fall by 1e-10.
    let best = found.calibration.best();
    assert!(
        best.fit.converged && within(best.fit.chi2, 1e-9, Tolerance) && found.calibration.ranked.len() == 1
    );
    for (number, truth) in found.numbers.iter().zip([0.0185, 0.97]) {
        assert!(
            within((number.after / truth - 1.0).abs(), 5e-6, Tolerance),
            "{} {}",
            number.name,
            number.after
        );
    }
    let shape = found.data[0].shape.unwrap();
    assert!(
        within(1.0 - shape.after.unwrap(), 1e-12, Tolerance) && shape.before.unwrap() < shape.after.unwrap()
    );
    let known = &found.calibration.knowledge;
    // One frequency and the components of a shape, less two scales and two numbers.
    assert_eq!((known.determined(), known.freedom), (2, 1 + shape.components - 4));
    // The frequency alone says one thing of the two, and fits several modes.
    let alone = calibrated(&case(dir.path(), &file, &asked.replace("SHAPES", "shapes = false")));
    assert!(alone.calibration.knowledge.determined() == 1 && alone.calibration.ranked.len() > 1);
    assert!(alone.data[0].shape.is_none());
}

#[test]
fn noisy_shapes_lead_to_the_truth_within_what_they_say() {
    let dir = tempfile::tempdir().unwrap();
    // Both modes of a double level, a single one, and another double one.
    let file = test_file(&[(2, 0, 0.4), (2, 0, 1.9), (0, 1, 0.0), (3, 0, 0.1)], 0.03, 0.0);
    let asked = format!(
        "shape_deviation = 0.03\n[calibrate]\nagainst = \"tap\"\nchance_draws = 50\ntrials = 100\n{HUB}{SCALE}"
    );
    let found = calibrated(&case(dir.path(), &file, &asked));
    let levels: Vec<&str> = found.data.iter().map(|datum| datum.level.as_str()).collect();
    let mut sorted = levels.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, ["disc (0, 1)", "disc (2, 0)", "disc (2, 0)", "disc (3, 0)"]);
    for (number, truth) in found.numbers.iter().zip([0.0185, 0.97]) {
        assert!(number.interval[0] < truth && truth < number.interval[1] && !number.at_bound, "{number:?}");
        assert!(number.interval[1] / number.interval[0] < 1.05, "{number:?}");
    }
    let known = &found.calibration.knowledge;
    // Four standard deviations of χ²/n.
    let bound = 4.0 * (2.0 / known.freedom as f64).sqrt();
    assert!(within((known.reduced_chi2.unwrap() - 1.0).abs(), bound, RandomSample), "{known:?}");
    for datum in &found.data {
        let shape = datum.shape.unwrap();
        assert!(shape.after.unwrap() > 0.998 && shape.left_out.unwrap() > 0.99, "{datum:?}");
    }
    let trials = found.calibration.trials.as_ref().unwrap();
    assert!(trials.converged == 100 && trials.model_error < 0.1, "{trials:?}");
    assert!(trials.covered.iter().all(|covered| (88..=100).contains(covered)), "{trials:?}");
}

#[test]
fn wrong_shapes_are_told_before_anything_is_computed() {
    let dir = tempfile::tempdir().unwrap();
    let file = test_file(&[(2, 0, 0.4)], 0.0, 0.0);
    let said = |file: &str, before: &str, calibrate: &str| {
        let more = format!("{before}[calibrate]\nagainst = \"tap\"\n{calibrate}{HUB}");
        let case = case(dir.path(), file, &more);
        let prepared = Prepared::new(&case).unwrap();
        let refused = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).err().unwrap();
        assert_eq!(refused.exit_code(), 2);
        refused.to_string()
    };
    let without = "[mode.a]\nfrequency = 330\n";
    let deviation = "shape_deviation = 0.05\n";
    let text = said(without, deviation, "");
    assert!(text.contains("measured.tap.shape_deviation") && text.contains("no mode with a shape"), "{text}");
    assert!(said(&file, deviation, "shapes = false\n").contains("`shapes = false`"));
    let far = said(&file, "transform = { origin = [\"30 mm\", 0, 0] }\n", "");
    assert!(far.contains("points more beyond `reach`"), "{far}");
}

#[test]
fn shapes_decide_between_assignments_that_frequencies_leave_alike() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/calibrate-shapes");
    let text = include_str!("../../../validation/calibrate-shapes/case.toml");
    let text =
        text.replace("radial = 32\naround = 96", "radial = 24\naround = 72").replace("trials = 100", "");
    let with = |shapes: bool| {
        let text = text.replace("[calibrate]\n", &format!("[calibrate]\nshapes = {shapes}\n"));
        let text = if shapes { text } else { text.replace("shape_deviation = 0.03", "") };
        calibrated(&Case::parse("case.toml", &text, folder.clone()).unwrap())
    };
    let (with, alone) = (with(true), with(false));
    // Each pair of neighbours between 1.7 and 2.3 kHz fits with a hub and a scale of its own.
    let as_good =
        |found: &CalibrationResult| found.calibration.ranked.iter().filter(|r| r.weight > 0.1).count();
    assert!(as_good(&alone) >= 2 && as_good(&with) == 1, "{} {}", as_good(&alone), as_good(&with));
    let levels: Vec<&str> = with.data.iter().map(|datum| datum.level.as_str()).collect();
    assert_eq!(levels, ["disc (0, 1)", "disc (1, 1)"]);
    for (number, truth) in with.numbers.iter().zip([0.0224, 0.973]) {
        assert!(
            within((number.after / truth - 1.0).abs(), 0.02, RandomSample),
            "{} {}",
            number.name,
            number.after
        );
    }
    assert!(with.least_mac(|shape| shape.after).unwrap() > 0.998);
}
