use super::super::samples::disc;
use super::coordinate::Coordinate;
use super::facts::{MeasuredModeSet, measurements};
use super::model::CaseModel;
use super::neighbours::Neighbour;
use super::*;
use crate::bounds::{Origin::*, least, within};
use crate::calibration::{CalibrationModel, Level};
use crate::case::Case;
use crate::linalg::SparseMatrix;
use crate::linalg::random::Random;
use crate::linalg::sparse::{add_scaled, diagonal};

fn case(more: &str) -> Case {
    let text = format!("{}{more}", disc(5, 32));
    Case::parse("case.toml", &text, ".".into()).unwrap()
}

/// Runs `work` on the model of a case with `[calibrate]`.
fn with_model<T>(case: &Case, work: impl FnOnce(&CaseModel) -> T) -> T {
    let prepared = Prepared::new(case).unwrap();
    let coordinates: Vec<Coordinate> =
        case.calibrate.as_ref().unwrap().parameter.values().map(Coordinate::new).collect();
    work(&CaseModel::new(&prepared, &coordinates, &measurements(&prepared).unwrap()).unwrap())
}

const SIX: &str = "[modes.disc]\nbelow = \"3 kHz\"\nmeasured = [450, 900]\n[calibrate]\nagainst = \"disc\"\n\
    [calibrate.parameter.hub]\npath = \"mesh.annulus.hub_radius\"\nbetween = [\"10 mm\", \"20 mm\"]\n\
    [calibrate.parameter.thickness]\npath = \"shell.disc.thickness\"\nbetween = [\"0.8 mm\", \"1.2 mm\"]\nlog = true\n\
    [calibrate.parameter.poisson]\npath = \"material.steel.poissons_ratio\"\nbetween = [0.25, 0.35]\n\
    deviation = 0.01\nexpected = 0.29\n\
    [calibrate.parameter.scale]\npath = \"modes.disc.frequency_scale\"\nbetween = [0.9, 1.1]\n\
    [calibrate.parameter.twist]\npath = \"spring.twist.stiffness\"\nbetween = [0.001, 100.001]\n\
    [spring.twist]\non = \"rim\"\ndirection = [0, 1, 0]\nrotational = true\nstiffness = 0.01\n";

/// ∂ ln f/∂x by (4 D(h) − D(2h))/3.
fn differences(model: &CaseModel, j: usize, h: f64) -> Vec<f64> {
    let at = |k: f64| -> Vec<f64> {
        let mut x = model.start().to_vec();
        x[j] += k * h;
        model.compute(&x).unwrap().levels.iter().map(|l| l.as_ref().unwrap().frequency_hz.ln()).collect()
    };
    let [up, down, up2, down2] = [1.0, -1.0, 2.0, -2.0].map(at);
    (0..up.len()).map(|l| (8.0 * (up[l] - down[l]) - (up2[l] - down2[l])) / (12.0 * h)).collect()
}

#[test]
fn one_sided_derivatives_are_those_of_both_sides() {
    let case = case(SIX);
    let from = |lowest: f64, highest: f64| {
        let build = |thickness: f64| {
            if !(lowest..=highest).contains(&thickness) {
                return Err(Error::input(Fault::new("thickness", "another", "one inside")));
            }
            let case = case.with_parameter("shell.disc.thickness", thickness)?;
            Ok(vec![Neighbour { assembled: Prepared::new(&case)?.assembled, seen: Vec::new() }])
        };
        super::neighbours::derivatives(1e-3, 1e-6, &build).map(|mut all| all.remove(0))
    };
    let (both, up, down) = (from(0.0, 1.0).unwrap(), from(1e-3, 1.0).unwrap(), from(0.0, 1e-3).unwrap());
    for one in [up, down] {
        for (a, b) in [(&one.stiffness, &both.stiffness), (&one.mass, &both.mass)] {
            let size = b.val().iter().fold(0.0f64, |m, v| m.max(v.abs()));
            assert!(a.val().iter().zip(b.val()).all(|(a, b)| within(
                (a - b).abs(),
                1e-8 * size,
                Discretisation
            )));
        }
    }
    assert_eq!(from(1e-3, 1e-3).err().unwrap().exit_code(), 2);
}

