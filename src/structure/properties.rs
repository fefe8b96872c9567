//! What parts, point masses and springs are, as plain data.

use super::elements::waves::shear_coefficient;
use super::material::Material;
use super::section::Section;
use crate::schema::choices;
use nalgebra::Vector3;

choices! {
    /// Plate theory of bending.
    pub enum PlateTheory {
        /// Rigid in transverse shear: thin plates.
        Kirchhoff = "kirchhoff",
        /// Transverse shear and rotary inertia (Mindlin, Reissner): thin and thick plates.
        Mindlin = "mindlin",
    }
}

choices! {
    /// Quadrature of the stiffness of 20-node hexahedra.
    pub enum Integration {
        /// 3 × 3 × 3 points, or more where edges are curved: exact.
        Full = "full",
        /// 2 × 2 × 2 points, as C3D20R of Abaqus and CalculiX: softer in bending, and less stiff where
        /// ν is near ½; a thousandth of the full stiffness holds its hourglass modes.
        Reduced = "reduced",
    }
}

/// A plate of constant thickness.
#[derive(Debug, Clone)]
pub struct Shell {
    /// Material.
    pub material: Material,
    /// h \[m\].
    pub thickness: f64,
    /// Plate theory of bending.
    pub theory: PlateTheory,
    /// κ of Mindlin's theory; `None` for 5/(6−ν), see [`Shell::shear_coefficient`].
    pub shear_coefficient: Option<f64>,
    /// Holds the membrane: displacements in the plate's plane and the rotation about its normal.
    pub bending_only: bool,
    /// Counts the rotary inertia ρh³/12 of the cross-section.
    pub rotary_inertia: bool,
}

/// A bar of constant section.
#[derive(Debug, Clone)]
pub struct Bar {
    /// Material.
    pub material: Material,
    /// Its section.
    pub section: Section,
    /// A vector in the plane of the section's first axis; any that is not along the bar.
    pub orientation: [f64; 3],
}

/// A solid.
#[derive(Debug, Clone)]
pub struct Solid {
    /// Material.
    pub material: Material,
    /// Quadrature of 20-node hexahedra; other cells have one of their own.
    pub integration: Integration,
}

impl Solid {
    /// Of a material, fully integrated.
    pub fn new(material: Material) -> Self {
        Solid { material, integration: Integration::Full }
    }
}

impl Shell {
    /// A thin plate of thickness h \[m\], its membrane free, its rotary inertia counted.
    pub fn new(material: Material, thickness: f64) -> Self {
        Shell {
            material,
            thickness,
            theory: PlateTheory::Kirchhoff,
            shear_coefficient: None,
            bending_only: false,
            rotary_inertia: true,
        }
    }

    /// κ of the transverse shear force κ G h γ by Mindlin's theory.
    ///
    /// 5/(6−ν) unless another is given: with it, bending waves are as slow as those of three-dimensional elasticity to the
    /// order (kh)², the measure by which Kirchhoff's theory is judged ([`super::thickness_error`]).
    pub fn shear_coefficient(&self) -> f64 {
        self.shear_coefficient.unwrap_or_else(|| shear_coefficient(self.material.poissons_ratio))
    }
}

/// A mass at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointMass {
    /// The node.
    pub node: usize,
    /// m \[kg\], the same along x, y and z.
    pub mass: f64,
    /// Moments of inertia about x, y, z \[kg m²\].
    pub inertia: [f64; 3],
}

/// A spring with a dashpot between two nodes, or a node and the ground: it acts on the difference of their
/// displacement along `direction` (of their rotation about it, when `rotational`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// One end.
    pub node: usize,
    /// The other end; `None` for the ground.
    pub other: Option<usize>,
    /// Its direction, of any length.
    pub direction: [f64; 3],
    /// Whether it acts on rotations.
    pub rotational: bool,
    /// k \[N/m or N m/rad\].
    pub stiffness: f64,
    /// c \[N s/m or N m s/rad\].
    pub damping: f64,
}

/// A line about which a body turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotationAxis {
    /// x₀ \[m\], a point on it.
    pub point: [f64; 3],
    /// e, a unit vector.
    pub direction: [f64; 3],
}

impl RotationAxis {
    /// x − x₀ without what is along the axis: r \[m\].
    pub fn arm(&self, x: [f64; 3]) -> Vector3<f64> {
        let (e, way) = (Vector3::from(self.direction), Vector3::from(x) - Vector3::from(self.point));
        way - e * e.dot(&way)
    }

    /// e × (x − x₀) \[m\]: the velocity at x for Ω = 1 rad/s.
    pub fn velocity(&self, x: [f64; 3]) -> Vector3<f64> {
        Vector3::from(self.direction).cross(&(Vector3::from(x) - Vector3::from(self.point)))
    }
}

/// Parts of a model that turn about one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotation {
    /// Their names.
    pub parts: Vec<String>,
    /// The axis.
    pub axis: RotationAxis,
    /// Ω \[rad/s\], positive by the right hand about the axis.
    pub speed: f64,
    /// Whether G counts.
    pub gyroscopic: bool,
    /// Whether −Ω² T counts.
    pub transport: bool,
    /// Whether K_σ counts.
    pub spin_stiffness: bool,
}
