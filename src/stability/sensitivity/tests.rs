use super::super::exact::ExactProblem;
use super::super::tests::{belt, damped, dense_modes, dense_spectrum, nearest, steady};
use super::super::{ComplexMode, complex_modes};
use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Exponential, FrictionSense, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::*;
use crate::linalg::SparseVector;
use crate::system::{Closing, ModalDamping};
use std::sync::Arc;

const BAND: [f64; 2] = [0.01, 5.0];
const KEPT: usize = 24;

/// Everything a test of a random system may vary, each as a factor of what it is.
#[derive(Debug, Clone, Copy)]
enum Scalar {
    Mu0,
    Alpha,
    Velocity,
    Load,
    Stiffness,
    Cubic,
    Regularisation,
    Elastic,
    Mass,
    Viscous,
    Lossy,
    Lever,
    Gap,
}

const ALL: [Scalar; 13] = [
    Scalar::Mu0,
    Scalar::Alpha,
    Scalar::Velocity,
    Scalar::Load,
    Scalar::Stiffness,
    Scalar::Cubic,
    Scalar::Regularisation,
    Scalar::Elastic,
    Scalar::Mass,
    Scalar::Viscous,
    Scalar::Lossy,
    Scalar::Lever,
    Scalar::Gap,
];

fn law(normal: NormalLaw, mu_0: f64, alpha: f64, regularisation: f64) -> Arc<SlidingLaw> {
    Arc::new(SlidingLaw::new(normal, Exponential { mu0: mu_0, mu1: 0.25, alpha }, regularisation))
}

/// The sample with one scalar times `factor`; modal damping follows the new real modes at the ratios it had.
fn varied(base: &System, scalar: Scalar, factor: f64) -> System {
    let mut system = base.clone();
    let mut normal = NormalLaw { stiffness: 300.0, cubic_stiffness: 2e4, damping: 0.0, bilateral: false };
    let (mut mu_0, mut alpha, mut regularisation) = (0.35, 0.8, 0.3);
    let part = |m: &SparseMatrix, f: &dyn Fn(usize, usize) -> f64| {
        let m = m.to_dense();
        sparse(m.nrows(), |i, j| m[(i, j)] * f(i, j))
    };
    let lower = |i: usize, j: usize| if i < 15 && j < 15 { factor } else { 1.0 };
    match scalar {
        Scalar::Mu0 => mu_0 *= factor,
        Scalar::Alpha => alpha *= factor,
        Scalar::Regularisation => regularisation *= factor,
        Scalar::Stiffness => normal.stiffness *= factor,
        Scalar::Cubic => normal.cubic_stiffness *= factor,
        Scalar::Velocity => system.pairs[0].sliding_velocity *= factor,
        Scalar::Load => {
            if let Closing::Load(load) = &mut system.pairs[0].closing {
                *load *= factor;
            }
        }
        Scalar::Elastic => system.structure.stiffness = part(&base.structure.stiffness, &lower).into(),
        Scalar::Mass => system.structure.mass = part(&base.structure.mass, &lower).into(),
        Scalar::Viscous => {
            system.structure.damping.viscous =
                base.structure.damping.viscous.as_ref().map(|c| part(c, &|_, _| factor).into());
        }
        Scalar::Lossy => {
            let lossy = base.structure.damping.hysteretic.as_ref();
            system.structure.damping.hysteretic = lossy.map(|h| part(h, &|_, _| factor).into());
        }
        Scalar::Lever => {
            for point in Arc::make_mut(&mut system.pairs[0].points) {
                for vector in point.tangents.iter_mut().chain([&mut point.normal]) {
                    let turned = vector.iter().map(|(i, x)| (i, if i % 2 == 0 { x * factor } else { x }));
                    *vector = SparseVector::from_entries(turned);
                }
            }
        }
        Scalar::Gap => Arc::make_mut(&mut system.pairs[0].points).iter_mut().for_each(|p| p.gap *= factor),
    }
    system.pairs[0].law = law(normal, mu_0, alpha, regularisation);
    with_modal(&mut system, base.structure.damping.modal.is_some());
    system
}

