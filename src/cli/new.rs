//! `stridor new`: a folder with a case to start from, and the files that it reads.

use super::mesh::refuse_existing;
use super::output::{Common, say};
use super::templates::Template;
use crate::error::{Error, Result};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// The JSON Schema beside it, which editors find by the first line of the case.
const SCHEMA: &str = "case.schema.json";

#[derive(Args)]
pub struct NewOptions {
    /// The folder to create; its case file is NAME/case.toml
    name: PathBuf,
    /// The case to start from
    #[arg(long, value_enum, default_value = "rig")]
    template: Template,
}

pub fn run(options: &NewOptions, common: &Common) -> Result<ExitCode> {
    let folder = &options.name;
    refuse_existing(folder, "Choose another name, or move it away")?;
    let failed = |path: &PathBuf, error| Error::io(path, error, "Choose a folder that can be written");
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    options.template.write(folder, &format!("#:schema {SCHEMA}"))?;
    let schema = folder.join(SCHEMA);
    std::fs::write(&schema, super::schema::of_cases()).map_err(|error| failed(&schema, error))?;
    if !common.quiet {
        let case = folder.join("case.toml").display().to_string();
        say(format!("{case} is ready, with its files. Next: stridor run {case}"))?;
    }
    Ok(ExitCode::SUCCESS)
}
