//! Options of every subcommand, and what is printed where.

use super::colour;
use crate::error::text::printable_lines;
use crate::error::{Error, Result};
use clap::Args;
use std::fmt::Display;
use std::io::{ErrorKind, IsTerminal, Write};

/// The exit code of what has gone well.
pub const SUCCESS: u8 = 0;

/// Options of every subcommand.
#[derive(Args)]
pub struct Common {
    /// No progress and no tables, only errors
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print one JSON document on stdout instead of tables: the summary, or what `check` found; of an error, too, with
    /// `"ok": false` and its `faults`, beside the message on stderr
    #[arg(long, global = true)]
    pub json: bool,
    /// Colours of tables and messages; `auto`: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub color: clap::ColorChoice,
    /// Number of threads; all cores by default. The numbers do not depend on it
    #[arg(long, global = true, value_name = "N")]
    pub threads: Option<usize>,
}

/// Prints lines for people on stdout, without characters that steer the terminal but for its own colours.
pub fn say(text: impl Display) -> Result<()> {
    let lines = printable_lines(&text.to_string());
    give(if colour::on_stdout() { colour::of_lines(&lines) } else { lines })
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
    let _ = writeln!(std::io::stderr(), "{}: {text}", colour::on_stderr(colour::RED, "error"));
}

/// Prints a note on stderr, which may be closed.
pub fn note(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{}: {text}", colour::on_stderr(colour::BOLD, "note"));
}

/// Columns of the window that stdout is shown in; those that COLUMNS gives where it is none, and else no limit.
pub fn window_width() -> Option<usize> {
    const LEAST: usize = 40;
    let window = console::Term::stdout().size_checked().map(|(_, columns)| usize::from(columns));
    let window = window.filter(|_| std::io::stdout().is_terminal());
    let given = || std::env::var("COLUMNS").ok()?.parse().ok();
    window.or_else(given).filter(|columns| *columns > 0).map(|columns| columns.max(LEAST))
}
