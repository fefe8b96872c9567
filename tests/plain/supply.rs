//! Where the dependencies come from, under which licence, and what each direct one is for. `deny.toml` holds the same with
//! cargo-deny, which .ci/nightly runs.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

fn text_of(file: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).expect("a text file")
}

/// The licences that deny.toml allows.
fn allowed() -> BTreeSet<String> {
    let table: toml::Table = text_of("deny.toml").parse().expect("TOML");
    let list = table["licenses"]["allow"].as_array().expect("a list");
    list.iter().map(|licence| licence.as_str().expect("a name").to_string()).collect()
}

/// Whether a package is of this repository.
fn ours(name: &str) -> bool {
    name == "stridor" || name.starts_with("stridor-")
}

/// Whether the SPDX expression can be met by allowed licences: of every part one alternative.
fn acceptable(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let plain = expression.replace('/', " OR ").replace(['(', ')'], "");
    plain.split(" AND ").all(|part| part.split(" OR ").any(|one| allowed.contains(one.trim())))
}

#[test]
fn every_dependency_is_from_crates_io_under_an_allowed_licence() {
    let metadata = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--filter-platform",
            "x86_64-unknown-linux-gnu",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).expect("JSON");
    let (packages, allowed) = (metadata["packages"].as_array().expect("a list"), allowed());
    let of_others = packages.iter().filter(|package| !package["name"].as_str().is_some_and(ours));
    let mut wrong = Vec::new();
    for package in of_others {
        if package["source"] != CRATES_IO {
            wrong.push(format!("{} comes from {}", package["id"], package["source"]));
        }
        if !package["license"].as_str().is_some_and(|licence| acceptable(licence, &allowed)) {
            wrong.push(format!("{} has the licence {}", package["id"], package["license"]));
        }
    }
    assert!(packages.len() > 100, "the dependencies of dependencies are among them");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_locked_package_has_a_checksum() {
    let lock: toml::Table = text_of("Cargo.lock").parse().expect("TOML");
    for package in lock["package"].as_array().expect("a list") {
        let ours = package["name"].as_str().is_some_and(ours);
        assert!(ours || package.get("checksum").is_some(), "{package} is locked without a checksum");
        assert!(ours || package["source"].as_str() == Some(CRATES_IO), "{package}");
    }
}

#[test]
fn every_direct_dependency_says_what_it_is_for() {
    let manifest = text_of("Cargo.toml");
    let part = manifest.split("\n[workspace.dependencies]\n").nth(1).expect("dependencies");
    let lines: Vec<&str> = part.split("\n[").next().expect("a first part").trim().lines().collect();
    for (k, line) in lines.iter().enumerate().filter(|(_, line)| !line.starts_with('#')) {
        assert!(line.is_empty() || k > 0 && lines[k - 1].starts_with("# "), "no reason above: {line}");
    }
}

#[test]
fn a_licence_is_met_by_one_alternative_of_every_part() {
    let allowed = BTreeSet::from(["MIT".to_string(), "Unicode-3.0".to_string()]);
    for (expression, met) in [
        ("MIT", true),
        ("GPL-3.0-only", false),
        ("Apache-2.0 OR MIT", true),
        ("Apache-2.0/MIT", true),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("MIT AND GPL-3.0-only", false),
    ] {
        assert_eq!(acceptable(expression, &allowed), met, "{expression}");
    }
}
