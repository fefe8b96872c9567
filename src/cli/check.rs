//! `stridor check`: the case and its mesh, without an analysis.

use super::error_json::fault_json;
use super::output::{Common, SUCCESS, give, say};
use crate::case::{Parameter, read_case};
use crate::error::Result;
use crate::job::{CaseWarnings, Prepared, Selection, check_case, check_memory};
use clap::Args;
use serde_json::{Value, json};
use std::ops::Bound;
use std::path::PathBuf;

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

pub fn run(options: &CheckOptions, common: &Common) -> Result<u8> {
    let case = read_case(&options.case)?;
    let prepared = Prepared::new(&case)?;
    let warnings = check_case(&prepared).map_err(|error| case.places.locate(error))?;
    if common.json {
        give(format!("{:#}", as_json(options, &prepared, &warnings)?))?;
        return Ok(SUCCESS);
    }
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
        for warning in warnings.words() {
            say(format!("warning: {warning}"))?;
        }
        let memory = check_memory(&prepared, Selection::Listed)?;
        say(format!("{}: valid. {}.", options.case.display(), sizes(&prepared)))?;
        if let Some(expected) = memory {
            say(format!(
                "A run is expected to take about {} of memory: {:.2e} entries of a factor, about {:.0} real modes.",
                expected.words(),
                expected.fill as f64,
                expected.modes
            ))?;
            if let Some(sentence) = expected.words_of_count() {
                say(sentence)?;
            }
        }
    }
    Ok(SUCCESS)
}

/// Nodes, elements, degrees of freedom and, where there is a contact, its points.
fn sizes(prepared: &Prepared) -> String {
    let size = prepared.size();
    let contact = match prepared.case.contact.is_empty() {
        true => String::new(),
        false => format!(", {} contact points within reach", size.contact_points),
    };
    format!("{} nodes, {} elements, {} degrees of freedom{contact}", size.nodes, size.elements, size.dofs)
}

/// `ok`, `faults` (none here), `warnings`, `sizes`, `memory` of a large case, and what else was asked for.
fn as_json(options: &CheckOptions, prepared: &Prepared, warnings: &CaseWarnings) -> Result<Value> {
    let size = prepared.size();
    let sentences = warnings.sentences.iter().map(|sentence| json!({ "message": sentence }));
    let memory = check_memory(prepared, Selection::Listed)?;
    let mut all = json!({
        "ok": true,
        "case": options.case.display().to_string(),
        "faults": [],
        "warnings": sentences.chain(warnings.unlikely.iter().map(fault_json)).collect::<Vec<_>>(),
        "sizes": {
            "nodes": size.nodes,
            "elements": size.elements,
            "degrees_of_freedom": size.dofs,
            "contact_points": size.contact_points,
        },
        "memory": memory.map(|expected| json!({
            "bytes": expected.bytes,
            "factor_entries": expected.fill,
            "real_modes": expected.modes,
            "certificate": expected.count.map(|count| json!({
                "operations": count.operations(),
                "seconds": count.seconds(),
                "bytes": count.bytes(),
            })),
        })),
    });
    if options.parameters {
        let parameter = |p: Parameter| {
            let bounds = range(&p);
            let redo = format!("{:?}", p.invalidates).to_lowercase();
            json!({ "path": p.path, "value": p.value, "unit": p.unit, "range": bounds, "invalidates": redo })
        };
        all["parameters"] = prepared.case.parameters().into_iter().map(parameter).collect();
    }
    if options.resolved {
        all["resolved"] = prepared.case.to_toml().into();
    }
    Ok(all)
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