/// K is proportional to E and M to the density, whatever the theory and the thickness; what does not depend on the value changes
/// by rounding only; and a weak spring has the derivative of a spring, however stiff the rest is.
#[test]
fn derivatives_are_those_of_proportional_matrices_and_of_weak_springs() {
    let mut random = Random::seeded(31);
    for k in 0..16 {
        let theory = ["kirchhoff", "mindlin"][k % 2];
        let thickness = 10f64.powf(random.between(-4.5, -1.7));
        let (e, spring) = (random.between(1e8, 4e11), 10f64.powf(random.between(-3.0, 3.0)));
        let more = format!(
            "[spring.weak]\non = \"rim\"\ndirection = [1, 0, 0]\nstiffness = {spring:e}\n[modes.disc]\nbelow = \"1 kHz\"\n"
        );
        let text = (disc(3, 16) + &more)
            .replace("thickness = \"1 mm\"", &format!("thickness = {thickness:e}\ntheory = \"{theory}\""))
            .replace("\"210 GPa\"", &format!("{e:e}"));
        let case = Case::parse("case.toml", &text, ".".into()).unwrap();
        let here = Prepared::new(&case).unwrap().assembled;
        let (stiffness, mass) = (&here.structure.stiffness, &here.structure.mass);
        let change = |path: &str| {
            let value = case.parameter(path).unwrap().value;
            let build = |value: f64| {
                let case = case.with_parameter(path, value)?;
                Ok(vec![Neighbour { assembled: Prepared::new(&case)?.assembled, seen: Vec::new() }])
            };
            let found = super::neighbours::derivatives(value, 1e-3 * value, &build);
            found.unwrap_or_else(|error| panic!("{theory} {thickness:e} {path}: {error}")).remove(0)
        };
        // The largest entry of value · derivative − exact against the diagonal of `like`, to be rounding over the step.
        let off = |derivative: &SparseMatrix, value: f64, exact: f64, like: &SparseMatrix| {
            let (off, d) = (add_scaled(&[(value, derivative), (-exact, like)]), diagonal(like));
            let column =
                |j: usize| off.row_idx_of_col(j).zip(off.val_of_col(j)).map(move |(i, v)| (i, j, *v));
            let part = |(i, j, v): (usize, usize, f64)| v.abs() / (d[i] * d[j]).sqrt();
            (0..off.ncols()).flat_map(column).map(part).fold(0.0, f64::max)
        };
        let by_e = change("material.steel.youngs_modulus");
        let by_density = change("material.steel.density");
        let rest = add_scaled(&[(1.0, stiffness), (-spring, &change("spring.weak.stiffness").stiffness)]);
        for (name, off) in [
            ("∂K/∂E", off(&by_e.stiffness, e, 1.0, &rest)),
            ("∂M/∂E", off(&by_e.mass, e, 0.0, mass)),
            ("∂M/∂ρ", off(&by_density.mass, 7850.0, 1.0, mass)),
            ("∂K/∂ρ", off(&by_density.stiffness, 7850.0, 0.0, stiffness)),
        ] {
            assert!(within(off, 1e-11, RoundOff), "{theory} {thickness:e} {name}: {off:e}");
        }
        // One spring, shared by the nodes of the rim: all of its entries together are 1, within rounding of K over the step.
        let sum: f64 = change("spring.weak.stiffness").stiffness.val().iter().sum();
        let largest = diagonal(stiffness).into_iter().fold(0.0, f64::max);
        let rounding = 16.0 * 16.0 * f64::EPSILON * largest / (1e-3 * spring);
        assert!(
            within((sum - 1.0).abs(), 1e-11 + rounding, RoundOff),
            "{theory} {thickness:e} {spring:e}: {sum}"
        );
    }
}

/// Young's modulus follows from frequencies, f ∝ √E, by either theory of plates, held and free.
#[test]
fn youngs_modulus_of_a_plate_that_was_made_is_found_again() {
    let mut random = Random::seeded(32);
    for k in 0..4 {
        let theory = ["mindlin", "kirchhoff"][k / 3];
        let (thickness, made) = (random.between(1.0, 12.0), random.between(160.0, 250.0));
        let held = k % 2 == 0;
        let mut text = disc(3, 22).replace(
            "thickness = \"1 mm\"",
            &format!("thickness = \"{thickness} mm\"\ntheory = \"{theory}\""),
        ) + "[modes.disc]\nbelow = BELOW\nfree = FREE\nmeasured = MEASURED\n[calibrate]\nagainst = \"disc\"\n\
               trials = 2\nchance_draws = 20\n[calibrate.parameter.E]\npath = \"material.steel.youngs_modulus\"\n\
               between = [\"150 GPa\", \"260 GPa\"]\n";
        text = text
            .replace("FREE", if held { "false" } else { "true" })
            .replace("BELOW", &(2.5e3 * thickness).to_string());
        let parse = |measured: &[f64]| {
            Case::parse("case.toml", &text.replace("MEASURED", &format!("{measured:?}")), ".".into()).unwrap()
        };
        let named = parse(&[1.0]).with_parameter("material.steel.youngs_modulus", made * 1e9).unwrap();
        let named = super::super::modes::part_modes(&Prepared::new(&named).unwrap(), "disc", &()).unwrap();
        let all = (named.modes.rigid_bodies..named.modes.len()).map(|k| named.modes.frequency_hz(k));
        let mut measured: Vec<f64> = all.collect();
        measured.dedup_by(|a, b| *a < 1.001 * *b);
        measured.truncate(5);
        let case = parse(&measured);
        let prepared = Prepared::new(&case).unwrap();
        let found = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).unwrap().run(&());
        let found = found.unwrap_or_else(|error| panic!("{theory} {thickness} {held}: {error}"));
        let after = found.numbers[0].after;
        assert!(
            within((after / (made * 1e9) - 1.0).abs(), 1e-6, Tolerance),
            "{theory} {thickness} {held}: {after:e} for {made}"
        );
    }
}

