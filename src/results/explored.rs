//! Sweeps and maps as plain data.

use crate::linalg::c64;
use crate::sweep::{Axis, Boundary, Checked, MapPoint, Sweep};

/// How the points of a sweep or map were solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// On one reduced model of this many degrees of freedom, right at full order where it was measured.
    Reduced(usize),
    /// A whole analysis each, because the scalar changes the structure.
    Whole,
}

/// Complex modes along one scalar of the case.
#[derive(Debug, Clone)]
pub struct SweepResult {
    /// The name the case gives it.
    pub name: String,
    /// The path of the scalar.
    pub parameter: String,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// The values asked for.
    pub axis: Axis,
    /// The value of the case itself.
    pub nominal: f64,
    /// Branches and critical values.
    pub sweep: Sweep,
    /// The mode at each critical value, measured on the full order.
    pub verified: Vec<Option<Checked>>,
    /// Values at which all modes were measured on the full order, with the largest |Δλ|/|λ| there.
    pub sample: Vec<(f64, f64)>,
    /// How it was solved.
    pub method: Method,
}

impl SweepResult {
    /// The estimated relative error of critical value `k`: the full-order error of λ over the slope of the growth rate,
    /// or the bracket's half length when that is more. Where two modes merge the slope is infinite: the bracket alone.
    pub fn value_error(&self, k: usize) -> f64 {
        let critical = &self.sweep.critical[k];
        let by_mode = match self.verified.get(k).copied().flatten() {
            Some(c) if critical.kind != crate::sweep::CriticalKind::Merging => {
                c.eigenvalue_error * c.eigenvalue.norm() / critical.slope
            }
            _ => 0.0,
        };
        critical.uncertainty.max(by_mode) / critical.value.abs().max(f64::MIN_POSITIVE)
    }

    /// The index in [`Sweep::values`] nearest to the case's own value, when the sweep covers it.
    pub fn nominal_index(&self) -> Option<usize> {
        let (low, high) = (self.axis.from.min(self.axis.to), self.axis.from.max(self.axis.to));
        let distance = |k: &usize| (self.sweep.values[*k] - self.nominal).abs();
        let nearest = (0..self.sweep.values.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.filter(|_| self.nominal >= low && self.nominal <= high)
    }
}

/// The strongest growth over two scalars of the case.
#[derive(Debug, Clone)]
pub struct MapResult {
    /// The name the case gives it.
    pub name: String,
    /// The paths of the scalars.
    pub parameters: [String; 2],
    /// Their SI units.
    pub units: [String; 2],
    /// The values, the first parameter running fastest in `points`.
    pub axes: [Axis; 2],
    /// The values of the case itself.
    pub nominal: [f64; 2],
    /// One a point of the grid.
    pub points: Vec<MapPoint>,
    /// Where the largest growth rate is zero.
    pub boundary: Boundary,
    /// Places at which all modes were measured on the full order, with the largest |Δλ|/|λ| there.
    pub sample: Vec<([f64; 2], f64)>,
    /// How it was solved.
    pub method: Method,
}

/// What the modal damping ratio, the most guessed of all inputs, decides.
#[derive(Debug, Clone)]
pub struct DampingVerdicts {
    /// ζ of the case.
    pub ratio: f64,
    /// The range that was looked at.
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

impl DampingVerdicts {
    /// The modes whose verdict the damping decides within the range.
    pub fn decided(&self) -> impl Iterator<Item = &DampingRow> {
        self.rows.iter().filter(|row| row.critical_ratio.is_some())
    }
}
