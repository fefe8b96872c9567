//! Eqs. (3)–(5) of Rusli et al. (2020), integrated apart from the program: no assembly, no contact code, no integrator of
//! its own.

use super::extrapolation::step;
use crate::case::{Case, ForceChoice, FrictionCurve, Sense};
use std::f64::consts::PI;

/// m ẍ + (k₁ + k₂/2 + k_t) x − k₂/2 y = −F_f + p(t), m ÿ − k₂/2 x + k₂/2 y + N = F, with
/// N = k_n y + k_nl y³ and F_f = (μ₀ + μ₁ exp(−α|v|)) N.
///
/// * As printed: v = V − ẋ, although friction pulls towards −x.
/// * As a belt towards −x has it: v = V + ẋ, and F_f times v/√(v² + v_ε²).
///
/// The motion starts from the steady state; the knock p is a half sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoDof {
    /// m \[kg\].
    pub mass: f64,
    /// k₁, k₂, k_t \[N/m\].
    pub springs: [f64; 3],
    /// k_n \[N/m\], k_nl \[N/m³\].
    pub contact: [f64; 2],
    /// N = 0 for y ≤ 0.
    pub unilateral: bool,
    /// μ₀, μ₁, α \[s/m\].
    pub friction: [f64; 3],
    /// V \[m/s\].
    pub velocity: f64,
    /// v_ε \[m/s\].
    pub regularisation: f64,
    /// With the sign that is printed.
    pub printed: bool,
    /// F \[N\].
    pub load: f64,
    /// The knock: its peak \[N\] and its duration \[s\], from t = 0.
    pub knock: [f64; 2],
}

impl TwoDof {
    /// The model of a case with the names of `validation/two-dof`; `None` when it is another.
    pub fn of(case: &Case) -> Option<Self> {
        let springs = ["k1", "k2", "kt"].map(|name| case.spring.get(name).map(|s| s.stiffness));
        let [Some(k1), Some(k2), Some(kt)] = springs else { return None };
        let contact = case.contact.get("belt")?;
        let friction = match contact.friction.law {
            FrictionCurve::Coulomb { law } => [law.mu0, 0.0, 0.0],
            FrictionCurve::Exponential { law } => [law.mu0, law.mu1, law.alpha],
            _ => return None,
        };
        let ForceChoice::Total { force: [_, load, _] } = case.force.get("press")?.load else { return None };
        let push = case.transient.as_ref()?.push.get("knock")?;
        Some(TwoDof {
            mass: case.mass.get("block")?.mass,
            springs: [k1, k2, kt],
            contact: [contact.normal.stiffness, contact.normal.cubic],
            unilateral: contact.normal.unilateral,
            friction,
            velocity: contact.sliding.rate(),
            regularisation: contact.friction.regularisation,
            printed: contact.friction.sense == Sense::AgainstSliding,
            load,
            knock: [push.force[0], push.duration],
        })
    }

    /// N.
    fn normal(&self, y: f64) -> f64 {
        let open = self.unilateral && y <= 0.0;
        if open { 0.0 } else { (self.contact[0] + self.contact[1] * y * y) * y }
    }

    /// F_f of the velocity ẋ and of N.
    fn pull(&self, rate: f64, normal: f64) -> f64 {
        let [mu_0, mu_1, alpha] = self.friction;
        let slip = if self.printed { self.velocity - rate } else { self.velocity + rate };
        let direction = match self.printed {
            true => 1.0,
            false if self.regularisation == 0.0 => slip.signum(),
            false => slip / slip.hypot(self.regularisation),
        };
        (mu_0 + mu_1 * (-alpha * slip.abs()).exp()) * normal * direction
    }

    /// x and y of steady sliding \[m\].
    pub fn steady(&self) -> [f64; 2] {
        let [k1, k2, kt] = self.springs;
        let x = |y: f64| (0.5 * k2 * y - self.pull(0.0, self.normal(y))) / (k1 + 0.5 * k2 + kt);
        let excess = |y: f64| 0.5 * k2 * (y - x(y)) + self.normal(y) - self.load;
        let mut high = 1.0;
        while excess(high) < 0.0 {
            high *= 2.0;
        }
        let mut low = 0.0;
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        [x(high), high]
    }

