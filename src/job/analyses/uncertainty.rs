//! Complex modes of samples of uncertain scalars.

use super::analysis::{Analysis, Planned, Scope};
use super::sweep::PlannedStudies;
use crate::case::Case;
use crate::error::Result;
use crate::job::prepared::Prepared;

/// Studies of uncertain scalars.
pub struct UncertaintyCommand;

impl Analysis for UncertaintyCommand {
    fn name(&self) -> &'static str {
        "uncertainty"
    }

    fn about(&self) -> &'static str {
        "Complex eigenvalues, and how probable instability is with the uncertain scalars of the case"
    }

    fn example(&self) -> Option<&'static str> {
        Some(
            "[uncertainty.all.parameter.mu] with `path = \"contact.NAME.friction.mu0\"`, `between = [0.2, 0.6]` and \
             `deviation = 0.05`",
        )
    }

    fn listed(&self, case: &Case) -> bool {
        !case.uncertainty.is_empty()
    }

    fn needs(&self) -> &'static [&'static str] {
        &["cea"]
    }

    fn plan<'a>(&self, _: &'a Prepared<'a>, _: Scope) -> Result<Box<dyn Planned<'a> + 'a>> {
        Ok(Box::new(PlannedStudies {
            phase: "samples of uncertain scalars",
            studies: &|explorer, known, results, record| explorer.uncertainty(known, results, record),
        }))
    }
}
