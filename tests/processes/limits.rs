//! Numbers and machines at their limits: the binary answers with a result or with a sentence and an exit code.

use crate::program::limit_memory;
use crate::program::{command, folder_with, run, said};
use std::f64::consts::TAU;
use std::path::Path;
use std::process::Output;
#[cfg(target_os = "linux")]
use stridor::bounds::{Origin::*, within};

fn stridor(folder: &Path, arguments: &[&str]) -> Output {
    run(&mut command(folder, arguments))
}

/// Two masses that a contact presses together while they slide; the belt drives the lower one.
const BLOCK: &str = r#"
[point]
block = [0, 0, 0]

[mass.block]
on = "block"
mass = "2 kg"

[support.plane]
on = "block"
held = ["uz", "rx", "ry", "rz"]

[spring.along]
on = "block"
direction = [1, 0, 0]
stiffness = "2 kN/m"

[force.press]
on = "block"
force = [0, "-10 N", 0]

[contact.belt]
body = "block"
counter = "ground"
into = [0, -1, 0]
approach = 0
sliding_velocity = "0.3 m/s"
sliding_direction = [1, 0, 0]
normal = { per = "point", stiffness = "100 kN/m" }
friction = { law = "coulomb", mu0 = 0.4 }

[cea]
band = [0, "10 Hz"]
"#;

/// A plate, free in space.
const PLATE: &str = r#"
[mesh.plate]
length = "200 mm"
width = "100 mm"
cells_along = 10
cells_across = 6

[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"

[shell.plate]
material = "steel"
thickness = "2 mm"

[modes.plate]
"#;

#[test]
fn contacts_of_extreme_numbers_are_analysed_or_refused() {
    let inclined = BLOCK.replace("into = [0, -1, 0]", "into = [0, -1, 0.2]");
    said(&stridor(folder_with(&inclined).path(), &["cea", "case.toml", "-q"]), 0);
    for (old, new) in [
        ("stiffness = \"100 kN/m\"", "stiffness = \"100 kN/m\", cubic = 1e300"),
        ("\"-10 N\"", "-1e300"),
        ("\"100 kN/m\"", "1e300"),
        ("\"100 kN/m\"", "1e-300"),
        ("\"2 kg\"", "1e-300"),
        ("\"2 kg\"", "1e300"),
    ] {
        assert!(BLOCK.contains(old));
        stridor(folder_with(&BLOCK.replace(old, new)).path(), &["run", "case.toml", "-q"]);
    }
}

/// A penalty is the limit of a rigid contact: above a certain stiffness neither the load nor the complex modes move, but by rounding,
/// ε k: of 1e18 N/m it is 222 N/m. The stated errors cover that, and of 1e18 N/m those of six modes are more than four digits allow.
#[test]
fn a_stiffer_penalty_moves_no_squeal_mode() {
    let rig = include_str!("../../validation/rig-coarse/plain.toml").replace("\"6 kHz\"", "\"2 kHz\"");
    let run = |stiffness: &str| {
        let folder = folder_with(&rig.replace("\"10 MN/m\"", stiffness));
        stridor(folder.path(), &["cea", "case.toml", "--json", "-q"])
    };
    let with = |stiffness: &str| {
        let output = run(stiffness);
        said(&output, 0);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let load = summary["steady_sliding"]["pairs"][0]["normal_force_n"].as_f64().unwrap();
        assert!(within((load - 10.0).abs(), 1e-8, Tolerance), "{stiffness}: {load} N");
        let modes = summary["cea"]["eigenvalues"].as_array().unwrap().clone();
        let number = |mode: &serde_json::Value, key: &str| mode[key].as_f64().unwrap();
        let keys = ["frequency_hz", "growth_rate", "eigenvalue_error"];
        modes.iter().map(|m| keys.map(|key| number(m, key))).collect::<Vec<_>>()
    };
    let reference = with("1e13");
    assert!(reference.len() > 4);
    for stiffness in ["1e14"] {
        let stiffer = with(stiffness);
        assert_eq!(stiffer.len(), reference.len());
        for ([hz, growth, error], [hz_before, growth_before, _]) in stiffer.iter().zip(&reference) {
            assert!(
                within((hz - hz_before).abs(), 1e-5 * hz_before.max(1.0), Theory),
                "{stiffness}: {hz} Hz, {hz_before} Hz"
            );
            let size = (TAU * hz).hypot(*growth);
            // The one that diverges follows the penalty longest, by 3e-4 here: as 1/k.
            let part = if *hz > 1.0 { 1e-5 } else { 1e-3 };
            let bound = (part * growth_before.abs().max(1.0)).max(error * size);
            assert!(
                within((growth - growth_before).abs(), bound, Theory),
                "{stiffness}: {growth}, {growth_before} 1/s"
            );
        }
    }
    let text = said(&run("1e18"), 1);
    assert!(
        text.contains("relative eigenvalue error") && text.contains("many orders of magnitude above"),
        "{text}"
    );
}

/// A record for which the disk has no space is refused before a folder is made.
#[test]
fn a_run_in_time_without_room_writes_nothing() {
    let probe = |k: usize| format!("[transient.probe.p{k}]\non = \"block\"\ndirection = [1, 0, 0]\n");
    let probes: String = (0..2000).map(probe).collect();
    let endless = format!("{BLOCK}[transient]\nduration = \"100 s\"\ntime_step = \"1 us\"\n{probes}");
    let folder = folder_with(&endless);
    let text = said(&stridor(folder.path(), &["run", "case.toml", "--out", "out"]), 1);
    assert!(text.contains("100000000 steps of 6013 channels") && text.contains("the disk has"), "{text}");
    assert!(!folder.path().join("out").exists(), "{text}");
}

#[test]
fn a_mesh_goes_to_a_folder_that_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let text = said(&stridor(folder.path(), &["mesh", "disc", "--out", "missing/folder/x.msh"]), 1);
    assert!(text.contains("missing/folder: there is no such folder") && text.contains("mkdir -p"), "{text}");
}

