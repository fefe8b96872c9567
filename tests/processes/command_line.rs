//! The program as its users meet it: runs the binary in a temporary folder.

use crate::small_rig::{RIG, folder_with, refused, stridor, text};
use std::path::Path;
use std::process::Command;
use stridor::bounds::{Origin::*, within};
use tempfile::TempDir;

#[test]
fn sensitivities_and_advice_are_printed_and_stored() {
    let case = RIG.to_string()
        + "\n[sensitivity]\nparameters = [\"contact.*.load\", \"*.mu0\", \"mesh.rig.disc_size\"]\n";
    let folder = folder_with(&case);
    let output = stridor(folder.path(), &["sensitivity", "rig.toml", "--out", "out"]);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for word in ["contact.rim.friction.mu0", "Stabilising additions", "an element size"] {
        assert!(table.contains(word), "\"{word}\" is not in: {table}");
    }
    assert!(folder.path().join("out/advice.vtu").exists());
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let rates = summary["sensitivity"]["modes"][0]["parameters"].as_array().expect("rates");
    assert_eq!(rates.len(), 2);
    assert!(rates.iter().all(|rate| rate["dsigma_dp"].is_number()));
    let refusal = folder_with(&case.replace("*.mu0", "*.mu9"));
    refused(&refusal, 2, &["sensitivity.parameters", "*.mu9"]);
}

#[test]
fn a_command_refuses_a_case_without_its_table() {
    let folder = folder_with(RIG);
    for (command, example) in [
        ("sweep", "[sweep.mu]"),
        ("uncertainty", "[uncertainty.all.parameter.mu]"),
        ("transient", "[transient]"),
        ("frf", "[frf.tap]"),
        ("calibrate", "[calibrate]"),
    ] {
        let output = stridor(folder.path(), &[command, "rig.toml", "--out", "out"]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains(&format!("`{command}`: found no such table")), "{message}");
        assert!(message.contains(example), "{message}");
        assert!(!folder.path().join("out").exists());
    }
}

