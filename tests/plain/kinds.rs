//! A new kind of cell, of element or of part takes the files that CONTRIBUTING names, and no other: elsewhere a kind is asked
//! for its dimension, its order or its components.

use super::architecture::sources;
use std::collections::BTreeSet;
use std::path::Path;

/// The text of every source of the workspace up to its tests, by path.
fn all_sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    ["src", "crates"].iter().for_each(|folder| sources(&root.join(folder), &mut files));
    let text = |file: &Path| {
        let text = std::fs::read_to_string(file).expect("source is text");
        text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().to_string()
    };
    let path = |file: &Path| file.strip_prefix(root).expect("below the root").display().to_string();
    let is_test = |path: &String| path.contains("/tests/") || path.ends_with("/tests.rs");
    files.iter().map(|file| (path(file), text(file))).filter(|(path, _)| !is_test(path)).collect()
}

/// The words of a text.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').collect()
}

/// The files in which `holds` is true of the text.
fn files_where(holds: impl Fn(&str) -> bool) -> Vec<String> {
    all_sources().into_iter().filter(|(_, text)| holds(text)).map(|(path, _)| path).collect()
}

#[test]
fn kinds_of_cells_are_listed_in_their_table_alone() {
    let kinds: Vec<String> = stridor::mesh::CellKind::all().map(|kind| format!("{kind:?}")).collect();
    let listing = |text: &str| {
        let words = words(text);
        2 * kinds.iter().filter(|kind| words.contains(kind.as_str())).count() > kinds.len()
    };
    assert_eq!(files_where(listing), ["crates/mesh/src/kind/table.rs"]);
}

#[test]
fn kinds_of_parts_are_named_in_one_file() {
    assert_eq!(files_where(|text| text.contains("PartKind::")), ["src/structure/part.rs"]);
}

/// Elements of parts are made in one file, those of masses and springs in another one.
#[test]
fn elements_are_named_where_they_are_made() {
    let all = all_sources();
    let elements: BTreeSet<&str> = all
        .iter()
        .flat_map(|(_, text)| text.split("impl FiniteElement for ").skip(1))
        .map(|after| after.split(['<', ' ']).next().expect("a name"))
        .collect();
    assert!(elements.len() >= 7, "{elements:?}");
    let names = |text: &str| words(text).intersection(&elements).next().is_some();
    let own = |path: &str| path.starts_with("src/structure/elements/");
    let mut files: Vec<&str> =
        all.iter().filter(|(path, text)| !own(path) && names(text)).map(|(path, _)| path.as_str()).collect();
    files.sort_unstable();
    assert_eq!(files, ["src/structure/model.rs", "src/structure/part.rs"]);
}

#[test]
fn what_contributing_says_of_new_kinds_names_these_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("CONTRIBUTING.md")).expect("it is there");
    for file in [
        "crates/mesh/src/kind/table.rs",
        "src/structure/elements/mod.rs",
        "src/structure/part.rs",
        "src/case/mod.rs",
        "src/case/model.rs",
        "src/case/structure.rs",
        "src/job/model.rs",
        "src/job/analyses/mod.rs",
        "src/job/analyses/selection.rs",
        "src/results/mod.rs",
        "src/report/mod.rs",
    ] {
        assert!(text.contains(file) && root.join(file).exists(), "{file}");
    }
}
