//! The least value of a quadratic function in a box.

use nalgebra::{DMatrix, DVector};

/// Share of the largest diagonal entry that is added to the diagonal, so that directions without curvature stay where they
/// are.
const RIDGE: f64 = 1e-12;

/// Where a variable stands.
#[derive(Clone, Copy, PartialEq)]
enum BoundState {
    Free,
    Lower,
    Upper,
}

/// x with the least ½ xᵀHx + gᵀx among lower ≤ x ≤ upper, from 0, which the box holds; H is symmetric and not indefinite.
///
/// The active-set method for convex quadratic programmes (Nocedal and Wright, Numerical Optimization, 2nd ed., alg. 16.3):
/// the free variables go to their least value or as far as the first bound; a bound that holds its variable back is
/// released.
pub(super) fn least_in_box(h: &DMatrix<f64>, g: &DVector<f64>, lower: &[f64], upper: &[f64]) -> DVector<f64> {
    let n = g.len();
    let size = (0..n).map(|j| h[(j, j)]).fold(f64::MIN_POSITIVE, f64::max);
    let mut x = DVector::zeros(n);
    let mut at = vec![BoundState::Free; n];
    // Each pass fixes or releases a variable; far fewer are needed.
    for _ in 0..50 * (n + 1) {
        let free: Vec<usize> = (0..n).filter(|j| at[*j] == BoundState::Free).collect();
        let slope = g + h * &x;
        let mut part = 1.0;
        let mut blocking = None;
        if !free.is_empty() {
            let mut inner = h.select_rows(&free).select_columns(&free);
            (0..free.len()).for_each(|k| inner[(k, k)] += RIDGE * size);
            let Some(factor) = inner.cholesky() else { return x };
            let step = factor.solve(&-slope.select_rows(&free));
            for (k, j) in free.iter().enumerate() {
                let distance = if step[k] < 0.0 { lower[*j] - x[*j] } else { upper[*j] - x[*j] };
                if step[k] != 0.0 && distance / step[k] < part {
                    part = (distance / step[k]).max(0.0);
                    blocking = Some((*j, if step[k] < 0.0 { BoundState::Lower } else { BoundState::Upper }));
                }
            }
            free.iter().enumerate().for_each(|(k, j)| x[*j] += part * step[k]);
        }
        if let Some((j, bound)) = blocking {
            at[j] = bound;
            x[j] = if bound == BoundState::Lower { lower[j] } else { upper[j] };
            continue;
        }
        let slope = g + h * &x;
        // How strongly each bound pulls its variable inwards; what is no more than round-off does not count.
        let pull = |j: usize| match at[j] {
            BoundState::Free => 0.0,
            BoundState::Lower => -slope[j],
            BoundState::Upper => slope[j],
        };
        let strongest = (0..n).max_by(|a, b| pull(*a).total_cmp(&pull(*b)));
        match strongest.filter(|j| pull(*j) > 1e-12 * (slope.amax() + size * x.amax())) {
            Some(j) => at[j] = BoundState::Free,
            None => break,
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;

    #[test]
    fn the_conditions_of_a_least_value_hold() {
        let mut random = Random::new();
        for n in [1, 2, 3, 5, 8] {
            for _ in 0..40 {
                let a = DMatrix::from_fn(n + 1, n, |_, _| random.next());
                let h = a.transpose() * &a;
                let g = DVector::from_fn(n, |_, _| 3.0 * random.next());
                let lower: Vec<f64> = (0..n).map(|_| -0.5 - 0.5 * random.next()).collect();
                let upper: Vec<f64> = (0..n).map(|_| 0.5 + 0.5 * random.next()).collect();
                let x = least_in_box(&h, &g, &lower, &upper);
                let slope = &g + &h * &x;
                for j in 0..n {
                    assert!(lower[j] <= x[j] && x[j] <= upper[j]);
                    let (low, high) = (x[j] == lower[j], x[j] == upper[j]);
                    assert!(low || within(slope[j], 1e-6, Tolerance), "{slope} {x}");
                    assert!(high || within(-slope[j], 1e-6, Tolerance), "{slope} {x}");
                }
            }
        }
    }

    #[test]
    fn a_direction_without_curvature_stays() {
        let h = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, 1.0]);
        let x = least_in_box(&h, &DVector::from_vec(vec![-1.0, -1.0]), &[-9.0; 2], &[9.0; 2]);
        assert!(
            within((x[0] - 0.5).abs(), 1e-3, Tolerance) && within((x[1] - 0.5).abs(), 1e-3, Tolerance),
            "{x}"
        );
    }
}
