mod apart;
mod from_rest;
mod held_load;
mod skew;
mod sticking;

use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Bristle, Coulomb, Hyperbolic, NormalLaw, SlidingLaw, Stribeck};
use crate::equilibrium::samples::{pair, point, random_system, sparse, structure, two_dof, vector};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::linalg::{SparseVector, c64};
use crate::modal::samples::dense_modes;
use crate::stability::complex_modes;
use crate::system::{Closing, Damping, ModalDamping, Structure, System};
use faer::Mat;
use std::f64::consts::TAU;

fn schemes() -> [Scheme; 5] {
    [
        Scheme::TRAPEZOIDAL,
        Scheme::newmark(0.3025, 0.6),
        Scheme::hht(-0.1),
        Scheme::hht(-1.0 / 3.0),
        Scheme::generalised_alpha(0.5),
    ]
}

/// A system without contact, and what a model needs besides.
fn free(structure: Structure) -> (System, SteadySliding) {
    let n = structure.n_dofs();
    let system = System { structure, pairs: vec![], load: vec![0.0; n], prestress: None, coupling: None };
    let steady = SteadySliding {
        displacement: vec![0.0; n],
        approach: vec![],
        points: vec![],
        iterations: 0,
        residual: 0.0,
    };
    (system, steady)
}

fn oscillator(omega: f64) -> (System, SteadySliding) {
    free(structure(1, |_, _| 1.0, move |_, _| omega * omega))
}

/// Starts with u, v and the acceleration that the structure alone gives them.
fn start(model: &TransientModel<'_>, u: &[f64], v: &[f64], a: &[f64]) -> State {
    let mut state = State::empty(model);
    for (k, x) in [u, v, a].into_iter().enumerate() {
        state.motion.col_as_slice_mut(k).copy_from_slice(x);
    }
    state.settle(model);
    state
}

fn run(model: &TransientModel<'_>, from: State, plan: Plan) -> Marched {
    march(model, from, &plan, &(), &mut |_| Ok(())).unwrap()
}

pub(super) fn plan(scheme: Scheme, step: f64, steps: usize) -> Plan {
    Plan { scheme, step, steps, method: StepMethod::Condensed, tolerance: None }
}

/// The amplification matrix of x = (u, Δt v, Δt² a) of an undamped oscillator, from the equations of the scheme as
/// they stand.
fn amplification(s: Scheme, big_omega: f64) -> Mat<f64> {
    let w = big_omega * big_omega;
    let left =
        faer::mat![[(1.0 - s.alpha_f) * w, 0.0, 1.0 - s.alpha_m], [1.0, 0.0, -s.beta], [0.0, 1.0, -s.gamma]];
    let right =
        faer::mat![[-s.alpha_f * w, 0.0, -s.alpha_m], [1.0, 1.0, 0.5 - s.beta], [0.0, 1.0, 1.0 - s.gamma]];
    use faer::linalg::solvers::Solve;
    left.partial_piv_lu().solve(right)
}

#[test]
fn the_oscillator_follows_the_amplification_matrix_with_its_damping_and_frequency_error() {
    for scheme in schemes() {
        for big_omega in [0.05, 0.7, 5.0] {
            let (system, steady) = oscillator(big_omega);
            let model = TransientModel::new(&system, &steady).unwrap();
            let steps = 50;
            let end = run(
                &model,
                start(&model, &[1.0], &[0.3], &[-big_omega * big_omega]),
                plan(scheme, 1.0, steps),
            );
            let mut x = faer::mat![[1.0], [0.3], [-big_omega * big_omega]];
            let a = amplification(scheme, big_omega);
            (0..steps).for_each(|_| x = &a * &x);
            for k in 0..3 {
                let size = 1.0 + big_omega * big_omega;
                assert!(
                    within((end.state.motion[(0, k)] - x[(k, 0)]).abs(), 1e-12 * size, RoundOff),
                    "{scheme:?} {big_omega} {k}"
                );
            }
            assert!(within(end.worst_residual, 1e-12, RoundOff), "{:e}", end.worst_residual);
        }
    }
    // The published spectral radii at infinite frequency, and the frequency of the trapezoidal rule. HHT(−1/3) has a threefold
    // root there: at Ω it is Ω^(−2/3) = 5e-6 away, and round-off moves it by ε^(1/3) = 6e-6.
    for (scheme, rho) in [
        (Scheme::hht(-1.0 / 3.0), 0.5),
        (Scheme::hht(-0.05), 0.95 / 1.05),
        (Scheme::generalised_alpha(0.7), 0.7),
    ] {
        let spectrum = amplification(scheme, 1e8).eigenvalues().unwrap();
        let radius = spectrum.iter().map(|z| z.norm()).fold(0.0, f64::max);
        assert!(within((radius - rho).abs(), 1e-4, RoundOff), "{radius} {rho}");
    }
    let phase = amplification(Scheme::TRAPEZOIDAL, 0.7).eigenvalues().unwrap();
    let turned = phase.iter().map(|z| z.im.atan2(z.re)).fold(0.0, f64::max);
    assert!(within((turned - 2.0 * 0.35f64.atan()).abs(), 1e-14, RoundOff));
}

