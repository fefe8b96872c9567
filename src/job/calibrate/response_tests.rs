use super::super::frf::frfs;
use super::super::samples::disc;
use super::facts::measurements;
use super::model::CaseModel;
use super::*;
use crate::bounds::{Origin::*, within};
use crate::calibration::{CalibrationModel, ResponseLine};
use crate::measured::Quantity;
use crate::measured::uff::{Function, functions_file};
use std::path::Path;

const FRF: &str = "[frf.hammer]\nexcitation = { at = [0, 0, \"75 mm\"], direction = [1, 0, 0] }\n\
    response.inside = { at = [0, \"40 mm\", 0], direction = [1, 0, 0] }\n\
    response.rim = { at = [0, 0, \"75 mm\"], direction = [1, 0, 0] }\n\
    band = [\"50 Hz\", \"700 Hz\"]\nsolution = \"SOLUTION\"\n";

/// The case `text` with a hammer test of `hz`, measured on the same disc with other `values`, at its two places.
fn case(folder: &Path, text: &str, values: &[(&str, f64)], hz: &[f64]) -> Case {
    let plain = Case::parse("case.toml", text, folder.into()).unwrap();
    let made = values.iter().fold(plain.clone(), |case, (path, v)| case.with_parameter(path, *v).unwrap());
    let prepared = Prepared::new(&made).unwrap();
    let mut all = frfs(&prepared).unwrap();
    let answers: Vec<usize> = (0..2).map(|place| all[0].also_at(place, hz.to_vec())).collect();
    let (_, beside) = all[0].run(&prepared, (None, None), &()).unwrap();
    let values: Vec<Vec<_>> = answers
        .iter()
        .map(|k| hz.iter().zip(&beside[*k]).map(|(hz, h)| Quantity::Mobility.factor(*hz) * h).collect())
        .collect();
    let points = [(1, [0.0, 0.0, 0.075]), (2, [0.0, 0.04, 0.0])];
    // "inside" is the first of the places by name.
    let functions = [2, 1].into_iter().zip(&values).map(|(place, values)| Function {
        title: ["made", "NONE"],
        quantity: Quantity::Mobility,
        excitation: (1, 1),
        response: (place, 1),
        frequencies_hz: hz,
        values,
    });
    std::fs::write(folder.join("tap.unv"), functions_file(points.into_iter(), functions, false)).unwrap();
    plain
}

fn with_model<T>(case: &Case, work: impl FnOnce(&CaseModel) -> T) -> T {
    let prepared = Prepared::new(case).unwrap();
    let coordinates: Vec<Coordinate> =
        case.calibrate.as_ref().unwrap().parameter.values().map(Coordinate::new).collect();
    let measured = measurements(&prepared).unwrap();
    work(&CaseModel::new(&prepared, &coordinates, &measured).unwrap())
}

const MEASURED: &str = "[measured.tap]\nfrf = \"hammer\"\nfile = \"tap.unv\"\nresponse_lines = 60\n\
    [calibrate]\nagainst = \"tap\"\n";
const THICKNESS: &str = "[calibrate.parameter.thickness]\npath = \"shell.disc.thickness\"\n\
    between = [\"0.9 mm\", \"1.1 mm\"]\n";
const HUB: &str =
    "[calibrate.parameter.hub]\npath = \"mesh.annulus.hub_radius\"\nbetween = [\"12 mm\", \"20 mm\"]\n";
const RATIO: &str =
    "[calibrate.parameter.ratio]\npath = \"damping.modal_ratio\"\nbetween = [0.001, 0.03]\nlog = true\n";

fn hz() -> Vec<f64> {
    (0..131).map(|k| 50.0 + 5.0 * f64::from(k)).collect()
}

