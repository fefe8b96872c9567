//! `stridor export` from the command line: what is written is a case, and nothing of the user is written over.

use crate::small_rig::{stridor, text};
use tempfile::TempDir;

#[test]
fn the_matrices_of_solids_are_a_case() {
    let folder = TempDir::new().expect("a temporary folder");
    let succeeds = |arguments: &[&str]| {
        let output = stridor(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    };
    succeeds(&["new", "brake", "--template", "solid"]);
    succeeds(&["export", "brake/case.toml", "--out", "matrices"]);
    succeeds(&["check", "matrices/case.toml"]);
    // Once more into the same folder; but never over a case that is not an export's.
    succeeds(&["export", "brake/case.toml", "--out", "matrices"]);
    let own = folder.path().join("brake/case.toml");
    let before = std::fs::read(&own).unwrap();
    std::fs::copy(&own, folder.path().join("brake/brake.inp")).unwrap();
    for out in [
        ["brake/case.toml", "brake"],
        ["matrices/case.toml", "brake"],
        ["matrices/case.toml", "matrices"],
        ["brake/brake.inp", "brake/brake.inp"],
    ] {
        let output = stridor(folder.path(), &["export", out[0], "--out", out[1]]);
        assert_eq!(output.status.code(), Some(2), "{out:?}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains("a place where nothing is lost"), "{}", text(&output.stderr));
    }
    assert_eq!(std::fs::read(&own).unwrap(), before);
    assert_eq!(std::fs::read(folder.path().join("brake/brake.inp")).unwrap(), before);
}

/// Names of what is written: a file of a format that is written, or a folder; nothing is written over without `--force`.
#[test]
fn an_export_has_a_name_that_says_what_it_is() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let export = |case: &str, out: &str, more: &[&str]| {
        stridor(at, &[&["export", case, "--out", out][..], more].concat())
    };
    for template in ["pad", "two-dof"] {
        assert_eq!(stridor(at, &["new", template, "--template", template]).status.code(), Some(0));
    }
    std::fs::create_dir(at.join("folder.inp")).unwrap();
    std::fs::write(at.join("there.bdf"), "mine").unwrap();
    for (case, out, words) in [
        ("pad/case.toml", "model.txt", "which ends in `.txt`"),
        ("pad/case.toml", "model.inp.gz", "which ends in `.gz`"),
        ("pad/case.toml", "model.cdb", "which ends in `.cdb`"),
        ("pad/case.toml", "folder.inp", "a folder with the name of a file"),
        ("pad/case.toml", "there.bdf", "--force"),
        ("two-dof/case.toml", "model.inp", "no parts"),
    ] {
        let output = export(case, out, &[]);
        let message = text(&output.stderr);
        assert!(output.status.code() == Some(2) && message.contains(words), "{out}: {message}");
        let names = !matches!(out, "there.bdf" | "model.inp");
        assert!(!names || message.contains(".inp (abaqus)") && message.contains(".bdf"), "{message}");
        assert!(out == "folder.inp" || out == "there.bdf" || !at.join(out).exists(), "{out}");
    }
    assert_eq!(std::fs::read(at.join("there.bdf")).unwrap(), b"mine");
    assert_eq!(std::fs::read_dir(at.join("folder.inp")).unwrap().count(), 0);
    for (case, out, more) in [
        ("pad/case.toml", "there.bdf", &["--force"][..]),
        ("pad/case.toml", "model.inp", &[]),
        ("two-dof/case.toml", "run-1.5", &[]),
    ] {
        let output = export(case, out, more);
        assert_eq!(output.status.code(), Some(0), "{out}: {}", text(&output.stderr));
    }
    assert!(std::fs::read_to_string(at.join("there.bdf")).unwrap().contains("BEGIN BULK"));
    assert!(at.join("run-1.5/mass.mtx").is_file() && !at.join("run-1.5/.lock").exists());
}
