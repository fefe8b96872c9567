//! `stridor run`, `modes` and `cea`.

use super::Common;
use super::progress::Bars;
use crate::case::read_case;
use crate::error::Result;
use crate::job::{Selection, run_case};
use crate::report;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// What the three analysis commands take.
#[derive(Args)]
pub struct Options {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for the results; `results/NAME` by default, NAME being the case file's
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(options: &Options, common: &Common, selection: Selection) -> Result<ExitCode> {
    let case = read_case(&options.case)?;
    let name = options.case.file_stem().unwrap_or_default();
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("results").join(name));
    let results = run_case(&case, selection, &out, &Bars::new(common.quiet))?;
    if common.json {
        println!("{}", crate::results::summary_json(&results));
    } else if !common.quiet {
        print!("{}", report::text::summary(&results));
        println!("\nResults are in {}: open report.html, or *.vtu in ParaView.", out.display());
    }
    Ok(ExitCode::SUCCESS)
}
