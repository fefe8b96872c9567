//! Numbers that real matrices multiply.

use faer::c64;
use std::ops::{AddAssign, Mul};

/// A number that a real sparse matrix can multiply: `f64` or `c64`.
pub trait Scalar: Copy + Default + Send + Sync + AddAssign + Mul<f64, Output = Self> + 'static {
    /// 0.
    const ZERO: Self;
}
impl Scalar for f64 {
    const ZERO: Self = 0.0;
}
impl Scalar for c64 {
    const ZERO: Self = c64::new(0.0, 0.0);
}
