//! Cards that are not read, and what they mean.

use super::fields::{Fields, integer};
use crate::ledger::Weight;
use std::collections::BTreeSet;

/// Numbers of what is not read but may be named.
#[derive(Debug, Default)]
pub(super) struct Unread {
    pub properties: BTreeSet<u64>,
    pub materials: BTreeSet<u64>,
    pub elements: BTreeSet<u64>,
}

/// By how names begin: what it means, and why it is not read.
const KINDS: &[(&str, Weight, &str)] = &[
    ("DMIG", Weight::Matters, "matrices in the deck are not read"),
    ("DMI", Weight::Nothing, "matrices of the user's own programs are not read"),
    ("TABDMP", Weight::Matters, "damping of modes over frequency is not read"),
    ("TABLE", Weight::Nothing, "tables are not read"),
    ("TEMP", Weight::Nothing, "temperatures are not read"),
    ("MATT", Weight::Nothing, "properties over temperature are not read: those at the reference hold"),
    ("MATS", Weight::Nothing, "plasticity is not read"),
    ("MATF", Weight::Nothing, "strength is not read"),
    ("MAT", Weight::Matters, "materials of this kind are not read"),
    ("GRAV", Weight::Perhaps, "gravity is not read"),
    ("ACCEL", Weight::Perhaps, "accelerations are not read"),
    ("MOMENT", Weight::Perhaps, "moments are not read"),
    ("FORCE", Weight::Perhaps, "forces along lines between nodes are not read"),
    ("PLOAD", Weight::Perhaps, "loads of this kind are not read"),
    ("PLOTEL", Weight::Nothing, "lines of pictures are not read"),
    ("SPCD", Weight::Perhaps, "motions of supports are not read: they are held"),
    ("SPCOFF", Weight::Nothing, "degrees of freedom that may not be held by the program are not read"),
    ("SPCAX", Weight::Matters, "supports of this kind are not read"),
    ("SPCR", Weight::Perhaps, "motions of supports are not read: they are held"),
    ("SUPORT", Weight::Nothing, "the directions of rigid modes are not read"),
    ("ASET", Weight::Perhaps, "the model is not reduced to some degrees of freedom"),
    ("BSET", Weight::Perhaps, "the model is not reduced to some degrees of freedom"),
    ("CSET", Weight::Perhaps, "the model is not reduced to some degrees of freedom"),
    ("QSET", Weight::Perhaps, "the model is not reduced to some degrees of freedom"),
    ("OMIT", Weight::Perhaps, "the model is not reduced to some degrees of freedom"),
    ("USET", Weight::Nothing, "sets of degrees of freedom for output are not read"),
    ("SET", Weight::Nothing, "sets of this kind are not read"),
    ("RGYRO", Weight::Matters, "rotation is not read"),
    ("ROTOR", Weight::Matters, "rotation is not read"),
    ("RSPINR", Weight::Matters, "rotation is not read"),
    ("UNBALNC", Weight::Nothing, "loads of other analyses are not read"),
    ("RB", Weight::Matters, "rigid elements of this kind are not read"),
    ("RROD", Weight::Matters, "rigid elements of this kind are not read"),
    ("RTRPLT", Weight::Matters, "rigid elements of this kind are not read"),
    ("RSPLINE", Weight::Matters, "rigid elements of this kind are not read"),
    ("RSSCON", Weight::Matters, "rigid elements of this kind are not read"),
    ("RJOINT", Weight::Matters, "rigid elements of this kind are not read"),
    ("RLOAD", Weight::Nothing, "loads of other analyses are not read"),
    ("TLOAD", Weight::Nothing, "loads of other analyses are not read"),
    ("DLOAD", Weight::Nothing, "loads of other analyses are not read"),
    ("LSEQ", Weight::Nothing, "loads of other analyses are not read"),
    ("DAREA", Weight::Nothing, "loads of other analyses are not read"),
    ("DELAY", Weight::Nothing, "loads of other analyses are not read"),
    ("DPHASE", Weight::Nothing, "loads of other analyses are not read"),
    ("FREQ", Weight::Nothing, "frequencies of other analyses are not read"),
    ("TSTEP", Weight::Nothing, "times of other analyses are not read"),
    ("TIC", Weight::Nothing, "times of other analyses are not read"),
    ("TF", Weight::Matters, "transfer functions are not read"),
    ("NLPARM", Weight::Nothing, "steps of nonlinear analyses are not read"),
    ("NLSTEP", Weight::Nothing, "steps of nonlinear analyses are not read"),
    ("NLPCI", Weight::Nothing, "steps of nonlinear analyses are not read"),
    ("EIG", Weight::Perhaps, "methods of this kind are not read"),
    ("BCTPAR", Weight::Perhaps, "parameters of contact are not read"),
    ("BCPARA", Weight::Perhaps, "parameters of contact are not read"),
    ("BGPARM", Weight::Perhaps, "parameters of glue are not read"),
    ("BCRPARA", Weight::Perhaps, "sides and kinds of contact surfaces are not read"),
    ("BOLT", Weight::Perhaps, "forces in bolts are not read"),
    ("BC", Weight::Matters, "contact of this kind is not read"),
    ("BE", Weight::Matters, "contact of this kind is not read"),
    ("DES", Weight::Nothing, "optimisation is not read"),
    ("DV", Weight::Nothing, "optimisation is not read"),
    ("DOPT", Weight::Nothing, "optimisation is not read"),
    ("DRESP", Weight::Nothing, "optimisation is not read"),
    ("DCON", Weight::Nothing, "optimisation is not read"),
    ("AE", Weight::Nothing, "flows are not read"),
    ("CAERO", Weight::Nothing, "flows are not read"),
    ("PAERO", Weight::Nothing, "flows are not read"),
    ("SPLINE", Weight::Nothing, "flows are not read"),
    ("FLUTTER", Weight::Nothing, "flows are not read"),
    ("FLFACT", Weight::Nothing, "flows are not read"),
    ("MKAERO", Weight::Nothing, "flows are not read"),
    ("TRIM", Weight::Nothing, "flows are not read"),
    ("CONV", Weight::Nothing, "heat is not read"),
    ("CHBDY", Weight::Nothing, "heat is not read"),
    ("PCONV", Weight::Nothing, "heat is not read"),
    ("QBDY", Weight::Nothing, "heat is not read"),
    ("QVOL", Weight::Nothing, "heat is not read"),
    ("QHBDY", Weight::Nothing, "heat is not read"),
    ("RADM", Weight::Nothing, "heat is not read"),
    ("SEQGP", Weight::Nothing, "orders of equations are not read"),
    ("SE", Weight::Matters, "superelements are not read"),
    ("CSUPER", Weight::Matters, "superelements are not read"),
    ("NSM", Weight::Matters, "mass that stiffens nothing is not read"),
    ("PARAM", Weight::Perhaps, "not read"),
    ("C", Weight::Matters, "elements of this kind are not read"),
    ("P", Weight::Matters, "properties of this kind are not read"),
];

/// Cards that make grid points or elements.
const MAKERS: &[&str] = &["GRIDB", "GRIDF", "GRIDG", "GRIDS", "EGRID", "CGEN", "GMCURV", "GMSURF", "RINGAX"];

/// Notes a card.
pub(super) fn note(fields: &mut Fields, unread: &mut Unread) {
    let name = fields.name();
    if MAKERS.contains(&name) {
        fields.fault(
            1,
            format!("{name}, which makes points or elements"),
            "GRID cards and elements: cards that make them are not read",
        );
    }
    let number = integer(fields.word(1)).and_then(|number| u64::try_from(number).ok());
    match name.as_bytes() {
        [b'C', ..] => unread.elements.extend(number),
        [b'M', b'A', b'T', ..] => unread.materials.extend(number),
        [b'P', ..] => unread.properties.extend(number),
        _ => {}
    }
    let kind = KINDS.iter().find(|(start, ..)| name.starts_with(start));
    let (weight, why) =
        kind.map_or((Weight::Perhaps, "a card that is not known"), |(_, weight, why)| (*weight, *why));
    fields.note(weight, why);
}