#[test]
fn schemes_are_of_second_order_where_they_should_be() {
    let (system, steady) = oscillator(TAU);
    let model = TransientModel::new(&system, &steady).unwrap();
    let error = |scheme: Scheme, steps: usize| {
        let end = run(
            &model,
            start(&model, &[1.0], &[0.0], &[-TAU * TAU]),
            plan(scheme, 1.3 / steps as f64, steps),
        );
        (end.state.motion[(0, 0)] - (1.3 * TAU).cos()).abs()
    };
    for scheme in schemes() {
        let order = (error(scheme, 800) / error(scheme, 1600)).log2();
        let expected = if scheme.gamma == 0.6 && scheme.alpha_f == 0.0 { 1.0 } else { 2.0 };
        assert!(within((order - expected).abs(), 0.1, Discretisation), "{scheme:?}: {order}");
    }
}

#[test]
fn the_trapezoidal_rule_keeps_the_energy_of_a_linear_system_over_a_million_steps() {
    let chain = structure(
        3,
        |i, j| f64::from(i == j),
        |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        },
    );
    let (system, steady) = free(chain);
    let model = TransientModel::new(&system, &steady).unwrap();
    let from = start(&model, &[1.0, 0.0, 0.0], &[0.0, 0.0, 0.5], &[-2.0, 1.0, 0.0]);
    let before = from.energy();
    let end = run(&model, from, plan(Scheme::TRAPEZOIDAL, 0.1, 1_000_000));
    let drift = (end.state.energy() / before - 1.0).abs();
    assert!(within(drift, 1e-10, RoundOff), "{drift:e}");
}

/// A random system in sliding contact with viscous and modal damping.
fn damped(seed: u64) -> System {
    let mut system = random_system(30, 4, 3.0, seed);
    let modes = dense_modes(&system, 5);
    let basis = &crate::linalg::sparse::times(&system.structure.mass, modes.shapes.as_ref());
    system.structure.damping = Damping {
        viscous: Some(
            crate::linalg::sparse::add_scaled(&[
                (1e-3, &system.structure.stiffness),
                (0.05, &system.structure.mass),
            ])
            .into(),
        ),
        modal: Some(ModalDamping { basis: basis.clone(), coefficients: vec![0.0, 0.2, 0.3, 0.4, 0.5] }),
        hysteretic: None,
    };
    system
}

/// A blow on three degrees of freedom of [`damped`].
fn blow() -> Push {
    Push {
        direction: vector(&[(3, 40.0), (11, -60.0), (20, 50.0)]),
        course: Pulse::HalfSine { begin: 0.01, duration: 0.3 },
    }
}

/// Holds the `states` of a condensed march against Newton's method on the whole.
pub(super) fn full_newton_agrees(
    model: &TransientModel<'_>,
    steady: &SteadySliding,
    condensed: Plan,
    states: &[Mat<f64>],
) {
    let full = Plan { method: StepMethod::FullNewton, ..condensed };
    let largest = states.iter().map(|m| m.col(0).norm_max()).fold(0.0, f64::max);
    let end = march(model, State::steady(model, steady), &full, &(), &mut |moment| {
        let difference = (moment.state.motion.col(0) - states[moment.step].col(0)).norm_max();
        assert!(
            within(difference, 1e-10 * largest, Tolerance),
            "{:?}, step {}: {difference:e}",
            full.scheme,
            moment.step
        );
        Ok(())
    })
    .unwrap();
    assert_eq!(end.split.0, 0, "steps of Newton's method on the whole were split");
}

