//! Systems with gyroscopic and circulatory parts of full rank.

use super::*;
use crate::equilibrium::samples::skew_parts;
use crate::linalg::random::Random;
use crate::linalg::samples;
use crate::linalg::sparse::{add_scaled, times};
use crate::system::{Coupling, Skew};

/// A mass on springs in a frame that turns: z = x + iy with z̈ + (c + 2iΩ) ż + (k + ih) z = 0, h circulatory.
struct Rotor {
    c: f64,
    spin: f64,
    k: f64,
    h: f64,
    /// z and ż at the start.
    from: [c64; 2],
}

impl Rotor {
    fn random(random: &mut Random, h: f64) -> Rotor {
        let mut place = || c64::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let from = [place(), place() * 20.0];
        let spin = random.between(0.5, 8.0);
        Rotor { c: random.between(0.0, 1.0), spin, k: random.between(100.0, 900.0), h, from }
    }

    fn system(&self) -> (System, SteadySliding) {
        let (c, k) = (self.c, self.k);
        let mut structure = structure(2, |i, j| f64::from(i == j), move |i, j| if i == j { k } else { 0.0 });
        structure.damping.viscous = Some(sparse(2, |i, j| if i == j { c } else { 0.0 }).into());
        let (mut system, steady) = free(structure);
        let turned = |value: f64| sparse(2, move |i, j| value * (i as f64 - j as f64)).into();
        let skew = Skew { stiffness: turned(self.h), damping: turned(2.0 * self.spin) };
        system.coupling = Some(Coupling::sparse(skew));
        (system, steady)
    }

    /// A and s of z = Σ A e^{st}.
    fn terms(&self) -> [(c64, c64); 2] {
        let (c, k) = (c64::new(self.c, 2.0 * self.spin), c64::new(self.k, self.h));
        let root = (c * c - k * 4.0).sqrt();
        let s = [(-c + root) * 0.5, (-c - root) * 0.5];
        let first = (self.from[1] - s[1] * self.from[0]) / (s[0] - s[1]);
        [(first, s[0]), (self.from[0] - first, s[1])]
    }

    /// The derivative of this order of z at a time.
    fn exact(&self, time: f64, derivative: i32) -> c64 {
        self.terms().iter().map(|(a, s)| a * s.powi(derivative) * (s * time).exp()).sum()
    }

    /// −∫ ẋᵀN x dt = −h ∫ Im(z̄ ż) dt, the work of the circulatory force.
    fn circulated(&self, time: f64) -> f64 {
        let terms = self.terms();
        let pairs = terms.iter().flat_map(|a| terms.iter().map(move |b| (a, b)));
        let integral = pairs.map(|((a, s), (b, t))| {
            let sum = s.conj() + t;
            a.conj() * b * t * ((sum * time).exp() - 1.0) / sum
        });
        -self.h * integral.sum::<c64>().im
    }

    fn run(&self, scheme: Scheme, steps: usize, time: f64) -> Marched {
        let (system, steady) = self.system();
        let model = TransientModel::new(&system, &steady).unwrap();
        let [u, v, a] = [0, 1, 2].map(|k| {
            let z = self.exact(0.0, k);
            [z.re, z.im]
        });
        run(&model, start(&model, &u, &v, &a), plan(scheme, time / steps as f64, steps))
    }
}

#[test]
fn a_spinning_mass_follows_the_closed_form_with_the_order_of_the_scheme() {
    let mut random = Random::seeded(11);
    for (number, scheme) in schemes().into_iter().cycle().take(20).enumerate() {
        let h = if number % 3 == 0 { 0.0 } else { random.between(-60.0, 60.0) };
        let rotor = Rotor::random(&mut random, h);
        let time = 0.5;
        let label = format!("{number} {scheme:?}");
        let error = |steps: usize| {
            let end = rotor.run(scheme, steps, time);
            let z = c64::new(end.state.motion[(0, 0)], end.state.motion[(1, 0)]);
            (z - rotor.exact(time, 0)).norm()
        };
        let order = (error(2000) / error(4000)).log2();
        let expected = if scheme.gamma == 0.6 && scheme.alpha_f == 0.0 { 1.0 } else { 2.0 };
        assert!(within((order - expected).abs(), 0.1, Discretisation), "{label}: {order}");
        let end = rotor.run(scheme, 100, time);
        // Round-off of the works of a step, which are the smaller the less it moves: 1e-14 to 3e-13 of their sum.
        assert!(within(end.worst_residual, 1e-11, RoundOff), "{label}: {:e}", end.worst_residual);
        let work = end.work;
        let size = work.turnover();
        if h == 0.0 {
            assert_eq!(work.coupling, 0.0, "{label}: gyroscopic forces do no work");
        } else {
            let off = (rotor.run(scheme, 4000, time).work.coupling - rotor.circulated(time)).abs();
            assert!(within(off, 0.01 * size, Discretisation), "{label}: {off:e} of {size:e}");
        }
        if scheme == Scheme::TRAPEZOIDAL {
            assert!(within(work.algorithm.abs(), 1e-12 * size, RoundOff), "{label}: {:e}", work.algorithm);
        }
    }
}

