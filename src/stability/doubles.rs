//! Eigenvalues that are zero or double: their rounding is the root of that of the matrices.

use super::{ComplexModes, Verdict, complex_modes};
use crate::bounds::{Origin::*, least, within};
use crate::equilibrium::samples::sparse;
use crate::equilibrium::{SteadyOptions, solve_steady};
use crate::linalg::random::Random;
use crate::linalg::{SparseVector, c64};
use crate::modal::samples::dense_modes;
use crate::system::{Coupling, Damping, Structure, System};
use faer::Mat;
use std::f64::consts::TAU;

fn system(mass: &Mat<f64>, damping: &Mat<f64>, stiffness: &Mat<f64>) -> System {
    let n = mass.nrows();
    let of = |a: &Mat<f64>| std::sync::Arc::new(sparse(n, |i, j| a[(i, j)]));
    let viscous = (damping.norm_max() > 0.0).then(|| of(damping));
    let damping = Damping { viscous, ..Damping::default() };
    let (mass, stiffness) = (of(mass), of(stiffness));
    System::new(Structure { mass, stiffness, damping, engine: Default::default() }, Vec::new())
}

fn modes(system: &System, band_hz: [f64; 2]) -> ComplexModes {
    let steady = solve_steady(system, &SteadyOptions::default(), &()).unwrap();
    let real = dense_modes(system, system.n_dofs());
    let modes = complex_modes(system, &steady, &real, band_hz, &()).unwrap();
    for mode in &modes.modes {
        let numbers = [mode.eigenvalue_error, mode.uncertainty, mode.condition, mode.damping_ratio()];
        assert!(numbers.iter().all(|v| v.is_finite()) && mode.accurate(), "{mode:?}");
    }
    modes
}

/// Graphs of springs of `parts` pieces, alike where `alike`, none held, with masses from one to three and springs of a unit: each
/// piece has λ = 0 twice.
fn free_graph(parts: usize, alike: bool, unit: f64, seed: u64) -> [Mat<f64>; 2] {
    let mut random = Random::seeded(seed);
    let size = 2 + seed as usize % 5;
    let n = parts * size;
    let (mut mass, mut stiffness) = (Mat::<f64>::zeros(n, n), Mat::<f64>::zeros(n, n));
    for part in 0..parts {
        if alike {
            random = Random::seeded(seed);
        }
        let mut spring = |a: usize, b: usize, random: &mut Random| {
            let k = unit * (1.5 + random.next());
            for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                stiffness[(part * size + i, part * size + j)] += sign * k;
            }
        };
        (1..size).for_each(|i| spring(i, (i * 7) % i, &mut random));
        spring(0, size - 1, &mut random);
        (0..size).for_each(|i| mass[(part * size + i, part * size + i)] = 2.0 + random.next());
    }
    [mass, stiffness]
}

#[test]
fn nothing_grows_in_bodies_that_nothing_holds() {
    for seed in 0..40 {
        let (parts, alike) = (1 + seed as usize % 3, seed % 2 == 0);
        let unit = 10f64.powi([-3, 2, 6, 11][seed as usize / 10]);
        let [mass, stiffness] = free_graph(parts, alike, unit, seed);
        let n = mass.nrows();
        let system = system(&mass, &Mat::zeros(n, n), &stiffness);
        let real = dense_modes(&system, n);
        let top = 1.1 * real.frequency_hz(n - 1);
        let found = modes(&system, [0.0, top]).modes;
        let zero = found.iter().filter(|mode| mode.is_zero()).count();
        assert_eq!((zero, found.len()), (2 * parts, n + parts), "{seed}: {found:#?}");
        let above = modes(&system, [1e-2 * top, top]).modes;
        assert_eq!(above.len(), n - parts, "{seed}");
        for (k, mode) in found.iter().enumerate() {
            // Rounding mixes the vectors of equal parts, so that of some of these growth is undecided.
            let undecided = mode.verdict() == Verdict::Undecided;
            assert!(!mode.unstable() && (k >= 2 * parts || undecided), "{seed}: {mode:?}");
            // Rounding of K: √ε of its scale.
            assert!(within(mode.uncertainty, 1e-6 * TAU * top, RoundOff), "{seed}: {mode:?}");
            let hz = if k < 2 * parts { 0.0 } else { real.frequency_hz(k - parts) };
            // Equal parts are separated by a change of the projected problem, of which one Newton step leaves less than this.
            assert!(within((mode.frequency_hz() - hz).abs(), 1e-9 * top, Tolerance), "{seed}: {mode:?}");
        }
    }
}

