//! Complex modes of samples of uncertain scalars.

use super::analysis::{Analysis, Planned, Scope};
use super::sweep::PlannedStudies;
use crate::error::Result;
use crate::job::prepared::Prepared;

/// Studies of uncertain scalars.
pub const UNCERTAINTY: Analysis = Analysis {
    name: "uncertainty",
    about: "Complex eigenvalues, and how probable instability is with the uncertain scalars of the case",
    example: Some(
        "[uncertainty.all.parameter.mu] with `path = \"contact.NAME.friction.mu0\"`, `between = [0.2, 0.6]` and \
     `deviation = 0.05`",
    ),
    listed: |case| !case.uncertainty.is_empty(),
    ready: |case| !case.uncertainty.is_empty(),
    needs: &["cea"],
    left_vectors: false,
    plan,
};

fn plan<'a>(_: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
    Ok(Box::new(PlannedStudies {
        phase: "samples of uncertain scalars",
        studies: &|explorer, results, record| explorer.uncertainty(results, record),
    }))
}
