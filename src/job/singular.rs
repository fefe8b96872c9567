//! Explanation of singular equations: the parts that are not supported.

use super::prepared::Prepared;
use crate::error::Error;
use crate::structure::free_parts;

/// The most parts that a message names.
const NAMED: usize = 5;

/// An analysis that failed as its equations are singular, with the parts that the supports and springs do not hold.
pub fn explained(prepared: &Prepared, error: Error) -> Error {
    let Error::Analysis { what, found, help } = error else { return error };
    let singular = ["singular", "nothing holds", "no steady state"].iter().any(|words| found.contains(words));
    let parts = match singular && prepared.case.matrices.is_none() {
        true => free_parts(&prepared.model, &prepared.assembled).unwrap_or_default(),
        false => Vec::new(),
    };
    if parts.is_empty() {
        return Error::Analysis { what, found, help };
    }
    let said = parts.iter().take(NAMED).map(|part| {
        let names: Vec<String> = part.names.iter().map(|name| format!("`{name}`")).collect();
        let name = if names.is_empty() { "a point mass".into() } else { names.join(" with ") };
        let motions = if part.motions == 1 { "motion" } else { "motions" };
        format!("{name} is free in {} rigid-body {motions} (node {})", part.motions, part.node + 1)
    });
    let mut said: Vec<String> = said.collect();
    if parts.len() > NAMED {
        said.push(format!("and {} more pieces", parts.len() - NAMED));
    }
    Error::analysis(
        what,
        format!("{found}; without contacts {}", said.join(", ")),
        "Hold these parts by supports, springs, rigid links or a contact that is closed; merge coincident nodes where they \
         should hang together; a part without mass cannot be free",
    )
}