/// Growth below the resolution of an eigenvalue, of all sizes of growth, backward error and condition, is never called unstable, above it always.
#[test]
fn growth_below_the_resolution_is_undecided() {
    let [mass, stiffness] = free_graph(1, false, 1.0, 3);
    let n = mass.nrows();
    let mode = modes(&system(&mass, &Mat::zeros(n, n), &stiffness), [0.01, 1.0]).modes.pop().unwrap();
    let mut random = Random::seeded(8);
    let mut undecided = 0;
    for _ in 0..2000 {
        let mut power = |low: f64, high: f64| 10f64.powf(random.between(low, high));
        let (size, growth) = (power(0.0, 6.0), power(-12.0, -2.0));
        let mut mode = mode.clone();
        (mode.backward_error, mode.condition, mode.uncertainty) =
            (power(-16.0, -10.1), power(0.0, 5.0), power(-16.0, -9.0) * size);
        (mode.eigenvalue, mode.eigenvalue_error) = (c64::new(growth * size, size), 1e-12);
        let resolved = mode.backward_error * mode.condition < growth && mode.uncertainty < growth * size;
        let grows = super::unstable(mode.eigenvalue);
        match mode.verdict() {
            Verdict::Unstable => assert!(resolved && grows, "{mode:?}"),
            Verdict::Undecided => assert!(!resolved, "{mode:?}"),
            verdict => assert!(verdict == Verdict::Stable && !grows, "{mode:?}"),
        }
        undecided += usize::from(mode.verdict() == Verdict::Undecided);
    }
    assert!(undecided > 100, "{undecided}");
}

#[test]
fn a_drift_is_zero_and_its_friction_decides_what_grows() {
    // m λ² + c λ = 0: a mass on a dashpot that nothing holds, and one that pushes.
    for (mass, damping) in [(1.0, 0.3), (2.0, 5.0), (0.1, -0.4), (3.0, -2.0), (1e-4, 1e-3)] {
        let of = |v: f64| Mat::from_fn(1, 1, |_, _| v);
        let found = modes(&system(&of(mass), &of(damping), &of(0.0)), [0.0, 20.0]).modes;
        let values: Vec<f64> = found.iter().map(|mode| mode.eigenvalue.re).collect();
        let rate = -damping / mass;
        assert!(values.len() == 2 && values.contains(&0.0), "{values:?}");
        let off = least(values.iter().map(|v| (v - rate).abs()));
        assert!(within(off, 1e-13 * rate.abs(), RoundOff), "{values:?} {rate}");
        let grows = found.iter().filter(|mode| mode.unstable()).count();
        assert_eq!(grows, usize::from(rate > 0.0), "{found:?}");
    }
}

#[test]
fn critical_damping_is_stable_within_its_stated_error() {
    // λ² + 2ω(1 + δ) λ + ω² = 0, alone and beside equal ones: λ = −ω twice for δ = 0.
    for (k, delta) in [0.0, 0.0, 1e-16, -1e-15, 1e-12, 1e-7, -1e-9].into_iter().enumerate() {
        for (n, omega) in [(1, 1.0), (2, 3.7e3), (3, 0.02 + k as f64)] {
            let of = |v: f64| Mat::from_fn(n, n, |i, j| if i == j { v } else { 0.0 });
            let damping = of(2.0 * omega * (1.0 + delta));
            let found = modes(&system(&of(1.0), &damping, &of(omega * omega)), [0.0, 2.0 * omega / TAU]);
            assert!(!found.modes.is_empty());
            for mode in found.modes {
                // The radius in which the two roots are: √(2δ).
                let radius = omega * (2.0 * f64::abs(delta)).sqrt();
                let off = (mode.eigenvalue + c64::new(omega, 0.0)).norm();
                assert!(
                    within(off, 1.5 * radius + 10.0 * mode.uncertainty, Stated),
                    "{n} {omega} {delta:e}: {mode:?}"
                );
                assert!(
                    within(mode.uncertainty, 1e-4 * omega, Stated) && mode.verdict() == Verdict::Stable,
                    "{mode:?}"
                );
            }
        }
    }
}

#[test]
fn at_the_onset_of_divergence_growth_is_undecided_and_beyond_it_unstable() {
    // A mass held by 1 and pushed away by 1 + δ: λ = ±√δ.
    for (seed, delta) in [0.0, 0.0, 1e-17, -1e-3, 1e-3, 1e-6, 4e-8, -1e-2].into_iter().enumerate() {
        let n = 1 + seed % 3;
        let scale = 10f64.powi(3 * (seed as i32 % 4) - 3);
        let stiffness = Mat::from_fn(n, n, |i, j| if i == j { scale * (1 + 3 * i) as f64 } else { 0.0 });
        let mut system = system(&Mat::identity(n, n), &Mat::zeros(n, n), &stiffness);
        system.coupling = Some(Coupling {
            directions: vec![SparseVector::from_entries([(0, 1.0)])],
            stiffness: Mat::from_fn(1, 1, |_, _| -scale * (1.0 + delta)),
            damping: Mat::zeros(1, 1),
            skew: None,
        });
        let found = modes(&system, [0.0, scale.sqrt()]).modes;
        let count = |verdict| found.iter().filter(|mode| mode.verdict() == verdict).count();
        let expected = match delta {
            d if d > 1e-10 => [1, 0],
            d if d < -1e-10 => [0, 0],
            _ => [0, 2],
        };
        assert_eq!([count(Verdict::Unstable), count(Verdict::Undecided)], expected, "{delta:e}: {found:?}");
        if delta > 1e-10 {
            let exact = (scale * delta).sqrt();
            let fastest = found.iter().map(|mode| mode.growth_rate()).fold(0.0, f64::max);
            assert!(within((fastest / exact - 1.0).abs(), 1e-15 / delta, RoundOff), "{fastest:e} {exact:e}");
        }
    }
}

