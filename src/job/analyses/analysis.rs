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
#[derive(Debug, Clone, Copy)]
pub struct Analysis {
    /// The name of its subcommand and of its table in the case.
    pub name: &'static str,
    /// One line for the help of its subcommand.
    pub about: &'static str,
    /// An example of the table of the case that it cannot do without, if there is one.
    pub example: Option<&'static str>,
    /// Whether the case asks for it.
    pub listed: fn(&Case) -> bool,
    /// Whether the case has what it cannot do without.
    pub ready: fn(&Case) -> bool,
    /// Names of the analyses whose results it starts from.
    pub needs: &'static [&'static str],
    /// Whether it takes the left vectors of the complex modes.
    pub left_vectors: bool,
    /// Finds all faults of its input before anything is computed.
    pub plan: Plan,
}

/// What [`Analysis::plan`] is.
type Plan = for<'a> fn(&'a Prepared<'a>, Scope) -> Result<Box<dyn Planned<'a> + 'a>>;

impl Analysis {
    /// The error of a case without its table.
    pub fn no_table(&self) -> Error {
        let expected = format!("a table such as {}", self.example.unwrap_or_default());
        Error::input(Fault::new(format!("`{}`", self.name), "no such table in the case", expected))
    }
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
    /// An analysis without an answer; what [`Run::found`] returns.
    fn run(self: Box<Self>, run: &mut Run<'a, '_>) -> Result<()>;
}
