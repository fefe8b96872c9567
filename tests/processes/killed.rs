//! Results folders under kills, refused writes, reruns and changed inputs: nothing is lost, nothing is mixed. A run in time
//! that is killed with SIGKILL is resumed, and the result is that of a whole run.

use crate::program::{Record, names, numbers, titles};
use ndarray::Array1;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use stridor::results::record::Saved;
use tempfile::TempDir;

/// A block on a belt that turns round four times; the contact opens after the block is pushed.
const BLOCK: &str = r#"
title = "A block on a belt that turns round"
assumptions = ["Everything here is made up."]

[point]
block = [0, 0, 0]

[mass.block]
on = "block"
mass = "1 kg"

[support.plane]
on = "block"
held = ["uz", "rx", "ry", "rz"]

[spring.k1]
on = "block"
direction = [1, 0, 0]
stiffness = "1 N/m"

[spring.k2]
on = "block"
direction = [1, -1, 0]
stiffness = "1 N/m"

[spring.kt]
on = "block"
direction = [1, 0, 0]
stiffness = "0.5 N/m"

[force.press]
on = "block"
force = [0, "1 N", 0]

[contact.belt]
body = "block"
counter = "ground"
into = [0, 1, 0]
approach = 0
sliding_velocity = "1 m/s"
sliding_direction = [-1, 0, 0]
normal = { per = "point", stiffness = "1 N/m" }
friction = { law = "coulomb", mu0 = 0.7, regularisation = "10 mm/s" }

[cea]
band = [0, "1 Hz"]

[transient]
duration = "200 s"
time_step = "5 ms"

[transient.disturbance]
amplitude = "1 mm"

[transient.push.up]
on = "block"
force = ["0.3 N", "-2 N", 0]
begin = "50 s"
duration = "2 s"

[transient.slide.belt]
motion = "reciprocating"
frequency = "0.02 Hz"
"#;

/// A disc that rubs on a pin and is struck, and what is heard of it.
const DISC: &str = r#"
title = "A disc on a pin"
assumptions = ["Everything here is made up."]

[mesh.annulus]
outer_radius = "75 mm"
hub_radius = "15 mm"
radial = 3
around = 12

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

[transient]
duration = "0.4 s"
time_step = "20 us"
fields_every = "10 ms"
push.blow = { on = "rim", force = ["-50 N", 0, 0], duration = "1 ms" }
probe.rim = { at = [0, 0, "75 mm"], direction = [1, 0, 0] }
sound.distance = "1 m"
"#;

/// When a run is killed, as parts of the time that a whole one takes.
const MOMENTS: [f64; 20] = [
    0.02, 0.07, 0.11, 0.16, 0.21, 0.26, 0.31, 0.37, 0.42, 0.46, 0.51, 0.55, 0.60, 0.64, 0.69, 0.73, 0.78,
    0.83, 0.89, 0.96,
];

fn start(folder: &Path, case: &str, out: &str, resume: bool) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stridor"));
    command.args(["transient", case, "--quiet", "--threads", "1", "--out", out]);
    command.args(resume.then_some("--resume")).current_dir(folder);
    command.stderr(Stdio::inherit()).spawn().expect("the binary runs")
}

/// Runs to the end.
fn run(folder: &Path, case: &str, out: &str, resume: bool) {
    assert!(start(folder, case, out, resume).wait().expect("it ends").success(), "{out}");
}

/// Runs for a time, then kills.
fn kill_after(time: Duration, folder: &Path, case: &str, out: &str, resume: bool) {
    let mut child = start(folder, case, out, resume);
    std::thread::sleep(time);
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
}

/// What a finished run says: the numbers of its record, its summary without what differs from run to run, its tables.
fn said(out: &Path) -> (Record, serde_json::Value, [Vec<u8>; 2]) {
    let file = hdf5::File::open(out.join("results.h5")).expect("results.h5 opens");
    assert!(file.attr("complete").and_then(|a| a.read_scalar::<bool>()).expect("a root attribute"));
    let mut record = Vec::new();
    numbers(&file.group("transient").expect("a run in time"), &mut record);
    if let Ok(fields) = hdf5::File::open(out.join("transient.vtkhdf")) {
        numbers(&fields, &mut record);
    }
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let mut summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    stridor::results::KEYS_OF_THE_RUN.iter().for_each(|key| drop(summary[*key].take()));
    (
        record,
        summary,
        ["transient.csv", "events.csv"].map(|name| std::fs::read(out.join(name)).expect("a table")),
    )
}

