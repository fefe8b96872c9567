mod no_state;
mod sticking;

use super::samples::*;
use super::*;
use crate::bounds::{Origin::*, within};
use crate::contact::{Coulomb, NormalLaw, SlidingLaw};
use crate::error::{Error, Result};
use crate::linalg::random::Random;
use crate::linalg::{SparseMatrix, SparseVector, extended};
use crate::system::{Closing, Damping, Prestress, Structure, System};
use faer::Mat;
use std::sync::Arc;

fn solve(system: &System) -> Result<SteadySliding> {
    solve_steady(system, &SteadyOptions::default(), &())
}

#[test]
fn two_dof_equilibrium_is_that_of_its_two_equations() {
    let (k_t, k_n, mu) = (0.5, 1.2, 0.4);
    let steady = solve(&two_dof(k_t, k_n, mu)).unwrap();
    // [1.5 + kt, −0.5 + μ k_n; −0.5, 0.5 + k_n] (x, y) = (0, −1)
    let (a, b, c, d) = (1.5 + k_t, -0.5 + mu * k_n, -0.5, 0.5 + k_n);
    let det = a * d - b * c;
    let exact = [b / det, -a / det];
    for (found, exact) in steady.displacement.iter().zip(exact) {
        assert!(within((found - exact).abs(), 1e-14, RoundOff));
    }
    assert!(within((steady.points[0].forces.normal + k_n * exact[1]).abs(), 1e-14, RoundOff));
    assert!(within(steady.residual, 1e-14, RoundOff));
}

#[test]
fn random_systems_carry_their_load_and_balance() {
    let mut open = 0;
    for seed in 0..20 {
        let system = random_system(40 + 7 * seed as usize, 3 + seed as usize, 5.0 + seed as f64, seed);
        let steady = solve(&system).unwrap();
        let total: f64 = steady.points.iter().map(|p| p.forces.normal).sum();
        assert!(within((total - (5.0 + seed as f64)).abs(), 1e-11, RoundOff), "seed {seed}: ΣN = {total}");
        assert!(within(steady.residual, 1e-13, RoundOff), "seed {seed}: {:.1e}", steady.residual);
        for state in &steady.points {
            assert_eq!(state.forces.normal > 0.0, state.penetration > 0.0);
            open += usize::from(!state.closed());
        }
    }
    assert!(open > 20, "the samples must open some points: {open}");
}

#[test]
fn cubic_penalty_on_rigid_ground_has_its_closed_form() {
    // One mass on a very soft spring, closed by a load: N(δ) = 1000 δ + 1e9 δ³ = 9 has δ = 2e-3 minus the spring's part.
    let normal = NormalLaw { stiffness: 500.0, cubic_stiffness: 1e9, damping: 0.0, bilateral: false };
    let p = point(0.3, 1.0, vector(&[(0, 1.0)]), SparseVector::default(), SparseVector::default());
    let system = System {
        structure: structure(1, |_, _| 1.0, |_, _| 40.0),
        pairs: vec![pair(
            vec![p],
            SlidingLaw::new(normal, Coulomb { mu0: 0.3 }, 0.0),
            Closing::Load(9.0),
            1.0,
        )],
        load: vec![0.0],
        prestress: None,
        coupling: None,
    };
    let steady = solve(&system).unwrap();
    // 500 · 2e-3 + 1e9 · 8e-9 = 9; u = −9/40; approach = δ + gap − u.
    assert!(within((steady.points[0].penetration - 2e-3).abs(), 1e-14, RoundOff));
    assert!(within((steady.displacement[0] + 9.0 / 40.0).abs(), 1e-14, RoundOff));
    assert!(within((steady.approach[0] - (2e-3 + 0.3 + 9.0 / 40.0)).abs(), 1e-13, RoundOff));
}

/// A body of two masses in y that only the contact holds, pressed by its weight; x held by a spring.
fn free_body(held_in_x: bool) -> System {
    let k = [[5.0, -5.0, 0.0], [-5.0, 5.0, 0.0], [0.0, 0.0, if held_in_x { 7.0 } else { 0.0 }]];
    let p = point(0.0, 1.0, vector(&[(0, -1.0)]), vector(&[(2, 1.0)]), SparseVector::default());
    System {
        structure: structure(3, |i, j| if i == j { 1.0 } else { 0.0 }, |i, j| k[i][j]),
        pairs: vec![pair(
            vec![p],
            SlidingLaw::new(NormalLaw::linear(100.0), Coulomb { mu0: 0.5 }, 0.0),
            Closing::Approach(0.0),
            1.0,
        )],
        load: vec![0.0, -2.0, 0.0],
        prestress: None,
        coupling: None,
    }
}

