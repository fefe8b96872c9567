//! The keywords that are read, and what is known of those that are not.

use super::reader::{Found, Reader};
use crate::ledger::Weight;
use Phase::{Elements, Nodes, Rest, Sets, Surfaces};

/// When a keyword is read: numbers before what names them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Phase {
    Nodes,
    Elements,
    Sets,
    Surfaces,
    Rest,
}

impl Phase {
    pub const ALL: [Phase; 5] = [Nodes, Elements, Sets, Surfaces, Rest];
}

/// Reads a block in a space.
type Read = fn(&mut Reader, usize, Found<'_>);

/// A keyword that is read.
pub(super) struct Keyword {
    /// Capitals, as the manual writes it.
    pub words: &'static str,
    pub phase: Phase,
    pub read: Read,
    /// Options that are read, capitals without blanks.
    pub options: &'static [&'static str],
    /// Options that change nothing here.
    pub without_effect: &'static [&'static str],
}

const fn keyword(
    words: &'static str,
    phase: Phase,
    read: Read,
    options: &'static [&'static str],
    without_effect: &'static [&'static str],
) -> Keyword {
    Keyword { words, phase, read, options, without_effect }
}

/// The table.
#[rustfmt::skip]
const KEYWORDS: &[Keyword] = &[
    keyword("BEAM GENERAL SECTION", Rest, Reader::beam_section, &["ELSET", "MATERIAL", "SECTION", "DENSITY"], &["POISSON"]),
    keyword("BEAM SECTION", Rest, Reader::beam_section, &["ELSET", "MATERIAL", "SECTION"], &["TEMPERATURE", "POISSON"]),
    keyword("BOUNDARY", Rest, Reader::boundary, &["OP"], &["FIXED", "AMPLITUDE"]),
    keyword("CHANGE FRICTION", Rest, Reader::change_interaction, &["INTERACTION"], &[]),
    keyword("CHANGE SURFACE BEHAVIOR", Rest, Reader::change_interaction, &["INTERACTION"], &[]),
    keyword("CLOAD", Rest, Reader::concentrated, &["OP"], &["AMPLITUDE"]),
    keyword("COMPLEX FREQUENCY", Rest, Reader::complex_frequency, &["FRICTIONDAMPING"], &["NORMALIZATION"]),
    keyword("CONTACT PAIR", Rest, Reader::contact_pair, &["INTERACTION", "ADJUST", "TIED"], &["TYPE", "SMALLSLIDING", "SLAVE", "MECHANICALCONSTRAINT", "EXTENSIONZONE", "NAME", "CPSET"]),
    keyword("COUPLING", Rest, Reader::coupling, &["REFNODE", "SURFACE", "CONSTRAINTNAME"], &[]),
    keyword("DAMPING", Rest, Reader::damping, &["ALPHA", "BETA", "STRUCTURAL"], &[]),
    keyword("DASHPOT", Rest, Reader::dashpot, &["ELSET", "ORIENTATION"], &[]),
    keyword("DENSITY", Rest, Reader::density, &[], &["DEPENDENCIES"]),
    keyword("DISTRIBUTING", Rest, Reader::distributing, &[], &["ALPHA", "COUPLING", "WEIGHTINGMETHOD"]),
    keyword("DISTRIBUTING COUPLING", Rest, Reader::distributing_coupling, &["ELSET"], &[]),
    keyword("DLOAD", Rest, Reader::distributed, &["OP"], &["AMPLITUDE"]),
    keyword("DSLOAD", Rest, Reader::surface_load, &["OP"], &["AMPLITUDE"]),
    keyword("ELASTIC", Rest, Reader::elastic, &["TYPE"], &["DEPENDENCIES", "MODULI"]),
    keyword("ELCOPY", Elements, Reader::copied_elements, &["ELEMENTSHIFT", "NEWSET", "OLDSET", "REFLECT", "SHIFTNODES"], &[]),
    keyword("ELEMENT", Elements, Reader::elements, &["TYPE", "ELSET"], &[]),
    keyword("ELGEN", Elements, Reader::elements_in_rows, &["ELSET"], &["ALLNODES"]),
    keyword("ELSET", Sets, Reader::element_set, &["ELSET", "GENERATE", "INSTANCE", "INTERNAL"], &[]),
    keyword("END STEP", Rest, Reader::end_step, &[], &[]),
    keyword("EQUATION", Rest, Reader::equation, &["REMOVE"], &[]),
    keyword("FREQUENCY", Rest, Reader::frequency, &[], &["STORAGE", "SOLVER", "EIGENSOLVER", "NORMALIZATION", "ACOUSTICCOUPLING", "SIM", "RESIDUALMODES"]),
    keyword("FRICTION", Rest, Reader::friction, &["ROUGH", "NONE", "EXPONENTIALDECAY"], &[]),
    keyword("HEADING", Rest, Reader::heading, &[], &[]),
    keyword("KINEMATIC", Rest, Reader::kinematic, &[], &["ALPHA"]),
    keyword("KINEMATIC COUPLING", Rest, Reader::kinematic_coupling, &["REFNODE"], &[]),
    keyword("MASS", Rest, Reader::mass, &["ELSET"], &[]),
    keyword("MATERIAL", Rest, Reader::material, &["NAME"], &[]),
    keyword("MOTION", Rest, Reader::motion, &["ROTATION", "TYPE", "DEFINITION"], &["AMPLITUDE"]),
    keyword("MPC", Rest, Reader::mpc, &[], &[]),
    keyword("NCOPY", Nodes, Reader::copied_nodes, &["CHANGENUMBER", "MULTIPLE", "NEWSET", "OLDSET", "POLE", "REFLECT", "SHIFT"], &[]),
    keyword("NFILL", Nodes, Reader::nodes_between, &["BIAS", "NSET", "SINGULAR", "TWOSTEP"], &[]),
    keyword("NGEN", Nodes, Reader::nodes_on_curves, &["LINE", "NSET", "SYSTEM"], &[]),
    keyword("NMAP", Nodes, Reader::mapped_nodes, &["DEFINITION", "NSET", "TYPE"], &[]),
    keyword("NODE", Nodes, Reader::nodes, &["NSET", "SYSTEM"], &[]),
    keyword("NSET", Sets, Reader::node_set, &["NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED"], &[]),
    keyword("ORIENTATION", Surfaces, Reader::orientation, &["NAME", "SYSTEM"], &["DEFINITION", "LOCALDIRECTIONS"]),
    keyword("RIGID BODY", Rest, Reader::rigid_body, &["REFNODE", "ELSET", "NSET", "TIENSET", "PINNSET", "ROTNODE"], &[]),
    keyword("ROTARY INERTIA", Rest, Reader::rotary_inertia, &["ELSET"], &[]),
    keyword("SHELL SECTION", Rest, Reader::shell_section, &["ELSET", "MATERIAL", "ORIENTATION", "COMPOSITE"], &["SECTIONINTEGRATION"]),
    keyword("SOLID SECTION", Rest, Reader::solid_section, &["ELSET", "MATERIAL", "ORIENTATION", "COMPOSITE"], &["CONTROLS"]),
    keyword("SPRING", Rest, Reader::spring, &["ELSET", "NONLINEAR", "ORIENTATION"], &[]),
    keyword("STEP", Rest, Reader::begin_step, &[], &["NAME", "PERTURBATION", "INC", "UNSYMM", "AMPLITUDE"]),
    keyword("SURFACE", Surfaces, Reader::surface, &["NAME", "TYPE", "COMBINE", "INTERNAL"], &[]),
    keyword("SURFACE BEHAVIOR", Rest, Reader::behaviour, &["PRESSURE-OVERCLOSURE"], &["AUGMENTEDLAGRANGE", "PENALTY"]),
    keyword("SURFACE INTERACTION", Rest, Reader::interaction, &["NAME"], &["UNSYMM"]),
    keyword("TIE", Rest, Reader::tie, &["NAME", "POSITIONTOLERANCE", "CYCLICSYMMETRY", "MULTISTAGE", "FLUIDPERIODIC", "FLUIDCYCLIC"], &["ADJUST", "NOROTATION", "TYPE"]),
    keyword("TRANSFORM", Surfaces, Reader::transform, &["NSET", "TYPE"], &[]),
];

