//! From a TOML file to a validated [`Case`], in two stages: what the file says, then what it means.
//!
//! Quantities are numbers in SI or strings with a unit (`"1 mm"`). Unknown keys are refused, and every fault is
//! reported at once with its line. A [`Case`] is complete: every default is filled in, and its TOML form
//! ([`Case::to_toml`]) reads back as the same case.

mod calibrate;
mod explore;
mod expression;
mod frf;
mod keys;
mod matrices;
mod measured;
mod mesh;
mod parameter;
mod places;
mod read;
pub(crate) mod reader;
mod sound;
mod test_file;
mod transient;
pub(crate) mod units;

pub(crate) use calibrate::read_parameter;
pub use calibrate::{CalibrateAnalysis, CalibratedParameter, SQUEAL};
pub use expression::{Dual, evaluate};
pub use frf::{FrfAnalysis, FrfContact, FrfQuantity, FrfSolution, MotionAt};
pub(crate) use keys::keys_of;
pub use matrices::{Factor, Matrices, MatrixTerm};
pub use measured::{MeasuredData, Transform};
pub use mesh::{GeneratedMesh, MeshSource, RigMesh};
pub(crate) use parameter::path_matches;
pub use parameter::{Invalidates, Parameter};
pub use places::Places;
pub(crate) use read::DOF_NAMES;
pub use read::read_case;
pub use sound::{AirChoice, Microphone, ON_AXIS, SoundAnalysis};
pub use test_file::read_test;
pub use transient::{
    Course, Disturbance, ModelChoice, Probe, PushedRegion, SchemeChoice, Slide, StartChoice,
    TransientAnalysis,
};

use crate::structure::{Material, Section};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Everything a run needs to know. Maps are keyed by the names that the user chose, or by mesh regions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// One line for reports.
    pub title: String,
    /// What the source of the case does not state, one sentence each; shown in every report.
    pub assumptions: Vec<String>,
    /// Whether the preload's geometric stiffness counts.
    pub prestress: bool,
    /// The folder that relative paths start from.
    #[serde(skip)]
    pub folder: PathBuf,
    /// Where its keys stand in the file.
    #[serde(skip)]
    pub places: Places,
    /// The mesh, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSource>,
    /// M, C and K from files, instead of a mesh and what stands on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matrices: Option<Matrices>,
    /// Nodes given by their coordinates \[m\]; each is a region of one point under its name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub point: BTreeMap<String, [f64; 3]>,
    /// Materials by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub material: BTreeMap<String, Material>,
    /// Plates by region.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub shell: BTreeMap<String, Shell>,
    /// Bars by region.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bar: BTreeMap<String, Bar>,
    /// Concentrated masses by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub mass: BTreeMap<String, Mass>,
    /// Springs with dashpots by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub spring: BTreeMap<String, SpringSet>,
    /// Rigid bodies by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub rigid: BTreeMap<String, Rigid>,
    /// Supports by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub support: BTreeMap<String, Held>,
    /// External forces by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub force: BTreeMap<String, Force>,
    /// Contact pairs by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub contact: BTreeMap<String, Contact>,
    /// Damping of the whole structure.
    pub damping: StructureDamping,
    /// Real-mode analyses by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub modes: BTreeMap<String, ModesAnalysis>,
    /// Complex eigenvalue analysis, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cea: Option<CeaAnalysis>,
    /// Sensitivities of complex eigenvalues and advice, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<SensitivityAnalysis>,
    /// Motion in time, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transient: Option<TransientAnalysis>,
    /// Frequency responses by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub frf: BTreeMap<String, FrfAnalysis>,
    /// What tests found, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub measured: BTreeMap<String, MeasuredData>,
    /// Scalars to be found from measured frequencies, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibrate: Option<CalibrateAnalysis>,
    /// Complex eigenvalues along one scalar, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub sweep: BTreeMap<String, SweepAnalysis>,
    /// Complex eigenvalues over two scalars, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub map: BTreeMap<String, MapAnalysis>,
}