#[test]
fn slopes_are_those_of_differences_of_frequencies_of_double_modes_too() {
    let case = case(SIX);
    with_model(&case, |model| {
        let levels: Vec<Level> = model.compute(model.start()).unwrap().levels.into_iter().flatten().collect();
        let names = model.level_names();
        let set = &model.sets[0];
        let double = set.levels.iter().filter(|level| level.len() == 2).count();
        assert!(double >= 3 && double < levels.len(), "{names:?}");
        // In the order of the names: hub, poisson, scale, thickness, twist.
        for j in 0..5 {
            let expected = differences(model, j, if j == 4 { 4e-5 } else { 4e-3 });
            let largest = expected.iter().fold(0.0f64, |m, s| m.max(s.abs()));
            assert!(largest > 1e-3);
            for (k, level) in levels.iter().enumerate() {
                let error = (level.slope[j] - expected[k]).abs();
                assert!(
                    within(error, 1e-6 * largest, Reference),
                    "{} by {j}: {} {}",
                    names[k],
                    level.slope[j],
                    expected[k]
                );
                // What keeps the disc round splits no double mode; springs that resist turning about y do.
                let split = level.split[j].abs();
                let splits = j == 4 && set.levels[k].len() == 2 && names[k].contains("(1, ");
                assert_eq!(splits, split > 1e-4 * largest, "{} by {j}: {split}", names[k]);
            }
        }
    });
}

#[test]
fn a_double_mode_parts_as_its_split_says() {
    let text = SIX.replace("stiffness = 0.01\n", "stiffness = 0.03\n");
    let (round, twisted) = (case(SIX), case(&text));
    let pair = |case: &Case| {
        with_model(case, |model| {
            let set = &model.sets[0];
            let k = set.names.iter().position(|name| name == "disc (1, 0)").unwrap();
            (model.compute(model.start()).unwrap().levels[k].clone().unwrap(), set.levels[k].clone())
        })
    };
    let (level, modes) = pair(&round);
    assert_eq!(modes.len(), 2);
    let prepared = Prepared::new(&twisted).unwrap();
    let named = super::super::modes::part_modes(&prepared, "disc", &()).unwrap();
    let [a, b] = [modes[0], modes[1]].map(|k| named.modes.frequency_hz(k).ln());
    // One unknown is 50 N m: half of the width of its bounds.
    assert!(
        within((0.5 * (b - a) / (0.03 / 50.0) / level.split[4] - 1.0).abs(), 1e-3, Theory),
        "{b} {a} {level:?}"
    );
    let mean = 0.5 * (a + b) - level.frequency_hz.ln();
    assert!(within((mean / (0.02 / 50.0) / level.slope[4] - 1.0).abs(), 1e-3, Theory), "{mean} {level:?}");
}

/// Frequencies that a disc with another hub and another thickness would have.
const MADE: &str = "[modes.disc]\nbelow = \"3 kHz\"\nmeasured = MEASURED\n[calibrate]\nagainst = \"disc\"\n\
    deviation = 0.003\ntrials = 20\nchance_draws = 100\n\
    [calibrate.parameter.hub]\npath = \"mesh.annulus.hub_radius\"\nbetween = [\"10 mm\", \"22 mm\"]\n\
    [calibrate.parameter.thickness]\npath = \"shell.disc.thickness\"\nbetween = [\"0.8 mm\", \"1.2 mm\"]\n";

