//! The pressure at a point.

use super::{Air, Plate};
use std::f64::consts::TAU;

/// Taps that are worked on together, so that a sum is read and written once for all of them.
const TOGETHER: usize = 4;

/// A point that hears plates: p(t) = ρ₀/(2π) Σ_i ± q̈(t − R_i/c)·s_i / R_i with s_i what piston i displaces in each
/// mode, + in front of its plate and − behind it.
///
/// Delays that fall between two steps take the cubic through the four steps about them: of a sine of frequency f it
/// loses at most (2πfΔt)⁴·3/128, half a percent at 2πfΔt = 0.7. The common delay is not waited for: sample n of the
/// pressure belongs to step n + [`Receiver::delay`].
#[derive(Debug)]
pub struct Receiver {
    first: usize,
    /// One impulse response a mode \[Pa s²\], all of one length.
    taps: Vec<Vec<f64>>,
    /// Contribution of past samples to those to come.
    tail: Vec<f64>,
}

impl Receiver {
    /// At `place` \[m\], for accelerations that come every `step` seconds.
    pub fn new(plates: &[Plate], place: [f64; 3], air: Air, step: f64) -> Self {
        let modes = plates.iter().map(|plate| plate.strength.ncols()).max().unwrap_or(0);
        let per_metre = 1.0 / (air.speed * step);
        let distance = |x: &[f64; 3]| (0..3).map(|k| (place[k] - x[k]).powi(2)).sum::<f64>().sqrt();
        let radiating = || plates.iter().filter(|plate| plate.side(place) != 0.0);
        let distances = || radiating().flat_map(|plate| plate.points.iter().map(distance));
        let nearest = distances().fold(f64::INFINITY, f64::min);
        let farthest = distances().fold(0.0, f64::max);
        // The cubic reaches from one step before to two after.
        let whole = |r: f64| ((r * per_metre) as usize).max(1);
        let first = if nearest.is_finite() { whole(nearest) - 1 } else { 0 };
        let length = if nearest.is_finite() { whole(farthest) + 3 - first } else { 1 };
        let length = length.next_multiple_of(TOGETHER);
        let mut taps = vec![vec![0.0; length]; modes];
        for plate in radiating() {
            let side = plate.side(place);
            for (i, x) in plate.points.iter().enumerate() {
                let r = distance(x);
                let delay = r * per_metre;
                let below = whole(r);
                let f = delay - below as f64;
                let weights = [
                    -f * (f - 1.0) * (f - 2.0) / 6.0,
                    (f + 1.0) * (f - 1.0) * (f - 2.0) / 2.0,
                    -(f + 1.0) * f * (f - 2.0) / 2.0,
                    (f + 1.0) * f * (f - 1.0) / 6.0,
                ];
                let factor = side * air.density / (TAU * r);
                for (m, taps) in taps.iter_mut().enumerate() {
                    let strength = factor * plate.strength[(i, m)];
                    let at = below - 1 - first;
                    taps[at..at + 4].iter_mut().zip(weights).for_each(|(tap, w)| *tap += strength * w);
                }
            }
        }
        Receiver { first, tail: vec![0.0; length - 1], taps }
    }

    /// Steps before any pressure arrives.
    pub fn delay(&self) -> usize {
        self.first
    }

    /// The pressure \[Pa\], one value a step, for the next modal accelerations: one slice a mode, all of one length.
    pub fn receive(&mut self, accelerations: &[Vec<f64>]) -> Vec<f64> {
        let steps = accelerations.first().map_or(0, Vec::len);
        let mut out = std::mem::take(&mut self.tail);
        out.resize(steps + out.len(), 0.0);
        let edge = TOGETHER - 1;
        let mut padded = vec![0.0; steps + 2 * edge];
        for (taps, x) in self.taps.iter().zip(accelerations) {
            padded[edge..edge + steps].copy_from_slice(x);
            let reach = steps + edge;
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| &padded[k..k + reach]);
            for (k, four) in taps.chunks_exact(TOGETHER).enumerate() {
                let out = &mut out[TOGETHER * k..TOGETHER * k + reach];
                for n in 0..reach {
                    out[n] += four[3] * a[n] + four[2] * b[n] + four[1] * c[n] + four[0] * d[n];
                }
            }
        }
        self.tail = out.split_off(steps);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::plate::samples::disc;
    use super::*;
    use faer::Mat;
    use stridor_base::bounds::{Origin::*, within};

