//! `stridor export`: a case as matrices, for other programs and for tests.

use super::output::{Common, SUCCESS, say};
use crate::case::read_case;
use crate::error::Result;
use crate::job::{ContactAs, export};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct ExportOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for mass.mtx, stiffness.mtx, damping.mtx, dofs.csv, contact points and a case that takes them
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The contacts as terms of C and K, linearised at steady sliding: the matrices of small motions
    #[arg(long)]
    linearised: bool,
}

pub fn run(options: &ExportOptions, common: &Common) -> Result<u8> {
    let contact = if options.linearised { ContactAs::Matrices } else { ContactAs::Points };
    let left_out = export(&read_case(&options.case)?, contact, &options.out)?;
    if !common.quiet {
        for sentence in left_out {
            say(format!("warning: {sentence}."))?;
        }
        say(format!("M, C and K are in {}; case.toml there takes them.", options.out.display()))?;
    }
    Ok(SUCCESS)
}
