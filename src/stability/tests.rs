use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Coulomb, Exponential, FrictionSense, NormalLaw, SlidingLaw};
use crate::equilibrium::samples::*;
use crate::equilibrium::{SteadyOptions, SteadySliding, SteadySolver, directions, linearize, solve_steady};
use crate::linalg::{SparseMatrix, SparseVector};
pub(super) use crate::modal::samples::dense_modes;
use crate::system::{Closing, ModalDamping, System};
use faer::Mat;
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Dense K + iH + K_c and C + C_c of the whole system.
pub(super) fn dense_matrices(system: &System, steady: &SteadySliding) -> (Mat<c64>, Mat<c64>) {
    let (mut k, mut c) = dense_without_contact(system);
    let points: Vec<_> = system.points().map(|(_, p)| p).collect();
    for block in linearize(system, steady).blocks {
        let u = directions(points[block.point]);
        for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
            for (i, x) in u[a].iter() {
                for (j, y) in u[b].iter() {
                    k[(i, j)] += c64::new(x * block.stiffness[a][b] * y, 0.0);
                    c[(i, j)] += c64::new(x * block.damping[a][b] * y, 0.0);
                }
            }
        }
    }
    (k, c)
}

/// Dense K + iH and C with imported couplings.
pub(super) fn dense_without_contact(system: &System) -> (Mat<c64>, Mat<c64>) {
    let n = system.n_dofs();
    let real = |m: &Option<Arc<SparseMatrix>>| m.as_ref().map_or(Mat::zeros(n, n), |m| m.to_dense());
    let (s, d) = (&system.structure, &system.structure.damping);
    let (k0, h, mut c0) = (s.stiffness.to_dense(), real(&d.hysteretic), real(&d.viscous));
    if let Some(modal) = &d.modal {
        for (j, c) in modal.coefficients.iter().enumerate() {
            let b = modal.basis.col(j);
            c0 += faer::Scale(*c) * (b * b.transpose());
        }
    }
    let mut k = Mat::from_fn(n, n, |i, j| c64::new(k0[(i, j)], h[(i, j)]));
    let mut c = Mat::from_fn(n, n, |i, j| c64::new(c0[(i, j)], 0.0));
    if let Some(skew) = system.skew() {
        let add = |to: &mut Mat<c64>, a: &SparseMatrix| {
            let a = a.to_dense();
            *to += Mat::from_fn(n, n, |i, j| c64::new(a[(i, j)], 0.0));
        };
        add(&mut k, &skew.stiffness);
        add(&mut c, &skew.damping);
    }
    if let Some(rest) = &system.coupling {
        for (a, u) in rest.directions.iter().enumerate() {
            for (b, v) in rest.directions.iter().enumerate() {
                for ((i, x), (j, y)) in u.iter().flat_map(|x| v.iter().map(move |y| (x, y))) {
                    k[(i, j)] += c64::new(x * rest.stiffness[(a, b)] * y, 0.0);
                    c[(i, j)] += c64::new(x * rest.damping[(a, b)] * y, 0.0);
                }
            }
        }
    }
    (k, c)
}

/// Every eigenvalue in the band.
pub(super) fn dense_eigenvalues(system: &System, steady: &SteadySliding, band_hz: [f64; 2]) -> Vec<c64> {
    let mut all = dense_spectrum(system, steady);
    all.retain(|z| z.im >= TAU * band_hz[0] && z.im <= TAU * band_hz[1]);
    all
}

/// Every eigenvalue from the full-order first-order form ẋ = [0 I; −M⁻¹K −M⁻¹C] x.
pub(super) fn dense_spectrum(system: &System, steady: &SteadySliding) -> Vec<c64> {
    use faer::linalg::solvers::Solve;
    let n = system.n_dofs();
    let (k, c) = dense_matrices(system, steady);
    let m = system.structure.mass.to_dense();
    let lu = Mat::from_fn(n, n, |i, j| c64::new(m[(i, j)], 0.0)).partial_piv_lu();
    let (k, c) = (lu.solve(&k), lu.solve(&c));
    let a = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => -c[(i, j)],
        (true, false) => -k[(i, j - n)],
        (false, true) => c64::new(f64::from(i - n == j), 0.0),
        (false, false) => c64::new(0.0, 0.0),
    });
    let mut all = a.eigenvalues().unwrap();
    all.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
    all
}

