//! Sweeps: complex modes along one scalar of the case.

use super::explored::{SweepMethod, ends};
use super::file_name;
use crate::dataset::{Column, Describe, Dimension, Group, Table, Values, Variable, column};
use crate::linalg::c64;
use crate::numbers::{hertz, power, significant};
use crate::sweep::{Axis, Branch, Checked, Critical, CriticalKind, Interaction, InteractionKind, Sweep};
use std::f64::consts::TAU;

/// Complex modes along one scalar of the case.
#[derive(Debug, Clone)]
pub struct SweepResult {
    /// The name the case gives it.
    pub name: String,
    /// The path of the scalar.
    pub parameter: String,
    /// Name of the quantity with its symbol, for axes.
    pub label: String,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// The requested values.
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
    pub method: SweepMethod,
}

/// A branch with the values of its sweep.
type Followed<'a> = (&'a [f64], &'a Branch);

fn branch_columns<'a>(unit: &str) -> Vec<Column<Followed<'a>>> {
    type B<'a> = Followed<'a>;
    let both = |branch: &Branch, part: fn(&c64) -> f64| {
        [branch.eigenvalues.first(), branch.eigenvalues.last()].map(|z| z.map_or(f64::NAN, part))
    };
    let last = |branch: &Branch| branch.first + branch.eigenvalues.len().saturating_sub(1);
    vec![
        column("from", unit.to_string(), "first value of the branch", |(v, b): &B| v[b.first]),
        column("to", unit.to_string(), "last value of the branch", move |(v, b): &B| v[last(b)]),
        column("frequency_hz", "Hz", "ω/2π at both ends", move |(_, b): &B| both(b, |z| z.im / TAU))
            .along(ends()),
        column("growth_rate", "1/s", "σ at both ends", move |(_, b): &B| both(b, |z| z.re)).along(ends()),
        column("largest_growth_rate", "1/s", "largest σ of the branch", |(_, b): &B| {
            b.eigenvalues.iter().map(|z| z.re).fold(f64::NEG_INFINITY, f64::max)
        }),
        column("ever_unstable", "1", "whether it is unstable somewhere", |(_, b): &B| {
            b.growing().any(|grows| grows)
        }),
        column("lowest_mac", "1", "least MAC of neighbouring shapes along it", |(_, b): &B| b.lowest_mac),
    ]
}

/// A critical value by its index.
type Passed<'a> = (&'a SweepResult, usize);

fn passed((result, k): &Passed) -> Critical {
    result.sweep.critical[*k]
}

/// Error of the mode there at full order.
fn full((result, k): &Passed, part: fn(Checked) -> f64) -> Option<f64> {
    result.verified.get(*k).copied().flatten().map(part)
}

fn critical_columns<'a>(unit: &str) -> Vec<Column<Passed<'a>>> {
    type P<'a> = Passed<'a>;
    let shown = |error: Option<f64>| error.map_or("–".into(), power);
    let becomes = |c: Critical| if c.rises { "unstable" } else { "stable" };
    vec![
        column("value", unit.to_string(), "where a branch becomes unstable or stable", move |p: &P| {
            passed(p).value
        })
        .shown("value", move |p| significant(passed(p).value, 8)),
        column("verified_error", "1", "estimated relative error of the value", |(result, k): &P| {
            result.value_error(*k)
        })
        .proof("rel. error of the value", |(result, k)| power(result.value_error(*k))),
        column("frequency_hz", "Hz", "ω/2π there", move |p: &P| passed(p).eigenvalue.im / TAU)
            .shown("f [Hz]", move |p| hertz(passed(p).eigenvalue.im / TAU, 1)),
        column("becomes", "text", "unstable or stable, along the sweep", move |p: &P| becomes(passed(p)))
            .shown("becomes", move |p| becomes(passed(p)).into()),
        column("kind", "text", "merging (flutter), growth (σ passes zero) or divergence", move |p: &P| {
            match passed(p).kind {
                CriticalKind::Merging => "merging",
                CriticalKind::Growth => "growth",
                CriticalKind::Divergence => "divergence",
            }
        })
        .shown("what happens", move |p| {
            match passed(p).kind {
                CriticalKind::Merging => "two frequencies merge",
                CriticalKind::Growth => "growth rate passes zero",
                CriticalKind::Divergence => "divergence",
            }
            .into()
        }),
        column("branch", "1", "number of the branch", move |p: &P| passed(p).branch + 1),
        column("backward_error", "1", "η at full order", move |p: &P| full(p, |c| c.backward_error))
            .proof("η", move |p| shown(full(p, |c| c.backward_error))),
        column("eigenvalue_error", "1", "estimated |Δλ|/|λ| at full order", move |p: &P| {
            full(p, |c| c.eigenvalue_error)
        })
        .proof("|Δλ|/|λ|", move |p| shown(full(p, |c| c.eigenvalue_error))),
    ]
}

