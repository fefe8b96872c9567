//! `stridor run`, `compare`, and a subcommand for every analysis.

use super::engine::{EngineName, with_engine};
use super::examples;
use super::output::{Common, SUCCESS, give, say, window_width};
use super::progress::Bars;
use crate::case::read_case;
use crate::error::Result;
use crate::job::{ANALYSES, RunOptions, Selection, run_case};
use crate::linalg::Engine;
use crate::report;
use clap::{ArgMatches, Args, FromArgMatches, Subcommand};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A subcommand that runs analyses.
pub struct Analyse {
    selection: Selection,
    options: AnalyseOptions,
}

/// The options of these subcommands.
#[derive(Args)]
struct AnalyseOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for the results; `results/NAME` by default, NAME being the case file's, or its folder's for case.toml
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume the maps and the run in time that an interrupted run of the same case left in the folder
    #[arg(long)]
    resume: bool,
    /// Distribute the matrices over the ranks of `mpirun`
    #[arg(long, value_name = "NAME")]
    engine: Option<EngineName>,
}

/// Name, help and analyses of every subcommand.
fn commands() -> impl Iterator<Item = (&'static str, &'static str, Selection)> {
    let run = ("run", "Run every analysis of a case and write a results folder", Selection::Listed);
    let each = ANALYSES.map(|analysis| (analysis.name(), analysis.about(), Selection::Only(analysis.name())));
    let about = "Compare measured with computed real modes and frequency responses";
    std::iter::once(run).chain(each).chain([("compare", about, Selection::Measured)])
}

impl Subcommand for Analyse {
    fn augment_subcommands(command: clap::Command) -> clap::Command {
        commands().fold(command, |command, (name, about, _)| {
            let own = AnalyseOptions::augment_args(clap::Command::new(name)).about(about);
            command.subcommand(own.after_help(examples::of_analysis(name)))
        })
    }

    fn augment_subcommands_for_update(command: clap::Command) -> clap::Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        commands().any(|(own, ..)| own == name)
    }
}

impl FromArgMatches for Analyse {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, clap::Error> {
        let chosen = matches.subcommand().and_then(|(name, inner)| {
            commands().find(|(own, ..)| *own == name).map(|found| (found.2, inner))
        });
        let (selection, inner) =
            chosen.ok_or_else(|| clap::Error::new(clap::error::ErrorKind::InvalidSubcommand))?;
        Ok(Analyse { selection, options: AnalyseOptions::from_arg_matches(inner)? })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> std::result::Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

pub fn run(analyse: &Analyse, common: &Common) -> Result<u8> {
    let Analyse { selection, options } = analyse;
    with_engine(options.engine, *selection, |engine| run_with(analyse, engine, common))
}

fn run_with(analyse: &Analyse, engine: &Engine, common: &Common) -> Result<u8> {
    let Analyse { selection, options } = analyse;
    let case = read_case(&options.case)?;
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("results").join(case_name(&options.case)));
    let run_options = RunOptions { resume: options.resume, engine: engine.clone() };
    let results = run_case(&case, *selection, &out, &run_options, &Bars::new(common.quiet));
    let results = results.map_err(|error| case.places.locate(error))?;
    if common.json {
        give(crate::results::summary_json(&results))?;
    } else if !common.quiet {
        say(report::text::summary(&results, window_width()))?;
        say(format!("Results are in {}: open report.html, or *.vtu in ParaView.", out.display()))?;
    }
    Ok(SUCCESS)
}

/// Name of the results folder of a case file: `disc.toml` → `disc`, `rig/case.toml` → `rig`, also from within that folder.
fn case_name(case: &Path) -> OsString {
    let path = std::path::absolute(case).unwrap_or_else(|_| case.to_path_buf());
    let stem = path.file_stem().unwrap_or_default();
    let folder = path.parent().and_then(Path::file_name);
    folder.filter(|_| stem == "case").unwrap_or(stem).to_os_string()
}