pub(super) fn steady(system: &System) -> SteadySliding {
    solve_steady(system, &SteadyOptions::default(), &()).unwrap()
}

fn modes_of(system: &System, real: usize, band_hz: [f64; 2]) -> ComplexModes {
    complex_modes(system, &steady(system), &dense_modes(system, real), band_hz, &()).unwrap()
}

/// ((λ₁² − λ₂²)/2)² of an undamped two-degree-of-freedom system: positive when stable, negative in flutter.
fn discriminant(system: &System) -> f64 {
    let found = modes_of(system, 2, [0.0, 500.0]);
    assert_eq!(found.modes.len(), 2);
    let square: Vec<c64> = found.modes.iter().map(|m| m.eigenvalue * m.eigenvalue).collect();
    let half = (square[0] - square[1]) * 0.5;
    (half * half).re
}

/// A flutter pair σ ± has one frequency, so that its order is left to round-off.
pub(super) fn nearest(z: c64, among: &[c64]) -> c64 {
    *among.iter().min_by(|a, b| (*a - z).norm().total_cmp(&(*b - z).norm())).unwrap()
}

fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let (mut fa, fb) = (f(a), f(b));
    assert!(fa * fb < 0.0);
    for _ in 0..60 {
        let c = 0.5 * (a + b);
        let fc = f(c);
        if fa * fc <= 0.0 { b = c } else { (a, fa) = (c, fc) }
    }
    0.5 * (a + b)
}

#[test]
fn two_dof_critical_friction_and_stiffness_are_those_of_the_closed_form() {
    let closed = |k_t: f64, k_n: f64, mu: f64| ((1.0 + k_t - k_n) / 2.0).powi(2) + 0.5 * (0.5 - mu * k_n);
    for (k_t, mu_c, k_c) in [(0.5, 0.625, 1.3), (0.3f64.sqrt(), 0.650, 1.3167)] {
        let mu = root(|mu| discriminant(&two_dof(k_t, 1.0, mu)), 0.5, 0.8);
        let exact = root(|mu| closed(k_t, 1.0, mu), 0.5, 0.8);
        assert!(within((mu - exact).abs(), 1e-9, RoundOff), "{mu} {exact}");
        assert!(within((mu - mu_c).abs(), 3e-4, Reference), "{mu} {mu_c}");
        let k_n = root(|k| discriminant(&two_dof(k_t, k, 0.4)), 1.1, 1.6);
        let exact = root(|k| closed(k_t, k, 0.4), 1.1, 1.6);
        assert!(within((k_n - exact).abs(), 1e-9, RoundOff), "{k_n} {exact}");
        assert!(within((k_n - k_c).abs(), 1e-4, Reference), "{k_n} {k_c}");
    }
}

#[test]
fn at_the_onset_of_flutter_growth_is_undecided() {
    let of = |mu: f64| {
        let modes = modes_of(&two_dof(0.5, 1.0, mu), 2, [0.0, 500.0]).modes;
        let count = |verdict| modes.iter().filter(|mode| mode.verdict() == verdict).count();
        [count(Verdict::Unstable), count(Verdict::Undecided)]
    };
    assert_eq!((of(0.62), of(0.625), of(0.63)), ([0, 0], [0, 2], [1, 0]));
}

