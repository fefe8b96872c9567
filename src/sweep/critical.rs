//! Critical values: where a branch becomes unstable or stable, located between two values of the sweep.

use super::assign::difference;
use super::branch::{Branch, Sample};
use super::root::{Bracket, narrow};
use super::{Axis, Modes, ROUND_OFF, SweepProblem, unstable};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::mac;
use crate::progress::Observer;

/// A value of the parameter at which a branch becomes unstable or stable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The branch, an index into [`super::Sweep::branches`].
    pub branch: usize,
    /// The value.
    pub value: f64,
    /// Half the length of the bracket that holds it.
    pub uncertainty: f64,
    /// λ there \[1/s\].
    pub eigenvalue: c64,
    /// Whether the mode is unstable beyond the value, going along the sweep.
    pub rises: bool,
    /// Type of instability.
    pub kind: CriticalKind,
    /// Whether the bracket is longer than it was to be, as the search had come to its limit.
    pub wide: bool,
    /// |dσ/dp| about the value \[1/s per unit of the parameter\], from the ends of the last wide bracket.
    pub slope: f64,
}

/// Type of instability at a critical value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CriticalKind {
    /// The frequencies of two modes merge: flutter.
    Merging,
    /// The growth rate of one mode passes zero: what feeds it outweighs its damping.
    Growth,
    /// A mode without oscillation: divergence.
    Divergence,
}

/// A mode at one value, as followed through a bracket.
#[derive(Clone)]
struct End {
    value: f64,
    lambda: c64,
    vector: Vec<c64>,
    /// What rounding may leave of σ.
    rounding: f64,
}

impl End {
    fn of(value: f64, modes: &Modes, k: usize) -> Self {
        let rounding = rounding(&modes.eigenvalues, k);
        End { value, lambda: modes.eigenvalues[k], vector: modes.vector(k).to_vec(), rounding }
    }

    /// Where the mode is not.
    fn absent(value: f64) -> Self {
        End { value, lambda: c64::new(0.0, 0.0), vector: Vec::new(), rounding: 0.0 }
    }
}

/// Rounding of σ of a mode by itself, over |λ|.
const ROUNDING: f64 = 1e-12;

/// Every place between two samples at which a branch becomes unstable or stable, each narrowed to `tolerance`, all with `most` solutions
/// at most.
pub(super) fn critical_values(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
    most: usize,
    observer: &dyn Observer,
) -> Result<Vec<Critical>> {
    let mut places: Vec<(usize, usize)> = Vec::new();
    for (b, branch) in branches.iter().enumerate() {
        let at = |(k, sample): (usize, &Sample)| {
            let place = branch.place(k)?;
            let all = &sample.modes.eigenvalues;
            Some((all[place], rounding(all, place)))
        };
        let growth: Vec<Option<(c64, f64)>> = samples.iter().enumerate().map(at).collect();
        let grows = growing(&growth);
        for k in 0..samples.len() - 1 {
            let changes = match (growth[k], growth[k + 1]) {
                (Some((a, of_a)), Some((b, of_b))) => {
                    let passes = |x: f64, of_x: f64, y: f64, of_y: f64| x > of_x && y < -of_y;
                    grows[k] != grows[k + 1]
                        || passes(a.re, of_a, b.re, of_b)
                        || passes(b.re, of_b, a.re, of_a)
                }
                // A mode that diverges is given whatever the band: where its branch begins or ends and there is no other in its place,
                // it begins or ends to grow.
                (Some((z, _)), None) => begins_to_diverge(z, &samples[k + 1], &samples[k]),
                (None, Some((z, _))) => begins_to_diverge(z, &samples[k], &samples[k + 1]),
                (None, None) => false,
            };
            if changes {
                places.push((k, b));
            }
        }
    }
    places.sort_unstable();
    observer.begin("critical values", Some(places.len() as u64));
    let each = most / places.len().max(1);
    let locate = |&(k, b): &(usize, usize)| {
        let end = |k: usize| match branches[b].place(k) {
            Some(place) => End::of(samples[k].value, &samples[k].modes, place),
            None => End::absent(samples[k].value),
        };
        let found = locate(problem, axis, (tolerance, each), b, [end(k), end(k + 1)]);
        observer.advance(1);
        found
    };
    let found: Result<Vec<Critical>> = places.iter().map(locate).collect();
    observer.end();
    let mut found = found?;
    let along = (axis.to - axis.from).signum();
    found.sort_by(|x, y| (along * x.value).total_cmp(&(along * y.value)).then(x.branch.cmp(&y.branch)));
    Ok(found)
}

/// Whether a branch grows at each sample, given λ and the rounding of σ: where it is unstable, and before and after that as long as
/// σ is more than its rounding, though less than an undamped mode needs to be called unstable.
fn growing(growth: &[Option<(c64, f64)>]) -> Vec<bool> {
    let positive = |k: usize| growth[k].is_some_and(|(z, rounding)| z.re > rounding);
    let mut grows: Vec<bool> = growth.iter().map(|at| at.is_some_and(|(z, _)| unstable(z))).collect();
    for k in 1..grows.len() {
        grows[k] |= grows[k - 1] && positive(k);
    }
    for k in (1..grows.len()).rev() {
        grows[k - 1] |= grows[k] && positive(k - 1);
    }
    grows
}

/// Whether a mode does not oscillate.
fn diverges(z: c64) -> bool {
    z.im.abs() <= 1e-9 * z.norm()
}

