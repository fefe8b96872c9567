//! Which of some frequencies is meant by one that is given.

use crate::stability::ComplexMode;
use std::f64::consts::TAU;

/// How far a frequency may lie from the one that is given, as a part of that.
const REACH: f64 = 0.1;

/// Index of the frequency nearest to `hz` \[Hz\]; none where none is within 10 % of it.
pub fn near(frequencies_hz: impl IntoIterator<Item = f64>, hz: f64) -> Option<usize> {
    let away = frequencies_hz.into_iter().map(|f| (f - hz).abs()).enumerate();
    let (nearest, away) = away.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (away <= REACH * hz).then_some(nearest)
}

/// The same for the complex modes that are `wanted`. A mode is at all frequencies from ω/2π to |λ|/2π, which are apart where
/// it grows or decays fast.
pub fn near_mode(modes: &[ComplexMode], hz: f64, wanted: impl Fn(&ComplexMode) -> bool) -> Option<usize> {
    let at = |mode: &ComplexMode| hz.max(mode.frequency_hz()).min(mode.eigenvalue.norm() / TAU);
    near(modes.iter().map(|mode| if wanted(mode) { at(mode) } else { f64::INFINITY }), hz)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::c64;
    use crate::stability::GrowthBudget;

    #[test]
    fn the_nearest_is_meant_where_one_is_near() {
        let all = [0.0, 100.0, 200.0];
        assert_eq!((near(all, 104.0), near(all, 0.0), near(all, 186.0)), (Some(1), Some(0), Some(2)));
        assert_eq!((near(all, 150.0), near(all, 1e5), near([], 100.0)), (None, None, None));
    }

    #[test]
    fn a_mode_that_grows_fast_is_near_both_of_its_frequencies() {
        let mode = |growth: f64, hz: f64| ComplexMode {
            eigenvalue: c64::new(growth, TAU * hz),
            right: Vec::new(),
            left: Vec::new(),
            backward_error: 0.0,
            eigenvalue_error: 0.0,
            condition: 1.0,
            growth: GrowthBudget::default(),
            participation: Vec::new(),
        };
        let modes = [mode(0.0, 2.0), mode(TAU, 1.0)];
        let all = |hz: f64| near_mode(&modes, hz, |_| true);
        assert_eq!((all(1.0), all(1.4), all(2.1), all(5.0)), (Some(1), Some(1), Some(0), None));
        assert_eq!(near_mode(&modes, 2.0, ComplexMode::unstable), None);
    }
}
