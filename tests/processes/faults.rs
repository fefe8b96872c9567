//! Calls to the system that fail, by a library that is loaded before all others (tests/common/faults.c): writes, allocations and
//! threads that are refused at the n-th call, a clock that jumps, and which writes wait for the disk. The tests of the suite take a
//! sample of the calls; `cargo test --release --test processes faults -- --ignored` takes every write
//! and many allocations (`FAULT_EVERY=1`: all).

use crate::program::{self, CASE, Record, command, numbers, titles};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};
use stridor::results::KEYS_OF_THE_RUN;
use tempfile::TempDir;

const TITLES: [&str; 2] = ["The first case", "The second case"];
/// What a run may take; the machine may be loaded.
const PATIENCE: Duration = Duration::from_secs(120);

/// The library, built once.
fn library() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common/faults.c");
        let built = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("faults-{}.so", std::process::id()));
        let mut compiler = Command::new("cc");
        compiler.args(["-shared", "-fPIC", "-O1", "-o"]).args([&built, &source]).arg("-ldl");
        assert!(compiler.status().expect("a C compiler").success());
        built
    })
}

/// A call that fails: the n-th of a kind, or none for 0; whether all later ones do, too; with which error.
#[derive(Debug, Clone, Copy)]
struct Fault {
    calls: &'static str,
    at: usize,
    lasts: bool,
    error: i32,
}

/// What a run says, and what the library reports of it, a line each.
struct Outcome {
    output: Output,
    report: Vec<String>,
}

impl Outcome {
    /// How many calls there were of those that could fail.
    fn calls(&self) -> usize {
        let line = self.report.iter().find_map(|line| line.strip_prefix("calls "));
        line.expect("a count").parse().expect("a number")
    }
}

/// Two cases in a folder of their own, that differ in their titles.
fn cases() -> TempDir {
    let folder = program::folder_with(CASE);
    let second = CASE.replace(TITLES[0], TITLES[1]);
    std::fs::write(folder.path().join("second.toml"), second).expect("a case");
    folder
}

fn arguments<'a>(case: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", case, "--out", out, "--quiet"], more].concat()
}

/// The program with a fault: exit code 0, or 1 with one line; neither panic nor signal, and it comes to an end.
fn faulty(folder: &Path, arguments: &[&str], out: &str, fault: Fault) -> Outcome {
    let report = folder.join(format!("{out}.report"));
    let _ = std::fs::remove_file(&report);
    let below = folder.canonicalize().expect("a folder").join(out);
    let mut command = command(folder, arguments);
    command
        .env("LD_PRELOAD", library())
        .env("FAULT_CALLS", fault.calls)
        .env("FAULT_AT", fault.at.to_string());
    command.env("FAULT_LASTS", u8::from(fault.lasts).to_string()).env("FAULT_ERROR", fault.error.to_string());
    command.env("FAULT_BELOW", below).env("FAULT_REPORT", &report);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the binary runs");
    let begun = Instant::now();
    while child.try_wait().expect("it is there").is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().expect("it can be killed");
            panic!("{fault:?}: it does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().expect("it has ended");
    let report = std::fs::read_to_string(&report).unwrap_or_default();
    let outcome = Outcome { output, report: report.lines().map(str::to_string).collect() };
    let said = String::from_utf8_lossy(&outcome.output.stderr);
    // What C libraries print themselves when they have no memory stands before the error. HDF5 does not always survive it: it calls
    // itself without end, follows null pointers or frees what it has freed (H5open, H5E__get_stack, H5Acreate2).
    let theirs = ["Fatal glibc error: ", "corrupted ", "HDF5-DIAG", "  #", "    major: ", "    minor: "];
    let said: Vec<&str> =
        said.lines().filter(|line| !theirs.iter().any(|theirs| line.starts_with(theirs))).collect();
    let (lines, said) = (said.len(), said.join("\n"));
    match outcome.output.status.code() {
        Some(0) => assert!(lines == 0, "{fault:?} {:?}: {said}", outcome.report),
        Some(1) => {
            assert!(lines == 1 && said.starts_with("error: "), "{fault:?} {:?}: {said}", outcome.report)
        }
        _ => panic!("{fault:?} {:?}: {:?} {said}", outcome.report, outcome.output.status),
    }
    outcome
}

/// The numbers of a run, its summary without times and title, its tables.
type Results = (Record, serde_json::Value, Vec<Vec<u8>>);

/// What a finished run says.
fn results(out: &Path) -> Results {
    let file = hdf5::File::open(out.join("results.h5")).expect("results.h5 opens");
    assert!(file.attr("complete").and_then(|a| a.read_scalar::<bool>()).expect("a root attribute"));
    let mut record = Vec::new();
    numbers(&file, &mut record);
    let fields = hdf5::File::open(out.join("transient.vtkhdf")).expect("transient.vtkhdf opens");
    numbers(&fields, &mut record);
    record.retain(|(name, _)| !KEYS_OF_THE_RUN.iter().any(|key| name.contains(key)));
    assert!(record.len() > 50);
    let summary = std::fs::read(out.join("summary.json")).expect("a summary");
    let mut summary: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    let others = ["title", "warnings"];
    KEYS_OF_THE_RUN.iter().chain(&others).for_each(|key| drop(summary[*key].take()));
    let tables = ["transient.csv", "events.csv", "map_m.csv", "modes_disc.csv", "steady.vtu"];
    let tables = tables.map(|name| std::fs::read(out.join(name)).expect("a table"));
    (record, summary, tables.to_vec())
}

/// Runs to the end without a fault.
fn well(folder: &Path, arguments: &[&str]) {
    let output = command(folder, arguments).output().expect("the binary runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Calls `each` with every number, on as many threads as there are cores, and the number of the thread.
fn side_by_side(numbers: &[usize], each: impl Fn(usize, usize) + Sync) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let (next, each) = (&next, &each);
            scope.spawn(move || {
                while let Some(number) = numbers.get(next.fetch_add(1, Relaxed)) {
                    each(*number, thread);
                }
            });
        }
    });
}

