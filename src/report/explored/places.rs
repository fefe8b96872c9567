//! The places of a sweep that are worth a closer look: where a mode becomes unstable or stable, and where two frequencies merge
//! or veer.

use super::axis::{place, places};
use crate::linalg::c64;
use crate::report::chart::{ends, widened};
use crate::results::SweepResult;
use crate::sweep::{CriticalKind, InteractionKind};
use std::f64::consts::TAU;
use std::ops::Range;

/// Places that are drawn.
pub(super) const MOST: usize = 6;
/// The first half width of a window, as a part of the axis.
const REACH: f64 = 0.15;
/// Halvings of it at most.
const HALVINGS: usize = 4;
/// A window is narrowed until the distance of the pair is this part of its height somewhere.
const SEEN: f64 = 0.3;
/// Values of the sweep in a window at least.
const FEWEST: usize = 7;

const MERGE: &str = "two frequencies merge";
const SEPARATE: &str = "two frequencies separate";

/// A place of the sweep with its window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SweepPlace {
    /// Value of the parameter.
    pub value: f64,
    /// ω/2π there \[Hz\].
    pub frequency_hz: f64,
    /// What happens there, and at the other values in the window.
    pub what: Vec<&'static str>,
    /// The one or two branches that it concerns.
    pub branches: Vec<usize>,
    /// Whether a mode becomes unstable or stable in the window.
    pub critical: bool,
    /// Places on the axis across.
    pub across: Range<f64>,
    /// \[Hz\].
    pub frequencies: Range<f64>,
    /// \[1/s\].
    pub rates: Range<f64>,
}

/// Something that happens to one or two branches.
struct Event {
    value: f64,
    frequency_hz: f64,
    what: &'static str,
    branches: Vec<usize>,
    critical: bool,
    /// The smaller, the more it is worth a look.
    order: f64,
}

/// All places, those that are drawn first in the order of the parameter: critical values of the modes that grow most, then the
/// nearest approaches.
pub(super) fn places_of(result: &SweepResult) -> Vec<SweepPlace> {
    let mut events = events(result);
    events.sort_by(|a, b| a.order.total_cmp(&b.order));
    let across = places(&result.axis);
    let length = across.end - across.start;
    let mut groups: Vec<Vec<Event>> = Vec::new();
    for event in events {
        let near = |of: &Event| {
            (place(&result.axis, of.value) - place(&result.axis, event.value)).abs() < 2.0 * REACH * length
                && of.branches.iter().any(|b| event.branches.contains(b))
        };
        match groups.iter_mut().find(|group| near(&group[0])) {
            Some(group) => group.push(event),
            None => groups.push(vec![event]),
        }
    }
    let mut all: Vec<SweepPlace> = groups.iter().map(|group| with_window(result, group)).collect();
    let shown = all.len().min(MOST);
    all[..shown].sort_by(|a, b| a.value.total_cmp(&b.value).then(a.frequency_hz.total_cmp(&b.frequency_hz)));
    all
}

fn events(result: &SweepResult) -> Vec<Event> {
    let sweep = &result.sweep;
    let critical = sweep.critical.iter().map(|c| {
        let growth = sweep.branches[c.branch].eigenvalues.iter().map(|z| z.re).fold(0.0, f64::max);
        Event {
            value: c.value,
            frequency_hz: c.eigenvalue.im / TAU,
            what: match (c.kind, c.rises) {
                (CriticalKind::Merging, true) => MERGE,
                (CriticalKind::Merging, false) => SEPARATE,
                (CriticalKind::Growth, true) => "becomes unstable",
                (CriticalKind::Growth, false) => "becomes stable",
                (CriticalKind::Divergence, true) => "divergence begins",
                (CriticalKind::Divergence, false) => "divergence ends",
            },
            branches: vec![c.branch],
            critical: true,
            order: -growth,
        }
    });
    let met = sweep.interactions.iter().filter(|e| e.kind != InteractionKind::Crossing);
    let met = met.map(|e| Event {
        value: e.value,
        frequency_hz: e.frequency_hz,
        what: if e.kind == InteractionKind::Merging { MERGE } else { "frequencies veer" },
        branches: e.branches.to_vec(),
        critical: false,
        order: e.distance,
    });
    critical.chain(met).collect()
}

