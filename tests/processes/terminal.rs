//! What the program says on a terminal, in a file and as JSON, and what `check` warns of.

use crate::small_rig::{RIG, folder_with, stridor, text};
use std::path::Path;
use std::process::{Command, Output};
use stridor::bounds::{Origin::*, within};
use tempfile::TempDir;

/// What `check` prints of the small rig with one line of it replaced.
fn checked(from: &str, to: &str) -> Output {
    assert!(RIG.contains(from), "{from}");
    let folder = folder_with(&RIG.replacen(from, to, 1));
    stridor(folder.path(), &["check", "rig.toml"])
}

#[test]
fn check_warns_of_implausible_numbers() {
    let valid = checked("title", "title");
    let said = text(&valid.stdout);
    assert!(said.contains("rig.toml: valid. ") && said.contains("contact points within reach"), "{said}");
    for (from, to, words) in [
        ("\"210 GPa\"", "210", &["material.steel.youngs_modulus", "Found 210 Pa", "\"210 GPa\""][..]),
        ("density = 7850", "density = 7.85", &["material.steel.density", "\"7.85 g/cm^3\""]),
        ("poissons_ratio = 0.3", "poissons_ratio = -0.3", &["poissons_ratio", "auxetic"]),
        ("thickness = \"10 mm\"", "thickness = 1", &["shell.slider.thickness", "times the size", "0.0465 m"]),
        ("\"1.5 kHz\"", "\"6 kHz\"", &["shell.slider.theory", "3.1 %", "theory = \"mindlin\""]),
        ("\"1.5 kHz\"", "\"6 kHz\"", &["`shell.disc`", "4.1 to a bending wave of 40 mm", "Refine"]),
    ] {
        let output = checked(from, to);
        let said = text(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        for word in words {
            assert!(
                said.contains("warning: Found ") && said.contains(", at rig.toml:") && said.contains(word),
                "{word} is not in {said}"
            );
        }
    }
}

#[test]
fn check_refuses_contacts_that_cannot_carry_load() {
    let apart = checked("load = \"20 N\"", "approach = \"-1 mm\"");
    let message = text(&apart.stderr);
    assert_eq!(apart.status.code(), Some(2), "{message}");
    assert!(message.contains("contact.rim.approach") && message.contains("0.00100 m away"), "{message}");
    let nothing = checked("load = \"20 N\"\n", "");
    assert!(text(&nothing.stderr).contains("no point touches"), "{}", text(&nothing.stderr));

    // A pad that only the contact holds across: a force presses it, from wherever it stands.
    let pad = std::fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/pad-on-disc/case.toml"),
    )
    .expect("a case");
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    let pad = pad.replace("../../meshes", &meshes.display().to_string());
    let run = |pressing: &str| {
        let folder = folder_with(&pad.replace("approach = 0\n", pressing));
        stridor(folder.path(), &["cea", "rig.toml", "--out", "out", "--json"])
    };
    let loads = ["", "approach = \"-0.2 mm\"\n"].map(|pressing| {
        let output = run(pressing);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        summary["steady_sliding"]["pairs"][0]["normal_force_n"].as_f64().expect("a force")
    });
    assert!(loads.iter().all(|load| within((load / 50.0 - 1.0).abs(), 1e-9, Tolerance)), "{loads:?}");
    let refused = run("load = \"50 N\"\n");
    assert_eq!(refused.status.code(), Some(2));
    let message = text(&refused.stderr);
    assert!(message.contains("nothing holds along [-1, 0, 0]"), "{message}");
    assert!(message.contains("`force = [-50, 0, 0]`"), "{message}");
}

