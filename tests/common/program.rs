//! The program on a folder, and what it leaves there.
#![allow(dead_code)]

use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// The program: `stridor`, or `stridor-mpi` in the tests of that package.
pub const PROGRAM: &str =
    match (option_env!("CARGO_BIN_EXE_stridor"), option_env!("CARGO_BIN_EXE_stridor-mpi")) {
        (Some(program), _) | (_, Some(program)) => program,
        _ => panic!("Cargo names the program"),
    };

/// All kinds of results in a tenth of a second: modes, complex modes, a map, motion in time with fields.
pub const CASE: &str = r#"
title = "The first case"
assumptions = ["Everything here is made up."]

[mesh.annulus]
outer_radius = "75 mm"
hub_radius = "15 mm"
radial = 2
around = 8

[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"

[shell.disc]
material = "steel"
thickness = "1 mm"

[support.hub]
on = "hub"

[damping]
modal_ratio = 0.002

[modes.disc]
count = 4

[contact.pin]
body = "rim"
counter = "ground"
into = [1, 0, 0]
approach = "1 um"
sliding_velocity = "0.1 m/s"
sliding_direction = [0, 1, 0]
normal = { per = "point", stiffness = "10 kN/m" }
friction = { law = "coulomb", mu0 = 0.3, regularisation = "10 mm/s" }

[cea]
band = [0, "1 kHz"]

[map.m]
parameters = ["contact.pin.friction.mu0", "damping.modal_ratio"]
from = [0.1, 0.001]
to = [0.5, 0.01]
points = [3, 2]

[transient]
duration = "2 ms"
time_step = "20 us"
fields_every = "1 ms"
push.blow = { on = "rim", force = ["-50 N", 0, 0], duration = "1 ms" }
probe.rim = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
"#;

/// The program with arguments, in a folder.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).current_dir(folder).env("RUST_BACKTRACE", "0");
    command
}

/// A folder with `case.toml`.
pub fn folder_with(case: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("case.toml"), case).expect("a case");
    folder
}

/// Runs to the end. Whatever the program says, it does not panic.
pub fn run(command: &mut Command) -> Output {
    let output = command.output().expect("the binary runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("panicked"), "{said}");
    assert!(matches!(output.status.code(), Some(0..=2)), "{:?}: {said}", output.status);
    output
}

/// What is said where the exit code is `code`.
#[track_caller]
pub fn said(output: &Output, code: i32) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// Bounds the memory of the program \[MiB\].
#[cfg(target_os = "linux")]
pub fn limit_memory(command: &mut Command, mebibytes: u64) {
    use std::os::unix::process::CommandExt;
    let limit = libc::rlimit { rlim_cur: mebibytes << 20, rlim_max: mebibytes << 20 };
    // SAFETY: the closure calls nothing but the system, in the child before it becomes the program.
    unsafe {
        command.pre_exec(move || match libc::setrlimit(libc::RLIMIT_AS, &limit) {
            0 => Ok(()),
            _ => Err(std::io::Error::last_os_error()),
        });
    }
}

/// Arrays of numbers by name, as bits.
pub type Record = Vec<(String, Vec<u64>)>;

/// Every array of numbers in a group of an HDF5 file and below.
pub fn numbers(group: &hdf5::Group, found: &mut Record) {
    for dataset in group.datasets().expect("datasets") {
        if let Ok(values) = dataset.read_raw::<f64>() {
            found.push((dataset.name(), values.iter().map(|v| v.to_bits()).collect()));
        }
    }
    group.groups().expect("groups").iter().for_each(|inner| numbers(inner, found));
}

/// The names in a folder but hidden ones, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}

/// Those of `known` that are in the results of a folder, once for each file.
pub fn titles(out: &Path, known: [&'static str; 2]) -> Vec<&'static str> {
    let file = hdf5::File::open(out.join("results.h5"));
    let hdf5 = file.and_then(|file| file.dataset("title")?.read_scalar::<hdf5::types::VarLenUnicode>());
    let texts = ["summary.json", "report.html"].map(|name| std::fs::read_to_string(out.join(name)));
    let mut all: Vec<String> = texts.into_iter().flatten().collect();
    all.extend(hdf5.map(|title| title.to_string()));
    all.iter().flat_map(|text| known.into_iter().filter(|title| text.contains(title))).collect()
}
