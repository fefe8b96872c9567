//! Measured squeal beside the unstable modes.

use crate::results::ComplexResult;

/// A measured squeal frequency and an unstable mode nearer than this share of it are taken for the same.
pub(super) const SQUEAL_TOLERANCE: f64 = 0.03;

/// Whether a computed and a measured frequency are taken for the same.
pub(super) fn near(computed: f64, measured: f64) -> bool {
    (computed / measured - 1.0).abs() <= SQUEAL_TOLERANCE
}

/// The measured squeal frequency that `hz` is taken for.
pub(super) fn nearest_squeal(result: &ComplexResult, hz: f64) -> Option<f64> {
    let all = result
        .measured_squeal_hz
        .iter()
        .map(|(measured, _)| *measured)
        .filter(|measured| near(hz, *measured));
    all.min_by(|a, b| (hz / a - 1.0).abs().total_cmp(&(hz / b - 1.0).abs()))
}
