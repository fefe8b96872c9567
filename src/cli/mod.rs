//! The command line: parses, calls the library, prints what it returns. One file a subcommand.
//!
//! Results go to stdout, progress and errors to stderr; with `--json` stdout gets one JSON document, of an error, too. Exit codes:
//! 0 done, 1 the analysis or the machine failed, 2 the input is wrong.

mod analyse;
mod check;
mod colour;
mod documents;
mod engine;
mod error_json;
mod examples;
mod export;
mod import;
mod interrupt;
mod mesh;
mod new;
mod output;
mod process;
mod progress;
mod schema;
mod search;
mod templates;
mod validate;
mod version;

use crate::error::{Error, Fault, Result};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
pub use engine::Ranks;
pub use import::import_deck;
pub use new::new_case;
use output::{Common, SUCCESS, complain, give};
pub use process::{OrExit, process};
use std::ffi::OsString;
pub use version::VERSION;

#[derive(Parser)]
#[command(name = "stridor", version = VERSION.as_str(), about, propagate_version = true, after_help = examples::PROGRAM)]
struct Command {
    #[command(subcommand)]
    action: Action,
    #[command(flatten)]
    common: Common,
}

#[derive(Subcommand)]
enum Action {
    #[command(flatten)]
    Analyse(analyse::Analyse),
    /// Search for parameters of a case inside bounds, so that its results match given facts
    #[command(after_help = examples::SEARCH)]
    Search(search::SearchOptions),
    /// Check a case and its mesh without running it, and list its parameters
    #[command(after_help = examples::CHECK)]
    Check(check::CheckOptions),
    /// Print the JSON Schema of case files, for editors, or the reference of their keys
    #[command(after_help = examples::SCHEMA)]
    Schema(schema::SchemaOptions),
    /// Write M, C, K, the degrees of freedom and the contact points of a case, or its model, for other programs
    #[command(after_help = examples::EXPORT)]
    Export(export::ExportOptions),
    /// Make a case and a mesh of a model of another program
    #[command(after_help = examples::IMPORT)]
    Import(import::ImportOptions),
    /// Write a case and a mesh to start from
    #[command(after_help = examples::NEW)]
    New(new::NewOptions),
    /// Generate or inspect a mesh
    #[command(subcommand, after_help = examples::MESH)]
    Mesh(mesh::MeshAction),
    /// Run the validation cases and compare computed with reference values
    #[command(after_help = examples::VALIDATE)]
    Validate(validate::ValidateOptions),
    /// Print the completions of a shell
    #[command(after_help = examples::COMPLETIONS)]
    Completions(documents::CompletionsOptions),
    /// Print a page of the manual, or write all
    #[command(after_help = examples::MAN)]
    Man(documents::ManOptions),
}

/// Runs the program on `arguments`, the first of which is its name, and gives its exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    main_with(arguments, None)
}

/// [`main`] with `ranks`: the program `stridor-mpi`.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>, ranks: Option<&dyn Ranks>) -> u8 {
    too_large_is_an_error();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let program = declared(ranks.is_some());
    let read = program.clone().try_get_matches_from(&arguments);
    let command = match read.and_then(|matches| Command::from_arg_matches(&matches)) {
        Ok(command) => command,
        Err(error) => {
            let _ = error.print();
            if error.use_stderr() && arguments.iter().any(|argument| argument == "--json") {
                let message = error.to_string();
                let _ = give(format!("{:#}", error_json::usage_json(message.trim_end())));
            }
            return if error.use_stderr() { 2 } else { SUCCESS };
        }
    };
    colour::choose(command.common.color);
    // On a thread of the pool: work that is too small to be shared then costs no handing over.
    match set_threads(command.common.threads).and_then(|()| rayon::scope(|_| act(&command, program, ranks))) {
        Ok(code) => code,
        Err(error) => {
            if command.common.json {
                let _ = give(format!("{:#}", error_json::error_json(&error)));
            }
            complain(&error);
            error.exit_code()
        }
    }
}

