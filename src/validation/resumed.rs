//! A resumed run compared with an uninterrupted one.

use crate::case::Case;
use crate::error::Result;
use crate::job::{RunOptions, Selection, run_case};
use crate::progress::Observer;
use crate::results::{KEYS_OF_THE_RUN, summary_json};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// In how many places the summary of a run of `case` that was stopped differs from that of a whole run: what the whole run left
/// in its folder halfway through its longest work is resumed with `resume`. What says how a run went and not what it found does not count.
pub(super) fn differences(case: &Case, observer: &dyn Observer) -> Result<f64> {
    let folder = super::scratch::scratch()?;
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    let halfway = Halfway { observer, from: &whole, to: &stopped, stage: Mutex::default() };
    let expected = run_case(case, Selection::Listed, &whole, &RunOptions::default(), &halfway)?;
    let found = run_case(
        case,
        Selection::Listed,
        &stopped,
        &RunOptions { resume: true, ..RunOptions::default() },
        observer,
    )?;
    let summary = |results| {
        let mut summary = summary_json(results);
        KEYS_OF_THE_RUN.iter().for_each(|key| summary[*key] = Value::Null);
        summary
    };
    Ok(different(&summary(&expected), &summary(&found)) as f64)
}

/// The leaves of two values that are not the same.
fn different(a: &Value, b: &Value) -> usize {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) if a.len() == b.len() => {
            a.iter().map(|(key, value)| b.get(key).map_or(1, |other| different(value, other))).sum()
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).map(|(a, b)| different(a, b)).sum()
        }
        _ => usize::from(a != b),
    }
}

/// Copies the results of a run as they are when its longest stage is halfway through, as a kill would leave them.
struct Halfway<'a> {
    observer: &'a dyn Observer,
    from: &'a Path,
    to: &'a Path,
    stage: Mutex<ProgressStage>,
}

#[derive(Default)]
struct ProgressStage {
    steps: u64,
    done: u64,
    /// The most steps of any stage so far whose middle has been seen.
    longest: u64,
}

impl Observer for Halfway<'_> {
    fn begin(&self, stage: &str, total: Option<u64>) {
        let mut at = self.stage.lock().expect("no thread panics with it");
        (at.steps, at.done) = (total.unwrap_or(0), 0);
        self.observer.begin(stage, total);
    }

    fn advance(&self, steps: u64) {
        let mut at = self.stage.lock().expect("no thread panics with it");
        at.done += steps;
        if at.steps > at.longest && 2 * at.done >= at.steps {
            at.longest = at.steps;
            copy(self.from, self.to);
        }
        self.observer.advance(steps);
    }

    fn end(&self) {
        self.observer.end();
    }
}

/// Copies the files of a folder; a file that cannot be copied is missing there, which the resumed run reports.
fn copy(from: &Path, to: &Path) {
    let files = std::fs::read_dir(from).into_iter().flatten().flatten().map(|entry| entry.path());
    let files: Vec<PathBuf> = files.filter(|path| path.is_file()).collect();
    let _ = std::fs::create_dir_all(to);
    for file in files {
        let _ = file.file_name().map(|name| std::fs::copy(&file, to.join(name)));
    }
}

#[cfg(test)]
mod tests {
    use super::different;
    use serde_json::json;

    #[test]
    fn every_leaf_that_differs_counts() {
        let whole = json!({ "a": [1.0, 2.0, 3.0], "b": { "c": "x", "d": null } });
        assert_eq!(different(&whole, &whole.clone()), 0);
        assert_eq!(different(&whole, &json!({ "a": [1.0, 2.5, 3.5], "b": { "c": "x", "d": 0 } })), 3);
        assert_eq!(different(&whole, &json!({ "a": [1.0, 2.0], "b": { "c": "x", "e": null } })), 2);
    }
}