#[test]
fn a_mode_that_is_not_accurate_is_neither_stable_nor_unstable() {
    let modes = modes_of(&two_dof(0.5, 1.0, 0.63), 2, [0.0, 500.0]).modes;
    assert!(modes.iter().any(ComplexMode::unstable));
    for mode in modes {
        assert!(mode.accurate() && mode.verdict() != Verdict::Inaccurate);
        // Whose own error is shown to be small is accurate whatever its residual.
        let stiff = ComplexMode { backward_error: 2e-8, ..mode.clone() };
        assert!(stiff.accurate() && stiff.verdict() == mode.verdict());
        let coarse = ComplexMode { backward_error: 2e-10, eigenvalue_error: 2e-8, ..mode.clone() };
        let wrong = ComplexMode { eigenvalue_error: 2e-4, ..mode.clone() };
        let lost = ComplexMode { eigenvalue_error: f64::NAN, ..mode };
        for mode in [coarse, wrong, lost] {
            assert!(mode.verdict() == Verdict::Inaccurate && !mode.unstable(), "{mode:?}");
        }
    }
}

#[test]
fn two_dof_without_tangential_spring_never_flutters_at_moderate_friction() {
    for k in 1..200 {
        let found = modes_of(&two_dof(0.0, 0.05 * k as f64, 0.4), 2, [0.0, 10.0]);
        assert!(found.modes.iter().all(|m| within(m.growth_rate(), 1e-7, RoundOff)), "k_n = 0.05 × {k}");
    }
}

#[test]
fn hoffmann_two_dof_flutter() {
    let (k12, k3) = (3.8971, 11.0);
    let k = [[23.25, k12], [k12, 18.75 - k3]];
    let system = |mu: f64| {
        let normal = NormalLaw { bilateral: true, ..NormalLaw::linear(k3) };
        let p = point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
        System {
            structure: structure(2, |i, j| f64::from(i == j), |i, j| k[i][j]),
            pairs: vec![pair(
                vec![p],
                SlidingLaw::new(normal, Coulomb { mu0: mu }, 0.0),
                Closing::Approach(1.0),
                1.0,
            )],
            load: vec![0.0; 2],
            prestress: None,
            coupling: None,
        }
    };
    let mu = root(|mu| discriminant(&system(mu)), 0.3, 0.6);
    assert!(within((mu - 0.472377).abs(), 5e-7, Reference), "{mu}");
}

/// Sinou and Jézéquel's two-degree-of-freedom system: damping can destabilise. Two contacts that carry all the
/// stiffness and damping: ω₁² along x with friction along −y, ω₂² along y with friction along x.
fn sinou(eta: [f64; 2], mu: f64) -> System {
    let omega = [200.0 * std::f64::consts::PI, 150.0 * std::f64::consts::PI];
    let pairs = (0..2)
        .map(|d| {
            let normal = NormalLaw {
                stiffness: omega[d] * omega[d],
                cubic_stiffness: 0.0,
                damping: eta[d] * omega[d],
                bilateral: true,
            };
            let tangent = if d == 0 { vector(&[(1, -1.0)]) } else { vector(&[(0, 1.0)]) };
            let p = point(0.0, 1.0, vector(&[(d, 1.0)]), tangent, SparseVector::default());
            pair(vec![p], SlidingLaw::new(normal, Coulomb { mu0: mu }, 0.0), Closing::Approach(0.0), 1.0)
        })
        .collect();
    let structure = structure(2, |i, j| f64::from(i == j), |_, _| 0.0);
    System { structure, pairs, load: vec![1.0, 1.0], prestress: None, coupling: None }
}

#[test]
fn sinou_jezequel_damping_shifts_the_onset() {
    let undamped = root(|mu| discriminant(&sinou([0.0; 2], mu)) / 1e8, 0.1, 0.4);
    assert!(within((undamped - 0.291667).abs(), 5e-7, Reference), "{undamped}");
    for (eta, mu_c) in [
        ([0.02, 0.02], 0.289425),
        ([0.02, 0.05], 0.247676),
        ([0.05, 0.02], 0.280016),
        ([0.02, 0.001], 0.141296),
    ] {
        let growth = |mu: f64| {
            let found = modes_of(&sinou(eta, mu), 2, [1.0, 500.0]);
            found.modes.iter().map(|m| m.growth_rate()).fold(f64::NEG_INFINITY, f64::max)
        };
        // The table's damped thresholds are those of ηᵢωᵢ as the damping per unit of mass.
        let mu = root(growth, 0.05, 0.4);
        assert!(within((mu - mu_c).abs(), 2e-6, Reference), "{eta:?}: {mu} {mu_c}");
    }
}

