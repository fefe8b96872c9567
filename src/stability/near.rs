//! Which complex mode is meant by a frequency that is given.

use super::ComplexMode;
use crate::modal::near;
use std::f64::consts::TAU;

/// Index of the complex mode nearest to `hz` \[Hz\] among those that are `wanted`; none where none is within 10 % of it. A mode is at all frequencies from ω/2π to |λ|/2π, which are apart where
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
    fn a_mode_that_grows_fast_is_near_both_of_its_frequencies() {
        let mode = |growth: f64, hz: f64| ComplexMode {
            eigenvalue: c64::new(growth, TAU * hz),
            right: Vec::new(),
            left: Vec::new(),
            backward_error: 0.0,
            eigenvalue_error: 0.0,
            uncertainty: 0.0,
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
