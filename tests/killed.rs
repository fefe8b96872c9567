//! A run in time that is killed with SIGKILL: its file opens, the run is taken up, the result is that of a whole run.

use ndarray::Array1;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
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

/// Arrays of numbers by name, as bits.
type Record = Vec<(String, Vec<u64>)>;

/// Every array of numbers in a group and below.
fn numbers(group: &hdf5::Group, found: &mut Record) {
    for dataset in group.datasets().expect("datasets") {
        if let Ok(values) = dataset.read_raw::<f64>() {
            found.push((dataset.name(), values.iter().map(|v| v.to_bits()).collect()));
        }
    }
    group.groups().expect("groups").iter().for_each(|inner| numbers(inner, found));
}

/// What a finished run says: the numbers of its record, its summary without wall times, its tables.
fn said(out: &Path) -> (Record, serde_json::Value, [Vec<u8>; 2]) {
    let file = hdf5::File::open(out.join("results.h5")).expect("results.h5 opens");
    assert!(file.attr("complete").and_then(|a| a.read_scalar::<bool>()).expect("a root attribute"));
    let mut record = Vec::new();
    numbers(&file.group("transient").expect("a run in time"), &mut record);
    record.retain(|(name, _)| !name.contains("/checkpoint/"));
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let mut summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    summary["timings"].take();
    (
        record,
        summary,
        ["transient.csv", "events.csv"].map(|name| std::fs::read(out.join(name)).expect("a table")),
    )
}

/// Whether a name is one of what the whole record says, which a killed run does not have.
fn found(name: &str) -> bool {
    ["spectrum", "spectrogram", "contact_state", "sound"].iter().any(|word| name.contains(word))
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
    for (name, values) in whole.iter().filter(|(name, _)| !found(name)) {
        let kept: Array1<f64> = file.dataset(name).and_then(|d| d.read_1d()).expect("a channel");
        let there = if name.contains("/events/") { events } else { rows };
        assert!(kept.len() >= there && values.len() >= there);
        assert!(kept.iter().zip(values).take(there).all(|(a, b)| a.to_bits() == *b), "{name}");
    }
    Some(rows)
}

#[test]
fn a_killed_run_opens_and_goes_on_bit_for_bit() {
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
    for (k, moment) in MOMENTS.into_iter().enumerate() {
        let case = cases[k % 3];
        let (time, whole) = &wholes[k % 3];
        let out = format!("killed-{k}");
        kill_after(time.mul_f64(moment), at, case, &out, false);
        let rows = left(&at.join(&out), &whole.0);
        if k % 4 == 0 {
            kill_after(time.mul_f64(0.5 * moment), at, case, &out, true);
            assert!(left(&at.join(&out), &whole.0) >= rows, "{out}");
        }
        on_the_way += usize::from(rows.is_some_and(|rows| rows > 0 && rows < whole.0[0].1.len()));
        run(at, case, &out, true);
        assert!(said(&at.join(&out)) == *whole, "killed at {moment} of the time: {rows:?} rows were left");
        std::fs::remove_dir_all(at.join(&out)).expect("it is there");
    }
    assert!(wholes[1].1.1["transient"]["steps_split"].as_u64() > Some(0), "the tolerance splits no step");
    assert!(wholes[2].1.1["transient"]["sound"]["power_level_db"].as_f64() > Some(40.0));
    let events = wholes[0].1.1["transient"]["events"].clone();
    assert!(["opens", "closes", "turns"].iter().all(|kind| events[kind].as_u64() > Some(0)), "{events}");
    assert!(on_the_way >= 6, "only {on_the_way} runs were killed on their way");
}

#[test]
fn results_of_another_case_or_another_start_are_not_taken_up() {
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
    // What a changed mesh would do to the same case: the run no longer begins as the earlier one did.
    let file = hdf5::File::open_rw(at.join("out/results.h5")).expect("results");
    let penetration = file.dataset("transient/penetration").expect("a channel");
    penetration.write_slice(&[0.5], ndarray::s![0..1]).expect("it is written");
    drop((penetration, file));
    refused(&["penetration", "without --resume"]);
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
    for command in ["modes", "transient", "export"] {
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
