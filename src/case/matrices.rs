//! `[matrices]`: M, C and K from another program.

use super::read::collect;
use super::reader::Section;
use super::units::NUMBER;
use serde::Serialize;
use std::collections::BTreeMap;

/// M, C and K from MatrixMarket files (paths relative to the case file).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Matrices {
    /// M \[kg, kg m²\].
    pub mass: String,
    /// K \[N/m, N m\]; an imaginary part is hysteretic damping.
    pub stiffness: String,
    /// C \[N s/m, N m s\]; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<String>,
    /// External force f \[N, N m\], a matrix of one column; none when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<String>,
    /// A table (CSV) of what each row is: `node`, its motion `ux` … `rz`, and the node's coordinates `x`, `y`, `z`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dofs: Option<String>,
    /// What is added to them, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub term: BTreeMap<String, MatrixTerm>,
}

/// Matrices that are added with a common factor, a scalar of the case: M + a M₁, C + a C₁, K + a K₁. So a friction
/// coefficient or a speed can be varied in a model that another program exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MatrixTerm {
    /// a.
    pub factor: f64,
    /// M₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<String>,
    /// C₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<String>,
    /// K₁.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<String>,
}

pub(super) fn read(s: &Section) -> Matrices {
    const FILE: &str = "the path of a MatrixMarket file";
    let term = |t: &Section| {
        let term = MatrixTerm {
            factor: t.quantity("factor", NUMBER).required("a number"),
            mass: t.string("mass").optional(),
            damping: t.string("damping").optional(),
            stiffness: t.string("stiffness").optional(),
        };
        if [&term.mass, &term.damping, &term.stiffness].iter().all(|file| file.is_none()) {
            t.fault("stiffness", "no matrix", "`mass`, `damping` or `stiffness`", "");
        }
        term
    };
    Matrices {
        mass: s.string("mass").required(FILE),
        stiffness: s.string("stiffness").required(FILE),
        damping: s.string("damping").optional(),
        load: s.string("load").optional(),
        dofs: s.string("dofs").optional(),
        term: collect(s, "term", term),
    }
}
