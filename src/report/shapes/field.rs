//! The displacements of a mode at the nodes of the picture, at the size and the phase at which they are shown.

use crate::linalg::c64;
use base64::prelude::{BASE64_STANDARD, Engine};

/// Re φ and Im φ \[1\], 3 numbers a node: scaled so that the largest displacement of a node during a cycle is 1, and turned in
/// phase by a common factor e^{iα} so that the sum of squares of Re φ is as large as can be: t = 0 is the phase of the
/// largest deflection, and a standing wave has Im φ = 0.
#[derive(Debug)]
pub(super) struct Motion {
    pub re: Vec<f64>,
    pub im: Vec<f64>,
}

impl Motion {
    /// The motion of `nodes` in the mode `shape`; `None` where none of them moves.
    pub(super) fn new(shape: &[[c64; 6]], nodes: &[usize]) -> Option<Self> {
        let u: Vec<[c64; 3]> = nodes.iter().map(|k| [shape[*k][0], shape[*k][1], shape[*k][2]]).collect();
        let largest = u.iter().map(largest_in_a_cycle).fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        // Σ Re(φ e^{iα})² = ½ Σ |φ|² + ½ Re(e^{2iα} Σ φ²).
        let squares: c64 = u.iter().flatten().map(|c| (c / largest) * (c / largest)).sum();
        let turn = c64::from_polar(1.0 / largest, -0.5 * squares.arg());
        let turned = u.iter().flatten().map(|c| c * turn);
        Some(Motion { re: turned.clone().map(|c| c.re).collect(), im: turned.map(|c| c.im).collect() })
    }
}

/// The larger half-axis of the ellipse Re(u e^{iωt}): with a = Re u and b = Im u the root of
/// ½(a² + b²) + √(¼(a² − b²)² + (a·b)²).
fn largest_in_a_cycle(u: &[c64; 3]) -> f64 {
    let sum = |of: fn(&c64) -> f64| u.iter().map(of).sum::<f64>();
    let (aa, bb, ab) = (sum(|c| c.re * c.re), sum(|c| c.im * c.im), sum(|c| c.re * c.im));
    (0.5 * (aa + bb) + (0.5 * (aa - bb)).hypot(ab)).sqrt()
}

/// Numbers from −1 to 1 as whole numbers of 16 bits, little end first, in base64: one step is 1/32767.
pub(super) fn encode(values: &[f64]) -> String {
    let limit = f64::from(i16::MAX);
    let short = |v: &f64| ((v * limit).round().clamp(-limit, limit) as i16).to_le_bytes();
    BASE64_STANDARD.encode(values.iter().flat_map(short).collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn shape() -> Vec<[c64; 6]> {
        let zero = c64::new(0.0, 0.0);
        let u = |k: usize| c64::new((1.7 * k as f64).sin(), (2.3 * k as f64 + 0.4).cos());
        (0..20).map(|k| [u(3 * k), u(3 * k + 1), u(3 * k + 2), c64::new(99.0, 0.0), zero, zero]).collect()
    }

    #[test]
    fn the_largest_displacement_of_a_cycle_is_one_and_comes_at_the_largest_deflection() {
        let nodes: Vec<usize> = (0..20).collect();
        let motion = Motion::new(&shape(), &nodes).unwrap();
        let squares = |angle: f64| -> Vec<f64> {
            let u = |k: usize| motion.re[k] * angle.cos() - motion.im[k] * angle.sin();
            (0..20).map(|n| (0..3).map(|c| u(3 * n + c).powi(2)).sum()).collect()
        };
        let angles = || (0..20_000).map(|k| TAU * f64::from(k) / 20_000.0);
        let largest = angles().flat_map(squares).fold(0.0, f64::max);
        assert!((largest - 1.0).abs() < 1e-6, "{largest}");
        let sum = |angle: f64| squares(angle).iter().sum::<f64>();
        assert!(angles().all(|angle| sum(angle) <= sum(0.0) + 1e-12));
    }

    #[test]
    fn a_standing_wave_of_any_phase_is_real_and_rest_is_nothing() {
        let factor = c64::from_polar(3.0, 1.1);
        let standing: Vec<[c64; 6]> = shape().iter().map(|u| u.map(|c| factor * c.re)).collect();
        let motion = Motion::new(&standing, &[3, 7]).unwrap();
        assert!(motion.im.iter().all(|im| im.abs() < 1e-14) && motion.re.len() == 6);
        assert!(Motion::new(&[[c64::new(0.0, 0.0); 6]], &[0]).is_none());
    }

    #[test]
    fn sixteen_bits_little_end_first() {
        assert_eq!(
            encode(&[1.0, -1.0, 0.0, 7.0]),
            BASE64_STANDARD.encode([0xff, 0x7f, 0x01, 0x80, 0, 0, 0xff, 0x7f])
        );
    }
}