#[test]
fn what_a_case_asks_of_no_mode_is_said() {
    let with = |old: &str, new: &str| {
        assert!(BLOCK.contains(old));
        folder_with(&BLOCK.replace(old, new))
    };
    let band = "band = [0, \"10 Hz\"]";
    let nearest = with(band, "band = [0, \"10 Hz\"]\nnearest = \"5 Hz\"\ncount = 1");
    let output = stridor(nearest.path(), &["check", "case.toml"]);
    let text = said(&output, 0) + &String::from_utf8_lossy(&output.stdout);
    assert!(
        text.contains("the 1 complex modes nearest to 5 Hz alone, not for all from 0 to 10 Hz"),
        "{text}"
    );

    let massless = with("mass = \"2 kg\"", "mass = 0");
    let text = said(&stridor(massless.path(), &["check", "case.toml"]), 2);
    assert!(text.contains("no mass") && text.contains("nothing vibrates without"), "{text}");

    let empty = with(band, "band = [\"10 Hz\", \"20 Hz\"]");
    let output = stridor(empty.path(), &["cea", "case.toml"]);
    let text = said(&output, 0) + &String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("No complex mode was found between 10 and 20 Hz"), "{text}");
}

/// Where the penalty leaves λ no digits, the modes are marked in every output and the run fails.
#[test]
fn modes_without_digits_have_no_verdict() {
    let rig = include_str!("../../validation/rig-coarse/plain.toml").replace("\"6 kHz\"", "\"2 kHz\"");
    let folder = folder_with(&rig.replace("\"10 MN/m\"", "1e23"));
    let text = said(&stridor(folder.path(), &["cea", "case.toml", "--out", "out"]), 1);
    assert!(text.contains("complex modes: the refinement did not settle"), "{text}");
    let written = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&written("summary.json")).unwrap();
    assert!(summary["complete"] == false && summary["failed"].as_str().unwrap().contains("did not settle"));
    let modes = summary["cea"]["eigenvalues"].as_array().unwrap();
    let lost = modes.iter().filter(|mode| mode["verdict"] == "not accurate").count();
    assert!(lost > 0 && summary["cea"]["not_accurate"] == lost);
    assert!(modes.iter().all(|mode| mode["verdict"] != "not accurate" || mode["unstable"] == false));
    assert_eq!(written("complex_modes.csv").matches(",not accurate,").count(), lost);
    let page = written("report.html");
    assert!(page.contains("NOT ACCURATE") && page.contains("neither stable nor unstable"));
}

#[test]
fn a_free_body_gives_as_many_rigid_motions_as_it_has() {
    for count in [1, 3, 6] {
        let folder = folder_with(&format!("{PLATE}count = {count}\n"));
        let output = stridor(folder.path(), &["modes", "case.toml", "--json"]);
        said(&output, 0);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["mode_sets"][0]["rigid_bodies"], 6, "{}", summary["mode_sets"][0]);
    }
    let light = PLATE.replace("\"7850 kg/m^3\"", "1e-100");
    stridor(folder_with(&format!("{light}count = 3\n")).path(), &["modes", "case.toml"]);
}

