//! Every value of every validation case set to extremes: no panic, no abort, no hang, and whatever `check` calls sound, `run`
//! does not refuse.
//!
//! The tests that always run take a sample. All of it, which takes hours, is run by
//! `EXTREMES=FILTER cargo test --release --test processes extremes -- --ignored --nocapture`: the cases whose path has FILTER in it.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use stridor::case::{Case, read_case};
use tempfile::TempDir;
use toml::{Table, Value};

/// Optional keys that a case may not have, by the table that they belong to.
const OPTIONAL: [(&str, &str, &str); 27] = [
    ("", "prestress", "true"),
    ("damping", "modal_ratio", "0.01"),
    ("damping", "modal_ratios", "[[1e3, 0.01]]"),
    ("cea", "nearest", "1.0"),
    ("cea", "count", "3"),
    ("cea", "certify", "true"),
    ("cea", "confirm", "true"),
    ("cea", "measured_squeal", "[1e5]"),
    ("", "sensitivity", "{ modes = [1e5] }"),
    ("", "sensitivity", "{ verify = true }"),
    ("", "transient", "{ duration = 1e-3, time_step = 1e-4 }"),
    (
        "",
        "transient",
        "{ duration = 1e-3, time_step = 1e-4, disturbance = { amplitude = 1e-9, mode_near = 1e5 } }",
    ),
    ("", "transient", "{ duration = 1e-3, time_step = 1e-4, model = \"reduced\" }"),
    ("", "transient", "{ duration = 1e-3, time_step = 1e-4, start = \"rest\", fields_every = 1e-4 }"),
    ("", "transient", "{ duration = 1e-3, time_step = 1e-4, probe = { p = { spring = \"none\" } } }"),
    ("", "transient", "{ duration = 1e-3, time_step = 1e-4, sound = {} }"),
    ("", "frf", "{ a = { band = [1.0, 10.0], excitation = { at = [0, 0, 0], direction = [1, 0, 0] } } }"),
    ("", "frf", "{ a = { band = [1.0, 10.0], excitation = { at = [70, 0, 0], direction = [1, 0, 0] } } }"),
    ("", "modes", "{ \"a/b\" = { count = 1 } }"),
    ("", "modes", "{ a = { count = 2, free = true } }"),
    ("", "modes", "{ a = { below = 1.0, contact = \"closed\" } }"),
    ("", "force", "{ a = { on = \"none\", force = [0, 0, 1] } }"),
    ("", "point", "{ \"a.b\" = [0, 0, 0] }"),
    ("", "measured", "{ a = { frequencies = [1.0], of = \"none\" } }"),
    ("", "matrices", "{ mass = \"m\", stiffness = \"k\" }"),
    ("", "contact", "{}"),
    ("", "nonsense", "1"),
];

/// What numbers, strings, lists and all else are set to.
const NUMBERS: [&str; 18] = [
    "0",
    "-1",
    "1",
    "1e-300",
    "1e300",
    "1e-60",
    "1e60",
    "1e-12",
    "1e12",
    "1e6",
    "1e-6",
    "nan",
    "inf",
    "\"\"",
    "\"1 furlong\"",
    "9223372036854775807",
    "[]",
    "true",
];
const COUNTS: [&str; 6] = ["0", "-1", "1", "1000000000", "9223372036854775807", "1.5"];
const STRINGS: [&str; 6] = ["\"\"", "\"none\"", "\"a.b\"", "\"\\u0000\"", "0", "[]"];
const LISTS: [&str; 4] = ["[]", "0", "[[]]", "[0, 0, 0, 0, 0, 0, 0]"];
const OTHERS: [&str; 3] = ["false", "true", "7"];

/// A case with one value set to another, and what was done.
pub struct Variant {
    pub what: String,
    pub text: String,
}

pub fn value(text: &str) -> Value {
    format!("x = {text}").parse::<Table>().expect("TOML")["x"].clone()
}

