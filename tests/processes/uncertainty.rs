//! Studies of uncertain scalars: against closed forms of the model of Rusli et al. (2020), in parts, after a kill, and with wrong input.

use crate::program::{command, folder_with, names, run, said};
use crate::sweeps::{disc, found};
use serde_json::Value;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use stridor::bounds::{Origin::*, within};
use stridor::linalg::c64;
use stridor::results::record::{Entry, entries};

/// The block of Rusli et al. (2020) with these uncertain scalars.
fn block(study: &str) -> String {
    format!("{}\n{study}", include_str!("../../validation/two-dof/case.toml"))
}

/// `stridor uncertainty case.toml` with results in `out` and these arguments; what it prints on stderr, where the exit code is `code`.
#[track_caller]
fn study(at: &Path, out: &str, arguments: &[&str], code: i32) -> String {
    let arguments = [&["uncertainty", "case.toml", "--quiet", "--out", out], arguments].concat();
    said(&run(&mut command(at, &arguments)), code)
}

fn summary(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&text).expect("JSON");
    summary["uncertainty"][0].clone()
}

fn limits(summary: &Value) -> [f64; 2] {
    [0, 1].map(|k| summary["probability_limits"][k].as_f64().expect("a number"))
}

/// With μ₀ alone the verdict turns at μ = (1 + k_t²/N²m²)/2 = 0.625 (Eq. 4 of the paper), and λ² = −a ± i b with a = 1.75 and
/// b² = 2 μ/4 − (k_t² + 1)/4 beyond.
#[test]
fn the_probability_of_one_scalar_is_that_of_its_distribution() {
    let parameter = "[uncertainty.mu.parameter.friction]\npath = \"contact.belt.friction.mu0\"\n";
    let uniform = format!("[uncertainty.mu]\nsamples = 2000\n{parameter}between = [0.4, 0.8]\n");
    let folder = folder_with(&block(&uniform));
    let at = folder.path();
    study(at, "out", &[], 0);
    let found = summary(&at.join("out"));
    // A Latin hypercube has one sample in each of 2000 intervals: one of them holds the limit.
    let share = found["probability"].as_f64().expect("a number");
    assert!(within((share - 0.4375).abs(), 1.0 / 2000.0, RandomSample), "{share}");
    assert_eq!(found["method"]["kind"], "reduced");
    let grows: f64 =
        found["modes"].as_array().unwrap().iter().map(|mode| mode["probability"].as_f64().unwrap()).sum();
    assert!(within((grows - share).abs(), 1e-12, RoundOff), "one of the two modes grows: {grows}");
    let mut table = csv::Reader::from_path(at.join("out/uncertainty_mu.csv")).expect("a table");
    let headings: Vec<String> = table.headers().expect("headings").iter().map(String::from).collect();
    assert_eq!(headings[..3], ["sample", "contact.belt.friction.mu0", "growth_rate [1/s]"]);
    let mut count = 0;
    for row in table.records() {
        let row = row.expect("a row");
        let [mu, growth, hz] = [1, 2, 3].map(|k| row[k].parse::<f64>().expect("a number"));
        let b = 0.25 * (2.0 * mu - 1.25);
        let exact = (c64::new(1.75, 0.0) + c64::new(0.0, 1.0) * c64::new(b, 0.0).sqrt()).sqrt();
        // At the limit λ moves as the root of the error of the matrices.
        let error = 1e-14 / b.abs().sqrt();
        if b > 0.0 {
            assert!(within((growth - exact.im).abs(), error, RoundOff), "{mu}: {growth}, {}", exact.im);
            assert!(within((hz * std::f64::consts::TAU - exact.re).abs(), error, RoundOff), "{mu}: {hz}");
        } else {
            assert!(within(growth.abs(), error, RoundOff), "{mu}: {growth}");
        }
        count += 1;
    }
    assert_eq!(count, 2000);
    // Normal: P = 1 − Φ((0.625 − 0.6)/0.05) = 1 − Φ(0.5) = 0.308538; the bounds are 6 deviations away.
    let normal = format!(
        "[uncertainty.mu]\nsamples = 2000\n{parameter}between = [0.3, 0.9]\nexpected = 0.6\ndeviation = 0.05\n"
    );
    std::fs::write(at.join("case.toml"), block(&normal)).expect("a case");
    study(at, "out", &[], 0);
    let share = summary(&at.join("out"))["probability"].as_f64().expect("a number");
    assert!(within((share - 0.308_538).abs(), 1.0 / 2000.0, RandomSample), "{share}");
}

