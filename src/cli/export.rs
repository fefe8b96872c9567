//! `stridor export`: a case as matrices, for other programs and for tests.

use super::output::{Common, SUCCESS, say};
use crate::case::read_case;
use crate::error::Result;
use crate::job::export;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct ExportOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for mass.mtx, stiffness.mtx, damping.mtx, dofs.csv, contact points and a case that takes them
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub fn run(options: &ExportOptions, common: &Common) -> Result<u8> {
    let left_out = export(&read_case(&options.case)?, &options.out)?;
    if !common.quiet {
        for sentence in left_out {
            say(format!("warning: {sentence}."))?;
        }
        say(format!("M, C and K are in {}; case.toml there takes them.", options.out.display()))?;
    }
    Ok(SUCCESS)
}
