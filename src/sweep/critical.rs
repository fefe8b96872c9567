//! Critical values: where a branch becomes unstable or stable, located between two values of the sweep.

use super::assign::difference;
use super::branch::{Branch, Sample};
use super::root::{Bracket, narrow};
use super::{Axis, Modes, ROUND_OFF, SweepProblem, unstable};
use crate::error::Result;
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
}

impl End {
    fn of(value: f64, modes: &Modes, k: usize) -> Self {
        End { value, lambda: modes.eigenvalues[k], vector: modes.vector(k).to_vec() }
    }
}

pub(super) fn critical_values(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
    observer: &dyn Observer,
) -> Result<Vec<Critical>> {
    let mut places: Vec<(usize, usize)> = Vec::new();
    for (b, branch) in branches.iter().enumerate() {
        for (k, pair) in branch.eigenvalues.windows(2).enumerate() {
            if unstable(pair[0]) != unstable(pair[1]) {
                places.push((branch.first + k, b));
            }
        }
    }
    places.sort_unstable();
    observer.begin("critical values", Some(places.len() as u64));
    let locate = |&(k, b): &(usize, usize)| {
        let end = |k: usize| {
            let place = branches[b].place(k).expect("the branch has both ends");
            End::of(samples[k].value, &samples[k].modes, place)
        };
        let found = locate(problem, axis, tolerance, b, [end(k), end(k + 1)]);
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

/// Narrows the bracket between two neighbouring samples. The mode is followed from its unstable end: beyond a
/// coalescence two modes have one frequency, and only from there it is plain which of them grows.
fn locate(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    branch: usize,
    ends: [End; 2],
) -> Result<Critical> {
    let rises = unstable(ends[1].lambda);
    // A clearly damped mode passes zero smoothly; an undamped one leaves the round-off.
    let stable = &ends[usize::from(!rises)];
    let threshold = if stable.lambda.re < -1e-6 * stable.lambda.norm() { 0.0 } else { ROUND_OFF };
    let f = |z: c64| z.re - threshold * z.norm();
    let mut known = ends.to_vec();
    let (below, above) = (&ends[usize::from(!rises)], &ends[usize::from(rises)]);
    let slope = ((above.lambda.re - below.lambda.re) / (above.value - below.value)).abs();
    let bracket = Bracket { below: (below.value, f(below.lambda)), above: (above.value, f(above.lambda)) };
    let accuracy = |x: f64| tolerance * x.abs().max(1e-6 * (axis.to - axis.from).abs());
    let width = accuracy(0.5 * (below.value + above.value));
    let mut gap = f64::INFINITY;
    let found = narrow(bracket, width, |x| {
        let modes = problem.modes(&[x])?;
        let growing = known.iter().filter(|end| f(end.lambda) > 0.0);
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
        let lambda = modes.eigenvalues[best];
        let others = modes.eigenvalues.iter().enumerate().filter(|(k, _)| *k != best);
        gap = others.map(|(_, z)| (z - lambda).norm()).fold(f64::INFINITY, f64::min);
        known.push(End::of(x, &modes, best));
        Ok(f(lambda))
    })?;
    let value = 0.5 * (found.below.0 + found.above.0);
    let at = known.iter().min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()));
    let lambda = at.map_or(c64::new(0.0, 0.0), |end| end.lambda);
    let kind = match () {
        () if lambda.im <= 1e-9 * lambda.norm() => CriticalKind::Divergence,
        () if gap < 2e-3 * lambda.norm() => CriticalKind::Merging,
        () => CriticalKind::Growth,
    };
    let uncertainty = 0.5 * (found.above.0 - found.below.0).abs();
    Ok(Critical { branch, value, uncertainty, eigenvalue: lambda, rises, kind, slope })
}
