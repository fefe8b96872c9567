//! A reduced model beside the full one: its complex eigenvalues, and the first steps of the motion.

use super::in_time::InTime;
use super::places::TransientPlaces;
use crate::case::{ModelChoice, TransientAnalysis};
use crate::equilibrium::SteadySliding;
use crate::error::Result;
use crate::job::sink::{Histories, Memory, ResultStage};
use crate::linalg::c64;
use crate::progress::Observer;
use crate::reduction::Reduced;
use crate::results::{ComplexResult, Deviation, MotionCompared, ReducedCheck};
use crate::stability::{ComplexModes, complex_modes};
use crate::system::System;

/// Below this part of |λ| a growth rate is round-off.
const NO_GROWTH: f64 = 1e-9;
/// Range below which a channel does not move, as a part of its size in steady sliding.
const AT_REST: f64 = 1e-10;
/// The end of the name of a probe's channel.
const DISPLACEMENT: &str = "_displacement";

/// Motion of the full model in the first steps of a reduced run, as many of them as are requested.
pub(super) fn first_steps(
    run: &InTime<'_>,
    wanted: &TransientAnalysis,
    places: &TransientPlaces,
    observer: &dyn Observer,
) -> Result<Option<Histories>> {
    let steps = run.compared(wanted);
    if steps == 0 {
        return Ok(None);
    }
    let full = TransientAnalysis {
        model: Some(ModelChoice::Full),
        compare_steps: None,
        fields_every: None,
        duration: wanted.duration.min(steps as f64 * wanted.time_step),
        ..wanted.clone()
    };
    let places = TransientPlaces { acoustics: None, ..places.clone() };
    let mut nowhere = |_: ResultStage<'_>| Ok(());
    let mut memory = Memory::new(&mut nowhere);
    run.run(&full, places, &mut memory, observer)?;
    Ok(Some(memory.histories))
}

/// Compares `reduced` with the model it was made from, whose steady state and complex modes are known, and the first
/// steps of its motion with those of the `full` model, if they are known; `few` has so many values of a channel of the
/// reduced run.
pub(super) fn reduced_check(
    reduced: &Reduced,
    (full_system, steady, complex): (&System, &SteadySliding, &ComplexResult),
    full: Option<&Histories>,
    few: &dyn Fn(&str, usize) -> Result<Vec<f64>>,
    observer: &dyn Observer,
) -> Result<ReducedCheck> {
    let linear = reduced.linearised(full_system, steady);
    let (system, own) = match &linear {
        Some((system, own)) => (system, own.clone()),
        None => (&reduced.system, reduced.steady(steady)),
    };
    let modes = &complex.modes;
    let [low, high] = complex.band_hz;
    // A mode at the edge may come to lie beyond it.
    let band = [0.9 * low, 1.1 * high];
    let own = complex_modes(system, &own, &reduced.real_modes(), band, observer)?;
    let partners = partners(modes, &own);
    let of = |k: usize| modes.modes[k].eigenvalue;
    let shift =
        |(k, other): &(usize, c64)| Deviation { relative: (other - of(*k)).norm() / of(*k).norm(), mode: *k };
    let growth = |(k, other): &(usize, c64)| {
        let sigma = of(*k).re;
        let deviation = Deviation { relative: (other.re / sigma - 1.0).abs(), mode: *k };
        (sigma.abs() > NO_GROWTH * of(*k).norm()).then_some(deviation)
    };
    let unstable = partners.iter().filter(|(k, _)| modes.modes[*k].unstable());
    let nearest = partners.iter().max_by(|a, b| of(a.0).re.total_cmp(&of(b.0).re));
    let growths = unstable.filter_map(growth).max_by(larger);
    Ok(ReducedCheck {
        modes: [modes.modes.len(), partners.len()],
        eigenvalue: partners.iter().map(shift).max_by(larger),
        growth: growths.or_else(|| nearest.and_then(growth)),
        motion: full.map(|full| motion(steady, full, few)).transpose()?,
    })
}

fn larger(a: &Deviation, b: &Deviation) -> std::cmp::Ordering {
    a.relative.total_cmp(&b.relative)
}