/// A pad on springs along any of three directions, strong and weak, or on none: the contact holds it across and against tilting, the
/// two directions of its plane and the turn in it must be held by springs on all its nodes. What `check` calls valid is run.
#[test]
fn what_check_calls_valid_has_a_steady_state() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pad = std::fs::read_to_string(root.join("validation/pad-on-disc/case.toml")).expect("a case");
    let pad = pad.replace("../../meshes", &root.join("meshes").display().to_string());
    let begin = pad.find("[spring.along]").expect("springs");
    let end = begin + pad[begin..].find("[force.").expect("a force");
    for stiffness in ["20 MN/m", "1 N/m", "1e-6 N/m"] {
        for subset in 0..8 {
            let along = (0..3).filter(|c| subset >> c & 1 == 1);
            let spring = |c: usize| {
                let direction = [0, 1, 2].map(|k| u8::from(k == c));
                format!(
                    "[spring.s{c}]\non = \"pad\"\ndirection = {direction:?}\nstiffness = \"{stiffness}\"\n"
                )
            };
            let springs: String = along.map(spring).collect();
            let folder = folder_with(&format!("{}{springs}{}", &pad[..begin], &pad[end..]));
            let check = stridor(folder.path(), &["check", "rig.toml"]);
            let message = text(&check.stderr);
            let valid = check.status.code() == Some(0);
            match stiffness {
                "20 MN/m" => assert_eq!(valid, subset & 6 == 6, "{subset}: {message}"),
                // So weak that rounding may hide it.
                _ => assert!(!valid || subset & 6 == 6, "{subset}: {message}"),
            }
            if valid {
                let run = stridor(folder.path(), &["cea", "rig.toml", "--out", "out"]);
                assert_eq!(run.status.code(), Some(0), "{stiffness}, {subset}: {}", text(&run.stderr));
                assert!(text(&run.stdout).contains("between 3 and 3000 Hz"), "{}", text(&run.stdout));
                assert!(text(&run.stdout).contains("loss factors"), "{}", text(&run.stdout));
            } else {
                assert!(
                    message.contains("`shell.pad`") && message.contains("rigid-body motion"),
                    "{message}"
                );
            }
        }
    }
}

#[test]
fn json_is_one_document_also_of_a_refusal() {
    let json = |arguments: &[&str], case: &str| -> (Option<i32>, serde_json::Value) {
        let folder = folder_with(case);
        let output = stridor(folder.path(), arguments);
        (output.status.code(), serde_json::from_slice(&output.stdout).expect("JSON on stdout"))
    };
    let (code, valid) =
        json(&["check", "rig.toml", "--json"], &RIG.replace("density = 7850", "density = 7.85"));
    assert_eq!(
        (code, &valid["ok"], valid["faults"].as_array().map(Vec::len)),
        (Some(0), &true.into(), Some(0))
    );
    assert_eq!(valid["warnings"][0]["key"], "material.steel.density");
    assert_eq!(valid["warnings"][0]["found"], "7.85 kg/m^3");
    assert!(valid["sizes"]["contact_points"].as_u64().is_some_and(|points| points > 0));
    let wrong = RIG.replace("thickness = \"1 mm\"", "thickness = true");
    for arguments in [&["check", "rig.toml", "--json"][..], &["run", "rig.toml", "--json"]] {
        let (code, refused) = json(arguments, &wrong);
        assert_eq!((code, &refused["ok"], &refused["kind"]), (Some(2), &false.into(), &"input".into()));
        let fault = &refused["faults"][0];
        let line = 1 + wrong.lines().position(|line| line == "thickness = true").expect("a line");
        assert_eq!((&fault["file"], fault["line"].as_u64()), (&"rig.toml".into(), Some(line as u64)));
        assert_eq!((&fault["key"], &fault["found"]), (&"shell.disc.thickness".into(), &"true".into()));
    }
    let (code, usage) = json(&["check", "--json"], RIG);
    assert_eq!((code, &usage["kind"]), (Some(2), &"usage".into()));
    let (code, failed) = json(&["new", "rig.toml", "--json"], RIG);
    assert_eq!((code, &failed["faults"][0]["place"]), (Some(2), &"rig.toml".into()));
}