#[test]
fn a_part_that_nothing_holds_is_named() {
    let spring = "[spring.along]\non = \"block\"\ndirection = [1, 0, 0]\nstiffness = \"2 kN/m\"\n";
    assert!(BLOCK.contains(spring));
    let text = said(&stridor(folder_with(&BLOCK.replace(spring, "")).path(), &["run", "case.toml"]), 2);
    assert!(text.contains("`mass`") && text.contains("free in 1 rigid-body motion even with"), "{text}");
}

#[test]
fn numbers_of_threads_are_bounded() {
    let folder = folder_with(&format!("{PLATE}count = 1\n"));
    for threads in ["0", "8000"] {
        let text = said(&stridor(folder.path(), &["check", "case.toml", "--threads", threads]), 2);
        assert!(text.contains("--threads") && text.contains("1 to 1024"), "{text}");
    }
    said(&stridor(folder.path(), &["check", "case.toml", "--threads", "3"]), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn only_regular_files_are_read() {
    let mesh = PLATE.replace(
        "[mesh.plate]\nlength = \"200 mm\"\nwidth = \"100 mm\"\ncells_along = 10\ncells_across = 6\n",
        "[mesh]\nfile = \"MESH\"\nunit = \"mm\"\n",
    );
    assert!(mesh.contains("MESH"));
    let folder = folder_with("");
    let pipe = folder.path().join("pipe");
    let name = std::ffi::CString::new(pipe.to_str().unwrap()).unwrap();
    // SAFETY: a call to the system with the name of a file, which ends in a zero.
    assert_eq!(unsafe { libc::mkfifo(name.as_ptr(), 0o600) }, 0);
    std::fs::File::create(folder.path().join("huge")).unwrap().set_len(100 << 30).unwrap();
    for (file, words) in
        [("/dev/zero", "a device"), ("pipe", "a pipe"), (".", "a folder"), ("huge", "100.000 GiB")]
    {
        std::fs::write(folder.path().join("case.toml"), format!("{}count = 1\n", mesh.replace("MESH", file)))
            .unwrap();
        let text = said(&stridor(folder.path(), &["check", "case.toml"]), 2);
        assert!(text.contains(words), "{text}");
        let text = said(&stridor(folder.path(), &["check", file]), 2);
        assert!(text.contains(words), "{text}");
    }
}

/// With a bound on the memory a run ends with its results or with one paragraph.
#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_one_paragraph() {
    let fine = PLATE.replace("= 10\n", "= 130\n").replace("= 6\n", "= 70\n");
    let folder = folder_with(&format!("{fine}count = 40\n"));
    let mut refused = 0;
    for megabytes in [60u64, 90, 130, 200, 300] {
        let mut command = command(folder.path(), &["modes", "case.toml", "-q", "--threads", "2"]);
        limit_memory(&mut command, megabytes);
        let output = command.output().expect("the binary runs");
        // The loader of the system needs some, too.
        if !output.status.success() && output.status.code() != Some(127) {
            let text = said(&output, 1);
            assert!(text.contains("memory") || text.contains("threads"), "{text}");
            assert!(text.trim_end().lines().count() <= 2, "{text}");
            refused += 1;
        }
    }
    assert!(refused > 0, "limits that do not bind");
}

/// A run that is large enough to be estimated takes what was expected within thirty percent, and is not begun where that is not
/// there.
#[cfg(target_os = "linux")]
#[test]
fn the_peak_of_memory_is_predicted() {
    let fine = PLATE.replace("= 10\n", "= 60\n").replace("= 6\n", "= 60\n");
    let folder = folder_with(&format!("{fine}count = 30\n"));
    let checked = stridor(folder.path(), &["check", "case.toml"]);
    let text = String::from_utf8(checked.stdout).unwrap();
    let words = text.split("about ").nth(1).expect("an estimate").split(' ').collect::<Vec<_>>();
    assert_eq!(words[1], "MiB", "{text}");
    let expected: f64 = words[0].parse().unwrap();

    let mut child = command(folder.path(), &["modes", "case.toml", "-q", "--threads", "2"]).spawn().unwrap();
    let mut status = 0;
    // SAFETY: the system writes into two values of its own kinds; the child is waited for here only.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        assert!(libc::wait4(child.id() as libc::pid_t, &mut status, 0, &mut usage) > 0);
        usage
    };
    let _ = child.try_wait();
    assert_eq!(status, 0);
    let measured = usage.ru_maxrss as f64 / 1024.0;
    assert!(
        within((expected / measured - 1.0).abs(), 0.3, Theory),
        "expected {expected} MiB, measured {measured} MiB"
    );

    let mut small = command(folder.path(), &["modes", "case.toml", "-q", "--threads", "1"]);
    limit_memory(&mut small, 220);
    let text = said(&small.output().unwrap(), 1);
    assert!(text.contains("memory"), "{text}");
}
