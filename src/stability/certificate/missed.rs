//! What the basis misses of the static responses to the interface, W_Z, by norms.
//!
//! S = W_ZᵀW_Z = Wᵀ(A⁻¹ − B(BᵀAB)⁻¹Bᵀ)W of thousands of directions is never formed: the largest eigenvalue of its block of a group of
//! directions, ‖W_Z‖² of these, is bounded by some products ([`largest_eigenvalues`]), a solution each.

use super::largest::largest_eigenvalues;
use super::probes::{Probes, RitzPairs};
use crate::dynamics::InterfaceTerm;
use crate::error::Result;
use crate::linalg::dense::{product, symmetric_eigen};
use crate::linalg::sparse::dot;
use crate::stability::analysis::CompletedAnalysis;
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// Bounds on what W_Z adds to the interface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Missed {
    /// ‖W_Z k W_Zᵀ‖.
    pub(super) stiffness: f64,
    /// ‖W_Z c W_Zᵀ‖ \[s\].
    pub(super) damping: f64,
    /// ‖W_Z‖, of the directions times the root of their sizes.
    pub(super) response: f64,
}

impl Missed {
    /// Of the squares of ‖W_Z‖ for the groups of [`DirectionGroup::of`]: ‖W_Z k W_Zᵀ‖ ≤ ‖W_Z‖ ‖k‖ ‖W_Z‖ with the directions of
    /// the rows of k on the left and of its columns on the right.
    pub(super) fn new(analysis: &CompletedAnalysis<'_>, squares: &[f64]) -> Self {
        let interface = &analysis.operator.interface;
        let sizes = interface.sizes(TAU * analysis.band_hz[1]);
        let norm = |value: fn(&InterfaceTerm) -> f64| {
            let mut sums = [vec![0.0f64; sizes.len()], vec![0.0f64; sizes.len()]];
            for term in interface.terms.iter().filter(|term| value(term) != 0.0) {
                let scaled = value(term).abs() / (sizes[term.row] * sizes[term.column]).sqrt();
                sums[0][term.row] += scaled;
                sums[1][term.column] += scaled;
            }
            let [rows, columns] = sums.map(|sums| sums.into_iter().fold(0.0, f64::max));
            (rows * columns).sqrt()
        };
        let [rows, columns, damped, all] = [0, 1, 2, 3].map(|group| squares[group].max(0.0));
        Missed {
            stiffness: norm(|term| term.stiffness) * (rows * columns).sqrt(),
            damping: norm(|term| term.damping) * damped,
            response: all.sqrt(),
        }
    }
}

/// Some directions of the interface, each times the root of its size.
pub(super) struct DirectionGroup {
    /// Their places among those of the operator.
    members: Vec<usize>,
    scales: Vec<f64>,
}

impl DirectionGroup {
    /// The directions along which the stiffness of the interface acts, those whose motion it answers, those of its damping, and all
    /// that are `active`.
    pub(super) fn of(analysis: &CompletedAnalysis<'_>, active: &[usize]) -> [Self; 4] {
        let interface = &analysis.operator.interface;
        let sizes = interface.sizes(TAU * analysis.band_hz[1]);
        let mut ends = [(); 3].map(|()| vec![false; sizes.len()]);
        for term in &interface.terms {
            if term.stiffness != 0.0 {
                ends[0][term.row] = true;
                ends[1][term.column] = true;
            }
            if term.damping != 0.0 {
                ends[2][term.row] = true;
                ends[2][term.column] = true;
            }
        }
        let [rows, columns, damped] = ends;
        [rows, columns, damped, vec![true; sizes.len()]].map(|chosen| {
            let members: Vec<usize> = active.iter().copied().filter(|d| chosen[*d]).collect();
            let scales = members.iter().map(|d| sizes[*d].sqrt()).collect();
            DirectionGroup { members, scales }
        })
    }

    /// The largest eigenvalue of S, given W_Zᵀ of the `active` directions.
    pub(super) fn largest_of_rows(&self, active: &[usize], rows: MatRef<'_, f64>) -> Result<f64> {
        let place = |i: usize| active.binary_search(&self.members[i]).expect("a group of the active ones");
        let own = Mat::from_fn(self.members.len(), rows.ncols(), |i, j| rows[(place(i), j)]);
        let (values, _) = symmetric_eigen(product(own.as_ref(), own.transpose()).as_ref())?;
        Ok(values.last().copied().unwrap_or(0.0))
    }

