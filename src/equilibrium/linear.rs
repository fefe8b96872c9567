//! The contact's forces in any state of motion, and their linearisation at steady sliding.

use super::point_laws::{respond, slid};
use super::{PointState, SteadySliding};
use crate::error::Result;
use crate::linalg::sparse::{add_scaled, multiply_vector, sum_of_squares};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::system::{
    ContactForces, ContactMotion, ContactPoint, ContactTangent, Coupling, Structure, System,
};
use std::borrow::Cow;

/// The linearised contact: K_c = Σ U k Uᵀ and C_c = Σ U c Uᵀ with U = \[g t₁ t₂\] of each point that carries load.
/// It is kept as these small blocks and never assembled.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearContact {
    /// The blocks of the points that are not silent, ascending in the point's index.
    pub blocks: Vec<ContactBlock>,
}

/// One point of the linearised contact. Rows: the forces along g, t₁, t₂ on the left-hand side, (N, −F₁, −F₂).
/// Columns: the displacements (or velocities) gᵀu, t₁ᵀu, t₂ᵀu.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactBlock {
    /// Index in [`System::points`].
    pub point: usize,
    /// k \[N/m\]: not symmetric, as −∂F₁/∂δ = −μN′ has no counterpart. What a point slides is (−t₁ᵀu, −t₂ᵀu).
    pub stiffness: [[f64; 3]; 3],
    /// c \[N s/m\]: the slip velocity is (V − t₁ᵀu̇, −t₂ᵀu̇), which turns the signs of its columns.
    pub damping: [[f64; 3]; 3],
}

impl ContactBlock {
    /// The block of a point from the derivatives of its law.
    pub fn new(point: usize, t: &ContactTangent) -> Self {
        let (mut stiffness, mut damping) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for row in 0..3 {
            // Friction stands with a minus sign on the left-hand side.
            let sign = if row == 0 { 1.0 } else { -1.0 };
            stiffness[row][0] = sign * t.by_penetration[row];
            damping[row][0] = sign * t.by_penetration_rate[row];
            for k in 0..2 {
                stiffness[row][1 + k] = -sign * t.by_slid[row][k];
                damping[row][1 + k] = -sign * t.by_slip_velocity[row][k];
            }
        }
        ContactBlock { point, stiffness, damping }
    }

    /// Whether the point is not silent.
    pub fn acts(&self) -> bool {
        self.stiffness.iter().chain(&self.damping).flatten().any(|v| *v != 0.0)
    }
}

/// g, t₁, t₂ of a point.
pub fn directions(point: &ContactPoint) -> [&SparseVector; 3] {
    [&point.normal, &point.tangents[0], &point.tangents[1]]
}

/// A stiffness d \[N/m\] along a direction.
pub type Spring<'a> = (f64, &'a SparseVector);

/// The springs of a point along g, t₁ and t₂.
pub(super) fn springs<'a>(point: &'a ContactPoint, tangent: &ContactTangent) -> [Spring<'a>; 3] {
    let [normal, along, across] = tangent.springs();
    let [g, t1, t2] = directions(point);
    [(normal, g), (along, t1), (across, t2)]
}

/// Adds g N − t₁ F₁ − t₂ F₂ of a point to a force.
pub(super) fn add_reaction(point: &ContactPoint, forces: &ContactForces, total: &mut [f64]) {
    let [g, t1, t2] = directions(point);
    g.add_to(forces.normal, total);
    t1.add_to(-forces.friction[0], total);
    t2.add_to(-forces.friction[1], total);
}

/// K_c and C_c at steady sliding: the Jacobian of the laws, point by point.
pub fn linearize(system: &System, steady: &SteadySliding) -> LinearContact {
    debug_assert_eq!(system.points().count(), steady.points.len());
    linearize_points(&steady.points)
}

/// [`linearize`] from the contact points alone.
pub fn linearize_points(points: &[PointState]) -> LinearContact {
    let mut blocks = Vec::new();
    for (point, state) in points.iter().enumerate() {
        let block = ContactBlock::new(point, &state.tangent);
        if block.acts() {
            blocks.push(block);
        }
    }
    LinearContact { blocks }
}