fn with_modal(system: &mut System, modal: bool) {
    if modal {
        let modes = dense_modes(system, KEPT);
        let coefficients = modes.eigenvalues.iter().map(|w| 2.0 * 0.01 * w.sqrt()).collect();
        let basis = system.structure.mass.to_dense() * &modes.shapes;
        system.structure.damping.modal = Some(ModalDamping { basis, coefficients });
    }
}

/// A random system with some unstable modes and damping of `kind` (bits: viscous, hysteretic, modal).
fn sample(seed: u64, kind: u64) -> System {
    let mut system = damped(random_system(40, 4, 20.0, 1000 + seed), kind & 3);
    with_modal(&mut system, kind & 4 != 0);
    varied(&system, Scalar::Mu0, 1.0)
}

fn modes_of(system: &System) -> (SteadySliding, RealModes, Vec<ComplexMode>) {
    let (state, real) = (steady(system), dense_modes(system, KEPT));
    let found = complex_modes(system, &state, &real, BAND, &()).unwrap();
    (state, real, found.modes)
}

/// The eigenvalues nearest to `lambda`, each taken from a dense full-order solution and refined: those of the QR algorithm are
/// 1e-12 off, which a difference over a step of 1e-3 makes 1e-9, a thousand times the error of the rate.
fn exact_eigenvalues(system: &System, lambda: &[c64]) -> Vec<c64> {
    let state = steady(system);
    let (all, exact) = (dense_spectrum(system, &state), ExactProblem::new(system, &state));
    lambda.iter().map(|l| exact.eigenvalue(nearest(*l, &all))).collect()
}

/// The fourth-order difference of the eigenvalues themselves.
fn by_rerun(system: &dyn Fn(f64) -> System, at: f64, step: f64, lambda: &[c64]) -> Vec<c64> {
    let values = |p: f64| exact_eigenvalues(&system(p), lambda);
    let central = |h: f64| {
        let (up, down) = (values(at + h), values(at - h));
        up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect::<Vec<c64>>()
    };
    central(step).iter().zip(central(2.0 * step)).map(|(near, far)| (near * 4.0 - far) / 3.0).collect()
}

#[test]
fn sensitivities_of_random_systems_equal_those_of_a_rerun() {
    let mut compared = 0;
    for (seed, kind) in [(0, 0), (1, 7)] {
        let system = sample(seed, kind);
        let (state, real, modes) = modes_of(&system);
        // Near a coalescence differences of eigenvalues are no reference.
        let chosen: Vec<&ComplexMode> = modes.iter().filter(|m| m.condition < 20.0).take(4).collect();
        let lambda: Vec<c64> = chosen.iter().map(|m| m.eigenvalue).collect();
        let sensitivity = Sensitivity::new(&system, &state, &real, &chosen).unwrap();
        for scalar in ALL {
            let build = |factor: f64| varied(&system, scalar, factor);
            let rates = sensitivity.differentiate(1.0, 1e-3, Domain::Inside, &|p| Ok(build(p))).unwrap();
            for ((l, rate), exact) in lambda.iter().zip(&rates).zip(by_rerun(&build, 1.0, 1e-4, &lambda)) {
                let error = (rate.value - exact).norm();
                // 1e-6: δ⁴ of the rate and of the reference. 1e-11 |λ|: ten times ε |λ| over a step of 1e-4.
                assert!(
                    within(error, 1e-6 * exact.norm() + 1e-11 * l.norm(), Reference),
                    "seed {seed}, {scalar:?}: {} {exact}: {:.1e}",
                    rate.value,
                    error / exact.norm()
                );
                compared += usize::from(exact.norm() > 1e-4 * l.norm());
            }
        }
    }
    assert!(compared > 80, "{compared}");
}

