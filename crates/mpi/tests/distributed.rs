//! Analyses over the ranks of an MPI program: the results of one process, faults in words, ranks that die.

#[path = "../../../tests/common/program.rs"]
mod program;
#[path = "../../../tests/common/solid.rs"]
mod solid;
#[path = "../../../tests/common/sweeps.rs"]
mod sweeps;

use program::PROGRAM;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use stridor::bounds::{Origin::*, within};
use tempfile::TempDir;

/// Engines that share out the matrices; they find real modes by different methods.
const ENGINES: [&str; 2] = ["slepc", "slepc-krylov-schur"];

/// The program on some ranks.
fn on_ranks(ranks: usize, folder: &Path, arguments: &[&str]) -> Command {
    ranks_of(PROGRAM, ranks, folder, arguments)
}

/// Some ranks of any program.
fn ranks_of(program: &str, ranks: usize, folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "--allow-run-as-root", "-n", &ranks.to_string()]);
    command.arg(program).args(arguments);
    // MUMPS calls BLAS on every rank.
    command.current_dir(folder).env("OMP_NUM_THREADS", "1").env("RUST_BACKTRACE", "0");
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// That it ended well; its summary.
fn summary(output: Output, out: &Path) -> Value {
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}

fn eigenvalues(summary: &Value) -> Vec<[f64; 2]> {
    let modes = summary["cea"]["eigenvalues"].as_array().unwrap();
    let number = |mode: &Value, key: &str| mode[key].as_f64().unwrap();
    modes.iter().map(|mode| [number(mode, "growth_rate"), TAU * number(mode, "frequency_hz")]).collect()
}

/// One process and 1, 2 and 4 ranks of `case.toml` in a folder: the same complex modes to 1e-8, and the same count of the
/// unstable ones.
fn same_on_all_ranks(folder: &Path) -> Value {
    let (out, one) = (folder.join("one"), ["cea", "case.toml", "--out", "one", "--quiet"]);
    let alone = summary(program::command(folder, &one).output().unwrap(), &out);
    let expected = eigenvalues(&alone);
    assert!(!expected.is_empty());
    for ranks in [1, 2, 4] {
        let name = format!("ranks-{ranks}");
        let arguments = ["cea", "case.toml", "--out", &name, "--quiet", "--engine", "slepc"];
        let found = summary(on_ranks(ranks, folder, &arguments).output().unwrap(), &folder.join(&name));
        assert_eq!(found["provenance"]["engine"], "slepc");
        assert_eq!(found["provenance"]["ranks"], ranks);
        let values = eigenvalues(&found);
        assert_eq!(values.len(), expected.len(), "{ranks} ranks");
        for (found, expected) in values.iter().zip(&expected) {
            let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(
                within(apart, 1e-8 * expected[0].hypot(expected[1]), Tolerance),
                "{ranks} ranks: {found:?}, {expected:?}"
            );
        }
        let certificate = |summary: &Value, key: &str| summary["cea"]["certificate"][key].clone();
        for key in ["unstable_counted", "unstable_found"] {
            assert_eq!(certificate(&found, key), certificate(&alone, key), "{ranks} ranks");
        }
        let errors =
            found["cea"]["eigenvalues"].as_array().unwrap().iter().map(|mode| &mode["backward_error"]);
        assert!(errors.flat_map(Value::as_f64).all(|error| within(error, 1e-10, Tolerance)), "{ranks} ranks");
        let second = &found["cea"]["second_method"];
        for other in ["unconfirmed_hz", "missed_hz"] {
            assert_eq!(second[other].as_array().map(Vec::len), Some(0), "{ranks} ranks: {second}");
        }
        assert!(second["confirmed"].as_u64().is_some_and(|count| count > 0), "{ranks} ranks: {second}");
    }
    alone
}

#[test]
fn rig_with_modal_damping() {
    let folder = tempfile::tempdir().unwrap();
    let new = program::command(folder.path(), &["new", "rig"]).output().unwrap();
    assert!(new.status.success(), "{}", text(&new.stderr));
    let rig = folder.path().join("rig");
    let case = std::fs::read_to_string(rig.join("case.toml")).unwrap();
    assert!(case.contains("modal_ratio") && case.contains("[cea]\n"));
    std::fs::write(rig.join("case.toml"), case.replace("[cea]\n", "[cea]\nconfirm = true\n")).unwrap();
    let alone = same_on_all_ranks(&rig);
    assert!(alone["cea"]["certificate"]["unstable_counted"].as_u64().unwrap() > 0);
}

#[test]
fn solid_as_matrices() {
    let folder = tempfile::tempdir().unwrap();
    solid::write(folder.path());
    let alone = same_on_all_ranks(folder.path());
    assert!(alone["cea"]["eigenvalues"].as_array().unwrap().len() > 5);
}

