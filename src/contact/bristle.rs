//! Friction that sticks: elastic bristles that bend before they slip, with return mapping.

use super::coefficient::FrictionCoefficient;
use super::normal::NormalLaw;
use super::slip::Slip;
use crate::system::{ContactForces, ContactMotion, ContactTangent, SlipAnswer, SlipStep};

/// Bristles between the bodies, bent by **s** along the face, with stiffness k_t and damping c_t:
///
/// k_t **s** + c_t ṡ = **F**, |**F**| ≤ μ N, and the point slips, with **v** − ṡ along **F**, only where |**F**| = μ N.
///
/// A time step first bends them by the whole slip Δ, **F*** = κ(**s** + Δ) − (c_t/Δt) **s** with κ = k_t + c_t/Δt. Up to
/// μ(0) N that is the force, and the point sticks. Beyond, **F** = μ(w) N **F***/|**F***|, and the bristles bend back to
/// what this force bends: the return mapping of elastoplasticity (J. C. Simo & T. J. R. Hughes, Computational
/// Inelasticity, 1998). The mean speed of slip v_p in the step follows from κ Δt v_p + μ(w) N = |**F***|; μ is taken at
/// the speed at the end of the step, w = v_p + (**v** − Δ/Δt)·**F***/|**F***|, which keeps the order of the integrator,
/// but nowhere beyond 0 … 2 v_p, so that the force runs on into sticking without a jump. Where the slip changes its direction, that
/// of the force is of first order in Δt.
///
/// μ(0) is the static coefficient. With μ falling steeper than κ Δt the force has a jump where slip begins, as it should.
/// A contact that pulls (N < 0) does not rub.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bristle {
    /// k_t \[N/m per unit of weight\].
    pub stiffness: f64,
    /// c_t \[N s/m per unit of weight\].
    pub damping: f64,
}

impl Bristle {
    pub(super) fn advance(
        &self,
        normal: &NormalLaw,
        friction: &dyn FrictionCoefficient,
        motion: &ContactMotion,
        since: &SlipStep,
        weight: f64,
    ) -> SlipAnswer {
        let unit = normal.force(motion.penetration, motion.penetration_rate);
        let pressure = unit.value.max(0.0);
        let mut answer = SlipAnswer::default();
        answer.forces.normal = weight * unit.value;
        answer.tangent.by_penetration[0] = weight * unit.by_penetration;
        answer.tangent.by_penetration_rate[0] = weight * unit.by_penetration_rate;
        if pressure == 0.0 {
            return answer;
        }
        let viscous = weight * self.damping / since.duration;
        let bend = weight * self.stiffness + viscous;
        let trial = [0, 1].map(|i| bend * (since.bristle[i] + since.slid[i]) - viscous * since.bristle[i]);
        let size = trial[0].hypot(trial[1]);
        let load = weight * pressure;
        if size <= friction.mu(0.0, pressure).value * load {
            answer.forces.friction = trial;
            answer.tangent.by_slid = along_the_face([[bend, 0.0], [0.0, bend]]);
            answer.bristle = [0, 1].map(|i| since.bristle[i] + since.slid[i]);
            answer.sticks = true;
            return answer;
        }
        let towards = trial.map(|f| f / size);
        let excess = [0, 1].map(|i| motion.slip_velocity[i] - since.slid[i] / since.duration);
        let slip = Slip {
            friction,
            pressure,
            load,
            resistance: bend * since.duration,
            late: towards[0] * excess[0] + towards[1] * excess[1],
        };
        let at = slip.solve(size, size / slip.resistance);
        let force = at.mu.value * load;
        // |F| by |F*|, by `late`, by N.
        let share = load * at.mu.by_speed * at.by_speed / slip.resistance;
        let by_size = share / (1.0 + share);
        let by_late = load * at.mu.by_speed * at.by_late / (1.0 + share);
        let by_normal = (at.mu.value + pressure * at.mu.by_pressure) / (1.0 + share);
        for i in 0..2 {
            answer.forces.friction[i] = force * towards[i];
            answer.tangent.by_penetration[1 + i] = by_normal * answer.tangent.by_penetration[0] * towards[i];
            answer.tangent.by_penetration_rate[1 + i] =
                by_normal * answer.tangent.by_penetration_rate[0] * towards[i];
            answer.bristle[i] = (force * towards[i] + viscous * since.bristle[i]) / bend;
            for j in 0..2 {
                let across = if i == j { 1.0 } else { 0.0 } - towards[i] * towards[j];
                // `late` changes with its own Δ, and as F* turns.
                let turned = (excess[j] - slip.late * towards[j]) * bend / size;
                let along = by_size * bend * towards[j] + by_late * (turned - towards[j] / since.duration);
                answer.tangent.by_slid[1 + i][j] = towards[i] * along + force / size * bend * across;
                answer.tangent.by_slip_velocity[1 + i][j] = by_late * towards[i] * towards[j];
            }
        }
        answer
    }