/// Options that are not read, and what that means: keyword, option in capitals without blanks, as the manual writes it, why.
const UNREAD_OPTIONS: &[(&str, &str, &str, &str)] = &[
    ("COMPLEX FREQUENCY", "CORIOLIS", "CORIOLIS", "gyroscopic terms are those of the rotations of the case"),
    ("FRICTION", "ELASTICSLIP", "ELASTIC SLIP", STICK),
    ("FRICTION", "SLIPTOLERANCE", "SLIP TOLERANCE", STICK),
    ("FRICTION", "TAUMAX", "TAUMAX", "friction grows with the pressure without limit"),
    (
        "STEP",
        "NLGEOM",
        "NLGEOM",
        "the geometric stiffness of the preload is a key of the case: prestress = true",
    ),
];

const STICK: &str = "the stiffness of sticking contact is a key of the case: bristle = { stiffness = … }";

/// How an option that is not read is called, and why it is not.
pub(super) fn unread_option(words: &str, option: &str) -> (String, &'static str) {
    let row = UNREAD_OPTIONS.iter().find(|(keyword, name, ..)| *keyword == words && *name == option);
    let (name, why) = row.map_or((option, "an option that is not read"), |(_, _, name, why)| (*name, *why));
    (format!("*{words}, {name}"), why)
}

