//! Puts the commit of the sources into `STRIDOR_COMMIT`: that of the git repository whose root this package is, with
//! `-modified` where the sources differ from it, or that of the package file; `src/lib.rs` reads it.
//!
//! It runs again when the sources change, not at every commit: the commit is the one at which the sources were last compiled.

use std::path::Path;
use std::process::Command;

/// What the program is made of.
const SOURCES: [&str; 5] = ["src", "crates", "build.rs", "Cargo.toml", "Cargo.lock"];

fn main() {
    for path in SOURCES.iter().filter(|path| Path::new(path).exists()) {
        println!("cargo:rerun-if-changed={path}");
    }
    if let Some(commit) = of_repository().or_else(of_package) {
        println!("cargo:rustc-env=STRIDOR_COMMIT={commit}");
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_string())
}

fn of_repository() -> Option<String> {
    // A package below the root of another repository has no commit of its own.
    if !Path::new(".git").exists() {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changed = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?;
    Some(if changed.is_empty() { commit } else { format!("{commit}-modified") })
}

/// From the file that `cargo package` adds: `"sha1": "…"`.
fn of_package() -> Option<String> {
    let text = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let commit: String =
        text.split("\"sha1\": \"").nth(1)?.chars().take_while(char::is_ascii_hexdigit).collect();
    commit.get(..12).map(str::to_string)
}