    /// At rest: **F** = k_t Δ up to μ(0) N, and that along Δ beyond, for a load that has grown from nothing in one proportion (the deformation
    /// theory of plasticity).
    pub(super) fn hold(
        &self,
        normal: &NormalLaw,
        friction: &dyn FrictionCoefficient,
        (penetration, slid): (f64, [f64; 2]),
        weight: f64,
    ) -> (ContactForces, ContactTangent) {
        let unit = normal.force(penetration, 0.0);
        let mut forces = ContactForces { normal: weight * unit.value, friction: [0.0; 2] };
        let mut tangent = ContactTangent::default();
        tangent.by_penetration[0] = weight * unit.by_penetration;
        tangent.by_penetration_rate[0] = weight * unit.by_penetration_rate;
        if unit.value <= 0.0 {
            return (forces, tangent);
        }
        let bend = weight * self.stiffness;
        let trial = slid.map(|s| bend * s);
        let size = trial[0].hypot(trial[1]);
        let mu = friction.mu(0.0, unit.value);
        let most = mu.value * forces.normal;
        if size <= most {
            forces.friction = trial;
            tangent.by_slid = along_the_face([[bend, 0.0], [0.0, bend]]);
            let dashpot = weight * self.damping;
            tangent.by_slip_velocity = along_the_face([[dashpot, 0.0], [0.0, dashpot]]);
            return (forces, tangent);
        }
        let towards = trial.map(|f| f / size);
        for i in 0..2 {
            forces.friction[i] = most * towards[i];
            tangent.by_penetration[1 + i] =
                (mu.value + unit.value * mu.by_pressure) * tangent.by_penetration[0] * towards[i];
            for j in 0..2 {
                let across = if i == j { 1.0 } else { 0.0 } - towards[i] * towards[j];
                tangent.by_slid[1 + i][j] = most / size * bend * across;
            }
        }
        (forces, tangent)
    }
}