#[test]
fn a_body_held_only_by_the_contact_finds_its_rigid_position() {
    let steady = solve(&free_body(true)).unwrap();
    let exact = [-2.0 / 100.0, -2.0 / 100.0 - 2.0 / 5.0, 0.5 * 2.0 / 7.0];
    for (found, exact) in steady.displacement.iter().zip(exact) {
        assert!(within((found - exact).abs(), 1e-13, RoundOff), "{found} {exact}");
    }
}

fn analysis_error(system: &System, options: &SteadyOptions) -> String {
    match solve_steady(system, options, &()) {
        Err(error @ Error::Analysis { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_has_no_steady_state_is_explained() {
    let options = SteadyOptions::default();
    assert!(analysis_error(&free_body(false), &options).contains("nothing holds"));

    // A chain of masses that floats in x: singular to round-off only, and the contact acts in y.
    let link = [3.1, 0.7, 1.9, 2.3];
    let mut floating = free_body(true);
    floating.load = vec![0.0; 6];
    floating.load[5] = -1.0;
    floating.structure = structure(
        6,
        |i, j| f64::from(i == j),
        |i, j| match (i.min(j), i.max(j)) {
            (5, 5) => 4.0,
            (_, 5) => 0.0,
            (a, b) if a == b => link.get(a).unwrap_or(&0.0) + if a > 0 { link[a - 1] } else { 0.0 },
            (a, b) if a + 1 == b => -link[a],
            _ => 0.0,
        },
    );
    let point = &mut Arc::make_mut(&mut floating.pairs[0].points)[0];
    point.normal = vector(&[(5, -1.0)]);
    point.tangents[0] = vector(&[(2, 1.0)]);
    assert!(analysis_error(&floating, &options).contains("nothing holds"));

    let mut lifted = free_body(true);
    lifted.structure.stiffness = sparse(3, |i, j| if i == j { 9.0 } else { 0.0 }).into();
    Arc::make_mut(&mut lifted.pairs[0].points)[0].gap = 1.0;
    assert!(analysis_error(&lifted, &options).contains("no point touches"));

    let crush = SteadyOptions { penetration_limit: 1e-3, ..options };
    assert!(analysis_error(&free_body(true), &crush).contains("crushes"));

    // Lifted off and free: no equilibrium at all.
    let mut flying = free_body(true);
    flying.load[1] = 2.0;
    assert!(analysis_error(&flying, &options).contains("no steady state"));

    let mut faulty = free_body(true);
    faulty.pairs[0].sliding_velocity = 0.0;
    faulty.pairs[0].closing = Closing::Load(-1.0);
    let error = solve(&faulty).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("sliding velocity") && error.to_string().contains("closing load"));
}

#[derive(Debug)]
struct Stiffening(f64);

impl Prestress for Stiffening {
    fn geometric_stiffness(&self, displacement: &[f64]) -> Result<SparseMatrix> {
        Ok(sparse(1, |_, _| self.0 * displacement[0]))
    }
}

#[test]
fn prestress_is_carried_to_its_fixed_point() {
    // (k + k_n + a u) u = f with bilateral contact: a quadratic in u.
    let normal = NormalLaw { bilateral: true, ..NormalLaw::linear(30.0) };
    let p = point(0.0, 1.0, vector(&[(0, 1.0)]), SparseVector::default(), SparseVector::default());
    let system = System {
        structure: Structure {
            mass: sparse(1, |_, _| 1.0).into(),
            stiffness: sparse(1, |_, _| 70.0).into(),
            damping: Damping::default(),
            engine: Default::default(),
        },
        pairs: vec![pair(
            vec![p],
            SlidingLaw::new(normal, Coulomb { mu0: 0.3 }, 0.0),
            Closing::Approach(0.0),
            1.0,
        )],
        load: vec![12.0],
        prestress: Some(Arc::new(Stiffening(80.0))),
        coupling: None,
    };
    let steady = solve(&system).unwrap();
    let exact = (-100.0 + (100.0f64 * 100.0 + 4.0 * 80.0 * 12.0).sqrt()) / 160.0;
    assert!(within((steady.displacement[0] - exact).abs(), 1e-13, RoundOff));
    let tangent = tangent_stiffness(&system, &steady.displacement).unwrap();
    assert!(within((tangent.val()[0] - (70.0 + 80.0 * exact)).abs(), 1e-10, RoundOff));

    /// Takes away what structure and contact have.
    #[derive(Debug)]
    struct Buckling;
    impl Prestress for Buckling {
        fn geometric_stiffness(&self, _: &[f64]) -> Result<SparseMatrix> {
            Ok(sparse(1, |_, _| -100.0))
        }
    }
    let buckled = System { prestress: Some(Arc::new(Buckling)), ..system };
    let said = analysis_error(&buckled, &SteadyOptions::default());
    assert!(said.contains("as in buckling") && said.contains("Lower the load"), "{said}");
}

/// Goal: a chain that only contacts on one side hold, touching without force at first, is found where it is pressed, whatever tiny
/// stiffness rounding or a preload leaves it when all of them are open.
#[test]
fn bodies_that_only_contact_holds_are_found_pressed() {
    for (power, sign) in (-16..-8).flat_map(|power| [(power, 1.0), (power, -1.0)]) {
        let left = sign * 1000.0 * 10f64.powi(power);
        let stiffness = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 500.0 * if i == 1 { 2.0 } else { 1.0 } + left,
            1 => -500.0,
            _ => 0.0,
        };
        let none = SparseVector::default;
        let points = (0..3).map(|i| point(0.0, 1.0, vector(&[(i, 1.0)]), none(), none())).collect();
        let law = SlidingLaw::new(NormalLaw::linear(1000.0), Coulomb { mu0: 0.3 }, 0.0);
        let system = System {
            structure: structure(3, |i, j| f64::from(u8::from(i == j)), stiffness),
            pairs: vec![pair(points, law, Closing::Approach(0.0), 1.0)],
            load: vec![3.0, 4.0, 5.0],
            prestress: None,
            coupling: None,
        };
        let steady = solve(&system).unwrap();
        let sum: f64 = steady.points.iter().map(|point| point.forces.normal).sum();
        assert!(within((sum / 12.0 - 1.0).abs(), 1e-6, Stated), "{left:e}: {sum}");
        assert!(within(steady.residual, 1e-6, Stated), "{left:e}: {:e}", steady.residual);
    }
}

/// K_c and C_c against differences of r_c in a random direction.
#[test]
fn linearised_contact_is_the_derivative_of_the_residual() {
    for seed in 0..6 {
        let system = random_system(45, 9, 12.0, 100 + seed);
        let n = system.n_dofs();
        let steady = solve(&system).unwrap();
        let contact = linearize(&system, &steady);
        assert!(!contact.blocks.is_empty());
        let points: Vec<_> = system.points().map(|(_, p)| p).collect();
        let mut random = Random::seeded(seed + 1);
        let du: Vec<f64> = (0..n).map(|_| random.between(-1.0, 1.0)).collect();
        let dv: Vec<f64> = (0..n).map(|_| random.between(-1.0, 1.0)).collect();
        let mut exact = vec![0.0; n];
        for block in &contact.blocks {
            let u = directions(points[block.point]);
            for row in 0..3 {
                let force: f64 = (0..3)
                    .map(|c| block.stiffness[row][c] * u[c].dot(&du) + block.damping[row][c] * u[c].dot(&dv))
                    .sum();
                u[row].add_to(force, &mut exact);
            }
        }
        let h = 1e-6;
        let at = |s: f64| {
            let u: Vec<f64> = steady.displacement.iter().zip(&du).map(|(a, b)| a + s * h * b).collect();
            let v: Vec<f64> = dv.iter().map(|b| s * h * b).collect();
            contact_force(&system, &steady.approach, &u, &v)
        };
        let (plus, minus) = (at(1.0), at(-1.0));
        let size = exact.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        for i in 0..n {
            let difference = (plus[i] - minus[i]) / (2.0 * h);
            assert!(
                within((difference - exact[i]).abs(), 1e-7 * size, Reference),
                "dof {i}: {difference} {}",
                exact[i]
            );
        }
    }
}

#[test]
fn two_dof_contact_stiffness_has_the_signs_of_its_equations() {
    let system = two_dof(0.5, 1.3, 0.4);
    let contact = linearize(&system, &solve(&system).unwrap());
    let u = directions(&system.pairs[0].points[0]);
    let mut k = [[0.0; 2]; 2];
    for (j, e) in [[1.0, 0.0], [0.0, 1.0]].iter().enumerate() {
        for row in 0..3 {
            let mut column = vec![0.0; 2];
            let force = (0..3).map(|c| contact.blocks[0].stiffness[row][c] * u[c].dot(e)).sum();
            u[row].add_to(force, &mut column);
            k[0][j] += column[0];
            k[1][j] += column[1];
        }
    }
    assert_eq!(k, [[0.0, 0.4 * 1.3], [0.0, 1.3]]);
}

#[test]
fn a_neighbour_is_found_without_a_new_factorisation() {
    let system = random_system(60, 5, 20.0, 11);
    let state = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
    let nearby = super::Nearby::new(&system, &state).unwrap();
    let mut other = system.clone();
    other.pairs[0].closing = Closing::Load(20.4);
    other.pairs[0].sliding_velocity *= 0.98;
    let k = system.structure.stiffness.to_dense();
    other.structure.stiffness =
        sparse(60, |i, j| if i < 30 && j < 30 { 1.02 * k[(i, j)] } else { k[(i, j)] }).into();
    let (found, exact) =
        (nearby.solve(&other).unwrap(), solve_steady(&other, &SteadyOptions::default(), &()).unwrap());
    let scale = exact.displacement.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    assert!(found.displacement.iter().zip(&exact.displacement).all(|(a, b)| within(
        (a - b).abs(),
        1e-12 * scale,
        Tolerance
    )));
    assert!(
        within((found.approach[0] - exact.approach[0]).abs(), 1e-12 * scale, Tolerance)
            && within(found.residual, 1e-14, Tolerance)
    );
    assert!(nearby.solve(&random_system(61, 5, 20.0, 11)).is_err());
}

/// The linear system of the points that are closed, solved with twice the digits: K u + Σ (g − r₁t₁ − r₂t₂) N = f,
/// a + gᵀu − N/k = gap, and ΣN = L or the given a, with r the ratios of friction to normal force. Gives (u, N, a), and what
/// rounding of the entries changes of each.
fn by_elimination(system: &System, state: &SteadySliding) -> (Vec<f64>, Vec<f64>) {
    let closed: Vec<usize> = (0..state.points.len()).filter(|p| state.points[*p].closed()).collect();
    let (n, size) = (system.n_dofs(), system.n_dofs() + closed.len() + 1);
    let (mut a, mut b) = (Mat::<f64>::zeros(size, size), system.load.clone());
    a.submatrix_mut(0, 0, n, n).copy_from(system.structure.stiffness.to_dense());
    b.resize(size, 0.0);
    match system.pairs[0].closing {
        Closing::Load(load) => {
            b[size - 1] = load;
            (n..size - 1).for_each(|j| a[(size - 1, j)] = 1.0);
        }
        Closing::Approach(approach) => (b[size - 1], a[(size - 1, size - 1)]) = (approach, 1.0),
    }
    for (row, p) in (n..).zip(closed) {
        let (point, PointState { forces, tangent, .. }) = (&system.pairs[0].points[p], &state.points[p]);
        let ratios = forces.friction.map(|friction| friction / forces.normal);
        let sides = point.tangents.iter().zip(ratios).map(|(t, ratio)| (-ratio, t));
        for (factor, direction) in sides.chain([(1.0, &point.normal)]) {
            direction.iter().for_each(|(i, x)| a[(i, row)] += factor * x);
        }
        point.normal.iter().for_each(|(i, x)| a[(row, i)] += x);
        (a[(row, row)], a[(row, size - 1)], b[row]) = (-1.0 / tangent.by_penetration[0], 1.0, point.gap);
    }
    extended::solve(&a, &b)
}

/// A penalty is the limit of a rigid contact: above a certain stiffness nothing changes any more, and every digit of the
/// forces stays that rounding of K and of the directions leaves, although δ is 1e-20 m beside motions of 1e-2 m.
#[test]
fn a_penalty_however_stiff_carries_the_load() {
    let with = |stiffness: f64, closing: Closing| {
        let mut system = random_system(60, 6, 8.0, 4);
        let law = SlidingLaw::new(NormalLaw::linear(stiffness), Coulomb { mu0: 0.3 }, 0.0);
        (system.pairs[0].law, system.pairs[0].closing) = (Arc::new(law), closing);
        let state = solve(&system).unwrap();
        (system, state)
    };
    let (_, reference) = with(1e13, Closing::Load(8.0));
    for closing in [Closing::Load(8.0), Closing::Approach(reference.approach[0])] {
        for stiffness in [1e15, 1e18, 1e22] {
            let (system, stiff) = with(stiffness, closing);
            assert!(within(stiff.residual, 1e-13, RoundOff), "{stiffness:e}: {:.1e}", stiff.residual);
            let (exact, moved) = by_elimination(&system, &stiff);
            let forces = stiff.points.iter().filter(|p| p.closed()).map(|p| p.forces.normal);
            for ((found, exact), moved) in
                stiff.displacement.iter().copied().chain(forces).zip(exact).zip(moved)
            {
                let off = (found - exact).abs();
                assert!(within(off, 20.0 * moved, RoundOff), "{stiffness:e}: {found} {exact}");
            }
            assert!(stiff.points.iter().zip(&reference.points).all(|(a, b)| a.closed() == b.closed()));
        }
    }
}

#[test]
fn a_state_that_does_not_meet_its_equations_is_refused() {
    // Two masses tied by a spring that is so stiff that K u has no digit left.
    let mut system = free_body(true);
    let k = [[1.0 + 1e25, -1e25, 0.0], [-1e25, 3.0 + 1e25, 0.0], [0.0, 0.0, 7.0]];
    system.structure.stiffness = sparse(3, |i, j| k[i][j]).into();
    let said = analysis_error(&system, &SteadyOptions::default());
    assert!(said.contains("steady sliding"), "{said}");

    // Laws beyond the largest number.
    let mut system = free_body(true);
    let normal = NormalLaw { cubic_stiffness: 1e300, ..NormalLaw::linear(1e300) };
    system.pairs[0].law = Arc::new(SlidingLaw::new(normal, Coulomb { mu0: 0.5 }, 0.0));
    system.pairs[0].closing = Closing::Approach(1e10);
    let said = analysis_error(&system, &SteadyOptions::default());
    assert!(said.contains("no steady state"), "{said}");
}

/// A contact that also pulls, at its place without a load: N = 0 everywhere and u = 0 is the state, of gaps that are none or rounding, of few points and many,
/// linear and cubic.
#[test]
fn a_bilateral_contact_without_a_load_carries_nothing() {
    for seed in 0..12 {
        for (rounding, cubic) in [(0.0, 0.0), (0.0, 2e4), (1e-17, 0.0), (1e-17, 2e4), (1e-300, 0.0)] {
            let mut random = Random::seeded(seed);
            let mut system = random_system(40, if seed % 3 == 0 { 230 } else { 5 }, 1.0, seed);
            let mut points = system.pairs[0].points.to_vec();
            points.iter_mut().for_each(|point| point.gap = rounding * random.next());
            let normal =
                NormalLaw { stiffness: 300.0, cubic_stiffness: cubic, damping: 0.0, bilateral: true };
            let law = SlidingLaw::new(normal, Coulomb { mu0: 0.3 }, 0.0);
            system.pairs[0] = pair(points, law, Closing::Approach(0.0), 1.2);
            system.load = vec![0.0; 40];
            let state = solve(&system).unwrap_or_else(|error| panic!("{seed} {rounding:e} {cubic}: {error}"));
            let largest = state.points.iter().map(|point| point.forces.normal.abs()).fold(0.0, f64::max);
            let moved = state.displacement.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
            assert!(
                within(largest, 1e4 * rounding, RoundOff) && within(moved, 1e2 * rounding, RoundOff),
                "{seed}: {largest:e}"
            );
        }
    }
}
