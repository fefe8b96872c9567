//! The commit of the sources, for `--version` and the provenance of results: `STRIDOR_COMMIT`, which `src/lib.rs` reads.
//! Sources without a repository of their own, such as a tarball, have none.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if !Path::new(".git").exists() {
        return; // A folder above may be a repository, of something else.
    }
    // The script runs again when HEAD moves: HEAD names another branch, or its log or its branch has a new line.
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for file in ["HEAD", "logs/HEAD", "packed-refs"].into_iter().chain(branch.as_deref()) {
        // A file that is missing would run the script at every build.
        if let Some(path) = git(&["rev-parse", "--git-path", file]).filter(|path| Path::new(path).exists()) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    if let Some(commit) = git(&["rev-parse", "--verify", "--short=12", "HEAD"]) {
        println!("cargo::rustc-env=STRIDOR_COMMIT={commit}");
    }
}

/// What git prints; none where it fails or is not installed.
fn git(arguments: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_string()).filter(|line| !line.is_empty())
}
