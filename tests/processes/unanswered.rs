//! Points of sweeps, maps and studies of samples that have no answer: the others are kept, and what is left out is said.

use crate::program::{CASE, command, folder_with, run, said};
use serde_json::Value;
use std::path::Path;
use stridor::numbers::given;

/// A disc on a pin, which a positive approach alone closes.
fn disc(study: &str) -> String {
    let (head, _) = CASE.split_once("[map.m]").expect("a map");
    format!("{}\n{study}", head.replace("\"1 kHz\"", "\"260 Hz\""))
}

/// What `stridor ANALYSIS case.toml` says, where the exit code is `code`.
#[track_caller]
fn analyse(at: &Path, analysis: &str, code: i32) -> String {
    said(&run(&mut command(at, &[analysis, "case.toml", "--quiet", "--out", "out"])), code)
}

fn summary(at: &Path) -> Value {
    let text = std::fs::read_to_string(at.join("out/summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

/// Headings and rows of a table.
fn table(at: &Path, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(at.join("out").join(name)).expect("a table");
    let headings = reader.headers().expect("headings").iter().map(String::from).collect();
    let rows = reader.records().map(|row| row.expect("a row").iter().map(String::from).collect());
    (headings, rows.collect())
}

/// Gaps at the beginning, at the end, and nowhere; one point alone that has an answer.
#[test]
fn a_sweep_leaves_out_points_without_an_answer() {
    for ([from, to], points) in
        [([-2.0, 2.0], 5), ([2.0, -2.0], 5), ([-1.0, 3.0], 9), ([0.5, 2.0], 4), ([-3.0, 1.0], 5)]
    {
        let folder = folder_with(&disc(&format!(
            "[sweep.approach]\nparameter = \"contact.pin.approach\"\n\
             from = \"{from} um\"\nto = \"{to} um\"\npoints = {points}\n"
        )));
        let at = folder.path();
        analyse(at, "sweep", 0);
        let axis = |k: usize| from + (to - from) * k as f64 / (points - 1) as f64;
        let (closed, open): (Vec<f64>, Vec<f64>) = (0..points).map(axis).partition(|um| *um > 0.0);
        let summary = summary(at);
        let found = &summary["sweeps"][0];
        let [values, answered] =
            ["values", "answered"].map(|key| found[key].as_u64().expect("a number") as usize);
        assert!(values - answered >= open.len() && answered >= closed.len(), "{found}");
        assert_eq!(values == answered, open.is_empty(), "{found}");
        let (headings, rows) = table(at, "sweep_approach.csv");
        let approach = headings.iter().position(|heading| heading.starts_with("contact.pin.approach"));
        let approach = approach.expect("a column");
        let at_values: Vec<f64> =
            rows.iter().map(|row| 1e6 * row[approach].parse::<f64>().expect("a number")).collect();
        assert!(!rows.is_empty() && at_values.iter().all(|um| *um > 0.0), "{at_values:?}");
        assert!(
            closed.iter().all(|own| at_values.iter().any(|um| given(*um) == given(*own))),
            "{at_values:?}"
        );
        let picture = std::fs::read_to_string(at.join("out/sweep_approach.svg")).expect("a picture");
        assert!(!picture.contains("NaN"));
        let said = summary["warnings"].to_string();
        let counted =
            format!("`sweep.approach` leaves out {} of {values} points without an answer", values - answered);
        assert_eq!(said.contains(&counted), !open.is_empty(), "{said}");
        let first = |um: &f64| format!("the first, `contact.pin.approach` = {} m: ", given(1e-6 * um));
        assert!(open.first().is_none_or(|um| said.contains(&first(um))), "{said}");
    }
}

/// What is not known is no number, and no zero.
#[test]
fn a_map_is_empty_where_it_has_no_answer() {
    let folder = folder_with(&disc(
        "[map.gap]\nparameters = [\"contact.pin.approach\", \"contact.pin.friction.mu0\"]\n\
         from = [\"-2 um\", 0.1]\nto = [\"2 um\", 0.8]\npoints = [5, 3]\n",
    ));
    let at = folder.path();
    analyse(at, "sweep", 0);
    let (headings, rows) = table(at, "map_gap.csv");
    let column =
        |name: &str| headings.iter().position(|heading| heading.starts_with(name)).expect("a column");
    let [approach, growth, unstable] = ["contact.pin.approach", "growth_rate", "unstable"].map(column);
    assert_eq!(rows.len(), 15);
    for row in &rows {
        let closed = row[approach].parse::<f64>().expect("a number") > 0.0;
        assert!(row[growth].is_empty() != closed && row[unstable].is_empty() != closed, "{row:?}");
    }
    let file = hdf5::File::open(at.join("out/results.h5")).expect("results.h5 opens");
    let unstable = file.dataset("maps/gap/grid/unstable").expect("a dataset");
    assert_eq!(
        unstable.attr("_FillValue").expect("an attribute").read_scalar::<i64>().expect("a number"),
        -1
    );
    let numbers = unstable.read_raw::<i64>().expect("numbers");
    assert!(
        numbers.iter().zip(&rows).all(|(number, row)| (*number == -1) == row[growth].is_empty()),
        "{numbers:?}"
    );
    let found = summary(at);
    assert_eq!(found["maps"][0]["answered"], 6);
    let warnings = found["warnings"].to_string();
    let counted =
        "`map.gap` leaves out 9 of 15 points without an answer; the first, `contact.pin.approach` = ";
    let first = format!("{counted}{} m, `contact.pin.friction.mu0` = 0.1: ", given(-2e-6));
    assert!(warnings.contains(&first), "{warnings}");
}

/// Nothing found is an error that names the first place.
#[test]
fn a_study_without_any_answer_is_an_error() {
    let approach = "parameter = \"contact.pin.approach\"\n";
    let parameter =
        "parameter.approach = { path = \"contact.pin.approach\", between = [\"-2 um\", \"-1 um\"] }";
    for (table, analysis, points) in [
        ("sweep", "sweep", format!("{approach}from = \"-2 um\"\nto = \"-1 um\"\npoints = 4")),
        (
            "map",
            "sweep",
            "parameters = [\"contact.pin.approach\", \"contact.pin.friction.mu0\"]\n\
             from = [\"-2 um\", 0.1]\nto = [\"-1 um\", 0.8]\npoints = [2, 2]"
                .into(),
        ),
        ("uncertainty", "uncertainty", format!("samples = 10\n{parameter}")),
    ] {
        let folder = folder_with(&disc(&format!("[{table}.none]\n{points}\n")));
        let words = analyse(folder.path(), analysis, 1);
        let named = format!("`{table}.none`: none of ");
        assert!(words.contains(&named) && words.contains("the first, `contact.pin.approach` = "), "{words}");
    }
}