/// The largest difference between slopes and differences (4 D(h) − D(2h))/3, over the largest slope, for each unknown.
fn roughness(model: &CaseModel, h: f64) -> Vec<f64> {
    let lines = |x: &[f64]| -> Vec<ResponseLine> { model.compute(x).unwrap().lines };
    let here = lines(model.start());
    let one = |j: usize| {
        let at = |k: f64| {
            let mut x = model.start().to_vec();
            x[j] += k * h;
            lines(&x)
        };
        let around = [1.0, -1.0, 2.0, -2.0].map(at);
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        for (k, line) in here.iter().enumerate() {
            let [up, down, up2, down2] = [0, 1, 2, 3].map(|side| around[side][k].value);
            let expected = (8.0 * (up - down) - (up2 - down2)) / (12.0 * h);
            largest = largest.max(expected.abs());
            worst = worst.max((line.slope[j] - expected).abs());
        }
        assert!(largest > 0.1, "{j}: {largest}");
        worst / largest
    };
    (0..model.start().len()).map(one).collect()
}

#[test]
fn slopes_are_those_of_differences_of_responses() {
    let dir = tempfile::tempdir().unwrap();
    let asked = |solution: &str| format!("{}{MEASURED}{HUB}{THICKNESS}", FRF.replace("SOLUTION", solution));
    let loss = "[calibrate.parameter.loss]\npath = \"material.steel.loss_factor\"\nbetween = [0.005, 0.02]\n";
    let steel =
        disc(5, 32).replace("density = ", "loss_factor = 0.01\nrayleigh = { alpha = 3.0 }\ndensity = ");
    let lossy = |solution: &str| case(dir.path(), &format!("{steel}{}{loss}", asked(solution)), &[], &hz());
    // At full order: exact.
    let direct = with_model(&lossy("direct"), |model| roughness(model, 1e-3));
    assert!(direct.iter().all(|worst| within(*worst, 1e-6, Reference)), "{direct:?}");
    // Superposed: as exact as the superposition.
    let modes = with_model(&lossy("modes"), |model| roughness(model, 1e-3));
    assert!(modes.iter().all(|worst| within(*worst, 1e-4, Discretisation)), "{modes:?}");
    let text = format!("{}[damping]\nmodal_ratio = 0.006\n{}{RATIO}", disc(5, 32), asked("modes"));
    let modal = with_model(&case(dir.path(), &text, &[], &hz()), |model| roughness(model, 1e-3));
    assert!(modal.iter().all(|worst| within(*worst, 1e-4, Discretisation)), "{modal:?}");
    // Both ways give one answer.
    let lines =
        |solution: &str| with_model(&lossy(solution), |model| model.compute(model.start()).unwrap().lines);
    for (a, b) in lines("direct").iter().zip(&lines("modes")) {
        assert!(within((a.value - b.value).abs(), 1e-3, Discretisation), "{} {}", a.value, b.value);
    }
}

#[test]
fn a_response_tells_thickness_and_damping() {
    let dir = tempfile::tempdir().unwrap();
    let text = format!(
        "{}[damping]\nmodal_ratio = 0.006\n{}{MEASURED}{THICKNESS}{RATIO}",
        disc(5, 32),
        FRF.replace("SOLUTION", "modes")
    );
    let made = [("shell.disc.thickness", 0.98e-3), ("damping.modal_ratio", 0.009)];
    let case = case(dir.path(), &text, &made, &hz());
    let prepared = Prepared::new(&case).unwrap();
    let found = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).unwrap().run(&()).unwrap();
    assert!(found.data.is_empty() && found.responses.len() == 2 && found.calibration.chance.is_none());
    assert!(found.calibration.best().fit.converged, "{:?}", found.calibration.best().fit.iterations);
    // In the order of the names: ratio, thickness.
    for (number, truth) in found.numbers.iter().zip([0.009, 0.98e-3]) {
        assert!(
            within((number.after / truth - 1.0).abs(), 1e-4, Tolerance),
            "{} {}",
            number.name,
            number.after
        );
    }
    let known = &found.calibration.knowledge;
    assert!(known.determined() == 2 && known.freedom > 60, "{}", known.freedom);
    for response in &found.responses {
        assert!(
            within(response.apart_db(&response.after), 0.01, Tolerance)
                && response.apart_db(&response.before) > 0.5
        );
        assert!(response.frequencies_hz.len() <= 60);
        let left_out = response.left_out.as_ref().unwrap();
        assert!(
            within(response.apart_db(left_out), 0.01, Tolerance)
                && within(response.apart(left_out), 0.02, Tolerance)
        );
    }
}

