//! The sliding contact: a normal law and a friction coefficient make a [`ContactLaw`].

use super::bristle::Bristle;
use super::coefficient::FrictionCoefficient;
use super::coulomb;
use super::normal::NormalLaw;
use crate::schema::choices;
use crate::system::{
    ContactForces, ContactLaw, ContactMotion, ContactTangent, FrictionAtRest, SlipAnswer, SlipStep,
};
use std::sync::Arc;

/// **F** = μ(|v|, p) N **v** / √(|v|² + v_ε²), with N of the normal law and p = N/weight.
///
/// The regularised sign is φ(v) = v/√(v² + v_ε²): only the direction is smoothed, μ is taken at the true speed.
/// So for V ≫ v_ε the force is μ(V) N, the slope along the slip is N(μ′|φ| + μφ′) and the slope across it is
/// N μ|φ|/|V|. With v_ε = 0 the force is exact and zero at rest, and in time, without bristles, it is any force up to
/// μ(0) N there: what keeps the point at rest, as far as that reaches.
#[derive(Debug, Clone)]
pub struct SlidingLaw {
    /// N(δ, δ̇).
    pub normal: NormalLaw,
    /// μ(|v|, p).
    pub friction: Arc<dyn FrictionCoefficient>,
    /// v_ε \[m/s\].
    pub regularisation: f64,
    /// Which way friction pulls.
    pub sense: FrictionSense,
    /// Bristle, the tangential stiffness before the point slips; in time only, since in steady sliding it is at its limit.
    pub bristle: Option<Bristle>,
}

choices! {
    /// Which way friction pulls the body.
    pub enum FrictionSense {
        /// Along the velocity of the counter-body relative to the body: physics. Falling friction feeds energy in.
        WithSlip = "with_slip",
        /// Against the sliding direction t₁ whatever the slip, F₁ = −μ(|v|) N, as two-degree-of-freedom models are sometimes
        /// written (a belt that pulls towards −x while the slip is taken as V − ẋ). Falling friction then damps, and
        /// nothing turns round where the slip does. For the comparison with such equations only.
        AgainstSliding = "against_sliding",
    }
}

impl SlidingLaw {
    /// A law whose friction pulls along the slip velocity.
    pub fn new(normal: NormalLaw, friction: impl FrictionCoefficient + 'static, regularisation: f64) -> Self {
        let sense = FrictionSense::WithSlip;
        SlidingLaw { normal, friction: Arc::new(friction), regularisation, sense, bristle: None }
    }
}

impl ContactLaw for SlidingLaw {
    fn respond(&self, motion: &ContactMotion, weight: f64) -> (ContactForces, ContactTangent) {
        let unit = self.normal.force(motion.penetration, motion.penetration_rate);
        let normal = weight * unit.value;
        let pressure = unit.value.max(0.0);
        let v = motion.slip_velocity;
        // Not hypot: no slip comes near the ends of the range of numbers, and every step asks many times.
        let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let turns = self.sense == FrictionSense::WithSlip;
        let smoothed = (speed * speed + self.regularisation * self.regularisation).sqrt();
        let mut forces = ContactForces { normal, friction: [0.0; 2] };
        let mut tangent = ContactTangent::default();
        tangent.by_penetration[0] = weight * unit.by_penetration;
        tangent.by_penetration_rate[0] = weight * unit.by_penetration_rate;
        if turns && smoothed == 0.0 {
            return (forces, tangent);
        }
        let mu = self.friction.mu(speed, pressure);
        // ∂(μN)/∂N = μ + p ∂μ/∂p, because p is proportional to N.
        let by_normal = mu.value + pressure * mu.by_pressure;
        let towards = if turns { [v[0] / smoothed, v[1] / smoothed] } else { [-1.0, 0.0] };
        for i in 0..2 {
            forces.friction[i] = mu.value * normal * towards[i];
            tangent.by_penetration[1 + i] = by_normal * tangent.by_penetration[0] * towards[i];
            tangent.by_penetration_rate[1 + i] = by_normal * tangent.by_penetration_rate[0] * towards[i];
            for j in 0..2 {
                let identity = if i == j { 1.0 } else { 0.0 };
                let turning =
                    if turns { mu.value * (identity - towards[i] * towards[j]) / smoothed } else { 0.0 };
                let falling = if speed > 0.0 { mu.by_speed * towards[i] * v[j] / speed } else { 0.0 };
                tangent.by_slip_velocity[1 + i][j] = normal * (turning + falling);
            }
        }
        (forces, tangent)
    }

