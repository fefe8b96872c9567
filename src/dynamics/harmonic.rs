//! Response to a harmonic force, at full order.

use super::block::Block;
use super::operator::{Operator, Side};
use super::shifted::Shifted;
use crate::equilibrium::SteadySliding;
use crate::error::{Error, Result};
use crate::linalg::factor::is_singular;
use crate::linalg::{SparseVector, c64};
use crate::system::System;
use faer::Mat;
use std::f64::consts::TAU;

/// Receptances of a system about steady sliding: for a force Re(f e^{iωt}) along f the displacement Re(dᵀu e^{iωt}) along
/// d is Re(h e^{iωt}) with
///
/// h(ω) = dᵀ Q(iω)⁻¹ f,   Q(λ) = λ² M + λ (C + C_c) + K + K_σ + iH + K_c,
///
/// \[m/N\] for unit vectors. The contacts are linear about steady sliding: K_c and C_c are not symmetric there, so that
/// the way from one place to another is not that back; without them it is (Maxwell–Betti).
pub struct Harmonic<'a> {
    operator: Operator<'a>,
    modal: bool,
}

/// What the frequency of the factor is moved by, as a part of it, where there is modal damping: the factor is of the matrix without
/// it, which may be singular, or nearly so, where the sum is not. With the response at the frequency itself, refinement takes back what
/// the move leaves, of which each step keeps this over ζ.
const ASIDE: [f64; 4] = [0.0, 1e-10, -1e-8, 1e-6];
/// Refinement ends at a step of this part of the response, or where steps no longer shrink: then rounding is left, as of fine meshes.
const REFINED: f64 = 1e-9;
/// With a larger last step than the first the factors of another frequency are tried; with a larger one than the second there is no answer.
const ACCEPTED: [f64; 2] = [1e-7, 1e-4];
/// Steps of the refinement at most.
const STEPS: usize = 8;

impl<'a> Harmonic<'a> {
    /// Of a system at steady sliding.
    ///
    /// # Errors
    /// A geometric stiffness that cannot be worked out.
    pub fn new(system: &'a System, steady: &SteadySliding) -> Result<Self> {
        Ok(Harmonic {
            operator: Operator::new(system, steady)?,
            modal: system.structure.damping.modal.is_some(),
        })
    }

    /// h of each direction of `seen` for a force along `force` at ω \[rad/s\], by one factorisation of Q(iω).
    ///
    /// # Errors
    /// A frequency at which nothing damps a resonance, or little beside what rounding leaves.
    pub fn at(&self, omega: f64, force: &SparseVector, seen: &[SparseVector]) -> Result<Vec<c64>> {
        let moved = self.moved(omega, std::slice::from_ref(force))?;
        let along = |d: &SparseVector| d.iter().map(|(i, v)| moved[(i, 0)] * v).sum();
        Ok(seen.iter().map(along).collect())
    }

    /// Q(iω)⁻¹ f for each f of `forces`, one a column.
    ///
    /// # Errors
    /// A frequency at which nothing damps a resonance, or little beside what rounding leaves.
    pub fn moved(&self, omega: f64, forces: &[SparseVector]) -> Result<Mat<c64>> {
        let mut columns = Mat::<c64>::zeros(self.operator.n(), forces.len());
        for (k, force) in forces.iter().enumerate() {
            force.iter().for_each(|(i, v)| columns[(i, k)] = c64::new(v, 0.0));
        }
        let at = |omega: f64| Shifted::new(&self.operator, c64::new(0.0, omega));
        if !self.modal {
            let shifted = at(omega).map_err(|e| if is_singular(&e) { unbounded(omega) } else { e })?;
            return Ok(shifted.invert(columns));
        }
        let (mut best, mut singular): (Option<(Mat<c64>, f64)>, bool) = (None, false);
        for aside in ASIDE {
            match at(omega * (1.0 + aside)) {
                Ok(shifted) => {
                    let (moved, step) = self.refined(omega, &shifted, &columns);
                    if best.as_ref().is_none_or(|(_, least)| step < *least) {
                        best = Some((moved, step));
                    }
                    if step <= ACCEPTED[0] {
                        break;
                    }
                }
                Err(error) if is_singular(&error) => singular = true,
                Err(error) => return Err(error),
            }
        }
        let unsolved = || if singular { unbounded(omega) } else { not_solved(omega) };
        best.filter(|(_, step)| *step <= ACCEPTED[1]).map(|(moved, _)| moved).ok_or_else(unsolved)
    }

    /// Q(iω)⁻¹ F by the factors at another frequency, and its last step as a part of it.
    fn refined(&self, omega: f64, shifted: &Shifted<'_>, columns: &Mat<c64>) -> (Mat<c64>, f64) {
        let (n, count) = (columns.nrows(), columns.ncols());
        let lambda = vec![c64::new(0.0, omega); count];
        let mut moved = shifted.invert(columns.clone());
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let x = Block::from_fn(n, count, |i, j| moved[(i, j)]);
            let value = self.operator.value(Side::Right, &lambda, &x);
            let step = shifted.invert(Mat::from_fn(n, count, |i, j| columns[(i, j)] - value.get(i, j)));
            let part = |j: usize| step.col(j).norm_l2() / moved.col(j).norm_l2().max(f64::MIN_POSITIVE);
            // NaN is no step.
            let size =
                (0..count).map(part).fold(0.0, |most: f64, part| if part <= most { most } else { part });
            if size > 0.5 * last || size.is_nan() {
                break;
            }
            moved += &step;
            last = size;
            if last <= REFINED {
                break;
            }
        }
        (moved, last)
    }
}