/// Whether an array of `results.h5` is filled during a run; the others are written at its end, or are of another file.
fn filled(name: &str) -> bool {
    let Some(path) = name.strip_prefix("/transient/") else { return false };
    match path.split_once('/') {
        Some(("events", of)) => ["time_s", "point", "kind"].contains(&of),
        Some((group, _)) => group == "history",
        None => false,
    }
}

/// How many rows a killed run left, all of which are those of the whole run; `None` when its march had not begun.
fn left(out: &Path, whole: &[(String, Vec<u64>)]) -> Option<usize> {
    let path = out.join("results.h5");
    if !path.exists() {
        return None;
    }
    let file = hdf5::File::open(path).expect("results.h5 opens after a kill");
    let group = file.group("transient").expect("a run in time");
    let count = |name: &str| group.attr(name).and_then(|a| a.read_scalar::<u64>()).expect("a count") as usize;
    let [rows, events] = ["rows", "events"].map(count);
    let filled: Vec<_> = whole.iter().filter(|(name, _)| filled(name)).collect();
    assert!(filled.len() > 15, "{} arrays", filled.len());
    for (name, values) in filled {
        let kept: Array1<f64> = file.dataset(name).and_then(|d| d.read_1d()).expect("a channel");
        let there = if name.contains("/events/") { events } else { rows };
        assert!(kept.len() >= there && values.len() >= there);
        assert!(kept.iter().zip(values).take(there).all(|(a, b)| a.to_bits() == *b), "{name}");
    }
    Some(rows)
}

/// The bytes of `record.bin` from which a killed run is resumed; `None` before its first checkpoint.
fn resumed_from(out: &Path) -> Option<u64> {
    let checkpoint = std::fs::read(out.join("checkpoint.bin")).ok()?;
    Some(Saved::from_bytes(&checkpoint).expect("a whole checkpoint").length)
}

#[test]
fn a_killed_run_opens_and_goes_on_bit_for_bit() {
    killed_runs_resume(&MOMENTS);
}

#[test]
#[ignore = "takes minutes"]
fn two_hundred_killed_runs_open_and_resume_bit_for_bit() {
    let moments: Vec<f64> = (1..=200).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract()).collect();
    killed_runs_resume(&moments);
}

/// Kills runs at these parts of the time that a whole one takes.
fn killed_runs_resume(moments: &[f64]) {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let reduced = BLOCK.replace("[transient]\n", "[transient]\nmodel = \"reduced\"\ntolerance = 1e-5\n");
    std::fs::write(at.join("full.toml"), BLOCK).expect("a case");
    std::fs::write(at.join("reduced.toml"), reduced).expect("a case");
    std::fs::write(at.join("disc.toml"), DISC).expect("a case");
    let cases = ["full.toml", "reduced.toml", "disc.toml"];
    let wholes = cases.map(|case| {
        let started = Instant::now();
        run(at, case, &format!("whole-{case}"), false);
        (started.elapsed(), said(&at.join(format!("whole-{case}"))))
    });
    let mut on_the_way = 0;
    for (k, moment) in moments.iter().copied().enumerate() {
        let case = cases[k % 3];
        let (time, whole) = &wholes[k % 3];
        let out = format!("killed-{k}");
        kill_after(time.mul_f64(moment), at, case, &out, false);
        let rows = left(&at.join(&out), &whole.0);
        if k % 4 == 0 {
            let kept = resumed_from(&at.join(&out));
            kill_after(time.mul_f64(0.5 * moment), at, case, &out, true);
            left(&at.join(&out), &whole.0);
            assert!(resumed_from(&at.join(&out)) >= kept, "{out}");
        }
        let (_, times) = whole.0.iter().find(|(name, _)| name == "/transient/history/time_s").expect("times");
        on_the_way += usize::from(rows.is_some_and(|rows| rows > 0 && rows < times.len()));
        run(at, case, &out, true);
        assert!(said(&at.join(&out)) == *whole, "killed at {moment} of the time: {rows:?} rows were left");
        std::fs::remove_dir_all(at.join(&out)).expect("it is there");
    }
    assert!(wholes[1].1.1["transient"]["steps_split"].as_u64() > Some(0), "the tolerance splits no step");
    assert!(wholes[2].1.1["transient"]["sound"]["power_level_db"].as_f64() > Some(40.0));
    let events = wholes[0].1.1["transient"]["events"].clone();
    assert!(["opens", "closes", "turns"].iter().all(|kind| events[kind].as_u64() > Some(0)), "{events}");
    println!("{} runs killed, {on_the_way} of them on their way", moments.len());
    assert!(on_the_way >= 6, "only {on_the_way} runs were killed on their way");
}