#[test]
fn a_disc_that_was_made_is_found_again() {
    let made = case(&MADE.replace("MEASURED", "[1]"))
        .with_parameter("mesh.annulus.hub_radius", 0.0185)
        .and_then(|case| case.with_parameter("shell.disc.thickness", 0.97e-3))
        .unwrap();
    let named = super::super::modes::part_modes(&Prepared::new(&made).unwrap(), "disc", &()).unwrap();
    let hz = |n: usize, s: usize| {
        let at = |k: &usize| named.names[*k].is_some_and(|m| (m.nodal_diameters, m.nodal_circles) == (n, s));
        named.modes.frequency_hz((0..named.modes.len()).find(at).unwrap())
    };
    let noise = [1.002, 0.998, 1.001, 0.9995];
    let wanted = [(2, 0), (4, 0), (0, 1), (3, 1)];
    let measured: Vec<f64> = wanted.iter().zip(noise).map(|((n, s), e)| e * hz(*n, *s)).collect();
    let case = case(&MADE.replace("MEASURED", &format!("{measured:?}")));
    let prepared = Prepared::new(&case).unwrap();
    let calibrate = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).unwrap();
    let found = calibrate.run(&()).unwrap();
    for (datum, (n, s)) in found.data.iter().zip(wanted) {
        assert_eq!(datum.level, format!("disc ({n}, {s})"));
    }
    for (number, truth) in found.numbers.iter().zip([0.0185, 0.97e-3]) {
        assert!(number.interval[0] < truth && truth < number.interval[1] && !number.at_bound, "{number:?}");
    }
    let best = found.calibration.best();
    assert!(
        best.fit.converged && best.fit.chi2 < 6.0 && found.largest_percent(|d| d.after_hz).unwrap() < 0.5
    );
    let trials = found.calibration.trials.as_ref().unwrap();
    assert!(trials.converged == 20 && trials.covered.iter().all(|covered| *covered >= 17), "{trials:?}");
    // The calibrated case loads as a case, and has the modes that were promised.
    let again = Case::parse("calibrated.toml", &found.calibrated_case, "elsewhere".into()).unwrap();
    assert_eq!(again.parameter("mesh.annulus.hub_radius").unwrap().value, found.numbers[0].after);
    let named = super::super::modes::part_modes(&Prepared::new(&again).unwrap(), "disc", &()).unwrap();
    let after = found.data[0].after_hz.unwrap();
    let off = least((0..named.modes.len()).map(|k| (named.modes.frequency_hz(k) / after - 1.0).abs()));
    assert!(within(off, 1e-9, Tolerance), "{off:e}");
}

#[test]
fn faults_are_told_at_once_before_anything_is_computed() {
    let text = "[modes.disc]\nbelow = 1\nmeasured = [450]\n[calibrate]\nagainst = \"disc\"\n\
        [calibrate.parameter.a]\npath = \"shell.disc.thickness\"\nbetween = [\"2 mm\", \"3 mm\"]\n\
        [calibrate.parameter.b]\npath = [\"mesh.annulus.hub_radius\", \"mesh.annulus.outer_radius\"]\n\
        between = [\"10 mm\", \"30 mm\"]\n";
    let case = case(text);
    let prepared = Prepared::new(&case).unwrap();
    let error = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).err().unwrap();
    let text = error.to_string();
    assert!(text.contains("calibrate.parameter.a.between") && text.contains("own value 0.001"), "{text}");
    assert!(text.contains("calibrate.parameter.b.path") && error.exit_code() == 2, "{text}");
}

#[test]
fn measured_data_bring_their_own_deviations() {
    let more = "[modes.disc]\nbelow = \"3 kHz\"\n[measured.tap]\nof = \"disc\"\nfrequencies = [450, 900]\ndeviation = 0.01\n\
        [calibrate]\nagainst = \"tap\"\n[calibrate.parameter.scale]\npath = \"modes.disc.frequency_scale\"\n\
        between = [0.9, 1.1]\n";
    let facts_of = |more: &str| -> Result<Vec<MeasuredModeSet>> {
        Ok(measurements(&Prepared::new(&case(more)).unwrap())?.modes)
    };
    let found = facts_of(more).unwrap();
    assert_eq!(found.len(), 1);
    let fact = |frequency_hz| Fact { frequency_hz, deviation: 0.01, shape: None };
    assert_eq!((found[0].of.name(), &found[0].modes[..]), ("disc", &[fact(450.0), fact(900.0)][..]));
    let gone = more.replace("frequencies = [450, 900]", "file = \"gone.uff\"");
    assert!(facts_of(&gone).unwrap_err().to_string().contains("gone.uff"));
    let text = format!("{}{}", disc(5, 32), more.replace("of = \"disc\"", "frf = \"h\""));
    let wrong = Case::parse("case.toml", &text, ".".into()).unwrap_err().to_string();
    assert!(wrong.contains("calibrate.against") && wrong.contains("measured.tap"), "{wrong}");
}