/// A mass on a belt, its normal motion apart: s² + (c + Nμ′)s + k along x.
pub(super) fn belt(c: f64, load: f64, velocity: f64, sense: FrictionSense) -> System {
    let normal = NormalLaw { bilateral: true, ..NormalLaw::linear(50.0) };
    let mut law = SlidingLaw::new(normal, Exponential { mu0: 0.3, mu1: 0.2, alpha: 1.5 }, 0.0);
    law.sense = sense;
    let p = point(0.0, 1.0, vector(&[(1, 1.0)]), vector(&[(0, 1.0)]), SparseVector::default());
    let mut structure =
        structure(2, |i, j| f64::from(i == j), |i, j| if i == j { 9.0 - 4.0 * i as f64 } else { 0.0 });
    structure.damping.viscous = Some(sparse(2, |i, j| if i == 0 && j == 0 { c } else { 0.0 }).into());
    System {
        structure,
        pairs: vec![pair(vec![p], law, Closing::Load(load), velocity)],
        load: vec![0.0; 2],
        prestress: None,
        coupling: None,
    }
}

#[test]
fn falling_friction_is_negative_damping_below_its_bound() {
    let (load, velocity) = (2.0, 0.4);
    let slope = load * 0.2 * 1.5 * f64::exp(-1.5 * velocity);
    for factor in [0.5, 0.99, 1.01, 2.0] {
        let c = factor * slope;
        let found = modes_of(&belt(c, load, velocity, FrictionSense::WithSlip), 2, [0.1, 10.0]);
        let slow = &found.modes[0];
        assert!(within((slow.growth_rate() + 0.5 * (c - slope)).abs(), 1e-12, RoundOff));
        assert_eq!(slow.unstable(), factor < 1.0);
        assert!(within((slow.growth.falling_friction - 0.5 * slope).abs(), 1e-12, RoundOff));
        assert!(within((slow.growth.structural_damping + 0.5 * c).abs(), 1e-12, RoundOff));
    }
    // A belt that pulls against the sliding turns the same law into damping.
    let found = modes_of(&belt(0.0, load, velocity, FrictionSense::AgainstSliding), 2, [0.1, 10.0]);
    assert!(within((found.modes[0].growth_rate() + 0.5 * slope).abs(), 1e-12, RoundOff));
}

/// Damping of every kind by turns.
pub(super) fn damped(mut system: System, kind: u64) -> System {
    let n = system.n_dofs();
    let (m, k) = (system.structure.mass.to_dense(), system.structure.stiffness.to_dense());
    let damping = &mut system.structure.damping;
    if kind & 1 != 0 {
        damping.viscous = Some(sparse(n, |i, j| 0.02 * m[(i, j)] + 4e-4 * k[(i, j)]).into());
    }
    if kind & 2 != 0 {
        damping.hysteretic =
            Some(sparse(n, |i, j| if i < n / 2 && j < n / 2 { 0.01 * k[(i, j)] } else { 0.0 }).into());
    }
    if kind & 4 != 0 {
        let modes = dense_modes(&system, 6);
        let coefficients = modes.eigenvalues.iter().map(|w| 2.0 * 0.01 * w.sqrt()).collect();
        system.structure.damping.modal = Some(ModalDamping { basis: &m * &modes.shapes, coefficients });
    }
    system
}

