//! Interactions of two branches: crossing, veering, merging (N. C. Perkins and C. D. Mote, J. Sound Vib. 106 (1986) 451).

use super::assign::assign;
use super::at_once::solve_all;
use super::branch::{Branch, Sample};
use super::{Axis, SweepProblem};
use crate::error::{Error, Result};
use crate::linalg::c64;
use std::f64::consts::TAU;

/// Branches that come nearer than this share of |λ| interact …
const NEAR: f64 = 0.01;
/// … and minima of the samples below this share are refined, because the nearest place lies between samples.
const CANDIDATE: f64 = 0.05;
/// A minimum by less than this part of the distance is none: doublets keep theirs, but for round-off.
const DIP: f64 = 1e-3;

/// Where a step would lower |λ₁ − λ₂|² by less than this part, its place is found: there the distance is flat.
const FLAT: f64 = 1e-9;
/// Steps at most.
const STEPS: usize = 80;
/// The shorter part of a golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Pieces in which the minimum of a parabola is sought first.
const PIECES: usize = 64;

/// Interaction of two branches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interaction {
    /// The branches, indices into [`super::Sweep::branches`].
    pub branches: [usize; 2],
    /// The value of the parameter at which they are nearest.
    pub value: f64,
    /// Their distance there, |λ₁ − λ₂| / |λ|.
    pub distance: f64,
    /// ω/2π between them \[Hz\].
    pub frequency_hz: f64,
    /// Kind of interaction.
    pub kind: InteractionKind,
}

/// Kind of interaction of two branches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InteractionKind {
    /// Their frequencies pass through each other, each keeps its shape.
    Crossing,
    /// Their frequencies veer away from each other and their shapes are exchanged.
    Veering,
    /// Their frequencies become one: flutter begins or ends.
    Merging,
}

/// Every local minimum of the distance of two branches that is small, narrowed to `tolerance`, all with `most` solutions at most.
pub(super) fn interactions(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
    most: usize,
) -> Result<Vec<Interaction>> {
    let mut near = Vec::new();
    for a in 0..branches.len() {
        for b in a + 1..branches.len() {
            let distance = |k: usize| {
                let (x, y) = (branches[a].at(k)?, branches[b].at(k)?);
                Some((x - y).norm() / x.norm().max(y.norm()).max(f64::MIN_POSITIVE))
            };
            for k in 1..samples.len().saturating_sub(1) {
                let (Some(before), Some(here), Some(after)) = (distance(k - 1), distance(k), distance(k + 1))
                else {
                    continue;
                };
                let dips = here < before && here <= after && before.max(after) > (1.0 + DIP) * here;
                if here < CANDIDATE && dips {
                    near.push(([a, b], k));
                }
            }
        }
    }
    let steps = (most / near.len().max(1)).min(STEPS);
    let refine = |candidate: usize| {
        let (pair, k) = near[candidate];
        interaction(problem, axis, (tolerance, steps), samples, branches, pair, k)
    };
    let refined = solve_all(problem.at_once(), 0..near.len(), &refine)?;
    let mut found: Vec<Interaction> = refined.into_iter().filter(|m| m.distance < NEAR).collect();
    let along = (axis.to - axis.from).signum();
    found.sort_by(|x, y| (along * x.value).total_cmp(&(along * y.value)).then(x.branches.cmp(&y.branches)));
    Ok(found)
}

