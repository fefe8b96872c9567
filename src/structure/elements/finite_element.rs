//! Interface of a finite element, of any number of nodes and freedoms.

use super::ElementMatrix;
use crate::structure::{Material, RotationAxis};

/// The components (ux, uy, uz, rx, ry, rz) of a node.
const ALL: &[usize] = &[0, 1, 2, 3, 4, 5];

/// An element of any size.
///
/// Its matrices are n × n in global axes, with n = nodes × components: row c + k · `components().len()` belongs to the
/// component `components()[c]` of the displacement of node k. A matrix to be filled comes with n rows, all zero;
/// `false` means that the element adds nothing to it.
pub trait FiniteElement: Send + Sync {
    /// Its nodes.
    fn nodes(&self) -> &[usize];

    /// Which of (ux, uy, uz, rx, ry, rz) of each of its nodes it knows, ascending: all six of plates and bars, the first
    /// three of solids.
    fn components(&self) -> &'static [usize] {
        ALL
    }

    /// n, the number of its freedoms.
    fn n_freedoms(&self) -> usize {
        self.nodes().len() * self.components().len()
    }

    /// The directions in which it gives its nodes stiffness or mass.
    fn acting(&self) -> Acting {
        match self.components() {
            components if components == ALL => Acting::Everywhere,
            components => {
                let unit = |k: &usize| std::array::from_fn(|i| if i == *k { 1.0 } else { 0.0 });
                Acting::Along(components.iter().map(unit).collect())
            }
        }
    }

    /// Whether its nodes leave it without length, area or orientation; its matrices may then not be computed.
    fn is_degenerate(&self) -> bool {
        false
    }

    /// Material: Rayleigh damping C = α M + β K and loss factor, η K. `None` for an element without damping or with its own.
    fn material(&self) -> Option<&Material> {
        None
    }

    /// K \[N/m, N, N m\].
    fn stiffness(&self, _k: &mut ElementMatrix) -> bool {
        false
    }

    /// M \[kg, kg m, kg m²\].
    fn mass(&self, _m: &mut ElementMatrix) -> bool {
        false
    }

    /// Whether it has a [`FiniteElement::dashpot`].
    fn has_dashpot(&self) -> bool {
        false
    }

    /// C \[N s/m, …\] beyond that of its material.
    fn dashpot(&self, _c: &mut ElementMatrix) -> bool {
        false
    }

    /// K_σ of the membrane or axial forces that the displacement of all nodes of the model gives it, linear in it.
    fn geometric_stiffness(&self, _displacement: &[[f64; 6]], _k: &mut ElementMatrix) -> bool {
        false
    }

    /// D = ∫ ρ Nᵀ ∂_θN dV and T = ∫ ρ (∂_θN)ᵀ ∂_θN dV \[kg, kg m, kg m²\] of an element that turns about an axis, ∂_θ = (e × (x − x₀))·∇
    /// ([`crate::structure::Rotation`]).
    fn transport(&self, _axis: &RotationAxis, _matrices: [&mut ElementMatrix; 2]) -> bool {
        false
    }

    /// Mass \[kg\] and its centre \[m\].
    fn mass_and_center(&self) -> (f64, [f64; 3]);

    /// (ux, uy, uz, rx, ry, rz) of a point of its face for a unit of each of its n freedoms; `None` of an element
    /// without faces. Rigid motions are met exactly.
    fn displacement_at(&self, _at: &FacePoint) -> Option<Vec<[f64; 6]>> {
        None
    }

    /// How far its theory is off for modes at `frequency_hz`; `None` where it holds at any frequency that its mesh resolves.
    fn theory_error(&self, _frequency_hz: f64) -> Option<TheoryError> {
        None
    }

    /// k \[rad/m\] of its bending waves at `frequency_hz`; `None` of an element without such waves.
    fn bending_wavenumber(&self, _frequency_hz: f64) -> Option<f64> {
        None
    }
}

/// The directions in which an element acts on each of its nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Acting {
    /// All six.
    Everywhere,
    /// Combinations of (ux, uy, uz, rx, ry, rz).
    Along(Vec<[f64; 6]>),
}

/// A point of the face of an element: on the triangle of three of its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacePoint {
    /// The corners of the triangle, as nodes of the model.
    pub corners: [usize; 3],
    /// Barycentric coordinates on it.
    pub barycentric: [f64; 3],
}

/// How far the theory of a plate is off at a frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheoryError {
    /// kh at that frequency.
    pub wavenumber_times_thickness: f64,
    /// Expected relative error of the frequency of a mode, positive when it comes out too high.
    pub relative_error: f64,
}