#[test]
fn random_systems_agree_with_the_dense_full_order_solution() {
    let (mut unstable, mut refined, mut partial) = (0, 0, 0);
    for seed in 0..16 {
        let n = 40 + 8 * seed as usize;
        let system = damped(random_system(n, 2 + seed as usize / 5, 20.0, 1000 + seed), seed % 8);
        let state = steady(&system);
        let kept = n / 2;
        let real = dense_modes(&system, kept);
        let top = 0.5 * (real.frequency_hz(kept / 2) + real.frequency_hz(kept / 2 + 1));
        let band = [0.01, top];
        let found = complex_modes(&system, &state, &real, band, &()).unwrap();
        let exact = dense_eigenvalues(&system, &state, band);
        assert_eq!(found.modes.len(), exact.len(), "seed {seed}: {:?}", found.warnings);
        partial += usize::from(found.subspace_dimension < n);
        for mode in &found.modes {
            let exact = nearest(mode.eigenvalue, &exact);
            let error = (mode.eigenvalue - exact).norm() / exact.norm();
            assert!(
                within(error, 1e-9, Tolerance),
                "seed {seed}: {} {exact}: {error:.1e} estimated {:.1e}",
                mode.eigenvalue,
                mode.eigenvalue_error
            );
            assert!(mode.accepted(), "seed {seed}: {mode:?}");
            let off = (mode.growth.total() - mode.growth_rate()).abs();
            assert!(within(off, 1e-8 * exact.norm(), RoundOff), "seed {seed}");
            assert!(mode.condition > 0.99);
            let shares: f64 = mode.participation.iter().map(|(_, share)| share).sum();
            assert!(within(shares - 1.0, 1e-10, RoundOff) && shares > 0.3);
            unstable += usize::from(mode.unstable());
        }
        refined += found.refinements;
    }
    // In how many of the sixteen the subspace is smaller than the system depends on the samples: 4 at the least of twenty seeds tried.
    assert!(
        unstable > 0 && refined > 0 && partial > 1,
        "{unstable} unstable, {refined} refinement steps, {partial} partial"
    );
}

/// More contact directions than real modes: a sketch of the responses represents them.
#[test]
fn many_contact_directions_agree_with_the_dense_full_order_solution() {
    for seed in [1, 3, 6] {
        let n = 360;
        let system = damped(random_system(n, 14, 20.0, 500 + seed), seed);
        let state = steady(&system);
        let real = dense_modes(&system, 24);
        assert!(linearize(&system, &state).blocks.len() * 3 > real.len());
        let band = [0.01, 0.5 * (real.frequency_hz(11) + real.frequency_hz(12))];
        let found = complex_modes(&system, &state, &real, band, &()).unwrap();
        let exact = dense_eigenvalues(&system, &state, band);
        assert_eq!(found.modes.len(), exact.len(), "seed {seed}: {:?}", found.warnings);
        assert!(found.subspace_dimension < n, "seed {seed}: the basis spans everything");
        for mode in &found.modes {
            let exact = nearest(mode.eigenvalue, &exact);
            let error = (mode.eigenvalue - exact).norm() / exact.norm();
            assert!(within(error, 1e-9, Tolerance) && mode.accepted(), "seed {seed}: {error:.1e} {mode:?}");
        }
    }
}

#[test]
fn modes_do_not_depend_on_the_number_of_threads() {
    // The second is large enough for a library to share its dense problems out.
    for (n, kept, within) in [(110, 40, 20), (500, 220, 30)] {
        let system = damped(random_system(n, 4, 20.0, 3), 5);
        let (state, real) = (steady(&system), dense_modes(&system, kept));
        let band = [0.01, real.frequency_hz(within)];
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let found = complex_modes(&system, &state, &real, band, &()).unwrap();
                let confirmation = confirm(&system, &state, &found, band, &()).unwrap();
                (found, confirmation)
            })
        };
        let ((one, first), (three, second)) = (run(1), run(3));
        assert_eq!(one.modes.len(), three.modes.len());
        for (a, b) in one.modes.iter().zip(&three.modes) {
            assert!(a.eigenvalue == b.eigenvalue && a.right == b.right && a.left == b.left, "{n}");
        }
        assert!(first.holds() && first == second, "{n}");
    }
}

