//! The distribution of a scalar inside its bounds.

use statrs::function::erf::{erfc, erfc_inv};
use std::f64::consts::SQRT_2;

/// Below this probability of the interval between the bounds a normal distribution is flat there, to nine digits.
const FLAT: f64 = 1e-9;

/// Distribution of a scalar x between two bounds a < b: uniform or truncated normal, of x or of ln x.
///
/// Truncated normal: F(x) = (Φ((x − m)/s) − Φ((a − m)/s)) / (Φ((b − m)/s) − Φ((a − m)/s)) with the expected value m and the standard
/// deviation s before truncation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    /// a, b \[unit of x\].
    pub between: [f64; 2],
    /// m \[unit of x\] and s, where it is not uniform; s in the unit of x, or of ln x with `log`.
    pub normal: Option<[f64; 2]>,
    /// Of ln x; a > 0 then.
    pub log: bool,
}

impl Distribution {
    /// x with F(x) = `p`, 0 ≤ p ≤ 1.
    pub fn quantile(&self, p: f64) -> f64 {
        let scale = |x: f64| if self.log { x.ln() } else { x };
        let [a, b] = self.between.map(scale);
        let place = match self.normal.map(|[m, s]| [scale(m), s]) {
            Some([m, s]) if below((b - m) / s) - below((a - m) / s) > FLAT => {
                let [low, high] = [below((a - m) / s), below((b - m) / s)];
                m + s * point(low + p * (high - low))
            }
            _ => a + p * (b - a),
        };
        let x = if self.log { place.exp() } else { place };
        x.clamp(self.between[0], self.between[1])
    }
}

/// Φ(z).
fn below(z: f64) -> f64 {
    0.5 * erfc(-z / SQRT_2)
}

/// Φ⁻¹(p).
fn point(p: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn quantiles_are_those_of_tables() {
        // 97.5 % of the standard normal distribution lie below 1.959964, 84.134475 % below 1.
        let wide = Distribution { between: [-50.0, 70.0], normal: Some([10.0, 2.0]), log: false };
        for (p, x) in [(0.975, 13.919_928), (0.841_344_75, 12.0), (0.5, 10.0), (0.025, 6.080_072)] {
            assert!(within((wide.quantile(p) - x).abs(), 1e-6, Reference), "{p}: {}", wide.quantile(p));
        }
        // Of the half above the mean, a half lies below 0.674490 deviations.
        let half = Distribution { between: [10.0, 70.0], ..wide };
        assert!(within((half.quantile(0.5) - 11.348_980).abs(), 1e-6, Reference), "{}", half.quantile(0.5));
        let uniform = Distribution { between: [2.0, 4.0], normal: None, log: false };
        assert_eq!([0.0, 0.25, 1.0].map(|p| uniform.quantile(p)), [2.0, 2.5, 4.0]);
        let decades = Distribution { between: [1e2, 1e6], normal: None, log: true };
        assert!(within((decades.quantile(0.5) / 1e4 - 1.0).abs(), 1e-14, RoundOff));
        let log = Distribution { between: [1e2, 1e6], normal: Some([1e4, 0.1]), log: true };
        assert!(within((log.quantile(0.841_344_75) / (1e4 * 0.1_f64.exp()) - 1.0).abs(), 1e-8, Reference));
    }

    #[test]
    fn every_value_is_inside_the_bounds() {
        for deviation in [1e-12, 1e-3, 1.0, 1e5, 1e12, 1e300] {
            for log in [false, true] {
                let of = Distribution { between: [0.5, 2.5], normal: Some([1.0, deviation]), log };
                let all = [0.0, 1e-300, 0.1, 0.5, 0.9, 1.0].map(|p| of.quantile(p));
                assert!(all.iter().all(|x| (0.5..=2.5).contains(x)), "{deviation}: {all:?}");
                assert!(all.windows(2).all(|two| two[0] <= two[1]), "{deviation}: {all:?}");
                if deviation > 1e4 {
                    assert!(all[2] < 0.8 && all[4] > 2.0, "{deviation}: {all:?}");
                }
            }
        }
    }
}
