//! Friction that is set-valued at rest: true sticking, without a parameter.

use super::coefficient::FrictionCoefficient;
use super::normal::NormalLaw;
use super::slip::Slip;
use crate::system::{ContactMotion, SlipAnswer, SlipStep};

/// **F** = μ(|**v**|) N **v**/|**v**| where the point slips, |**F**| ≤ μ(0) N where **v** = 0.
///
/// Both are one equation, **F** = R(**F** + ρ **v**) for any ρ > 0 (P. Alart & A. Curnier, Comput. Methods Appl. Mech. Eng. 92
/// (1991) 353). R(**T**) is the resolvent: **T** where |**T**| ≤ μ(0) N; beyond, μ(w) N **T**/|**T**| with the speed w of
/// ρ w + μ(w) N = |**T**|. It is continuous and its value unique while N |μ′| < ρ. With ρ the resistance of the structure to
/// the force in a time step this is no more than what makes the step have one solution.
///
/// Evaluates R at the iterate of **F** and the motion at the end of the step. N > 0 is taken for granted.
pub(super) fn advance(
    normal: &NormalLaw,
    friction: &dyn FrictionCoefficient,
    motion: &ContactMotion,
    since: &SlipStep,
    weight: f64,
) -> SlipAnswer {
    let unit = normal.force(motion.penetration, motion.penetration_rate);
    let (pressure, load) = (unit.value, weight * unit.value);
    let mut answer = SlipAnswer::default();
    answer.forces.normal = load;
    answer.tangent.by_penetration[0] = weight * unit.by_penetration;
    answer.tangent.by_penetration_rate[0] = weight * unit.by_penetration_rate;
    let (v, resistance) = (motion.slip_velocity, since.resistance);
    let trial = [0, 1].map(|i| since.friction[i] + resistance * v[i]);
    let size = (trial[0] * trial[0] + trial[1] * trial[1]).sqrt();
    if size <= friction.mu(0.0, pressure).value * load {
        answer.forces.friction = trial;
        answer.sticks = true;
        (0..2).for_each(|i| {
            answer.by_friction[i][i] = 1.0;
            answer.tangent.by_slip_velocity[1 + i][i] = resistance;
        });
        return answer;
    }
    let towards = trial.map(|t| t / size);
    let slip = Slip { friction, pressure, load, resistance, late: 0.0 };
    let mu = slip.solve(size, (v[0] * v[0] + v[1] * v[1]).sqrt()).mu;
    let force = mu.value * load;
    // |F| by |T|, by N.
    let share = load * mu.by_speed / resistance;
    let by_size = share / (1.0 + share);
    let by_normal = (mu.value + pressure * mu.by_pressure) / (1.0 + share);
    for i in 0..2 {
        answer.forces.friction[i] = force * towards[i];
        answer.tangent.by_penetration[1 + i] = by_normal * answer.tangent.by_penetration[0] * towards[i];
        answer.tangent.by_penetration_rate[1 + i] =
            by_normal * answer.tangent.by_penetration_rate[0] * towards[i];
        for j in 0..2 {
            let across = if i == j { 1.0 } else { 0.0 } - towards[i] * towards[j];
            let slope = by_size * towards[i] * towards[j] + force / size * across;
            answer.by_friction[i][j] = slope;
            answer.tangent.by_slip_velocity[1 + i][j] = resistance * slope;
        }
    }
    answer
}

#[cfg(test)]
mod tests {
    use super::super::{Coulomb, Exponential, SlidingLaw, Stribeck};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::system::ContactLaw;

    fn laws() -> [SlidingLaw; 3] {
        let normal = NormalLaw { stiffness: 2e6, cubic_stiffness: 4e16, damping: 30.0, bilateral: false };
        [
            SlidingLaw::new(normal, Coulomb { mu0: 0.4 }, 0.0),
            SlidingLaw::new(normal, Exponential { mu0: 0.3, mu1: 0.25, alpha: 3.0 }, 0.0),
            SlidingLaw::new(
                normal,
                Stribeck { mu_static: 0.6, mu_kinetic: 0.4, stribeck_velocity: 0.05, exponent: 2.0 },
                0.0,
            ),
        ]
    }

