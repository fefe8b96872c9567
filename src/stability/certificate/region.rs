//! The region of the plane in which eigenvalues are counted.

use crate::linalg::c64;

/// A closed region of the plane of s: growth \[1/s\] times angular frequency \[rad/s\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CountedRegion {
    pub(super) growth: [f64; 2],
    /// When it begins at zero, the region reaches as far below the real axis as above.
    pub(super) omega: [f64; 2],
}

impl CountedRegion {
    /// Whether the region is symmetric about the real axis.
    pub(super) fn symmetric(&self) -> bool {
        self.omega[0] == 0.0
    }

    fn bottom(&self) -> f64 {
        if self.symmetric() { -self.omega[1] } else { self.omega[0] }
    }

    /// Whether `s` lies inside.
    pub(super) fn contains(&self, s: c64) -> bool {
        s.re > self.growth[0] && s.re < self.growth[1] && s.im > self.bottom() && s.im < self.omega[1]
    }

    /// The distance of `s` from the boundary.
    pub(super) fn distance(&self, s: c64) -> f64 {
        let ([left, right], [bottom, top]) = (self.growth, [self.bottom(), self.omega[1]]);
        let outside = |x: f64, low: f64, high: f64| (low - x).max(x - high).max(0.0);
        let (dx, dy) = (outside(s.re, left, right), outside(s.im, bottom, top));
        if dx > 0.0 || dy > 0.0 {
            return dx.hypot(dy);
        }
        (s.re - left).min(right - s.re).min(s.im - bottom).min(top - s.im)
    }

    /// The corners of the path, counter-clockwise: the upper half of a symmetric region, the whole of another.
    pub(super) fn path(&self) -> Vec<c64> {
        let ([left, right], [low, high]) = (self.growth, self.omega);
        let mut path =
            vec![c64::new(right, low), c64::new(right, high), c64::new(left, high), c64::new(left, low)];
        if !self.symmetric() {
            path.push(path[0]);
        }
        path
    }
}
