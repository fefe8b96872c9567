//! ∂K/∂p and ∂M/∂p, between systems that are assembled anew at neighbouring values.

use super::super::scalars::no_derivative;
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::add_scaled;
use crate::structure::Assembled;
use std::sync::Arc;

/// Where the two estimates of a derivative differ by more than this part, it is none.
const ROUGH: f64 = 1e-3;

/// Derivatives of K and M by an unknown.
pub struct Change {
    /// ∂K.
    pub stiffness: SparseMatrix,
    /// ∂M.
    pub mass: SparseMatrix,
}

impl Change {
    /// The same in another unit of the unknown.
    pub fn scaled(self, rate: f64) -> Change {
        Change { stiffness: add_scaled(&[(rate, &self.stiffness)]), mass: add_scaled(&[(rate, &self.mass)]) }
    }
}

/// Derivatives at `value` of the matrices that `build` gives for several structures at once, by (4 D(h) − D(2h))/3 with
/// D(h) = (A(p+h) − A(p−h))/2h, which is right to h⁴ and exact for what is cubic in p, such as the bending stiffness in the
/// thickness. Where the case refuses one side, (−25 A₀ + 48 A₁ − 36 A₂ + 16 A₃ − 3 A₄)/12h is taken on the other, right to h⁴
/// as well.
///
/// Steps ten and a hundred times smaller are tried where the larger ones change the mesh.
///
/// # Errors
/// What `build` returns, and matrices that do not follow the value smoothly.
pub fn derivatives(
    value: f64,
    step: f64,
    accepted: &dyn Fn(f64) -> bool,
    build: &dyn Fn(f64) -> Result<Vec<Arc<Assembled>>>,
) -> Result<Vec<Change>> {
    let mut tried = differences(value, step, accepted, build);
    for smaller in [0.1, 0.01] {
        if tried.is_err() {
            tried = differences(value, smaller * step, accepted, build);
        }
    }
    tried
}

fn differences(
    value: f64,
    step: f64,
    accepted: &dyn Fn(f64) -> bool,
    build: &dyn Fn(f64) -> Result<Vec<Arc<Assembled>>>,
) -> Result<Vec<Change>> {
    let side = |sign: f64| (1..=4).all(|k| accepted(value + sign * f64::from(k) * step));
    let two_sided = [-2.0, -1.0, 1.0, 2.0].iter().all(|k| accepted(value + k * step));
    // Offsets in steps, with the weights of the derivative; what does not change cancels pair by pair.
    let one_sided = |sign: f64| -> Vec<(f64, f64)> {
        let weights = [-25.0, 48.0, -36.0, 16.0, -3.0].map(|w| sign * w / 12.0);
        (0..5).map(|k| (sign * f64::from(k as u8), weights[k])).collect()
    };
    let stencil = match two_sided {
        true => vec![(1.0, 2.0 / 3.0), (-1.0, -2.0 / 3.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0)],
        false if side(1.0) => one_sided(1.0),
        false if side(-1.0) => one_sided(-1.0),
        false => return Err(no_derivative("the case refuses its neighbours on both sides")),
    };
    let at = |(offset, _): &(f64, f64)| build(value + offset * step);
    let systems: Vec<Vec<Arc<Assembled>>> = stencil.iter().map(at).collect::<Result<_>>()?;
    let count = systems[0].len();
    let sum = |k: usize, pick: fn(&Assembled) -> &SparseMatrix| -> Result<SparseMatrix> {
        let terms: Vec<(f64, &SparseMatrix)> =
            stencil.iter().zip(&systems).map(|((_, w), system)| (w / step, pick(&system[k]))).collect();
        let sum = add_scaled(&terms);
        if two_sided {
            let near = add_scaled(&[(0.5 / step, terms[0].1), (-0.5 / step, terms[1].1)]);
            let size = |m: &SparseMatrix| m.val().iter().fold(0.0f64, |a, v| a.max(v.abs()));
            if size(&add_scaled(&[(1.0, &near), (-1.0, &sum)])) > ROUGH * size(&sum) {
                return Err(no_derivative("the matrices do not follow it smoothly"));
            }
        }
        Ok(sum)
    };
    (0..count)
        .map(|k| {
            Ok(Change {
                stiffness: sum(k, |a| &a.structure.stiffness)?,
                mass: sum(k, |a| &a.structure.mass)?,
            })
        })
        .collect()
}
