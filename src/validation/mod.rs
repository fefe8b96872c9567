//! Validation of the program. Each folder below `validation/` holds a case, and a `reference.toml` with
//! quantities, reference values, tolerances, and the reason for each.

mod check;
pub mod extrapolation;
mod in_time;
pub mod kirchhoff;
mod record;
mod reference;
mod resumed;
mod run;
mod scratch;
pub mod two_dof;

pub(crate) use check::computed;
pub(crate) use reference::read_check;
pub use reference::{ChannelWindow, Check, CheckQuantity, Measure, Near, QuantityKind, Reference};

use crate::error::{Error, Fault, Faults, Result};
use crate::progress::Observer;
use crate::results::record::InputFile;
use crate::results::{CheckedCase, passed};
use rayon::ThreadPool;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Runs every validation case below `root` whose folder name contains `filter`; several at a time, each on one thread.
///
/// # Errors
/// A folder without cases, a reference file with faults, or a case that cannot be analysed.
pub fn run(root: &Path, filter: Option<&str>, observer: &dyn Observer) -> Result<Vec<CheckedCase>> {
    let mut faults = Faults::new();
    let folders = folders(root, filter)?;
    let references: Vec<_> =
        folders.iter().filter_map(|folder| faults.take(reference::read(folder))).collect();
    faults.into_result(())?;
    match references.as_slice() {
        [one] => Ok(vec![check::run(one, observer)?]),
        several => side_by_side(several, observer),
    }
}

/// Every case on one thread, as many at a time as there are threads.
fn side_by_side(references: &[Reference], observer: &dyn Observer) -> Result<Vec<CheckedCase>> {
    let threads = rayon::current_num_threads().min(references.len());
    let alone = || rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pools: Vec<ThreadPool> = (0..threads)
        .map(|_| alone())
        .collect::<std::result::Result<_, _>>()
        .map_err(|error| Error::analysis("starting threads", error.to_string(), "Try fewer --threads"))?;
    observer.begin("validation cases", Some(references.len() as u64));
    let next = AtomicUsize::new(0);
    let take_turns = || {
        let mut found = Vec::new();
        loop {
            let k = next.fetch_add(1, Relaxed);
            let Some(reference) = references.get(k) else { return found };
            found.push((k, check::run(reference, &())));
            observer.advance(1);
        }
    };
    let mut found = std::thread::scope(|scope| {
        // Where the machine gives fewer threads, fewer cases run at a time.
        let workers = pools[1..].iter().filter_map(|pool| {
            let builder = std::thread::Builder::new();
            builder.spawn_scoped(scope, move || pool.install(take_turns)).ok()
        });
        let workers: Vec<_> = workers.collect();
        let own = Ok(pools[0].install(take_turns));
        let found = workers.into_iter().map(|worker| worker.join()).chain([own]);
        found.flat_map(|found| found.unwrap_or_else(|panic| resume_unwind(panic))).collect::<Vec<_>>()
    });
    observer.end();
    found.sort_by_key(|(k, _)| *k);
    found.into_iter().map(|(_, case)| case).collect()
}

/// The cases below `root` whose folder name contains `filter`, and their references.
///
/// # Errors
/// A folder without cases, a file that cannot be read.
pub fn inputs(root: &Path, filter: Option<&str>) -> Result<Vec<InputFile>> {
    let folders = folders(root, filter)?;
    let files = folders.iter().flat_map(|folder| {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        ["case.toml", "reference.toml"].map(|file| format!("{name}/{file}"))
    });
    files.filter(|file| root.join(file).is_file()).map(|file| InputFile::read(root, &file)).collect()
}

fn folders(root: &Path, filter: Option<&str>) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(root).map_err(|error| {
        Error::input(
            Fault::new(root.display().to_string(), error.to_string(), "the folder of validation cases")
                .with_help("Run from the repository, or name it with --from"),
        )
    })?;
    let mut folders: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.join("reference.toml").is_file())
        .filter(|path| {
            filter.is_none_or(|f| path.file_name().is_some_and(|n| n.to_string_lossy().contains(f)))
        })
        .collect();
    folders.sort();
    if folders.is_empty() {
        let expected = match filter {
            Some(filter) => format!("a case whose name contains \"{filter}\""),
            None => "folders with a reference.toml".to_string(),
        };
        return Err(Error::input(Fault::new(root.display().to_string(), "no validation case", expected)));
    }
    Ok(folders)
}

/// The rows as a table for people.
pub fn table(cases: &[CheckedCase]) -> String {
    let mut text = String::new();
    for case in cases {
        let width = case.rows.iter().map(|row| row.quantity.chars().count()).max().unwrap_or(0).max(8);
        text += &format!("\n{} ({})\n", case.title, case.name);
        text += &format!("  source: {}\n", case.source);
        text += &format!(
            "  {:<width$} {:>12} {:>12} {:>10} {:>9}\n",
            "quantity", "computed", "reference", "difference", "tolerance"
        );
        for row in &case.rows {
            text += &format!(
                "  {:<width$} {:>12} {:>12} {:>10.1e} {:>9.1e}  {}\n",
                row.quantity,
                short(row.computed),
                short(row.reference),
                row.difference(),
                row.tolerance,
                if row.passed() { "pass" } else { "FAIL" }
            );
        }
    }
    let [all, within] = passed(cases);
    text + &format!("\n{within} of {all} quantities within tolerance\n")
}

/// A number with seven significant digits, without trailing zeros; powers of ten where it is tiny.
fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let magnitude = x.abs().log10().floor() as i32;
    if magnitude < -4 {
        return format!("{x:.1e}");
    }
    let text = format!("{x:.*}", (6 - magnitude).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// The rows as JSON, in the form of the summary's `validation` list.
pub fn to_json(cases: &[CheckedCase]) -> String {
    let list: Vec<serde_json::Value> = cases
        .iter()
        .flat_map(|case| case.rows.iter().map(move |row| (case, row)))
        .map(|(case, row)| {
            serde_json::json!({
                "case": case.name,
                "quantity": row.quantity,
                "computed": row.computed,
                "reference": row.reference,
                "difference": row.difference(),
                "tolerance": row.tolerance,
                "relative": row.relative,
                "source": case.source,
                "reason": row.reason,
                "passed": row.passed(),
            })
        })
        .collect();
    serde_json::json!({ "validation": list }).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_the_suite_names_every_case_and_no_other() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
        let page = std::fs::read_to_string(root.join("README.md")).unwrap();
        let name = |folder: &PathBuf| folder.file_name().unwrap().to_string_lossy().into_owned();
        let cases: Vec<String> = folders(&root, None).unwrap().iter().map(name).collect();
        for case in &cases {
            assert!(page.contains(&format!("[{case}]({case})")), "{case} is not in validation/README.md");
        }
        for link in page.split("](").skip(1) {
            let target = link.split(')').next().unwrap_or_default();
            assert!(cases.iter().any(|case| case == target), "{target} is no validation case");
        }
    }
}