/// Ctrl-C ends the run as the system does, and says how to continue, once there is something to continue from.
#[test]
#[cfg(unix)]
fn an_interrupted_run_says_how_to_continue() {
    use std::os::unix::process::{CommandExt, ExitStatusExt};
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    std::fs::write(at.join("case.toml"), BLOCK.replace("200 s", "2000 s")).expect("a case");
    let mut command = Command::new(env!("CARGO_BIN_EXE_stridor"));
    command.args(["transient", "case.toml", "--out", "out"]).current_dir(at);
    // Whatever runs the tests in the background ignores interrupts, which is inherited.
    // SAFETY: signal may be called between fork and exec.
    unsafe {
        command.pre_exec(|| {
            libc::signal(libc::SIGINT, libc::SIG_DFL);
            Ok(())
        })
    };
    let child = command.stderr(Stdio::piped()).spawn().expect("the binary runs");
    let deadline = Instant::now() + Duration::from_secs(60);
    while !at.join("out/record.bin").exists() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(5));
    }
    // SAFETY: a signal to a process that is not yet waited for.
    unsafe { libc::kill(child.id() as i32, libc::SIGINT) };
    let ended = child.wait_with_output().expect("it ends");
    assert_eq!(ended.status.signal(), Some(libc::SIGINT));
    let words = String::from_utf8(ended.stderr).expect("text");
    assert!(words.contains("The same command with --resume continues."), "{words}");
    run(at, "case.toml", "out", true);
}

#[test]
fn results_of_another_case_or_another_start_are_not_resumed() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let short = BLOCK.replace("200 s", "20 s");
    std::fs::write(at.join("case.toml"), &short).expect("a case");
    run(at, "case.toml", "out", false);
    let refused = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stridor"));
        command.args(["transient", "case.toml", "--out", "out", "--resume"]).current_dir(at);
        let output = command.output().expect("the binary runs");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    let before = std::fs::read(at.join("out/results.h5")).expect("results");
    std::fs::write(at.join("case.toml"), short.replace("20 s", "21 s")).expect("a case");
    refused(&["results of another case", "--out"]);
    std::fs::write(at.join("case.toml"), &short).expect("a case");
    assert_eq!(std::fs::read(at.join("out/results.h5")).expect("results"), before);
    std::fs::write(at.join("case.toml"), short.replace("time_step", "fields_every = \"1 s\"\ntime_step"))
        .expect("a case");
    refused(&["case.toml:", "fields_every", "no [mesh]"]);
    std::fs::write(at.join("case.toml"), &short).expect("a case");
    // A record that was written by another version of the program, say, or that a disk has damaged.
    let record = at.join("out/record.bin");
    let whole = std::fs::read(&record).expect("a record");
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 1;
    std::fs::write(&record, damaged).expect("it is written");
    refused(&["record.bin", "checksum", "without --resume"]);
    std::fs::write(&record, whole).expect("it is written");
    // `results.h5` is not read: whatever is in it, the result is the same.
    std::fs::write(at.join("out/results.h5"), &before[..before.len() / 2]).expect("it is written");
    run(at, "case.toml", "again", false);
    run(at, "case.toml", "out", true);
    assert!(said(&at.join("out")) == said(&at.join("again")));
}

/// The program with arguments, on one thread.
fn stridor(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stridor"));
    command.args(arguments).args(["--threads", "1"]).current_dir(folder).output().expect("the binary runs")
}