/// Derivatives of (N, F₁, F₂) from those of (F₁, F₂).
fn along_the_face([first, second]: [[f64; 2]; 2]) -> [[f64; 2]; 3] {
    [[0.0; 2], first, second]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::contact::{Coulomb, Exponential, Hyperbolic, SlidingLaw, Stribeck};
    use crate::system::ContactLaw;

    const BRISTLE: Bristle = Bristle { stiffness: 5e5, damping: 20.0 };

    fn law(friction: impl FrictionCoefficient + 'static) -> SlidingLaw {
        let normal = NormalLaw { stiffness: 2e6, cubic_stiffness: 4e16, damping: 30.0, bilateral: false };
        SlidingLaw { bristle: Some(BRISTLE), ..SlidingLaw::new(normal, friction, 0.0) }
    }

    fn motion(v: [f64; 2]) -> ContactMotion {
        ContactMotion { penetration: 1e-5, penetration_rate: 0.01, slip_velocity: v }
    }

    fn values(answer: &SlipAnswer) -> [f64; 3] {
        [answer.forces.normal, answer.forces.friction[0], answer.forces.friction[1]]
    }

    #[test]
    fn the_point_sticks_elastically_up_to_static_friction_and_slips_beyond() {
        let law = law(Stribeck { mu_static: 0.6, mu_kinetic: 0.4, stribeck_velocity: 0.01, exponent: 1.0 });
        let (weight, duration) = (2.0, 1e-5);
        let at = |slid: f64, v: f64| {
            law.advance(
                &motion([v, 0.0]),
                &SlipStep { slid: [slid, 0.0], duration, ..SlipStep::default() },
                weight,
            )
        };
        let small = at(1e-6, 0.1);
        let bend = weight * (BRISTLE.stiffness + BRISTLE.damping / duration);
        assert!(small.sticks && within((small.forces.friction[0] - bend * 1e-6).abs(), 1e-9, RoundOff));
        assert_eq!(small.bristle, [1e-6, 0.0]);
        // The last force of sticking, and the first of slipping.
        let limit = 0.6 * small.forces.normal / bend;
        let (below, above) = (at(limit * (1.0 - 1e-9), 0.0), at(limit * (1.0 + 1e-9), 0.0));
        assert!(below.sticks && !above.sticks);
        assert!(within((below.forces.friction[0] / above.forces.friction[0] - 1.0).abs(), 1e-6, Theory));
        let far = at(1e-4, 10.0);
        assert!(within((far.forces.friction[0] / far.forces.normal - 0.4).abs(), 1e-6, Theory));
        // An open contact forgets.
        let open = ContactMotion { penetration: -1e-6, ..motion([0.1, 0.0]) };
        let since = SlipStep { bristle: [1e-6, 0.0], slid: [1e-6, 0.0], duration, ..SlipStep::default() };
        assert_eq!(law.advance(&open, &since, weight), SlipAnswer::default());
    }

    #[test]
    fn steady_slip_has_the_friction_of_the_law_without_bristles() {
        for law in [law(Hyperbolic { mu_static: 0.7, decline: 3.0 }), law(Coulomb { mu0: 0.4 })] {
            let (v, duration) = ([0.3, 0.4], 1e-4);
            let slid = v.map(|v| v * duration);
            let steady = law.respond(&motion(v), 1.0).0;
            let mut bristle = [0.0; 2];
            for _ in 0..400 {
                let answer = law.advance(
                    &motion(v),
                    &SlipStep { bristle, slid, duration, ..SlipStep::default() },
                    1.0,
                );
                bristle = answer.bristle;
                let friction = answer.forces.friction[0].hypot(answer.forces.friction[1]);
                assert!(within(friction / steady.normal - 0.7, 1e-12, RoundOff));
            }
            let answer =
                law.advance(&motion(v), &SlipStep { bristle, slid, duration, ..SlipStep::default() }, 1.0);
            let same = |found: [f64; 2], expected: [f64; 2]| {
                let pairs = found.iter().zip(expected);
                assert!(
                    pairs.map(|(a, b)| (a / b - 1.0).abs()).all(|off| within(off, 1e-12, RoundOff)),
                    "{found:?} {expected:?}"
                );
            };
            same(answer.forces.friction, steady.friction);
            same(law.bent(steady.friction, 1.0), bristle);
        }
    }

    #[test]
    fn jacobian_agrees_with_differences_while_it_sticks_and_slips() {
        let (weight, duration) = (0.7, 1e-5);
        let laws = [
            law(Coulomb { mu0: 0.4 }),
            law(Exponential { mu0: 0.3, mu1: 0.25, alpha: 3.0 }),
            law(Stribeck { mu_static: 0.6, mu_kinetic: 0.4, stribeck_velocity: 0.05, exponent: 2.0 }),
        ];
        let steps = [
            ([0.0, 0.0], [1e-6, 5e-7], [0.1, 0.05]),
            ([8e-5, -1e-5], [4e-6, 1e-6], [0.35, 0.12]),
            ([8e-5, -1e-5], [4e-6, 1e-6], [0.45, 0.12]),
            ([-7e-5, 5e-5], [-1e-6, 2e-6], [-0.3, 0.2]),
        ];
        let mut stuck = 0;
        for law in &laws {
            for (bristle, slid, v) in steps {
                let of = |x: [f64; 6]| {
                    let m = ContactMotion {
                        penetration: x[0],
                        penetration_rate: x[1],
                        slip_velocity: [x[2], x[3]],
                    };
                    law.advance(
                        &m,
                        &SlipStep { bristle, slid: [x[4], x[5]], duration, ..SlipStep::default() },
                        weight,
                    )
                };
                let at = [1e-5, 0.01, v[0], v[1], slid[0], slid[1]];
                let answer = of(at);
                stuck += usize::from(answer.sticks);
                for input in 0..6 {
                    let h = [1e-10, 1e-5, 1e-6, 1e-6, 1e-11, 1e-11][input];
                    let moved = |s: f64| {
                        let mut x = at;
                        x[input] += s * h;
                        values(&of(x))
                    };
                    let (plus, minus) = (moved(1.0), moved(-1.0));
                    for row in 0..3 {
                        let exact = match input {
                            0 => answer.tangent.by_penetration[row],
                            1 => answer.tangent.by_penetration_rate[row],
                            2 | 3 => answer.tangent.by_slip_velocity[row][input - 2],
                            _ if row == 0 => 0.0,
                            _ => answer.tangent.by_slid[row][input - 4],
                        };
                        let difference = (plus[row] - minus[row]) / (2.0 * h);
                        let scale = answer.forces.normal * [1e5, 1.0, 1.0, 1.0, 1e5, 1e5][input];
                        assert!(
                            within((exact - difference).abs(), 1e-5 * (exact.abs() + scale), Reference),
                            "{law:?} {bristle:?} row {row}, input {input}: {exact} {difference}"
                        );
                    }
                }
            }
        }
        assert!(stuck > 0 && stuck < 9, "{stuck}");
    }

    #[test]
    fn jacobian_at_rest_agrees_with_differences_below_and_beyond_the_limit() {
        let (weight, mut beyond) = (0.7, 0);
        for law in [law(Coulomb { mu0: 0.4 }), law(Hyperbolic { mu_static: 0.7, decline: 3.0 })] {
            for slid in [[1e-6, -2e-6], [8e-5, 3e-5], [-1e-4, 2e-4]] {
                let of = |x: [f64; 3]| law.hold(x[0], [x[1], x[2]], weight);
                let at = [1e-5, slid[0], slid[1]];
                let (forces, tangent) = of(at);
                let size = forces.friction[0].hypot(forces.friction[1]);
                let most = law.friction.mu(0.0, forces.normal / weight).value * forces.normal;
                assert!(within(size / most - 1.0, 1e-12, RoundOff));
                beyond += usize::from(tangent.by_penetration[1] != 0.0);
                for input in 0..3 {
                    let h = [1e-10, 1e-11, 1e-11][input];
                    let moved = |s: f64| {
                        let mut x = at;
                        x[input] += s * h;
                        let forces = of(x).0;
                        [forces.normal, forces.friction[0], forces.friction[1]]
                    };
                    let (plus, minus) = (moved(1.0), moved(-1.0));
                    for row in 0..3 {
                        let exact = match input {
                            0 => tangent.by_penetration[row],
                            k => tangent.by_slid[row][k - 1],
                        };
                        let difference = (plus[row] - minus[row]) / (2.0 * h);
                        let scale = forces.normal * 1e5;
                        assert!(
                            within((exact - difference).abs(), 1e-5 * (exact.abs() + scale), Reference),
                            "{law:?} {slid:?} row {row}, input {input}: {exact} {difference}"
                        );
                    }
                }
            }
        }
        assert!((1..6).contains(&beyond), "{beyond}");
        // An open contact does not rub.
        assert_eq!(law(Coulomb { mu0: 0.4 }).hold(-1e-6, [1e-5, 0.0], weight).0.friction, [0.0; 2]);
    }
}
