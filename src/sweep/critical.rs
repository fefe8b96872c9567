//! Critical values: where a branch becomes unstable or stable, located between two values of the sweep.

use super::assign::difference;
use super::branch::{Branch, Sample};
use super::root::{Bracket, narrow};
use super::rounding::{apart, merges};
use super::{Axis, Modes, SweepProblem, unstable};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::dense::mac;
use crate::progress::Observer;
use crate::stability::is_real;

/// A value of the parameter at which a branch becomes unstable or stable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The branch, an index into [`super::Sweep::branches`].
    pub branch: usize,
    /// The value.
    pub value: f64,
    /// What it may be off by: half the length of the bracket that holds it, or, where rounding hides in more than that whether the mode
    /// grows, the distance to the places where it certainly does and does not.
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
    /// Whether it differs from others by more than rounding.
    apart: bool,
}

impl End {
    fn of(value: f64, modes: &Modes, k: usize) -> Self {
        let rounding = modes.rounding(k);
        let apart = apart(&modes.eigenvalues, k, rounding);
        End { value, lambda: modes.eigenvalues[k], vector: modes.vector(k).to_vec(), rounding, apart }
    }

    /// Where the mode is not.
    fn absent(value: f64) -> Self {
        End { value, lambda: c64::new(0.0, 0.0), vector: Vec::new(), rounding: 0.0, apart: true }
    }

    /// Whether it grows or does not grow whatever rounding did. An undamped mode does not while it has not merged with another one.
    fn settled(&self, damped: bool) -> bool {
        let sure = SURE * self.rounding;
        let still = if damped { self.lambda.re < -sure } else { self.apart };
        self.lambda.re > sure || still
    }
}

/// Samples before and after a bracket at most that are looked at.
const BEYOND: usize = 16;
/// The sign of σ is sure where it is this many times what rounding leaves of it.
const SURE: f64 = 10.0;
/// Of an undamped mode by itself the growth begins nearer to where it is rounding than to where it is this many times as large, if it
/// begins with a power of the parameter up to the fifth.
const LARGE: f64 = 32.0;

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
            Some((sample.modes.eigenvalues[place], sample.modes.rounding(place)))
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
                (Some(z), None) => begins_to_diverge(z, &samples[k + 1], &samples[k]),
                (None, Some(z)) => begins_to_diverge(z, &samples[k], &samples[k + 1]),
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
        let followed = |k: usize| {
            let sample = samples.get(k)?;
            Some(End::of(sample.value, &sample.modes, branches[b].place(k)?))
        };
        let end = |k: usize| followed(k).unwrap_or_else(|| End::absent(samples[k].value));
        // As far as where rounding no longer matters.
        let outward = |order: &mut dyn Iterator<Item = usize>| {
            let mut all: Vec<End> = Vec::new();
            for end in order.take(BEYOND).map_while(followed) {
                let small = end.lambda.re.abs() <= LARGE * end.rounding;
                all.push(end);
                if !small {
                    break;
                }
            }
            all
        };
        let beyond = [outward(&mut (0..k).rev()), outward(&mut (k + 2..samples.len()))];
        let found = locate(problem, axis, (tolerance, each), b, [end(k), end(k + 1)], beyond);
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
    for (k, grows) in grows.iter_mut().enumerate() {
        *grows &= positive(k);
    }
    for k in 1..grows.len() {
        grows[k] |= grows[k - 1] && positive(k);
    }
    for k in (1..grows.len()).rev() {
        grows[k - 1] |= grows[k] && positive(k - 1);
    }
    grows
}

/// Whether λ of one sample, given with its rounding, grows without oscillation, as more modes do than at the sample `without` it, if that
/// has an answer.
fn begins_to_diverge((z, rounding): (c64, f64), without: &Sample, with: &Sample) -> bool {
    let grows = |z: c64, rounding: f64| unstable(z) && z.re > rounding && is_real(z);
    let count = |Sample { modes, .. }: &Sample| {
        let all = modes.eigenvalues.iter().enumerate();
        all.filter(|(k, z)| grows(**z, modes.rounding(*k))).count()
    };
    without.why_none.is_none() && grows(z, rounding) && count(with) > count(without)
}