/// A file beyond the limit of its size (`ulimit -f`) is refused by the write, with a message, instead of a signal that
/// ends the process.
fn too_large_is_an_error() {
    #[cfg(unix)]
    // SAFETY: no handler is installed; the signal is ignored from here on.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

/// The command line of the program with ranks or of that without, under its name.
fn declared(ranks: bool) -> clap::Command {
    fn renamed(command: clap::Command) -> clap::Command {
        let examples =
            command.get_after_help().map(|help| help.to_string().replace("  stridor ", "  stridor-mpi "));
        command.after_help(examples.unwrap_or_default()).mut_subcommands(renamed)
    }
    let program = Command::command();
    if ranks { renamed(program.name("stridor-mpi")) } else { program }
}

fn act(command: &Command, program: clap::Command, ranks: Option<&dyn Ranks>) -> Result<u8> {
    let common = &command.common;
    match &command.action {
        Action::Analyse(options) => analyse::run(options, common, ranks),
        Action::Search(options) => search::run(options, common),
        Action::Check(options) => check::run(options, common),
        Action::Schema(options) => schema::run(options, common),
        Action::Export(options) => export::run(options, common),
        Action::Import(options) => import::run(options, common),
        Action::New(options) => new::run(options, common),
        Action::Mesh(action) => mesh::run(action, common),
        Action::Validate(options) => validate::run(options, common),
        Action::Completions(options) => documents::completions(options, program),
        Action::Man(options) => documents::man(options, program, common),
    }
}

/// The most threads that may be requested, unless there are more cores.
const MOST_THREADS: usize = 1024;

/// Starts the threads: as many as there are cores where no number is given.
fn set_threads(threads: Option<usize>) -> Result<()> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (threads, most) = (threads.unwrap_or(cores), MOST_THREADS.max(cores));
    if !(1..=most).contains(&threads) {
        let help = format!("More threads than cores ({cores} here) make nothing faster");
        return Err(Error::input(
            Fault::new("--threads", threads.to_string(), format!("1 to {most}")).with_help(help),
        ));
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|error| {
        Error::analysis(
            format!("starting {threads} threads"),
            error.to_string(),
            "Ask for fewer: `--threads 1`",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::Command;
    use clap::{CommandFactory, Parser};
    use std::collections::BTreeSet;
    use std::path::Path;

    /// Words of the sources below `folder`; unit tests, comments, C, and styles and scripts of the page left out.
    fn words(folder: &Path, text: &mut String) {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                words(&path, text);
            } else if !path.ends_with("tests.rs")
                && !path.extension().is_some_and(|e| ["css", "js", "c", "h"].iter().any(|other| e == *other))
            {
                let file = std::fs::read_to_string(&path).unwrap();
                let code = file.split("#[cfg(test)]\nmod tests {").next().unwrap();
                text.extend(code.lines().filter(|line| !line.trim_start().starts_with("//")));
            }
        }
    }

    /// The words that follow `mark` in `text`.
    fn after(text: &str, mark: &str) -> BTreeSet<String> {
        let word = |(at, _): (usize, &str)| -> String {
            text[at + mark.len()..].chars().take_while(|c| c.is_ascii_lowercase() || *c == '-').collect()
        };
        text.match_indices(mark).map(word).filter(|word| !word.is_empty()).collect()
    }

    #[test]
    fn every_subcommand_has_examples_that_can_be_run() {
        let program = Command::command();
        let mut lines = Vec::new();
        for command in program.get_subcommands().chain([&program]).filter(|c| c.get_name() != "help") {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let examples = help.lines().filter(|line| line.starts_with("  stridor ")).map(str::to_string);
            let before = lines.len();
            lines.extend(examples);
            assert!(lines.len() > before, "{} has no example", command.get_name());
        }
        for line in lines {
            // What follows several blanks says what the command does.
            let command = line.trim().split("   ").next().unwrap();
            let quoted = command.split('\'').enumerate();
            let words = quoted.flat_map(|(k, part)| match k % 2 {
                0 => part.split_whitespace().collect(),
                _ => vec![part],
            });
            let read = Command::try_parse_from(words);
            let shown = read.as_ref().err().is_none_or(|error| !error.use_stderr());
            assert!(shown, "{line}: {}", read.err().unwrap());
        }
    }

    #[test]
    fn every_flag_and_command_that_a_message_names_exists() {
        let mut text = String::new();
        words(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut text);
        // Those of every program, of cargo and of .ci/setup.
        let others = ["help", "version", "release", "features", "mpi", "path"];
        let mut flags = BTreeSet::from(others.map(str::to_string));
        let mut commands = BTreeSet::new();
        let mut left = vec![Command::command()];
        while let Some(command) = left.pop() {
            flags.extend(command.get_arguments().filter_map(|a| Some(a.get_long()?.to_string())));
            commands.insert(command.get_name().to_string());
            left.extend(command.get_subcommands().cloned());
        }
        let (named, called) = (after(&text, "--"), after(&text, "`stridor "));
        assert!(named.len() >= 5 && called.len() >= 2, "{named:?} {called:?}");
        assert!(named.is_subset(&flags), "no such flag: {:?}", named.difference(&flags));
        assert!(called.is_subset(&commands), "no such command: {:?}", called.difference(&commands));
    }
}