/// Contact points that are given, not found on a mesh.
///
/// A direction is a sum of degrees of freedom counted from 1, each with an optional factor before it:
/// `12 -45` is u₁₂ − u₄₅, `-3 +0.5*7` is −u₃ + ½ u₇. The normal closes the contact when u moves along it; the tangents
/// are the displacement of the body relative to the counter-body along and across the sliding direction.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ContactPoints {
    /// A table (CSV) with the columns `normal`, `t1` and, when there are any, `t2`, `weight` (1), `gap` (0) \[m\],
    /// `x`, `y`, `z` \[m\].
    File(String),
    /// Rows of `normal`, `t1` and, when there is one, `t2`.
    Rows(Vec<Vec<String>>),
}

/// A plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shell {
    /// Material by name.
    pub material: String,
    /// h \[m\].
    pub thickness: f64,
    /// Holds the membrane.
    pub bending_only: bool,
    /// Counts rotary inertia.
    pub rotary_inertia: bool,
}

/// A bar.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bar {
    /// Material by name.
    pub material: String,
    /// A vector in the plane of the section's first axis.
    pub orientation: [f64; 3],
    /// Its section.
    #[serde(flatten)]
    pub profile: Profile,
}

/// The section of a bar: a diameter that is a scalar of the case, or its properties in full.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Profile {
    /// A full round bar.
    Round {
        /// d \[m\].
        diameter: f64,
    },
    /// Any section.
    Full {
        /// Its properties.
        section: Section,
    },
}

impl Profile {
    /// The properties of the section.
    pub fn section(&self) -> Section {
        match *self {
            Profile::Round { diameter } => Section::round(diameter),
            Profile::Full { section } => section,
        }
    }
}

/// A concentrated mass at every point of a region.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mass {
    /// The region.
    pub on: String,
    /// m \[kg\] at each node.
    pub mass: f64,
    /// Moments of inertia about x, y, z \[kg m²\].
    pub inertia: [f64; 3],
}

/// Springs from the nodes of a region to the ground, or from one point to another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpringSet {
    /// The region whose nodes are sprung; the stiffness is shared equally among them.
    pub on: String,
    /// A region of one point at the other end; the ground when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// Direction.
    pub direction: [f64; 3],
    /// Acts on rotations.
    pub rotational: bool,
    /// Total k \[N/m or N m\].
    pub stiffness: f64,
    /// Total c \[N s/m or N m s\].
    pub damping: f64,
}

/// Regions that move as one rigid body with a point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rigid {
    /// A region of one point.
    pub master: String,
    /// The regions that follow.
    pub follow: Vec<String>,
}

/// Held degrees of freedom of regions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Held {
    /// The regions.
    pub on: Vec<String>,
    /// Names of held degrees of freedom among ux, uy, uz, rx, ry, rz.
    pub held: Vec<String>,
}

/// A force shared equally by the nodes of a region.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Force {
    /// The region.
    pub on: String,
    /// Total force \[N\].
    pub force: [f64; 3],
}

/// What presses a contact pair together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Pressing {
    /// ΣN \[N\].
    Load(f64),
    /// Approach \[m\].
    Approach(f64),
}

/// A contact pair.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contact {
    /// The contact points themselves; only with matrices, where they stand for the regions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<ContactPoints>,
    /// Region of the body: rim lines, a face, or a point.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub body: String,
    /// Region of the counter-body, or `ground`.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub counter: String,
    /// Direction in which the body moves into the ground; only for a contact with the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub into: Option<[f64; 3]>,
    /// Contact points across the thickness of a rim: 2, one at each edge, or 1, in the middle.
    pub points_across: usize,
    /// Points with a larger initial gap are left out \[m\].
    pub reach: f64,
    /// What presses the pair together.
    #[serde(flatten)]
    pub pressing: Pressing,
    /// V \[m/s\] of the counter-body relative to the body along the sliding direction.
    pub sliding_velocity: f64,
    /// How far the counter-body travels in all along the sliding direction \[m\]; it must stay under the body.
    pub stroke: f64,
    /// Direction in which the counter-body slides.
    pub sliding_direction: [f64; 3],
    /// Tilts and moves everything connected to the body; as meshed when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// Normal law.
    pub normal: Normal,
    /// Friction law.
    pub friction: Friction,
    /// What bends before a point slips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bristle: Option<BristleChoice>,
}