#[test]
fn tables_fit_the_window_and_are_whole_in_a_file() {
    let folder = folder_with(RIG);
    let printed = |columns: Option<&str>, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stridor"));
        command.args(["cea", "rig.toml"]).args(more).current_dir(folder.path()).env_remove("NO_COLOR");
        match columns {
            Some(columns) => command.env("COLUMNS", columns),
            None => command.env_remove("COLUMNS"),
        };
        text(&command.output().expect("the program starts").stdout)
    };
    let whole = printed(None, &[]);
    assert!(!whole.contains('…') && !whole.contains('\u{1b}'), "{whole}");
    assert!(whole.contains("Results are in results/rig:"), "{whole}");
    // Of a closed table, which the page opens on request, a window has the first rows and columns.
    let (before, closed) = whole.split_once("Shares of the parts in the complex modes").expect("its caption");
    let (_, after) = closed.split_once("Shares of the parts in kinetic").expect("its note");
    let words: Vec<&str> = before.split_whitespace().chain(after.split_whitespace()).collect();
    for columns in [60, 80, 120] {
        let fitted = printed(Some(&columns.to_string()), &[]);
        let tables = fitted.lines().filter(|line| !line.starts_with("Results are in"));
        assert!(tables.clone().all(|line| line.chars().count() <= columns), "{fitted}");
        let missing: Vec<&str> =
            words.iter().copied().filter(|w| !w.starts_with('─') && !fitted.contains(w)).collect();
        assert!(missing.is_empty(), "{missing:?} are not in {fitted}");
    }
    let coloured = printed(None, &["--color", "always"]);
    assert!(
        coloured.contains("\u{1b}[1;31m*") && coloured.contains("\u{1b}[1mUnstable modes\u{1b}[0m"),
        "{coloured}"
    );
}

#[test]
fn the_program_documents_itself() {
    let folder = TempDir::new().expect("a temporary folder");
    let printed = |arguments: &[&str]| {
        let output = stridor(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    let version = printed(&["--version"]);
    let commit = stridor::COMMIT.map_or(String::new(), |commit| format!(" ({commit})"));
    assert_eq!(version.trim(), format!("stridor {}{commit}", env!("CARGO_PKG_VERSION")));
    for (shell, word) in
        [("bash", "complete -F"), ("zsh", "#compdef stridor"), ("fish", "complete -c stridor")]
    {
        let script = printed(&["completions", shell]);
        assert!(script.contains(word) && script.contains("calibrate"), "{shell}");
    }
    assert!(printed(&["man"]).contains(".TH stridor 1"));
    assert!(printed(&["man", "run"]).contains("Examples:"));
    printed(&["man", "--out", "man1"]);
    for page in ["stridor.1", "stridor-run.1", "stridor-mesh-disc.1"] {
        assert!(folder.path().join("man1").join(page).is_file(), "{page}");
    }
    assert!(printed(&["check", "--help"]).contains("stridor check rig/case.toml --parameters"));
    let unknown = stridor(folder.path(), &["man", "rum"]);
    assert!(text(&unknown.stderr).contains("Did you mean `run`?"), "{}", text(&unknown.stderr));
}

#[test]
fn results_carry_the_name_of_the_folder_of_the_case() {
    let folder = TempDir::new().expect("a temporary folder");
    let own = folder.path().join("brake");
    std::fs::create_dir(&own).expect("a folder");
    for file in ["case.toml", "softer.toml"] {
        std::fs::write(own.join(file), RIG).expect("a case");
    }
    for (at, case, name) in [
        (folder.path(), "brake/case.toml", "results/brake"),
        (&own, "case.toml", "results/brake"),
        (&own, "softer.toml", "results/softer"),
    ] {
        let output = stridor(at, &["modes", case, "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(at.join(name).join("summary.json").is_file(), "{case} in {}", at.display());
    }
}

#[test]
fn the_transient_of_the_guide_runs_on_the_shipped_case() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let guide = std::fs::read_to_string(root.join("guide/src/motion-and-sound.md")).expect("a chapter");
    let mut blocks = guide.split("```toml,file=keys.toml\n").skip(1);
    let block = blocks.next().and_then(|rest| rest.split("```").next()).expect("a TOML block");
    let begin = block.find("[transient]").expect("a transient");
    let end = begin + block[begin..].find("\n[transient.sound]").expect("its end");
    let transient = block[begin..end].replace("\"0.3 s\"", "\"8 ms\"").replace("\"0.1 s\"", "\"4 ms\"");
    // The slider turns round at 5 and 10 ms: the first of these is inside.
    let transient = transient.replace("\"5 Hz\"", "\"50 Hz\"");
    let case = std::fs::read_to_string(root.join("validation/rig/case.toml")).expect("a case");
    let meshes = root.join("meshes").display().to_string();
    let folder = folder_with(&(case.replace("../../meshes", &meshes) + "\n" + &transient));
    let output = stridor(folder.path(), &["transient", "rig.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("Motion in time: 800 steps"), "{}", text(&output.stdout));
}
