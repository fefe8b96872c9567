//! The compliances fᵀA⁻¹g of many forces, by half solutions where the factors give them.
//!
//! With PSASPᵀ = LBLᵀ, fᵀA⁻¹g = (L⁻¹PSf)ᵀ B⁻¹ (L⁻¹PSg): the way back down the tree is not needed, and of a sparse f the way up
//! touches only what lies between its entries and the root.

use super::SymmetricFactor;
use crate::multivector::gram;
use faer::{Mat, MatMut};

/// FᵀA⁻¹F of the columns of `f`, which are lost; the lower triangle is computed and mirrored.
///
/// # Panics
/// When `f` has not n rows.
pub fn compliances(factor: &dyn SymmetricFactor, mut f: MatMut<'_, f64>) -> Mat<f64> {
    match factor.halves() {
        Some(halves) => {
            halves.forward_in_place(f.as_mut());
            mirrored(f, |turned| halves.pivots_in_place(turned))
        }
        None => mirrored(f, |solved| factor.solve_in_place(solved)),
    }
}

/// FᵀX, symmetric, for the columns X that `apply` makes of those of F.
fn mirrored(f: MatMut<'_, f64>, apply: impl Fn(MatMut<'_, f64>)) -> Mat<f64> {
    /// Columns that are applied to together: wide enough for the products, few enough to be held twice.
    const TOGETHER: usize = 64;
    let columns = f.ncols();
    let mut square = Mat::zeros(columns, columns);
    let mut work = Mat::zeros(f.nrows(), TOGETHER.min(columns));
    for start in (0..columns).step_by(TOGETHER) {
        let width = TOGETHER.min(columns - start);
        let mut turned = work.subcols_mut(0, width);
        turned.copy_from(f.as_ref().subcols(start, width));
        apply(turned.as_mut());
        let part = gram(f.as_ref().subcols(start, columns - start), turned.as_ref());
        for j in 0..width {
            for i in j..columns - start {
                square[(start + i, start + j)] = part[(i, j)];
                square[(start + j, start + i)] = part[(i, j)];
            }
        }
    }
    square
}

#[cfg(test)]
mod tests {
    use super::super::super::samples;
    use super::super::super::sparse::add_scaled;
    use super::super::factorize;
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    /// Against whole solutions, for numbers of columns on either side of the lanes and of those that go together.
    #[test]
    fn compliances_are_those_of_whole_solutions() {
        let (k, m) = samples::plate(24, false);
        let a = add_scaled(&[(1.0, &k), (-(std::f64::consts::TAU * 5000.0).powi(2), &m)]);
        let factor = factorize(&a).unwrap();
        assert!(factor.inertia().negative > 0);
        for columns in [1, 3, 7, 16, 83] {
            let f = Mat::from_fn(a.ncols(), columns, |i, j| {
                if j % 2 == 0 { ((i + 3 * j) as f64 * 0.7).sin() } else { f64::from(i % 97 == j) }
            });
            let mut x = f.clone();
            factor.solve_in_place(x.as_mut());
            let expected = gram(f.as_ref(), x.as_ref());
            let found = compliances(&*factor, f.clone().as_mut());
            assert!(within((&found - &expected).norm_max(), 1e-11 * expected.norm_max(), RoundOff));
        }
    }

    #[test]
    fn an_analysis_knows_its_pattern() {
        let (k, m) = samples::plate(6, false);
        let symbolic = factorize(&add_scaled(&[(1.0, &k), (1.0, &m)])).unwrap().symbolic();
        assert!(symbolic.fits(add_scaled(&[(2.0, &m), (1.0, &k)]).symbolic()));
        assert!(!symbolic.fits(samples::identity(k.ncols()).symbolic()));
        assert!(!symbolic.fits(samples::plate(7, false).0.symbolic()));
    }
}
