//! Where results come from: program, command, machine, files, times; and the case.

use super::format::{fixed, significant};
use super::html::{PageLayout, escape};
use super::table::ReportTable;
use crate::results::record::InputFile;
use crate::results::{Provenance, RunResults};

/// The tables of the end of the page, and links to the files beside it.
pub(super) fn provenance(results: &RunResults, layout: &mut PageLayout) -> String {
    let mut text = origin(results.provenance.as_ref(), &results.inputs, layout);
    if !results.timings.is_empty() {
        text += &layout.table(&timings(results));
    }
    text + &links(layout)
}

/// Program, command and machine, the case file and the files that were read.
pub(super) fn origin(
    provenance: Option<&Provenance>,
    inputs: &[InputFile],
    layout: &mut PageLayout,
) -> String {
    let mut text = provenance.map_or(String::new(), |p| layout.table(&facts(p)));
    let case = provenance.and_then(|p| p.case_file.as_ref());
    let files = files(case.into_iter().chain(inputs));
    text += &match files.rows.len() {
        0 => String::new(),
        1..=MANY => layout.table(&files),
        _ => layout.closed_table(&files),
    };
    text
}

/// More files than this are opened with a click.
const MANY: usize = 25;

/// Program, command and machine.
fn facts(p: &Provenance) -> ReportTable {
    let mut table = ReportTable::new("Program, command and machine", &["<what", "<value"]);
    let known = |value: Option<String>| value.unwrap_or_else(|| "unknown".into());
    let memory = p.memory_gib().map(|size| format!("{} GiB", fixed(size, 1)));
    let rows = [
        ("program", format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"))),
        ("commit", p.commit.to_string()),
        ("started (UTC)", p.started.clone()),
        ("command", p.command.join(" ")),
        ("threads", p.threads.to_string()),
        ("engine", p.engine.to_string()),
        ("MPI ranks", p.ranks.to_string()),
        ("system", p.system.clone()),
        ("processor", known(p.processor.clone())),
        ("cores", known(p.cores.map(|cores| cores.to_string()))),
        ("memory", known(memory)),
    ];
    rows.into_iter().for_each(|(what, value)| table.row(vec![what.into(), value], false));
    table
}

/// Files with their checksums.
fn files<'a>(files: impl Iterator<Item = &'a InputFile>) -> ReportTable {
    let mut table = ReportTable::new("Files that were read", &["<file", "bytes", "<SHA-256"]);
    for file in files {
        table.row(vec![file.path.clone(), file.bytes.to_string(), file.sha256.clone()], false);
    }
    table
}

/// Where the wall time went.
fn timings(results: &RunResults) -> ReportTable {
    let mut table = ReportTable::new("Wall time", &["<phase", "seconds"]);
    for (phase, seconds) in &results.timings {
        table.row(vec![phase.clone(), significant(*seconds, 3)], false);
    }
    let total: f64 = results.timings.iter().map(|(_, seconds)| seconds).sum();
    table.row(vec!["all".into(), significant(total, 3)], true);
    table
}

/// What the files of a run are, by their extension.
const KINDS: [(&str, &str); 8] = [
    ("h5", "Everything, in full precision (xarray, h5py, MATLAB)"),
    ("json", "Figures for scripts"),
    ("csv", "Tables for spreadsheets"),
    ("svg", "Pictures for papers"),
    ("vtu", "Shapes on the mesh (ParaView)"),
    ("vtkhdf", "Motion of all nodes (ParaView)"),
    ("uff", "Universal files for test-data programs"),
    ("wav", "Sound"),
];

/// The files beside the page, by kind.
fn links(layout: &PageLayout) -> String {
    let ends = |file: &str, kind: &str| file.rsplit_once('.').is_some_and(|(_, end)| end == kind);
    let each = KINDS.iter().filter_map(|(kind, words)| {
        let links = layout.files.iter().filter(|file| ends(file, kind)).filter_map(|file| layout.link(file));
        let links: Vec<String> = links.collect();
        (!links.is_empty()).then(|| format!("<li>{words}: {}</li>\n", links.join(", ")))
    });
    let each: String = each.collect();
    if each.is_empty() { each } else { format!("<h3>Files beside this page</h3>\n<ul>\n{each}</ul>\n") }
}

/// The file of a case as the user wrote it; nothing of one that was no file.
pub(super) fn as_written(title: &str, provenance: &Provenance) -> String {
    if provenance.case_text.is_empty() {
        return String::new();
    }
    let shown = escape(&provenance.case_text.replace('\t', "    ").replace("\r\n", "\n"));
    format!("<details open><summary>{title}</summary><pre>{shown}</pre></details>\n")
}

/// The case as the user wrote it, and as the run used it.
pub(super) fn the_case(results: &RunResults) -> String {
    let text = results.provenance.as_ref().map_or(String::new(), |p| as_written("The case file", p));
    let resolved = escape(&results.resolved_case);
    text + &format!(
        "<details><summary>Every value as the run used it</summary><pre>{resolved}</pre></details>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn facts_files_and_links_are_there() {
        let results = sample::rig();
        let files = ["results.h5", "growth.svg", "x.bin"].map(String::from);
        let mut layout = PageLayout::beside(files);
        let text = provenance(&results, &mut layout);
        for fact in
            ["stridor run rig.toml", "unknown", "rig.toml", "rig.msh", "Wall time", "href=\"results.h5\""]
        {
            assert!(text.contains(fact), "{fact}");
        }
        assert!(!text.contains("x.bin"));
        let case = the_case(&results);
        assert!(case.contains("&lt;written by hand&gt;") && case.contains("mu0 = 0.6"));
    }
}