/// A random damped body with skew parts of full rank; without contacts where these are circulatory.
fn turning(seed: u64, spin: f64, friction: f64) -> System {
    let mut system = damped(seed);
    if friction > 0.0 {
        system.pairs.clear();
        system.load.fill(0.0);
    }
    system.coupling = Some(skew_parts(30, seed, spin, friction));
    system
}

/// The three modes that grow fastest, or die away most slowly: of others rounding in these is what is left at the end.
#[test]
fn disturbances_of_turning_bodies_grow_and_turn_as_the_complex_eigenvalues_say() {
    let mut unstable = 0;
    for (seed, spin, friction) in
        [(1, 4.0, 0.0), (2, 15.0, 0.0), (3, 3.0, 300.0), (4, 0.0, 500.0), (5, 8.0, 800.0)]
    {
        let system = turning(seed, spin, friction);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let modes =
            complex_modes(&system, &steady, &dense_modes(&system, 30), [0.0, 1e3], &()).unwrap().modes;
        let mut order: Vec<usize> = (0..modes.len()).collect();
        order.sort_by(|a, b| modes[*b].growth_rate().total_cmp(&modes[*a].growth_rate()));
        for mode in &order[..3] {
            let coarse = measured(&system, Scheme::TRAPEZOIDAL, 1e-3, *mode);
            let fine = measured(&system, Scheme::TRAPEZOIDAL, 5e-4, *mode);
            let error = |(lambda, found): (c64, c64)| (found - lambda).norm() / lambda.norm();
            assert!(within(error(fine), 1e-3, Discretisation), "{seed} {mode}: {fine:?}");
            assert!(
                within(error(fine), 0.3 * error(coarse) + 1e-6, Discretisation),
                "{seed} {mode}: {coarse:?} {fine:?}"
            );
            unstable += usize::from(fine.0.re > 1e-2);
        }
    }
    assert!(unstable > 3, "{unstable}");
}

#[test]
fn the_condensed_step_of_turning_bodies_is_the_full_newton_step() {
    for (seed, scheme) in schemes().into_iter().enumerate() {
        let mut system = turning(seed as u64 + 1, 20.0, 0.0);
        if seed % 2 == 1 {
            system.structure.damping.modal = None;
        }
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let track = winding(&system);
        let back = TimeProfile::Reciprocating { frequency_hz: 0.5, phase: 0.1 };
        let model = TransientModel::new(&system, &steady).unwrap().driven(vec![back], vec![blow()]);
        let model = model.travelling(vec![Some(&track)]);
        let (mut open, mut states) = (0, Vec::new());
        let condensed = plan(scheme, 2e-3, 400);
        let end = march(&model, State::steady(&model, &steady), &condensed, &(), &mut |moment| {
            let points = 0..model.points.len();
            open += points.filter(|p| moment.state.contact_forces(*p)[0] == 0.0).count();
            states.push(moment.state.motion.clone());
            Ok(())
        })
        .unwrap();
        assert!(open > 10 && open < 1590, "{open}");
        assert!(within(end.worst_residual, 1e-9, Tolerance), "{scheme:?}: {:e}", end.worst_residual);
        full_newton_agrees(&model, &steady, condensed, &states);
    }
}