/// The projection and two-level Arnoldi on the full order are two ways to the same eigenvalues.
#[test]
fn the_second_method_confirms_every_mode_and_notices_one_that_is_left_out() {
    for kind in 0..8 {
        let system = damped(random_system(60, 4, 20.0, 300 + kind), kind);
        let state = steady(&system);
        let real = dense_modes(&system, 45);
        let band = [0.01, real.frequency_hz(24)];
        let mut found = complex_modes(&system, &state, &real, band, &()).unwrap();
        let confirmation = confirm(&system, &state, &found, band, &()).unwrap();
        assert!(confirmation.holds(), "kind {kind}: {confirmation:?}");
        assert_eq!(confirmation.confirmed, found.modes.iter().filter(|m| m.eigenvalue.im > 0.0).count());
        assert!(
            within(confirmation.largest_difference, 1e-8 * confirmation.condition.max(1.0), Tolerance),
            "{confirmation:?}"
        );
        let left_out = found.modes.remove(5).eigenvalue;
        let confirmation = confirm(&system, &state, &found, band, &()).unwrap();
        assert_eq!(confirmation.missed.len(), 1);
        assert!(within((confirmation.missed[0] - left_out).norm(), 1e-8 * left_out.norm(), Tolerance));
    }
}

/// Left vectors solve ψᴴQ(λ) = 0 on the full order, formed here as a dense matrix.
#[test]
fn left_vectors_annihilate_the_operator_from_the_left() {
    let system = damped(random_system(60, 5, 20.0, 77), 7);
    let state = steady(&system);
    let real = dense_modes(&system, 30);
    let found = complex_modes(&system, &state, &real, [0.01, real.frequency_hz(12)], &()).unwrap();
    let (k, c) = dense_matrices(&system, &state);
    let m = system.structure.mass.to_dense();
    for mode in &found.modes {
        let s = mode.eigenvalue;
        let q = Mat::from_fn(60, 60, |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)]);
        let column = |x: &[c64]| Mat::from_fn(60, 1, |i, _| x[i]);
        let (right, left) = (&q * column(&mode.right), q.adjoint() * column(&mode.left));
        assert!(within(right.norm_l2(), 1e-7 * q.norm_l2(), Tolerance));
        assert!(within(left.norm_l2(), 1e-7 * q.norm_l2(), Tolerance));
    }
}

/// K_cᵀ is itself a contact, with the normal g − μt₁ and the tangent −t₁: same eigenvalues, left and right swapped.
#[test]
fn transposed_contact_swaps_left_and_right_vectors() {
    let mu = 0.45;
    let build = |transposed: bool| {
        let mut system = random_system(50, 4, 1.0, 5);
        let normal = NormalLaw { bilateral: true, ..NormalLaw::linear(400.0) };
        system.pairs[0].law = Arc::new(SlidingLaw::new(normal, Coulomb { mu0: mu }, 0.0));
        for p in Arc::make_mut(&mut system.pairs[0].points) {
            p.tangents[1] = SparseVector::default();
            if transposed {
                let t = p.tangents[0].clone();
                p.normal =
                    SparseVector::from_entries(p.normal.iter().chain(t.iter().map(|(i, v)| (i, -mu * v))));
                p.tangents[0] = SparseVector::from_entries(t.iter().map(|(i, v)| (i, -v)));
            }
        }
        system
    };
    let solve = |system: &System| {
        let real = dense_modes(system, 25);
        complex_modes(system, &steady(system), &real, [0.01, real.frequency_hz(10)], &()).unwrap()
    };
    let (a, b) = (solve(&build(false)), solve(&build(true)));
    assert_eq!(a.modes.len(), b.modes.len());
    let mut differ = 0.0f64;
    let others: Vec<c64> = b.modes.iter().map(|m| m.eigenvalue).collect();
    for x in &a.modes {
        let same = nearest(x.eigenvalue, &others);
        let y = b.modes.iter().find(|y| y.eigenvalue == same).unwrap();
        assert!(within((x.eigenvalue - y.eigenvalue).norm(), 1e-9 * x.eigenvalue.norm(), Tolerance));
        // ψᴴQ = 0 is Qᵀψ̄ = 0: the right vector of the transposed system is the conjugate left vector.
        let mac = |p: &[c64], q: &[c64]| {
            let dot = |u: &[c64], v: &[c64]| u.iter().zip(v).map(|(a, b)| a.conj() * b).sum::<c64>();
            dot(p, q).norm_sqr() / (dot(p, p).re * dot(q, q).re)
        };
        let left: Vec<c64> = x.left.iter().map(|z| z.conj()).collect();
        assert!(within(1.0 - mac(&left, &y.right), 1e-10, Tolerance));
        differ = differ.max(1.0 - mac(&x.right, &y.right));
    }
    assert!(differ > 1e-3, "the two systems must differ in their right vectors");
}