#[test]
fn real_modes_with_their_count() {
    let folder = tempfile::tempdir().unwrap();
    solid::write(folder.path());
    let run = |command: &mut Command, out: &str| {
        summary(command.output().unwrap(), &folder.path().join(out))["modes"].clone()
    };
    let arguments = |out, engine| ["modes", "case.toml", "--out", out, "--quiet", "--engine", engine];
    // A band and a number.
    let case = format!("{}\n[modes.lowest]\ncount = 12\n", solid::CASE);
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    let alone = run(&mut program::command(folder.path(), &arguments("one", "")[..5]), "one");
    let frequencies = |modes: &Value| -> Vec<f64> {
        modes.as_array().unwrap().iter().map(|mode| mode["frequency_hz"].as_f64().unwrap()).collect()
    };
    let expected = frequencies(&alone);
    assert!(expected.len() > 10);
    for (ranks, engine) in [1, 2, 4].into_iter().flat_map(|ranks| ENGINES.map(|engine| (ranks, engine))) {
        let found = run(&mut on_ranks(ranks, folder.path(), &arguments("several", engine)), "several");
        let found = frequencies(&found);
        assert_eq!(found.len(), expected.len());
        assert!(
            found.iter().zip(&expected).all(|(a, b)| within((a - b).abs(), 1e-8 * b, Tolerance)),
            "{ranks} ranks, {engine}"
        );
    }
}

#[test]
fn the_program_has_a_name_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let printed = |arguments: &[&str]| {
        let output = program::command(folder.path(), arguments).output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    assert_eq!(printed(&["--version"]).trim(), format!("stridor-mpi {}", *stridor::cli::VERSION));
    for (shell, words) in
        [("bash", " stridor-mpi\n"), ("zsh", "#compdef stridor-mpi"), ("fish", "complete -c stridor-mpi")]
    {
        let script = printed(&["completions", shell]);
        assert!(script.contains(words) && script.contains("calibrate"), "{shell}: {words}");
    }
    assert!(printed(&["man", "cea"]).contains("stridor\\-mpi cea rig/case.toml"));
    assert!(printed(&["man", "--out", "man"]).contains("man/stridor-mpi.1"));
    assert!(folder.path().join("man/stridor-mpi-cea.1").exists());
    let help = printed(&["cea", "--help"]);
    assert!(help.contains("Usage: stridor-mpi cea ") && !help.contains("  stridor "), "{help}");
}

#[test]
fn wrong_use_is_a_fault() {
    let folder = program::folder_with(program::CASE);
    // Each: ranks, arguments, words of the message.
    let faults: [(usize, &[&str], &[&str]); 5] = [
        (2, &["run", "case.toml", "--engine", "slepc"], &["--engine slepc", "`stridor cea`"]),
        (2, &["cea", "case.toml", "--engine", "mpi"], &["--engine mpi", "`stridor sweep`"]),
        (2, &["sweep", "missing.toml", "--engine", "mpi"], &["missing.toml"]),
        (2, &["cea", "missing.toml", "--engine", "slepc"], &["missing.toml"]),
        (2, &["cea", "case.toml", "--engine", "petsc"], &["petsc", "slepc"]),
    ];
    for (ranks, arguments, words) in faults {
        let output = on_ranks(ranks, folder.path(), arguments).output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert!(!folder.path().join("results").exists(), "nothing is written");
    }
}

#[test]
fn more_ranks_than_rows_are_a_fault() {
    let folder = tempfile::tempdir().unwrap();
    let new = program::command(folder.path(), &["new", "two", "--template", "two-dof"]).output().unwrap();
    assert!(new.status.success(), "{}", text(&new.stderr));
    let arguments = ["cea", "two/case.toml", "--out", "out", "--engine", "slepc"];
    let output = on_ranks(4, folder.path(), &arguments).output().unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("4 ranks") && message.contains("at most 2"), "{message}");
    assert!(!folder.path().join("out").exists(), "nothing is written");
    let output = on_ranks(2, folder.path(), &arguments).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    // However long rank 0 takes to write its message, the end of the others does not end it.
    let late = r#""$@"; code=$?; [ "$OMPI_COMM_WORLD_RANK" != 0 ] || { sleep 1; touch late; }; exit $code"#;
    let program = [&["-c", late, "sh", PROGRAM], &arguments[..]].concat();
    let output = ranks_of("sh", 4, folder.path(), &program).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(folder.path().join("late").exists(), "rank 0 was ended by another rank");
}

