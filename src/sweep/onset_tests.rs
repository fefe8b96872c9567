//! Onsets against the roots of growth rates in closed form.

use super::*;
use crate::bounds::{Origin::*, within};
use crate::linalg::random::Random;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Eigenvalues in closed form.
struct Closed<F> {
    eigenvalues: F,
    limit: usize,
    /// Whether the last one has a shape of its own and the others share one; otherwise shapes cannot be compared.
    shapes: bool,
    solved: AtomicUsize,
}

impl<F: Fn(f64) -> Vec<c64> + Sync> Closed<F> {
    fn new(eigenvalues: F) -> Self {
        Closed { eigenvalues, limit: 4000, shapes: false, solved: AtomicUsize::new(0) }
    }
}

impl<F: Fn(f64) -> Vec<c64> + Sync> SweepProblem for Closed<F> {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        self.solved.fetch_add(1, Ordering::Relaxed);
        let eigenvalues = (self.eigenvalues)(at[0]);
        let n = eigenvalues.len();
        let shape = |i: usize, j: usize| c64::new(f64::from((i == 1) == (j + 1 == n)), 0.0);
        Ok(Modes { vectors: Mat::from_fn(if self.shapes { 2 } else { 0 }, n, shape), eigenvalues })
    }

    fn solutions_between(&self, _: usize) -> usize {
        self.limit
    }
}

fn axis(ends: [f64; 2], points: usize) -> Axis {
    Axis { from: ends[0], to: ends[1], points, log: false }
}

/// Growth rates that pass zero with slopes from 1e-8 to 0.1 of ω, or that are zero up to the onset, zero itself among the onsets.
#[test]
fn an_onset_is_a_root_of_the_growth_rate() {
    let mut random = Random::seeded(5);
    for trial in 0..300 {
        let onset = if trial % 4 == 0 { 0.0 } else { random.between(-0.6, 0.6) };
        let (slope, bend) = (10f64.powf(random.between(-7.5, -1.0)), random.between(-0.3, 0.3));
        let (falls, undamped) = (trial % 2 == 1, trial % 3 == 0);
        let omega = 10f64.powf(random.between(0.0, 4.0));
        let problem = Closed::new(|p: f64| {
            let x = (p - onset) * if falls { -1.0 } else { 1.0 };
            let growth = slope * x * (1.0 + bend * x);
            let growth = if undamped { growth.max(0.0) } else { growth };
            vec![c64::new(omega * growth, omega), c64::new(-0.01 * omega, 3.0 * omega)]
        });
        let ends = if trial % 5 == 0 { [1.0, -1.0] } else { [-1.0, 1.0] };
        let found = sweep(&problem, &axis(ends, 4 + trial % 7), 1e-10, &()).unwrap();
        let [critical] = found.critical[..] else { panic!("{trial}: {:?}", found.critical) };
        // A growth rate below 1e-12 |λ| is rounding: the root is known as far as that is from it.
        let aim = 1e-9 + 1e-12 / slope;
        let error = (critical.value - onset).abs();
        assert!(within(error, aim, Tolerance), "{trial}: {error:e} at slope {slope:e}, {critical:?}");
    }
}

/// λ² = k (p − p₀): a mode slows down, leaves the band where that does not begin at zero, and diverges.
#[test]
fn divergence_is_a_critical_value_whatever_the_band() {
    let mut random = Random::seeded(6);
    for trial in 0..60 {
        let (onset, k) = (random.between(0.2, 0.8), 10f64.powf(random.between(2.0, 6.0)));
        let lowest = if trial % 2 == 0 { 0.0 } else { 0.3 * k.sqrt() };
        let mut problem = Closed::new(|p: f64| {
            let square = k * (p - onset);
            let other = c64::new(-0.01 * k.sqrt(), 5.0 * k.sqrt());
            let root = square.abs().sqrt();
            let mut all = match square > 0.0 {
                true if lowest == 0.0 => vec![c64::new(-root, 0.0), c64::new(root, 0.0)],
                true => vec![c64::new(root, 0.0)],
                false => vec![c64::new(0.0, root)],
            };
            all.retain(|z| z.im == 0.0 || z.im >= lowest);
            all.push(other);
            all
        });
        problem.shapes = true;
        let ends = if trial % 3 == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
        let found = sweep(&problem, &axis(ends, 3 + trial % 9), 1e-9, &()).unwrap();
        let [critical] = found.critical[..] else { panic!("{trial}: {:?}", found.critical) };
        assert_eq!(critical.kind, CriticalKind::Divergence, "{trial}");
        assert_eq!(critical.rises, ends[1] > ends[0], "{trial}");
        assert!(within((critical.value - onset).abs(), 1e-8, Tolerance), "{trial}: {onset} {critical:?}");
    }
}

/// Many crossings in one step: the search ends at its limit, with brackets that hold the onsets.
#[test]
fn a_search_with_a_limit_gives_what_it_has() {
    for (modes, limit) in [(1, 12), (6, 24), (12, 60), (12, 5)] {
        let onset = |j: usize| (j as f64 + 0.4) / modes as f64;
        let mut problem = Closed::new(|p: f64| {
            (0..modes)
                .map(|j| c64::new(p - onset(j) + 0.3 * (p - onset(j)).powi(3), 10.0 * (j + 1) as f64))
                .collect()
        });
        problem.limit = limit;
        let found = sweep(&problem, &axis([0.0, 1.0], 2), 1e-14, &()).unwrap();
        assert_eq!(found.critical.len(), modes);
        for critical in &found.critical {
            let error = (critical.value - onset(critical.branch)).abs();
            assert!(within(error, 1.01 * critical.uncertainty + 1e-15, Stated), "{critical:?}");
        }
        let solved = problem.solved.load(Ordering::Relaxed);
        assert!(solved <= 2 + 3 * limit, "{solved}");
        // Shapes that are not known leave no link in doubt.
        assert_eq!(found.doubtful_steps, 0);
        assert!(modes == 1 || found.critical.iter().any(|c| c.wide), "{:?}", found.critical);
    }
}

/// Two modes whose shapes turn in their plane: one step cannot show which is which, and none is left to halve it by.
struct Turning(usize);

impl SweepProblem for Turning {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let (sin, cos) = (0.8 * at[0]).sin_cos();
        let vectors = Mat::from_fn(2, 2, |i, j| c64::new([[cos, -sin], [sin, cos]][i][j], 0.0));
        Ok(Modes { eigenvalues: vec![c64::new(0.0, 1.0), c64::new(0.0, 1.01)], vectors })
    }

    fn solutions_between(&self, _: usize) -> usize {
        self.0
    }
}

#[test]
fn steps_that_the_limit_leaves_in_doubt_are_counted() {
    let doubtful = |limit| sweep(&Turning(limit), &axis([0.0, 1.0], 2), 1e-9, &()).unwrap().doubtful_steps;
    assert_eq!([doubtful(0), doubtful(1000)], [1, 0]);
}
