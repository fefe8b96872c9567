//! Selection of complex modes.

use super::SLOWEST_GROWTH;
use crate::linalg::c64;

/// Selection of complex modes, and options of their output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Lowest and highest frequency \[Hz\].
    pub hz: [f64; 2],
    /// A frequency \[Hz\] and how many modes are requested, those whose λ is nearest to iω; `None` for all in the band.
    pub nearest: Option<(f64, usize)>,
    /// Whether the left vectors are kept, which take as much memory as the right ones.
    pub left_vectors: bool,
}

/// All modes, with left vectors.
impl From<[f64; 2]> for Band {
    fn from(hz: [f64; 2]) -> Self {
        Band { hz, nearest: None, left_vectors: true }
    }
}

/// Below this part of the band's top |λ| may be rounding of zero, of which neither λ nor its conjugate is the one to give.
const NEXT_TO_ZERO: f64 = 1e-6;

/// Whether λ is one to give: one of each conjugate pair, its frequency in the band, or one that diverges, whatever the band. Next to
/// zero both of a pair are, until it is known whether they are zero.
pub(super) fn in_band(z: c64, band: [f64; 2]) -> bool {
    let real = z.im.abs() <= 1e-9 * z.norm() || z.norm() <= NEXT_TO_ZERO * band[1];
    let oscillates = !real && z.im > 0.0;
    (oscillates && z.im >= band[0] && z.im <= band[1])
        || (real && band[0] == 0.0 && z.norm() <= band[1])
        || diverges(z, band)
}

/// Whether λ grows by more than [`SLOWEST_GROWTH`] of the band's top, and tenfold faster than it turns: a real eigenvalue, to which
/// loss factors give a small imaginary part.
pub(super) fn diverges(z: c64, band: [f64; 2]) -> bool {
    z.re > SLOWEST_GROWTH * band[1] && z.im >= -1e-9 * z.norm() && z.im <= 0.1 * z.re
}