fn interaction(
    problem: &dyn SweepProblem,
    axis: &Axis,
    (tolerance, steps): (f64, usize),
    samples: &[Sample],
    branches: &[Branch],
    pair: [usize; 2],
    k: usize,
) -> Result<Interaction> {
    let place = |b: usize| branches[b].place(k).expect("the branch is there");
    let places = [place(pair[0]), place(pair[1])];
    // The modes at the sample are the reference by which the two are found again.
    let reference = &samples[k].modes;
    let measure = |value: f64| -> Result<Gap> {
        let modes = match problem.modes(&[value]) {
            Err(Error::Analysis { .. }) => return Ok(Gap { value, modes: None }),
            other => other?,
        };
        let link = assign(reference, &modes);
        let [a, b] = places.map(|p| link.to[p].map(|(j, _)| modes.eigenvalues[j]));
        Ok(Gap { value, modes: a.zip(b) })
    };
    let known = [k - 1, k, k + 1].map(|k| {
        let [a, b] = pair.map(|b| branches[b].at(k));
        Gap { value: samples[k].value, modes: a.zip(b) }
    });
    let width = tolerance * samples[k].value.abs().max(1e-3 * (axis.to - axis.from).abs());
    let gap = narrowest(known, width, steps, measure)?;
    let order = |k: usize| {
        let at = |b: usize| branches[b].at(k).map_or(0.0, |z| z.im);
        let (p, q) = (at(pair[0]), at(pair[1]));
        if (p - q).abs() <= 1e-7 * p.abs().max(q.abs()) { 0.0 } else { (p - q).signum() }
    };
    let kind = match (order(k - 1), order(k + 1)) {
        (p, q) if p == 0.0 || q == 0.0 => InteractionKind::Merging,
        (p, q) if p != q => InteractionKind::Crossing,
        _ => InteractionKind::Veering,
    };
    let frequency_hz = gap.modes.map_or(0.0, |(a, b)| 0.5 * (a.im + b.im)) / TAU;
    Ok(Interaction { branches: pair, value: gap.value, distance: gap.distance(), frequency_hz, kind })
}

/// Two modes at a value of the parameter.
#[derive(Debug, Clone, Copy)]
struct Gap {
    value: f64,
    /// λ₁ and λ₂, where both are found.
    modes: Option<(c64, c64)>,
}

impl Gap {
    /// (λ₁ − λ₂)/|λ|.
    fn difference(&self) -> Option<c64> {
        self.modes.map(|(a, b)| (a - b) / a.norm().max(b.norm()).max(f64::MIN_POSITIVE))
    }

    /// |λ₁ − λ₂|/|λ|.
    fn distance(&self) -> f64 {
        self.difference().map_or(f64::INFINITY, |d| d.norm())
    }

    /// (λ₁ − λ₂)²/|λ|², which is smooth where the modes cross, veer or merge: the discriminant of the characteristic polynomial of the two.
    fn square(&self) -> c64 {
        self.difference().map_or(c64::new(f64::NAN, f64::NAN), |d| d * d)
    }
}

/// Where two modes are nearest: a minimum of |λ₁ − λ₂|²/|λ|², of which three values with the least in the middle are known, to within `width`
/// or where it is flat.
///
/// Each step goes to the minimum of the parabola through the three values that are nearest to the least one, or, where that does not
/// close in, by a golden section into the longer side, as Brent's method does (Algorithms for Minimization without Derivatives, 1973).
fn narrowest(
    [mut low, mut least, mut high]: [Gap; 3],
    width: f64,
    most: usize,
    mut measure: impl FnMut(f64) -> Result<Gap>,
) -> Result<Gap> {
    let mut known = vec![low, least, high];
    // Lengths of the last two steps.
    let mut steps = [f64::INFINITY; 2];
    for step in 0..most {
        let side =
            if (high.value - least.value).abs() > (low.value - least.value).abs() { high } else { low };
        let section = least.value + GOLDEN * (side.value - least.value);
        let (ahead, modulus) = minimum_of_parabola(&known, least.value, [low.value, high.value]);
        let length = (ahead - least.value).abs();
        let flat = modulus > (1.0 - FLAT) * least.square().norm();
        // The first parabolas are not confirmed yet.
        if ((length <= width || flat) && step > 1) || (high.value - low.value).abs() <= width {
            break;
        }
        let value = if length < 0.5 * steps[0] && length > 0.1 * width { ahead } else { section };
        if known.iter().any(|gap| gap.value == value) {
            break;
        }
        steps = [steps[1], (value - least.value).abs()];
        let gap = measure(value)?;
        known.push(gap);
        let above = (value - least.value) * (high.value - least.value) > 0.0;
        match (gap.distance() < least.distance(), above) {
            (true, true) => (low, least) = (least, gap),
            (true, false) => (high, least) = (least, gap),
            (false, true) => high = gap,
            (false, false) => low = gap,
        }
    }
    Ok(least)
}