/// About `count` numbers from 1 to `most`, spread evenly.
fn sample(most: usize, count: usize) -> Vec<usize> {
    (0..count).map(|k| 1 + (k * most + most / 2) / count % most).collect()
}

/// Of how many calls one fails in the long tests: `FAULT_EVERY`, or as many as usual.
fn every(usual: usize) -> usize {
    std::env::var("FAULT_EVERY").ok().and_then(|every| every.parse().ok()).unwrap_or(usual)
}

/// For each of these calls: into a new folder, then `--resume`; and over the results of another case, then again. Gives how many of
/// the faulty runs did not end with an error.
fn writes_fail(choose: impl Fn(usize) -> Vec<usize>) -> usize {
    let folder = cases();
    let at = folder.path();
    let wholes = ["case.toml", "second.toml"].map(|case| {
        well(at, &arguments(case, "whole", &["--threads", "1"]));
        results(&at.join("whole"))
    });
    let none = Fault { calls: "writes", at: 0, lasts: false, error: 0 };
    let most = faulty(at, &arguments("case.toml", "count", &["--threads", "1"]), "count", none).calls();
    assert!(most > 200, "{most}");
    let harmless = AtomicUsize::new(0);
    side_by_side(&choose(most), |n, thread| {
        let out = &format!("out-{thread}");
        let dir = at.join(out);
        for (lasts, error) in [(false, libc::EIO), (true, libc::ENOSPC)] {
            let fault = Fault { calls: "writes", at: n, lasts, error };
            let ended = |outcome: &Outcome, whole: &Results| {
                if outcome.output.status.success() {
                    harmless.fetch_add(1, Relaxed);
                    assert!(results(&dir) == *whole, "{fault:?} {:?}: silently wrong", outcome.report);
                }
            };
            ended(&faulty(at, &arguments("case.toml", out, &["--threads", "1"]), out, fault), &wholes[0]);
            well(at, &arguments("case.toml", out, &["--threads", "1", "--resume"]));
            assert!(results(&dir) == wholes[0], "{fault:?}: not resumed");
            let outcome = faulty(at, &arguments("second.toml", out, &["--threads", "1"]), out, fault);
            ended(&outcome, &wholes[1]);
            let titles = titles(&dir, TITLES);
            assert!(
                titles.windows(2).all(|pair| pair[0] == pair[1]),
                "{fault:?} {:?}: {titles:?}",
                outcome.report
            );
            well(at, &arguments("second.toml", out, &["--threads", "1"]));
            assert!(results(&dir) == wholes[1], "{fault:?}: not run again");
            std::fs::remove_dir_all(&dir).expect("it is there");
        }
    });
    println!("writes: {most} calls, {} runs without an error", harmless.load(Relaxed));
    harmless.into_inner()
}