#[test]
fn the_condensed_step_is_the_full_newton_step_through_lift_off() {
    for (seed, scheme) in schemes().into_iter().cycle().take(10).enumerate() {
        let mut system = damped(seed as u64 + 1);
        if seed % 5 == 3 {
            system.structure.damping.modal = None;
        }
        if seed % 5 == 4 {
            system.structure.damping = Damping::default();
        }
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let push = blow();
        let model = TransientModel::new(&system, &steady)
            .unwrap()
            .driven(vec![TimeProfile::Reciprocating { frequency_hz: 0.2, phase: 0.1 }], vec![push]);
        let (mut open, mut back) = (0, 0);
        let mut states = Vec::new();
        let condensed = plan(scheme, 2e-3, 1000);
        let end = march(&model, State::steady(&model, &steady), &condensed, &(), &mut |moment| {
            let points = 0..model.points.len();
            open += points.filter(|p| moment.state.contact_forces(*p)[0] == 0.0).count();
            back += usize::from(moment.state.speeds[0] < 0.0);
            states.push(moment.state.motion.clone());
            Ok(())
        })
        .unwrap();
        assert!(open > 100 && open < 3900 && back > 0, "{open} {back}");
        assert!(within(end.worst_residual, 1e-9, Tolerance), "{scheme:?}: {:e}", end.worst_residual);
        full_newton_agrees(&model, &steady, condensed, &states);
    }
}

#[test]
fn momentum_and_energy_pass_through_an_impact() {
    // Two free masses; the first runs into the second, 0.1 m away.
    let masses = [2.0, 3.0];
    let free = structure(2, |i, j| if i == j { masses[i] } else { 0.0 }, |_, _| 0.0);
    let touch =
        point(0.1, 1.0, vector(&[(0, 1.0), (1, -1.0)]), SparseVector::default(), SparseVector::default());
    let law = SlidingLaw::new(NormalLaw::linear(1e4), Coulomb { mu0: 0.0 }, 0.0);
    let system = System {
        structure: free,
        pairs: vec![pair(vec![touch], law, Closing::Approach(0.0), 1.0)],
        load: vec![0.0; 2],
        prestress: None,
        coupling: None,
    };
    let steady = SteadySliding {
        displacement: vec![0.0; 2],
        approach: vec![0.0],
        points: vec![],
        iterations: 0,
        residual: 0.0,
    };
    let model = TransientModel::new(&system, &steady).unwrap();
    let from = start(&model, &[0.0, 0.0], &[1.0, -0.5], &[0.0, 0.0]);
    let mut touched = 0;
    let end = march(&model, from, &plan(Scheme::TRAPEZOIDAL, 1e-4, 4000), &(), &mut |moment| {
        touched += usize::from(moment.state.contact_forces(0)[0] > 0.0);
        Ok(())
    })
    .unwrap();
    let v = end.state.motion.col_as_slice(1);
    assert!(touched > 100);
    assert!(within((2.0 * v[0] + 3.0 * v[1] - 0.5).abs(), 1e-12, RoundOff), "{v:?}");
    // An elastic impact turns the relative velocity round: v₁ = −0.8, v₂ = 0.7.
    assert!(
        within((v[0] + 0.8).abs(), 1e-3, Discretisation) && within((v[1] - 0.7).abs(), 1e-3, Discretisation),
        "{v:?}"
    );
}

