//! GMRES with a preconditioner on the right.
//!
//! Y. Saad & M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856: x = P⁻¹y with y in the Krylov space of A P⁻¹ and b for which ‖b − A x‖
//! is least; the Krylov vectors are orthogonalised twice.

use super::multivector::{combine, expand, gram};
use faer::{Accum, Mat, MatRef};

/// Krylov vectors that are held; after as many the iteration starts again from what it has.
const HELD: usize = 60;
/// A restart that leaves more than this part of the residual is the last one.
const STALLED: f64 = 0.9;
/// The part of a column of the Hessenberg matrix below which what the columns before leave of it is rounding.
const SINGULAR: f64 = 1e-14;

/// An approximate solution of A x = b.
#[derive(Debug, Clone)]
pub struct Solution {
    /// x.
    pub x: Vec<f64>,
    /// Applications of A P⁻¹.
    pub iterations: usize,
    /// ‖b − A x‖ / ‖b‖, as the iteration has it; what rounding adds to it shows in b − A x alone.
    pub residual: f64,
}

/// x with ‖b − A x‖ ≤ `tolerance` ‖b‖, or as near as `most` iterations come: `apply` gives A v, `precondition` P⁻¹v, both linear.
///
/// ```
/// let a = [[4.0, 1.0], [0.0, 2.0]];
/// let apply = |x: &[f64]| a.iter().map(|row| row[0] * x[0] + row[1] * x[1]).collect();
/// let found = stridor_linalg::gmres::gmres(apply, |x| vec![x[0] / 4.0, x[1] / 2.0], &[5.0, 2.0], 1e-14, 10);
/// assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-14) && found.iterations == 2);
/// ```
pub fn gmres(
    apply: impl Fn(&[f64]) -> Vec<f64>,
    precondition: impl Fn(&[f64]) -> Vec<f64>,
    b: &[f64],
    tolerance: f64,
    most: usize,
) -> Solution {
    let size = norm(b);
    let mut solution = Solution { x: vec![0.0; b.len()], iterations: 0, residual: 1.0 };
    if size == 0.0 {
        return Solution { residual: 0.0, ..solution };
    }
    let mut rest = b.to_vec();
    while solution.residual > tolerance && solution.iterations < most {
        let before = norm(&rest) / size;
        let cycle = Cycle::run(&apply, &precondition, &rest, tolerance * size, most - solution.iterations);
        solution.iterations += cycle.iterations;
        let step = precondition(&cycle.step);
        if !step.iter().all(|v| v.is_finite()) {
            return solution;
        }
        solution.x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
        solution.residual = cycle.residual / size;
        if solution.residual <= tolerance || solution.iterations >= most {
            break;
        }
        let image = apply(&solution.x);
        rest = b.iter().zip(&image).map(|(b, image)| b - image).collect();
        solution.residual = norm(&rest) / size;
        let shrinks = solution.residual <= STALLED * before;
        if !shrinks {
            break;
        }
    }
    solution
}

/// The iterations up to a restart.
struct Cycle {
    /// y of the step P⁻¹y.
    step: Vec<f64>,
    iterations: usize,
    residual: f64,
}