/// Paths of all values below `node`, the node itself among them; indices of lists count from 0.
pub fn paths(node: &Value, path: &mut Vec<String>, all: &mut Vec<Vec<String>>) {
    if !path.is_empty() {
        all.push(path.clone());
    }
    let inner: Vec<(String, &Value)> = match node {
        Value::Table(table) => table.iter().map(|(key, value)| (key.clone(), value)).collect(),
        Value::Array(list) => list.iter().enumerate().map(|(k, value)| (k.to_string(), value)).collect(),
        _ => Vec::new(),
    };
    for (key, value) in inner {
        path.push(key);
        paths(value, path, all);
        path.pop();
    }
}

pub fn slot<'a>(root: &'a mut Value, path: &[String]) -> Option<&'a mut Value> {
    path.iter().try_fold(root, |node, key| match node {
        Value::Array(list) => list.get_mut(key.parse::<usize>().ok()?),
        _ => node.get_mut(key),
    })
}

/// Every value of `case` set to extremes, removed, renamed with a dot in the name; and optional keys added.
fn variants(case: &Case) -> Vec<Variant> {
    let root = Value::Table(case.with_absolute_paths().to_toml().parse().expect("a case is TOML"));
    let mut found = Vec::new();
    let mut add = |what: String, root: &Value| {
        found.push(Variant { what, text: toml::to_string(root).expect("TOML") });
    };
    let mut all = Vec::new();
    paths(&root, &mut Vec::new(), &mut all);
    for path in &all {
        let shown = path.join(".");
        let mut other = root.clone();
        let own = slot(&mut other, path).expect("it is there").clone();
        let extremes: &[&str] = match own {
            Value::Float(_) => &NUMBERS,
            Value::Integer(_) => &COUNTS,
            Value::String(_) => &STRINGS,
            Value::Array(_) => &LISTS,
            _ => &OTHERS,
        };
        for extreme in extremes {
            *slot(&mut other, path).expect("it is there") = value(extreme);
            add(format!("{shown} = {extreme}"), &other);
        }
        let (last, before) = path.split_last().expect("not the root");
        let mut other = root.clone();
        if let Some(Value::Table(table)) = slot(&mut other, before) {
            table.remove(last);
            add(format!("no {shown}"), &other);
            if let Some(Value::Table(table)) = slot(&mut other, before) {
                table.insert("a.b".into(), own.clone());
            }
            add(format!("{shown} is called a.b"), &other);
        }
    }
    for (table, key, text) in OPTIONAL {
        let mut other = root.clone();
        let path: Vec<String> = table.split('.').filter(|key| !key.is_empty()).map(String::from).collect();
        let Some(Value::Table(table)) = slot(&mut other, &path) else { continue };
        table.insert(key.into(), value(text));
        add(format!("{key} = {text}"), &other);
    }
    found
}

/// The case files of the validation whose path has `filter` in it.
pub fn cases(filter: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    let folders = std::fs::read_dir(root).expect("a folder").map(|entry| entry.expect("an entry").path());
    let files =
        folders.filter(|path| path.is_dir()).flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let files = files.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = files
        .filter(|file| file.extension().is_some_and(|kind| kind == "toml"))
        .filter(|file| file.display().to_string().contains(filter) && read_case(file).is_ok())
        .collect();
    files.sort();
    files
}

/// One variant in `of`, always the same ones.
fn sample(case: &Path, variant: &Variant, of: u64) -> bool {
    let mut hasher = DefaultHasher::new();
    (case.file_stem(), &variant.what).hash(&mut hasher);
    hasher.finish().is_multiple_of(of)
}

/// How the program ended and what it says on stderr; CPU time (by the signal SIGXCPU) and memory are limited.
fn stridor(folder: &Path, command: &str) -> (ExitStatus, String) {
    let limits = "ulimit -S -t 20; ulimit -v 3000000; ulimit -f 200000; ulimit -c 0";
    let program = env!("CARGO_BIN_EXE_stridor");
    let output = Command::new("sh")
        .args(["-c", &format!("{limits}; exec {program} {command} --quiet --threads 1")])
        .current_dir(folder)
        .output()
        .expect("a shell");
    (output.status, String::from_utf8_lossy(&output.stderr).into_owned())
}

