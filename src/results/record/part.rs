//! Part of a job array.

use crate::error::{Error, Fault, Result};
use std::fmt;

/// One of several shares of the sweeps and maps of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part {
    /// How many shares there are.
    pub of: usize,
    /// Which one, from 1.
    pub number: usize,
}

impl Part {
    /// Reads `3/40`.
    ///
    /// # Errors
    /// Input: anything else.
    pub fn read(text: &str) -> Result<Self> {
        let part = text
            .split_once('/')
            .and_then(|(number, of)| Some(Part { number: number.parse().ok()?, of: of.parse().ok()? }));
        part.filter(|part| (1..=part.of).contains(&part.number)).ok_or_else(|| {
            let expected = "the part and how many there are, from 1/40 to 40/40 for a job array of 40";
            Error::input(Fault::new("--part", format!("`{text}`"), expected))
        })
    }

    /// The name of its file.
    pub fn file(self) -> String {
        format!("{}-of-{}.bin", self.number, self.of)
    }

    /// The part whose file has this name.
    pub(super) fn of_file(name: &str) -> Option<Self> {
        let (number, of) = name.strip_suffix(".bin")?.split_once("-of-")?;
        let part = Part { number: number.parse().ok()?, of: of.parse().ok()? };
        (part.file() == name).then_some(part)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "part {} of {}", self.number, self.of)
    }
}
