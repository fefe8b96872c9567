//! Numerical comparisons of the tests: each with the origin of its bound, and a record of how much of it is used.
//!
//! With `STRIDOR_TEST_BOUNDS=FILE` a comparison adds a line to that file whenever it uses more of its bound than it has before in this
//! process: place, error, bound, their ratio and the origin. `.ci/widths` finds from many runs the comparisons without a margin.

use std::collections::HashMap;
use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};

/// Why an error is there at all, which says how near to its bound it may come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Rounding, of the value and of the reference: some n ε times a condition number.
    RoundOff,
    /// The criterion by which an iteration stops, of the value or of the reference, as its condition magnifies it.
    Tolerance,
    /// A mesh, a time step, a truncated series or basis, a window, a filter.
    Discretisation,
    /// Digits of a published or written number, or a reference by differences.
    Reference,
    /// Two theories that differ by a small parameter.
    Theory,
    /// Random numbers that the test puts in, of which the bound is a quantile or the largest.
    RandomSample,
    /// The error that the result itself states, or that was asked for.
    Stated,
}

/// Whether an error is within a bound that has this origin; not where one of them is not a number.
#[track_caller]
pub fn within(error: f64, bound: f64, origin: Origin) -> bool {
    if let Some(file) = &*FILE {
        record(file, Location::caller(), error, bound, origin);
    }
    error <= bound
}

/// The least of these errors: that of the nearest of several values.
pub fn least(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(f64::INFINITY, f64::min)
}

static FILE: LazyLock<Option<PathBuf>> =
    LazyLock::new(|| std::env::var_os("STRIDOR_TEST_BOUNDS").map(Into::into));

/// File, line and column of a comparison.
type Place = (&'static str, u32, u32);

/// The largest share of its bound that each comparison has used.
static USED: LazyLock<Mutex<HashMap<Place, f64>>> = LazyLock::new(Mutex::default);

fn record(file: &Path, at: &'static Location<'static>, error: f64, bound: f64, origin: Origin) {
    let share = if error <= 0.0 { 0.0 } else { error / bound };
    let mut used = USED.lock().unwrap_or_else(PoisonError::into_inner);
    let most = used.entry((at.file(), at.line(), at.column())).or_insert(-1.0);
    // Not for a share that is not a number: the assertion fails.
    if share > *most {
        *most = share;
        let (place, column) = (format!("{}:{}", at.file(), at.line()), at.column());
        let line = format!("{place}:{column}\t{error:.3e}\t{bound:.3e}\t{share:.6e}\t{origin:?}\n");
        let open = OpenOptions::new().append(true).create(true).open(file);
        open.and_then(|mut file| file.write_all(line.as_bytes())).expect("a file for the record of bounds");
    }
}

#[cfg(test)]
mod tests {
    use super::{Origin::RoundOff, least, within};

    #[test]
    fn what_is_no_number_is_not_within() {
        assert!(within(1.0, 1.0, RoundOff) && within(-3.0, 0.0, RoundOff) && !within(1.1, 1.0, RoundOff));
        assert!(!within(f64::NAN, 1.0, RoundOff) && !within(1.0, f64::NAN, RoundOff));
        assert_eq!((least([3.0, 0.5, 2.0]), least([])), (0.5, f64::INFINITY));
    }
}