/// Keywords that are not read because they are about output, steps or heat, which are nothing of the vibrations.
const WITHOUT_EFFECT: &[&str] = &[
    "AMPLITUDE",
    "ASSEMBLY",
    "BASEMOTION",
    "BUCKLE",
    "BULKVISCOSITY",
    "CFD",
    "CFLUX",
    "CHANGEPLASTIC",
    "CONDUCTIVITY",
    "CONSTRAINT",
    "CONTACTCONTROLS",
    "CONTACTFILE",
    "CONTACTOUTPUT",
    "CONTACTPRINT",
    "CONTROLS",
    "COUPLEDTEMPERATURE-DISPLACEMENT",
    "CRADIATE",
    "CREEP",
    "CYCLICHARDENING",
    "DAMAGEINITIATION",
    "DEPVAR",
    "DESIGNRESPONSE",
    "DESIGNVARIABLES",
    "DFLUX",
    "DISTRIBUTIONTABLE",
    "DYNAMIC",
    "DYNAMICTEMPERATURE-DISPLACEMENT",
    "ELECTRICALCONDUCTIVITY",
    "ELECTROMAGNETICS",
    "ELEMENTOUTPUT",
    "ELFILE",
    "ELOUTPUT",
    "ELPRINT",
    "ENDASSEMBLY",
    "ENDINSTANCE",
    "ENDPART",
    "ENERGYFILE",
    "ENERGYOUTPUT",
    "ENERGYPRINT",
    "EXPANSION",
    "FACEPRINT",
    "FEASIBLEDIRECTION",
    "FIELD",
    "FILEFORMAT",
    "FILEOUTPUT",
    "FILM",
    "FILTER",
    "FLUIDCONSTANTS",
    "FLUIDSECTION",
    "GAPCONDUCTANCE",
    "GAPHEATGENERATION",
    "GEOMETRICTOLERANCES",
    "GREEN",
    "HCF",
    "HEATTRANSFER",
    "INELASTICHEATFRACTION",
    "LATENTHEAT",
    "MAGNETICPERMEABILITY",
    "MATRIXASSEMBLE",
    "MATRIXGENERATE",
    "MATRIXOUTPUT",
    "MODALDYNAMIC",
    "MODALFILE",
    "MODALOUTPUT",
    "MODALPRINT",
    "MONITOR",
    "NOANALYSIS",
    "NODEFILE",
    "NODEOUTPUT",
    "NODEPRINT",
    "NOPRINT",
    "NSETOUTPUT",
    "OBJECTIVE",
    "OUTPUT",
    "PHYSICALCONSTANTS",
    "PLASTIC",
    "PREPRINT",
    "PRINT",
    "RADIATE",
    "RATEDEPENDENT",
    "RESTART",
    "SECTIONFILE",
    "SECTIONPRINT",
    "SELECTCYCLICSYMMETRYMODES",
    "SENSITIVITY",
    "SFILM",
    "SOLUTIONTECHNIQUE",
    "SPECIFICGASCONSTANT",
    "SPECIFICHEAT",
    "SRADIATE",
    "STATIC",
    "STEADYSTATEDYNAMICS",
    "SURFACEPROPERTYASSIGNMENT",
    "TEMPERATURE",
    "TIMEPOINTS",
    "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
    "USERMATERIAL",
    "VALUESATINFINITY",
    "VIEWFACTOR",
    "VISCO",
];