/// Elastic bristles between the bodies, for sticking in time; in the unit of the normal stiffness.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BristleChoice {
    /// k_t.
    pub stiffness: f64,
    /// c_t.
    pub damping: f64,
}

/// Where the body stands on the counter-body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Placement {
    /// θ \[rad\]: body and all that hangs on it rotated about the lateral axis y through the body's centre; the
    /// lowest point moves towards −x when θ > 0.
    pub lead_angle: f64,
    /// x, y of the lowest point, from the middle of the counter-body's region \[m\].
    pub position: [f64; 2],
}

/// What a contact stiffness belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StiffnessPer {
    /// The one point nearest to the counter-body \[N/m\].
    Point,
    /// Length of a line contact \[N/m²\].
    Length,
    /// Area of a face contact \[N/m³\].
    Area,
}

/// N = k_n δ + k_nl δ³ + c_n δ̇.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Normal {
    /// What the coefficients belong to.
    pub per: StiffnessPer,
    /// k_n.
    pub stiffness: f64,
    /// k_nl.
    pub cubic: f64,
    /// c_n.
    pub damping: f64,
    /// Never pulls.
    pub unilateral: bool,
}

/// μ(v, p).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Friction {
    /// The friction coefficient.
    #[serde(flatten)]
    pub law: FrictionCurve,
    /// v_ε \[m/s\] of the regularised slip direction.
    pub regularisation: f64,
    /// Which way friction pulls the body.
    pub sense: Sense,
}

/// Which way friction pulls the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sense {
    /// Along the velocity of the counter-body relative to the body, as friction does.
    WithSlip,
    /// Against the sliding direction whatever the slip, for the comparison with equations that are written so.
    AgainstSliding,
}

/// The curve of the friction coefficient.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "law", rename_all = "snake_case")]
pub enum FrictionCurve {
    /// μ = μ₀.
    Coulomb {
        /// μ₀.
        mu0: f64,
    },
    /// μ = μ₀ + μ₁ exp(−α|v|).
    Exponential {
        /// μ₀.
        mu0: f64,
        /// μ₁.
        mu1: f64,
        /// α \[s/m\].
        alpha: f64,
    },
    /// μ = μ_k + (μ_s − μ_k) exp(−(|v|/v_s)^δ).
    Stribeck {
        /// μ_s.
        mu_static: f64,
        /// μ_k.
        mu_kinetic: f64,
        /// v_s \[m/s\].
        stribeck_velocity: f64,
        /// δ.
        exponent: f64,
    },
    /// μ = μ_s/(1 + a|v|).
    Hyperbolic {
        /// μ_s.
        mu_static: f64,
        /// a \[s/m\].
        decline: f64,
    },
    /// μ over slip velocity and pressure.
    Table {
        /// Slip velocities \[m/s\], ascending.
        velocity: Vec<f64>,
        /// Pressures (N per length, area or point), ascending; one entry when μ does not depend on it.
        pressure: Vec<f64>,
        /// One row a pressure, one column a velocity.
        mu: Vec<Vec<f64>>,
    },
}

/// Damping of the whole structure beyond its materials'.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct StructureDamping {
    /// ζ of every real mode below `modal_below`.
    pub modal_ratio: f64,
    /// ζ of single modes instead: (frequency near the mode \[Hz\], ζ).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub modal_ratios: Vec<[f64; 2]>,
}

/// The contact during a real-mode analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactState {
    /// No contact.
    Open,
    /// The contact's normal stiffness at steady sliding, without friction.
    Closed,
}