/// What the error of a response without a bound begins with.
const UNBOUNDED: &str = "nothing damps the resonance there";

/// What damps a resonance.
pub const DAMPERS: &str = "Give `[damping] modal_ratio = 0.002` or `rayleigh`, a material's `loss_factor`, or springs with `damping`";

/// The error of a response at a resonance that nothing damps.
fn unbounded(omega: f64) -> Error {
    let found = format!("{UNBOUNDED}: the response has no bound");
    Error::analysis(format!("frequency response at {:.6} Hz", omega / TAU), found, DAMPERS)
}

/// The error of a response whose equations are too near to singular.
fn not_solved(omega: f64) -> Error {
    let found = "its equations are solved to less than four digits";
    Error::analysis(format!("frequency response at {:.6} Hz", omega / TAU), found, DAMPERS)
}

/// Whether this is the error of a response at a resonance that nothing damps.
pub fn is_unbounded(error: &Error) -> bool {
    matches!(error, Error::Analysis { found, .. } if found.starts_with(UNBOUNDED))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::equilibrium::samples::random_system;
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::linalg::sparse::add_scaled;
    use crate::modal::samples::dense_modes;

    fn unit(at: usize) -> SparseVector {
        SparseVector::from_entries([(at, 1.0)])
    }

    /// At resonances and next to them, where the matrix without modal damping is singular but for rounding: H = Σ_k φ_k φ_kᵀ/(ω_k² + 2iζωω_k
    /// − ω²).
    #[test]
    fn modal_damping_bounds_the_response_at_resonances() {
        let base = System { load: vec![0.0; 40], pairs: vec![], ..random_system(40, 1, 3.0, 4) };
        let modes = dense_modes(&base, 40);
        for ratio in [1e-4, 2e-3, 0.05] {
            let mut system = base.clone();
            system.structure.damping.viscous = None;
            system.structure.damping.hysteretic = None;
            let basis = crate::linalg::sparse::times(&system.structure.mass, modes.shapes.as_ref());
            let coefficients = modes.eigenvalues.iter().map(|w| 2.0 * ratio * w.sqrt()).collect();
            system.structure.damping.modal = Some(crate::system::ModalDamping { basis, coefficients });
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let harmonic = Harmonic::new(&system, &steady).unwrap();
            let (a, b) = (3, 17);
            for k in [0, 5, 20] {
                for beside in [0.0, 1e-16, -3e-15, 1e-13, 1e-11, -1e-9, 1e-6] {
                    let omega = modes.eigenvalues[k].sqrt() * (1.0 + beside);
                    let found = harmonic.at(omega, &unit(a), &[unit(b)]).unwrap()[0];
                    let term = |k: usize| {
                        let w = modes.eigenvalues[k].sqrt();
                        let residue = modes.shapes[(a, k)] * modes.shapes[(b, k)];
                        residue / c64::new(w * w - omega * omega, 2.0 * ratio * omega * w)
                    };
                    let exact: c64 = (0..40).map(term).sum();
                    let size = (0..40).map(|k| term(k).norm()).sum::<f64>();
                    assert!(
                        within((found - exact).norm() / size, 10.0 * ACCEPTED[0], Tolerance),
                        "{ratio} {k} {beside}: {found} {exact}"
                    );
                }
            }
        }
    }

    /// With C = β K: H = Σ_k φ_k φ_kᵀ/(ω_k² (1 + iβω) − ω²).
    #[test]
    fn modes_of_a_chain_add_up_to_the_response() {
        let mut system = System { load: vec![0.0; 40], pairs: vec![], ..random_system(40, 1, 3.0, 4) };
        let beta = 2e-3;
        system.structure.damping.modal = None;
        system.structure.damping.viscous = Some(add_scaled(&[(beta, &system.structure.stiffness)]).into());
        let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
        let modes = dense_modes(&system, 40);
        let harmonic = Harmonic::new(&system, &steady).unwrap();
        let (a, b) = (3, 17);
        for omega in [0.3, 1.0, 2.2].map(|part| part * modes.eigenvalues[4].sqrt()) {
            let found = harmonic.at(omega, &unit(a), &[unit(a), unit(b)]).unwrap();
            let back = harmonic.at(omega, &unit(b), &[unit(a)]).unwrap();
            for (h, place) in found.iter().zip([a, b]) {
                let term = |k: usize| {
                    let square = modes.eigenvalues[k];
                    let residue = modes.shapes[(a, k)] * modes.shapes[(place, k)];
                    residue / (c64::new(1.0, beta * omega) * square - omega * omega)
                };
                let exact: c64 = (0..40).map(term).sum();
                assert!(within((h - exact).norm(), 1e-9 * exact.norm(), RoundOff), "{h} {exact}");
            }
            assert!(within((found[1] - back[0]).norm(), 1e-10 * back[0].norm(), RoundOff));
        }
    }
}