/// Whether λ of one sample grows without oscillation, as more modes do than at the sample `without` it.
fn begins_to_diverge(z: c64, without: &Sample, with: &Sample) -> bool {
    let count =
        |sample: &Sample| sample.modes.eigenvalues.iter().filter(|z| unstable(**z) && diverges(**z)).count();
    unstable(z) && diverges(z) && count(with) > count(without)
}

/// What rounding may leave of σ of eigenvalue `k`: [`ROUNDING`] of |λ|, and near another one, with which it may be about to merge,
/// more by |λ| over their distance, at most [`ROUND_OFF`] of |λ|.
pub(super) fn rounding(all: &[c64], k: usize) -> f64 {
    let (z, size) = (all[k], all[k].norm());
    let others = all.iter().enumerate().filter(|(j, _)| *j != k);
    let gap = others.map(|(_, other)| (other - z).norm()).fold(f64::INFINITY, f64::min);
    size * (ROUNDING * (1.0 + 1e-2 * size / gap.max(f64::MIN_POSITIVE))).min(ROUND_OFF)
}

/// Narrows the bracket between two neighbouring samples, with so many solutions at most. The mode is followed from its unstable end:
/// beyond a coalescence two modes have one frequency, and only from there it is plain which of them grows.
///
/// A damped mode passes zero: the root of σ is sought. Of an undamped one, whose σ is rounding at the stable end, the end of the
/// growth is sought: where σ is no longer more than its rounding, and from there on by the line through two growth rates.
fn locate(
    problem: &dyn SweepProblem,
    axis: &Axis,
    (tolerance, most): (f64, usize),
    branch: usize,
    ends: [End; 2],
) -> Result<Critical> {
    let rises = ends[1].lambda.re > ends[0].lambda.re;
    let (below, above) = (&ends[usize::from(!rises)], &ends[usize::from(rises)]);
    let damped = below.lambda.re < -below.rounding;
    let f = |end: &End| if damped { end.lambda.re } else { end.lambda.re - end.rounding };
    let mut known = ends.to_vec();
    let slope = ((above.lambda.re - below.lambda.re) / (above.value - below.value)).abs();
    let bracket = Bracket { below: (below.value, f(below).min(0.0)), above: (above.value, f(above)) };
    let accuracy = |x: f64| tolerance * x.abs().max(1e-6 * (axis.to - axis.from).abs());
    let width = accuracy(0.5 * (below.value + above.value));
    let mut gap = f64::INFINITY;
    let found = narrow(bracket, width, most, |x| {
        // A solution that fails between two that did not ends the search: its bracket is what is known.
        let modes = match problem.modes(&[x]) {
            Err(Error::Analysis { .. }) => return Ok(f64::NAN),
            other => other?,
        };
        let growing = known.iter().filter(|end| f(end) > 0.0);
        let near = growing.min_by(|a, b| (a.value - x).abs().total_cmp(&(b.value - x).abs()));
        let near = near.unwrap_or(above);
        let cost = |k: &usize| {
            let comparable = modes.vectors.nrows() == near.vector.len() && !near.vector.is_empty();
            let mac = if comparable { mac(&near.vector, modes.vector(*k)) } else { 1.0 };
            difference(near.lambda, modes.eigenvalues[*k], mac)
                + 0.5 * (modes.eigenvalues[*k] - near.lambda).norm()
                    / near.lambda.norm().max(f64::MIN_POSITIVE)
        };
        let best = (0..modes.eigenvalues.len()).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(best) = best else { return Ok(-1.0) };
        let end = End::of(x, &modes, best);
        let others = modes.eigenvalues.iter().enumerate().filter(|(k, _)| *k != best);
        gap = others.map(|(_, z)| (z - end.lambda).norm()).fold(f64::INFINITY, f64::min);
        let growth = f(&end);
        known.push(end);
        Ok(growth)
    })?;
    let wide = (found.above.0 - found.below.0).abs() > width;
    let mut uncertainty = 0.5 * (found.above.0 - found.below.0).abs();
    let mut value = 0.5 * (found.below.0 + found.above.0);
    // What grows is known from the growing end: the mode may not be there at the other one.
    let grown = known.iter().find(|end| end.value == found.above.0).unwrap_or(above).lambda;
    let at = known.iter().min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()));
    let lambda = if diverges(grown) { grown } else { at.map_or(grown, |end| end.lambda) };
    let kind = match () {
        () if diverges(grown) => CriticalKind::Divergence,
        () if gap < 2e-3 * lambda.norm() => CriticalKind::Merging,
        () => CriticalKind::Growth,
    };
    if kind == CriticalKind::Growth && !damped && !wide {
        let root = extrapolated(&known, found.above.0, below.value);
        uncertainty = uncertainty.max(0.5 * (root - value).abs());
        value = root;
    }
    Ok(Critical { branch, value, uncertainty, eigenvalue: lambda, rises, kind, slope, wide })
}

/// Where the line through the growth rates at `last`, the smallest that is more than rounding, and at the next known place where it is
/// four times as large is zero; not beyond `end`.
fn extrapolated(known: &[End], last: f64, end: f64) -> f64 {
    let Some(first) = known.iter().find(|k| k.value == last) else { return last };
    let far = known.iter().filter(|k| k.lambda.re > 4.0 * first.lambda.re);
    let near = far.min_by(|a, b| (a.value - last).abs().total_cmp(&(b.value - last).abs()));
    let Some(near) = near else { return last };
    let root = last - first.lambda.re * (near.value - last) / (near.lambda.re - first.lambda.re);
    root.clamp(last.min(end), last.max(end))
}
