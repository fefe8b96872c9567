//! A number of the case as an unknown of the calibration, in its own unit and back.

use crate::calibration::Unknown;
use crate::case::VariedParameter;

/// x = (z − z̄)/s with z the value p or, in equal ratios, ln p; z̄ what is expected, and s its standard deviation, or half of
/// the width of the bounds where none is stated.
#[derive(Debug, Clone)]
pub struct Coordinate<'a> {
    /// The number.
    pub parameter: &'a VariedParameter,
    scale: f64,
}

impl<'a> Coordinate<'a> {
    /// The coordinate of `parameter`.
    pub fn new(parameter: &'a VariedParameter) -> Self {
        let mut own = Coordinate { parameter, scale: 1.0 };
        let [low, high] = parameter.between;
        own.scale = parameter.deviation.unwrap_or(0.5 * (own.z(high) - own.z(low)));
        own
    }

    fn z(&self, value: f64) -> f64 {
        if self.parameter.log { value.ln() } else { value }
    }

    /// x of a value.
    pub fn x(&self, value: f64) -> f64 {
        (self.z(value) - self.z(self.parameter.expectation())) / self.scale
    }

    /// The value at x, inside the bounds.
    pub fn value(&self, x: f64) -> f64 {
        let z = self.z(self.parameter.expectation()) + self.scale * x;
        let value = if self.parameter.log { z.exp() } else { z };
        value.clamp(self.parameter.between[0], self.parameter.between[1])
    }

    /// dp/dx where the value is p.
    pub fn rate(&self, value: f64) -> f64 {
        if self.parameter.log { self.scale * value } else { self.scale }
    }

    /// Its bounds and what is expected.
    pub fn unknown(&self) -> Unknown {
        Unknown {
            bounds: self.parameter.between.map(|value| self.x(value)),
            expected: self.parameter.deviation.map(|_| 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    #[test]
    fn there_and_back() {
        for (log, deviation) in [(false, None), (false, Some(0.3)), (true, None), (true, Some(0.3))] {
            let parameter =
                VariedParameter { path: vec![], between: [2.0, 8.0], expected: Some(3.0), deviation, log };
            let c = Coordinate::new(&parameter);
            for p in [2.0, 3.0, 5.0, 8.0] {
                assert!(
                    within((c.value(c.x(p)) - p).abs(), 20.0 * f64::EPSILON * p, RoundOff),
                    "{log} {deviation:?} {p}"
                );
                let slope = (c.x(p * (1.0 + 1e-6)) - c.x(p * (1.0 - 1e-6))) / (2e-6 * p);
                assert!(within((slope * c.rate(p) - 1.0).abs(), 1e-8, Reference));
            }
            let ends = c.unknown().bounds;
            assert!(deviation.is_some() || within((ends[1] - ends[0] - 2.0).abs(), 1e-14, RoundOff));
            assert!(c.x(3.0) == 0.0 && c.value(99.0) == 8.0);
        }
    }
}