    fn at(v: [f64; 2]) -> ContactMotion {
        ContactMotion { penetration: 1e-5, penetration_rate: 0.01, slip_velocity: v }
    }

    #[test]
    fn the_forces_of_sliding_and_of_sticking_are_fixed_points() {
        for law in laws() {
            assert!(law.is_set_valued());
            for v in [[0.3, 0.4], [-1e-3, 2e-4], [-0.7, 0.0]] {
                let slides = law.respond(&at(v), 0.7).0;
                let since = SlipStep { friction: slides.friction, resistance: 5e3, ..SlipStep::default() };
                let answer = law.advance(&at(v), &since, 0.7);
                let off = [0, 1].map(|i| (answer.forces.friction[i] - slides.friction[i]).abs());
                assert!(
                    within(off[0].max(off[1]), 1e-13 * slides.normal, RoundOff) && !answer.sticks,
                    "{v:?} {off:?}"
                );
                assert_eq!(answer.forces.normal, slides.normal);
            }
            let most = law.friction.mu(0.0, 0.0).value * law.respond(&at([1.0, 0.0]), 0.7).0.normal;
            for (part, sticks) in [(0.999, true), (1.001, false)] {
                let friction = [0.6, -0.8].map(|t| part * most * t);
                let since = SlipStep { friction, resistance: 5e3, ..SlipStep::default() };
                let answer = law.advance(&at([0.0, 0.0]), &since, 0.7);
                assert!(answer.sticks == sticks && (answer.forces.friction == friction) == sticks);
            }
        }
    }

    #[test]
    fn jacobian_agrees_with_differences_while_it_sticks_and_slips() {
        let mut stuck = 0;
        for law in laws() {
            for (friction, v) in [
                ([4.0, 0.5], [1e-4, -2e-4]),
                ([4.0, 0.5], [0.3, -0.2]),
                ([-9.0, 3.0], [-5e-3, 2e-3]),
                ([0.0, 0.0], [0.05, 0.02]),
            ] {
                let of = |x: [f64; 6]| {
                    let motion = ContactMotion {
                        penetration: x[0],
                        penetration_rate: x[1],
                        slip_velocity: [x[2], x[3]],
                    };
                    let since = SlipStep { friction: [x[4], x[5]], resistance: 2e3, ..SlipStep::default() };
                    law.advance(&motion, &since, 0.7)
                };
                let x = [1e-5, 0.01, v[0], v[1], friction[0], friction[1]];
                let answer = of(x);
                stuck += usize::from(answer.sticks);
                let h = [1e-10, 1e-5, 1e-6, 1e-6, 1e-4, 1e-4];
                for (input, row) in (0..6).flat_map(|input| (0..3).map(move |row| (input, row))) {
                    let moved = |sign: f64| {
                        let mut x = x;
                        x[input] += sign * h[input];
                        let forces = of(x).forces;
                        [forces.normal, forces.friction[0], forces.friction[1]][row]
                    };
                    let exact = match input {
                        0 => answer.tangent.by_penetration[row],
                        1 => answer.tangent.by_penetration_rate[row],
                        2 | 3 => answer.tangent.by_slip_velocity[row][input - 2],
                        _ if row == 0 => 0.0,
                        _ => answer.by_friction[row - 1][input - 4],
                    };
                    let found = (moved(1.0) - moved(-1.0)) / (2.0 * h[input]);
                    let size = answer.forces.normal * [1e5, 1.0, 1.0, 1.0, 0.05, 0.05][input];
                    assert!(
                        within((found - exact).abs(), 1e-5 * (exact.abs() + size), Reference),
                        "{law:?} {friction:?} {v:?} row {row}, input {input}: {exact} {found}"
                    );
                }
            }
        }
        assert!(stuck > 0 && stuck < 9, "{stuck}");
    }
}