/// Where the modulus of the parabola through (λ₁ − λ₂)²/|λ|² at the three places nearest to `least` is least, between two ends, and that
/// modulus; not numbers where there are no such three.
fn minimum_of_parabola(known: &[Gap], least: f64, [from, to]: [f64; 2]) -> (f64, f64) {
    let mut near: Vec<&Gap> = known.iter().filter(|gap| gap.modes.is_some()).collect();
    near.sort_by(|a, b| (a.value - least).abs().total_cmp(&(b.value - least).abs()));
    let [a, b, c, ..] = near[..] else { return (f64::NAN, f64::NAN) };
    let slope = |a: &Gap, b: &Gap| (b.square() - a.square()) / (b.value - a.value);
    let (first, second) = (slope(a, b), (slope(b, c) - slope(a, b)) / (c.value - a.value));
    let modulus = |x: f64| (a.square() + (first + second * (x - b.value)) * (x - a.value)).norm();
    let place = |t: f64| from + t * (to - from);
    let nearest = (0..=PIECES).min_by(|p, q| {
        let modulus = |k: usize| modulus(place(k as f64 / PIECES as f64));
        modulus(*p).total_cmp(&modulus(*q))
    });
    let nearest = nearest.unwrap_or(0) as f64;
    let [mut low, mut high] = [nearest - 1.0, nearest + 1.0].map(|k| (k / PIECES as f64).clamp(0.0, 1.0));
    for _ in 0..STEPS {
        let [left, right] = [low + GOLDEN * (high - low), high - GOLDEN * (high - low)];
        if modulus(place(left)) <= modulus(place(right)) { high = right } else { low = left }
    }
    let found = place(0.5 * (low + high));
    (found, modulus(found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// Two undamped modes of frequencies ω₀² ± √s(x).
    fn two(x: f64, s: impl Fn(f64) -> f64) -> Gap {
        let root = c64::new(s(x), 0.0).sqrt();
        let i = c64::new(0.0, 1.0);
        Gap { value: x, modes: Some((i * (1.0 + root).sqrt(), i * (1.0 - root).sqrt())) }
    }

    #[test]
    fn the_nearest_place_takes_few_steps() {
        // Veering; a crossing; the end of a range of flutter; a crossing inside of two that are one at the ends, descending.
        type Square = fn(f64) -> f64;
        let cases: [(Square, [f64; 3], f64); 4] = [
            (|x| 1e-4 + 0.01 * (x - 0.3).powi(2) + 0.004 * (x - 0.3).powi(3), [0.0, 0.4, 1.0], 0.3),
            (|x| (0.1 * (x - 0.7) + 0.03 * (x - 0.7).powi(2)).powi(2), [0.0, 0.6, 1.0], 0.7),
            (|x| 0.05 * (x.exp() - 0.25_f64.exp()), [0.0, 0.2, 1.0], 0.25),
            (|x| (0.1 * (x - 0.3)).powi(2), [1.0, 0.4, 0.0], 0.3),
        ];
        for (k, (square, places, exact)) in cases.into_iter().enumerate() {
            let mut count = 0;
            let found = narrowest(places.map(|x| two(x, square)), 1e-7, STEPS, |x| {
                count += 1;
                Ok(two(x, square))
            });
            let found = found.unwrap().value;
            // Where the square of the distance of veering modes is flat, to a part of 1e9: 1e-4 + x²/100 for x up to 3e-6. Times ten.
            assert!(
                within((found - exact).abs(), 3e-5, Tolerance) && count <= 9,
                "{k}: {found} after {count}"
            );
        }
    }

    #[test]
    fn places_without_the_two_modes_are_passed_over() {
        let square = |x: f64| 1e-4 + 0.01 * (x - 0.3).powi(2);
        let gap = |x: f64| if x < 0.2 { Gap { value: x, modes: None } } else { two(x, square) };
        let found = narrowest([0.0, 0.45, 1.0].map(gap), 1e-6, STEPS, |x| Ok(gap(x))).unwrap();
        assert!(within((found.value - 0.3).abs(), 2e-6, Tolerance), "{}", found.value);
    }
}
