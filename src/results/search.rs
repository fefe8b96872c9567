//! Numbers of a case that were searched for, beside the facts that the case then meets or misses.

use super::{CheckedCase, CheckedQuantity, write_result};
use crate::dataset::{Column, Describe, Dimension, Group, Table, Variable, column};
use crate::error::Result;
use std::path::Path;

/// Results of a search.
#[derive(Debug, Clone)]
pub struct SearchResult {
    /// One line.
    pub title: String,
    /// The numbers.
    pub numbers: Vec<SearchedNumber>,
    /// The facts with the numbers that were found.
    pub facts: CheckedCase,
    /// Values of the facts computed at the start.
    pub before: Vec<f64>,
    /// The cost at the start and of what was found.
    pub costs: [f64; 2],
    /// The cost of every evaluation, in their order.
    pub history: Vec<f64>,
    /// Evaluations whose case had no answer.
    pub without_answer: usize,
    /// The case with the numbers that were found, as TOML.
    pub found_case: String,
}

/// A number that was searched for.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchedNumber {
    /// Its name in the search.
    pub name: String,
    /// The scalars of the case that have its value.
    pub paths: Vec<String>,
    /// The SI unit; empty for a pure number.
    pub unit: String,
    /// Its bounds \[SI\].
    pub between: [f64; 2],
    /// The value of the case \[SI\].
    pub before: f64,
    /// The value that was found \[SI\].
    pub after: f64,
    /// Cost at a smaller and a larger value, all others as found; none beyond a bound.
    pub moved: [Option<Moved>; 2],
}

/// One number moved away from where it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Its value \[SI\].
    pub to: f64,
    /// The cost there.
    pub cost: f64,
    /// The fact whose cost rises most, by its index.
    pub worst: usize,
}

impl SearchedNumber {
    /// Whether it was found at one of its bounds.
    pub fn at_bound(&self) -> bool {
        let [low, high] = self.between;
        let tolerance = 1e-6 * (high - low);
        self.after <= low + tolerance || self.after >= high - tolerance
    }

    /// How much the cost rises when the number is moved, at most; nothing where no cost is finite.
    pub fn weight(&self, cost: f64) -> f64 {
        let rises = self.moved.iter().flatten().map(|moved| moved.cost - cost);
        rises.filter(|rise| rise.is_finite()).fold(0.0, f64::max)
    }
}

impl SearchResult {
    /// Writes `search.json` and `found.toml`, the case with the numbers that were found, into the
    /// folder `dir`.
    ///
    /// # Errors
    /// [`crate::error::Error::Io`] when a file cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let text = format!("{:#}\n", self.describe().to_json());
        write_result(dir, "search.json", text.as_bytes())?;
        write_result(dir, "found.toml", self.found_case.as_bytes())
    }
}

/// A fact and what was computed for it at the start.
type Fact<'a> = (&'a CheckedQuantity, f64);

fn fact_columns<'a>() -> Vec<Column<Fact<'a>>> {
    type F<'a> = Fact<'a>;
    vec![
        column("quantity", "text", "name of the fact", |(row, _): &F| row.quantity.clone()),
        column("reference", "unit", "wanted value", |(row, _): &F| row.reference),
        column("tolerance", "unit", "largest difference that meets it", |(row, _): &F| row.tolerance),
        column("relative", "1", "whether that is relative to the reference", |(row, _): &F| row.relative),
        column("before", "unit", "value with the numbers of the case", |(_, before): &F| *before),
        column("computed", "unit", "value with the numbers found", |(row, _): &F| row.computed),
        column("difference", "unit", "difference from the reference", |(row, _): &F| row.difference()),
        column("met", "1", "whether it is met", |(row, _): &F| row.passed()),
        column("reason", "text", "reason of the tolerance", |(row, _): &F| row.reason.clone()),
    ]
}

/// A number moved towards one of its bounds, and the fact whose cost rises most.
type Shift = (&'static str, Moved, String);

fn moved_columns() -> Vec<Column<Shift>> {
    vec![
        column("towards", "text", "lower or upper bound", |(end, ..): &Shift| *end),
        column("to", "unit", "value of the number", |(_, moved, _): &Shift| moved.to),
        column("cost", "1", "cost there", |(_, moved, _): &Shift| moved.cost),
        column("worst", "text", "fact whose cost rises most", |(.., worst): &Shift| worst.clone()),
    ]
}

impl Describe for SearchResult {
    fn describe(&self) -> Group<'_> {
        let rows = self.facts.rows.iter().zip(self.before.iter().copied());
        let facts: Vec<Fact> = rows.collect();
        Group::new("", "")
            .value("title", "text", "title of the search", self.title.clone())
            .value("cost", "1", "cost of the numbers found", self.costs[1])
            .value("cost_before", "1", "cost of the numbers of the case", self.costs[0])
            .value("evaluations", "1", "number of evaluations", self.history.len())
            .value("without_answer", "1", "those whose case had no answer", self.without_answer)
            .table(Table::of("facts", "fact", &fact_columns(), &facts))
            .list("numbers", self.numbers.iter().map(|number| self.number(number)).collect())
    }
}

impl SearchResult {
    fn number<'a>(&self, number: &'a SearchedNumber) -> Group<'a> {
        let ends = ["lower", "upper"].into_iter().zip(&number.moved);
        let worst = |moved: &Moved| self.facts.rows[moved.worst].quantity.clone();
        let moved = ends.filter_map(|(end, moved)| moved.clone().map(|m| (end, m.clone(), worst(&m))));
        let moved: Vec<Shift> = moved.collect();
        let paths = Dimension::indexed("path", number.paths.len());
        let between = number.between.to_vec();
        Group::new(&*number.name, "a number that was searched for")
            .with(Variable::texts("paths", "scalars that have its value", paths, number.paths.clone()))
            .value("unit", "text", "its unit; empty of a pure number", number.unit.clone())
            .with(Variable::reals("between", "unit", "bounds", vec![Dimension::limits()], between))
            .value("before", "unit", "value of the case", number.before)
            .value("after", "unit", "value found", number.after)
            .value("at_bound", "1", "whether it was found at a bound", number.at_bound())
            .table(Table::by("moved", "towards", &moved_columns(), &moved))
    }
}
