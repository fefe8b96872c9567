//! The examples below the help of each subcommand; a test reads every line as a command line.

use crate::job::SHARED;

pub const PROGRAM: &str = "\
Examples:
  stridor new rig                          A case and a mesh to start from
  stridor check rig/case.toml              What is wrong or unlikely in it
  stridor run rig/case.toml                Every analysis of the case, into results/rig
  stridor run --help                       The options of a subcommand";

pub const SEARCH: &str = "\
Examples:
  stridor search search.toml
  stridor search search.toml --out found --resume";

pub const CHECK: &str = "\
Examples:
  stridor check rig/case.toml
  stridor check rig/case.toml --parameters     Paths for [sweep], [sensitivity] and [calibrate]
  stridor check rig/case.toml --json           Faults, warnings, sizes and memory, for programs";

pub const SCHEMA: &str = "\
Examples:
  stridor schema
  stridor schema --markdown";

pub const EXPORT: &str = "\
Examples:
  stridor export rig/case.toml --out matrices
  stridor export rig/case.toml --linearised --out matrices
  stridor export brake/case.toml --out brake.inp     A model of Abaqus and CalculiX; .bdf: of NASTRAN";

pub const IMPORT: &str = "\
Examples:
  stridor import brake.inp --unit mm --out brake";

pub const NEW: &str = "\
Examples:
  stridor new rig
  stridor new pad --template pad";

pub const MESH: &str = "\
Examples:
  stridor mesh rig --out rig.msh --contact-size '1 mm'
  stridor mesh disc --out disc.msh --outer-radius '150 mm' --size '4 mm'
  stridor mesh info rig.msh --unit mm";

pub const VALIDATE: &str = "\
Examples:
  stridor validate
  stridor validate rig --report results/validation";

pub const COMPLETIONS: &str = "\
Examples:
  stridor completions bash                     To ~/.local/share/bash-completion/completions/stridor
  stridor completions zsh                      To a folder of $fpath, as _stridor
  stridor completions fish                     To ~/.config/fish/completions/stridor.fish";

pub const MAN: &str = "\
Examples:
  stridor man
  stridor man run
  stridor man --out man1";

/// Of a subcommand that runs analyses.
pub fn of_analysis(name: &str) -> String {
    let parts = match SHARED.contains(&name) {
        true => format!(
            "\n  stridor {name} rig/case.toml --part 3/40       The third of 40 parts of a job array\n  \
             stridor {name} rig/case.toml --merge           One result of all 40"
        ),
        false => String::new(),
    };
    format!(
        "Examples:\n  stridor {name} rig/case.toml\n  stridor {name} rig/case.toml --out results/softer --threads 4\n  \
         stridor {name} rig/case.toml --json --quiet{parts}"
    )
}