#[test]
fn a_response_decides_which_mode_a_frequency_is() {
    const BOTH: &str = "[\"disc\", \"tap\"]";
    let dir = tempfile::tempdir().unwrap();
    let made = [("mesh.annulus.hub_radius", 0.0165), ("shell.disc.thickness", 0.98e-3)];
    let text = |measured_hz: f64, against: &str| {
        format!(
            "{}[damping]\nmodal_ratio = 0.006\n{}[modes.disc]\nbelow = \"1 kHz\"\nmeasured = [{measured_hz}]\n\
             {}{HUB}{THICKNESS}",
            disc(5, 32),
            FRF.replace("SOLUTION", "modes"),
            MEASURED.replace("\"tap\"\n", &format!("{against}\n"))
        )
    };
    let truth = case(dir.path(), &text(1.0, BOTH), &made, &hz());
    let truth = made.iter().fold(truth, |case, (path, v)| case.with_parameter(path, *v).unwrap());
    let named = super::super::modes::part_modes(&Prepared::new(&truth).unwrap(), "disc", &()).unwrap();
    let own = |k: &usize| named.names[*k].is_some_and(|m| (m.nodal_diameters, m.nodal_circles) == (1, 0));
    let measured_hz = named.modes.frequency_hz((0..named.modes.len()).find(own).unwrap());
    let found = |against: &str| {
        let case = case(dir.path(), &text(measured_hz, against), &made, &hz());
        let prepared = Prepared::new(&case).unwrap();
        Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).unwrap().run(&()).unwrap()
    };
    let alone = found("\"disc\"").calibration;
    assert!(alone.ranked.len() > 1 && alone.ranked[1].weight > 0.9, "{:?}", alone.ranked);
    let with = found(BOTH);
    assert_eq!(with.data[0].level, "disc (1, 0)");
    assert!(with.calibration.ranked[1].weight.ln() < -13.0);
    // In the order of the names: hub, thickness.
    for (number, (_, truth)) in with.numbers.iter().zip(made) {
        assert!(
            within((number.after / truth - 1.0).abs(), 1e-4, Tolerance),
            "{} {}",
            number.name,
            number.after
        );
    }
    assert!(within((with.data[0].left_out_hz.unwrap() / measured_hz - 1.0).abs(), 1e-4, Tolerance));
    for response in &with.responses {
        assert!(within(response.apart_db(response.left_out.as_ref().unwrap()), 0.05, Tolerance));
    }
}

#[test]
fn responses_that_cannot_be_compared_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let damping = "[damping]\nmodal_ratio = 0.006\n";
    let text = format!("{}{damping}{}{MEASURED}{THICKNESS}", disc(5, 32), FRF.replace("SOLUTION", "modes"));
    let with = |text: &str| {
        let case = case(dir.path(), text, &[], &hz());
        let prepared = Prepared::new(&case).unwrap();
        let refused = Calibrate::new(&prepared, case.calibrate.as_ref().unwrap()).err().unwrap();
        assert_eq!(refused.exit_code(), 2);
        refused.to_string()
    };
    let beyond = with(&text.replace("response_lines = 60", "response_band = [\"2 kHz\", \"3 kHz\"]"));
    assert!(beyond.contains("measured.tap.response_band") && beyond.contains("50.0 to 700.0 Hz"), "{beyond}");
    let off = with(&text.replace("response_lines = 60", "transform = { origin = [\"20 mm\", 0, 0] }"));
    assert!(off.contains("measured.tap.frf") && off.contains("no response of the case is there"), "{off}");
}
