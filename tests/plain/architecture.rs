//! The modules of `src` and which of them each may use, as `lib.rs` says in words; and that the glossary is right. Members of the
//! workspace (`crates/`) use what their manifests say.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Each module with all modules that it may use.
const MAY_USE: [(&str, &[&str]); 19] = [
    ("system", &[]),
    // Mechanics: builds a system, knows no analysis.
    ("structure", &["system"]),
    ("contact", &["system", "structure"]),
    // Analyses: take a system, know no part of the mechanics.
    ("equilibrium", &["system"]),
    ("dynamics", &["system", "equilibrium"]),
    ("modal", &["system"]),
    ("reduction", &["system", "equilibrium", "modal"]),
    ("stability", &["system", "equilibrium", "dynamics", "modal"]),
    ("sweep", &["stability"]),
    ("uncertainty", &[]),
    ("transient", &["system", "equilibrium"]),
    ("calibration", &[]),
    // What both wings leave behind.
    (
        "results",
        &[
            "structure",
            "equilibrium",
            "modal",
            "stability",
            "sweep",
            "uncertainty",
            "transient",
            "calibration",
        ],
    ),
    ("report", &["equilibrium", "modal", "stability", "sweep", "uncertainty", "results"]),
    // From a file to results.
    ("case", &["structure", "contact", "uncertainty"]),
    (
        "job",
        &[
            "system",
            "structure",
            "contact",
            "equilibrium",
            "dynamics",
            "modal",
            "stability",
            "sweep",
            "uncertainty",
            "reduction",
            "transient",
            "calibration",
            "results",
            "report",
            "case",
        ],
    ),
    ("validation", &["structure", "sweep", "results", "case", "job"]),
    ("search", &["results", "case", "job", "validation"]),
    ("cli", &["report", "results", "case", "job", "validation", "search"]),
];

/// The two modules of `stridor-mpi` that know no analysis: its program, `main.rs`, is between them and the library.
#[test]
fn what_talks_to_mpi_knows_linear_algebra_only() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/mpi/src");
    let mut files = Vec::new();
    ["slepc", "distributed"].iter().for_each(|module| sources(&folder.join(module), &mut files));
    assert!(files.len() > 5);
    for file in files {
        let text = std::fs::read_to_string(&file).expect("source is text");
        assert!(!text.contains("stridor::"), "{} uses the library", file.display());
    }
}

pub(super) fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the crate").flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The modules that `text` names as `crate::module`, its unit tests and comments left out; constants are no modules.
fn modules_used(text: &str) -> BTreeSet<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let mut used = BTreeSet::new();
    for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
        for (at, _) in line.match_indices("crate::") {
            let name: String =
                line[at + 7..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if name.starts_with(char::is_lowercase) {
                used.insert(name);
            }
        }
    }
    used
}

#[test]
fn modules_use_only_modules_above_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    for file in files {
        let inside = file.strip_prefix(&root).expect("below src").with_extension("");
        let module = inside.iter().next().expect("a file has a name").to_string_lossy().into_owned();
        if module == "lib"
            || module == "main"
            || inside.iter().any(|part| ["tests", "sample", "samples"].iter().any(|t| part == *t))
        {
            continue;
        }
        let Some((_, allowed)) = MAY_USE.iter().find(|(name, _)| *name == module) else {
            wrong.push(format!("{}: a module that this test does not know", inside.display()));
            continue;
        };
        seen.insert(module.clone());
        let text = std::fs::read_to_string(&file).expect("source is text");
        for used in modules_used(&text) {
            let known = MAY_USE.iter().any(|(name, _)| *name == used);
            if known && used != module && !allowed.contains(&used.as_str()) {
                wrong.push(format!("{} uses {used}", inside.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(seen.len(), MAY_USE.len(), "every module of the list exists");
}

#[test]
fn the_index_of_the_library_names_every_module() {
    let index = include_str!("../../src/lib.rs");
    for (module, _) in MAY_USE {
        assert!(index.contains(&format!("pub mod {module};")), "{module} is not public");
        // Those of a feature that is left out are no links.
        assert!(index.contains(&format!("`{module}`")), "{module} is not in the index");
    }
}

/// Every file of GLOSSARY.md is there, and has the names that it is to define.
#[test]
fn the_glossary_names_what_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut names = 0;
    for line in include_str!("../../GLOSSARY.md")
        .lines()
        .filter(|line| line.contains("`src/") || line.contains("`crates/"))
    {
        let (row, file) = line.trim_end_matches(['|', ' ']).rsplit_once('|').expect("a row");
        let file = file.trim().trim_matches('`');
        let text = std::fs::read_to_string(root.join(file));
        let text = text.unwrap_or_else(|_| panic!("{file} of the glossary is not there"));
        let last = row.rsplit_once('|').expect("a row").1;
        for name in last.split('`').skip(1).step_by(2).filter(|name| !name.contains('.')) {
            assert!(text.contains(name), "{name} is not in {file}");
            names += 1;
        }
    }
    assert!(names > 50, "{names}");
}
