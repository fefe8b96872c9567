//! From a TOML file to a validated [`Case`], in two stages: what the file says, then what it means.
//!
//! Quantities are numbers in SI or strings with a unit (`"1 mm"`). Unknown keys are refused, and every fault is
//! reported at once with its line. A [`Case`] is complete: every default is filled in, and its TOML form
//! ([`Case::to_toml`]) reads back as the same case. Every key is declared once ([`crate::schema`]).

mod absent;
mod analyses;
mod calibrate;
mod check;
mod consistent;
mod contact;
mod equation;
mod explore;
mod expression;
mod frf;
mod matrices;
mod measured;
mod mesh;
mod model;
mod names;
mod parameter;
mod rotation;
mod sound;
mod structure;
mod test_file;
#[cfg(test)]
mod tests;
mod transient;
mod uncertainty;
mod varied;

pub use analyses::{CeaAnalysis, ContactState, ModesAnalysis, SensitivityAnalysis};
pub use calibrate::{CalibrateAnalysis, SQUEAL};
pub use contact::{
    BristleChoice, Contact, ContactPoints, ContactRotation, Friction, FrictionCurve, InitialGap, Normal,
    Placement, Pressing, Sense, SlidingChoice, StiffnessPer,
};
pub use equation::Equation;
pub use explore::{MapAnalysis, SweepAnalysis};
pub use expression::{Dual, evaluate};
pub use frf::{FrfAnalysis, FrfContact, FrfQuantity, FrfSolution, MotionAt, UniversalForm};
pub use matrices::{Factor, Matrices, MatrixTerm};
pub use measured::{MeasuredData, Transform};
pub use mesh::{AnnulusMesh, LengthUnit, MeshSource, PlateMesh, RigMesh};
pub(crate) use model::DOF_NAMES;
pub use model::{
    Averaging, Axis, Bar, Force, ForceChoice, Held, Mass, Profile, Rigid, Shell, Solid, SpringPer, SpringSet,
    StructureDamping, Tie,
};
pub use parameter::VariedCase;
pub(crate) use parameter::path_matches;
pub use rotation::Rotation;
pub use sound::{AirChoice, Microphone, ON_AXIS, SoundAnalysis};
pub use test_file::read_test;
pub use transient::{
    CONTACT_TOLERANCE, Course, Disturbance, HoldChoice, ModelChoice, Probe, PushedRegion, SchemeChoice,
    Slide, StartChoice, TransientAnalysis,
};
pub use uncertainty::UncertaintyAnalysis;
pub use varied::VariedParameter;
pub(crate) use varied::check_parameter;

pub use crate::schema::{Invalidates, Places, Scalar as Parameter};

use crate::error::Result;
use crate::error::read::read_text;
use crate::schema::units::LENGTH;
use crate::schema::{Report, declare, key, read_table, to_toml};
use crate::structure::Material;
use consistent::Consistent;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

