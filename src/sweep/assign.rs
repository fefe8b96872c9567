//! Which mode here is which mode there: the assignment with the greatest likeness in all.

use super::Modes;
use crate::linalg::c64;
use crate::linalg::dense::mac;

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
}

/// How much two modes differ: 1 − MAC of their shapes, and half of their distance in units of 2 % of |λ|, at most ½.
/// Shapes decide where modes cross; where two merge their shapes become one, and the distance decides.
pub(super) fn difference(a: (c64, &[c64]), b: (c64, &[c64])) -> f64 {
    let likeness = likeness(a.1, b.1);
    let size = a.0.norm().max(b.0.norm()).max(f64::MIN_POSITIVE);
    let distance = (a.0 - b.0).norm() / size;
    if likeness < 0.2 || distance > 0.3 {
        return NONE;
    }
    1.0 - likeness + 0.5 * (distance / 0.02).min(1.0)
}

/// MAC; 1 when there are no shapes to compare.
fn likeness(a: &[c64], b: &[c64]) -> f64 {
    if a.is_empty() { 1.0 } else { mac(a, b) }
}

/// Assigns the modes of `a` to those of `b`.
pub(super) fn assign(a: &Modes, b: &Modes) -> Link {
    let (rows, columns) = (a.eigenvalues.len(), b.eigenvalues.len());
    let comparable = a.vectors.nrows() == b.vectors.nrows();
    let shape = |modes: &'_ Modes, k: usize| if comparable { modes.vector(k).to_vec() } else { Vec::new() };
    let here: Vec<Vec<c64>> = (0..rows).map(|i| shape(a, i)).collect();
    let there: Vec<Vec<c64>> = (0..columns).map(|j| shape(b, j)).collect();
    let cost: Vec<Vec<f64>> = (0..rows)
        .map(|i| {
            let of = |j: usize| difference((a.eigenvalues[i], &here[i]), (b.eigenvalues[j], &there[j]));
            (0..columns).map(of).collect()
        })
        .collect();
    let chosen = least_cost(&cost, rows, columns);
    let mut to = vec![None; rows];
    let mut taken = vec![false; columns];
    for (i, j) in chosen.into_iter().filter(|(i, j)| cost[*i][*j] < NONE) {
        to[i] = Some((j, likeness(&here[i], &there[j])));
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
                let other = likeness(&here[i], &there[k]);
                k != *j && cost[i][k] < NONE && other > RIVAL && other > mac - 0.2
            };
            *mac < SURE || (!here[i].is_empty() && (0..columns).any(rival))
        }
    };
    // Above or below, where it is the frequency in which two modes differ; inside flutter it is the growth rate.
    let order = |x: c64, y: c64| Some((x - y).im).filter(|d| d.abs() > (x - y).re.abs()).map(f64::signum);
    let exchange = |i: usize, k: usize| match (to[i], to[k]) {
        (Some((j, _)), Some((l, _))) => {
            let here_order = order(a.eigenvalues[i], a.eigenvalues[k]);
            let there_order = order(b.eigenvalues[j], b.eigenvalues[l]);
            let swapped = here_order.zip(there_order).is_some_and(|(p, q)| p != q);
            swapped && comparable && likeness(&here[i], &there[l]) > EXCHANGE
        }
        _ => false,
    };
    let turned_away = (0..rows).any(|i| (0..i).any(|k| exchange(i, k)));
    let doubtful = turned_away || to.iter().enumerate().any(unsure);
    Link { to, doubtful }
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