/// Systems of small integers, whose real and oscillating eigenvalues have the same size, and lie where a shift is likely to be: all
/// eigenvalues are there, as those of the companion matrix.
#[test]
fn neat_numbers_hit_no_shift() {
    let mut random = Random::seeded(71);
    for trial in 0..120 {
        let n = 1 + trial % 4;
        let unit = 10f64.powi(2 * (trial as i32 % 4));
        let mut whole = |most: usize| random.below(2 * most + 1) as f64 - most as f64;
        let mut symmetric = |most: usize, diagonal: bool| {
            let all: Vec<f64> = (0..n * n).map(|_| whole(most)).collect();
            Mat::from_fn(n, n, |i, j| match (i == j, diagonal) {
                (false, true) => 0.0,
                _ => all[i.min(j) * n + i.max(j)],
            })
        };
        let stiffness = match trial % 3 {
            // ± of one size.
            0 => Mat::from_fn(n, n, |i, j| if i == j { 3.0 - 6.0 * (i % 2) as f64 } else { 0.0 }),
            _ => symmetric(2, trial % 3 == 1),
        };
        let damping = if trial % 2 == 0 { Mat::zeros(n, n) } else { symmetric(2, true) };
        let mass = Mat::from_fn(n, n, |i, j| if i == j { 1.0 + (trial / 3 % 2) as f64 } else { 0.0 });
        let (damping, stiffness) = (damping * faer::Scale(unit.sqrt()), stiffness * faer::Scale(unit));
        let system = system(&mass, &damping, &stiffness);
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        // A shift on an eigenvalue, too.
        let top = [4.0, 1.8, 3f64.sqrt() * 1.0001][trial % 3] * unit.sqrt() / TAU;
        let real = dense_modes(&system, n);
        let found = complex_modes(&system, &steady, &real, [0.0, top], &()).unwrap();
        let spectrum = super::tests::dense_spectrum(&system, &steady);
        // Those that are zero or all but so, and defective ones, are known to the root of rounding.
        let size = unit.sqrt();
        let expected = spectrum.iter().filter(|z| z.im > -1e-5 * size && z.norm() > 1e-3 * size);
        for z in expected.filter(|z| z.norm() < 0.999 * TAU * top) {
            let error = found.modes.iter().map(|m| (m.eigenvalue - z).norm()).fold(f64::INFINITY, f64::min);
            assert!(within(error, 1e-4 * size, RoundOff), "{trial}: {z} is missing by {error:e}");
        }
        for mode in &found.modes {
            assert!(mode.accurate(), "{trial}: {mode:?}");
        }
    }
}

/// Critically damped and critically driven oscillators, coupled by a random rotation, beside others: of a double real eigenvalue, which
/// rounding parts into a pair off the real axis, at least one is there, whatever side of the axis the last step leaves it on.
#[test]
fn a_double_real_eigenvalue_is_there_whatever_side_of_the_axis_rounding_leaves_it_on() {
    let mut random = Random::seeded(72);
    for trial in 0..1000 {
        let n = 2 + trial % 3;
        let rate = 10f64.powf(random.between(-1.0, 4.0));
        let mut rotation = Mat::<f64>::identity(n, n);
        for k in 1..n {
            let (sin, cos) = random.between(-3.0, 3.0).sin_cos();
            let turn = Mat::from_fn(n, n, |i, j| match (i == 0 || i == k, j == 0 || j == k) {
                (true, true) if i == j => cos,
                (true, true) => {
                    if i < j {
                        -sin
                    } else {
                        sin
                    }
                }
                _ => f64::from(i == j),
            });
            rotation = rotation * turn;
        }
        // (λ − rate)² = 0 of the first, λ² + c λ + k = 0 of the others.
        let own: Vec<[f64; 2]> = (0..n)
            .map(|i| match i {
                0 => [-2.0 * rate, rate * rate],
                _ => [random.between(-1.0, 1.0) * rate, random.between(-1.0, 2.0) * rate * rate],
            })
            .collect();
        let of = |k: usize| {
            let diagonal = Mat::from_fn(n, n, |i, j| if i == j { own[i][k] } else { 0.0 });
            let turned = &rotation * diagonal * rotation.transpose();
            Mat::from_fn(n, n, |i, j| 0.5 * (turned[(i, j)] + turned[(j, i)]))
        };
        let found = modes(&system(&Mat::identity(n, n), &of(0), &of(1)), [0.0, 2.0 * rate / TAU]);
        let off =
            found.modes.iter().map(|mode| (mode.eigenvalue - rate).norm()).fold(f64::INFINITY, f64::min);
        // √(10 ε) of the sizes in it.
        assert!(within(off, 1e-5 * rate, RoundOff), "{trial}: {off:e} {own:?} {:?}", found.modes);
    }
}
