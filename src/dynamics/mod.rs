//! The quadratic operator of a system about steady sliding, Q(λ) = λ² M + λ (C + G + C_c) + K + K_σ + N + iH + K_c: its products, its
//! factorisation at a shift, and harmonic responses.
//!
//! Complex modes, their sensitivities, families of systems and frequency responses are made of it; it knows no case and no analysis. A
//! [`System`] holds the matrices and the contacts, [`solve_steady`] finds the state about which these are linear, [`Operator`] applies Q(λ)
//! and Q(λ)ᴴ, [`Shifted`] solves with Q at a shift, and [`Harmonic`] gives receptances.
//!
//! [`System`]: crate::system::System
//! [`solve_steady`]: crate::equilibrium::solve_steady
//!
//! A mass on springs in a frame that turns, with G = 2Ω\[0 −1; 1 0\]: the residual of a complex mode, and a frequency response.
//!
//! ```
//! use std::sync::Arc;
//! use stridor::dynamics::{Block, Operator, Shifted, Side};
//! use stridor::equilibrium::{SteadyOptions, solve_steady};
//! use stridor::linalg::sparse::entry;
//! use stridor::linalg::{Engine, SparseMatrix, c64};
//! use stridor::system::{Coupling, Damping, Skew, Structure, System};
//!
//! let matrix = |entries: &[(usize, usize, f64)]| {
//!     let entries: Vec<_> = entries.iter().map(|(i, j, v)| entry(*i, *j, *v)).collect();
//!     Arc::new(SparseMatrix::try_new_from_triplets(2, 2, &entries).unwrap())
//! };
//! let (k, spin) = (400.0, 3.0);
//! let structure = Structure {
//!     mass: matrix(&[(0, 0, 1.0), (1, 1, 1.0)]),
//!     stiffness: matrix(&[(0, 0, k), (1, 1, k)]),
//!     damping: Damping::default(),
//!     engine: Engine::default(),
//! };
//! let mut system = System::new(structure, Vec::new());
//! let turning = matrix(&[(0, 1, -2.0 * spin), (1, 0, 2.0 * spin)]);
//! system.coupling = Some(Coupling::sparse(Skew { stiffness: matrix(&[]), damping: turning }));
//! let steady = solve_steady(&system, &SteadyOptions::default(), &())?;
//!
//! // φ = (1, −i) with λ² + 2iΩλ + k = 0.
//! let operator = Operator::new(&system, &steady)?;
//! let lambda = c64::new(0.0, (k + spin * spin).sqrt() - spin);
//! let mode = Block::from_columns(2, &[&[c64::new(1.0, 0.0), c64::new(0.0, -1.0)]]);
//! let residual = operator.value(Side::Right, &[lambda], &mode);
//! assert!(residual.norm(0) < 1e-14 * operator.size(lambda) * mode.norm(0));
//!
//! // u = Q(iω)⁻¹ f with det Q = (k − ω²)² − (2Ωω)².
//! let omega = 10.0;
//! let shifted = Shifted::new(&operator, c64::new(0.0, omega))?;
//! let force = faer::mat![[c64::new(1.0, 0.0)], [c64::new(0.0, 0.0)]];
//! let moved = shifted.invert(force);
//! let (free, turn) = (k - omega * omega, 2.0 * spin * omega);
//! assert!((moved[(0, 0)] - free / (free * free - turn * turn)).norm() < 1e-15);
//! # Ok::<(), stridor::error::Error>(())
//! ```

mod block;
mod damper;
mod harmonic;
mod interface;
mod operator;
mod shifted;