/// Keywords that are not read, and what that means.
const UNREAD: &[(&str, Weight, &str)] = &[
    ("", Weight::Nothing, "a line with nothing but an asterisk"),
    ("CLEARANCE", Weight::Perhaps, "gaps are those of the meshes"),
    ("CONNECTORSECTION", Weight::Matters, "connectors are not read"),
    ("CONTACT", Weight::Matters, "general contact is not read: name the pairs with *CONTACT PAIR"),
    ("CONTACTDAMPING", Weight::Perhaps, "damping of contacts is not read"),
    ("CONTACTINCLUSIONS", Weight::Matters, "general contact is not read: name the pairs with *CONTACT PAIR"),
    ("CYCLICSYMMETRYMODEL", Weight::Matters, "cyclic symmetry is not read: the sector alone is the model"),
    ("DISTRIBUTION", Weight::Matters, "directions that differ from element to element are not read"),
    ("GAP", Weight::Matters, "gap elements are not read: name a *CONTACT PAIR"),
    ("HYPERELASTIC", Weight::Matters, "a material that is not linear is not read: give E and ν"),
    ("INITIALCONDITIONS", Weight::Perhaps, "stresses and temperatures at the beginning are not read"),
    ("MEMBRANESECTION", Weight::Matters, "membranes are not read"),
    ("MODALDAMPING", Weight::Perhaps, "damping of modes is a key of the case: [damping] modal_ratio"),
    ("MODELCHANGE", Weight::Perhaps, "all elements and contacts are there"),
    (
        "NODALTHICKNESS",
        Weight::Matters,
        "a thickness that differs from node to node is not read; that of *SHELL SECTION is",
    ),
    ("NORMAL", Weight::Perhaps, "normals are those of the elements"),
    ("PARAMETER", Weight::Matters, "parameters are not read: write the values"),
    ("PRE-TENSIONSECTION", Weight::Perhaps, "tension of bolts is not read"),
    ("SECTIONCONTROLS", Weight::Perhaps, "elements are integrated as their kind is"),
    ("SUBMODEL", Weight::Perhaps, "displacements of another model are not read"),
    ("SURFACESECTION", Weight::Perhaps, "mass on surfaces is not read"),
    ("SYSTEM", Weight::Matters, "nodes in another frame are read in that of the model"),
    ("VISCOELASTIC", Weight::Matters, "a material whose stiffness depends on frequency is not read"),
];

impl Keyword {
    /// The row of a keyword.
    pub fn named(keyword: &str) -> Option<&'static Keyword> {
        KEYWORDS.iter().find(|row| row.words.chars().filter(|c| *c != ' ').eq(keyword.chars()))
    }
}

/// How a keyword that is not read is called, what that means and why.
pub(super) fn unread(keyword: &str) -> (String, Weight, &'static str) {
    let named = |(_, weight, why): &(&str, Weight, &'static str)| (keyword.to_string(), *weight, *why);
    if WITHOUT_EFFECT.contains(&keyword) {
        return (keyword.to_string(), Weight::Nothing, "nothing of the vibrations");
    }
    let row = UNREAD.iter().find(|(name, ..)| *name == keyword);
    row.map(named).unwrap_or_else(|| (keyword.to_string(), Weight::Matters, "an unknown keyword"))
}

/// The keywords that are read.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    KEYWORDS.iter().map(|row| row.words)
}

/// The options that are not read and matter, each with its keyword: `*STEP, NLGEOM`.
#[cfg(test)]
pub(super) fn unread_options() -> impl Iterator<Item = String> {
    UNREAD_OPTIONS.iter().map(|(words, _, name, _)| format!("*{words}, {name}"))
}