#[test]
fn a_write_that_fails_is_told_and_loses_nothing() {
    writes_fail(|most| sample(most, 8));
}

#[test]
#[ignore = "takes minutes"]
fn every_write_that_fails_is_told_and_loses_nothing() {
    writes_fail(|most| (1..=most).step_by(every(1)).collect());
}

/// For each of these allocations: an error of one line, or the same results.
fn allocations_fail(choose: impl Fn(usize) -> Vec<usize>) {
    let folder = cases();
    let at = folder.path();
    well(at, &arguments("case.toml", "first", &["--threads", "1"]));
    let whole = results(&at.join("first"));
    let none = Fault { calls: "memory", at: 0, lasts: false, error: libc::ENOMEM };
    let most = faulty(at, &arguments("case.toml", "count", &["--threads", "1"]), "count", none).calls();
    assert!(most > 10_000, "{most}");
    let [harmless, ended] = [(); 2].map(|()| AtomicUsize::new(0));
    side_by_side(&choose(most), |n, thread| {
        let out = &format!("out-{thread}");
        let fault = Fault { at: n, lasts: n % 2 == 0, ..none };
        let outcome = faulty(at, &arguments("case.toml", out, &["--threads", "1"]), out, fault);
        if outcome.output.status.success() {
            harmless.fetch_add(1, Relaxed);
            assert!(results(&at.join(out)) == whole, "{fault:?} {:?}: silently wrong", outcome.report);
        }
        ended.fetch_add(1, Relaxed);
        let _ = std::fs::remove_dir_all(at.join(out));
    });
    let [harmless, ended] = [harmless, ended].map(AtomicUsize::into_inner);
    println!("memory: {most} calls, {ended} of them failed, {harmless} without harm");
}

#[test]
fn an_allocation_that_fails_is_told() {
    allocations_fail(|most| sample(most, 60));
}

#[test]
#[ignore = "takes an hour"]
fn many_allocations_that_fail_are_told() {
    allocations_fail(|most| (1..=most).step_by(every(40)).collect());
}

/// What a program is shown that writes to a terminal, and the other end of it.
fn terminal() -> (std::fs::File, Stdio) {
    use std::os::fd::{FromRawFd, OwnedFd};
    let (mut master, mut slave) = (0, 0);
    let null = std::ptr::null_mut();
    // SAFETY: the system writes two descriptors, which nobody else has.
    unsafe {
        assert_eq!(libc::openpty(&mut master, &mut slave, null, null.cast(), null.cast()), 0);
        (std::fs::File::from_raw_fd(master), OwnedFd::from_raw_fd(slave).into())
    }
}

#[test]
fn a_thread_that_cannot_be_had_is_told_or_not_needed() {
    let folder = cases();
    let at = folder.path();
    for n in 1..=4 {
        let fault = Fault { calls: "threads", at: n, lasts: true, error: libc::EAGAIN };
        let outcome = faulty(at, &arguments("case.toml", "out", &["--threads", "3"]), "out", fault);
        assert_eq!(outcome.output.status.code(), Some(i32::from(n < 4)), "{n}: {:?}", outcome.report);
    }
    // The thread that draws the progress, which is there on a terminal only.
    let mut command = command(at, &["run", "case.toml", "--out", "drawn", "--threads", "1"]);
    let (shown, stderr) = terminal();
    command.env("LD_PRELOAD", library()).env("FAULT_CALLS", "threads").env("FAULT_AT", "2");
    let report = at.join("drawn.report");
    command.env("FAULT_REPORT", &report).stdout(Stdio::null()).stderr(stderr);
    let status = command.status().expect("the binary runs");
    drop(shown);
    assert!(status.success(), "{status:?}");
    assert!(
        std::fs::read_to_string(&report).unwrap().starts_with("pthread_create"),
        "no thread was asked for"
    );
}

