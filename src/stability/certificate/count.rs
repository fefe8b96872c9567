//! A count of eigenvalues beside those that were found.

use super::region::CountedRegion;
use crate::stability::{ComplexMode, ComplexModes, is_real};
use std::f64::consts::TAU;

/// ε relative to the band's top, 2π f: the slowest growth that is counted. At the band's top it is a damping ratio of
/// −1e-5, an amplitude that takes 16,000 periods to grow e-fold: less than the damping of any built structure is known
/// to. It keeps the contour clear of the modes of an undamped structure, which lie on the imaginary axis.
pub const SLOWEST_GROWTH: f64 = 1e-5;

/// The slowest growth that is counted, by the largest uncertainty of an eigenvalue that is zero but for rounding: none of
/// those is counted as growth.
const CLEAR_OF_ZERO: f64 = 2.0;

/// The slowest growth \[1/s\] that is counted in a band up to `top` \[rad/s\] with growth up to `reach` \[1/s\].
pub(super) fn slowest_growth(modes: &ComplexModes, top: f64, reach: f64) -> f64 {
    let zeros = modes.modes.iter().filter(|mode| mode.is_zero()).map(|mode| mode.uncertainty);
    let rounding = CLEAR_OF_ZERO * zeros.fold(0.0, f64::max);
    (SLOWEST_GROWTH * top).max(rounding.min(0.1 * reach))
}

/// How many eigenvalues lie in a closed region, counted, beside how many were found.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// The region's frequencies ω/2π \[Hz\]. When they begin at zero the region reaches as far below the real axis as
    /// above: it holds real eigenvalues (divergence), and both of each conjugate pair.
    pub band_hz: [f64; 2],
    /// The region's growth rates σ \[1/s\].
    pub growth: [f64; 2],
    /// Eigenvalues counted inside.
    pub counted: i64,
    /// Eigenvalues found inside.
    pub found: i64,
    /// The smallest 1/ρ on the contour: above 1 the count holds at full order; at most 1e16.
    pub margin: f64,
    /// Frequency \[Hz\] and growth rate \[1/s\] on the contour where the margin is smallest.
    pub tightest: [f64; 2],
    /// Points of the contour.
    pub points: usize,
    /// Zeros of the oscillators inside, accounted for in the count; none when the structure dissipates and K is
    /// positive semidefinite.
    pub structure_poles: usize,
    /// Whether C and H are known to dissipate, by a factorisation.
    pub dissipative: bool,
    /// Whether it was shown that no eigenvalue of the band grows faster than the region reaches.
    pub nothing_faster: bool,
    /// Whether the count is a proof, up to rounding, where `margin` is above 1. Otherwise it is that of a phase followed from point to
    /// point at full order, `margin` half a turn by the largest step.
    pub proven: bool,
    /// Eigenvalues near the contour, or unstable outside it.
    pub close_calls: Vec<CloseCall>,
}

/// A mode that is near the contour, or grows too slowly to be counted.
#[derive(Debug, Clone, PartialEq)]
pub struct CloseCall {
    /// ω/2π of the mode \[Hz\].
    pub frequency_hz: f64,
    /// σ of the mode \[1/s\].
    pub growth_rate: f64,
    /// Its distance from the contour \[1/s\].
    pub distance: f64,
    /// Whether it was counted as inside.
    pub inside: bool,
}

impl Certificate {
    /// Whether the count equals the number found.
    pub fn agrees(&self) -> bool {
        self.counted == self.found
    }

    /// Whether the count equals the number found and holds at full order, of a structure that dissipates.
    pub fn holds(&self) -> bool {
        self.agrees() && self.margin > 1.0 && self.dissipative
    }

    /// Whether no mode of the band was missed, however fast it grows: what a statement of stability needs.
    pub fn whole(&self) -> bool {
        self.holds() && self.nothing_faster
    }
}

/// The eigenvalues found inside: each once, or both of a pair when the region holds both.
pub(super) fn found(modes: &ComplexModes, region: &CountedRegion) -> i64 {
    let inside = modes.modes.iter().map(|m| m.eigenvalue).filter(|z| region.contains(*z));
    inside.map(|z| if region.symmetric() && z.im > 0.0 && !is_real(z) { 2 } else { 1 }).sum()
}

/// Modes within half of ε, or within their own error, of the contour, and unstable ones slower than ε.
pub(super) fn close_calls(modes: &ComplexModes, region: &CountedRegion) -> Vec<CloseCall> {
    let slowest = region.growth[0];
    let call = |mode: &ComplexMode| {
        let z = mode.eigenvalue;
        let error = mode.uncertainty;
        let distance = region.distance(z);
        let slow = z.re > (1e-2 * slowest).max(10.0 * error) && z.re <= slowest;
        (distance <= (0.5 * slowest).max(10.0 * error) || slow).then_some(CloseCall {
            frequency_hz: z.im / TAU,
            growth_rate: z.re,
            distance,
            inside: region.contains(z),
        })
    };
    modes.modes.iter().filter_map(call).collect()
}