/// Sparse skew parts, the same between unit directions as a coupling of low rank, and a model reduced to all modes.
#[test]
fn skew_parts_move_a_body_however_they_are_given() {
    for (seed, spin, friction) in [(1, 20.0, 0.0), (2, 5.0, 100.0), (3, 0.0, 200.0)] {
        let mut sparse = turning(seed, spin, friction);
        let whole = sparse.coupling.take().unwrap();
        let [stiffness, damping] = whole.assembled(30).unwrap().map(|a| a.to_dense());
        let directions = (0..30).map(|k| vector(&[(k, 1.0)])).collect();
        let low_rank = Coupling { directions, stiffness, damping, skew: None };
        let mut beside = sparse.clone();
        // Half of the sparse parts beside half in low rank.
        let half = |a: &crate::linalg::SparseMatrix| add_scaled(&[(0.5, a)]).into();
        let skew = whole
            .skew
            .as_ref()
            .map(|skew| Skew { stiffness: half(&skew.stiffness), damping: half(&skew.damping) });
        let halved = |a: &Mat<f64>| a * faer::Scale(0.5);
        beside.coupling = Some(Coupling {
            stiffness: halved(&low_rank.stiffness),
            damping: halved(&low_rank.damping),
            skew,
            directions: low_rank.directions.clone(),
        });
        let mut other = sparse.clone();
        other.coupling = Some(low_rank);
        sparse.coupling = Some(whole);
        let steady = solve_steady(&sparse, &SteadyOptions::default(), &()).unwrap();
        let reduced =
            crate::reduction::reduce(&beside, &steady, &dense_modes(&beside, 30), &[], None).unwrap();
        let small = reduced.steady(&steady);
        let plan = plan(Scheme::hht(-0.05), 1e-3, 600);
        let go = |system: &System, steady: &SteadySliding, push: Push| {
            let profiles = vec![TimeProfile::Constant; system.pairs.len()];
            let model = TransientModel::new(system, steady).unwrap().driven(profiles, vec![push]);
            run(&model, State::steady(&model, steady), plan)
        };
        let a = go(&sparse, &steady, blow());
        let seen = Push { direction: reduced.form(&blow().direction), ..blow() };
        let few = go(&reduced.system, &small, seen);
        let others = [go(&other, &steady, blow()), go(&beside, &steady, blow())];
        let motions = others.iter().map(|end| end.state.motion.col_as_slice(0).to_vec());
        let size = a.state.motion.col(0).norm_max();
        for motion in motions.chain([reduced.expand(few.state.motion.col_as_slice(0))]) {
            let off = motion.iter().zip(a.state.motion.col_as_slice(0)).map(|(x, y)| (x - y).abs());
            let off = off.fold(0.0, f64::max);
            assert!(within(off, 1e-8 * size, RoundOff), "{seed}: {off:e} of {size:e}");
        }
        for end in others.iter().chain([&few]) {
            let turnover = a.work.turnover();
            for (one, other) in end.work.terms().iter().zip(a.work.terms()) {
                assert!(within((one - other).abs(), 1e-8 * turnover, RoundOff), "{seed}: {one} {other}");
            }
        }
    }
}

#[test]
fn a_turning_plate_moves_the_same_on_any_number_of_threads() {
    let (k, m) = samples::plate(30, true);
    let n = k.ncols();
    let turned = |size: f64| {
        let below: Vec<_> = (0..n)
            .flat_map(|j| k.row_idx_of_col(j).zip(k.val_of_col(j)).map(move |(i, v)| (i, j, size * v)))
            .filter(|(i, j, _)| i > j)
            .flat_map(|(i, j, v)| {
                [crate::linalg::sparse::entry(i, j, v), crate::linalg::sparse::entry(j, i, -v)]
            })
            .collect();
        crate::linalg::SparseMatrix::try_new_from_triplets(n, n, &below).unwrap()
    };
    let skew = Skew { stiffness: turned(1e-3).into(), damping: turned(1e-7).into() };
    let basis = times(&m, Mat::from_fn(n, 3, |i, j| ((i * (j + 1)) as f64 * 0.01).sin()).as_ref());
    let damping = Damping {
        modal: Some(ModalDamping { basis, coefficients: vec![1.0, 2.0, 3.0] }),
        ..Damping::default()
    };
    let structure = Structure { mass: m.into(), stiffness: k.into(), damping, engine: Default::default() };
    let (mut system, steady) = free(structure);
    system.coupling = Some(Coupling::sparse(skew));
    let ends = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = TransientModel::new(&system, &steady).unwrap();
            let moved: Vec<f64> = (0..n).map(|i| 1e-3 * (i as f64 * 0.02).cos()).collect();
            let zero = vec![0.0; n];
            let end = run(&model, start(&model, &moved, &zero, &zero), plan(Scheme::hht(-0.1), 1e-5, 8));
            (end.state.motion.clone(), end.work)
        })
    });
    assert!(n > 2000 && ends[0] == ends[1] && ends[0] == ends[2], "{n}");
    assert!(ends[0].0.norm_max().is_finite());
}