/// The place of the first of some events, in a window that holds all of them and is as high as its branches need.
fn with_window(result: &SweepResult, events: &[Event]) -> SweepPlace {
    let mut branches: Vec<usize> = events.iter().flat_map(|event| event.branches.iter().copied()).collect();
    branches.sort_unstable();
    branches.dedup();
    if let [alone] = branches[..] {
        branches.extend(nearest(result, alone, events[0].value));
    }
    let at = events.iter().map(|event| place(&result.axis, event.value));
    let [low, high] = ends(at);
    let whole = places(&result.axis);
    let mut half = REACH * (whole.end - whole.start);
    let mut window = (low - half).max(whole.start)..(high + half).min(whole.end);
    for _ in 0..HALVINGS {
        half *= 0.5;
        let smaller = (low - half).max(whole.start)..(high + half).min(whole.end);
        let values = result.sweep.values.iter().filter(|v| smaller.contains(&place(&result.axis, **v)));
        if branches.len() < 2 || coupling_seen(result, &branches, &window) || values.count() < FEWEST {
            break;
        }
        window = smaller;
    }
    let span = |part: fn(c64) -> f64, first: [f64; 2]| {
        let all = branches.iter().flat_map(|b| inside(result, *b, &window)).map(|(_, z)| part(z));
        all.fold(first, |[low, high], v| [low.min(v), high.max(v)])
    };
    let hz = events[0].frequency_hz;
    let [lowest, highest] = span(|z| z.im / TAU, [hz * (1.0 - 5e-4), hz * (1.0 + 5e-4)]);
    let [least, most] = span(|z| z.re, [0.0, 0.0]);
    let mut what: Vec<&'static str> = Vec::new();
    for event in events {
        // Where a mode becomes unstable by merging, the two branches meet, too.
        let known = what.iter().any(|w| *w == event.what || (event.what == MERGE && *w == SEPARATE));
        if !known {
            what.push(event.what);
        }
    }
    SweepPlace {
        value: events[0].value,
        frequency_hz: hz,
        what,
        branches,
        critical: events.iter().any(|event| event.critical),
        across: window,
        frequencies: widened([lowest, highest], 0.12),
        rates: widened([least, most], 0.1),
    }
}

/// λ of a branch at the values of the sweep inside a window, with their places on the axis.
fn inside<'a>(
    result: &'a SweepResult,
    b: usize,
    window: &'a Range<f64>,
) -> impl Iterator<Item = (f64, c64)> + 'a {
    let branch = &result.sweep.branches[b];
    let along = branch.eigenvalues.iter().enumerate();
    along
        .map(move |(k, z)| (place(&result.axis, result.sweep.values[branch.first + k]), *z))
        .filter(|(x, _)| window.contains(x))
}

/// Whether the distance of the first two branches is a good part of the height that the window needs for them.
fn coupling_seen(result: &SweepResult, branches: &[usize], window: &Range<f64>) -> bool {
    let frequencies = |b: usize| inside(result, b, window).map(|(x, z)| (x, z.im));
    let other: Vec<(f64, f64)> = frequencies(branches[1]).collect();
    let apart = frequencies(branches[0]).filter_map(|(x, omega)| {
        let beside = other.iter().find(|(at, _)| *at == x)?;
        Some((omega - beside.1).abs())
    });
    let all = branches.iter().flat_map(|b| frequencies(*b)).map(|(_, omega)| omega);
    let [low, high] = ends(all);
    apart.fold(0.0, f64::max) >= SEEN * (high - low)
}