/// A rank that is killed ends the program with an error, and a later run has the whole result.
#[test]
fn a_killed_rank_leaves_no_half_result() {
    let folder: TempDir = tempfile::tempdir().unwrap();
    let new = program::command(folder.path(), &["new", "rig"]).output().unwrap();
    assert!(new.status.success());
    let arguments = ["cea", "rig/case.toml", "--out", "out", "--quiet", "--engine", "slepc"];
    let started = Instant::now();
    let child = on_ranks(2, folder.path(), &arguments).stderr(Stdio::piped()).spawn().unwrap();
    let victim = loop {
        let ranks = ranks_in(folder.path());
        // The results folder is taken when the input is found right: now they compute.
        if ranks.len() == 2 && folder.path().join("out").exists() {
            break ranks[1];
        }
        assert!(started.elapsed() < Duration::from_secs(60), "two ranks start");
        std::thread::sleep(Duration::from_millis(20));
    };
    let killed = Command::new("kill").args(["-9", &victim.to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    assert!(!output.status.success());
    assert!(text(&output.stderr).contains("signal 9"), "{}", text(&output.stderr));
    assert!(!folder.path().join("out/summary.json").exists());
    let again = on_ranks(2, folder.path(), &arguments).output().unwrap();
    let whole = summary(again, &folder.path().join("out"));
    assert!(!eigenvalues(&whole).is_empty());
}

/// The processes of the program that work in a folder, ascending.
fn ranks_in(folder: &Path) -> Vec<u32> {
    let folder = folder.canonicalize().unwrap();
    let program = Path::new(PROGRAM).canonicalize().unwrap();
    let mut found: Vec<u32> = std::fs::read_dir("/proc")
        .unwrap()
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .filter(|pid: &u32| {
            let of = |link: &str| std::fs::read_link(format!("/proc/{pid}/{link}"));
            of("cwd").is_ok_and(|cwd| cwd == folder) && of("exe").is_ok_and(|exe| exe == program)
        })
        .collect();
    found.sort_unstable();
    found
}

#[test]
fn studies_over_ranks_are_those_of_one_process() {
    let folder = program::folder_with(&sweeps::disc());
    let at = folder.path();
    for analysis in ["sweep", "uncertainty"] {
        let one = format!("one-{analysis}");
        let alone =
            program::command(at, &[analysis, "case.toml", "--quiet", "--out", &one]).output().unwrap();
        assert!(alone.status.success(), "{}", text(&alone.stderr));
        let whole = sweeps::found(&at.join(one));
        for ranks in [1, 2, 3] {
            let out = format!("{analysis}-{ranks}");
            let arguments =
                [analysis, "case.toml", "--quiet", "--out", &out, "--threads", "1", "--engine", "mpi"];
            let provenance =
                &summary(on_ranks(ranks, at, &arguments).output().unwrap(), &at.join(&out))["provenance"];
            assert_eq!((&provenance["engine"], &provenance["ranks"]), (&"mpi".into(), &ranks.into()));
            assert!(sweeps::found(&at.join(&out)) == whole, "{analysis}: {ranks} ranks have another result");
            assert!(!at.join(&out).join("parts").join(analysis).join("ranks.txt").exists());
        }
    }
}

/// What the ranks had finished is there after one is killed; the next run, of another number of ranks, names what was lost.
#[test]
fn studies_resume_after_a_rank_was_killed() {
    let folder = program::folder_with(&sweeps::disc());
    let at = folder.path();
    for analysis in ["sweep", "uncertainty"] {
        let (out, one) = (format!("out-{analysis}"), format!("one-{analysis}"));
        let arguments = [analysis, "case.toml", "--out", &out, "--threads", "1", "--engine", "mpi"];
        let child = on_ranks(2, at, &arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let parts = at.join(&out).join("parts").join(analysis);
        let started = Instant::now();
        let finished = || std::fs::read_dir(&parts).is_ok_and(|entries| entries.flatten().count() >= 4);
        while !finished() {
            assert!(started.elapsed() < Duration::from_secs(120), "parts come");
            std::thread::sleep(Duration::from_millis(5));
        }
        let victim = *ranks_in(at).last().expect("two ranks");
        assert!(Command::new("kill").args(["-9", &victim.to_string()]).status().unwrap().success());
        assert!(!child.wait_with_output().unwrap().status.success());
        assert!(!at.join(&out).join("summary.json").exists());
        let again = on_ranks(3, at, &arguments).output().unwrap();
        assert!(again.status.success(), "{}", text(&again.stderr));
        let said = text(&again.stderr);
        assert!(
            said.contains("An earlier run ended while rank") && said.contains("which is resumed"),
            "{said}"
        );
        let alone =
            program::command(at, &[analysis, "case.toml", "--quiet", "--out", &one]).output().unwrap();
        assert!(alone.status.success());
        assert!(sweeps::found(&at.join(&out)) == sweeps::found(&at.join(&one)), "{analysis}");
    }
}
