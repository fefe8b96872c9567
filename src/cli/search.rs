//! `stridor search`: numbers of a case, so that it meets facts of any kind.

use super::output::{Common, SUCCESS, give, say, window_width};
use super::progress::Bars;
use crate::dataset::Describe;
use crate::error::Result;
use crate::report::{search_text, write_search};
use crate::results::{FolderLock, Provenance};
use crate::search::{read_search, search};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct SearchOptions {
    /// The file of the search (TOML): a case, its numbers with their bounds, and the facts
    file: PathBuf,
    /// The folder for the results; `results/NAME` by default, NAME being the file's, or its folder's for search.toml
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume from the evaluations that an interrupted run of the same search left in the folder
    #[arg(long)]
    resume: bool,
}

pub fn run(options: &SearchOptions, common: &Common) -> Result<u8> {
    let file = read_search(&options.file)?;
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("results").join(&file.name));
    let _lock = FolderLock::take(&out)?;
    let provenance = Provenance::now(&options.file.to_string_lossy(), file.text());
    let inputs = file.inputs()?;
    let result = search(&file, &out, options.resume, &Bars::new(common.quiet))?;
    result.write(&out)?;
    write_search(&out, &result, &provenance, &inputs)?;
    if common.json {
        give(format!("{:#}", result.describe().to_json()))?;
    } else if !common.quiet {
        say(search_text(&result, window_width()))?;
        say(format!("Results are in {}: open search.html; the case is found.toml.", out.display()))?;
    }
    Ok(SUCCESS)
}