/// λ of a march that starts along a mode: the complex amplitude c from u = Re(c φ), v = Re(c λ φ) at one degree of
/// freedom, at the start and at the end.
///
/// A march along a mode that dies away ends in what rounding has put into the growing one at the start, some 1e-16 / `SMALL`
/// of it; what is not linear turns the mode by `SMALL`² only, as its part in `SMALL` changes sign with the motion.
fn measured(system: &System, scheme: Scheme, step: f64, mode: usize) -> (c64, c64) {
    const SMALL: f64 = 1e-6;
    let steady = solve_steady(system, &SteadyOptions::default(), &()).unwrap();
    let n = system.n_dofs();
    let modes = complex_modes(system, &steady, &dense_modes(system, n), [0.0, 1e3], &()).unwrap().modes;
    let mode = &modes[mode % modes.len()];
    let (lambda, shape) = (mode.eigenvalue, &mode.right);
    let model = TransientModel::new(system, &steady).unwrap();
    let from = State::steady(&model, &steady).disturbed(&model, lambda, shape, SMALL);
    let steps = (8.0 * TAU / lambda.im / step).round() as usize;
    let dof = (0..n).max_by(|a, b| shape[*a].norm().total_cmp(&shape[*b].norm())).unwrap();
    let end = run(&model, from, plan(scheme, step, steps));
    let (u, v) = (end.state.motion[(dof, 0)] - steady.displacement[dof], end.state.motion[(dof, 1)]);
    let (p, q) = (shape[dof], lambda * shape[dof]);
    // u = p' x − p'' y, v = q' x − q'' y.
    let determinant = -p.re * q.im + p.im * q.re;
    let (x, y) = ((-q.im * u + p.im * v) / determinant, (p.re * v - q.re * u) / determinant);
    let turned = c64::new(x, y) / SMALL;
    let time = steps as f64 * step;
    let growth = turned.norm().ln() / time;
    let angle = turned.im.atan2(turned.re);
    let near = (lambda.im * time - angle) / TAU;
    (lambda, c64::new(growth, (angle + TAU * near.round()) / time))
}

#[test]
fn small_disturbances_grow_and_turn_as_the_complex_eigenvalues_say() {
    let mut unstable = 0;
    let systems =
        [two_dof(0.5, 1.0, 0.8), two_dof(0.5, 1.0, 0.3), random_system(20, 3, 3.0, 2), damped(5), damped(9)];
    for (k, system) in systems.iter().enumerate() {
        for mode in 0..3 {
            let coarse = measured(system, Scheme::TRAPEZOIDAL, 4e-3, mode);
            let fine = measured(system, Scheme::TRAPEZOIDAL, 2e-3, mode);
            let error = |(lambda, found): (c64, c64)| (found - lambda).norm() / lambda.norm();
            assert!(within(error(fine), 1e-3, Discretisation), "{k} {mode}: {fine:?}");
            assert!(
                within(error(fine), 0.3 * error(coarse) + 1e-6, Discretisation),
                "{k} {mode}: {coarse:?} {fine:?}"
            );
            unstable += usize::from(fine.0.re > 1e-3);
        }
    }
    assert!(unstable > 0);
}

#[test]
fn a_loss_factor_is_refused_with_what_to_do() {
    let (mut system, steady) = oscillator(1.0);
    system.structure.damping.hysteretic = Some(sparse(1, |_, _| 0.1).into());
    let text = TransientModel::new(&system, &steady).unwrap_err().to_string();
    assert!(text.contains("loss factor") && text.contains("modal_ratio"), "{text}");
}