/// (K + W k Wᵀ + N) u: with what is not symmetric in an imported stiffness.
pub(super) fn elastic_force(k: &SparseMatrix, rest: Option<&Coupling>, u: &[f64]) -> Vec<f64> {
    let mut force = multiply_vector(k, u);
    let Some(rest) = rest else { return force };
    let motions: Vec<f64> = rest.directions.iter().map(|w| w.dot(u)).collect();
    for (i, w) in rest.directions.iter().enumerate() {
        w.add_to(motions.iter().enumerate().map(|(j, e)| rest.stiffness[(i, j)] * e).sum(), &mut force);
    }
    if let Some(skew) = &rest.skew {
        // A product with a matrix stored by columns is that with its transpose.
        force.iter_mut().zip(multiply_vector(&skew.stiffness, u)).for_each(|(f, v)| *f -= v);
    }
    force
}

/// K, or K + K_σ(u₀) when the system asks for the geometric stiffness of the preload.
pub fn tangent_stiffness<'a>(system: &'a System, displacement: &[f64]) -> Result<Cow<'a, SparseMatrix>> {
    let Some(prestress) = &system.prestress else {
        return Ok(Cow::Borrowed(&system.structure.stiffness));
    };
    let geometric = prestress.geometric_stiffness(displacement)?;
    Ok(Cow::Owned(add_scaled(&[(1.0, &system.structure.stiffness), (1.0, &geometric)])))
}

/// The structure at a steady state without its contacts: K, or K + K_σ(u₀).
///
/// # Errors
/// A geometric stiffness that cannot be worked out.
pub fn preloaded_structure<'a>(system: &'a System, steady: &SteadySliding) -> Result<Cow<'a, Structure>> {
    let structure = &system.structure;
    Ok(match tangent_stiffness(system, &steady.displacement)? {
        Cow::Borrowed(_) => Cow::Borrowed(structure),
        Cow::Owned(stiffness) => Cow::Owned(Structure { stiffness: stiffness.into(), ..structure.clone() }),
    })
}

/// The structure at steady sliding with its contact closed and frictionless: K (+ K_σ) + Σ ∂N/∂δ g gᵀ, with the springs of points that
/// stick, for real modes of the rig in contact. Those modes need an inertia count of the closed structure, so here, and only here, the
/// springs of the contact are added to a copy of K.
pub fn closed_structure(system: &System, steady: &SteadySliding) -> Result<Structure> {
    let stiffness = tangent_stiffness(system, &steady.displacement)?;
    let points = system.points().zip(&steady.points);
    let closed = points.flat_map(|((_, point), state)| springs(point, &state.tangent));
    let sum = sum_of_squares(system.n_dofs(), closed.filter(|(k, _)| *k != 0.0));
    let stiffness = add_scaled(&[(1.0, stiffness.as_ref()), (1.0, &sum)]);
    Ok(Structure { stiffness: stiffness.into(), ..system.structure.clone() })
}

/// r_c(u, u̇) = Σ \[g N − t₁ F₁ − t₂ F₂\] \[N, N m\], with δ = approach − gap + gᵀu and the pairs' own sliding velocity.
pub fn contact_force(system: &System, approach: &[f64], displacement: &[f64], velocity: &[f64]) -> Vec<f64> {
    let mut total = vec![0.0; system.n_dofs()];
    for (pair, approach) in system.pairs.iter().zip(approach) {
        for point in &*pair.points {
            let [g, t1, t2] = directions(point);
            let penetration = approach - point.gap + g.dot(displacement);
            if pair.sticks() {
                let (forces, _) = respond(pair, point, penetration, slid(pair, point, displacement));
                add_reaction(point, &forces, &mut total);
                continue;
            }
            let motion = ContactMotion {
                penetration,
                penetration_rate: g.dot(velocity),
                slip_velocity: [pair.velocity_at(point) - t1.dot(velocity), -t2.dot(velocity)],
            };
            let (forces, _) = pair.law.respond(&motion, point.weight);
            add_reaction(point, &forces, &mut total);
        }
    }
    total
}