#[test]
fn the_frozen_steady_state_would_be_wrong() {
    // The sensitivity to the load lives in the steady state alone: frozen, it would be zero.
    let system = sample(2, 0);
    let (state, real, modes) = modes_of(&system);
    let all: Vec<&ComplexMode> = modes.iter().collect();
    let sensitivity = Sensitivity::new(&system, &state, &real, &all).unwrap();
    let build = |p| Ok(varied(&system, Scalar::Load, p));
    let rates = sensitivity.differentiate(1.0, 1e-3, Domain::Inside, &build).unwrap();
    // Of some mode: one that the contact hardly moves is hardly moved by the load.
    assert!(rates.iter().zip(&modes).any(|(rate, m)| rate.value.norm() > 1e-3 * m.eigenvalue.norm()));
}

/// σ = −(c − N μ₁ α e^(−αV))/2 of a mass on a belt: every derivative in closed form, one of them at a bound.
#[test]
fn derivatives_of_a_mass_on_a_belt_are_those_of_the_closed_form() {
    let (load, velocity, mu_1, alpha) = (2.0, 0.4, 0.2, 1.5);
    let fall = mu_1 * alpha * f64::exp(-alpha * velocity);
    let build = |c: f64, n: f64, v: f64| belt(c, n, v, FrictionSense::WithSlip);
    let system = build(0.0, load, velocity);
    let (state, real) = (steady(&system), dense_modes(&system, 2));
    let modes = complex_modes(&system, &state, &real, [0.1, 10.0], &()).unwrap().modes;
    let sensitivity = Sensitivity::new(&system, &state, &real, &[&modes[0]]).unwrap();
    let slope = |at: f64, domain: Domain, of: &dyn Fn(f64) -> System| {
        sensitivity.differentiate(at, 1e-3 * at.max(1.0), domain, &|p| Ok(of(p))).unwrap()[0]
    };
    for (rate, exact) in [
        (slope(0.0, Domain::AtLowerBound, &|c| build(c, load, velocity)), -0.5),
        (slope(load, Domain::Inside, &|n| build(0.0, n, velocity)), 0.5 * fall),
        (slope(velocity, Domain::Inside, &|v| build(0.0, load, v)), -0.5 * alpha * load * fall),
    ] {
        assert!(within((rate.value.re - exact).abs(), 1e-10, RoundOff), "{} {exact}", rate.value);
        assert!(within(rate.error, 1e-5 * exact.abs(), Tolerance));
    }
}

#[test]
fn ratios_of_modal_damping_enter_exactly() {
    let system = sample(3, 4);
    let (state, real, modes) = modes_of(&system);
    let chosen: Vec<&ComplexMode> = modes.iter().filter(|m| m.condition < 20.0).collect();
    let lambda: Vec<c64> = chosen.iter().map(|m| m.eigenvalue).collect();
    let sensitivity = Sensitivity::new(&system, &state, &real, &chosen).unwrap();
    let build = |ratio: f64| {
        let mut system = system.clone();
        for (c, w) in
            system.structure.damping.modal.as_mut().unwrap().coefficients.iter_mut().zip(&real.eigenvalues)
        {
            *c = 2.0 * ratio * w.sqrt();
        }
        system
    };
    let rates = sensitivity.change_by_ratios(&vec![1.0; real.len()]);
    for (rate, exact) in rates.iter().zip(by_rerun(&build, 0.01, 1e-4, &lambda)) {
        // δ⁴ at a step of a hundredth of the ratio.
        assert!(within((rate - exact).norm(), 1e-6 * exact.norm(), Discretisation), "{rate} {exact}");
    }
}

