//! Products of the matrices with the motion, once a step.

use super::rows::chunks;
use crate::linalg::SparseMatrix;
use crate::linalg::proportional::Proportional;
use crate::linalg::row_sparse::RowSparse;
use crate::linalg::shared_pattern::SharedPattern;
use crate::system::Damping;
use faer::{Mat, MatMut, MatRef};

/// K u, K v, K a, M v, M a and, with viscous damping, C v and C a.
#[derive(Debug)]
pub(super) enum Products {
    /// All matrices are diagonal, as those of reduced models: nothing to factorise, a few products a step.
    Diagonal(Diagonal),
    /// M and K in one pass; C = αM + βK and a few rows nearly for free.
    Proportional { matrices: SharedPattern<'static>, viscous: Option<Viscous> },
    /// M, K and C in one pass.
    General { matrices: SharedPattern<'static> },
}

/// C = αM + βK + rest.
#[derive(Debug)]
pub(super) struct Viscous {
    /// α \[1/s\] and β \[s\].
    factors: [f64; 2],
    rest: Option<RowSparse>,
}

/// The diagonals of M, K and C.
#[derive(Debug)]
pub(super) struct Diagonal {
    pub(super) mass: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    /// Zero without viscous damping.
    pub(super) viscous: Vec<f64>,
}

/// Where the products go.
pub(super) struct Derived<'a> {
    /// K u, K v, K a.
    pub(super) elastic: &'a mut Mat<f64>,
    /// M v, M a.
    pub(super) inertia: &'a mut Mat<f64>,
    /// C v, C a.
    pub(super) viscous: Option<&'a mut Mat<f64>>,
}

impl Products {
    pub(super) fn new(mass: &SparseMatrix, stiffness: &SparseMatrix, damping: &Damping) -> Self {
        if let Some(diagonal) = Diagonal::of(mass, stiffness, damping) {
            return Products::Diagonal(diagonal);
        }
        let Some(viscous) = &damping.viscous else {
            return Products::Proportional {
                matrices: SharedPattern::new(&[stiffness, mass]).into_owned(),
                viscous: None,
            };
        };
        let split = Proportional::split(viscous, mass, stiffness);
        let rest = split.rest.as_ref().map(RowSparse::new);
        if rest.as_ref().is_some_and(|rest| !rest.are_few(mass.ncols())) {
            return Products::General {
                matrices: SharedPattern::new(&[stiffness, mass, viscous]).into_owned(),
            };
        }
        let viscous = Viscous { factors: [split.mass_factor, split.stiffness_factor], rest };
        Products::Proportional {
            matrices: SharedPattern::new(&[stiffness, mass]).into_owned(),
            viscous: Some(viscous),
        }
    }

    /// The diagonals, where there is nothing else.
    pub(super) fn diagonal(&self) -> Option<&Diagonal> {
        match self {
            Products::Diagonal(diagonal) => Some(diagonal),
            _ => None,
        }
    }