/// Real modes of parts or of the whole.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModesAnalysis {
    /// Regions of shells and bars; all of them when empty.
    pub parts: Vec<String>,
    /// Regions held in all degrees of freedom in this analysis only.
    pub clamp: Vec<String>,
    /// Supports, springs and rigid bodies of the case are left out.
    pub free: bool,
    /// All modes below this frequency \[Hz\] …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below: Option<f64>,
    /// … or this many.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Contact open or closed.
    pub contact: ContactState,
    /// Computed frequencies are multiplied by this before they are compared: an unknown thickness or modulus.
    pub frequency_scale: f64,
    /// Measured natural frequencies \[Hz\] to set beside the computed ones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<f64>,
    /// Where they come from.
    pub measured_source: String,
    /// Writes the shapes as a universal file too.
    pub uff: bool,
}

/// Complex eigenvalues at steady sliding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CeaAnalysis {
    /// Frequency band \[Hz\]; the pairs nearest to a frequency are sought inside.
    pub band: [f64; 2],
    /// Only the pairs whose λ is nearest to iω of this frequency \[Hz\] …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<f64>,
    /// … this many of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Real modes up to this frequency span the first subspace \[Hz\].
    pub basis_below: f64,
    /// Counts the unstable eigenvalues of the band, to certify that none was missed: always, never, or, when not said,
    /// where it takes seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certify: Option<bool>,
    /// Looks for the same modes again by a second, independent method on the full order.
    pub confirm: bool,
    /// Whether the left vectors are among the results, which take as much memory as the right ones. Sensitivities and a run
    /// in time need them, and keep them all the same.
    pub left_vectors: bool,
    /// Measured squeal frequencies \[Hz\].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured_squeal: Vec<f64>,
    /// Where they come from.
    pub measured_source: String,
}

/// How complex eigenvalues answer the scalars of the case, and small things mounted on its nodes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensitivityAnalysis {
    /// The complex modes nearest to these frequencies \[Hz\]; the unstable ones when empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<f64>,
    /// Paths of scalars; a `*` stands for any letters, so that `*` alone is all of them.
    pub parameters: Vec<String>,
    /// Whether to work out where a mass, a spring or a damper helps.
    pub advice: bool,
    /// The mass that the advice speaks of \[kg\].
    pub mass: f64,
    /// The constant of the damper that the advice speaks of \[N s/m\].
    pub damper: f64,
    /// Mounts the best mass and the best damper of each mode, and runs the analysis anew.
    pub verify: bool,
}

impl Default for SensitivityAnalysis {
    fn default() -> Self {
        SensitivityAnalysis {
            modes: Vec::new(),
            parameters: vec!["*".into()],
            advice: true,
            mass: 1e-3,
            damper: 1.0,
            verify: false,
        }
    }
}

/// Complex eigenvalues along one scalar of the case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepAnalysis {
    /// The path of the scalar.
    pub parameter: String,
    /// Its first value.
    pub from: f64,
    /// Its last value.
    pub to: f64,
    /// How many values.
    pub points: usize,
    /// Equal ratios instead of equal steps.
    pub log: bool,
}

/// Complex eigenvalues over a grid of two scalars of the case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapAnalysis {
    /// The paths of the scalars.
    pub parameters: [String; 2],
    /// Their first values.
    pub from: [f64; 2],
    /// Their last values.
    pub to: [f64; 2],
    /// How many values of each.
    pub points: [usize; 2],
    /// Equal ratios instead of equal steps.
    pub log: [bool; 2],
}

impl Case {
    /// The same case without its sweeps and maps, as each of their points is.
    pub fn without_sweeps(&self) -> Case {
        Case { sweep: BTreeMap::new(), map: BTreeMap::new(), ..self.clone() }
    }

    /// The case as TOML in SI units with every default written out.
    pub fn to_toml(&self) -> String {
        toml::to_string(self)
            .expect("a case is made of tables, lists, strings and numbers that TOML can hold")
    }
}
