//! Numerical comparisons of the tests: each with the origin of its bound, and a record of how much of it is used.
//!
//! With `STRIDOR_TEST_BOUNDS=FILE` every comparison adds a line to that file: place, error, bound, their ratio and the origin.
//! `.ci/widths` lists from it the comparisons with less than a margin of ten.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;

/// Whether an error is within a bound that has this origin; not where one of them is not a number.
#[track_caller]
pub fn within(error: f64, bound: f64, origin: &str) -> bool {
    if let Some(file) = std::env::var_os("STRIDOR_TEST_BOUNDS") {
        let (place, share) = (Location::caller(), if error == 0.0 { 0.0 } else { error / bound });
        let line =
            format!("{}:{}\t{error:.2e}\t{bound:.2e}\t{share:.1e}\t{origin}\n", place.file(), place.line());
        let open = OpenOptions::new().append(true).create(true).open(file);
        open.and_then(|mut file| file.write_all(line.as_bytes())).expect("a file for the record of bounds");
    }
    error <= bound
}
