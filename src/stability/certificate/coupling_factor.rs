//! What multiplies the terms that couple the basis with its complement.

use crate::linalg::c64;

/// s² + linear · s + constant, or s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CouplingFactor {
    pub(super) square: f64,
    pub(super) linear: f64,
    pub(super) constant: c64,
}

impl CouplingFactor {
    /// Its value at `s`.
    pub(super) fn at(&self, s: c64) -> c64 {
        s * s * self.square + s * self.linear + self.constant
    }

    /// A bound on its change within `h` of `s`.
    pub(super) fn change(&self, s: c64, h: f64) -> f64 {
        h * ((s * (2.0 * self.square) + self.linear).norm() + h * self.square)
    }
}