#[test]
fn a_clock_that_jumps_changes_nothing() {
    let folder = cases();
    let at = folder.path();
    well(at, &arguments("case.toml", "first", &["--threads", "1"]));
    let fault = Fault { calls: "clock", at: 0, lasts: false, error: 0 };
    let begun = Instant::now();
    let outcome = faulty(at, &arguments("case.toml", "out", &["--threads", "1"]), "out", fault);
    let took = begun.elapsed().as_secs_f64();
    assert!(outcome.output.status.success() && outcome.calls() > 0);
    assert!(results(&at.join("out")) == results(&at.join("first")));
    let summary = std::fs::read(at.join("out/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    let times = summary["timings"].as_array().expect("a list");
    let seconds: Vec<f64> = times.iter().map(|phase| phase["wall_s"].as_f64().expect("a number")).collect();
    assert!(
        seconds.len() > 5 && seconds.iter().all(|s| (0.0..took).contains(s)),
        "{times:?}, all within {took} s"
    );
}

/// Whether the disk has what a loss of power must leave: a checkpoint counts nothing that is not on the disk, and results.h5 comes
/// to its place for the last time when all other files of the run are there.
#[test]
fn checkpoints_and_results_wait_for_the_disk() {
    let folder = cases();
    let at = folder.path();
    let none = Fault { calls: "writes", at: 0, lasts: false, error: 0 };
    let outcome = faulty(at, &arguments("case.toml", "out", &["--threads", "1"]), "out", none);
    let out = at.canonicalize().expect("a folder").join("out");
    let mut waiting: BTreeSet<String> = BTreeSet::new();
    let (mut checkpoints, mut at_the_end) = (0, None);
    for line in &outcome.report {
        let (call, path) = line.split_once(' ').expect("a call and a path");
        let Ok(name) = Path::new(path).strip_prefix(&out) else { continue };
        let name = name.to_str().expect("a plain name").to_string();
        match call {
            "fsync" | "fdatasync" => drop(waiting.remove(&name)),
            "rename" => {
                let before = [
                    format!(".{name}.part"),
                    name.replace(".h5", ".new.h5"),
                    name.replace(".vtk", ".new.vtk"),
                ];
                let before = before.iter().find(|before| waiting.remove(*before));
                if name == "checkpoint.bin" {
                    checkpoints += 1;
                    let open = before.is_some() || waiting.contains("record.bin");
                    assert!(!open, "a checkpoint is ahead of the disk: {waiting:?}");
                } else if name == "results.h5" {
                    at_the_end = Some((before.is_some(), waiting.clone()));
                } else if before.is_some() {
                    waiting.insert(name);
                }
            }
            "mkdir" | "unlink" => {}
            _ => drop(waiting.insert(name)),
        }
    }
    assert!(checkpoints > 1, "{checkpoints}");
    let (itself, mut others) = at_the_end.expect("results.h5");
    others.remove(".lock");
    assert!(!itself && others.is_empty(), "{others:?}");
}

#[test]
fn what_is_nested_too_deeply_is_refused() {
    let many = 100_000;
    let nested = [
        format!("a = {}{}", "[".repeat(many), "]".repeat(many)),
        format!("a = {}1{}", "{a=".repeat(many), "}".repeat(many)),
        format!("a{} = 1", ".a".repeat(many)),
        format!("[a{}]\nb = 1", ".a".repeat(many)),
        format!("[[a{}]]\nb = 1", ".a".repeat(many)),
        format!("[matrices.scalar]\nx = \"{}1{}\"", "(".repeat(many), ")".repeat(many)),
        format!(
            "[matrices.scalar]\nx = 1\n[[matrices.term]]\nfile = \"a.mtx\"\nfactor = \"{}x\"",
            "-".repeat(many)
        ),
    ];
    for text in nested {
        let folder = program::folder_with(&text);
        for command in ["check", "search"] {
            let output = program::run(&mut program::command(folder.path(), &[command, "case.toml"]));
            let said = program::said(&output, 2);
            assert!(said.len() < 2500, "{said}");
        }
    }
}