impl Cycle {
    fn run(
        apply: &impl Fn(&[f64]) -> Vec<f64>,
        precondition: &impl Fn(&[f64]) -> Vec<f64>,
        rest: &[f64],
        aim: f64,
        most: usize,
    ) -> Self {
        let (n, held, size) = (rest.len(), HELD.min(most), norm(rest));
        let mut krylov = Mat::<f64>::zeros(n, held + 1);
        let mut hessenberg = Mat::<f64>::zeros(held + 1, held);
        let mut rotations: Vec<[f64; 2]> = Vec::new();
        let mut rhs = vec![0.0; held + 1];
        rhs[0] = size;
        krylov.col_as_slice_mut(0).iter_mut().zip(rest).for_each(|(v, r)| *v = r / size);
        let mut count = 0;
        while count < held && rhs[count].abs() > aim {
            let mut image = apply(&precondition(krylov.col_as_slice(count)));
            let known = krylov.subcols(0, count + 1);
            for _ in 0..2 {
                let share = gram(known, column(&image));
                (0..=count).for_each(|i| hessenberg[(i, count)] += share[(i, 0)]);
                let mut next = Mat::from_fn(n, 1, |i, _| image[i]);
                combine(next.as_mut(), Accum::Add, known, share.as_ref(), -1.0);
                image.copy_from_slice(next.col_as_slice(0));
            }
            let length = norm(&image);
            hessenberg[(count + 1, count)] = length;
            let size = norm(&hessenberg.col_as_slice(count)[..=count + 1]);
            for (i, [c, s]) in rotations.iter().enumerate() {
                let (a, b) = (hessenberg[(i, count)], hessenberg[(i + 1, count)]);
                hessenberg[(i, count)] = c * a + s * b;
                hessenberg[(i + 1, count)] = c * b - s * a;
            }
            let (a, b) = (hessenberg[(count, count)], hessenberg[(count + 1, count)]);
            let radius = a.hypot(b);
            // The operator is singular on the Krylov space, or a number is not finite: what came before is what there is.
            if radius <= SINGULAR * size || !radius.is_finite() {
                break;
            }
            let [c, s] = [a / radius, b / radius];
            hessenberg[(count, count)] = radius;
            rhs[count + 1] = -s * rhs[count];
            rhs[count] *= c;
            rotations.push([c, s]);
            count += 1;
            if length == 0.0 {
                break;
            }
            krylov.col_as_slice_mut(count).iter_mut().zip(&image).for_each(|(v, w)| *v = w / length);
        }
        let mut y = Mat::<f64>::zeros(count, 1);
        for i in (0..count).rev() {
            let known: f64 = (i + 1..count).map(|j| hessenberg[(i, j)] * y[(j, 0)]).sum();
            y[(i, 0)] = (rhs[i] - known) / hessenberg[(i, i)];
        }
        let step = expand(krylov.subcols(0, count), y.as_ref()).col_as_slice(0).to_vec();
        Cycle { step, iterations: count.max(1), residual: rhs[count].abs() }
    }
}

fn column(x: &[f64]) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(x, x.len(), 1)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use stridor_base::bounds::{Origin::*, within};

    /// Matrices of n rows with a diagonal from 1 to 1e6 and what is not symmetric beside it, preconditioned by the diagonal.
    #[test]
    fn unsymmetric_systems_are_solved_with_restarts_and_without() {
        for (n, share) in [(1, 0.0), (7, 0.3), (150, 0.3), (400, 1.2)] {
            let mut random = Random::seeded(n as u64);
            let diagonal: Vec<f64> = (0..n).map(|i| 10f64.powf(6.0 * i as f64 / n as f64)).collect();
            let far: Vec<f64> = (0..n).map(|_| share * random.next()).collect();
            let apply = |x: &[f64]| -> Vec<f64> {
                (0..n).map(|i| diagonal[i] * (x[i] + far[i] * x[(3 * i + 1) % n])).collect()
            };
            let by_diagonal =
                |x: &[f64]| -> Vec<f64> { x.iter().zip(&diagonal).map(|(x, d)| x / d).collect() };
            let exact: Vec<f64> = (0..n).map(|_| random.next()).collect();
            let b = apply(&exact);
            let found = gmres(apply, by_diagonal, &b, 1e-13, 2000);
            let image = apply(&found.x);
            let off: Vec<f64> = b.iter().zip(&image).map(|(b, a)| b - a).collect();
            assert!(within(norm(&off), 1e-12 * norm(&b), Tolerance), "{n}: {:e}", norm(&off) / norm(&b));
            assert!(found.iterations < 2000, "{n}");
        }
    }

    #[test]
    fn what_has_no_solution_ends_with_what_there_is() {
        let project = |x: &[f64]| vec![x[0], 0.0];
        let found = gmres(project, |x| x.to_vec(), &[1.0, 1.0], 1e-12, 50);
        assert!(found.residual > 0.5 && found.iterations < 50 && found.x.iter().all(|v| v.is_finite()));
        let nothing = gmres(project, |x| x.to_vec(), &[0.0, 0.0], 1e-12, 50);
        assert!(nothing.x == [0.0, 0.0] && nothing.iterations == 0);
    }
}