/// Waits until a run under way has saved rows.
fn wait_for_rows(out: &Path) {
    let began = Instant::now();
    while !out.join("checkpoint.bin").exists() && began.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_rerun_keeps_an_interrupted_record_and_leaves_nothing_else_of_the_earlier_run() {
    let folder = TempDir::new().expect("a temporary folder");
    let (at, out) = (folder.path(), folder.path().join("out"));
    std::fs::write(at.join("case.toml"), BLOCK).expect("a case");
    run(at, "case.toml", "whole", false);
    run(at, "case.toml", "out", false);
    std::fs::write(out.join("modes_notes.csv"), "mine").expect("a file of the user");
    // A finished run is replaced, with all its files.
    for name in ["out", "alone"] {
        let output = stridor(at, &["cea", "case.toml", "--out", name]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let mut alone = names(&at.join("alone"));
    assert!(alone.contains(&"report.html".to_string()) && !alone.contains(&"transient.csv".to_string()));
    alone.push("modes_notes.csv".into());
    alone.sort();
    assert_eq!(names(&out), alone);
    let mut child = start(at, "case.toml", "out", false);
    wait_for_rows(&out);
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let interrupted =
        ["checkpoint.bin", "events.csv", "modes_notes.csv", "record.bin", "results.h5", "transient.csv"];
    assert_eq!(names(&out), interrupted, "the files of the earlier run are beside the new ones");
    // Another analysis does not resume it.
    let output = stridor(at, &["cea", "case.toml", "--out", "out", "--resume"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && message.contains("stridor transient"), "{message}");
    assert_eq!(names(&out), interrupted);
    let output = stridor(at, &["transient", "case.toml", "--out", "out"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(0) && message.contains("interrupted-1"), "{message}");
    let whole = said(&at.join("whole"));
    let restarted = said(&out);
    assert!(restarted.0 == whole.0 && restarted.2 == whole.2);
    assert!(restarted.1["warnings"].to_string().contains("interrupted-1"), "{}", restarted.1["warnings"]);
    // The record that was moved is a results folder of its own.
    run(at, "case.toml", "out/interrupted-1", true);
    assert!(said(&out.join("interrupted-1")) == whole);
    assert!(out.join("modes_notes.csv").exists() && !out.join("interrupted-2").exists());
}

#[test]
fn a_sweep_is_not_resumed_after_its_mesh_has_changed() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let mesh = |size: &str| {
        let output = stridor(
            at,
            &["mesh", "disc", "--out", "disc.msh", "--force", "--size", size, "--contact-size", "10 mm"],
        );
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let (head, tail) = DISC.split_once("[mesh.annulus]").expect("a mesh");
    let (_, tail) = tail.split_once("[material.steel]").expect("a material");
    let (tail, _) = tail.split_once("[transient]").expect("a run in time");
    let map = "[map.m]\nparameters = [\"contact.pin.friction.mu0\", \"damping.modal_ratio\"]\n\
               from = [0.1, 0.001]\nto = [0.5, 0.01]\npoints = [3, 2]\n";
    let case = format!("{head}[mesh]\nfile = \"disc.msh\"\nunit = \"mm\"\n[material.steel]{tail}{map}");
    std::fs::write(at.join("case.toml"), case).expect("a case");
    mesh("30 mm");
    let sweep = |arguments: &[&str]| {
        stridor(at, &[&["sweep", "case.toml", "--out", "out", "--quiet"], arguments].concat())
    };
    let output = sweep(&[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let map = std::fs::read(at.join("out/map_m.csv")).expect("a map");
    assert!(sweep(&["--resume"]).status.success());
    assert_eq!(std::fs::read(at.join("out/map_m.csv")).expect("a map"), map);
    let summary = std::fs::read(at.join("out/summary.json")).expect("a summary");
    let said: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    assert!(said["inputs"][0]["path"] == "disc.msh" && said["complete"] == true, "{}", said["inputs"]);
    assert_eq!(said["inputs"][0]["sha256"].as_str().map(str::len), Some(64));
    mesh("12 mm");
    let output = sweep(&["--resume"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && message.contains("`disc.msh` has changed"), "{message}");
    assert_eq!(std::fs::read(at.join("out/summary.json")).expect("a summary"), summary);
}

#[test]
fn what_was_found_before_an_analysis_failed_is_written() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    let (head, _) = DISC.split_once("[damping]").expect("a damping");
    let case = format!(
        "{head}[modes.disc]\nbelow = \"3 kHz\"\nmeasured = [10, 330]\nmeasured_source = \"none\"\n\
         [calibrate]\nagainst = [\"disc\"]\n[calibrate.parameter.hub]\n\
         path = \"shell.disc.thickness\"\nbetween = [\"0.9 mm\", \"1.1 mm\"]\n"
    );
    std::fs::write(at.join("case.toml"), case).expect("a case");
    let output = stridor(at, &["run", "case.toml", "--out", "out"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && message.contains("10 Hz"), "{message}");
    let out = at.join("out");
    let summary = std::fs::read(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_slice(&summary).expect("JSON");
    assert!(summary["complete"] == false && summary["modes"][0]["frequency_hz"].is_number());
    assert!(summary["failed"].as_str().is_some_and(|said| said.contains("10 Hz")));
    let report = std::fs::read_to_string(out.join("report.html")).expect("a report");
    assert!(report.contains("This run failed.") && report.contains("10 Hz"));
    assert!(out.join("modes_disc.csv").exists());
    let file = hdf5::File::open(out.join("results.h5")).expect("results.h5 opens");
    assert!(!file.attr("complete").and_then(|a| a.read_scalar::<bool>()).expect("a root attribute"));
    assert!(file.attr("failed").is_ok() && file.dataset("modes/disc/frequency_hz").is_ok());
}

#[test]
fn what_is_in_the_folder_is_always_of_one_run() {
    let folder = TempDir::new().expect("a temporary folder");
    let (at, out) = (folder.path(), folder.path().join("out"));
    let short = BLOCK.replace("200 s", "10 s").replace("50 s", "5 s");
    for (name, title) in [("first.toml", "The first case"), ("second.toml", "The second case")] {
        let case = short.replace("A block on a belt that turns round", title);
        std::fs::write(at.join(name), case).expect("a case");
    }
    run(at, "first.toml", "out", false);
    let files = names(&out);
    let began = Instant::now();
    run(at, "first.toml", "out", false);
    let time = began.elapsed();
    let mut of_one = [0, 0];
    for k in 0..40 {
        kill_after(time.mul_f64(f64::from(k) / 36.0), at, "second.toml", "out", false);
        let titles = titles(&out, ["The first case", "The second case"]);
        assert!(titles.windows(2).all(|pair| pair[0] == pair[1]), "kill {k}: {titles:?}");
        let second = titles.contains(&"The second case");
        of_one[usize::from(second)] += 1;
        if !second {
            let others =
                names(&out).into_iter().filter(|name| name != "results.new.h5" && !files.contains(name));
            assert_eq!(others.count(), 0, "kill {k}: {:?}", names(&out));
        }
        if second || titles.len() < 3 {
            std::fs::remove_dir_all(&out).expect("it is there");
            run(at, "first.toml", "out", false);
        }
    }
    assert!(of_one.iter().all(|count| *count > 3), "{of_one:?}");
}

/// Every write fails that makes a file larger than a limit, for many limits: a message, exit code 1, and nothing is lost.
#[test]
#[cfg(target_os = "linux")]
fn writes_that_fail_anywhere_are_told_and_lose_nothing() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    std::fs::write(at.join("case.toml"), BLOCK.replace("200 s", "60 s")).expect("a case");
    run(at, "case.toml", "whole", false);
    let whole = said(&at.join("whole"));
    let mut failed = 0;
    // In blocks of 512 bytes, to beyond the largest file.
    for limit in [0, 1, 2, 4, 8, 16, 40, 100, 200, 400, 800, 1200, 1600, 2000, 2500, 3000, 4000, 20000] {
        let mut command = Command::new("sh");
        let words =
            format!("ulimit -f {limit}; exec \"$0\" transient case.toml --quiet --threads 1 --out out");
        command.args(["-c", &words, env!("CARGO_BIN_EXE_stridor")]).current_dir(at);
        let output = command.output().expect("a shell");
        let message = String::from_utf8_lossy(&output.stderr);
        if output.status.code() != Some(0) {
            failed += 1;
            assert_eq!(output.status.code(), Some(1), "{limit}: {message}");
            assert!(message.contains("error: out/") && message.lines().count() == 1, "{limit}: {message}");
            let reported =
                ["File too large", "cannot be written"].iter().any(|words| message.contains(words));
            assert!(reported, "{limit}: {message}");
        }
        run(at, "case.toml", "out", true);
        assert!(said(&at.join("out")) == whole, "{limit}");
        std::fs::remove_dir_all(at.join("out")).expect("it is there");
    }
    assert!((8..18).contains(&failed), "{failed}");
}

#[test]
fn a_second_process_in_the_folder_is_refused_and_a_kill_frees_it() {
    let folder = TempDir::new().expect("a temporary folder");
    let at = folder.path();
    std::fs::write(at.join("case.toml"), BLOCK).expect("a case");
    run(at, "case.toml", "whole", false);
    let mut first = start(at, "case.toml", "out", false);
    let began = Instant::now();
    while !at.join("out/transient.csv").exists() && began.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    for command in ["cea", "transient", "export"] {
        let mut second = Command::new(env!("CARGO_BIN_EXE_stridor"));
        let output = second.args([command, "case.toml", "--out", "out"]).current_dir(at).output();
        let output = output.expect("the binary runs");
        let message = String::from_utf8_lossy(&output.stderr);
        let holder = format!("process {} (`", first.id());
        assert!(output.status.code() == Some(1) && message.contains(&holder), "{command}: {message}");
        assert!(message.contains("transient case.toml --quiet"), "{message}");
    }
    first.kill().expect("it can be killed");
    first.wait().expect("it ends");
    run(at, "case.toml", "out", true);
    assert!(said(&at.join("out")) == said(&at.join("whole")), "the first was harmed");
}