    /// The amplitude and phase of p at `place` per unit amplitude of a sine of acceleration.
    fn transfer(plates: &[Plate], place: [f64; 3], hz: f64, step: f64) -> [f64; 2] {
        let mut receiver = Receiver::new(plates, place, Air::default(), step);
        let n = (20.0 / (hz * step)).round() as usize;
        let angle = |k: usize| TAU * hz * step * k as f64;
        let delay = receiver.delay();
        let mut pressure = Vec::new();
        let record: Vec<f64> = (0..2 * n).map(|k| angle(k).cos()).collect();
        record.chunks(97).for_each(|piece| pressure.extend(receiver.receive(&[piece.to_vec()])));
        // The second half is steady; f n Δt is whole to 1e-4, so that a projection suffices.
        let mut found = [0.0; 2];
        for (k, p) in pressure.iter().enumerate().skip(n) {
            let phase = angle(k + delay);
            found[0] += 2.0 / n as f64 * p * phase.cos();
            found[1] -= 2.0 / n as f64 * p * phase.sin();
        }
        found
    }

    #[test]
    fn a_piston_sounds_on_its_axis_as_it_must() {
        // |p| = 2 ρ₀ c |v| |sin(k/2 (√(z² + a²) − z))| with v = a/ω; L. E. Kinsler et al., Fundamentals of Acoustics,
        // 4th ed., eq. 7.4.5.
        let (a, air) = (0.075, Air::default());
        let plate = [disc(a, 40, &[&|_, _| 1.0])];
        for (hz, z) in [(1000.0, 0.05), (2000.0, 1.0), (4000.0, 0.3), (5000.0, 0.1)] {
            let step = 1.0 / (hz * 50.0);
            let [re, im] = transfer(&plate, [0.0, 0.0, z], hz, step);
            let k = TAU * hz / air.speed;
            let lag = 0.5 * k * ((z * z + a * a).sqrt() - z);
            let exact = 2.0 * air.density * air.speed / (TAU * hz) * lag.sin().abs();
            let found = re.hypot(im);
            assert!(within((found / exact - 1.0).abs(), 3e-3, Discretisation), "{hz} {z}: {found} {exact}");
            let [behind, _] = transfer(&plate, [0.0, 0.0, -z], hz, step);
            assert!(within((behind + re).abs(), 1e-12 * exact, RoundOff));
        }
        assert_eq!(transfer(&plate, [1.0, 0.0, 0.0], 1000.0, 1e-5), [0.0; 2]);
    }

    #[test]
    fn sound_arrives_after_its_time_and_falls_with_distance() {
        let point = Plate {
            name: "point".into(),
            normal: [0.0, 0.0, 1.0],
            both_sides: true,
            middle: [0.0; 3],
            points: vec![[0.0; 3]],
            strength: Mat::from_fn(1, 1, |_, _| 2e-4),
        };
        let (air, step) = (Air::default(), 1e-5);
        for r in [0.0123, 1.0, 3.4567] {
            let mut receiver = Receiver::new(std::slice::from_ref(&point), [0.0, 0.0, r], air, step);
            let pulse = |t: f64| (-(t / 2e-4 - 5.0).powi(2)).exp();
            let record: Vec<f64> = (0..600).map(|k| pulse(k as f64 * step)).collect();
            let received = receiver.receive(&[record]);
            let scale = air.density * 2e-4 / (TAU * r);
            for (k, p) in received.iter().enumerate() {
                let time = (k + receiver.delay()) as f64 * step;
                let exact = scale * pulse(time - r / air.speed);
                assert!(within((p - exact).abs(), 1e-5 * scale, Discretisation), "{r} {k}: {p} {exact}");
            }
        }
    }
}
