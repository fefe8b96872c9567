//! Critical values at which the growth rate, or the square by which two modes merge, has a root of higher order.

use super::*;
use crate::bounds::{Origin::*, within};
use crate::linalg::dense::product;
use crate::linalg::random::Random;
use crate::linalg::unsymmetric::eigenpairs;

/// Two modes of frequency ω that a follower force couples, beside two of one frequency, M = 1:
///
/// K = ω² [[1 − d, d f], [−d f, 1 + d]] has λ² = −ω² (1 ± d √(1 − f²)): with the damping C = 2 ζ ω, σ = 0 where
/// f² = 1 + (2 ζ/d)². The force is f = f_c (1 + a (p − p₀)ᵏ), so that p₀ is the critical value.
struct Pair {
    omega: f64,
    d: f64,
    ratio: f64,
    /// k, a and p₀.
    root: (i32, f64, f64),
    /// ω, split and slope of the growth rate over ω of the other two, which grow for p > 0.1.
    others: Option<(f64, f64, f64)>,
    turned: Mat<f64>,
}

/// The critical value of the others.
const OF_OTHERS: f64 = 0.1;

impl Pair {
    fn new(random: &mut Random, order: i32, damped: bool, others: bool) -> Self {
        let omega = 10f64.powf(random.between(0.0, 4.0));
        let d = random.between(0.02, 0.2);
        let slope = 10f64.powf(random.between(-4.0, -2.0));
        let split = [0.0, 1e-13, 1e-8, 1e-6][random.below(4)];
        let mut square = Mat::from_fn(4, 4, |_, _| random.next());
        square = &square + square.transpose();
        Pair {
            omega,
            d,
            ratio: if damped { d * random.between(0.05, 0.3) } else { 0.0 },
            root: (order, random.between(0.3, 1.0), random.between(0.3, 0.7)),
            others: others.then(|| (omega * random.between(1.4, 3.0), split, slope)),
            turned: crate::linalg::dense::symmetric_eigen(square.as_ref()).unwrap().1,
        }
    }

    fn turned(&self, a: &Mat<f64>) -> Mat<f64> {
        product(self.turned.as_ref(), product(a.as_ref(), self.turned.transpose()).as_ref())
    }
}

impl SweepProblem for Pair {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let (order, a, p0) = self.root;
        let critical = (1.0 + (2.0 * self.ratio / self.d).powi(2)).sqrt();
        let f = critical * (1.0 + a * (at[0] - p0).powi(order));
        let (w, d) = (self.omega, self.d);
        let (wo, split, slope) = self.others.unwrap_or((3.0 * w, 0.2, 0.0));
        let k = [[1.0 - d, d * f], [-d * f, 1.0 + d]];
        let k = Mat::from_fn(4, 4, |i, j| match (i, j) {
            (0 | 1, 0 | 1) => w * w * k[i][j],
            (2, 2) => wo * wo,
            (3, 3) => (wo * (1.0 + split)).powi(2),
            _ => 0.0,
        });
        let growth = slope * (at[0] - OF_OTHERS) * wo;
        let c = Mat::from_fn(4, 4, |i, j| match i {
            _ if i != j => 0.0,
            0 | 1 => 2.0 * self.ratio * w,
            _ => -2.0 * growth,
        });
        // The state is (ω u, du/dt).
        let (k, c) = (self.turned(&k), self.turned(&c));
        let state = Mat::from_fn(8, 8, |i, j| match (i < 4, j < 4) {
            (true, true) => 0.0,
            (true, false) => w * f64::from(i + 4 == j),
            (false, true) => -k[(i - 4, j)] / w,
            (false, false) => -c[(i - 4, j - 4)],
        });
        let (values, vectors) = eigenpairs(state.as_ref())?;
        let upper: Vec<usize> = (0..8).filter(|k| values[*k].im > 0.0).collect();
        Ok(Modes {
            eigenvalues: upper.iter().map(|k| values[*k]).collect(),
            vectors: Mat::from_fn(4, upper.len(), |i, j| vectors[(i, upper[j])]),
        })
    }
}

fn axis(falls: bool, points: usize) -> Axis {
    let ends = if falls { [1.0, 0.0] } else { [0.0, 1.0] };
    Axis { from: ends[0], to: ends[1], points, log: false }
}

/// Odd powers: one critical value, as near as its uncertainty says; the doublet beside it has its own.
#[test]
fn roots_of_any_order_lie_within_their_uncertainty() {
    let mut random = Random::seeded(11);
    for trial in 0..48 {
        let order = 1 + 2 * (trial % 3);
        let (damped, others) = (trial % 2 == 1, trial / 3 % 2 == 1);
        let pair = Pair::new(&mut random, order, damped, others);
        let mut axis = axis(trial % 5 == 0, 4 + random.below(12));
        if trial % 7 == 0 {
            // A sample at the critical value itself.
            axis = Axis { from: pair.root.2 - 0.25, to: pair.root.2 + 0.25, points: 5, log: false };
        }
        let found = sweep(&pair, &axis, 1e-9, &()).unwrap();
        let (own, beside): (Vec<&Critical>, Vec<&Critical>) =
            found.critical.iter().partition(|c| (c.eigenvalue.norm() / pair.omega - 1.0).abs() < 0.3);
        let [own] = own[..] else { panic!("{trial}: {:?}", found.critical) };
        let error = (own.value - pair.root.2).abs();
        assert!(within(error, own.uncertainty, Stated), "{trial}: order {order}, {error:e}, {own:?}");
        let most = 3.0 * 1e-9f64.powf(1.0 / f64::from(order));
        assert!(within(own.uncertainty, most, Stated), "{trial}: order {order}, {error:e}, {own:?}");
        let grows = found.branches.iter().flat_map(|b| b.growing().zip(&found.values[b.first..]));
        let first = grows.filter(|(grows, _)| *grows && !others).map(|(_, p)| *p).fold(1.0, f64::min);
        assert!(first >= pair.root.2 - own.uncertainty, "{trial}: {first}");
        let inside = others && axis.from.min(axis.to) < OF_OTHERS;
        assert_eq!(beside.len(), if inside { 2 } else { 0 }, "{trial}: {:?}", found.critical);
        for c in beside {
            let error = (c.value - OF_OTHERS).abs();
            assert!(
                within(error, 1e-7, Tolerance) && within(error, c.uncertainty, Stated),
                "{trial}: {error:e}, {c:?}, {:?}",
                pair.others
            );
        }
    }
}

/// Even powers: the force comes to its critical value and turns back, from below, where nothing ever grows, or from above.
#[test]
fn a_touched_boundary_is_not_crossed() {
    let mut random = Random::seeded(12);
    for trial in 0..48 {
        let order = 2 + 2 * (trial % 2);
        let mut pair = Pair::new(&mut random, order, trial / 2 % 2 == 1, false);
        let below = trial % 3 > 0;
        pair.root.1 *= if below { -1.0 } else { 1.0 };
        let at_sample = trial % 4 < 2;
        let middle = if at_sample { pair.root.2 } else { 0.5 };
        let axis = Axis { from: middle - 0.3, to: middle + 0.3, points: 3 + 2 * random.below(5), log: false };
        let found = sweep(&pair, &axis, 1e-9, &()).unwrap();
        if below {
            assert!(found.critical.is_empty(), "{trial}: {:?}", found.critical);
            assert!(found.branches.iter().all(|b| !b.growing().any(|grows| grows)), "{trial}");
        }
        for c in &found.critical {
            assert!(within((c.value - pair.root.2).abs(), c.uncertainty, Stated), "{trial}: {c:?}");
        }
    }
}
