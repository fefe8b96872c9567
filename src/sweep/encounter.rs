//! Encounters: where two branches come nearest to each other.

use super::assign::assign;
use super::branch::{Branch, Sample};
use super::{Axis, Modes, Problem};
use crate::error::Result;
use rayon::prelude::*;

/// Branches that come nearer than this share of |λ| meet …
const NEAR: f64 = 0.01;
/// … and samples so near are looked at, because the nearest place lies between them.
const WORTH_A_LOOK: f64 = 0.05;
/// A minimum by less than this part of the distance is none: twin modes keep theirs, but for round-off.
const DIP: f64 = 1e-3;

/// Two branches near each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// The branches, indices into [`super::Sweep::branches`].
    pub branches: [usize; 2],
    /// The value of the parameter at which they are nearest.
    pub value: f64,
    /// Their distance there, |λ₁ − λ₂| / |λ|.
    pub distance: f64,
    /// ω/2π between them \[Hz\].
    pub frequency_hz: f64,
    /// Kind of interaction.
    pub kind: EncounterKind,
}

/// Kind of interaction of two branches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EncounterKind {
    /// Their frequencies pass through each other, each keeps its shape.
    Crossing,
    /// They turn away from each other and exchange their shapes.
    Veering,
    /// Their frequencies become one: flutter begins or ends.
    Merging,
}

/// Every local minimum of the distance of two branches that is small, narrowed to `tolerance` by golden sections.
pub(super) fn encounters(
    problem: &dyn Problem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
) -> Result<Vec<Encounter>> {
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
                if here < WORTH_A_LOOK && dips {
                    near.push(([a, b], k));
                }
            }
        }
    }
    let look =
        |(pair, k): &([usize; 2], usize)| encounter(problem, axis, tolerance, samples, branches, *pair, *k);
    let looked: Result<Vec<Encounter>> = match problem.parallel() {
        true => near.par_iter().map(look).collect(),
        false => near.iter().map(look).collect(),
    };
    let mut found: Vec<Encounter> = looked?.into_iter().filter(|m| m.distance < NEAR).collect();
    let along = (axis.to - axis.from).signum();
    found.sort_by(|x, y| (along * x.value).total_cmp(&(along * y.value)).then(x.branches.cmp(&y.branches)));
    Ok(found)
}

fn encounter(
    problem: &dyn Problem,
    axis: &Axis,
    tolerance: f64,
    samples: &[Sample],
    branches: &[Branch],
    pair: [usize; 2],
    k: usize,
) -> Result<Encounter> {
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
        (p, q) if p == 0.0 || q == 0.0 => EncounterKind::Merging,
        (p, q) if p != q => EncounterKind::Crossing,
        _ => EncounterKind::Veering,
    };
    let frequency_hz = omega / std::f64::consts::TAU;
    Ok(Encounter { branches: pair, value, distance, frequency_hz, kind })
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
