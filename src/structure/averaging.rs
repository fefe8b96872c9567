//! Averaging links: a point moves as some nodes do in the mean, without making them stiffer.

use super::model::Constraint;
use nalgebra::{Matrix3, Vector3};

/// Nodes whose smallest moment about an axis is below this share of the largest lie on a line.
const ON_A_LINE: f64 = 1e-10;

/// The six constraints of a `reference` node that moves as `nodes` with their weights w do, by least squares: the rigid motion (U, θ) for
/// which Σ w |u_i − U − θ × r_i|² is least, r_i from the centre Σ w x_i / Σ w. With W = Σ w and J = Σ w (r² 1 − r rᵀ)
///
/// θ = J⁻¹ Σ w r_i × u_i, u = Σ w u_i / W + θ × (x − centre).
///
/// A force F and a moment M on the point act as forces f_i on the nodes with Σ f_i = F and Σ x_i × f_i = M + x × F. `None` where
/// the nodes lie on one line, about which no rotation is known, or have no weight.
pub fn averaging(
    coordinates: &[[f64; 3]],
    reference: usize,
    nodes: &[(usize, f64)],
) -> Option<Vec<Constraint>> {
    let whole: f64 = nodes.iter().map(|(_, w)| w).sum();
    let at = |node: usize| Vector3::from(coordinates[node]);
    let centre = nodes.iter().map(|(node, w)| *w * at(*node)).sum::<Vector3<f64>>() / whole;
    let mut moment = Matrix3::zeros();
    for (node, w) in nodes {
        let r = at(*node) - centre;
        moment += *w * (Matrix3::identity() * r.norm_squared() - r * r.transpose());
    }
    let sizes = moment.symmetric_eigenvalues();
    // Nodes without weight have no number here.
    if sizes.min().is_nan() || sizes.min() <= ON_A_LINE * sizes.max() {
        return None;
    }
    let inverse = moment.try_inverse()?;
    let arm = at(reference) - centre;
    let mut constraints: Vec<Constraint> = (0..6)
        .map(|component| Constraint {
            slave: (reference, component),
            terms: Vec::with_capacity(3 * nodes.len()),
        })
        .collect();
    for (node, w) in nodes {
        let r = at(*node) - centre;
        for axis in 0..3 {
            let unit = Vector3::ith(axis, 1.0);
            let rotation = inverse * (*w * r.cross(&unit));
            let translation = *w / whole * unit + rotation.cross(&arm);
            for k in 0..3 {
                constraints[k].terms.push((*node, axis, translation[k]));
                constraints[3 + k].terms.push((*node, axis, rotation[k]));
            }
        }
    }
    constraints.iter_mut().for_each(|constraint| constraint.terms.retain(|(.., c)| *c != 0.0));
    Some(constraints)
}
