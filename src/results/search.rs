//! Numbers of a case that were searched for, beside the facts that the case then meets or misses.

use super::{CheckedCase, write_result};
use crate::error::Result;
use serde_json::{Value, json};
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
        let text = serde_json::to_string_pretty(&self.to_json()).expect("numbers and strings are JSON");
        write_result(dir, "search.json", text.as_bytes())?;
        write_result(dir, "found.toml", self.found_case.as_bytes())
    }

    /// The result as `search.json` has it.
    pub fn to_json(&self) -> Value {
        let rows = self.facts.rows.iter().zip(&self.before);
        json!({
            "title": self.title,
            "cost": self.costs[1],
            "cost_before": self.costs[0],
            "evaluations": self.history.len(),
            "without_answer": self.without_answer,
            "facts": rows.map(|(row, before)| json!({
                "quantity": row.quantity,
                "reference": row.reference,
                "tolerance": row.tolerance,
                "relative": row.relative,
                "before": before,
                "computed": row.computed,
                "difference": row.difference(),
                "met": row.passed(),
                "reason": row.reason,
            })).collect::<Vec<_>>(),
            "numbers": self.numbers.iter().map(|n| json!({
                "name": n.name,
                "paths": n.paths,
                "unit": n.unit,
                "between": n.between,
                "before": n.before,
                "after": n.after,
                "at_bound": n.at_bound(),
                "moved": n.moved.iter().map(|moved| moved.as_ref().map(|m| json!({
                    "to": m.to,
                    "cost": m.cost,
                    "worst": self.facts.rows[m.worst].quantity,
                }))).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
        })
    }
}