pub use block::Block;
pub(crate) use damper::{Between, Damper, DamperPart, modal_times};
pub use harmonic::{DAMPERS, Harmonic, is_unbounded};
pub(crate) use interface::terms_of_every_point;
pub use interface::{Interface, InterfaceTerm, TermOrigin};
pub(crate) use operator::Forms;
pub use operator::{Operator, Side};
pub(crate) use shifted::Adjoint;
pub use shifted::Shifted;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::{random_system, skew_parts};
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::linalg::c64;
    use crate::system::ModalDamping;
    use faer::Mat;

    /// Random systems with contacts of few and of many directions, skew parts and damping of every kind.
    #[test]
    fn products_and_solutions_are_those_of_the_dense_matrix() {
        for seed in 1..=9 {
            let many = seed > 6;
            let (n, points, load) = if many { (150, 130, 3e3) } else { (24, 3, 3.0) };
            let mut system = random_system(n, points, load, seed);
            if seed % 2 == 0 {
                system.coupling = Some(skew_parts(n, seed, 5.0, 0.0));
            }
            let basis = Mat::from_fn(n, 2, |i, j| ((i + 2) as f64 * (0.4 + j as f64)).sin());
            let modal = ModalDamping { basis, coefficients: vec![0.3, 0.7] };
            system.structure.damping.modal = (seed % 3 == 0).then(|| modal.clone());
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let operator = Operator::new(&system, &steady).unwrap();
            let interface = Interface::new(&system, &steady);
            assert_eq!(many, interface.directions.len() > 300);
            let own = system.constant_matrices().unwrap();
            let (mass, stiffness) = (own.mass.to_dense(), own.stiffness.to_dense());
            let damping = own.damping.map_or(Mat::zeros(n, n), |c| c.to_dense());
            let loss = own.loss.map_or(Mat::zeros(n, n), |h| h.to_dense());
            let (mut k, mut c) = (stiffness, damping);
            if system.structure.damping.modal.is_some() {
                for (j, own) in modal.coefficients.iter().enumerate() {
                    c +=
                        modal.basis.subcols(j, 1) * modal.basis.subcols(j, 1).transpose() * faer::Scale(*own);
                }
            }
            for term in &interface.terms {
                for (i, w) in interface.directions[term.row].iter() {
                    for (j, v) in interface.directions[term.column].iter() {
                        k[(i, j)] += w * term.stiffness * v;
                        c[(i, j)] += w * term.damping * v;
                    }
                }
            }
            let lambda = c64::new(-0.4, 11.0 + seed as f64);
            let q = Mat::from_fn(n, n, |i, j| {
                lambda * lambda * mass[(i, j)] + lambda * c[(i, j)] + c64::new(k[(i, j)], loss[(i, j)])
            });
            let slope = Mat::from_fn(n, n, |i, j| lambda * 2.0 * mass[(i, j)] + c[(i, j)]);
            let x = Mat::from_fn(n, 1, |i, _| c64::new((0.7 * i as f64).sin(), (1.1 * i as f64).cos()));
            let vector = Block::from_fn(n, 1, |i, j| x[(i, j)]);
            let near = |found: &Block, expected: Mat<c64>| {
                let off = (0..n).map(|i| (found.get(i, 0) - expected[(i, 0)]).norm()).fold(0.0, f64::max);
                assert!(
                    within(off, 1e-13 * operator.size(lambda) * x.norm_l2(), RoundOff),
                    "{seed}: {off:e}"
                );
            };
            near(&operator.value(Side::Right, &[lambda], &vector), &q * &x);
            near(&operator.value(Side::Left, &[lambda], &vector), q.adjoint() * &x);
            near(&operator.slope(Side::Right, &[lambda], &vector), &slope * &x);
            near(&operator.slope(Side::Left, &[lambda], &vector), slope.adjoint() * &x);
            let solved = Shifted::new(&operator, lambda).unwrap().invert(x.clone());
            let solved = Block::from_fn(n, 1, |i, j| solved[(i, j)]);
            let back = operator.value(Side::Right, &[lambda], &solved);
            let scale = operator.size(lambda) * solved.norm(0) + x.norm_l2();
            let off = (0..n).map(|i| (back.get(i, 0) - x[(i, 0)]).norm()).fold(0.0, f64::max);
            assert!(within(off, 1e-12 * scale, RoundOff), "{seed}: {off:e} of {scale:e}");
        }
    }
}
