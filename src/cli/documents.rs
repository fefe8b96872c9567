//! `stridor completions` and `stridor man`: what a shell and a manual hold of the command line, from its one declaration.

use super::output::{Common, SUCCESS, give, say};
use crate::error::{Error, Fault, Result, nearest};
use clap::{Args, Command};
use clap_complete::{Shell, generate};
use std::path::PathBuf;

#[derive(Args)]
pub struct CompletionsOptions {
    /// The shell
    shell: Shell,
}

/// Prints the completions of a shell.
pub fn completions(options: &CompletionsOptions, mut command: Command) -> Result<u8> {
    let mut script = Vec::new();
    let name = command.get_name().to_string();
    generate(options.shell, &mut command, name, &mut script);
    give(String::from_utf8_lossy(&script).trim_end())?;
    Ok(SUCCESS)
}

#[derive(Args)]
pub struct ManOptions {
    /// The subcommand; the program's own page without one
    command: Option<String>,
    /// Write the pages of all commands into this folder instead
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    out: Option<PathBuf>,
}

/// Prints a page of the manual, or writes all.
pub fn man(options: &ManOptions, mut command: Command, common: &Common) -> Result<u8> {
    let refused = |error| Error::io(PathBuf::from("manual"), error, "Choose a folder that can be written");
    if let Some(folder) = &options.out {
        let refused = |error| Error::io(folder, error, "Choose a folder that can be written");
        std::fs::create_dir_all(folder).map_err(refused)?;
        let first = folder.join(command.get_name()).with_extension("1");
        clap_mangen::generate_to(command, folder).map_err(refused)?;
        if !common.quiet {
            say(format!("The manual is in {}: man {}", folder.display(), first.display()))?;
        }
        return Ok(SUCCESS);
    }
    command.build();
    let page = match &options.command {
        None => command,
        Some(name) => {
            let known: Vec<String> = command.get_subcommands().map(|c| c.get_name().to_string()).collect();
            let of_name = command.find_subcommand(name).cloned();
            of_name.ok_or_else(|| unknown(name, &known))?
        }
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(refused)?;
    give(String::from_utf8_lossy(&text).trim_end())?;
    Ok(SUCCESS)
}

fn unknown(name: &str, known: &[String]) -> Error {
    let near = nearest(name, known.iter().map(String::as_str));
    let help = near.map_or(String::new(), |near| format!("Did you mean `{near}`?"));
    let expected = format!("a subcommand: {}", known.join(", "));
    Error::input(Fault::new("man", format!("\"{name}\""), expected).with_help(help))
}