/// Narrows the bracket between two neighbouring samples, with so many solutions at most. The mode is followed from its unstable end:
/// beyond a coalescence two modes have one frequency, and only from there it is plain which of them grows. `beyond` are the samples
/// before and after the two, from them outwards.
///
/// A damped mode passes zero: the root of σ is sought. Of an undamped one, whose σ is rounding at the stable end, the end of the
/// growth is sought: where σ is no longer more than its rounding, and from there on by the line through two growth rates.
///
/// Where σ, or of a pair that merges its square, has a root of higher order, rounding hides the sign in more than the bracket: the
/// value lies between the places where the mode certainly grows and certainly does not, which the uncertainty covers.
fn locate(
    problem: &dyn SweepProblem,
    axis: &Axis,
    (tolerance, most): (f64, usize),
    branch: usize,
    ends: [End; 2],
    beyond: [Vec<End>; 2],
) -> Result<Critical> {
    let rises = ends[1].lambda.re > ends[0].lambda.re;
    let (below, above) = (&ends[usize::from(!rises)], &ends[usize::from(rises)]);
    let stable_side = std::iter::once(below).chain(&beyond[usize::from(!rises)]);
    let damped = stable_side.into_iter().any(|end| end.lambda.re < -end.rounding);
    let f = |end: &End| if damped { end.lambda.re } else { end.lambda.re - end.rounding };
    let mut followed = Followed {
        problem,
        known: ends.iter().cloned().chain(beyond.iter().flatten().cloned()).collect(),
        gap: f64::INFINITY,
        left: most,
    };
    let slope = ((above.lambda.re - below.lambda.re) / (above.value - below.value)).abs();
    let bracket = Bracket { below: (below.value, f(below).min(0.0)), above: (above.value, f(above)) };
    let accuracy = |x: f64| tolerance * x.abs().max(1e-6 * (axis.to - axis.from).abs());
    let width = accuracy(0.5 * (below.value + above.value));
    let found = narrow(bracket, width, most, |x| {
        // A solution that fails between two that did not ends the search: its bracket is what is known.
        let end = followed.at(x, above, f)?;
        Ok(end.map_or(f64::NAN, |end| end.map_or(-1.0, |end| f(&end))))
    })?;
    let ([x, y], gap) = ([found.below.0, found.above.0], followed.gap);
    let wide = (y - x).abs() > width;
    let mut value = 0.5 * (x + y);
    // What grows is known from the growing end: the mode may not be there at the other one.
    let grown = followed.known.iter().find(|end| end.value == y).unwrap_or(above);
    let at = followed.known.iter().min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()));
    let lambda = if is_real(grown.lambda) { grown.lambda } else { at.unwrap_or(grown).lambda };
    let kind = match () {
        () if is_real(grown.lambda) => CriticalKind::Divergence,
        () if gap < 2e-3 * lambda.norm() && merges(lambda, grown.rounding) => CriticalKind::Merging,
        () => CriticalKind::Growth,
    };
    let mut uncertainty = 0.5 * (y - x).abs();
    if kind == CriticalKind::Growth && !damped && !wide {
        let root = extrapolated(&followed.known, y, below.value);
        let large = |end: &End| end.lambda.re > LARGE * end.rounding;
        let far = followed.edge([x, y], width, above, f, large)?;
        uncertainty = uncertainty.max(0.5 * (root - value).abs()).max((far - y).abs());
        value = root;
    } else {
        let settled = |end: &End| end.settled(damped);
        let from = followed.edge([y, x], width, above, f, settled)?;
        let to = followed.edge([x, y], width, above, f, settled)?;
        if !damped {
            value = 0.5 * (from + to);
        }
        uncertainty = uncertainty.max((value - from).abs()).max((to - value).abs());
    }
    Ok(Critical { branch, value, uncertainty, eigenvalue: lambda, rises, kind, slope, wide })
}

/// A mode that is followed through a bracket.
struct Followed<'a> {
    problem: &'a dyn SweepProblem,
    /// Where it is known.
    known: Vec<End>,
    /// Distance of λ from the next mode at the last value.
    gap: f64,
    /// Solutions that may still be taken.
    left: usize,
}

impl Followed<'_> {
    /// The mode at `x`, followed from the nearest value at which `f` is positive, or else from `above`; `None` where the analysis fails,
    /// and where there is no mode.
    fn at(&mut self, x: f64, above: &End, f: impl Fn(&End) -> f64) -> Result<Option<Option<End>>> {
        self.left = self.left.saturating_sub(1);
        let modes = match self.problem.modes(&[x]) {
            Err(Error::Analysis { .. }) => return Ok(None),
            other => other?,
        };
        let growing = self.known.iter().filter(|end| f(end) > 0.0);
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
        let Some(best) = best else { return Ok(Some(None)) };
        let end = End::of(x, &modes, best);
        let others = modes.eigenvalues.iter().enumerate().filter(|(k, _)| *k != best);
        self.gap = others.map(|(_, z)| (z - end.lambda).norm()).fold(f64::INFINITY, f64::min);
        self.known.push(end.clone());
        Ok(Some(Some(end)))
    }

    /// From `y` on, away from `x`: a value at which what `holds` is known to hold, nearer to the first such value than `width` or a
    /// quarter of its distance from `x`; the farthest that is known where none is.
    fn edge(
        &mut self,
        [x, y]: [f64; 2],
        width: f64,
        above: &End,
        f: impl Fn(&End) -> f64,
        holds: impl Fn(&End) -> bool,
    ) -> Result<f64> {
        let distance = |end: &End| (end.value - x) * (y - x).signum();
        let side = self.known.iter().filter(|end| distance(end) >= (y - x).abs());
        let (hold, not): (Vec<&End>, Vec<&End>) = side.partition(|end| holds(end));
        let first = hold.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let last = not.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(first) = first else { return Ok(last.map_or(y, |end| end.value)) };
        let mut outer = first.value;
        let before = not.iter().filter(|end| distance(end) < distance(first));
        let mut inner = before.max_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(y, |end| end.value);
        while self.left > 0 && (outer - inner).abs() > width.max(0.25 * (inner - x).abs()) {
            let middle = 0.5 * (outer + inner);
            if middle == outer || middle == inner {
                break;
            }
            match self.at(middle, above, &f)? {
                Some(Some(end)) if !holds(&end) => inner = middle,
                Some(_) => outer = middle,
                None => break,
            }
        }
        Ok(outer)
    }
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
