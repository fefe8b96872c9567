//! Interface of an analysis of a case.

use crate::case::Case;
use crate::error::{Error, Fault, Result};
use crate::job::prepared::Prepared;
use crate::job::run::Run;
use crate::results::RecordSize;

/// Which of its items an analysis takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// All that the case lists.
    All,
    /// Those that were measured.
    Measured,
}

/// An analysis of a case.
pub trait Analysis: Sync {
    /// The name of its subcommand and of its table in the case.
    fn name(&self) -> &'static str;

    /// One line for the help of its subcommand.
    fn about(&self) -> &'static str;

    /// An example of the table of the case that it cannot do without, if there is one.
    fn example(&self) -> Option<&'static str>;

    /// Whether the case asks for it.
    fn listed(&self, case: &Case) -> bool;

    /// Names of the analyses whose results it starts from.
    fn needs(&self) -> &'static [&'static str] {
        &[]
    }

    /// Whether it takes the left vectors of the complex modes.
    fn takes_left_vectors(&self) -> bool {
        false
    }

    /// Whether the case has what it cannot do without.
    fn ready(&self, case: &Case) -> bool {
        self.example().is_none() || self.listed(case)
    }

    /// The error of a case without its table.
    fn no_table(&self) -> Error {
        let expected = format!("a table such as {}", self.example().unwrap_or_default());
        Error::input(Fault::new(format!("`{}`", self.name()), "no such table in the case", expected))
    }

    /// Finds all faults of its input before anything is computed.
    ///
    /// # Errors
    /// These faults.
    fn plan<'a>(&self, prepared: &'a Prepared<'a>, scope: Scope) -> Result<Box<dyn Planned<'a> + 'a>>;
}

/// An analysis whose input has no fault.
pub trait Planned<'a> {
    /// Whether it starts from steady sliding.
    fn slides(&self) -> bool {
        false
    }

    /// Sentences for the user.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// The size of what it records at least, where that does not fit into memory.
    fn record_size(&self) -> Option<RecordSize> {
        None
    }

    /// Runs it; what it finds goes to [`Run::found`].
    ///
    /// # Errors
    /// An analysis without an answer, a machine that refuses.
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()>;
}
