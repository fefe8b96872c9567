//! A made-up test beside the made-up run.

use crate::linalg::c64;
use crate::results::{
    FrfResult, MeasuredComparison, MeasuredResponses, MeasuredRow, NamedModes, Placed, ResponsePair,
};

/// The factor of the computed frequencies.
const SCALE: f64 = 0.972;

/// Four measured modes, of which the last is like none of the computed ones.
pub(super) fn modes(disc: &NamedModes, modes: [Option<usize>; 4]) -> MeasuredComparison {
    let hz: Vec<f64> = (0..disc.modes.len()).map(|k| disc.modes.frequency_hz(k)).collect();
    let levels = crate::modal::levels(&hz, &disc.names);
    let level = |k: Option<usize>| k.and_then(|k| levels.iter().position(|level| level.contains(&k)));
    let row = |(frequency_hz, mode): (f64, Option<usize>)| MeasuredRow {
        frequency_hz,
        deviation: Some(0.005),
        damping_ratio: Some(0.002),
        mode,
        computed_hz: mode.map(|k| SCALE * disc.modes.frequency_hz(k)),
        computed_damping_ratio: mode.map(|k| disc.damping_ratio[k]),
        mac: mode.map(|_| 0.97),
    };
    let alike = |k: Option<usize>| {
        let of = |j: usize| if level(k) == Some(j) { 0.97 } else { 0.3 / (1.0 + j as f64) };
        (0..levels.len()).map(of).collect()
    };
    MeasuredComparison {
        name: "impact".into(),
        set: disc.name.clone(),
        source: "hammer test, free rim".into(),
        rows: [330.0, 936.0, 1697.0, 2050.0].into_iter().zip(modes).map(row).collect(),
        frequency_scale: SCALE,
        levels_hz: levels.iter().map(|level| SCALE * hz[level.start]).collect(),
        mac: modes.map(alike).into(),
        levels,
        placed: Some(Placed { points: 24, dofs: 24, largest: 1.2e-3, mean: 0.6e-3 }),
    }
}

/// A measured response that is near the computed one, and one that has none beside it.
pub(super) fn responses(frf: FrfResult) -> MeasuredResponses {
    let computed = frf.responses[0].values.clone();
    let measured: Vec<c64> = computed.iter().map(|h| h * c64::new(0.9, 0.1)).collect();
    MeasuredResponses {
        name: "impact".into(),
        source: "hammer test".into(),
        frf: frf.name.clone(),
        pairs: vec![ResponsePair {
            name: "point 3 over 1".into(),
            place: "rim".into(),
            swapped: false,
            away: [4e-4, 2e-4],
            quantity: frf.quantity,
            frequencies_hz: frf.frequencies_hz.clone(),
            assurance: crate::linalg::dense::mac(&measured, &computed),
            measured,
            computed,
        }],
        measured_alone: vec!["point 9 over 1: no response of the case is there".into()],
        computed_alone: vec!["inside".into()],
    }
}
