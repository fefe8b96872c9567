//! How far computed modes and responses are from the measured ones.

use crate::report::finding::{Finding, FindingClass};
use crate::report::format::{fixed, given, signed};
use crate::results::{MeasuredComparison, MeasuredResponses};
use std::f64::consts::TAU;

/// Customary limit of the difference of a frequency \[%\].
const FREQUENCY_PERCENT: f64 = 5.0;
/// Customary limit of the MAC of shapes that are taken for the same.
const MAC: f64 = 0.9;

/// Frequencies that are named one by one.
const NAMED: usize = 3;

/// The largest difference of a frequency, the least MAC, and what has no computed mode.
pub(super) fn modes(test: &MeasuredComparison) -> Finding {
    let paired: Vec<(f64, f64)> =
        test.rows.iter().filter_map(|row| Some((row.frequency_hz, row.difference_percent()?))).collect();
    let mut words = format!(
        "Test {}: {} of {} measured modes have a computed one.",
        test.name,
        paired.len(),
        test.rows.len()
    );
    let alone = test.rows.iter().filter(|row| row.computed_hz.is_none());
    let alone: Vec<String> = alone.take(NAMED).map(|row| format!("{} Hz", given(row.frequency_hz))).collect();
    if !alone.is_empty() {
        let more = if test.rows.len() - paired.len() > NAMED { " …" } else { "" };
        words += &format!(" None is near {}{more}.", alone.join(", "));
    }
    words += &other_unit(test).unwrap_or_default();
    let mut within = paired.len() == test.rows.len() && !paired.is_empty();
    if let Some((hz, percent)) = paired.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
        let inside = percent.abs() <= FREQUENCY_PERCENT;
        within &= inside;
        words += &format!(
            " The largest difference of a frequency, {} % at {} Hz, is {} {FREQUENCY_PERCENT} %.",
            signed(*percent, 2),
            given(*hz),
            if inside { "within" } else { "beyond" }
        );
    }
    if let Some(mac) = test.rows.iter().filter_map(|row| row.mac).reduce(f64::min) {
        within &= mac >= MAC;
        words += &format!(" The least MAC is {}.", fixed(mac, 2));
    }
    Finding::new(if within { FindingClass::Good } else { FindingClass::Attention }, words)
}

/// The words that measured frequencies are most likely in another unit: in it more than half of them, and more than now, are
/// within a fifth of a computed one.
fn other_unit(test: &MeasuredComparison) -> Option<String> {
    const NEAR: f64 = 0.2;
    let near = |factor: f64| {
        let close = |hz: f64| test.levels_hz.iter().any(|level| (factor * hz / level).ln().abs() < NEAR);
        test.rows.iter().filter(|row| close(row.frequency_hz)).count()
    };
    let (now, all) = (near(1.0), test.rows.len());
    let units = [(1e3, "kHz", "by 1000"), (1.0 / TAU, "rad/s", "by 1/2π"), (1.0 / 60.0, "1/min", "by 1/60")];
    let (unit, by, count) = units
        .into_iter()
        .map(|(factor, unit, by)| (unit, by, near(factor)))
        .find(|(_, _, count)| 4 * now < *count && 2 * count > all)?;
    Some(format!(
        " Multiplied {by}, {count} of them are near one: are they in {unit}? They have to be in Hz."
    ))
}

/// The range of the FRAC.
pub(super) fn responses(test: &MeasuredResponses) -> Finding {
    let all = || test.pairs.iter().map(|pair| pair.assurance);
    let (Some(least), Some(most)) = (all().reduce(f64::min), all().reduce(f64::max)) else {
        let words = format!("Test {}: no measured response has a computed one.", test.name);
        return Finding::new(FindingClass::Attention, words);
    };
    let [least, most] = [least, most].map(|frac| fixed(frac, 3));
    let frac = if least == most { least } else { format!("from {least} to {most}") };
    let words = format!(
        "Test {}: {} of its responses have a computed one; FRAC {frac}.",
        test.name,
        test.pairs.len()
    );
    Finding::new(FindingClass::Neutral, words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::MeasuredRow;

    #[test]
    fn frequencies_in_another_unit_are_told() {
        let hz = [410.0, 886.0, 1095.0, 1609.0];
        let test = |factor: f64, count: usize| MeasuredComparison {
            levels_hz: hz.to_vec(),
            rows: hz[..count]
                .iter()
                .map(|f| MeasuredRow { frequency_hz: f / factor, ..Default::default() })
                .collect(),
            ..MeasuredComparison::default()
        };
        for count in 1..=4 {
            for (factor, unit) in [(1e3, "kHz"), (1.0 / TAU, "rad/s")] {
                let words = modes(&test(factor, count)).words;
                assert!(words.contains(unit), "{words}");
            }
            for factor in [1.0, 1.1, 3.0, 0.3] {
                assert!(other_unit(&test(factor, count)).is_none(), "{factor} {count}");
            }
        }
    }

    #[test]
    fn one_mode_beyond_a_limit_or_without_a_partner_is_enough() {
        let row = |hz: f64, computed: Option<f64>, mac: f64| MeasuredRow {
            frequency_hz: hz,
            computed_hz: computed,
            mac: Some(mac),
            ..MeasuredRow::default()
        };
        let found =
            |rows: Vec<MeasuredRow>| modes(&MeasuredComparison { rows, ..MeasuredComparison::default() });
        let good = found(vec![row(100.0, Some(104.0), 0.95), row(200.0, Some(197.0), 0.99)]);
        assert_eq!(good.class, FindingClass::Good);
        assert!(good.words.contains("+4.00 % at 100 Hz, is within 5 %"), "{}", good.words);
        for bad in [row(300.0, Some(282.0), 0.99), row(300.0, Some(300.0), 0.85), row(300.0, None, 0.0)] {
            let words = found(vec![row(100.0, Some(104.0), 0.95), bad]);
            assert_eq!(words.class, FindingClass::Attention, "{}", words.words);
        }
        let results = sample::rig();
        let tested = responses(results.all::<MeasuredResponses>()[0]);
        assert!(tested.words.contains("FRAC 0.489"), "{}", tested.words);
    }
}
