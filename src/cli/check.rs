//! `stridor check`: the case and its mesh, without an analysis.

use super::output::{Common, give, say};
use crate::case::{Parameter, read_case};
use crate::error::Result;
use crate::job::{Prepared, Selection, check_case, expected_memory};
use clap::Args;
use std::ops::Bound;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct CheckOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// Also list every scalar: path, value, SI unit, the values it may take, what a change invalidates
    #[arg(long)]
    parameters: bool,
    /// Also print the resolved case, every default written out
    #[arg(long)]
    resolved: bool,
}

pub fn run(options: &CheckOptions, common: &Common) -> Result<ExitCode> {
    let case = read_case(&options.case)?;
    let prepared = Prepared::new(&case)?;
    let warnings = check_case(&prepared).map_err(|error| case.places.locate(error))?;
    if options.resolved {
        give(case.to_toml().trim_end())?;
    }
    if options.parameters {
        for p in case.parameters() {
            let redo = format!("{:?}", p.invalidates).to_lowercase();
            let value = number(p.value);
            say(format!("{:<44} {value:>22} {:<8} {:<16} {redo}", p.path, p.unit, range(&p)))?;
        }
    }
    if !common.quiet && !options.resolved && !options.parameters {
        for warning in prepared.warnings.iter().chain(&warnings) {
            say(format!("warning: {warning}"))?;
        }
        let size = prepared.size();
        say(format!(
            "{}: sound. {} nodes, {} elements, {} degrees of freedom, {} contact points within reach.",
            options.case.display(),
            size.nodes,
            size.elements,
            size.dofs,
            size.contact_points
        ))?;
        if let Some(expected) = expected_memory(&prepared, Selection::Listed)? {
            say(format!(
                "A run is expected to take about {} of memory: {:.2e} entries of a factor, about {:.0} real modes.",
                expected.words(),
                expected.fill as f64,
                expected.modes
            ))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// All digits of a number, with an exponent when it is very large or small.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// Bounds as an interval: "(0, ∞)".
fn range(parameter: &Parameter) -> String {
    let low = match parameter.bounds.0 {
        Bound::Included(v) => format!("[{}", number(v)),
        Bound::Excluded(v) => format!("({}", number(v)),
        Bound::Unbounded => "(-∞".into(),
    };
    let high = match parameter.bounds.1 {
        Bound::Included(v) => format!("{}]", number(v)),
        Bound::Excluded(v) => format!("{})", number(v)),
        Bound::Unbounded => "∞)".into(),
    };
    format!("{low}, {high}")
}