#[test]
fn a_model_reduced_to_all_it_has_moves_like_the_full_one() {
    let system = damped(3);
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let reduced = crate::reduction::reduce(&system, &steady, &dense_modes(&system, 30), &[], None).unwrap();
    let small = reduced.steady(&steady);
    let push = Push {
        direction: vector(&[(3, 40.0), (20, 50.0)]),
        course: Pulse::HalfSine { begin: 0.01, duration: 0.3 },
    };
    let seen = Push { direction: reduced.form(&push.direction), ..push.clone() };
    let full = TransientModel::new(&system, &steady).unwrap().driven(vec![TimeProfile::Constant], vec![push]);
    let few =
        TransientModel::new(&reduced.system, &small).unwrap().driven(vec![TimeProfile::Constant], vec![seen]);
    let plan = plan(Scheme::hht(-0.05), 1e-3, 800);
    let a = run(&full, State::steady(&full, &steady), plan).state;
    let b = run(&few, State::steady(&few, &small), plan).state;
    let back = reduced.expand(b.motion.col_as_slice(0));
    let size = a.motion.col(0).norm_max();
    let off = back.iter().zip(a.motion.col_as_slice(0)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(within(off, 1e-8 * size, RoundOff), "{off:e} of {size:e}");
}

/// A track of six stations whose contact points turn round a little from one to the next.
fn winding(system: &System) -> Track {
    let n = system.n_dofs();
    let station = |k: usize| {
        let moved = |d: &SparseVector, by: usize| {
            let extra = [((7 * by + 3) % n, 0.1 * (k as f64 - 2.0)), ((5 * by + 11) % n, 0.04 * k as f64)];
            SparseVector::from_entries(d.iter().chain(extra))
        };
        let points = system.pairs[0].points.iter().enumerate();
        points
            .map(|(p, point)| crate::system::ContactPoint {
                gap: point.gap + 1e-6 * (k as f64 - 2.0).powi(2),
                normal: moved(&point.normal, p),
                tangents: [moved(&point.tangents[0], p + 1), moved(&point.tangents[1], p + 2)],
                ..point.clone()
            })
            .collect()
    };
    Track { first: -0.4, spacing: 0.2, stations: (0..6).map(station).collect() }
}

#[test]
fn a_travelling_contact_that_sticks_is_condensed_exactly_too() {
    for (seed, scheme) in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.1)].into_iter().enumerate() {
        let mut system = damped(seed as u64 + 2);
        let normal = NormalLaw { stiffness: 60.0, cubic_stiffness: 5.0, damping: 0.5, bilateral: false };
        // Friction that falls by 0.86 (μ_s − μ_k) N/v_s faster than k_t Δt + c_t rises has two solutions of a step, one that sticks and
        // one that slips: this one is slower for all N below 6.
        let friction = Stribeck { mu_static: 0.4, mu_kinetic: 0.3, stribeck_velocity: 0.5, exponent: 2.0 };
        let bristle = Some(Bristle { stiffness: 40.0, damping: 1.0 });
        let law = SlidingLaw { bristle, ..SlidingLaw::new(normal, friction, 0.0) };
        system.pairs[0].law = std::sync::Arc::new(law);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let track = winding(&system);
        let push = blow();
        let back = TimeProfile::Reciprocating { frequency_hz: 1.0, phase: 0.1 };
        let model = TransientModel::new(&system, &steady).unwrap().driven(vec![back], vec![push]);
        let model = model.travelling(vec![Some(&track)]);
        let (mut open, mut stuck, mut far) = (0, 0, 0.0f64);
        let mut states = Vec::new();
        let condensed = plan(scheme, 2e-3, 1000);
        let end = march(&model, State::steady(&model, &steady), &condensed, &(), &mut |moment| {
            let points = 0..model.points.len();
            open += points.clone().filter(|p| moment.state.contact_forces(*p)[0] == 0.0).count();
            stuck += points.filter(|p| moment.state.sticks(*p)).count();
            far = far.max(moment.state.interface.travel[0].abs());
            states.push(moment.state.motion.clone());
            Ok(())
        })
        .unwrap();
        assert!(open > 20 && stuck > 20 && stuck < 3900 && far > 0.1, "{open} {stuck} {far}");
        assert!(within(end.worst_residual, 1e-9, Tolerance), "{scheme:?}: {:e}", end.worst_residual);
        full_newton_agrees(&model, &steady, condensed, &states);
    }
}

#[test]
fn a_contact_that_has_travelled_slowly_stands_like_one_that_was_set_there() {
    let mut system = damped(4);
    system.pairs[0].sliding_velocity = 0.2 / 400.0;
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let track = winding(&system);
    let model = TransientModel::new(&system, &steady)
        .unwrap()
        .driven(vec![TimeProfile::Constant], vec![])
        .travelling(vec![Some(&track)]);
    // From the third station, where the pair stands, to the fifth.
    let end = run(&model, State::steady(&model, &steady), plan(Scheme::hht(-0.3), 0.05, 16_000)).state;
    let mut there = system.clone();
    there.pairs[0].points = track.stations[4].clone().into();
    there.pairs[0].closing = Closing::Approach(steady.approach[0]);
    let there = solve_steady(&there, &SteadyOptions::default(), &()).unwrap();
    let largest = there.points.iter().map(|p| p.forces.normal).fold(0.0, f64::max);
    for (p, point) in there.points.iter().enumerate() {
        let off = end.contact_forces(p)[0] - point.forces.normal;
        assert!(within(off.abs(), 1e-3 * largest, Discretisation), "{p}: {off:e} of {largest}");
    }
    assert!(
        there
            .points
            .iter()
            .zip(&steady.points)
            .any(|(a, b)| (a.forces.normal - b.forces.normal).abs() > 0.01)
    );
}

