//! Selection of complex modes.

use super::{ComplexMode, SLOWEST_GROWTH, is_real};
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
    let real = is_real(z) || z.norm() <= NEXT_TO_ZERO * band[1];
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

/// A pair σ ± iω is two real eigenvalues as far as is known where the error p/(2mω) of λ, of a change p of Q, is that of a change
/// mω² which makes them one: ω up to twice the error, which itself is estimated within a factor of two.
const MAY_BE_ONE: f64 = 4.0;

/// ω of a real eigenvalue by rounding, as a part of |λ| and of the band's top.
const NOISE: [f64; 2] = [1e-12, 1e-14];

/// Takes what was looked for twice, and what is rounding, from modes of a band up to `top` \[rad/s\].
///
/// Pairs that may be two equal real eigenvalues, of critical damping or of two modes that diverge alike, become that; others that are
/// real but for rounding lose their ω. Next to zero both of a pair were looked for: the one with ω < 0 goes.
pub(super) fn part_real_pairs(modes: &mut Vec<ComplexMode>, top: f64) {
    let mut further = Vec::new();
    for mode in modes.iter_mut() {
        let z = mode.eigenvalue;
        let noise = (NOISE[0] * z.norm()).max(NOISE[1] * top);
        if z.im.abs() > (MAY_BE_ONE * mode.uncertainty).max(noise) {
            continue;
        }
        mode.eigenvalue.im = 0.0;
        if !is_real(z) && z.norm() > NEXT_TO_ZERO * top {
            let mut other = mode.clone();
            other.right.iter_mut().chain(&mut other.left).for_each(|z| *z = z.conj());
            further.push(other);
        }
    }
    modes.retain(|mode| mode.eigenvalue.im >= -1e-9 * mode.eigenvalue.norm());
    if !further.is_empty() {
        modes.extend(further);
        modes.sort_by(|a, b| {
            let [a, b] = [a, b].map(|mode| mode.eigenvalue);
            a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re))
        });
    }
}
