//! Options of every subcommand, and what is printed where.

use crate::error::text::printable_lines;
use crate::error::{Error, Result};
use clap::Args;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Options of every subcommand.
#[derive(Args)]
pub struct Common {
    /// No progress and no tables, only errors
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print the summary as JSON instead of tables
    #[arg(long, global = true)]
    pub json: bool,
    /// Number of threads; all cores by default. The numbers do not depend on it
    #[arg(long, global = true, value_name = "N")]
    pub threads: Option<usize>,
}

/// Prints lines for people on stdout, without characters that steer the terminal.
pub fn say(text: impl Display) -> Result<()> {
    give(printable_lines(&text.to_string()))
}

/// Prints data on stdout as it is. A reader that has closed the pipe, such as `head`, is no error.
pub fn give(text: impl Display) -> Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io("standard output", error, "The results folder, if any, is complete"))
        }
        _ => Ok(()),
    }
}

/// Prints a line on stderr, which may be closed.
pub fn complain(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "error: {text}");
}

/// Prints a note on stderr, which may be closed.
pub fn note(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}
