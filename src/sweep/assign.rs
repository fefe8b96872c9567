//! Which mode here is which mode there: the assignment with the greatest MAC in all.

use super::Modes;
use crate::linalg::assignment::least_cost;
use crate::linalg::c64;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Below this MAC a step is refined.
const SURE: f64 = 0.9;
/// Another mode as like as this, and nearly as like as the assigned one, makes a step doubtful.
const RIVAL: f64 = 0.5;
/// Modes that change places and are as like as this to each other's may turn away from each other between the samples.
/// Two modes with a gap g at their nearest that are d apart at the samples reach it from g ≈ 0.005 d on; a narrower gap
/// is passed within a hundredth of the step, and counts as a crossing.
const EXCHANGE: f64 = 1e-4;
/// The cost of a pair that is none.
const NONE: f64 = 4.0;

/// The modes of one place as those of another.
#[derive(Debug, Clone)]
pub(super) struct Link {
    /// For each mode here, its mode there and their MAC.
    pub(super) to: Vec<Option<(usize, f64)>>,
    /// Whether another assignment would be about as good.
    pub(super) doubtful: bool,
    /// Whether modes that change places may have turned away from each other in between.
    pub(super) exchange: bool,
    /// The least MAC of the links that are in doubt, zero for a mode that is lost; 1 without doubt.
    pub(super) certainty: f64,
}

/// How much two modes differ: 1 − MAC of their shapes, and half of their distance in units of 2 % of |λ|, at most ½.
/// Shapes decide where modes cross; where two merge their shapes become one, and the distance decides.
pub(super) fn difference(a: c64, b: c64, mac: f64) -> f64 {
    let size = a.norm().max(b.norm()).max(f64::MIN_POSITIVE);
    let distance = (a - b).norm() / size;
    if mac < 0.2 || distance > 0.3 {
        return NONE;
    }
    1.0 - mac + 0.5 * (distance / 0.02).min(1.0)
}

/// The MAC of every mode of `a` (a row each) with every mode of `b`; 1 when there are no shapes to compare.
fn mac_table(a: &Modes, b: &Modes) -> Mat<f64> {
    let (rows, columns) = (a.eigenvalues.len(), b.eigenvalues.len());
    if a.vectors.nrows() != b.vectors.nrows() || a.vectors.nrows() == 0 {
        return Mat::from_fn(rows, columns, |_, _| 1.0);
    }
    let mut products = Mat::<c64>::zeros(rows, columns);
    let one = c64::new(1.0, 0.0);
    matmul(products.as_mut(), Accum::Replace, a.vectors.adjoint(), &b.vectors, one, Par::Seq);
    let squares = |modes: &Modes| -> Vec<f64> {
        (0..modes.eigenvalues.len()).map(|k| modes.vectors.col(k).squared_norm_l2()).collect()
    };
    let (left, right) = (squares(a), squares(b));
    Mat::from_fn(rows, columns, |i, j| {
        let size = left[i] * right[j];
        if size > 0.0 { (products[(i, j)].norm_sqr() / size).min(1.0) } else { 0.0 }
    })
}

/// Assigns the modes of `a` to those of `b`.
pub(super) fn assign(a: &Modes, b: &Modes) -> Link {
    let (rows, columns) = (a.eigenvalues.len(), b.eigenvalues.len());
    let comparable = a.vectors.nrows() == b.vectors.nrows() && a.vectors.nrows() > 0;
    let table = mac_table(a, b);
    let of = |i: usize, j: usize| difference(a.eigenvalues[i], b.eigenvalues[j], table[(i, j)]);
    let cost: Vec<Vec<f64>> = (0..rows).map(|i| (0..columns).map(|j| of(i, j)).collect()).collect();
    let chosen = least_cost(&cost, columns);
    let mut to = vec![None; rows];
    let mut taken = vec![false; columns];
    for (i, j) in chosen.into_iter().filter(|(i, j)| cost[*i][*j] < NONE) {
        to[i] = Some((j, table[(i, j)]));
        taken[j] = true;
    }
    let lost = |i: usize| {
        let near = |j: usize| (a.eigenvalues[i] - b.eigenvalues[j]).norm() < 0.05 * a.eigenvalues[i].norm();
        (0..columns).any(|j| !taken[j] && near(j))
    };
    let unsure = |(i, link): (usize, &Option<(usize, f64)>)| match link {
        None => lost(i),
        Some((j, mac)) => {
            let rival = |k: usize| {
                let other = table[(i, k)];
                k != *j && cost[i][k] < NONE && other > RIVAL && other > mac - 0.2
            };
            *mac < SURE || (comparable && (0..columns).any(rival))
        }
    };
    // Above or below, where it is the frequency in which two modes differ; inside flutter it is the growth rate.
    let order = |x: c64, y: c64| Some((x - y).im).filter(|d| d.abs() > (x - y).re.abs()).map(f64::signum);
    let exchange = |i: usize, k: usize| match (to[i], to[k]) {
        (Some((j, _)), Some((l, _))) => {
            let here_order = order(a.eigenvalues[i], a.eigenvalues[k]);
            let there_order = order(b.eigenvalues[j], b.eigenvalues[l]);
            let swapped = here_order.zip(there_order).is_some_and(|(p, q)| p != q);
            swapped && comparable && table[(i, l)] > EXCHANGE
        }
        _ => false,
    };
    let exchange = (0..rows).any(|i| (0..i).any(|k| exchange(i, k)));
    let doubts = to.iter().enumerate().filter(|link| unsure(*link));
    let certainty = doubts.map(|(_, link)| link.map_or(0.0, |(_, mac)| mac)).fold(1.0, f64::min);
    let doubtful = exchange || to.iter().enumerate().any(unsure);
    Link { to, doubtful, exchange, certainty }
}
