//! Contact law: a pure function from the motion at a point to forces and their derivatives.

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
    /// ∂(N, F₁, F₂)/∂Δ \[N/m\], Δ how far the counter-body has slid past the body along t₁ and t₂; of points that stick elastically.
    pub by_slid: [[f64; 2]; 3],
}

impl ContactTangent {
    /// The stiffness along g, t₁ and t₂ \[N/m\]: ∂N/∂δ, and that of the elastic deflection of a point that sticks.
    pub fn springs(&self) -> [f64; 3] {
        [self.by_penetration[0], self.by_slid[1][0], self.by_slid[2][1]]
    }

    /// The derivatives where these springs are part of the structure.
    #[must_use]
    pub fn without(mut self, [normal, along, across]: [f64; 3]) -> Self {
        self.by_penetration[0] -= normal;
        self.by_slid[1][0] -= along;
        self.by_slid[2][1] -= across;
        self
    }
}

/// How far a point slid in a time step, and what it remembers of the steps before.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlipStep {
    /// s \[m\] along t₁ and t₂: by how much the bristles of the point were bent when the step began.
    pub bristle: [f64; 2],
    /// Δ \[m\]: ∫v dt over the step.
    pub slid: [f64; 2],
    /// Δt \[s\].
    pub duration: f64,
    /// **F** \[N\]: the last iterate of friction at the end of the step; for a law that is set-valued at rest.
    pub friction: [f64; 2],
    /// ρ > 0 \[N s/m\]: what scales the slip velocity beside **F**, see [`SlipAnswer::by_friction`].
    pub resistance: f64,
}

/// Forces and tangents of a law at the end of a time step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlipAnswer {
    /// The forces.
    pub forces: ContactForces,
    /// Their derivatives by the motion at the end of the step, Δ held.
    pub tangent: ContactTangent,
    /// ∂(F₁, F₂)/∂**F** of the last iterate: that of the resolvent where the law is set-valued at rest, whose answer is a
    /// function of **F** + ρ **v** and right where it equals **F**. Zero for other laws.
    pub by_friction: [[f64; 2]; 2],
    /// s \[m\] at the end of the step.
    pub bristle: [f64; 2],
    /// Whether the point did not slip.
    pub sticks: bool,
}

/// Friction of a contact law at zero slip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrictionAtRest {
    /// Any force up to μ(0) N.
    SetValued,
    /// The force of bristles.
    Elastic,
    /// None: it falls to zero over a range of slip.
    Smoothed,
    /// As at any slip: its direction is fixed.
    AsInSlip,
}

/// A contact law: (motion, weight) → (forces, their Jacobian). Pure: the same input gives the same output.
///
/// `weight` is the contact length or area that the point stands for \[m or m²\], or its share of one when the
/// law's stiffness is that of a single point: N is proportional to it.
pub trait ContactLaw: Debug + Send + Sync {
    /// Forces and Jacobian at one point.
    fn respond(&self, motion: &ContactMotion, weight: f64) -> (ContactForces, ContactTangent);

    /// Forces at the end of a time step, for a law that remembers. One that does not answers as ever.
    fn advance(&self, motion: &ContactMotion, _since: &SlipStep, weight: f64) -> SlipAnswer {
        let (forces, tangent) = self.respond(motion, weight);
        SlipAnswer { forces, tangent, ..SlipAnswer::default() }
    }

    /// Forces and Jacobian at one point of a pair that does not slide, at rest under a load: δ \[m\], and Δ \[m\], how far the
    /// counter-body has moved past the body along t₁ and t₂ since nothing pressed them. Without friction but in laws that stick elastically.
    fn hold(&self, penetration: f64, _slid: [f64; 2], weight: f64) -> (ContactForces, ContactTangent) {
        let motion = ContactMotion { penetration, penetration_rate: 0.0, slip_velocity: [0.0; 2] };
        let (forces, tangent) = self.respond(&motion, weight);
        let [normal, ..] = tangent.by_penetration;
        let tangent = ContactTangent { by_penetration: [normal, 0.0, 0.0], ..ContactTangent::default() };
        (ContactForces { friction: [0.0; 2], ..forces }, tangent)
    }

    /// Friction at zero slip.
    fn at_rest(&self) -> FrictionAtRest {
        FrictionAtRest::AsInSlip
    }

    /// Whether friction at rest is any force up to μ(0) N, so that it follows from the motion of the whole only.
    fn is_set_valued(&self) -> bool {
        self.at_rest() == FrictionAtRest::SetValued
    }

    /// How far steady friction **F** \[N\] has bent the bristles of a point: s \[m\].
    fn bent(&self, _friction: [f64; 2], _weight: f64) -> [f64; 2] {
        [0.0; 2]
    }
}
