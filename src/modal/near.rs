//! Which mode is meant by a frequency that is given.

use super::RealModes;

/// How far a mode's frequency may lie from the one that is given, as a part of that.
pub const NEAR: f64 = 0.1;

/// Index of the frequency nearest to `hz` \[Hz\]; none where none is within 10 % of it.
pub fn near(frequencies_hz: impl IntoIterator<Item = f64>, hz: f64) -> Option<usize> {
    let away = frequencies_hz.into_iter().map(|f| (f - hz).abs()).enumerate();
    let (nearest, away) = away.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (away <= NEAR * hz).then_some(nearest)
}

/// Damping ratios that are given by frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenRatios {
    /// ζ of each mode.
    pub ratios: Vec<f64>,
    /// Frequencies \[Hz\] that are given and that no mode is within 10 % of.
    pub without_mode: Vec<f64>,
}

/// ζ of each mode: `uniform` of those up to `below` \[Hz\], and of those nearest to the frequencies of `given`, (f \[Hz\], ζ) each, that
/// which is given.
pub fn given_ratios(modes: &RealModes, (uniform, below): (f64, f64), given: &[[f64; 2]]) -> GivenRatios {
    let of = |k: usize| if modes.frequency_hz(k) <= below { uniform } else { 0.0 };
    let (mut ratios, mut without_mode) = ((0..modes.len()).map(of).collect::<Vec<f64>>(), Vec::new());
    for [hz, ratio] in given {
        match near((0..modes.len()).map(|k| modes.frequency_hz(k)), *hz) {
            Some(k) => ratios[k] = *ratio,
            None => without_mode.push(*hz),
        }
    }
    GivenRatios { ratios, without_mode }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::SturmCertificate;
    use faer::Mat;
    use std::f64::consts::TAU;

    #[test]
    fn the_nearest_is_meant_where_one_is_near() {
        let all = [0.0, 100.0, 200.0];
        assert_eq!((near(all, 104.0), near(all, 0.0), near(all, 186.0)), (Some(1), Some(0), Some(2)));
        assert_eq!((near(all, 150.0), near(all, 1e5), near([], 100.0)), (None, None, None));
    }

    #[test]
    fn ratios_go_to_the_nearest_modes_and_what_has_none_is_named() {
        let modes = RealModes {
            eigenvalues: [100.0, 200.0].map(|hz: f64| (TAU * hz).powi(2)).to_vec(),
            shapes: Mat::zeros(0, 2),
            backward_errors: vec![0.0; 2],
            rigid_bodies: 0,
            negative: 0,
            certificate: SturmCertificate {
                below_hz: 300.0,
                shifts_hz: [300.0; 2],
                counted: [2; 2],
                found: 2,
            },
        };
        let found = given_ratios(&modes, (0.01, 500.0), &[[195.0, 0.03], [150.0, 0.5]]);
        assert_eq!(found, GivenRatios { ratios: vec![0.01, 0.03], without_mode: vec![150.0] });
        assert_eq!(given_ratios(&modes, (0.01, 150.0), &[]).ratios, [0.01, 0.0]);
    }
}
