//! What rounding leaves of growth rates.

use crate::linalg::c64;
use crate::linalg::dense::mac;
use faer::Mat;

/// Rounding of λ of a mode by itself, over |λ|.
const ROUNDING: f64 = 1e-12;
/// Rounding of the matrices, over |λ|, by which two modes that are nearly one are disturbed.
const OF_MATRICES: f64 = 1e-14;
/// Below this share of the largest |λ| a mode is zero but for rounding, which leaves λ² its share.
const ZERO: f64 = 1e-7;
/// Modes that differ by more than this share of |λ| are distinguished without their shapes.
const APART: f64 = 0.01;

/// What rounding may leave of σ of eigenvalue `k` \[1/s\], which shapes, one a column, judge better where they are known (no rows: not).
///
/// The condition number of λ is one over the sine of the angle between its vector and those of other modes, as (φ, λφ): about
/// √(1 − MAC + g²) with the gap g = |λ₁ − λ₂|/|λ| (G. W. Stewart and J. Sun, Matrix Perturbation Theory, 1990, ch. IV). Where two modes
/// merge, both are small: ε over it grows until it is the gap, √ε, all of which then may be rounding. Of equal modes with two shapes
/// (disc doublets), which do not merge, neither the angle nor the gap asks for more than ε.
pub(super) fn rounding(all: &[c64], shapes: &Mat<c64>, k: usize) -> f64 {
    let (z, size) = (all[k], all[k].norm());
    let largest = all.iter().map(|z| z.norm()).fold(0.0, f64::max);
    if size <= ZERO * largest {
        return 2.0 * size;
    }
    let others = all.iter().enumerate().filter(|(j, _)| *j != k);
    let by = |(j, other): (usize, &c64)| {
        let gap = (other - z).norm() / size;
        let sine = match shapes.nrows() > 0 && gap < APART {
            true => (1.0 - mac(shapes.col_as_slice(k), shapes.col_as_slice(j))).max(0.0).sqrt(),
            false => 0.0,
        };
        (OF_MATRICES / sine.hypot(gap).max(f64::MIN_POSITIVE)).min(gap)
    };
    size * (ROUNDING + others.map(by).fold(0.0, f64::max))
}

/// A gap is sure where half of it is this many times what rounding leaves.
const SURE: f64 = 10.0;

/// Whether λ of eigenvalue `k` and its neighbours surely differ by more than rounding, so that two modes that will merge have not yet done so.
pub(super) fn apart(all: &[c64], k: usize, rounding: f64) -> bool {
    let others = all.iter().enumerate().filter(|(j, _)| *j != k);
    let gap = others.map(|(_, other)| (other - all[k]).norm()).fold(f64::INFINITY, f64::min);
    let size = all[k].norm();
    rounding < size && (SURE * rounding <= 0.5 * gap || rounding <= 2.0 * ROUNDING * size)
}

/// Whether the rounding of σ of an eigenvalue shows that another mode is nearly one with it, in its shape as in λ.
pub(super) fn merges(lambda: c64, rounding: f64) -> bool {
    rounding > 2.0 * ROUNDING * lambda.norm()
}
