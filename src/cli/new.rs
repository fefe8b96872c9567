//! `stridor new`: a folder with a case to start from, and the files that it reads.

use super::mesh::refuse_existing;
use super::output::{Common, SUCCESS, say};
use super::templates::Template;
use crate::error::{Error, Fault, Result};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

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

pub fn run(options: &NewOptions, common: &Common) -> Result<u8> {
    let folder = &options.name;
    write(folder, options.template)?;
    if !common.quiet {
        let case = folder.join("case.toml").display().to_string();
        say(format!("{case} is ready, with its files. Next: stridor run {case}"))?;
    }
    Ok(SUCCESS)
}

/// Writes the template called `template` (`rig`, `pad` …) into the new folder `folder`, as `stridor new` does.
///
/// # Errors
/// A template that there is not, a folder that is there already, or one that cannot be written.
pub fn new_case(folder: &Path, template: &str) -> Result<()> {
    let template = Template::from_str(template, false).map_err(|_| {
        let names = Template::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        let names: Vec<String> = names.map(|value| value.get_name().to_string()).collect();
        let expected = format!("one of {}", names.join(", "));
        Error::input(Fault::new("`template`", format!("\"{template}\""), expected))
    })?;
    write(folder, template)
}

/// Writes a case, the files that it reads, and the schema of its keys.
fn write(folder: &Path, template: Template) -> Result<()> {
    refuse_existing(folder, "Choose another name, or move it away")?;
    create(folder)?;
    template.write(folder, &schema_line())
}

/// The first line of a case beside its schema.
pub(super) fn schema_line() -> String {
    format!("#:schema {SCHEMA}")
}

/// Makes a folder for a case, with the schema of its keys.
pub(super) fn create(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| unwritten(folder, error))?;
    write_into(folder, SCHEMA, &super::schema::of_cases())
}

/// Writes a file of a case.
pub(super) fn write_into(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    std::fs::write(&path, text).map_err(|error| unwritten(&path, error))
}

fn unwritten(path: &Path, error: std::io::Error) -> Error {
    Error::io(path, error, "Choose a folder that can be written")
}