fn interaction_columns(unit: &str) -> Vec<Column<Interaction>> {
    vec![
        column("value", unit.to_string(), "where two branches are nearest", |e: &Interaction| e.value),
        column("kind", "text", "crossing, veering or merging", |e: &Interaction| match e.kind {
            InteractionKind::Crossing => "crossing",
            InteractionKind::Veering => "veering",
            InteractionKind::Merging => "merging",
        }),
        column("frequency_hz", "Hz", "ω/2π there", |e: &Interaction| e.frequency_hz),
        column("distance", "1", "|λ₁ − λ₂|/|λ| there", |e: &Interaction| e.distance),
        column("branches", "1", "numbers of the two branches", |e: &Interaction| e.branches.map(|b| b + 1))
            .along(Dimension::numbered("of_two", 2)),
    ]
}

impl SweepResult {
    /// The estimated relative error of critical value `k`: the full-order error of λ over the slope of the growth rate,
    /// or the bracket's half length when that is more; relative to a millionth of the range at least. Where two modes merge the slope is
    /// infinite: the bracket alone.
    pub fn value_error(&self, k: usize) -> f64 {
        let critical = &self.sweep.critical[k];
        let by_mode = match self.verified.get(k).copied().flatten() {
            Some(c) if critical.kind != CriticalKind::Merging => {
                c.eigenvalue_error * c.eigenvalue.norm() / critical.slope
            }
            _ => 0.0,
        };
        let range = (self.axis.to - self.axis.from).abs();
        critical.uncertainty.max(by_mode) / critical.value.abs().max(1e-6 * range)
    }

    /// The critical values, one a row.
    pub(crate) fn critical_table(&self) -> Table<'static> {
        let all: Vec<Passed> = (0..self.sweep.critical.len()).map(|k| (self, k)).collect();
        Table::of("critical", "critical_value", &critical_columns(&self.unit), &all)
    }

    /// λ of every branch at every value, one a row.
    fn points(&self) -> Table<'static> {
        let branches = self.sweep.branches.iter().enumerate();
        let all: Vec<(usize, f64, c64)> = branches
            .flat_map(|(b, branch)| {
                let along = branch.eigenvalues.iter().enumerate();
                along.map(move |(k, z)| (b + 1, self.sweep.values[branch.first + k], *z))
            })
            .collect();
        type Point = (usize, f64, c64);
        let columns = [
            column("branch", "1", "number of the branch", |(branch, ..): &Point| *branch),
            column("frequency_hz", "Hz", "ω/2π", |(.., z): &Point| z.im / TAU),
            column("growth_rate", "1/s", "σ", |(.., z): &Point| z.re),
        ];
        let mut table = Table::of("points", "point", &columns, &all).long();
        let rows = vec![table.rows.clone()];
        let values = all.iter().map(|(_, value, _)| *value).collect();
        let story = "value of the parameter";
        let values = Variable::reals(self.parameter.clone(), self.unit.clone(), story, rows.clone(), values);
        table.columns.insert(1, values);
        let eigenvalues = Values::Complexes(all.iter().map(|(.., z)| *z).collect());
        table.field(Variable::new("eigenvalue", "1/s", "λ = σ + iω", rows, eigenvalues))
    }

    /// Branches, critical values and where branches meet.
    fn group(&self) -> Group<'_> {
        let (sweep, unit) = (&self.sweep, &self.unit);
        let branches: Vec<Followed> = sweep.branches.iter().map(|b| (&*sweep.values, b)).collect();
        let file = file_name("sweep", &self.name);
        let critical = self.critical_table().file(format!("{file}_critical"));
        let eigenvalues = Values::Complexes(sweep.critical.iter().map(|c| c.eigenvalue).collect());
        let eigenvalues =
            Variable::new("eigenvalue", "1/s", "λ there", vec![critical.rows.clone()], eigenvalues);
        let sample = [
            column("value", unit.clone(), "value", |(value, _): &(f64, f64)| *value),
            column(
                "eigenvalue_error",
                "1",
                "largest estimated |Δλ|/|λ| there",
                |(_, error): &(f64, f64)| *error,
            ),
        ];
        Group::new(&*self.name, "complex modes along one scalar of the case")
            .value("parameter", "text", "path of the scalar", self.parameter.clone())
            .value("label", "text", "name of the quantity with its symbol", self.label.clone())
            .value("unit", "text", "its unit; empty of a pure number", unit.clone())
            .with(self.value("from", "first value", self.axis.from))
            .with(self.value("to", "last value", self.axis.to))
            .with(self.value("nominal", "the value of the case", self.nominal))
            .value("values", "1", "number of values", sweep.values.len())
            .value("answered", "1", "values with an answer", sweep.answered().count())
            .group(self.method.group())
            .table(Table::of("branches", "branch", &branch_columns(unit), &branches))
            .table(critical.field(eigenvalues))
            .table(Table::of("encounters", "encounter", &interaction_columns(unit), &sweep.interactions))
            .table(Table::of("full_order_sample", "sample", &sample, &self.sample))
            .table(self.points().file(file))
    }

    /// A value of the parameter.
    fn value(&self, key: &'static str, description: &'static str, value: f64) -> Variable<'_> {
        Variable::reals(key, &*self.unit, description, Vec::new(), vec![value])
    }
}

impl Describe for SweepResult {
    fn describe(&self) -> Group<'_> {
        Group::new("", "").list("sweeps", vec![self.group()])
    }
}
