//! Who goes with whom: the assignment of least total cost.

/// The pairs of rows and columns with the least total cost, min(rows, columns) of them: the Hungarian method with
/// potentials (Kuhn, Naval Research Logistics Quarterly 2 (1955) 83; shortest augmenting paths). `cost` has a row of
/// `columns` finite numbers for each row.
pub fn least_cost(cost: &[Vec<f64>], columns: usize) -> Vec<(usize, usize)> {
    let rows = cost.len();
    if rows > columns {
        let turned: Vec<Vec<f64>> = (0..columns).map(|j| (0..rows).map(|i| cost[i][j]).collect()).collect();
        return least_cost(&turned, rows).into_iter().map(|(j, i)| (i, j)).collect();
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
    use crate::random::Random;
    use stridor_base::bounds::{Origin::*, within};

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
        let mut random = Random::new();
        for (rows, columns) in [(1, 1), (4, 4), (6, 6), (3, 6), (0, 3)] {
            let cost: Vec<Vec<f64>> =
                (0..rows).map(|_| (0..columns).map(|_| random.next()).collect()).collect();
            let pairs = least_cost(&cost, columns);
            assert_eq!(pairs.len(), rows);
            let total: f64 = pairs.iter().map(|(i, j)| cost[*i][*j]).sum();
            assert!(within((total - best(&cost, 0, &mut vec![false; columns])).abs(), 1e-12, RoundOff));
            let turned: Vec<Vec<f64>> =
                (0..columns).map(|j| (0..rows).map(|i| cost[i][j]).collect()).collect();
            let back: f64 = least_cost(&turned, rows).iter().map(|(j, i)| cost[*i][*j]).sum();
            assert!(within((total - back).abs(), 1e-12, RoundOff));
        }
    }
}