declare! {
    /// Everything a run needs to know. Maps are keyed by the names that the user chose, or by mesh regions.
    pub struct Case, checked by check_case {
        /// One line for reports.
        pub title: String = key::text().or("untitled".into()),
        /// Assumptions that the source of the case does not state, one sentence each; shown in every report.
        pub assumptions: Vec<String> = key::texts(),
        /// Whether the preload's geometric stiffness counts.
        pub prestress: bool = key::flag(false),
        /// The mesh, if any.
        pub mesh: Option<MeshSource> = key::table().optional(),
        /// M, C and K from files, instead of a mesh and what stands on it.
        pub matrices: Option<Matrices> = key::table().optional(),
        /// Nodes given by their coordinates \[m\]; each is a region of one point under its name.
        pub point: BTreeMap<String, [f64; 3]> = key::values(
            || key::quantities(LENGTH),
            "a name of at least one character, on one line",
            key::is_name,
        ),
        /// Materials by name.
        pub material: BTreeMap<String, Material> = key::named(),
        /// Plates by region.
        pub shell: BTreeMap<String, Shell> = key::named(),
        /// Bars by region.
        pub bar: BTreeMap<String, Bar> = key::named(),
        /// Solids by region.
        pub solid: BTreeMap<String, Solid> = key::named(),
        /// Concentrated masses by name.
        pub mass: BTreeMap<String, Mass> = key::named(),
        /// Springs with dashpots by name.
        pub spring: BTreeMap<String, SpringSet> = key::named(),
        /// Rigid bodies by name.
        pub rigid: BTreeMap<String, Rigid> = key::named(),
        /// Points that move as regions do in the mean, by name.
        pub averaging: BTreeMap<String, Averaging> = key::named(),
        /// Surfaces that are joined although their meshes do not match, by name.
        pub tie: BTreeMap<String, Tie> = key::named(),
        /// Linear constraints between degrees of freedom, by name.
        pub equation: BTreeMap<String, Equation> = key::named(),
        /// Supports by name.
        pub support: BTreeMap<String, Held> = key::named(),
        /// Steady rotations of parts by name.
        pub rotation: BTreeMap<String, Rotation> = key::named(),
        /// External forces by name.
        pub force: BTreeMap<String, Force> = key::named().invalidates(Invalidates::Equilibrium),
        /// Contact pairs by name.
        pub contact: BTreeMap<String, Contact> = key::named(),
        /// Damping of the whole structure.
        pub damping: StructureDamping = key::table().invalidates(Invalidates::Damping),
        /// Real-mode analyses by name.
        pub modes: BTreeMap<String, ModesAnalysis> = key::named().invalidates(Invalidates::Question),
        /// Complex eigenvalue analysis, if asked for.
        pub cea: Option<CeaAnalysis> = key::table().invalidates(Invalidates::Question).optional(),
        /// Sensitivities of complex eigenvalues and advice, if asked for.
        pub sensitivity: Option<SensitivityAnalysis> = key::table().invalidates(Invalidates::Question).optional(),
        /// Motion in time, if asked for.
        pub transient: Option<TransientAnalysis> = key::table().invalidates(Invalidates::Question).optional(),
        /// Frequency responses by name.
        pub frf: BTreeMap<String, FrfAnalysis> = key::named().invalidates(Invalidates::Question),
        /// Measured modes and frequency responses, by name.
        pub measured: BTreeMap<String, MeasuredData> = key::named().invalidates(Invalidates::Question),
        /// Scalars to be found from measured frequencies, if asked for.
        pub calibrate: Option<CalibrateAnalysis> = key::table().invalidates(Invalidates::Question).optional(),
        /// Complex eigenvalues along one scalar, by name.
        pub sweep: BTreeMap<String, SweepAnalysis> = key::named().invalidates(Invalidates::Question),
        /// Complex eigenvalues over two scalars, by name.
        pub map: BTreeMap<String, MapAnalysis> = key::named().invalidates(Invalidates::Question),
        /// Complex eigenvalues of samples of uncertain scalars, by name.
        pub uncertainty: BTreeMap<String, UncertaintyAnalysis> = key::named().invalidates(Invalidates::Question),
    }
    also {
        /// The folder that relative paths start from.
        pub folder: PathBuf,
        /// Where its keys stand in the file.
        pub places: Places,
    }
}

/// Refuses what does not go together.
fn check_case(case: &Case, report: &mut Report) {
    case.check(report);
}

/// Reads and validates the case file at `path`.
///
/// # Errors
/// Every fault of the file, each with its line and key.
pub fn read_case(path: &Path) -> Result<Case> {
    let text = read_text(path, "a case file in TOML, such as `stridor new NAME` writes")?;
    let folder = path.parent().unwrap_or(Path::new(".")).to_path_buf();
    Case::parse(&path.display().to_string(), &text, folder)
}

impl Case {
    /// Whether external forces alone stress the structure, with the stiffness of that preload.
    pub fn stressed_by_forces(&self) -> bool {
        self.prestress && self.contact.is_empty()
    }

    /// Reads a case from TOML text; `file` names it in faults and `folder` is where relative paths start. A case that is no
    /// file has an empty name: its faults have keys and no lines.
    ///
    /// # Errors
    /// Every fault of the text, each with its line and key.
    pub fn parse(file: &str, text: &str, folder: PathBuf) -> Result<Case> {
        let read = read_table::<Case>(file, text).map_err(absent::explained)?;
        let mut case = Case { folder, places: read.places.of_text(text), ..read.table };
        case.expect_own_values();
        Ok(case)
    }

    /// The same case without what names scalars of it, as each point of a sweep is: sweeps, maps, uncertain scalars, sensitivities,
    /// calibration.
    pub fn without_studies(&self) -> Case {
        let (sweep, map, uncertainty) = Default::default();
        Case { sweep, map, uncertainty, sensitivity: None, calibrate: None, ..self.clone() }
    }

    /// Whether something in it names scalars of it.
    fn has_studies(&self) -> bool {
        let Case { sweep, map, uncertainty, .. } = self;
        let none = sweep.is_empty() && map.is_empty() && uncertainty.is_empty();
        !none || self.sensitivity.is_some() || self.calibrate.is_some()
    }

    /// The case as TOML in SI units with every default written out.
    pub fn to_toml(&self) -> String {
        to_toml(self).to_string()
    }
}