/// A small mass, spring and damper really mounted: what is left over shrinks with the square of the amount.
#[test]
fn advice_agrees_with_a_thing_really_mounted() {
    let system = sample(1, 7);
    let (state, real, modes) = modes_of(&system);
    let chosen: Vec<&ComplexMode> = modes.iter().filter(|m| m.condition < 20.0).take(4).collect();
    let lambda: Vec<c64> = chosen.iter().map(|m| m.eigenvalue).collect();
    let sensitivity = Sensitivity::new(&system, &state, &real, &chosen).unwrap();
    let rows = [vector(&[(7, 1.0)]), vector(&[(20, 0.6), (21, -0.8)])];
    let advice = sensitivity.at(&rows);
    let mounted = |row: &SparseVector, m: f64, k: f64, c: f64| {
        let mut system = system.clone();
        let n = system.n_dofs();
        let add = |a: &SparseMatrix, factor: f64| {
            add_scaled(&[(1.0, a), (factor, &crate::linalg::sparse::sum_of_squares(n, [(1.0, row)]))])
        };
        system.structure.mass = add(&system.structure.mass, m).into();
        system.structure.stiffness = add(&system.structure.stiffness, k).into();
        system.structure.damping.viscous =
            system.structure.damping.viscous.as_ref().map(|v| add(v, c).into());
        // The spring is mounted without tension.
        row.add_to(k * row.dot(&state.displacement), &mut system.load);
        with_modal(&mut system, true);
        system
    };
    for (r, row) in rows.iter().enumerate() {
        let by_mass = by_rerun(&|m| mounted(row, m, 0.0, 0.0), 0.0, 5e-4, &lambda);
        let by_stiffness = by_rerun(&|k| mounted(row, 0.0, k, 0.0), 0.0, 0.3, &lambda);
        let by_damping = by_rerun(&|c| mounted(row, 0.0, 0.0, c), 0.0, 0.012, &lambda);
        for j in 0..lambda.len() {
            for (rate, exact) in [
                (advice[j][r].by_mass, by_mass[j]),
                (advice[j][r].by_stiffness, by_stiffness[j]),
                (advice[j][r].by_damping, by_damping[j]),
            ] {
                let bound = 1e-6 * exact.norm() + 1e-12 * lambda[j].norm();
                assert!(within((rate - exact).norm(), bound, Reference), "{r} {j}: {rate} {exact}");
            }
            let left_over = |m: f64| {
                let system = mounted(row, m, 0.0, 0.0);
                let there = exact_eigenvalues(&system, &lambda[j..=j])[0];
                ((there - lambda[j]) / m - advice[j][r].by_mass).norm()
            };
            let (coarse, fine) = (left_over(1e-3), left_over(5e-4));
            // What is of third order, the error of the advice itself, and round-off ε |λ| / m, times twenty.
            let round_off = 20.0 * f64::EPSILON * lambda[j].norm() / 5e-4;
            let bound = 0.1 * coarse + 1e-6 * advice[j][r].by_mass.norm() + round_off;
            assert!(within((coarse - 2.0 * fine).abs(), bound, Theory), "{coarse} {fine}");
        }
    }
}

#[test]
fn another_system_is_refused() {
    let (system, other) = (sample(0, 0), varied(&random_system(30, 4, 20.0, 7), Scalar::Mu0, 1.0));
    let (state, real, modes) = modes_of(&system);
    let sensitivity = Sensitivity::new(&system, &state, &real, &[&modes[0]]).unwrap();
    assert_eq!(sensitivity.change(&other).unwrap_err().exit_code(), 2);
    assert!(Sensitivity::new(&other, &state, &real, &[&modes[0]]).is_err());
}

#[test]
fn sensitivities_do_not_depend_on_the_number_of_threads() {
    let system = sample(1, 7);
    let (state, real, modes) = modes_of(&system);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let sensitivity = Sensitivity::new(&system, &state, &real, &[&modes[0], &modes[1]]).unwrap();
            let build = |p| Ok(varied(&system, Scalar::Elastic, p));
            let rates = sensitivity.differentiate(1.0, 1e-3, Domain::Inside, &build).unwrap();
            (rates, sensitivity.at(&[vector(&[(7, 1.0)])]))
        })
    };
    assert!(run(1) == run(3));
}