    /// Bounds on the largest eigenvalues of S of every group, with what rounding may hide.
    pub(super) fn largest(
        groups: &[Self],
        analysis: &CompletedAnalysis<'_>,
        ritz: &RitzPairs<'_>,
    ) -> Result<Vec<f64>> {
        let rounding = |group: &Self| {
            let combinations = Probes::combinations(group.members.len());
            let forces = group.forces(analysis, combinations.as_ref());
            let mut solved = forces.clone();
            analysis.factor.solve_in_place(solved.as_mut());
            Probes::new(analysis, forces).error(&combinations, &group.motions(analysis, solved.as_ref()))
        };
        let rounding: Vec<f64> = groups.iter().map(rounding).collect();
        let orders: Vec<usize> = groups.iter().map(|group| group.members.len()).collect();
        let mut sizes = largest_eigenvalues(&orders, |vectors| {
            let asked: Vec<usize> = (0..groups.len()).filter(|g| !vectors[*g].is_empty()).collect();
            let mut solved = Mat::zeros(analysis.operator.n(), asked.len());
            let mut share = Mat::zeros(analysis.basis.len(), asked.len());
            for (j, g) in asked.iter().enumerate() {
                let v = MatRef::from_column_major_slice(&vectors[*g], vectors[*g].len(), 1);
                solved.subcols_mut(j, 1).copy_from(groups[*g].forces(analysis, v));
                share.subcols_mut(j, 1).copy_from(groups[*g].share(analysis, &vectors[*g]));
            }
            analysis.factor.solve_in_place(solved.as_mut());
            let known = ritz.solution(&share);
            let mut products = vec![Vec::new(); groups.len()];
            for (j, g) in asked.iter().enumerate() {
                let mut motion = groups[*g].motions(analysis, solved.subcols(j, 1));
                motion -= groups[*g].motions_in_basis(analysis, known.col_as_slice(j));
                products[*g] = motion.col_as_slice(0).to_vec();
            }
            products
        })?;
        sizes.iter_mut().zip(rounding).for_each(|(size, rounding)| *size += rounding);
        Ok(sizes)
    }

    /// W v.
    fn forces(&self, analysis: &CompletedAnalysis<'_>, v: MatRef<'_, f64>) -> Mat<f64> {
        let mut forces = Mat::zeros(analysis.operator.n(), v.ncols());
        for j in 0..v.ncols() {
            for (i, (d, scale)) in self.members.iter().zip(&self.scales).enumerate() {
                analysis.operator.interface.directions[*d]
                    .add_to(scale * v[(i, j)], forces.col_as_slice_mut(j));
            }
        }
        forces
    }

    /// Wᵀx.
    fn motions(&self, analysis: &CompletedAnalysis<'_>, x: MatRef<'_, f64>) -> Mat<f64> {
        let columns: Vec<&[f64]> =
            x.col_iter().map(|x| x.try_as_col_major().expect("columns of a matrix").as_slice()).collect();
        Mat::from_fn(self.members.len(), x.ncols(), |i, j| {
            self.scales[i] * analysis.operator.interface.directions[self.members[i]].dot(columns[j])
        })
    }

    /// BᵀW v.
    fn share(&self, analysis: &CompletedAnalysis<'_>, v: &[f64]) -> Mat<f64> {
        let mut share = Mat::zeros(analysis.basis.len(), 1);
        for ((d, scale), v) in self.members.iter().zip(&self.scales).zip(v) {
            let seen = analysis.basis.interface.col_as_slice(*d);
            share.col_as_slice_mut(0).iter_mut().zip(seen).for_each(|(sum, w)| *sum += scale * v * w);
        }
        share
    }

    /// WᵀB y.
    fn motions_in_basis(&self, analysis: &CompletedAnalysis<'_>, y: &[f64]) -> Mat<f64> {
        let interface = &analysis.basis.interface;
        let motion = |i: usize| dot(interface.col_as_slice(self.members[i]), y);
        Mat::from_fn(self.members.len(), 1, |i, _| self.scales[i] * motion(i))
    }
}
