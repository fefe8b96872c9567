//! One error type that carries data: what was wrong, where, what was expected and what to do about it.

use std::fmt;
use std::path::PathBuf;

/// The result of everything in stridor that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// What can go wrong, by who can mend it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The input is wrong; all faults that were found, at once. Exit code 2.
    #[error("{0}")]
    Input(Faults),
    /// The input is well formed, but the analysis cannot give an answer. Exit code 1.
    #[error("{what}: {found}. {help}")]
    Analysis {
        /// The analysis and the step in it, such as `steady sliding, Newton iteration 25`.
        what: String,
        /// What happened, with its figures.
        found: String,
        /// What the user can do next.
        help: String,
    },
    /// The machine refused: a full disk, a folder that is not writable. Exit code 1.
    #[error("{}: {source}. {help}", path.display())]
    Io {
        /// The file or folder concerned.
        path: PathBuf,
        /// What the operating system or a file library said.
        source: Box<dyn std::error::Error + Send + Sync>,
        /// What the user can do next.
        help: String,
    },
}

impl Error {
    /// An input error with a single fault.
    pub fn input(fault: Fault) -> Self {
        Error::Input(Faults(vec![fault]))
    }

    /// An analysis that could not give an answer.
    pub fn analysis(what: impl Into<String>, found: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Analysis { what: what.into(), found: found.into(), help: help.into() }
    }

    /// A refusal of the machine on `path`.
    pub fn io(
        path: impl Into<PathBuf>,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
        help: impl Into<String>,
    ) -> Self {
        Error::Io { path: path.into(), source: source.into(), help: help.into() }
    }

    /// The same error once computing has begun: what is only found then counts as an analysis without an answer.
    pub fn while_computing(self) -> Self {
        let Error::Input(faults) = self else { return self };
        let found: Vec<String> = faults.0.iter().map(ToString::to_string).collect();
        let found = found.join(" ");
        Error::analysis(
            "found while computing",
            found.trim_end_matches('.'),
            "Change the case and run it again",
        )
    }

    /// The process exit code: 2 when the input is wrong, 1 otherwise.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input(_) => 2,
            Error::Analysis { .. } | Error::Io { .. } => 1,
        }
    }
}

/// One fault of the input: where it is, what was found, what was expected, what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// File with line, key or element: ``rig.toml:12 `contact.rim.stiffness` ``.
    pub place: String,
    /// What was found there.
    pub found: String,
    /// What is accepted there.
    pub expected: String,
    /// What to do; may be empty when `expected` says it all.
    pub help: String,
}

impl Fault {
    /// A fault at `place`; `found` and `expected` are phrases without a full stop.
    pub fn new(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Fault { place: place.into(), found: found.into(), expected: expected.into(), help: String::new() }
    }

    /// The same fault with advice, a sentence without its full stop.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: found {}; expected {}.", self.place, self.found, self.expected)?;
        if !self.help.is_empty() {
            let stop = if self.help.ends_with(['.', '?']) { "" } else { "." };
            write!(f, " {}{stop}", self.help)?;
        }
        Ok(())
    }
}

/// Every fault of an input, collected so that the user sees them all at once.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Faults(pub Vec<Fault>);

impl Faults {
    /// No fault yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Notes a fault.
    pub fn push(&mut self, fault: Fault) {
        self.0.push(fault);
    }

    /// Notes the faults of `result`, or gives its value; errors of another kind pass through as a fault each.
    pub fn take<T>(&mut self, result: Result<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(Error::Input(faults)) => {
                self.0.extend(faults.0);
                None
            }
            Err(other) => {
                self.push(Fault::new("input", other.to_string(), "input that can be read"));
                None
            }
        }
    }

    /// `Ok(value)` when no fault was noted.
    pub fn into_result<T>(self, value: T) -> Result<T> {
        if self.0.is_empty() { Ok(value) } else { Err(Error::Input(self)) }
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.as_slice() {
            [one] => write!(f, "{one}"),
            many => {
                write!(f, "{} faults in the input:", many.len())?;
                for fault in many {
                    write!(f, "\n  - {fault}")?;
                }
                Ok(())
            }
        }
    }
}

/// The known word nearest to `word`, when one is near enough to be what was meant.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|k| (strsim::damerau_levenshtein(word, k), k))
        .filter(|(distance, k)| *distance <= 1 + k.len() / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_faults_are_shown_and_input_exits_with_two() {
        let mut faults = Faults::new();
        faults.push(Fault::new("a.toml:3 `disc.thickness`", "-1.0", "a positive length"));
        faults.push(Fault::new("a.toml:4", "0.5", "ν in (-1, 0.5)").with_help("Steel has 0.3"));
        let error = faults.into_result(()).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("2 faults") && text.contains("disc.thickness") && text.contains("Steel"));
        assert_eq!(error.exit_code(), 2);
    }

    #[test]
    fn nearest_key_is_offered_only_when_near() {
        assert_eq!(nearest("thicknes", ["thickness", "material"]), Some("thickness"));
        assert_eq!(nearest("zzz", ["thickness", "material"]), None);
    }
}