    /// Of u, v and a, the columns of `motion`.
    pub(super) fn derive(&self, motion: &Mat<f64>, out: Derived<'_>) {
        let rates = motion.as_ref().subcols(1, 2);
        let (elastic, inertia) = (out.elastic.as_mut(), out.inertia.as_mut());
        match self {
            Products::Diagonal(diagonal) => {
                scale(&diagonal.stiffness, motion.as_ref(), elastic);
                scale(&diagonal.mass, rates, inertia);
                if let Some(viscous) = out.viscous {
                    scale(&diagonal.viscous, rates, viscous.as_mut());
                }
            }
            Products::Proportional { matrices, viscous } => {
                matrices.multiply(&mut [(0, elastic), (1, inertia)], motion.as_ref());
                if let (Some(Viscous { factors, rest }), Some(viscous)) = (viscous, out.viscous) {
                    combine(*factors, out.inertia, out.elastic, viscous);
                    rest.iter().for_each(|rest| rest.add_times(rates, viscous));
                }
            }
            Products::General { matrices } => match out.viscous {
                Some(viscous) => {
                    let out = &mut [(0, elastic), (1, inertia), (1, viscous.as_mut())];
                    matrices.multiply(out, motion.as_ref());
                }
                None => unreachable!("three matrices share a pattern where there is damping"),
            },
        }
    }
}

/// C v and C a = α M· + β K·.
fn combine([alpha, beta]: [f64; 2], inertia: &Mat<f64>, elastic: &Mat<f64>, viscous: &mut Mat<f64>) {
    for k in 0..2 {
        let (m, s) = (inertia.col_as_slice(k), elastic.col_as_slice(k + 1));
        chunks([viscous.col_as_slice_mut(k)], |first, [out]| {
            let rows = first..first + out.len();
            let terms = m[rows.clone()].iter().zip(&s[rows]);
            out.iter_mut().zip(terms).for_each(|(out, (m, s))| *out = alpha * m + beta * s);
        });
    }
}

impl Diagonal {
    /// That of a structure, if it is one.
    fn of(mass: &SparseMatrix, stiffness: &SparseMatrix, damping: &Damping) -> Option<Self> {
        if damping.modal.is_some() {
            return None;
        }
        let viscous = match &damping.viscous {
            Some(c) => diagonal(c)?,
            None => vec![0.0; mass.ncols()],
        };
        Some(Diagonal { mass: diagonal(mass)?, stiffness: diagonal(stiffness)?, viscous })
    }
}

/// The entries of a matrix that has none beside its diagonal.
fn diagonal(a: &SparseMatrix) -> Option<Vec<f64>> {
    let mut values = vec![0.0; a.ncols()];
    for (j, value) in values.iter_mut().enumerate() {
        for entry in a.col_ptr()[j]..a.col_ptr()[j + 1] {
            if a.row_idx()[entry as usize] as usize != j {
                return None;
            }
            *value = a.val()[entry as usize];
        }
    }
    Some(values)
}

/// y = diag(d) x.
fn scale(d: &[f64], x: MatRef<'_, f64>, mut y: MatMut<'_, f64>) {
    for k in 0..x.ncols() {
        let column = y.as_mut().col_mut(k).iter_mut().zip(x.col(k).iter());
        column.zip(d).for_each(|((y, x), d)| *y = d * x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::samples;
    use crate::linalg::sparse::{add_scaled, times};

    #[test]
    fn every_way_gives_the_products_of_the_matrices() {
        let (k, m) = samples::plate(8, true);
        let n = k.ncols();
        let rayleigh = add_scaled(&[(3.0, &m), (2e-6, &k)]);
        let dashpots = |every: usize| {
            samples::from_dense(
                Mat::from_fn(n, n, |i, j| if i == j && i % every == 0 { 7.0 } else { 0.0 }).as_ref(),
            )
        };
        let with = |every: usize| Some(add_scaled(&[(1.0, &rayleigh), (1.0, &dashpots(every))]));
        let motion = Mat::from_fn(n, 3, |i, j| ((i * 7 + j * 3) as f64).sin());
        let ways = [None, Some(rayleigh.clone()), with(40), with(2), Some(samples::random_definite(n, 3))];
        for (way, viscous) in ways.into_iter().enumerate() {
            let damping = Damping { viscous: viscous.map(Into::into), ..Damping::default() };
            let products = Products::new(&m, &k, &damping);
            assert_eq!(matches!(products, Products::General { .. }), way >= 3);
            let [mut elastic, mut inertia, mut damped] = [3, 2, 2].map(|columns| Mat::zeros(n, columns));
            let there = damping.viscous.is_some().then_some(&mut damped);
            products
                .derive(&motion, Derived { elastic: &mut elastic, inertia: &mut inertia, viscous: there });
            let near = |found: &Mat<f64>, a: &SparseMatrix, first: usize| {
                let expected = times(a, motion.subcols(first, 3 - first));
                assert!(
                    within((found - &expected).norm_max(), 1e-11 * expected.norm_max(), RoundOff),
                    "{way}"
                );
            };
            near(&elastic, &k, 0);
            near(&inertia, &m, 1);
            damping.viscous.iter().for_each(|c| near(&damped, c, 1));
        }
    }
}
