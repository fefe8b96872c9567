//! `stridor import`: a case and a mesh of a model of another program.

use super::mesh::refuse_existing;
use super::new::{create, schema_line, write_into};
use super::output::{Common, SUCCESS, give, say};
use crate::case::read_case;
use crate::decks::{self, Converted, Deck, Format, Units, convert};
use crate::error::Result;
use crate::job::{Prepared, check_case};
use crate::mesh::to_msh_exactly;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct ImportOptions {
    /// The file of the other program
    file: PathBuf,
    /// The units of its numbers, which no file states: m, mm (t, N, MPa), mm-kg, mm-kg-ms, cm, in
    #[arg(long, value_name = "UNITS")]
    unit: String,
    /// The folder to create: case.toml, mesh.msh and import.md, which says what was read
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The format of the file, where the ending of its name is that of another
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
}

pub fn run(options: &ImportOptions, common: &Common) -> Result<u8> {
    let folder = &options.out;
    let (deck, made) = import_deck(&options.file, &options.unit, options.format.as_deref(), folder)?;
    if common.quiet && !common.json {
        return Ok(SUCCESS);
    }
    let case = folder.join("case.toml");
    let valid = valid(&case);
    if common.json {
        let fault = valid.as_ref().err().map(ToString::to_string);
        let rows = made.ledger.rows().map(|row| {
            json!({ "what": row.what, "why": row.why, "matters": row.weight.word(), "first": deck.words(row.first), "count": row.count })
        });
        give(format!(
            "{:#}",
            json!({
                "ok": true, "case": case.display().to_string(), "valid": valid.is_ok(), "fault": fault,
                "nodes": deck.nodes.len(), "elements": deck.elements.len(), "mass": made.mass,
                "warnings": made.warnings, "unread": rows.collect::<Vec<_>>(),
            })
        ))?;
        return Ok(SUCCESS);
    }
    say(summary(&made, deck.nodes.len(), deck.elements.len()))?;
    match valid {
        Ok(()) => say(format!("{} is valid. Next: stridor run {}", case.display(), case.display()))?,
        Err(error) => say(format!("warning: {} does not run yet. {error}", case.display()))?,
    }
    Ok(SUCCESS)
}

/// Makes a case and a mesh in the new folder `folder` of the model in `file`, whose numbers are in the units called `unit`, as `stridor import` does.
///
/// # Errors
/// Every fault of the file; units or a format that there are not; a folder that is there already, or one that cannot be written.
pub fn import_deck(
    file: &Path,
    unit: &str,
    format: Option<&str>,
    folder: &Path,
) -> Result<(Deck, Converted)> {
    refuse_existing(folder, "Choose another name, or move it away")?;
    let units = Units::named(unit)?;
    let format = format.map(Format::named).transpose()?;
    let deck = decks::read(file, format)?;
    let made = convert(&deck, units)?;
    write(folder, &made)?;
    Ok((deck, made))
}

fn write(folder: &Path, made: &Converted) -> Result<()> {
    let mesh = to_msh_exactly(&made.mesh)?;
    create(folder)?;
    write_into(folder, "case.toml", &format!("{}\n{}", schema_line(), made.case))?;
    write_into(folder, Converted::MESH_FILE, &mesh)?;
    if let Some(equations) = &made.equations {
        write_into(folder, Converted::EQUATIONS_FILE, equations)?;
    }
    write_into(folder, "import.md", &made.page)
}

fn valid(case: &Path) -> Result<()> {
    let case = read_case(case)?;
    let prepared = Prepared::new(&case)?;
    check_case(&prepared).map_err(|error| case.places.locate(error)).map(|_| ())
}

fn summary(made: &Converted, nodes: usize, elements: usize) -> String {
    let mut text = format!(
        "{nodes} nodes, {elements} elements, {} kg in all.",
        crate::numbers::significant(made.mass, 6)
    );
    for warning in &made.warnings {
        text += &format!("\nwarning: {warning}.");
    }
    let rows = made.ledger.rows().filter(|row| row.weight == decks::Weight::Matters);
    for row in rows {
        text += &format!("\nnot read: {}: {} ({} times)", row.what, row.why, row.count);
    }
    text + "\nimport.md says what was read."
}
