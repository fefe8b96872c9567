//! Where a sweep or a map is unstable, and what damping decides.

use super::words::{list, with_unit};
use crate::report::finding::{Finding, FindingClass};
use crate::report::format::{hertz, rounded, signed, significant};
use crate::results::{DampingVerdicts, MapResult, SweepResult};

/// Ranges that are given one by one.
const NAMED: usize = 3;

/// The values at which a mode grows.
pub(super) fn sweep(result: &SweepResult) -> Finding {
    let (axis, unit) = (&result.axis, result.unit.as_str());
    let ends = [axis.from.min(axis.to), axis.from.max(axis.to)];
    let [low, high] = ends.map(|end| with_unit(end, unit));
    let name = format!("Sweep {}", result.name);
    let all = result.sweep.branches.len();
    let ranges = unstable_ranges(result);
    let (class, where_) = match &ranges[..] {
        [] if result.sweep.broken() > 0 => {
            let (values, broken) = (result.sweep.values.len(), result.sweep.broken());
            let words = format!(
                "none of {all} modes grows at the {values} values of {} from {low} to {high} that were examined; between them it is open, as \
                 {broken} of the modes begin or end there: more points follow them, or a wider `cea.band`",
                result.label
            );
            (FindingClass::Attention, words)
        }
        [] => {
            let words = format!("none of {all} modes grows for {} from {low} to {high}", result.label);
            (FindingClass::Good, words)
        }
        [range] if *range == ends => {
            let words = format!("a mode grows at every value of {} from {low} to {high}", result.label);
            (FindingClass::Attention, words)
        }
        several => {
            let each = several.iter().take(NAMED).map(|[a, b]| match a == b {
                true => format!("at {}", located(*a, unit)),
                false => format!("from {} to {}", located(*a, unit), located(*b, unit)),
            });
            let more = match several.len().saturating_sub(NAMED) {
                0 => String::new(),
                1 => " and in 1 more range".into(),
                more => format!(" and in {more} more ranges"),
            };
            let each = list(&each.collect::<Vec<_>>());
            let words =
                format!("a mode grows for {} {each}{more}, examined from {low} to {high}", result.label);
            (FindingClass::Attention, words)
        }
    };
    let nominal = with_unit(result.nominal, unit);
    let without = without_an_answer(result.sweep.unanswered.len(), result.sweep.values.len());
    let class = if without.is_empty() { class } else { FindingClass::Attention };
    Finding::new(class, format!("{name}: {where_}; the case has {nominal}.{without}"))
}

fn without_an_answer(count: usize, total: usize) -> String {
    if count == 0 { String::new() } else { format!(" Without an answer: {count} of {total} points.") }
}

/// A critical value with four digits, so that an end of the sweep is written as it was given.
fn located(value: f64, unit: &str) -> String {
    with_unit(rounded(value, 4), unit)
}

/// The ranges of the parameter in which a mode grows, ascending: between critical values, or the values of the sweep where
/// none was located.
fn unstable_ranges(result: &SweepResult) -> Vec<[f64; 2]> {
    let sweep = &result.sweep;
    let mut all: Vec<[f64; 2]> = Vec::new();
    for (b, branch) in sweep.branches.iter().enumerate() {
        let values = &sweep.values[branch.first..];
        // In the order of the sweep: where its state is known, and where it changes.
        let mut begun: Option<f64> = None;
        let mut last = None;
        for (grows, value) in branch.growing().zip(values) {
            let between = sweep.critical.iter().filter(|c| {
                c.branch == b && last.is_some_and(|last: f64| (c.value - last) * (c.value - value) < 0.0)
            });
            // At a value of the sweep within the uncertainty of a critical one rounding hides whether the mode grows.
            let hidden =
                sweep.critical.iter().any(|c| c.branch == b && (c.value - value).abs() < c.uncertainty);
            let here = (!hidden).then_some((*value, grows));
            let changes = between.map(|c| (c.value, c.rises)).chain(here);
            for (at, grows) in changes {
                match (begun, grows) {
                    (None, true) => begun = Some(at),
                    (Some(from), false) => {
                        // A change that was not located lies after the last value that is unstable.
                        let end = if at == *value { last.unwrap_or(at) } else { at };
                        all.push([from.min(end), from.max(end)]);
                        begun = None;
                    }
                    _ => {}
                }
            }
            last = Some(*value);
        }
        if let (Some(from), Some(end)) = (begun, last) {
            all.push([from.min(end), from.max(end)]);
        }
    }
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut united: Vec<[f64; 2]> = Vec::new();
    for range in all {
        match united.last_mut() {
            Some(before) if range[0] <= before[1] => before[1] = before[1].max(range[1]),
            _ => united.push(range),
        }
    }
    united
}

/// How many points are unstable, and the largest growth rate.
pub(super) fn map(result: &MapResult) -> Finding {
    let n = result.axes[0].points;
    let answered: Vec<_> =
        result.points.iter().enumerate().filter(|(_, p)| p.growth_rate.is_finite()).collect();
    let unstable = answered.iter().filter(|(_, p)| p.unstable > 0).count();
    let mut words = format!(
        "Map {}: {unstable} of {} points over {} and {} are unstable.",
        result.name,
        answered.len(),
        result.labels[0],
        result.labels[1]
    );
    let without = result.points.len() - answered.len();
    words += &without_an_answer(without, result.points.len());
    if let Some((k, p)) = answered.iter().max_by(|a, b| a.1.growth_rate.total_cmp(&b.1.growth_rate)) {
        words += &format!(
            " The largest growth rate, {} 1/s at {} Hz, is at {} and {}.",
            signed(p.growth_rate, 2),
            hertz(p.frequency_hz, 0),
            with_unit(result.axes[0].value(k % n), &result.units[0]),
            with_unit(result.axes[1].value(k / n), &result.units[1])
        );
    }
    let good = unstable == 0 && without == 0 && !answered.is_empty();
    Finding::new(if good { FindingClass::Good } else { FindingClass::Attention }, words)
}