#[test]
fn check_finds_what_run_refuses() {
    const THICKNESS: &str = "[calibrate.parameter.t]\npath = \"shell.disc.thickness\"\n";
    for (more, word) in [
        (
            "[transient]\nduration = 1e-3\ntime_step = 1e-4\n[transient.probe.cell]\nspring = \"none\"\n"
                .to_string(),
            "one of the case's springs",
        ),
        (
            format!("[calibrate]\nagainst = \"disc\"\n{THICKNESS}between = [\"2 mm\", \"3 mm\"]\n"),
            "bounds that hold the value of the case",
        ),
        (
            format!(
                "[measured.tap]\nof = \"disc\"\nfrequencies = [330]\nshape_deviation = 0.1\n\
                 [calibrate]\nagainst = \"tap\"\n{THICKNESS}between = [\"0.5 mm\", \"2 mm\"]\n"
            ),
            "shape_deviation",
        ),
        (
            "[frf.tap]\nband = [10, 1e3]\nexcitation = { at = [70, 0, 0], direction = [1, 0, 0] }\n"
                .to_string(),
            "a place on the model",
        ),
        (
            "[contact.again]\n".to_string()
                + RIG
                    .split("[contact.rim]\n")
                    .nth(1)
                    .expect("a contact")
                    .split("placement")
                    .next()
                    .expect("its keys")
                + "normal = { per = \"length\", stiffness = \"10 GN/m^2\" }\nfriction = { law = \"coulomb\", mu0 = 0.4 }\n",
            "contact points that are there once",
        ),
    ] {
        let folder = folder_with(&format!("{RIG}\n{more}"));
        refused(&folder, 2, &[word]);
        let output = stridor(folder.path(), &["check", "rig.toml"]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn what_is_only_found_while_computing_is_no_fault_of_the_input() {
    let folder = folder_with(&format!("{RIG}\n[damping]\nmodal_ratios = [[\"1 Hz\", 0.01]]\n"));
    refused(&folder, 1, &["found while computing", "damping.modal_ratios"]);
    let output = stridor(folder.path(), &["check", "rig.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[test]
fn the_main_job_prints_its_tables_and_leaves_a_results_folder() {
    let folder = folder_with(RIG);
    let output = stridor(folder.path(), &["run", "rig.toml", "--out", "out"]);
    let table = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for word in ["330", "936", "Steady sliding", "Complex eigenvalues"] {
        assert!(table.contains(word), "{word} is not in\n{table}");
    }
    for file in ["results.h5", "summary.json", "report.html", "complex_modes.vtu", "complex_modes.csv"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file} is missing");
    }
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("valid JSON");
    let modes = summary["cea"]["eigenvalues"].as_array().expect("a list");
    assert!(!modes.is_empty());
    assert!(
        modes.iter().all(|m| m["backward_error"].as_f64().is_some_and(|e| within(e, 1e-10, Tolerance))),
        "{modes:?}"
    );
    assert!(summary["mode_sets"][0]["certificate"]["holds"].as_bool().expect("a verdict"));
    let provenance = &summary["provenance"];
    let command = provenance["command"].as_array().expect("a list");
    assert_eq!(command[1..], ["run", "rig.toml", "--out", "out"].map(serde_json::Value::from));
    assert!(provenance["case_file"] == "rig.toml" && provenance["threads"].as_u64() > Some(0));
    assert!(provenance["started"].as_str().is_some_and(|date| date.starts_with("20") && date.ends_with('Z')));
    // What the page says and leads to is of this run.
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("a page");
    assert!(page.contains(provenance["case_sha256"].as_str().expect("a checksum")));
    let links = page.split("<a href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let files: Vec<&str> = links.filter(|link| !link.starts_with('#')).collect();
    assert!(files.contains(&"results.h5") && files.contains(&"complex_modes.csv"), "{files:?}");
    for file in files {
        assert!(folder.path().join("out").join(file).is_file(), "{file} is linked and missing");
    }
}

#[test]
fn one_and_two_threads_give_the_same_numbers() {
    let folder = folder_with(RIG);
    let figures = |threads: &str| {
        let output =
            stridor(folder.path(), &["cea", "rig.toml", "--json", "--threads", threads, "--out", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let mut summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
        stridor::results::KEYS_OF_THE_RUN.iter().for_each(|key| drop(summary[*key].take()));
        summary
    };
    assert_eq!(figures("1"), figures("2"));
}

/// The transient that is added to the small rig; the disc rings after a blow.
const BLOW: &str = r#"
[transient]
duration = "4 ms"
time_step = "10 us"
scheme = "newmark"

[transient.disturbance]
amplitude = "1 nm"

[transient.push.blow]
on = "bar_root"
force = ["1 N", 0, "1 N"]
begin = "0.5 ms"
duration = "0.4 ms"

[transient.probe.disc]
at = [0, 0, "20 mm"]
direction = [1, 0, 0]

[transient.sound]
distance = "0.5 m"
microphone.behind = { at = [-0.3, "0.2 m", "10 cm"] }
"#;

#[test]
fn motion_in_time_is_the_same_in_full_condensed_and_for_any_number_of_threads() {
    let folder = folder_with(&format!("{RIG}{BLOW}"));
    let history = |name: &str, extra: &str, threads: &str| -> Vec<Vec<f64>> {
        let case = format!("{RIG}{}", BLOW.replace("scheme", &format!("{extra}\nscheme")));
        std::fs::write(folder.path().join("rig.toml"), case).expect("a case file");
        let output = stridor(folder.path(), &["transient", "rig.toml", "--out", name, "--threads", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains("Motion in time: 400 steps"), "{}", text(&output.stdout));
        let table = std::fs::read_to_string(folder.path().join(name).join("transient.csv")).expect("a table");
        let row = |line: &str| line.split(',').map(|v| v.parse().expect("a number")).collect();
        table.lines().skip(1).map(row).collect()
    };
    let one = history("one", "", "1");
    assert_eq!(one.len(), 401);
    assert!(one == history("two", "", "2"), "the numbers depend on the number of threads");
    let far = |other: &[Vec<f64>], column: usize| {
        let size = one.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        let off = one.iter().zip(other).map(|(a, b)| (a[column] - b[column]).abs()).fold(0.0, f64::max);
        off / size
    };
    let whole = history("whole", "full_newton = true", "2");
    assert!(
        (1..6).all(|column| within(far(&whole, column), 1e-7, Tolerance)),
        "{:?}",
        [1, 2, 3, 4, 5].map(|c| far(&whole, c))
    );
    // Of the reduced model the motion and the forces follow; modes above its band are not in it.
    let reduced = history("reduced", "model = \"reduced\"", "2");
    assert!(
        within(far(&reduced, 1), 0.02, Discretisation) && within(far(&reduced, 4), 0.02, Discretisation),
        "{:?}",
        [1, 4].map(|c| far(&reduced, c))
    );
    let summary = std::fs::read_to_string(folder.path().join("reduced/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("valid JSON");
    let check = &summary["transient"]["reduced_check"];
    assert_eq!(check["modes"], check["modes_found"]);
    let deviations =
        ["/eigenvalue/relative", "/growth_rate/relative", "/motion/displacement", "/motion/normal_force"];
    let deviations = deviations.map(|at| check.pointer(at).and_then(serde_json::Value::as_f64));
    assert!(deviations.iter().all(|d| d.is_some_and(|d| d < 0.02)), "{check}");
    for file in [
        "transient.svg",
        "transient_spectrum.svg",
        "transient_phase.svg",
        "transient_contact.svg",
        "sound.svg",
        "results.h5",
        "transient_spectrum.csv",
    ] {
        assert!(folder.path().join("one").join(file).is_file(), "{file} is missing");
    }
    for file in ["sound_axis.wav", "sound_spectrum.csv"] {
        let bytes = |name: &str| std::fs::read(folder.path().join(name).join(file)).expect("a file");
        assert!(bytes("one") == bytes("two"), "{file} depends on the number of threads");
    }
}

/// The arrays of the motion in `transient.vtkhdf`, and how many steps it says.
fn fields(out: &Path) -> ([Vec<f32>; 2], i64) {
    let file = hdf5::File::open(out.join("transient.vtkhdf")).expect("fields");
    let array =
        |name: &str| file.dataset(&format!("VTKHDF/PointData/{name}")).and_then(|d| d.read_raw::<f32>());
    let steps = file.group("VTKHDF/Steps").and_then(|g| g.attr("NSteps")?.read_scalar::<i64>());
    (["displacement", "velocity"].map(|name| array(name).expect("an array")), steps.expect("a count"))
}

#[test]
fn fields_in_time_are_those_of_the_probe_in_full_and_reduced_and_resume() {
    let folder = folder_with("");
    let at = folder.path();
    let run = |name: &str, extra: &str, resume: bool| {
        let every = format!("fields_every = \"0.25 ms\"\n{extra}\nscheme");
        std::fs::write(at.join("rig.toml"), format!("{RIG}{}", BLOW.replace("scheme", &every)))
            .expect("a case file");
        let mut arguments = vec!["transient", "rig.toml", "--out", name];
        arguments.extend(resume.then_some("--resume"));
        let output = stridor(at, &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        fields(&at.join(name))
    };
    let (full, steps) = run("full", "", false);
    let (reduced, _) = run("reduced", "model = \"reduced\"", false);
    assert_eq!(steps, 17);
    let largest = |values: &[f32]| values.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    for (a, b) in full.iter().zip(&reduced) {
        assert!(a.len() == b.len() && a.iter().all(|v| v.is_finite()));
        let off = a.iter().zip(b).fold(0.0f32, |m, (a, b)| m.max((a - b).abs()));
        assert!(off < 0.1 * largest(a), "{off:e} of {:e}", largest(a));
    }
    // The probe stands at the node nearest to (0, 0, 20 mm) and looks along x.
    let file = hdf5::File::open(at.join("full/results.h5")).expect("results");
    let nodes = file.dataset("geometry/nodes").and_then(|d| d.read_2d::<f64>()).expect("nodes");
    let away =
        |row: usize| nodes[(row, 0)].powi(2) + nodes[(row, 1)].powi(2) + (nodes[(row, 2)] - 0.02).powi(2);
    let probe = (0..nodes.nrows()).min_by(|a, b| away(*a).total_cmp(&away(*b))).expect("a node");
    for (array, name) in full.iter().zip(["disc_displacement", "disc_velocity"]) {
        let record = file
            .dataset(&format!("transient/history/{name}"))
            .and_then(|d| d.read_1d::<f64>())
            .expect("a record");
        let agree = |k: &usize| array[3 * (k * nodes.nrows() + probe)] == record[25 * k] as f32;
        assert!((0..17).all(|k| agree(&k)), "{name}");
    }
    drop(file);
    // The file of an earlier run is not read: that of a resumed run is rewritten.
    let file = hdf5::File::open_rw(at.join("full/transient.vtkhdf")).expect("fields");
    let velocity = file.dataset("VTKHDF/PointData/velocity").expect("an array");
    velocity.write_raw(&vec![1.0_f32; velocity.size()]).expect("it is written");
    drop((velocity, file));
    std::fs::copy(at.join("full/transient.csv"), at.join("before.csv")).expect("a table");
    let (again, steps) = run("full", "", true);
    assert!(steps == 17 && again == full);
    let [before, after] =
        ["before.csv", "full/transient.csv"].map(|name| std::fs::read(at.join(name)).expect("a table"));
    assert!(before == after && before.len() > 10_000);
}

#[test]
fn faults_of_a_transient_come_together() {
    let wrong = BLOW
        .replace("duration = \"4 ms\"", "duration = \"1 us\"")
        .replace("at = [0, 0, \"20 mm\"]", "at = [0, 0, 0]\non = \"disc\"")
        .replace("scheme =", "fields_every = \"1 s\"\nscheme =")
        + "[transient.slide.rip]\nmotion = \"ramp\"\nduration = \"1 ms\"\n";
    let folder = folder_with(&format!("{RIG}{wrong}"));
    refused(
        &folder,
        2,
        &[
            "4 faults",
            "time_step",
            "fields_every",
            "several of `on`, `at` and `spring`",
            "Did you mean \"rim\"?",
        ],
    );
    let lost = folder_with(&format!("{RIG}{}", BLOW.replace("\"bar_root\"", "\"bar_rot\"")));
    refused(&lost, 2, &["transient.push.blow.on", "bar_root"]);
    let deaf = BLOW.replace("distance = \"0.5 m\"", "plates = [\"dics\"]");
    refused(&folder_with(&format!("{RIG}{deaf}")), 2, &["transient.sound.plates", "Did you mean \"disc\"?"]);
    let near = BLOW.replace("[-0.3, \"0.2 m\", \"10 cm\"]", "[0, 0, \"5 cm\"]");
    refused(&folder_with(&format!("{RIG}{near}")), 2, &["transient.sound.microphone.behind.at", "on `disc`"]);
}

#[test]
fn check_lists_every_scalar_and_new_makes_a_valid_case() {
    let folder = TempDir::new().expect("a temporary folder");
    assert_eq!(stridor(folder.path(), &["new", "mine"]).status.code(), Some(0));
    let output = stridor(folder.path(), &["check", "mine/case.toml", "--parameters"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("contact.rim.friction.mu0"));
    let again = stridor(folder.path(), &["new", "mine"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("already"));
}

#[test]
fn every_template_is_valid_and_runs() {
    let folder = TempDir::new().expect("a temporary folder");
    let ran = [
        ("rig", "report.html"),
        ("pad", "growth.svg"),
        ("solid", "complex_modes.csv"),
        ("brake", "complex_modes.csv"),
        ("two-dof", "complex_modes.csv"),
        ("imported", "sensitivity.svg"),
        ("transient", "transient.csv"),
        ("measured", "mac_shapes.svg"),
    ];
    for (template, result) in ran {
        assert_eq!(stridor(folder.path(), &["new", template, "--template", template]).status.code(), Some(0));
        let case = format!("{template}/case.toml");
        let checked = stridor(folder.path(), &["check", &case]);
        assert_eq!(checked.status.code(), Some(0), "{template}: {}", text(&checked.stderr));
        let output = stridor(folder.path(), &["run", &case, "--out", &format!("{template}/results")]);
        assert_eq!(output.status.code(), Some(0), "{template}: {}", text(&output.stderr));
        assert!(folder.path().join(template).join("results").join(result).is_file(), "{template}");
    }
}

#[test]
fn wrong_case_files_are_refused_with_what_to_do() {
    let folder = TempDir::new().expect("a temporary folder");
    refused(&folder, 2, &["rig.toml", "no file there", "stridor new"]);
    for (from, to, words) in [
        ("thickness = \"1 mm\"", "thicknes = \"1 mm\"", &["rig.toml:", "Did you mean `thickness`?"][..]),
        ("thickness = \"1 mm\"", "thickness = true", &["found true", "a length"]),
        ("thickness = \"1 mm\"", "thickness = \"-1 mm\"", &["-0.001", "above zero"]),
        ("poissons_ratio = 0.3", "poissons_ratio = 0.5", &["below 0.5"]),
        ("[support.clamp]", "[support.clamp", &["rig.toml:"]),
        ("sliding_velocity = \"0.5 m/s\"", "sliding_velocity = true", &["sliding_velocity", "found true"]),
        ("body = \"rim\"", "body = \"rimm\"", &["rimm", "Did you mean \"rim\"?", "bar_root"]),
        ("body = \"rim\"", "body = \"slider_edge_x_min\"", &["contact.rim", "two separate bodies"]),
        ("counter = \"slider\"", "counter = \"disk\"", &["disk"]),
        ("lead_angle = \"4 deg\"", "position = [\"150 mm\", 0]", &["position", "0.15"]),
        ("load = \"20 N\"", "load = \"20 N\"\nstroke = \"500 mm\"", &["stroke"]),
        ("placement = { lead_angle = \"4 deg\" }", "reach = \"1 nm\"\napproach = 0", &["approach"]),
    ] {
        assert!(RIG.contains(from), "{from}");
        refused(&folder_with(&RIG.replacen(from, to, 1)), 2, words);
    }
}

#[test]
fn wrong_meshes_are_refused_with_what_to_do() {
    let sound = {
        let folder = TempDir::new().expect("a temporary folder");
        let sizes = ["--contact-size", "2 mm", "--disc-size", "12 mm", "--slider-size", "20 mm"];
        let mut arguments = vec!["mesh", "rig", "--out", "rig.msh"];
        arguments.extend(sizes);
        let output = stridor(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        std::fs::read_to_string(folder.path().join("rig.msh")).expect("a mesh")
    };
    let start = RIG.find("[mesh.rig]").expect("a mesh");
    let end = RIG.find("[material.steel]").expect("a material");
    let case = format!("{}[mesh]\nfile = \"rig.msh\"\nunit = \"mm\"\n\n{}", &RIG[..start], &RIG[end..]);
    let with_mesh = |mesh: Option<&[u8]>| {
        let folder = folder_with(&case);
        if let Some(mesh) = mesh {
            std::fs::write(folder.path().join("rig.msh"), mesh).expect("a mesh");
        }
        folder
    };
    assert_eq!(
        stridor(with_mesh(Some(sound.as_bytes())).path(), &["check", "rig.toml"]).status.code(),
        Some(0)
    );
    refused(&with_mesh(None), 2, &["rig.msh"]);
    refused(&with_mesh(Some(b"")), 2, &["rig.msh", "empty"]);
    refused(&with_mesh(Some(b"\x00\xff garbage \x17")), 2, &["rig.msh"]);
    refused(&with_mesh(Some(&sound.as_bytes()[..sound.len() / 2])), 2, &["rig.msh"]);
    let from = sound.find("$PhysicalNames").expect("names");
    let to = sound.find("$EndPhysicalNames").expect("names") + "$EndPhysicalNames\n".len();
    let nameless = format!("{}{}", &sound[..from], &sound[to..]);
    refused(&with_mesh(Some(nameless.as_bytes())), 2, &["rig.msh", "name"]);
    let renamed = sound.replace("\"hub\"", "\"hup\"");
    refused(&with_mesh(Some(renamed.as_bytes())), 2, &["hub", "Did you mean \"hup\"?"]);
}

#[test]
fn a_rig_that_nothing_holds_is_explained() {
    let free = RIG.replace("[support.clamp]\non = \"bar_clamp\"\n", "");
    refused(&folder_with(&free), 2, &["contact.rim.load", "nothing holds along", "a support, spring"]);
    // Free across the load only.
    let hinged = RIG.replace("on = \"bar_clamp\"\n", "on = \"bar_clamp\"\nheld = [\"ux\", \"uz\"]\n");
    refused(&folder_with(&hinged), 2, &["shell.disc", "free in 2 rigid-body motions", "[support]"]);
}

#[test]
fn a_results_folder_that_cannot_be_written_is_one_clear_sentence() {
    let folder = folder_with(RIG);
    std::fs::write(folder.path().join("out"), "a file in the folder's place").expect("a file");
    let output = stridor(folder.path(), &["run", "rig.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("out"), "{}", text(&output.stderr));
    let kept = std::fs::read_to_string(folder.path().join("out")).expect("still there");
    assert_eq!(kept, "a file in the folder's place");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let output = Command::new(env!("CARGO_BIN_EXE_stridor"))
        .args(["check", "--parameters"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/rig/case.toml"))
        .stdout(writer)
        .stderr(std::process::Stdio::piped())
        .output()
        .expect("the program starts");
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), ""));
}

#[test]
fn a_calibrated_case_is_a_case() {
    let case = include_str!("../../validation/calibrate-disc/case.toml")
        .replace("radial = 48", "radial = 5")
        .replace("around = 144", "around = 24")
        .replace("2600]", "2700]")
        .replace("trials = 100", "trials = 5\nchance_draws = 50");
    let folder = folder_with(&case);
    let output = stridor(folder.path(), &["calibrate", "rig.toml", "--out", "found"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(printed.contains("Numbers found") && printed.contains("by chance"), "{printed}");
    for file in ["calibration.csv", "calibration_errors.svg", "calibration_numbers.svg", "report.html"] {
        assert!(folder.path().join("found").join(file).is_file(), "{file}");
    }
    let output = stridor(folder.path(), &["check", "found/calibrated.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));

    let faulty = case.replace("\"15 mm\", \"25 mm\"", "\"21 mm\", \"25 mm\"");
    std::fs::write(folder.path().join("faulty.toml"), faulty).expect("a file");
    let output = stridor(folder.path(), &["calibrate", "faulty.toml", "--out", "nothing"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("own value 0.02") && !folder.path().join("nothing").exists());
}

#[test]
fn a_search_leaves_a_case_and_a_page() {
    let case = include_str!("../../validation/hoffmann/case.toml");
    let folder = folder_with(case);
    let search = "title = \"t\"\nsource = \"s\"\ncase = \"rig.toml\"\nevaluations = 60\n\
                  [parameter.friction]\npath = \"contact.belt.friction.mu0\"\nbetween = [0, 1]\n\
                  [fact.growth]\nkind = \"growth_rate\"\nreference = 0.5\nabsolute_tolerance = 1e-3\n";
    std::fs::write(folder.path().join("search.toml"), search).expect("a file");
    let output = stridor(folder.path(), &["search", "search.toml", "--out", "found"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(printed.contains("1 of 1 facts are met") && printed.contains("proves nothing"), "{printed}");
    for file in ["search.csv", "search.json", "search.html", "search_cost.svg", "search_weights.svg"] {
        assert!(folder.path().join("found").join(file).is_file(), "{file}");
    }
    let output = stridor(folder.path(), &["check", "found/found.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));

    let faulty = search.replace("[0, 1]", "[0.5, 1]").replace("growth_rate", "growth_ratio");
    std::fs::write(folder.path().join("faulty.toml"), faulty).expect("a file");
    let output = stridor(folder.path(), &["search", "faulty.toml", "--out", "nothing"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("growth_ratio") && !folder.path().join("nothing").exists());
}

#[test]
fn an_engine_of_the_other_program_is_a_fault() {
    let folder = folder_with(RIG);
    for (analysis, engine) in
        [("modes", "slepc"), ("cea", "slepc-krylov-schur"), ("sweep", "mpi"), ("uncertainty", "mpi")]
    {
        let output = stridor(folder.path(), &[analysis, "rig.toml", "--engine", engine]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        let option = format!("--engine {engine}:");
        for word in [&option, "without MPI", "-p stridor-mpi", "--path crates/mpi", ".ci/setup --mpi"] {
            assert!(message.contains(word), "\"{word}\" is not in: {message}");
        }
        assert!(!folder.path().join("results").exists());
    }
}

#[test]
fn a_wrong_deck_is_refused_with_all_its_faults_and_nothing_is_written() {
    let chapter =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src/abaqus.md")).unwrap();
    let deck =
        chapter.split("```inp,file=rub.inp\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let import = |deck: &str, more: &[&str]| {
        std::fs::write(folder.path().join("rub.inp"), deck).unwrap();
        let output = stridor(folder.path(), &[&["import", "rub.inp", "--out", "rub"], more].concat());
        (
            output.status.code(),
            text(&output.stdout) + &text(&output.stderr),
            folder.path().join("rub").exists(),
        )
    };
    let wrong = deck
        .replace("1, 2, 3, 4, 5, 6, 7, 8\n*Solid", "1, 2, 3, 4, 5, 6, 7, 9\n*Solid")
        .replace("Guided, 1, 2", "Guided, x, 2");
    let (code, said, written) = import(&wrong, &["--unit", "mm"]);
    assert!(code == Some(2) && !written, "{said}");
    for word in ["2 faults", "on node 9", "`x, 2`", "rub.inp:"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let (code, said, written) = import(deck, &["--unit", "furlong"]);
    assert!(code == Some(2) && said.contains("mm, t, s (N, MPa)") && !written, "{said}");
    let (code, said, written) = import(deck, &["--unit", "mm", "--json"]);
    let summary: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert!(code == Some(0) && written && summary["valid"] == true && summary["nodes"] == 16, "{said}");
    let (code, said, _) = import(deck, &["--unit", "mm"]);
    assert!(code == Some(2) && said.contains("something there already"), "{said}");
}