#[test]
fn a_mass_on_a_belt_sticks_and_slips_with_the_period_of_the_exact_solution() {
    // m = k = F_s = 1, belt 0.2, F = F_s/(1 + 3|v|). The contact is pressed by 1 N on a spring of its own.
    let free = structure(2, |i, j| f64::from(i == j), |i, j| if (i, j) == (0, 0) { 1.0 } else { 0.0 });
    let touch = point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
    let bristle = Some(Bristle { stiffness: 1e5, damping: 600.0 });
    let friction = Hyperbolic { mu_static: 1.0, decline: 3.0 };
    let law = SlidingLaw { bristle, ..SlidingLaw::new(NormalLaw::linear(1e3), friction, 0.0) };
    let system = System {
        structure: free,
        pairs: vec![pair(vec![touch], law, Closing::Approach(0.0), 0.2)],
        load: vec![0.0, 1.0],
        prestress: None,
        coupling: None,
    };
    let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let model = TransientModel::new(&system, &steady).unwrap();
    // A push away from steady sliding, which is unstable.
    let from = start(&model, &[0.9, 1e-3], &[0.0, 0.0], &[0.0, 0.0]);
    let step = 1e-3;
    let (mut begins, mut stuck, mut range) = (Vec::new(), false, [f64::INFINITY, f64::NEG_INFINITY]);
    let (mut sticking, mut from_period) = (0, None);
    march(&model, from, &plan(Scheme::hht(-0.1), step, 60_000), &(), &mut |moment| {
        let now = moment.state.sticks(0);
        // After a first period, from one beginning of sticking to another.
        if moment.step > 20_000 {
            if now && !stuck {
                begins.push(moment.step as f64 * step);
                from_period.get_or_insert(moment.step);
            }
            if begins.len() == 1 || begins.len() == 2 {
                sticking += usize::from(now);
            }
            let x = moment.state.motion[(0, 0)];
            range = [range[0].min(x), range[1].max(x)];
        }
        stuck = now;
        Ok(())
    })
    .unwrap();
    let periods: Vec<f64> = begins.windows(2).map(|w| w[1] - w[0]).collect();
    assert!(periods.len() >= 2, "{begins:?}");
    let near = |found: f64, exact: f64| {
        assert!(within((found / exact - 1.0).abs(), 1e-3, Discretisation), "{found} {exact}")
    };
    periods.iter().for_each(|period| near(*period, 12.001031));
    near(sticking as f64 * step / 2.0, 7.705032);
    near(range[1], 1.133945);
    near(range[0], -0.555433);
}

#[test]
fn steps_are_split_until_the_frequency_is_as_right_as_was_asked() {
    let (system, steady) = oscillator(TAU);
    let model = TransientModel::new(&system, &steady).unwrap();
    let go = |tolerance: f64| {
        let plan = Plan { tolerance: Some(tolerance), ..plan(Scheme::TRAPEZOIDAL, 0.1, 200) };
        let end = run(&model, start(&model, &[1.0], &[0.0], &[-TAU * TAU]), plan);
        let (u, v) = (end.state.motion[(0, 0)], end.state.motion[(0, 1)] / TAU);
        // Twenty turns: what is left of the angle is the error of the frequency.
        ((-v).atan2(u).abs() / (20.0 * TAU), end.control.parts)
    };
    let (coarse, few) = go(1e-2);
    let (fine, many) = go(1e-4);
    assert!(within(coarse, 1e-2, Stated) && within(fine, 1e-4, Stated) && fine > 1e-6, "{coarse:e} {fine:e}");
    // (ωΔt)²/12 is 0.033: a fourth of it at each halving.
    assert_eq!((few, many), (400, 200 * 32));
}