/// What is wrong with the way that the program takes a variant, if anything is.
pub fn complaint(folder: &Path, variant: &Variant) -> Option<String> {
    std::fs::write(folder.join("case.toml"), &variant.text).expect("a file");
    let out = folder.join("out");
    let _ = std::fs::remove_dir_all(&out);
    let what = &variant.what;
    let (status, said) = stridor(folder, "check case.toml --parameters");
    match status.code() {
        Some(0) => {}
        Some(1 | 2) if said.starts_with("error: ") => return None,
        _ => return Some(format!("{what}: `check` ends with {status}: {said}")),
    }
    let (status, said) = stridor(folder, "run case.toml --out out");
    if out_of_time(status) {
        // No hang by itself.
        eprintln!("{what}: out of time");
        return None;
    }
    match status.code() {
        Some(0) => None,
        Some(1) if said.starts_with("error: ") => None,
        Some(2) => Some(format!(
            "{what}: `check` says sound, `run` ends with 2{}: {said}",
            if out.exists() { " and writes" } else { "" }
        )),
        _ => Some(format!("{what}: `run` ends with {status}: {said}")),
    }
}

/// Whether the limit of CPU time ended a process; any other signal is a crash.
fn out_of_time(status: ExitStatus) -> bool {
    status.signal() == Some(libc::SIGXCPU)
}

#[test]
fn a_crash_without_a_word_is_not_taken_for_a_lack_of_time() {
    let ended = |command: &str| Command::new("sh").args(["-c", command]).status().expect("a shell");
    assert!(out_of_time(ended("ulimit -c 0; kill -XCPU $$")));
    assert!(out_of_time(ended("ulimit -S -t 1; ulimit -c 0; while :; do :; done")));
    for signal in ["SEGV", "ABRT", "BUS", "KILL", "XFSZ"] {
        assert!(!out_of_time(ended(&format!("ulimit -c 0; kill -{signal} $$"))), "{signal}");
    }
}

#[test]
fn whatever_is_read_is_written_so_that_it_reads_back() {
    for file in cases("") {
        let case = read_case(&file).expect("it was read before");
        for variant in variants(&case).iter().filter(|variant| sample(&file, variant, 40)) {
            let Ok(case) = Case::parse("variant", &variant.text, case.folder.clone()) else { continue };
            let again = Case::parse("again", &case.to_toml(), case.folder.clone());
            let again = again.unwrap_or_else(|e| panic!("{}: {}: {e}", file.display(), variant.what));
            assert!(again == case, "{}: {}", file.display(), variant.what);
        }
    }
}

#[test]
fn a_sound_case_is_not_refused_by_run() {
    let small =
        ["two-dof/case", "hoffmann/case", "preload/strip", "friction-laws/table", "bar-cantilever/case"];
    let folder = TempDir::new().expect("a temporary folder");
    let mut complaints = Vec::new();
    for file in small.iter().flat_map(|name| cases(name)) {
        let case = read_case(&file).expect("it was read before");
        for variant in variants(&case).iter().filter(|variant| sample(&file, variant, 24)) {
            complaints
                .extend(complaint(folder.path(), variant).map(|said| format!("{}: {said}", file.display())));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
#[ignore = "takes hours"]
fn no_sound_case_is_refused_by_run() {
    let filter = std::env::var("EXTREMES").unwrap_or_default();
    let folder = TempDir::new().expect("a temporary folder");
    let (mut count, mut complaints) = (0, 0);
    for file in cases(&filter) {
        let case = read_case(&file).expect("it was read before");
        for variant in variants(&case) {
            count += 1;
            if let Some(said) = complaint(folder.path(), &variant) {
                complaints += 1;
                eprintln!("{}: {said}", file.display());
            }
        }
    }
    eprintln!("{count} variants, {complaints} complaints");
    assert!(complaints == 0, "{complaints} complaints");
}
