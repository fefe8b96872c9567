//! `stridor new`: a folder with the reference case and a small mesh to start from.

use super::mesh::refuse_existing;
use super::output::{Common, say};
use crate::error::{Error, Result};
use crate::mesh::generate::{self, RigSpec};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// The reference case of the validation suite is what users start from: one text, checked by every run of the suite.
const TEMPLATE: &str = include_str!("../../validation/rig/case.toml");
const TEMPLATE_MESH: &str = "../../meshes/rig-medium.msh";
/// The JSON Schema beside it, which editors find by the first line of the case.
const SCHEMA: &str = "case.schema.json";

#[derive(Args)]
pub struct NewOptions {
    /// The folder to create; its case file is NAME/case.toml
    name: PathBuf,
}

pub fn run(options: &NewOptions, common: &Common) -> Result<ExitCode> {
    let folder = &options.name;
    refuse_existing(folder, "Choose another name, or move it away")?;
    std::fs::create_dir_all(folder)
        .map_err(|error| Error::io(folder, error, "Choose a folder that can be written"))?;
    crate::mesh::write(&folder.join("rig.msh"), &generate::rig(&RigSpec::medium())?, 1e-3)?;
    let case = folder.join("case.toml");
    let text = format!("#:schema {SCHEMA}\n{}", TEMPLATE.replace(TEMPLATE_MESH, "rig.msh"));
    for (file, text) in [(&case, text), (&folder.join(SCHEMA), super::schema::of_cases())] {
        std::fs::write(file, text)
            .map_err(|error| Error::io(file, error, "Choose a folder that can be written"))?;
    }
    if !common.quiet {
        say(format!("{} and its mesh are ready. Next: stridor run {}", case.display(), case.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}
