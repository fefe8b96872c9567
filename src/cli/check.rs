//! `stridor check`: the case and its mesh, without an analysis.

use super::Common;
use crate::case::read_case;
use crate::error::Result;
use crate::job::Prepared;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Options {
    /// The case file (TOML)
    case: PathBuf,
    /// Also list every scalar with its path and value in SI units
    #[arg(long)]
    parameters: bool,
    /// Also print the resolved case, every default written out
    #[arg(long)]
    resolved: bool,
}

pub fn run(options: &Options, common: &Common) -> Result<ExitCode> {
    let case = read_case(&options.case)?;
    let prepared = Prepared::new(&case)?;
    if options.resolved {
        print!("{}", case.to_toml());
    }
    if options.parameters {
        for (path, value) in case.parameters() {
            println!("{path} = {value}");
        }
    }
    if !common.quiet && !options.resolved && !options.parameters {
        for warning in &prepared.warnings {
            println!("warning: {warning}");
        }
        let size = prepared.size();
        println!(
            "{}: sound. {} nodes, {} elements, {} degrees of freedom, {} contact points within reach.",
            options.case.display(),
            size.nodes,
            size.elements,
            size.dofs,
            size.contact_points
        );
    }
    Ok(ExitCode::SUCCESS)
}
