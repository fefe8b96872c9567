//! `stridor validate`: computed beside reference, one row a quantity.

use super::progress::Bars;
use super::{Common, complain, say};
use crate::error::Result;
use crate::validation;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Options {
    /// Only the validation cases whose folder name contains this
    filter: Option<String>,
    /// The folder that holds the validation cases
    #[arg(long, value_name = "DIR", default_value = "validation")]
    from: PathBuf,
}

pub fn run(options: &Options, common: &Common) -> Result<ExitCode> {
    let rows = validation::run(&options.from, options.filter.as_deref(), &Bars::new(common.quiet))?;
    if common.json {
        say(validation::to_json(&rows))?;
    } else if !common.quiet {
        say(validation::table(&rows).trim_end())?;
    }
    let failed = rows.iter().filter(|row| !row.passed()).count();
    if failed > 0 {
        complain(format!("{failed} of {} quantities are outside their tolerance", rows.len()));
    }
    Ok(ExitCode::from(u8::from(failed > 0)))
}