#[test]
fn input_that_cannot_be_analysed_is_refused() {
    let system = two_dof(0.5, 1.0, 0.4);
    let (state, real) = (steady(&system), dense_modes(&system, 2));
    for band in [[1.0, 1.0], [-1.0, 2.0], [0.0, f64::NAN], [0.0, f64::INFINITY]] {
        assert_eq!(complex_modes(&system, &state, &real, band, &()).unwrap_err().exit_code(), 2);
    }
    let other = dense_modes(&random_system(30, 2, 1.0, 1), 3);
    assert_eq!(complex_modes(&system, &state, &other, [0.0, 1.0], &()).unwrap_err().exit_code(), 2);
}

#[test]
fn left_vectors_are_there_where_they_are_requested() {
    let system = random_system(60, 3, 20.0, 9);
    let (state, real) = (steady(&system), dense_modes(&system, 45));
    let hz = [0.01, real.frequency_hz(12)];
    let whole = complex_modes(&system, &state, &real, hz, &()).unwrap().modes;
    let right_only = Band { left_vectors: false, ..hz.into() };
    let some = complex_modes(&system, &state, &real, right_only, &()).unwrap().modes;
    assert!(!some.is_empty() && some.len() == whole.len());
    for (a, b) in some.iter().zip(&whole) {
        assert!(a.left.is_empty() && b.left.len() == 60);
        assert!(a.eigenvalue == b.eigenvalue && a.right == b.right && a.condition == b.condition);
    }
    modal_filter(&system, &state, &whole[0]).unwrap();
    assert_eq!(modal_filter(&system, &state, &some[0]).unwrap_err().exit_code(), 2);
    assert!(Sensitivity::new(&system, &state, &real, &[&whole[0]]).is_ok());
    assert!(Sensitivity::new(&system, &state, &real, &[&some[0]]).is_err_and(|e| e.exit_code() == 2));
}

#[test]
fn the_nearest_of_a_band_are_those_of_all_modes() {
    let system = random_system(60, 3, 20.0, 9);
    let (state, real) = (steady(&system), dense_modes(&system, 45));
    let hz = [0.01, real.frequency_hz(20)];
    let all = complex_modes(&system, &state, &real, hz, &()).unwrap().modes;
    let target = real.frequency_hz(8);
    let distance = |mode: &ComplexMode| (mode.eigenvalue - c64::new(0.0, TAU * target)).norm();
    let mut sorted: Vec<&ComplexMode> = all.iter().collect();
    sorted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    for count in [0, 1, 6, all.len(), all.len() + 1] {
        let band = Band { nearest: Some((target, count)), ..hz.into() };
        let some = complex_modes(&system, &state, &real, band, &()).unwrap().modes;
        let mut expected: Vec<c64> = sorted.iter().take(count).map(|mode| mode.eigenvalue).collect();
        expected.sort_by(|a, b| a.im.total_cmp(&b.im));
        assert_eq!(some.len(), expected.len());
        for (found, expected) in some.iter().zip(&expected) {
            assert!(within((found.eigenvalue - expected).norm(), 1e-9 * expected.norm(), Tolerance));
        }
    }
}