/// μ > (1 + k_t²/N²m²)/2 over k_t from 0.2 to 1 N/m and μ from 0.4 to 1: P = (1/2 − E(k_t²)/2)/0.6, E(k_t²) = 0.992/2.4.
#[test]
fn the_probability_of_two_scalars_is_an_area() {
    let case = block(
        "[uncertainty.both]\nsamples = 1000\n[uncertainty.both.parameter.kt]\npath = \"spring.kt.stiffness\"\n\
         between = [0.2, 1]\n[uncertainty.both.parameter.mu]\npath = \"contact.belt.friction.mu0\"\nbetween = [0.4, 1]\n",
    );
    let folder = folder_with(&case);
    let at = folder.path();
    study(at, "out", &[], 0);
    let found = summary(&at.join("out"));
    let (share, [low, high], exact) =
        (found["probability"].as_f64().unwrap(), limits(&found), (0.5 - 0.496 / 2.4) / 0.6);
    assert!(
        within((share - exact).abs(), 0.02, RandomSample) && low < exact && exact < high,
        "{share} [{low}, {high}] {exact}"
    );
    assert!(high - low < 0.064 && found["method"]["kind"] == "whole" && found["undecided"] == 0, "{found}");
    let correlation = |k: usize| found["scalars"][k]["correlation"].as_f64().expect("a number");
    assert!(found["scalars"][0]["name"] == "kt" && correlation(0) < -0.2 && correlation(1) > 0.5, "{found}");
    // The same numbers for any number of threads and any order of the tables.
    let samples = std::fs::read(at.join("out/uncertainty_both.csv")).expect("a table");
    study(at, "other", &["--threads", "1"], 0);
    assert!(std::fs::read(at.join("other/uncertainty_both.csv")).expect("a table") == samples);
}

#[test]
fn samples_computed_in_parts_are_those_of_one_run() {
    let folder = folder_with(&disc());
    let at = folder.path();
    study(at, "whole", &[], 0);
    let whole = found(&at.join("whole"));
    let warnings = whole.1["warnings"].to_string();
    assert!(warnings.contains("`uncertainty.gap` leaves out "), "{warnings}");
    let of = |k: usize| whole.1["uncertainty"][k].clone();
    assert!(of(0)["method"]["kind"] == "reduced" && of(1)["method"]["kind"] == "whole");
    assert!(of(0)["answered"].as_u64() < of(0)["drawn"].as_u64() && of(1)["answered"] == of(1)["drawn"]);
    for part in ["3/3", "1/3", "2/3"] {
        study(at, "out", &["--part", part], 0);
    }
    assert_eq!(names(&at.join("out/parts/uncertainty")), ["1-of-3.bin", "2-of-3.bin", "3-of-3.bin"]);
    study(at, "out", &["--merge"], 0);
    assert!(found(&at.join("out")) == whole, "the merged result is another one");
    // The parts of another analysis are apart.
    let sweep = ["sweep", "case.toml", "--quiet", "--out", "out", "--merge"];
    let message = said(&run(&mut command(at, &sweep)), 2);
    assert!(message.contains("out/parts/sweep: found no part"), "{message}");
}

#[test]
fn a_study_that_was_killed_resumes() {
    let case = block(
        "[uncertainty.both]\nsamples = 6000\n[uncertainty.both.parameter.kt]\npath = \"spring.kt.stiffness\"\n\
         between = [0.2, 1]\n",
    );
    let folder = folder_with(&case);
    let (at, out) = (folder.path(), folder.path().join("out"));
    let arguments = ["uncertainty", "case.toml", "--quiet", "--out", "out"];
    let mut child = command(at, &arguments).stderr(Stdio::inherit()).spawn().expect("the binary runs");
    let recorded = || {
        let entries = entries(&out.join("record.bin")).ok()?;
        let sample =
            |entry: &&Entry| matches!(entry, Entry::Answer { study, .. } if study == "uncertainty.both");
        Some(entries.iter().filter(sample).count())
    };
    let began = Instant::now();
    while recorded().is_none_or(|count| count < 50) && began.elapsed() < Duration::from_secs(100) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let count = recorded().expect("a record");
    assert!((50..6_000).contains(&count), "{count}");
    let other = said(&run(&mut command(at, &["cea", "case.toml", "--quiet", "--out", "out", "--resume"])), 2);
    assert!(other.contains("an interrupted record of samples; expected `stridor uncertainty`"), "{other}");
    study(at, "out", &["--resume"], 0);
    study(at, "whole", &[], 0);
    assert!(found(&out) == found(&at.join("whole")), "the resumed result is another one");
}

#[test]
fn wrong_studies_are_refused_and_nothing_is_written() {
    let study_of = |more: &str| {
        let case = block(&format!("[uncertainty.mu]\n{more}"));
        let folder = folder_with(&case);
        let message = study(folder.path(), "out", &[], 2);
        assert_eq!(names(folder.path()), ["case.toml"], "{message}");
        message
    };
    let none = study_of("samples = 20\n");
    assert!(none.contains("at least one table [uncertainty.mu.parameter.NAME]"), "{none}");
    let parameter =
        "[uncertainty.mu.parameter.a]\npath = \"contact.belt.friction.mu\"\nbetween = [\"1 N\", 0]\n";
    let wrong = study_of(parameter);
    for words in ["Did you mean `contact.belt.friction.mu0`?", "the lower bound before the upper one"] {
        assert!(wrong.contains(words), "{words}: {wrong}");
    }
    let folder = folder_with(&block(""));
    let message = study(folder.path(), "out", &[], 2);
    assert!(
        message.contains("`uncertainty`") && message.contains("[uncertainty.all.parameter.mu]"),
        "{message}"
    );
}
