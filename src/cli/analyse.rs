//! `stridor run`, `compare`, and a subcommand for every analysis; studies in parts.

use super::engine::{EngineName, Ranks};
use super::examples;
use super::interrupt::says_how_to_continue;
use super::output::{Common, SUCCESS, give, say, window_width};
use super::progress::Bars;
use crate::case::read_case;
use crate::error::Result;
use crate::job::{ANALYSES, PartDone, RunOptions, SHARED, Selection, merge_parts, run_case, run_part};
use crate::linalg::Engine;
use crate::report;
use crate::results::RunResults;
use crate::results::record::{Part, RECORD};
use clap::{ArgMatches, Args, FromArgMatches, Subcommand};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A subcommand that runs analyses.
pub struct Analyse {
    name: &'static str,
    selection: Selection,
    options: AnalyseOptions,
    parts: PartOptions,
}

/// The options of these subcommands.
#[derive(Args)]
struct AnalyseOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for the results; `results/NAME` by default, NAME being the case file's, or its folder's for case.toml
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume the maps, the samples and the run in time that an interrupted run of the same case left in the folder
    #[arg(long)]
    resume: bool,
    /// Share the work over the ranks of `mpirun`, by the program `stridor-mpi`
    #[arg(long, value_name = "NAME", conflicts_with = "resume")]
    engine: Option<EngineName>,
}

impl AnalyseOptions {
    fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("results").join(case_name(&self.case)))
    }
}

/// The options of the subcommands whose points several processes can share.
#[derive(Args, Default)]
struct PartOptions {
    /// Compute the I-th of N parts of the points, as job I of a job array of N, into a file of the results folder; a part that was
    /// killed resumes when it is called again
    #[arg(long, value_name = "I/N", conflicts_with_all = ["resume", "engine"])]
    part: Option<String>,
    /// Make the results of one run of all parts in the results folder
    #[arg(long, conflicts_with_all = ["part", "resume", "engine"])]
    merge: bool,
}

/// Name, help and analyses of every subcommand.
fn commands() -> impl Iterator<Item = (&'static str, &'static str, Selection)> {
    let run = ("run", "Run every analysis of a case and write a results folder", Selection::Listed);
    let each = ANALYSES.map(|analysis| (analysis.name, analysis.about, Selection::Only(analysis.name)));
    let about = "Compare measured with computed real modes and frequency responses";
    std::iter::once(run).chain(each).chain([("compare", about, Selection::Measured)])
}

impl Subcommand for Analyse {
    fn augment_subcommands(command: clap::Command) -> clap::Command {
        commands().fold(command, |command, (name, about, _)| {
            let own = AnalyseOptions::augment_args(clap::Command::new(name));
            let own = if SHARED.contains(&name) { PartOptions::augment_args(own) } else { own };
            // After the options: clap takes the comment of their type for the help of the command.
            command.subcommand(own.about(about).after_help(examples::of_analysis(name)))
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
            commands().find(|(own, ..)| *own == name).map(|found| (found.0, found.2, inner))
        });
        let (name, selection, inner) =
            chosen.ok_or_else(|| clap::Error::new(clap::error::ErrorKind::InvalidSubcommand))?;
        let parts = match SHARED.contains(&name) {
            true => PartOptions::from_arg_matches(inner)?,
            false => PartOptions::default(),
        };
        Ok(Analyse { name, selection, options: AnalyseOptions::from_arg_matches(inner)?, parts })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> std::result::Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

pub fn run(analyse: &Analyse, common: &Common, ranks: Option<&dyn Ranks>) -> Result<u8> {
    let Analyse { name, selection, options, parts } = analyse;
    if let Some(part) = parts.part.as_deref().map(Part::read).transpose()? {
        run_share(name, part, options, common)?;
    } else if let Some(engine) = options.engine {
        let ranks = engine.on(ranks, *selection)?;
        match engine {
            EngineName::Mpi => run_on_ranks(ranks, name, options, common)?,
            _ => ranks.matrices(engine == EngineName::SlepcKrylovSchur, &mut |engine| {
                run_with(analyse, engine, common)
            })?,
        }
    } else {
        run_with(analyse, &Engine::default(), common)?;
    }
    Ok(SUCCESS)
}

/// Points of studies over the ranks; rank 0 prints.
fn run_on_ranks(
    ranks: &dyn Ranks,
    analysis: &'static str,
    options: &AnalyseOptions,
    common: &Common,
) -> Result<()> {
    let out = options.out();
    let results = ranks.points(read_case(&options.case), analysis, &out, &Bars::new(common.quiet))?;
    results.map_or(Ok(()), |results| print_results(&results, &out, common))
}

fn run_with(analyse: &Analyse, engine: &Engine, common: &Common) -> Result<()> {
    let Analyse { name, selection, options, parts } = analyse;
    let case = read_case(&options.case)?;
    let (out, bars) = (options.out(), Bars::new(common.quiet));
    says_how_to_continue(&out.join(RECORD));
    let results = match parts.merge {
        true => merge_parts(&case, name, &out, None, &bars),
        false => {
            let run_options = RunOptions { resume: options.resume, engine: engine.clone() };
            run_case(&case, *selection, &out, &run_options, &bars)
        }
    };
    print_results(&results.map_err(|error| case.places.locate(error))?, &out, common)
}

fn print_results(results: &RunResults, out: &Path, common: &Common) -> Result<()> {
    if common.json {
        give(crate::results::summary_json(results))?;
    } else if !common.quiet {
        say(report::text::summary(results, window_width()))?;
        say(format!("Results are in {}: open report.html, or *.vtu in ParaView.", out.display()))?;
    }
    Ok(())
}

/// One job of a job array.
fn run_share(analysis: &'static str, part: Part, options: &AnalyseOptions, common: &Common) -> Result<()> {
    let case = read_case(&options.case)?;
    let done = run_part(&case, analysis, part, &options.out(), &Bars::new(common.quiet));
    print_part(part, &done.map_err(|error| case.places.locate(error))?, common)
}

fn print_part(part: Part, done: &PartDone, common: &Common) -> Result<()> {
    let PartDone { points, file } = done;
    if common.json {
        let file = (*points > 0).then(|| file.display().to_string());
        give(serde_json::json!({ "part": part.number, "of": part.of, "points": points, "file": file }))?;
    } else if *points == 0 && !common.quiet {
        say(format!("There are more parts than the points can be cut into: {part} has none."))?;
    } else if !common.quiet {
        say(format!(
            "Done: {part}, {points} points, in {}. When all parts are done: --merge.",
            file.display()
        ))?;
    }
    Ok(())
}

/// Name of the results folder of a case file: `disc.toml` → `disc`, `rig/case.toml` → `rig`, also from within that folder.
fn case_name(case: &Path) -> OsString {
    let path = std::path::absolute(case).unwrap_or_else(|_| case.to_path_buf());
    let stem = path.file_stem().unwrap_or_default();
    let folder = path.parent().and_then(Path::file_name);
    folder.filter(|_| stem == "case").unwrap_or(stem).to_os_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_of_each_analysis_is_its_own() {
        let command = Analyse::augment_subcommands(clap::Command::new("stridor"));
        for (name, about, _) in commands() {
            let shown =
                command.find_subcommand(name).and_then(clap::Command::get_about).map(ToString::to_string);
            assert_eq!(shown.as_deref(), Some(about), "{name}");
        }
    }
}
