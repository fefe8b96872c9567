//! The complex pairs nearest to a frequency: a band that holds enough of them, found by counting.

use crate::case::CeaAnalysis;
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::factor::SymbolicFactor;
use crate::linalg::sparse::add_scaled;
use crate::stability::ComplexModes;
use crate::system::Structure;

use std::f64::consts::TAU;

/// Rounds of counting at most; each has two factorisations at most.
const ROUNDS: usize = 12;

/// A band around `cea.nearest`, inside `cea.band`, with at least `cea.count` real modes of `structure` and a few more,
/// but not many more: complex frequencies lie near the real ones.
///
/// The real modes below a frequency are counted by the inertia of K − ω²M (Sylvester's law), so that none needs to be
/// computed.
///
/// # Errors
/// A pencil that is singular at every shift.
pub fn band_around(structure: &Structure, cea: &CeaAnalysis) -> Result<[f64; 2]> {
    let (Some(target), Some(count)) = (cea.nearest, cea.count) else { return Ok(cea.band) };
    let [lowest, highest] = cea.band;
    let counter = Counter::new(structure)?;
    let least = count + 2 + count / 16;
    let most = least + 4 + count / 4;
    let at_target = counter.below(target)?;
    let at_lowest = counter.below(lowest)?;
    // Modes of plates lie evenly over frequency.
    let density = (at_target.saturating_sub(at_lowest).max(1)) as f64 / (target - lowest).max(1e-3 * target);
    let (mut inside, mut outside) = (0.0, f64::INFINITY);
    let mut reach = 0.5 * (least + most) as f64 / (2.0 * density);
    for _ in 0..ROUNDS {
        let band = [(target - reach).max(lowest), (target + reach).min(highest)];
        let (low, high) = rayon::join(
            || if band[0] == lowest { Ok(at_lowest) } else { counter.below(band[0]) },
            || counter.below(band[1]),
        );
        let held = high?.saturating_sub(low?);
        if held < least && band == cea.band {
            return Ok(band);
        }
        if (least..=most).contains(&held) || (held > most && outside - inside < 1e-6 * target) {
            return Ok(band);
        }
        let factor = 0.5 * (least + most) as f64 / held.max(1) as f64;
        if held < least {
            inside = reach;
            let next = reach * factor.clamp(1.05, 4.0);
            reach = if next < outside { next } else { 0.5 * (inside + outside) };
        } else {
            outside = reach;
            let next = reach * factor.clamp(0.1, 0.95);
            reach = if next > inside { next } else { 0.5 * (inside + outside) };
        }
    }
    // A cluster of modes: the band with it is wide enough.
    let reach = if outside.is_finite() { outside } else { reach };
    Ok([(target - reach).max(lowest), (target + reach).min(highest)])
}

/// Keeps the `cea.count` modes whose λ is nearest to iω of `cea.nearest`, when they are all inside `band`; otherwise
/// gives a wider band to look in. A band as wide as the case allows keeps what there is, and says so.
pub fn keep_nearest(modes: &mut ComplexModes, cea: &CeaAnalysis, band: [f64; 2]) -> Option<[f64; 2]> {
    let (target, count) = (cea.nearest?, cea.count?);
    let distance = |z: c64| (z - c64::new(0.0, TAU * target)).norm();
    // Whatever is nearer than the edges of the band was found: |Im λ − ω| ≤ |λ − iω|.
    let side = |k: usize| if band[k] == cea.band[k] { f64::INFINITY } else { TAU * (band[k] - target).abs() };
    let reach = side(0).min(side(1));
    let mut sorted: Vec<f64> = modes.modes.iter().map(|m| distance(m.eigenvalue)).collect();
    sorted.sort_by(f64::total_cmp);
    match sorted.get(count - 1) {
        Some(last) if *last <= reach => modes.modes.retain(|m| distance(m.eigenvalue) <= *last),
        _ if band != cea.band => {
            let wider = 1.25 * (band[1] - target).max(target - band[0]);
            return Some([(target - wider).max(cea.band[0]), (target + wider).min(cea.band[1])]);
        }
        _ => modes.warnings.push(format!(
            "only {} of the {count} complex modes nearest to {target} Hz lie between {} and {} Hz",
            modes.modes.len(),
            band[0],
            band[1]
        )),
    }
    None
}

/// Counts real modes.
struct Counter<'a> {
    structure: &'a Structure,
    symbolic: SymbolicFactor,
}

impl<'a> Counter<'a> {
    fn new(structure: &'a Structure) -> Result<Self> {
        let union = add_scaled(&[(1.0, &structure.stiffness), (1.0, &structure.mass)]);
        Ok(Counter { structure, symbolic: SymbolicFactor::new(union.symbolic())? })
    }

    /// The number of ω² below (2π hz)², negative ones among them.
    fn below(&self, hz: f64) -> Result<usize> {
        let mut refused = None;
        // A shift that sits on an eigenvalue is moved a little.
        for nudge in [1.0, 1.0 - 1e-6, 1.0 + 1.3e-6] {
            let shift = if hz > 0.0 { (TAU * hz * nudge).powi(2) } else { -1e-3 * nudge };
            let pencil = add_scaled(&[(1.0, &self.structure.stiffness), (-shift, &self.structure.mass)]);
            match self.symbolic.factorize(&pencil) {
                Ok(factor) if factor.inertia().zero == 0 => return Ok(factor.inertia().negative),
                Ok(factor) => refused = Some(Ok(factor.inertia().negative)),
                Err(error) => refused = Some(Err(error)),
            }
        }
        refused.unwrap_or_else(|| Err(Error::analysis("counting modes", "no shift", "Ask for a band")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;
    use crate::modal::{ModesWanted, compute};
    use crate::system::Damping;

    fn analysis(nearest: f64, count: usize, band: [f64; 2]) -> CeaAnalysis {
        CeaAnalysis {
            band,
            nearest: Some(nearest),
            count: Some(count),
            certify: None,
            confirm: false,
            basis_below: 1e5,
            measured_squeal: Vec::new(),
            measured_source: String::new(),
        }
    }

    #[test]
    fn the_band_holds_enough_modes_and_not_many_more() {
        let (stiffness, mass) = samples::plate(24, false);
        let structure = Structure { mass, stiffness, damping: Damping::default() };
        let (modes, _) = compute(&structure, ModesWanted::BelowHz(12e3), &()).unwrap();
        let held = |[low, high]: [f64; 2]| {
            (0..modes.len()).filter(|k| (low..=high).contains(&modes.frequency_hz(*k))).count()
        };
        for (target, count) in [(3e3, 1), (3e3, 20), (1e3, 10), (100.0, 3), (6e3, 40)] {
            let band = band_around(&structure, &analysis(target, count, [0.0, 4.0 * target])).unwrap();
            let found = held(band);
            assert!(
                found >= count && band[0] <= target && target <= band[1],
                "{target} {count}: {found} in {band:?}"
            );
            assert!(found <= count + 8 + count / 2, "{target} {count}: {found} in {band:?}");
        }
        let narrow = analysis(3e3, 500, [2.5e3, 3.5e3]);
        assert_eq!(band_around(&structure, &narrow).unwrap(), narrow.band);
    }
}
