//! The complex pairs nearest to a frequency: a band that holds enough of them, found by counting.

use super::ComplexModes;
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::sparse::add_scaled;
use crate::modal::{RealModes, ShiftedStiffness};
use crate::system::Structure;
use std::f64::consts::TAU;

/// The requested complex pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The frequency to which their λ is nearest \[Hz\].
    pub hz: f64,
    /// Number.
    pub count: usize,
    /// The widest band in which they are sought \[Hz\].
    pub within: [f64; 2],
}

/// Real modes that the band needs so that `count` complex ones are among them: complex frequencies lie near the real
/// ones.
fn enough(count: usize) -> usize {
    count + 2 + count / 16
}

/// Where the modes are counted, by the requested frequency: the factors serve the analysis best in the middle of the band in
/// ω², which lies above it.
const ABOVE: f64 = 1.2;

/// A band \[Hz\] around the requested frequency, inside the widest, that is expected to hold enough modes of `structure`, and K − ω²M
/// factorised a little above the requested frequency: its inertia counts the modes below (Sylvester's law), and modes of plates lie
/// evenly over frequency.
///
/// # Errors
/// A pencil that is singular there.
pub fn band_expected(structure: &Structure, asked: &Nearest) -> Result<([f64; 2], ShiftedStiffness)> {
    let Nearest { hz: target, count, within: [lowest, highest] } = *asked;
    let at = |hz: f64| -> Result<ShiftedStiffness> {
        let shift = (TAU * hz).powi(2);
        let factor = structure
            .engine
            .factorize(&add_scaled(&[(1.0, &structure.stiffness), (-shift, &structure.mass)]))?;
        Ok(ShiftedStiffness { shift, factor })
    };
    // A shift that sits on an eigenvalue is moved a little.
    let mut shifted = at(ABOVE * target);
    for nudge in [1.0 - 1e-4, 1.0 + 1.3e-4] {
        match &shifted {
            Ok(there) if there.factor.inertia().zero == 0 => break,
            _ => shifted = at(ABOVE * target * nudge),
        }
    }
    let shifted = shifted?;
    let density = shifted.factor.inertia().negative.max(1) as f64 / (ABOVE * target);
    // A tenth more, so that a second look is seldom needed.
    let wide = 1.1 * enough(count) as f64 / density;
    let below = target - lowest;
    let reach = if wide <= 2.0 * below { 0.5 * wide } else { wide - below };
    Ok(([(target - reach).max(lowest), (target + reach).min(highest)], shifted))
}

/// The band \[Hz\] around the requested frequency, inside the widest, that holds just enough of the real modes, or where they end.
pub fn band_around(real: &RealModes, asked: &Nearest) -> [f64; 2] {
    let Nearest { hz: target, count, within: [lowest, highest] } = *asked;
    let inside = (0..real.len()).map(|k| real.frequency_hz(k)).filter(|f| (lowest..=highest).contains(f));
    let mut distances: Vec<f64> = inside.map(|f| (f - target).abs()).collect();
    distances.sort_by(f64::total_cmp);
    let end = (real.certificate.below_hz - target).max(0.0);
    let needed = enough(count);
    let reach = match (distances.get(needed - 1), distances.get(needed)) {
        (Some(last), Some(next)) => 0.5 * (last + next),
        (Some(last), None) => 0.5 * (last + end.max(*last)),
        _ => end,
    };
    // Beyond the last real mode that is known nothing is known to lie near.
    let reach = reach.min(end.max(1e-3 * target));
    [(target - reach).max(lowest), (target + reach).min(highest)]
}

/// Keeps the requested modes, when they are all inside `band` \[Hz\]; otherwise gives a wider band to look in. The
/// widest band keeps what there is, and says so.
pub fn keep_nearest(modes: &mut ComplexModes, asked: &Nearest, band: [f64; 2]) -> Option<[f64; 2]> {
    let Nearest { hz: target, count, within } = *asked;
    let distance = |z: c64| (z - c64::new(0.0, TAU * target)).norm();
    // Whatever is nearer than the edges of the band was found: |Im λ − ω| ≤ |λ − iω|.
    let side = |k: usize| if band[k] == within[k] { f64::INFINITY } else { TAU * (band[k] - target).abs() };
    let reach = side(0).min(side(1));
    let mut sorted: Vec<f64> = modes.modes.iter().map(|m| distance(m.eigenvalue)).collect();
    sorted.sort_by(f64::total_cmp);
    match sorted.get(count.saturating_sub(1)) {
        Some(last) if *last <= reach => modes.modes.retain(|m| distance(m.eigenvalue) <= *last),
        _ if band != within => {
            let wider = 1.25 * (band[1] - target).max(target - band[0]);
            return Some([(target - wider).max(within[0]), (target + wider).min(within[1])]);
        }
        _ => modes.warnings.push(format!(
            "Only {} of the {count} complex modes nearest to {target} Hz lie between {} and {} Hz",
            modes.modes.len(),
            band[0],
            band[1]
        )),
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::samples;
    use crate::modal::{ModesWanted, compute};
    use crate::system::Damping;

    fn analysis(hz: f64, count: usize, within: [f64; 2]) -> Nearest {
        Nearest { hz, count, within }
    }

    #[test]
    fn the_band_holds_enough_modes_and_not_many_more() {
        let (stiffness, mass) = samples::plate(24, false);
        let structure = Structure {
            mass: mass.into(),
            stiffness: stiffness.into(),
            damping: Damping::default(),
            engine: Default::default(),
        };
        let (modes, _) = compute(&structure, ModesWanted::BelowHz(12e3), &()).unwrap();
        let held = |[low, high]: [f64; 2]| {
            (0..modes.len()).filter(|k| (low..=high).contains(&modes.frequency_hz(*k))).count()
        };
        for (target, count) in [(3e3, 1), (3e3, 20), (1e3, 10), (100.0, 3), (6e3, 40)] {
            let cea = analysis(target, count, [0.0, 4.0 * target]);
            let (expected, shifted) = band_expected(&structure, &cea).unwrap();
            assert!(expected[0] <= target && target <= expected[1] && expected[1] <= 4.0 * target);
            let below = held([0.0, (shifted.shift.sqrt()) / TAU]);
            assert_eq!(shifted.factor.inertia().negative, below);
            let band = band_around(&modes, &cea);
            let found = held(band);
            assert!(
                found == enough(count) && band[0] <= target && target <= band[1],
                "{target} {count}: {found} in {band:?}"
            );
        }
        let narrow = analysis(3e3, 500, [2.5e3, 3.5e3]);
        assert_eq!(band_around(&modes, &narrow), narrow.within);
    }
}
