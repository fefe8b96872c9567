//! `stridor validate`: computed beside reference, one row a quantity.

use super::output::{Common, complain, give, say};
use super::progress::Bars;
use crate::error::Result;
use crate::report::write_validation;
use crate::results::{FolderLock, Provenance, passed};
use crate::validation;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct ValidateOptions {
    /// Only the validation cases whose folder name contains this
    filter: Option<String>,
    /// The folder that holds the validation cases
    #[arg(long, value_name = "DIR", default_value = "validation")]
    from: PathBuf,
    /// Write the page validation.html with its picture into this folder
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

pub fn run(options: &ValidateOptions, common: &Common) -> Result<u8> {
    let _lock = options.report.as_deref().map(FolderLock::take).transpose()?;
    let provenance = Provenance::now("", "");
    let cases = validation::run(&options.from, options.filter.as_deref(), &Bars::new(common.quiet))?;
    if common.json {
        give(validation::to_json(&cases))?;
    } else if !common.quiet {
        say(validation::table(&cases).trim_end())?;
    }
    if let Some(folder) = &options.report {
        let inputs = validation::inputs(&options.from, options.filter.as_deref())?;
        write_validation(folder, &cases, &provenance, &inputs)?;
    }
    let [all, within] = passed(&cases);
    let failed = all - within;
    if failed > 0 {
        complain(format!("{failed} of {all} quantities are outside their tolerance"));
    }
    Ok(u8::from(failed > 0))
}