/// The branch whose frequency is nearest to that of `b` at a value, if it is near.
fn nearest(result: &SweepResult, b: usize, value: f64) -> Option<usize> {
    const NEAR: f64 = 0.05;
    let values = &result.sweep.values;
    let away = |k: &usize| (values[*k] - value).abs();
    let k = (0..values.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let own = result.sweep.branches[b].at(k)?.im;
    let others = (0..result.sweep.branches.len()).filter(|other| *other != b);
    let gaps = others.filter_map(|o| Some((o, (result.sweep.branches[o].at(k)?.im - own).abs())));
    let (other, gap) = gaps.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (gap < NEAR * own.abs()).then_some(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::sweep::{Axis, Branch, Critical, Interaction};

    /// λ of two modes that are coupled by friction: ω² = ω₀² (1 ∓ √(d² − μ²)), which merge at μ = d.
    fn coupled(mu: f64, merges_at: f64, hz: f64) -> [c64; 2] {
        let split = 0.02 * c64::new(merges_at * merges_at - mu * mu, 0.0).sqrt();
        let omega = |sign: f64| (c64::new(1.0, 0.0) + split * sign).sqrt() * (TAU * hz);
        let lambda = [1.0, -1.0].map(|sign| c64::new(-omega(sign).im, omega(sign).re));
        // The mode that grows is the first.
        if lambda[0].re < lambda[1].re { [lambda[1], lambda[0]] } else { lambda }
    }

    /// Pairs that merge at these values and 6 kHz that stays, over 0 to 1.
    fn sweep(merge_at: &[f64]) -> SweepResult {
        let results = sample::rig();
        let mut result = results.all::<SweepResult>()[0].clone();
        result.axis = Axis { from: 0.0, to: 1.0, points: 81, log: false };
        let values = result.axis.values();
        let branch = |of: &dyn Fn(f64) -> c64| Branch {
            first: 0,
            eigenvalues: values.iter().map(|mu| of(*mu)).collect(),
            lowest_mac: 1.0,
            places: vec![0; values.len()],
            rounding: vec![0.0; values.len()],
        };
        let one = result.sweep.critical[0];
        result.sweep.branches = vec![branch(&|_| c64::new(-1.0, TAU * 6000.0))];
        result.sweep.critical.clear();
        result.sweep.interactions.clear();
        for (k, at) in merge_at.iter().enumerate() {
            let hz = 900.0 + 400.0 * k as f64;
            result.sweep.branches.extend([0, 1].map(|i| branch(&|mu| coupled(mu, *at, hz)[i])));
            let kind = CriticalKind::Merging;
            let eigenvalue = c64::new(0.0, TAU * hz);
            result.sweep.critical.push(Critical { branch: 2 * k + 1, value: *at, eigenvalue, kind, ..one });
            result.sweep.interactions.push(Interaction {
                branches: [2 * k + 1, 2 * k + 2],
                value: *at,
                distance: 1e-6,
                frequency_hz: hz,
                kind: InteractionKind::Merging,
            });
        }
        result.sweep.values = values;
        result
    }

    #[test]
    fn a_merging_pair_is_one_place_in_a_window_of_its_own_height() {
        let found = places_of(&sweep(&[0.4]));
        let [place] = &found[..] else { panic!("{found:?}") };
        assert_eq!((place.value, &*place.branches, place.critical), (0.4, &[1, 2][..], true));
        assert_eq!(place.what, ["two frequencies merge"]);
        // The pair is at most 0.02 · 0.4 · 900 Hz = 7.2 Hz wide, of the 6 kHz of the sweep.
        let height = place.frequencies.end - place.frequencies.start;
        assert!(height > 1.0 && height < 10.0 && place.frequencies.contains(&900.0), "{place:?}");
        assert!(place.across.start < 0.35 && place.across.end > 0.45 && place.across.end < 0.7);
        assert!(place.rates.start < -1.0 && place.rates.end > 1.0, "{place:?}");
    }

    #[test]
    fn the_first_places_stand_in_the_order_of_the_parameter() {
        let at: Vec<f64> = (0..9).map(|k| 0.9 - 0.1 * f64::from(k)).collect();
        let found = places_of(&sweep(&at));
        assert_eq!(found.len(), 9);
        assert!(found[..MOST].windows(2).all(|pair| pair[0].value < pair[1].value), "{found:?}");
        let zoom = super::super::zoom::picture(&sweep(&at), &found).unwrap();
        assert!(zoom.caption.contains("3 more places") && !zoom.svg.contains("NaN"));
        // Two charts a panel, each with its axes for the script of the page.
        assert_eq!(zoom.svg.matches("class=\"axes\"").count(), 2 * MOST);
        assert!(places_of(&sweep(&[])).is_empty());
    }
}
