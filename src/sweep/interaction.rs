//! Interactions of two branches: crossing, veering, merging (N. C. Perkins and C. D. Mote, J. Sound Vib. 106 (1986) 451).

use super::assign::assign;
use super::branch::{Branch, Sample};
use super::{Axis, Modes, SweepProblem};
use crate::error::Result;
use rayon::prelude::*;

/// Branches that come nearer than this share of |λ| interact …
const NEAR: f64 = 0.01;
/// … and minima of the samples below this share are refined, because the nearest place lies between samples.
const CANDIDATE: f64 = 0.05;
/// A minimum by less than this part of the distance is none: doublets keep theirs, but for round-off.
const DIP: f64 = 1e-3;

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

/// Every local minimum of the distance of two branches that is small, narrowed to `tolerance` by golden sections.
pub(super) fn interactions(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
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
    let refine =
        |(pair, k): &([usize; 2], usize)| interaction(problem, axis, tolerance, samples, branches, *pair, *k);
    let refined: Result<Vec<Interaction>> = match problem.parallel() {
        true => near.par_iter().map(refine).collect(),
        false => near.iter().map(refine).collect(),
    };
    let mut found: Vec<Interaction> = refined?.into_iter().filter(|m| m.distance < NEAR).collect();
    let along = (axis.to - axis.from).signum();
    found.sort_by(|x, y| (along * x.value).total_cmp(&(along * y.value)).then(x.branches.cmp(&y.branches)));
    Ok(found)
}

fn interaction(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
    pair: [usize; 2],
    k: usize,
) -> Result<Interaction> {
    let place = |b: usize| branches[b].place(k).expect("the branch is there");
    let places = [place(pair[0]), place(pair[1])];
    // The modes at the sample are the reference by which the two are found again.
    let reference = &samples[k].modes;
    let measure = |x: f64| -> Result<(f64, f64)> {
        let modes = problem.modes(&[x])?;
        Ok(distance(reference, places, &modes))
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (samples[k - 1].value, samples[k + 1].value);
    let width = tolerance * samples[k].value.abs().max(1e-3 * (axis.to - axis.from).abs());
    let (mut x1, mut x2) = (high - golden * (high - low), low + golden * (high - low));
    let (mut f1, mut f2) = (measure(x1)?, measure(x2)?);
    while (high - low).abs() > width && x1 != x2 {
        if f1.0 <= f2.0 {
            (high, x2, f2) = (x2, x1, f1);
            x1 = high - golden * (high - low);
            f1 = measure(x1)?;
        } else {
            (low, x1, f1) = (x1, x2, f2);
            x2 = low + golden * (high - low);
            f2 = measure(x2)?;
        }
    }
    let (value, (distance, omega)) = if f1.0 <= f2.0 { (x1, f1) } else { (x2, f2) };
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
    let frequency_hz = omega / std::f64::consts::TAU;
    Ok(Interaction { branches: pair, value, distance, frequency_hz, kind })
}

/// The relative distance of the two modes that those at `places` of `reference` have become, and their mean Im λ.
fn distance(reference: &Modes, places: [usize; 2], modes: &Modes) -> (f64, f64) {
    let link = assign(reference, modes);
    let [a, b] = places.map(|p| link.to[p].map(|(j, _)| modes.eigenvalues[j]));
    match (a, b) {
        (Some(a), Some(b)) => {
            ((a - b).norm() / a.norm().max(b.norm()).max(f64::MIN_POSITIVE), 0.5 * (a.im + b.im))
        }
        _ => (f64::INFINITY, 0.0),
    }
}
