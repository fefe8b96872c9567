//! Which verdicts the modal damping decides.

use crate::dataset::{Column, Describe, Dimension, Group, Table, Variable, column};
use crate::linalg::c64;
use crate::stability::unstable;
use std::f64::consts::TAU;

/// Verdicts that depend on the modal damping ratio, the least certain of all inputs.
#[derive(Debug, Clone)]
pub struct DampingVerdicts {
    /// ζ of the case.
    pub ratio: f64,
    /// The range that was examined.
    pub range: [f64; 2],
    /// One a mode.
    pub rows: Vec<DampingRow>,
}

/// One mode at the case's own damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampingRow {
    /// λ at the case's damping \[1/s\].
    pub eigenvalue: c64,
    /// ζ at which its verdict flips, when that is in the range.
    pub critical_ratio: Option<f64>,
}

fn columns() -> Vec<Column<DampingRow>> {
    type Row = DampingRow;
    vec![
        column("frequency_hz", "Hz", "ω/2π at the damping of the case", |r: &Row| r.eigenvalue.im / TAU),
        column("growth_rate", "1/s", "σ at the damping of the case", |r: &Row| r.eigenvalue.re),
        column("unstable", "1", "whether the mode is unstable there", |r: &Row| unstable(r.eigenvalue)),
        column("critical_ratio", "1", "ζ at which that changes, if it does in the range", |r: &Row| {
            r.critical_ratio
        }),
    ]
}

impl Describe for DampingVerdicts {
    fn describe(&self) -> Group<'_> {
        let range = self.range.to_vec();
        Group::new("damping_verdicts", "verdicts that the modal damping ratio decides")
            .value("modal_ratio", "1", "ζ of the case", self.ratio)
            .with(Variable::reals(
                "range",
                "1",
                "range of ζ that was examined",
                vec![Dimension::limits()],
                range,
            ))
            .value("decided_by_damping", "1", "modes whose verdict changes in it", self.decided().count())
            .table(Table::of("modes", "mode", &columns(), &self.rows).file("damping_verdicts"))
    }
}

impl DampingVerdicts {
    /// The modes whose verdict the damping decides within the range.
    pub fn decided(&self) -> impl Iterator<Item = &DampingRow> {
        self.rows.iter().filter(|row| row.critical_ratio.is_some())
    }
}
