//! A calibration for the tests.

use super::super::{
    CalibratedDatum, CalibratedNumber, CalibratedResponse, CalibratedShape, CalibrationResult,
};
use crate::calibration::{
    Calibration, Chance, Computed, Fit, Knowledge, LeftOut, LeftOutCurve, LeftOutDatum, Level, Ranked, Trials,
};
use crate::measured::Quantity;

/// A made-up calibration: two numbers, the second at its bound and not determined, three data.
pub fn calibration() -> CalibrationResult {
    let level = |frequency_hz: f64| {
        Some(Level { frequency_hz, slope: vec![0.1, 0.02], split: vec![0.0; 2], span: None })
    };
    let fit = |converged: bool| Fit {
        x: vec![0.2, 1.0],
        computed: Computed { levels: [333.3, 936.0, 1705.0].map(level).to_vec(), lines: vec![] },
        chi2: 5.2,
        iterations: 4,
        evaluations: 4,
        gradient: 1e-9,
        converged,
    };
    let ranked = |weight: f64| Ranked {
        assignment: vec![0, 1, 2],
        fit: fit(weight == 1.0),
        linear_chi2: 5.3,
        largest_error: 0.01,
        least_mac: Some(0.97),
        weight,
    };
    let number = |name: &str, unit: &str, after: f64, at_bound: bool| CalibratedNumber {
        name: name.into(),
        paths: vec!["mesh.annulus.hub_radius".into()],
        unit: unit.into(),
        between: [0.015, 0.025],
        expected: 0.02,
        deviation: (!at_bound).then_some(0.002),
        log: at_bound,
        before: 0.02,
        after,
        deviation_after: 2e-4,
        interval: [after - 4e-4, (after + 4e-4).min(0.025)],
        scaled_interval: Some([after - 2e-3, (after + 2e-3).min(0.025)]),
        at_bound,
    };
    let datum = |measured_hz: f64, after: f64, level: &str| CalibratedDatum {
        set: "disc".into(),
        measured_hz,
        deviation: 0.005,
        level: level.into(),
        before_hz: Some(1.05 * measured_hz),
        after_hz: Some(after),
        left_out_hz: Some(0.97 * measured_hz),
        growth: None,
        shape: (measured_hz < 1e3).then_some(CalibratedShape {
            components: 24,
            before: Some(0.9),
            after: Some(0.97),
            left_out: Some(0.96),
        }),
    };
    CalibrationResult {
        numbers: vec![number("hub", "m", 0.021, false), number("stiffness", "N/m", 0.025, true)],
        data: vec![
            datum(330.0, 333.3, "disc (2, 0)"),
            datum(936.0, 936.0, "disc (4, 0)"),
            datum(1697.0, 1705.0, "disc (0, 1)"),
        ],
        responses: vec![CalibratedResponse {
            set: "tap".into(),
            name: "1, 2+x/1+x".into(),
            place: "rim".into(),
            quantity: Quantity::Accelerance,
            deviation: 0.1,
            frequencies_hz: vec![300.0, 330.0, 400.0],
            measured: vec![1.0, 10.0, 2.0],
            before: vec![2.0, 5.0, 2.0],
            after: vec![1.0, 9.0, 2.0],
            left_out: Some(vec![1.0, 8.0, 2.0]),
        }],
        levels: ["disc (2, 0)", "disc (4, 0)", "disc (0, 1)"].map(String::from).to_vec(),
        level_sets: vec!["disc".into(); 3],
        calibration: Calibration {
            before: Computed { levels: [340.0, 980.0, 1750.0].map(level).to_vec(), lines: vec![] },
            ranked: vec![ranked(1.0), ranked(0.03)],
            plausible: 24,
            tried: 20,
            all_counted: true,
            all_searched: true,
            knowledge: Knowledge {
                freedom: 2,
                singular_values: vec![30.0, 0.4],
                directions: vec![vec![0.98, 0.2], vec![-0.2, 0.98]],
                deviations: vec![0.04, 2.5],
                correlations: vec![vec![1.0, 0.3], vec![0.3, 1.0]],
                intervals: vec![[0.1, 0.3], [-1.0, 1.0]],
                scaled_intervals: Some(vec![[0.0, 0.4], [-1.0, 1.0]]),
                reduced_chi2: Some(2.6),
                chi2_probability: Some(0.07),
            },
            left_out: LeftOut {
                data: vec![
                    LeftOutDatum {
                        x: vec![0.1, 1.0],
                        predicted_hz: Some(320.0),
                        mac: Some(0.96),
                        converged: true
                    };
                    3
                ],
                curves: vec![LeftOutCurve {
                    x: vec![0.1, 1.0],
                    predicted: Some(vec![0.0, 2.08, 0.69]),
                    converged: true,
                }],
            },
            chance: Some(Chance { draws: 999, by_error: 49, by_chi2: 59 }),
            trials: Some(Trials {
                count: 100,
                converged: 100,
                covered: vec![95, 96],
                scaled_covered: Some(vec![94, 97]),
                model_error: 1e-3,
                scatter: vec![0.1, 1.0],
            }),
        },
        calibrated_case: "title = \"calibrated\"\n".into(),
    }
}
