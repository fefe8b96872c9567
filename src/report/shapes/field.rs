//! The displacements of a mode, or of a motion in time, at the nodes of the picture, at the size and the phase at which they are shown.

use crate::linalg::c64;
use crate::results::CycleFields;
use base64::prelude::{BASE64_STANDARD, Engine};
use std::f64::consts::TAU;

/// Phases of a period about the best of which the largest displacement of a series is sought.
const PHASES: usize = 64;
/// A harmonic whose amplitude is below this part of the largest displacement is not shown.
const LEAST: f64 = 1e-3;

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

/// A motion of several harmonics h = 1, 2 …, u = Σ_h (Re U_h cos hϑ − Im U_h sin hϑ), scaled so that the largest displacement is 1.
#[derive(Debug)]
pub(super) struct MotionInTime {
    pub harmonics: Vec<Motion>,
    /// The largest displacement of a node during the period \[m\].
    pub largest: f64,
    /// Time of ϑ = 0, a period before the end of the run \[s\].
    pub begin: f64,
}

impl MotionInTime {
    /// The last period of `nodes`; `None` where none of them moves.
    pub(super) fn new(cycle: &CycleFields, nodes: &[usize]) -> Option<Self> {
        let begin = cycle.window[1] - 1.0 / cycle.frequency_hz;
        let turned = |(h, field): (i32, &Vec<[c64; 3]>)| -> Vec<c64> {
            let turn = c64::from_polar(1.0, TAU * f64::from(h) * cycle.frequency_hz * begin);
            nodes.iter().flat_map(|k| field[*k].map(|c| c * turn)).collect()
        };
        let mut fields: Vec<Vec<c64>> = (1..).zip(&cycle.harmonics).map(turned).collect();
        let at = |phase: f64| -> f64 {
            let wave = |h: usize| c64::from_polar(1.0, TAU * h as f64 * phase / PHASES as f64);
            let u = |k: usize| (1..).zip(&fields).map(|(h, field)| (field[k] * wave(h)).re).sum::<f64>();
            let squares = |node: usize| (0..3).map(|c| u(3 * node + c).powi(2)).sum::<f64>();
            (0..nodes.len()).map(squares).fold(0.0, f64::max).sqrt()
        };
        let sampled = (0..PHASES).map(|phase| phase as f64);
        let best = sampled.max_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(0.0);
        let largest = largest_near(&at, best);
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let counts = |field: &Vec<c64>| field.iter().any(|c| c.norm() >= LEAST * largest);
        fields.truncate(1 + fields.iter().rposition(counts).unwrap_or(0));
        let scaled = |field: Vec<c64>| Motion {
            re: field.iter().map(|c| c.re / largest).collect(),
            im: field.iter().map(|c| c.im / largest).collect(),
        };
        Some(MotionInTime { harmonics: fields.into_iter().map(scaled).collect(), largest, begin })
    }
}

/// The largest value within one of `best`, where there is one maximum: each step leaves out a third.
fn largest_near(value: &impl Fn(f64) -> f64, best: f64) -> f64 {
    let (mut low, mut high) = (best - 1.0, best + 1.0);
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        if value(low + third) < value(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    value(0.5 * (low + high)).max(value(best))
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
    use crate::bounds::{Origin::*, within};
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
        assert!(within((largest - 1.0).abs(), 1e-6, Discretisation), "{largest}");
        let sum = |angle: f64| squares(angle).iter().sum::<f64>();
        assert!(angles().all(|angle| within(sum(angle) - sum(0.0), 1e-12, RoundOff)));
    }

    #[test]
    fn a_standing_wave_of_any_phase_is_real_and_rest_is_nothing() {
        let factor = c64::from_polar(3.0, 1.1);
        let standing: Vec<[c64; 6]> = shape().iter().map(|u| u.map(|c| factor * c.re)).collect();
        let motion = Motion::new(&standing, &[3, 7]).unwrap();
        assert!(motion.im.iter().all(|im| within(im.abs(), 1e-14, RoundOff)) && motion.re.len() == 6);
        assert!(Motion::new(&[[c64::new(0.0, 0.0); 6]], &[0]).is_none());
    }

    #[test]
    fn the_last_period_is_the_motion_at_the_end_of_the_run() {
        let (hz, end) = (1668.0, 0.0803);
        let of = |a: f64| -> Vec<[c64; 3]> {
            let u = |k: usize| c64::new((a * k as f64).sin(), (1.0 + a * k as f64).cos());
            (0..20).map(|k| [u(3 * k), u(3 * k + 1), u(3 * k + 2)].map(|c| 1e-6 * c)).collect()
        };
        let small = of(1.1).into_iter().map(|u| u.map(|c| 1e-4 * c)).collect();
        let cycle =
            CycleFields { frequency_hz: hz, window: [0.07, end], harmonics: vec![of(1.7), of(2.3), small] };
        let nodes = [3, 7, 11];
        let motion = MotionInTime::new(&cycle, &nodes).unwrap();
        assert_eq!(motion.harmonics.len(), 2, "the third is too small");
        for part in [0.0, 0.13, 0.7] {
            let time = motion.begin + part / hz;
            for (place, node) in nodes.iter().enumerate() {
                let exact: f64 = (1..)
                    .zip(&cycle.harmonics[..2])
                    .map(|(h, field)| {
                        (field[*node][1] * c64::from_polar(1.0, TAU * f64::from(h) * hz * time)).re
                    })
                    .sum();
                let shown: f64 = (1..)
                    .zip(&motion.harmonics)
                    .map(|(h, m)| {
                        let (sin, cos) = (TAU * f64::from(h) * part).sin_cos();
                        m.re[3 * place + 1] * cos - m.im[3 * place + 1] * sin
                    })
                    .sum();
                assert!(within((motion.largest * shown - exact).abs(), 1e-15, RoundOff), "{part} {node}");
            }
        }
        assert!(within((motion.begin + 1.0 / hz - end).abs(), 1e-15, RoundOff));
    }

    #[test]
    fn sixteen_bits_little_end_first() {
        assert_eq!(
            encode(&[1.0, -1.0, 0.0, 7.0]),
            BASE64_STANDARD.encode([0xff, 0x7f, 0x01, 0x80, 0, 0, 0xff, 0x7f])
        );
    }
}