/// A family trained on two ends of a range of friction gives the modes between them.
#[test]
fn a_family_gives_what_a_whole_analysis_gives_at_every_member() {
    let stiffness = |system: &System| Cow::Owned((*system.structure.stiffness).clone());
    let mut partial = 0;
    for seed in 0..6u64 {
        let n = 48 + 8 * seed as usize;
        let base = damped(random_system(n, 2 + seed as usize / 3, 20.0, 500 + seed), seed % 8);
        let at = |mu_0: f64, velocity: f64| {
            let mut system = base.clone();
            let normal = NormalLaw { stiffness: 300.0, cubic_stiffness: 2e4, damping: 0.0, bilateral: false };
            let law = Exponential { mu0: mu_0, mu1: 0.25, alpha: 0.8 };
            system.pairs[0].law = Arc::new(SlidingLaw::new(normal, law, 1e-3));
            system.pairs[0].sliding_velocity = velocity;
            system
        };
        let solver = SteadySolver::new(&base, stiffness(&base)).unwrap();
        let state = |system: &System| SlidingState {
            points: solver.points(&system.pairs, &system.load, &SteadyOptions::default()).unwrap(),
            damping_weights: vec![1.0],
        };
        let kept = n / 3;
        let real = dense_modes(&base, kept);
        let band = [0.01, 0.5 * (real.frequency_hz(kept / 2) + real.frequency_hz(kept / 2 + 1))];
        let frame = FamilyFrame::new(&base, &[], &real, Vec::new(), band).unwrap();
        let ends = [state(&at(0.0, 0.5)), state(&at(0.7, 2.0))];
        let mut family = Family::new(&frame, &ends).unwrap();
        for end in &ends {
            assert!(within(family.train(end).unwrap().worst(), 1e-10, Tolerance), "seed {seed}");
        }
        for (mu, velocity) in [(0.0, 0.5), (0.2, 1.7), (0.35, 1.2), (0.6, 0.6)] {
            let system = at(mu, velocity);
            let member = state(&system);
            let (found, check) = (family.modes(&member).unwrap(), family.check(&member).unwrap());
            assert_eq!(found.eigenvalues, check.eigenvalues);
            let whole = complex_modes(&system, &steady(&system), &real, band, &()).unwrap();
            assert_eq!(found.eigenvalues.len(), whole.modes.len(), "seed {seed}");
            let exact: Vec<c64> = whole.modes.iter().map(|m| m.eigenvalue).collect();
            for (z, estimate) in found.eigenvalues.iter().zip(&check.eigenvalue_errors) {
                let error = (z - nearest(*z, &exact)).norm() / z.norm();
                assert!(
                    within(error, 1e-8, Tolerance),
                    "seed {seed}, mu {mu}: {z} {error:.1e} {estimate:.1e}"
                );
            }
        }
        partial += usize::from(family.dimension() < n);
    }
    assert!(partial > 2, "{partial}");
}

#[test]
fn weights_of_dampings_are_their_sum_on_the_reduced_and_on_the_full_order() {
    let base = damped(random_system(80, 3, 20.0, 41), 6);
    let other = damped(random_system(80, 3, 20.0, 41), 3).structure.damping;
    let real = dense_modes(&base, 40);
    let band = [0.01, real.frequency_hz(20)];
    let frame = FamilyFrame::new(&base, &[], &real, vec![&other], band).unwrap();
    let member =
        |weights: &[f64]| SlidingState { points: steady(&base).points, damping_weights: weights.to_vec() };
    let mut family = Family::new(&frame, &[member(&[1.0, 0.0])]).unwrap();
    for weights in [[1.0, 0.0], [0.0, 1.0]] {
        assert!(within(family.train(&member(&weights)).unwrap().worst(), 1e-10, Tolerance));
        let mut system = base.clone();
        if weights[1] == 1.0 {
            system.structure.damping = other.clone();
        }
        let exact = dense_eigenvalues(&system, &steady(&system), band);
        let found = family.modes(&member(&weights)).unwrap().eigenvalues;
        assert_eq!(found.len(), exact.len());
        assert!(found.iter().all(|z| within((z - nearest(*z, &exact)).norm(), 1e-9 * z.norm(), Tolerance)));
    }
    assert!(within(family.check(&member(&[0.5, 0.5])).unwrap().worst(), 1e-8, Tolerance));
}
