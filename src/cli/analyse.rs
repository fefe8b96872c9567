//! `stridor run`, `modes`, `cea` and `sweep`.

use super::progress::Bars;
use super::{Common, give, say};
use crate::case::read_case;
use crate::error::Result;
use crate::job::{Selection, run_case};
use crate::report;
use clap::Args;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What the analysis commands take.
#[derive(Args)]
pub struct Options {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for the results; `results/NAME` by default, NAME being the case file's, or its folder's for case.toml
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Take up the maps and the run in time that an interrupted run of the same case left in the folder
    #[arg(long)]
    resume: bool,
}

pub fn run(options: &Options, common: &Common, selection: Selection) -> Result<ExitCode> {
    let case = read_case(&options.case)?;
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("results").join(case_name(&options.case)));
    let results = run_case(&case, selection, &out, options.resume, &Bars::new(common.quiet));
    let results = results.map_err(|error| case.places.locate(error))?;
    if common.json {
        give(crate::results::summary_json(&results))?;
    } else if !common.quiet {
        say(report::text::summary(&results))?;
        say(format!("Results are in {}: open report.html, or *.vtu in ParaView.", out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What the results of a case file are called: `disc.toml` → `disc`, `rig/case.toml` → `rig`.
fn case_name(case: &Path) -> OsString {
    let stem = case.file_stem().unwrap_or_default();
    let folder = case.parent().and_then(Path::file_name);
    folder.filter(|_| stem == "case").unwrap_or(stem).to_os_string()
}
