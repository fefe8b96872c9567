//! A made-up sweep, a map, and what damping decides.

use crate::linalg::c64;
use crate::results::{
    CheckedSample, DampingRow, DampingVerdicts, MapResult, SampledScalar, SweepMethod, SweepResult,
    UncertaintyResult, UncertaintyStudy,
};
use crate::sweep::{
    Axis, Boundary, Branch, Checked, Critical, CriticalKind, Interaction, InteractionKind, MapPoint, Sweep,
};
use crate::uncertainty::Distribution;
use std::f64::consts::TAU;

/// Five modes over friction, of which one grows beyond 0.3 and one has no answer at the first value.
pub(super) fn sweep() -> SweepResult {
    let axis = Axis { from: 0.1, to: 0.5, points: 5, log: false };
    let mode = |hz: f64, growth: f64| c64::new(growth, TAU * hz);
    let along = |hz: f64, slope: f64, first: usize| Branch {
        first,
        eigenvalues: (first..5).map(|k| mode(hz, slope * (axis.value(k) - 0.3) - 1e-3)).collect(),
        lowest_mac: 0.97,
        places: vec![0; 5 - first],
    };
    let critical = |value: f64, kind: CriticalKind| Critical {
        branch: 1,
        value,
        uncertainty: 1e-8,
        eigenvalue: mode(974.8, 0.0),
        rises: true,
        kind,
        slope: 120.0,
    };
    let checked = Checked { eigenvalue: mode(974.8, 0.0), backward_error: 1e-14, eigenvalue_error: 1e-10 };
    SweepResult {
        name: "over / friction".into(),
        parameter: "contact.rim.friction.mu0".into(),
        label: "friction coefficient μ₀ of rim".into(),
        unit: String::new(),
        axis,
        nominal: 0.4,
        sweep: Sweep {
            values: axis.values(),
            branches: vec![along(272.4, -1.0, 0), along(974.8, 120.0, 0), along(1484.2, -2.0, 1)],
            critical: vec![critical(0.3, CriticalKind::Growth), critical(0.31, CriticalKind::Merging)],
            interactions: vec![Interaction {
                branches: [0, 2],
                value: 0.2,
                distance: 1e-3,
                frequency_hz: 300.0,
                kind: InteractionKind::Veering,
            }],
        },
        verified: vec![Some(checked), None],
        sample: vec![(0.2, 1e-9), (0.4, 2e-9)],
        method: SweepMethod::Reduced(88),
    }
}

/// Four by three points over load and speed, of which the last has no answer.
pub(super) fn map() -> MapResult {
    let mut points: Vec<MapPoint> = (0..12)
        .map(|k| MapPoint {
            growth_rate: 3.0 * k as f64 - 15.5,
            frequency_hz: 974.8 + k as f64,
            unstable: u32::from(k > 5),
        })
        .collect();
    points[11] = MapPoint::NONE;
    MapResult {
        name: "load and speed".into(),
        parameters: ["contact.rim.load", "contact.rim.sliding_velocity"].map(String::from),
        labels: ["load ΣN of rim", "sliding velocity V of rim"].map(String::from),
        units: ["N", "m/s"].map(String::from),
        axes: [
            Axis { from: 10.0, to: 40.0, points: 4, log: false },
            Axis { from: 0.1, to: 10.0, points: 3, log: true },
        ],
        nominal: [20.0, 0.5],
        points,
        boundary: Boundary {
            points: vec![[10.0, 2.0], [22.0, 1.0], [40.0, 0.5], [30.0, 9.0]],
            lines: vec![vec![0, 1, 2]],
        },
        sample: vec![([15.0, 0.3], 1e-9)],
        method: SweepMethod::Whole,
    }
}

/// Two modes, of which damping decides one.
pub(super) fn damping() -> DampingVerdicts {
    let row = |growth: f64, hz: f64, critical_ratio: Option<f64>| DampingRow {
        eigenvalue: c64::new(growth, TAU * hz),
        critical_ratio,
    };
    let rows = vec![row(-8.0, 338.0, None), row(12.0, 974.8, Some(0.005))];
    DampingVerdicts { ratio: 0.0035, range: [0.00175, 0.007], rows }
}

/// Forty samples of friction and load, of which the last has no answer: the second of three modes grows with friction.
pub(super) fn uncertainty() -> UncertaintyResult {
    let scalar = |name: &str, path: &str, unit: &str, between: [f64; 2]| SampledScalar {
        name: name.into(),
        paths: vec![path.into()],
        label: name.into(),
        unit: unit.into(),
        distribution: Distribution { between, normal: None, log: false },
        nominal: between[0],
    };
    let values: Vec<Vec<f64>> =
        (0..40).map(|k| vec![0.2 + 0.01 * f64::from(k), 10.0 + f64::from(7 * k % 40)]).collect();
    let modes = |mu: f64| {
        let hz = [272.4, 974.8, 1484.2];
        let growth = [-3.0, 120.0 * (mu - 0.4), -2.0];
        Some((0..3).map(|k| c64::new(growth[k], TAU * (hz[k] + 20.0 * mu))).collect())
    };
    let mut samples: Vec<_> = values.iter().map(|sample| modes(sample[0])).collect();
    samples[39] = None;
    let study = UncertaintyStudy {
        name: "all".into(),
        scalars: vec![
            scalar("friction", "contact.rim.friction.mu0", "", [0.2, 0.6]),
            scalar("load", "contact.rim.load", "N", [10.0, 50.0]),
        ],
        values,
        sampling: "latin_hypercube",
        seed: 1,
        confidence: 0.95,
        reference: modes(0.3).unwrap_or_default(),
        modes: samples,
        method: SweepMethod::Reduced(60),
    };
    let checked = |sample| CheckedSample { sample, eigenvalue_error: 1e-10 };
    UncertaintyResult::new(study, vec![checked(3), checked(20)])
}
