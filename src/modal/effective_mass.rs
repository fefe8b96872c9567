//! How much of the mass a mode moves along a direction.

use crate::linalg::SparseMatrix;
use crate::linalg::dense::product;
use crate::linalg::multivector::gram;
use crate::linalg::sparse::multiply;
use faer::{Mat, MatRef};

/// Participation and effective mass of each mode for each direction.
#[derive(Debug, Clone)]
pub struct EffectiveMass {
    /// Γ_kd = φ_kᵀ M r_d \[√kg\] (√kg m for rotations), n_modes × n_directions.
    pub participation: Mat<f64>,
    /// Γ² \[kg\] (kg m²), n_modes × n_directions.
    pub effective: Mat<f64>,
    /// r_dᵀ M r_d: the mass that moves along each direction; the effective masses of all modes add up to it.
    pub total: Vec<f64>,
}

/// Effective masses of mass-normalised `shapes` (n × n_modes) for rigid-body motions `directions` (n × n_directions:
/// the displacement of every degree of freedom when the structure moves one metre or turns one radian as a whole).
///
/// Γ = Φᵀ M r, Σ_k Γ_k² = rᵀ M r over all n modes, because Φ Φᵀ M = I.
///
/// # Panics
/// When the shapes do not agree.
pub fn effective_mass(
    mass: &SparseMatrix,
    shapes: MatRef<'_, f64>,
    directions: MatRef<'_, f64>,
) -> EffectiveMass {
    let mut moved = Mat::zeros(mass.nrows(), directions.ncols());
    multiply(mass, directions, moved.as_mut());
    let participation = gram(shapes, moved.as_ref());
    let effective =
        Mat::from_fn(participation.nrows(), participation.ncols(), |k, d| participation[(k, d)].powi(2));
    let total = product(directions.transpose(), moved.as_ref());
    EffectiveMass { participation, effective, total: (0..total.ncols()).map(|d| total[(d, d)]).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::{Wanted, lowest_eigenpairs, samples};

    #[test]
    fn all_modes_together_move_all_the_mass() {
        let (k, m) = samples::plate(5, false);
        let n = k.ncols();
        let pairs = lowest_eigenpairs(&k, &m, Wanted::Count(n), &()).unwrap();
        assert_eq!(pairs.values.len(), n);
        // Lift, and tilt about the edge x = 0: w = x, w_x = 1.
        let tilt = |d: usize| match d % 3 {
            0 => (d / 3 / 6) as f64 * 0.03,
            1 => 1.0,
            _ => 0.0,
        };
        let directions =
            Mat::from_fn(n, 2, |d, c| if c == 0 { f64::from(d.is_multiple_of(3)) } else { tilt(d) });
        let result = effective_mass(&m, pairs.vectors.as_ref(), directions.as_ref());
        let mass = 7850.0 * 1e-3 * 0.15 * 0.15;
        for (d, expected) in [mass, mass * 0.15 * 0.15 / 3.0].into_iter().enumerate() {
            let sum: f64 = result.effective.col(d).iter().sum();
            assert!(
                within((result.total[d] / expected - 1.0).abs(), 1e-12, RoundOff),
                "{} {expected}",
                result.total[d]
            );
            assert!(within((sum / expected - 1.0).abs(), 1e-11, RoundOff), "{sum} {expected}");
        }
        // A free body's lift is all in its rigid-body modes.
        let rigid: f64 = (0..3).map(|k| result.effective[(k, 0)]).sum();
        assert!(within((rigid / mass - 1.0).abs(), 1e-11, RoundOff));
    }
}