    fn advance(&self, motion: &ContactMotion, since: &SlipStep, weight: f64) -> SlipAnswer {
        if let Some(bristle) = &self.bristle {
            return bristle.advance(&self.normal, &*self.friction, motion, since, weight);
        }
        let (forces, tangent) = self.respond(motion, weight);
        if self.is_set_valued() && forces.normal > 0.0 {
            return coulomb::advance(&self.normal, &*self.friction, motion, since, weight);
        }
        SlipAnswer { forces, tangent, ..SlipAnswer::default() }
    }

    fn hold(&self, penetration: f64, slid: [f64; 2], weight: f64) -> (ContactForces, ContactTangent) {
        let bristle = self.bristle.unwrap_or(Bristle { stiffness: 0.0, damping: 0.0 });
        bristle.hold(&self.normal, &*self.friction, (penetration, slid), weight)
    }

    fn at_rest(&self) -> FrictionAtRest {
        match (self.sense, self.bristle) {
            (FrictionSense::AgainstSliding, _) => FrictionAtRest::AsInSlip,
            (_, Some(_)) => FrictionAtRest::Elastic,
            _ if self.regularisation == 0.0 => FrictionAtRest::SetValued,
            _ => FrictionAtRest::Smoothed,
        }
    }

    fn bent(&self, friction: [f64; 2], weight: f64) -> [f64; 2] {
        self.bristle.map_or([0.0; 2], |bristle| friction.map(|f| f / (weight * bristle.stiffness)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::contact::{Coulomb, Exponential, FrictionTable};

    fn motion(penetration: f64, penetration_rate: f64, v1: f64, v2: f64) -> ContactMotion {
        ContactMotion { penetration, penetration_rate, slip_velocity: [v1, v2] }
    }

    fn as_array(forces: ContactForces) -> [f64; 3] {
        [forces.normal, forces.friction[0], forces.friction[1]]
    }

    /// Central differences in all four inputs against the analytic Jacobian.
    fn check(law: &SlidingLaw, at: ContactMotion, scale: [f64; 3]) {
        let weight = 0.7;
        let (forces, tangent) = law.respond(&at, weight);
        let size = as_array(forces).iter().fold(1e-3, |m: f64, f| m.max(f.abs()));
        for input in 0..4 {
            let h = 1e-5 * scale[input.min(2)];
            let moved = |s: f64| {
                let mut m = at;
                match input {
                    0 => m.penetration += s * h,
                    1 => m.penetration_rate += s * h,
                    j => m.slip_velocity[j - 2] += s * h,
                }
                as_array(law.respond(&m, weight).0)
            };
            let (plus, minus) = (moved(1.0), moved(-1.0));
            for row in 0..3 {
                let exact = match input {
                    0 => tangent.by_penetration[row],
                    1 => tangent.by_penetration_rate[row],
                    j => tangent.by_slip_velocity[row][j - 2],
                };
                let difference = (plus[row] - minus[row]) / (2.0 * h);
                let tolerance = 1e-7 * (exact.abs() + size / scale[input.min(2)]);
                assert!(
                    within((exact - difference).abs(), tolerance, Reference),
                    "row {row}, input {input}: {exact} {difference}"
                );
            }
        }
    }

    #[test]
    fn jacobian_agrees_with_differences_in_every_regime() {
        let normal = NormalLaw { stiffness: 2e6, cubic_stiffness: 4e16, damping: 30.0, bilateral: false };
        let table = FrictionTable::new(
            "mu",
            vec![0.0, 0.1, 1.0, 5.0],
            vec![0.0, 10.0, 60.0],
            vec![vec![0.6, 0.55, 0.4, 0.35], vec![0.5, 0.45, 0.35, 0.3], vec![0.4, 0.3, 0.3, 0.25]],
        )
        .unwrap();
        let exponential = Exponential { mu0: 0.3, mu1: 0.25, alpha: 3.0 };
        let mut laws = vec![
            SlidingLaw::new(normal, Coulomb { mu0: 0.4 }, 1e-2),
            SlidingLaw::new(normal, exponential, 1e-2),
            SlidingLaw::new(normal, table, 1e-2),
            SlidingLaw::new(NormalLaw { bilateral: true, ..normal }, exponential, 1e-2),
        ];
        laws.push(SlidingLaw { sense: FrictionSense::AgainstSliding, ..laws[1].clone() });
        for law in &laws {
            for (v1, v2) in [(0.7, 0.0), (0.5, -0.3), (-0.4, 0.2), (0.013, 0.004), (2e-3, -1e-3), (0.05, 0.0)]
            {
                let slip = if f64::abs(v1) < 0.1 { 1e-2 } else { 1.0 };
                check(law, motion(1e-5, 0.01, v1, v2), [1e-5, 0.1, slip]);
                check(law, motion(-1e-5, 0.2, v1, v2), [1e-5, 0.1, slip]);
                check(law, motion(2e-6, -0.5, v1, v2), [1e-6, 0.1, slip]);
            }
        }
    }

    #[test]
    fn friction_is_mu_n_along_the_slip_and_smooth_through_rest() {
        let normal = NormalLaw::linear(1e6);
        let law = SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0);
        let (forces, tangent) = law.respond(&motion(1e-5, 0.0, 0.3, 0.4), 2.0);
        assert!(within((forces.normal - 20.0).abs(), 1e-12, RoundOff));
        assert!(
            within((forces.friction[0] - 6.0).abs(), 1e-12, RoundOff)
                && within((forces.friction[1] - 8.0).abs(), 1e-12, RoundOff)
        );
        // Coulomb friction only turns: no slope along the slip.
        let along = tangent.by_slip_velocity[1][0] * 0.3 + tangent.by_slip_velocity[1][1] * 0.4;
        assert!(within(along.abs(), 1e-12, RoundOff));
        assert_eq!(law.respond(&motion(1e-5, 0.0, 0.0, 0.0), 2.0).0.friction, [0.0; 2]);
        let smooth = SlidingLaw { regularisation: 1e-3, ..law };
        let slope = smooth.respond(&motion(1e-5, 0.0, 0.0, 0.0), 2.0).1.by_slip_velocity[1][0];
        assert!(within((slope - 0.5 * 20.0 / 1e-3).abs(), 1e-6, RoundOff));
    }

    #[test]
    fn friction_against_the_sliding_direction_does_not_turn_with_the_slip() {
        let falling = Exponential { mu0: 0.3, mu1: 0.2, alpha: 2.0 };
        let law = SlidingLaw {
            sense: FrictionSense::AgainstSliding,
            ..SlidingLaw::new(NormalLaw::linear(1e6), falling, 0.0)
        };
        for v in [0.5, 0.0, -0.5] {
            let (forces, tangent) = law.respond(&motion(1e-5, 0.0, v, 0.0), 1.0);
            let mu = falling.mu(v.abs(), 0.0);
            assert!(
                within((forces.friction[0] + 10.0 * mu.value).abs(), 1e-14, RoundOff)
                    && forces.friction[1] == 0.0
            );
            // At rest, where −μ(|v|) N has its corner, the mean of both sides.
            let slope = -10.0 * mu.by_speed * if v == 0.0 { 0.0 } else { v.signum() };
            assert!(within((tangent.by_slip_velocity[1][0] - slope).abs(), 1e-14, RoundOff));
        }
    }

    #[test]
    fn bilateral_contact_pulls_and_open_contact_is_silent() {
        let mut normal = NormalLaw::linear(1e6);
        let open =
            SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0).respond(&motion(-1e-6, 0.0, 1.0, 0.0), 1.0);
        assert_eq!(open, (ContactForces::default(), ContactTangent::default()));
        normal.bilateral = true;
        let (forces, tangent) =
            SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0).respond(&motion(-1e-6, 0.0, 1.0, 0.0), 1.0);
        assert_eq!(as_array(forces), [-1.0, -0.5, 0.0]);
        assert_eq!(tangent.by_penetration, [1e6, 0.5e6, 0.0]);
    }
}
