//! Sweeps, maps and what damping decides: sections of the page, pictures, tables, and what was found in words.

mod map;
mod sweep;
mod words;

pub(super) use words::{critical_table, damping_table, map_words, sweep_words};

use super::html::{escape, figure, titled_table};
use crate::results::{FileNames, RunResults, write_result};
use crate::sweep::Axis;
use std::path::Path;

/// A picture with its file name and its caption.
pub(super) struct Drawn {
    file: String,
    caption: String,
    svg: String,
}

/// Writes the pictures of every sweep and map into the folder.
pub(super) fn write(dir: &Path, results: &RunResults) -> crate::error::Result<()> {
    let (mut names, mut map_names) = (FileNames::default(), FileNames::default());
    let sweeps = results.sweeps.iter().flat_map(|of| sweep::pictures(of, &names.next(&of.name)));
    let maps = results.maps.iter().filter_map(|of| map::picture(of, &map_names.next(&of.name)));
    for drawn in sweeps.chain(maps) {
        write_result(dir, &drawn.file, drawn.svg.as_bytes())?;
    }
    Ok(())
}

/// The part of the page on sweeps, maps and damping; empty when the run has none.
pub(super) fn section(results: &RunResults) -> String {
    let mut body = String::new();
    let say =
        |words: Vec<String>| -> String { words.iter().map(|w| format!("<p>{}</p>\n", escape(w))).collect() };
    for result in &results.sweeps {
        body += &format!("<h2>Sweep: {}</h2>\n{}", escape(&result.name), say(sweep_words(result)));
        for drawn in sweep::pictures(result, "") {
            body += &figure(&drawn.svg, &drawn.caption);
        }
        body += &titled_table(&critical_table(result));
    }
    for result in &results.maps {
        body += &format!("<h2>Map: {}</h2>\n{}", escape(&result.name), say(map_words(result)));
        if let Some(drawn) = map::picture(result, "") {
            body += &figure(&drawn.svg, &drawn.caption);
        }
    }
    if let Some(verdicts) = &results.damping {
        body += &format!("<h2>What damping decides</h2>\n{}", titled_table(&damping_table(verdicts)));
    }
    body
}

/// A parameter's path with its unit, for axes.
fn axis_name(path: &str, unit: &str) -> String {
    if unit.is_empty() { path.to_string() } else { format!("{path} [{unit}]") }
}

/// A value's place on an axis: itself, or its logarithm.
fn place(axis: &Axis, value: f64) -> f64 {
    if axis.log { value.abs().log10() } else { value }
}

/// The value at a place.
fn value_at(axis: &Axis, place: f64) -> f64 {
    if axis.log { axis.from.signum() * 10f64.powf(place) } else { place }
}
