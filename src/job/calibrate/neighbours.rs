//! ∂K/∂p, ∂M/∂p and the derivative of the sensor motions by p, between systems reassembled at neighbouring values.

use super::super::scalars::no_derivative;
use crate::error::{Error, Result};
use crate::linalg::sparse::{add_scaled, diagonal};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::structure::Assembled;
use std::sync::Arc;

/// Where the two estimates of a derivative differ by more than this part, it is none.
const ROUGH: f64 = 1e-3;
/// A change of an entry a_ij by less than this part of √(a_ii a_jj) is rounding, not another mesh, such as that of the mass of a
/// Mindlin element by Young's modulus: it goes through the inverse of the stiffness. Measured: 3e-16 for thicknesses of 0.03 to
/// 20 mm at edges of 20 mm; the rest is a margin for distorted elements.
const ROUNDING: f64 = 1e-11;

/// A structure, and what a test would measure of it.
pub struct Neighbour {
    /// The structure.
    pub assembled: Arc<Assembled>,
    /// The measured degrees of freedom as forms of its own.
    pub seen: Vec<SparseVector>,
}

/// Derivatives of K, M and what is measured by an unknown.
pub struct Change {
    /// ∂K.
    pub stiffness: SparseMatrix,
    /// ∂M.
    pub mass: SparseMatrix,
    /// ∂C of Rayleigh damping and dashpots, if there is any.
    pub viscous: Option<SparseMatrix>,
    /// ∂H of loss factors, if there are any.
    pub hysteretic: Option<SparseMatrix>,
    /// ∂ of the measured degrees of freedom as forms.
    pub seen: Vec<SparseVector>,
}

impl Change {
    /// The same in another unit of the unknown.
    pub fn scaled(self, rate: f64) -> Change {
        let scaled =
            |form: &SparseVector| SparseVector::from_entries(form.iter().map(|(i, v)| (i, rate * v)));
        Change {
            stiffness: add_scaled(&[(rate, &self.stiffness)]),
            mass: add_scaled(&[(rate, &self.mass)]),
            viscous: self.viscous.map(|c| add_scaled(&[(rate, &c)])),
            hysteretic: self.hysteretic.map(|h| add_scaled(&[(rate, &h)])),
            seen: self.seen.iter().map(scaled).collect(),
        }
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
/// Those of `build`, and matrices that do not follow the value smoothly.
pub fn derivatives(value: f64, step: f64, build: &Build) -> Result<Vec<Change>> {
    let mut tried = differences(value, step, build);
    for smaller in [0.1, 0.01] {
        if matches!(tried, Err(Error::Analysis { .. })) {
            tried = differences(value, smaller * step, build);
        }
    }
    tried
}

/// Whether two estimates of a derivative differ by more than [`ROUGH`] of its largest entry and more than the [`ROUNDING`] of the
/// matrices, whose diagonal is `diagonal`, leaves of an entry over `step`.
fn differ(near: &SparseMatrix, derivative: &SparseMatrix, diagonal: &[f64], step: f64) -> bool {
    let rough = ROUGH * derivative.val().iter().fold(0.0f64, |largest, v| largest.max(v.abs()));
    let difference = add_scaled(&[(1.0, near), (-1.0, derivative)]);
    (0..difference.ncols()).any(|j| {
        difference.row_idx_of_col(j).zip(difference.val_of_col(j)).any(|(i, v)| {
            v.abs() > rough.max(ROUNDING * (diagonal[i] * diagonal[j]).abs().sqrt() / step.abs())
        })
    })
}

/// Gives the structures at a value.
pub type Build<'a> = dyn Fn(f64) -> Result<Vec<Neighbour>> + 'a;

/// Offsets in steps, with the weights of the derivative; what does not change cancels pair by pair.
type Stencil = Vec<(f64, f64)>;

fn differences(value: f64, step: f64, build: &Build) -> Result<Vec<Change>> {
    let one_sided = |sign: f64| -> Stencil {
        let weights = [-25.0, 48.0, -36.0, 16.0, -3.0].map(|w| sign * w / 12.0);
        (0..5).map(|k| (sign * f64::from(k as u8), weights[k])).collect()
    };
    let both = vec![(1.0, 2.0 / 3.0), (-1.0, -2.0 / 3.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0)];
    let at = |stencil: &Stencil| -> Result<Vec<Vec<Neighbour>>> {
        stencil.iter().map(|(offset, _)| build(value + offset * step)).collect()
    };
    let (mut stencil, mut systems) = (both, Err(no_derivative("it has no neighbours")));
    for other in [None, Some(1.0), Some(-1.0)] {
        stencil = other.map_or(stencil, one_sided);
        systems = at(&stencil);
        // A value that the case refuses; what is wrong with the others is wrong on the other side too.
        if !matches!(systems, Err(Error::Input(_))) {
            break;
        }
    }
    let (systems, two_sided) = (systems?, stencil.len() == 4);
    let sum = |k: usize, pick: fn(&Assembled) -> &SparseMatrix| -> Result<SparseMatrix> {
        let terms: Vec<(f64, &SparseMatrix)> = stencil
            .iter()
            .zip(&systems)
            .map(|((_, w), system)| (w / step, pick(&system[k].assembled)))
            .collect();
        let sum = add_scaled(&terms);
        if two_sided {
            let near = add_scaled(&[(0.5 / step, terms[0].1), (-0.5 / step, terms[1].1)]);
            if differ(&near, &sum, &diagonal(terms[0].1), step) {
                return Err(no_derivative("the matrices do not follow it smoothly"));
            }
        }
        Ok(sum)
    };
    let form = |k: usize, i: usize| {
        let terms = stencil
            .iter()
            .zip(&systems)
            .flat_map(|((_, w), system)| system[k].seen[i].iter().map(move |(at, v)| (at, w / step * v)));
        SparseVector::from_entries(terms)
    };
    let damping = |k: usize, pick: fn(&Assembled) -> Option<&SparseMatrix>| {
        let each = stencil.iter().zip(&systems);
        let terms: Vec<(f64, &SparseMatrix)> =
            each.filter_map(|((_, w), system)| Some((w / step, pick(&system[k].assembled)?))).collect();
        (!terms.is_empty()).then(|| add_scaled(&terms))
    };
    let change = |k: usize| -> Result<Change> {
        Ok(Change {
            stiffness: sum(k, |a| &a.structure.stiffness)?,
            mass: sum(k, |a| &a.structure.mass)?,
            viscous: damping(k, |a| a.structure.damping.viscous.as_deref()),
            hysteretic: damping(k, |a| a.structure.damping.hysteretic.as_deref()),
            seen: (0..systems[0][k].seen.len()).map(|i| form(k, i)).collect(),
        })
    };
    (0..systems[0].len()).map(change).collect()
}