    /// x from its steady state \[m\], every `every` seconds, `count` times after the start.
    pub fn displacement(&self, every: f64, count: usize) -> Vec<f64> {
        /// The step is a part of the time between samples that is not longer than this, in seconds per √(k₁/m).
        const LONGEST: f64 = 0.02;
        let [k1, k2, kt] = self.springs;
        let parts = (every * (k1 / self.mass).sqrt() / LONGEST).ceil().max(1.0);
        let h = every / parts;
        let f = |t: f64, s: &[f64; 4]| {
            let [x, y, u, v] = *s;
            let normal = self.normal(y);
            let [peak, duration] = self.knock;
            let knock = if t < duration { peak * (PI * t / duration).sin() } else { 0.0 };
            let along = -(k1 + 0.5 * k2 + kt) * x + 0.5 * k2 * y - self.pull(u, normal) + knock;
            let down = 0.5 * k2 * (x - y) - normal + self.load;
            [u, v, along / self.mass, down / self.mass]
        };
        let [x, y] = self.steady();
        let mut state = [x, y, 0.0, 0.0];
        let mut record = vec![0.0];
        for sample in 0..count {
            for part in 0..parts as usize {
                state = step(&f, sample as f64 * every + part as f64 * h, state, h);
            }
            record.push(state[0] - x);
        }
        record
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    const LINEAR: TwoDof = TwoDof {
        mass: 1.0,
        springs: [1.0, 1.0, 0.5],
        contact: [1.0, 0.0],
        unilateral: false,
        friction: [0.6, 0.0, 0.0],
        velocity: 1.0,
        regularisation: 0.0,
        printed: true,
        load: 1.0,
        knock: [0.1, 0.1],
    };

    #[test]
    fn a_knock_rings_in_two_modes_with_closed_forms() {
        // Of m = 1 the transfer function is (s² + d)/((s² + ω₁²)(s² + ω₂²)) with ω² = (a + d)/2 ± r, a = 2, d = 3/2,
        // r² = ((a − d)/2)² + ½(½ − μ): each mode has the share (d − ωᵢ²)/(ωⱼ² − ωᵢ²). It answers the half sine
        // P sin Ωt by P Ω/(Ω² − ω²) (sin ωt + sin ω(t − π/Ω))/ω.
        let r = f64::sqrt(0.0625 + 0.5 * (0.5 - 0.6));
        let squares = [1.75 - r, 1.75 + r];
        let [peak, duration] = LINEAR.knock;
        let omega = PI / duration;
        let exact = |t: f64| -> f64 {
            let term = |i: usize| {
                let w = squares[i].sqrt();
                let share = (1.5 - squares[i]) / (squares[1 - i] - squares[i]);
                share * omega / (omega * omega - squares[i]) * ((w * t).sin() + (w * (t - duration)).sin())
                    / w
            };
            peak * (term(0) + term(1))
        };
        let found = LINEAR.displacement(0.1, 300);
        let worst = (1..=300).map(|k| (found[k] - exact(0.1 * k as f64)).abs()).fold(0.0, f64::max);
        // Ten times ε a step, of numbers near one: five steps from sample to sample.
        assert!(within(worst, 10.0 * 1500.0 * f64::EPSILON, RoundOff), "{worst:e}");
    }

    #[test]
    fn steady_sliding_balances() {
        let model = TwoDof { contact: [1.0, 1.0], friction: [0.4, 0.2, 1.0], ..LINEAR };
        let [x, y] = model.steady();
        let normal = y + y * y * y;
        let mu = 0.4 + 0.2 * f64::exp(-1.0);
        assert!(within((2.0 * x - 0.5 * y + mu * normal).abs(), 1e-14, RoundOff));
        assert!(within((0.5 * (y - x) + normal - 1.0).abs(), 1e-14, RoundOff));
    }
}
