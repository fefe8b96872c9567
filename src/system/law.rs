//! What a contact law is: a pure function from the motion at a point to forces and their derivatives.

use std::fmt::Debug;

/// The motion at one contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactMotion {
    /// δ \[m\], positive when pressed.
    pub penetration: f64,
    /// δ̇ \[m/s\].
    pub penetration_rate: f64,
    /// v = (V − t₁ᵀu̇, −t₂ᵀu̇) \[m/s\]: how fast the counter-body slides past the body along t₁ and t₂.
    pub slip_velocity: [f64; 2],
}

/// The forces at one contact point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactForces {
    /// N \[N\], positive in compression.
    pub normal: f64,
    /// F₁, F₂ \[N\]: friction on the body along t₁ and t₂; it points along the slip velocity.
    pub friction: [f64; 2],
}

/// Derivatives of (N, F₁, F₂), one row a force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactTangent {
    /// ∂(N, F₁, F₂)/∂δ \[N/m\].
    pub by_penetration: [f64; 3],
    /// ∂(N, F₁, F₂)/∂δ̇ \[N s/m\].
    pub by_penetration_rate: [f64; 3],
    /// ∂(N, F₁, F₂)/∂(v₁, v₂) \[N s/m\].
    pub by_slip_velocity: [[f64; 2]; 3],
}

/// A contact law: (motion, weight) → (forces, their Jacobian). Pure: the same input gives the same output.
///
/// `weight` is the contact length or area that the point stands for \[m or m²\], or its share of one when the
/// law's stiffness is that of a single point: N is proportional to it.
pub trait ContactLaw: Debug + Send + Sync {
    /// Forces and Jacobian at one point.
    fn respond(&self, motion: &ContactMotion, weight: f64) -> (ContactForces, ContactTangent);
}