/// For each mode of the full model the eigenvalue of the reduced one that is its own: the nearest pairs first.
fn partners(full: &ComplexModes, few: &ComplexModes) -> Vec<(usize, c64)> {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, mode) in full.modes.iter().enumerate() {
        let away = |other: c64| (other - mode.eigenvalue).norm();
        pairs.extend(few.modes.iter().enumerate().map(|(j, other)| (away(other.eigenvalue), k, j)));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut found: Vec<Option<c64>> = vec![None; full.modes.len()];
    let mut taken = vec![false; few.modes.len()];
    for (_, k, j) in pairs {
        if found[k].is_none() && !taken[j] {
            taken[j] = true;
            found[k] = Some(few.modes[j].eigenvalue);
        }
    }
    found.into_iter().enumerate().filter_map(|(k, other)| Some((k, other?))).collect()
}

/// The first probe and the normal force of the first contact.
fn motion(
    steady: &SteadySliding,
    full: &Histories,
    few: &dyn Fn(&str, usize) -> Result<Vec<f64>>,
) -> Result<MotionCompared> {
    let still = steady.displacement.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let load: f64 = steady.points.iter().map(|p| p.forces.normal).sum();
    let deviation = |suffix: &str, size: f64| -> Result<Option<f64>> {
        match full.all().find(|(name, _)| name.ends_with(suffix)) {
            None => Ok(None),
            Some((name, values)) => Ok(apart(values, &few(name, values.len())?, AT_REST * size)),
        }
    };
    let probe = full.all().find_map(|(name, _)| name.strip_suffix(DISPLACEMENT));
    Ok(MotionCompared {
        steps: full.all().next().map_or(0, |(_, values)| values.len().saturating_sub(1)),
        probe: probe.unwrap_or_default().to_string(),
        displacement: deviation(DISPLACEMENT, still)?,
        normal_force: deviation("_normal_force", load)?,
    })
}

/// The largest difference of two records from their start on, as a part of what the first spans; `None` when that is not
/// more than `rest`.
fn apart(full: &[f64], few: &[f64], rest: f64) -> Option<f64> {
    let [low, high] =
        full.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)]);
    let differences = full.iter().zip(few).map(|(a, b)| (a - b).abs());
    (high - low > rest).then(|| differences.fold(0.0, f64::max) / (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::random_system;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::modal::samples::dense_modes;
    use crate::reduction::reduce;
    use crate::stability::complex_modes;
    use crate::structure::DofMap;
    use std::sync::Arc;

    /// The deviations of a model reduced to some of the modes of a system of forty degrees of freedom.
    fn deviations(kept: usize) -> ReducedCheck {
        let system = random_system(40, 4, 3.0, 2);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let real = dense_modes(&system, 40);
        let top = real.frequency_hz(8);
        let modes = complex_modes(&system, &steady, &real, [0.0, top], &()).unwrap();
        let complex = ComplexResult {
            dofs: Arc::new(DofMap::given(vec![], vec![])),
            participation: vec![],
            real_modes: vec![],
            contact_closed: false,
            discs: vec![],
            shares: None,
            without_split: vec![],
            measured_squeal_hz: vec![],
            modal_damping_below_hz: None,
            band_hz: [0.0, top],
            certificate: None,
            confirmation: None,
            modes,
        };
        let few = dense_modes(&system, kept);
        let reduced = reduce(&system, &steady, &few, &[], None).unwrap();
        reduced_check(&reduced, (&system, &steady, &complex), None, &|_, _| Ok(vec![]), &()).unwrap()
    }

    #[test]
    fn the_more_modes_are_kept_the_nearer_are_the_eigenvalues() {
        let [some, more, all] = [12, 20, 40].map(deviations);
        let off = |check: &ReducedCheck| check.eigenvalue.unwrap().relative;
        assert!(some.modes[0] > 3 && some.modes[1] == some.modes[0], "{some:?}");
        assert!(
            within(off(&all), 1e-10, Tolerance) && off(&more) < 0.5 * off(&some) && off(&some) > 1e-9,
            "{some:?} {more:?}"
        );
        assert!(within(all.growth.unwrap().relative, 1e-6, Tolerance) && all.motion.is_none());
    }

    #[test]
    fn records_are_compared_where_something_moves() {
        let full = [1.0, 2.0, 4.0];
        assert_eq!(apart(&full, &[1.0, 2.5, 4.0, 9.0], 1e-9), Some(0.5 / 3.0));
        assert_eq!(apart(&full, &full, 3.5), None);
    }
}
