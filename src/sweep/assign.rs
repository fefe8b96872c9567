//! Which mode here is which mode there: the assignment with the greatest likeness in all.

use super::Modes;
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
pub(super) fn difference(a: c64, b: c64, likeness: f64) -> f64 {
    let size = a.norm().max(b.norm()).max(f64::MIN_POSITIVE);
    let distance = (a - b).norm() / size;
    if likeness < 0.2 || distance > 0.3 {
        return NONE;
    }
    1.0 - likeness + 0.5 * (distance / 0.02).min(1.0)
}

/// The MAC of every mode of `a` (a row each) with every mode of `b`; 1 when there are no shapes to compare.
fn likenesses(a: &Modes, b: &Modes) -> Mat<f64> {
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
    let likeness = likenesses(a, b);
    let of = |i: usize, j: usize| difference(a.eigenvalues[i], b.eigenvalues[j], likeness[(i, j)]);
    let cost: Vec<Vec<f64>> = (0..rows).map(|i| (0..columns).map(|j| of(i, j)).collect()).collect();
    let chosen = least_cost(&cost, rows, columns);
    let mut to = vec![None; rows];
    let mut taken = vec![false; columns];
    for (i, j) in chosen.into_iter().filter(|(i, j)| cost[*i][*j] < NONE) {
        to[i] = Some((j, likeness[(i, j)]));
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
                let other = likeness[(i, k)];
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
            swapped && comparable && likeness[(i, l)] > EXCHANGE
        }
        _ => false,
    };
    let exchange = (0..rows).any(|i| (0..i).any(|k| exchange(i, k)));
    let doubts = to.iter().enumerate().filter(|link| unsure(*link));
    let certainty = doubts.map(|(_, link)| link.map_or(0.0, |(_, mac)| mac)).fold(1.0, f64::min);
    let doubtful = exchange || to.iter().enumerate().any(unsure);
    Link { to, doubtful, exchange, certainty }
}

/// The pairs of rows and columns with the least total cost, min(rows, columns) of them: the Hungarian method with
/// potentials (Kuhn, Naval Research Logistics Quarterly 2 (1955) 83; shortest augmenting paths).
fn least_cost(cost: &[Vec<f64>], rows: usize, columns: usize) -> Vec<(usize, usize)> {
    if rows > columns {
        let turned: Vec<Vec<f64>> = (0..columns).map(|j| (0..rows).map(|i| cost[i][j]).collect()).collect();
        return least_cost(&turned, columns, rows).into_iter().map(|(j, i)| (i, j)).collect();
    }
    let (mut u, mut v) = (vec![0.0; rows + 1], vec![0.0; columns + 1]);
    // Row matched to each column; row and column 0 stand for none.
    let mut owner = vec![0; columns + 1];
    for row in 1..=rows {
        owner[0] = row;
        let (mut least, mut seen) = (vec![f64::INFINITY; columns + 1], vec![false; columns + 1]);
        let mut from = vec![0; columns + 1];
        let mut at = 0;
        while owner[at] != 0 {
            seen[at] = true;
            let (i, mut step, mut next) = (owner[at], f64::INFINITY, 0);
            for j in (1..=columns).filter(|j| !seen[*j]) {
                let reduced = cost[i - 1][j - 1] - u[i] - v[j];
                if reduced < least[j] {
                    (least[j], from[j]) = (reduced, at);
                }
                if least[j] < step {
                    (step, next) = (least[j], j);
                }
            }
            for j in 0..=columns {
                if seen[j] {
                    u[owner[j]] += step;
                    v[j] -= step;
                } else {
                    least[j] -= step;
                }
            }
            at = next;
        }
        while at != 0 {
            owner[at] = owner[from[at]];
            at = from[at];
        }
    }
    (1..=columns).filter(|j| owner[*j] != 0).map(|j| (owner[j] - 1, j - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equilibrium::samples::Random;

    #[test]
    fn the_least_cost_is_that_of_the_best_permutation() {
        fn best(cost: &[Vec<f64>], row: usize, used: &mut Vec<bool>) -> f64 {
            if row == cost.len() {
                return 0.0;
            }
            let mut least = f64::INFINITY;
            for j in 0..used.len() {
                if !used[j] {
                    used[j] = true;
                    least = least.min(cost[row][j] + best(cost, row + 1, used));
                    used[j] = false;
                }
            }
            least
        }
        let mut random = Random(9);
        for (rows, columns) in [(1, 1), (4, 4), (6, 6), (3, 6), (0, 3)] {
            let cost: Vec<Vec<f64>> =
                (0..rows).map(|_| (0..columns).map(|_| random.next()).collect()).collect();
            let pairs = least_cost(&cost, rows, columns);
            assert_eq!(pairs.len(), rows);
            let total: f64 = pairs.iter().map(|(i, j)| cost[*i][*j]).sum();
            assert!((total - best(&cost, 0, &mut vec![false; columns])).abs() < 1e-12);
            let turned: Vec<Vec<f64>> =
                (0..columns).map(|j| (0..rows).map(|i| cost[i][j]).collect()).collect();
            let back: f64 = least_cost(&turned, columns, rows).iter().map(|(j, i)| cost[*i][*j]).sum();
            assert!((total - back).abs() < 1e-12);
        }
    }
}
