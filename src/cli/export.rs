//! `stridor export`: a case as matrices, or as a model of another program.

use super::mesh::refuse_existing;
use super::output::{Common, SUCCESS, give, say};
use crate::case::{Case, read_case};
use crate::decks::{self, Format, Weight};
use crate::error::{Error, Fault, Result};
use crate::job::{ContactAs, Prepared, deck, export};
use crate::results::write_atomically;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct ExportOptions {
    /// The case file (TOML)
    case: PathBuf,
    /// The folder for mass.mtx, stiffness.mtx, damping.mtx, dofs.csv, contact points and a case that takes them; or a file for the model:
    /// .inp of Abaqus and CalculiX, .bdf of NASTRAN
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// The contacts as terms of C and K, linearised at steady sliding: the matrices of small motions
    #[arg(long)]
    linearised: bool,
    /// Overwrite an existing file of a model
    #[arg(long)]
    force: bool,
}

pub fn run(options: &ExportOptions, common: &Common) -> Result<u8> {
    let case = read_case(&options.case)?;
    let out = &options.out;
    keeps_the_case(&options.case, out)?;
    match format_of(out)? {
        Some(format) if !options.linearised => {
            if !options.force {
                refuse_existing(out, "`--force` overwrites it")?;
            }
            model(&case, format, out, common)
        }
        Some(_) => {
            let help = "Leave --linearised out, or give --out the name of a folder";
            let fault =
                Fault::new("--linearised", "a model of another program", "matrices, which have no laws");
            Err(Error::input(fault.with_help(help)))
        }
        None => matrices(&case, options, common),
    }
}

/// The format of the file that is to be written; none for a folder, whose name has no ending, or one of digits as in `run-1.5`.
fn format_of(out: &Path) -> Result<Option<Format>> {
    let ending = out.extension().unwrap_or_default().to_string_lossy();
    let format = Format::of_path(out).ok().filter(|format| format.is_written());
    if ending.bytes().all(|byte| byte.is_ascii_digit()) || format.is_none() && out.is_dir() {
        return Ok(None);
    }
    let found = match format {
        Some(format) if !out.is_dir() => return Ok(Some(format)),
        Some(_) => format!("`{}`, a folder with the name of a file", out.display()),
        None => format!("`{}`, which ends in `.{ending}`", out.display()),
    };
    let expected =
        format!("a file that ends in {}, or a folder without an ending", Format::written_endings());
    Err(Error::input(Fault::new("--out", found, expected)))
}

/// Fails where a case that no export wrote would be written over: the one that is exported, or another in the folder.
fn keeps_the_case(case: &Path, out: &Path) -> Result<()> {
    let written = if out.is_dir() { out.join("case.toml") } else { out.to_path_buf() };
    let same = written.canonicalize().ok().is_some_and(|path| case.canonicalize().ok() == Some(path));
    let found = if same {
        "the case itself"
    } else if out.is_dir() && written.exists() && !out.join("dofs.csv").exists() {
        "a case that no export wrote"
    } else {
        return Ok(());
    };
    let found = format!("{found}, `{}`", written.display());
    let fault = Fault::new("--out", found, "a place where nothing is lost");
    Err(Error::input(fault.with_help("Give the name of another folder or file")))
}

fn matrices(case: &Case, options: &ExportOptions, common: &Common) -> Result<u8> {
    let contact = if options.linearised { ContactAs::Matrices } else { ContactAs::Points };
    let left_out = export(case, contact, &options.out)?;
    if !common.quiet {
        for sentence in left_out {
            say(format!("warning: {sentence}."))?;
        }
        say(format!("M, C and K are in {}; case.toml there takes them.", options.out.display()))?;
    }
    Ok(SUCCESS)
}

fn model(case: &Case, format: Format, out: &Path, common: &Common) -> Result<u8> {
    let prepared = Prepared::new(case)?;
    let deck = deck(&prepared)?;
    let Some(written) = decks::write(&deck, format) else { return Ok(SUCCESS) };
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    write_atomically(folder, &name, written.text.as_bytes())?;
    let (nodes, elements) = (deck.nodes.len(), deck.elements.len());
    if common.json {
        let rows = written.left_out.rows().map(|row| {
            json!({ "what": row.what, "why": row.why, "matters": row.weight.word(), "count": row.count })
        });
        let rows = rows.collect::<Vec<_>>();
        let file = out.display().to_string();
        give(format!(
            "{:#}",
            json!({ "ok": true, "file": file, "nodes": nodes, "elements": elements, "unwritten": rows })
        ))?;
    } else if !common.quiet {
        for row in written.left_out.rows() {
            let head = if row.weight == Weight::Matters { "warning: " } else { "" };
            let times = if row.count > 1 { format!(" ({} times)", row.count) } else { String::new() };
            say(format!("{head}{}: {}{times}.", row.what, row.why))?;
        }
        say(format!("{nodes} nodes and {elements} elements in {}, in m, kg, s (N, Pa).", out.display()))?;
    }
    Ok(SUCCESS)
}