/// How many verdicts the modal damping decides.
pub(super) fn damping(verdicts: &DampingVerdicts) -> Finding {
    let percent = |ratio: f64| format!("{} %", significant(100.0 * ratio, 3));
    let [low, high] = verdicts.range.map(percent);
    let all = verdicts.rows.len();
    match verdicts.decided().count() {
        0 => {
            let words = format!("Damping between {low} and {high} changes none of {all} verdicts.");
            Finding::new(FindingClass::Neutral, words)
        }
        n => {
            let words =
                format!("Damping between {low} and {high} decides {n} of {all} verdicts: measure it.");
            Finding::new(FindingClass::Attention, words)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::linalg::c64;
    use crate::sweep::{Branch, Critical, CriticalKind};

    #[test]
    fn ranges_end_at_critical_values_and_overlaps_are_one() {
        let results = sample::rig();
        let mut result = results.all::<SweepResult>()[0].clone();
        let branch = |first: usize, rates: &[f64]| Branch {
            first,
            eigenvalues: rates.iter().map(|s| c64::new(*s, 1000.0)).collect(),
            rounding: vec![0.0; rates.len()],
            ..result.sweep.branches[0].clone()
        };
        let branches = vec![
            branch(0, &[-1.0, -1.0, 1.0, 1.0, -1.0]),
            branch(1, &[-1.0, 1.0, -1.0, -1.0]),
            // Up and down between two values.
            branch(0, &[-1.0, -1.0, -1.0, -1.0, -1.0]),
        ];
        let critical = |branch: usize, value: f64, rises: bool| Critical {
            branch,
            value,
            uncertainty: 0.0,
            eigenvalue: c64::new(0.0, 1000.0),
            rises,
            kind: CriticalKind::Growth,
            wide: false,
            slope: 1.0,
        };
        result.sweep.values = vec![0.0, 1.0, 2.0, 3.0, 4.0];
        result.sweep.branches = branches;
        result.sweep.critical = vec![
            critical(2, 0.2, true),
            critical(2, 0.3, false),
            critical(0, 1.5, true),
            critical(1, 1.25, true),
            critical(0, 3.5, false),
        ];
        // The fall of the second branch was not located; it is inside the range of the first.
        assert_eq!(unstable_ranges(&result), [[0.2, 0.3], [1.25, 3.5]]);
        let found = sweep(&result);
        assert!(
            found.class == FindingClass::Attention && found.words.contains("from 1.25 to 3.5"),
            "{}",
            found.words
        );
        // Critical values before and behind a value of the sweep that their uncertainty covers.
        for (at, grows) in [(2.9, -1.0), (3.1, -1.0), (2.9, 1.0), (3.1, 1.0)] {
            let mut near = result.clone();
            near.sweep.branches = vec![Branch {
                first: 0,
                eigenvalues: [-1.0, -1.0, -1.0, grows, 1.0].map(|s| c64::new(s, 1000.0)).to_vec(),
                rounding: vec![0.0; 5],
                ..result.sweep.branches[0].clone()
            }];
            near.sweep.critical = vec![Critical { uncertainty: 0.2, ..critical(0, at, true) }];
            assert_eq!(unstable_ranges(&near), [[at, 4.0]], "{at} {grows}");
        }
        // The same the other way round.
        result.sweep.values.reverse();
        result.sweep.branches.iter_mut().for_each(|b| b.eigenvalues.reverse());
        result.sweep.branches[1].first = 0;
        result.sweep.critical.reverse();
        result.sweep.critical.iter_mut().for_each(|c| c.rises = !c.rises);
        assert_eq!(unstable_ranges(&result), [[0.2, 0.3], [1.25, 3.5]]);
        // None grows: known of modes that are followed through all values only.
        for (first, count, class) in [
            (0, 5, FindingClass::Good),
            (1, 4, FindingClass::Attention),
            (0, 4, FindingClass::Attention),
            (4, 1, FindingClass::Attention),
        ] {
            let mut calm = result.clone();
            calm.sweep.critical.clear();
            calm.sweep.branches = vec![Branch {
                first,
                eigenvalues: vec![c64::new(-1.0, 1000.0); count],
                rounding: vec![0.0; count],
                ..result.sweep.branches[0].clone()
            }];
            let found = sweep(&calm);
            assert!(found.class == class, "{first} {count}: {}", found.words);
        }
        result.sweep.branches.truncate(0);
        assert_eq!(sweep(&result).class, FindingClass::Good);
    }

    #[test]
    fn maps_and_damping_are_counted() {
        let results = sample::rig();
        let found = map(results.all::<MapResult>()[0]);
        assert!(
            found.words.contains("points over") && found.words.contains("largest growth rate, +"),
            "{}",
            found.words
        );
        assert!(!damping(results.get::<DampingVerdicts>().unwrap()).words.is_empty());
    }
}
