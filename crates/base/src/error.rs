//! One error type that carries data: what was wrong, where, what was expected and what to do about it.

pub mod read;
pub mod text;

use std::collections::HashMap;
use std::fmt;
use std::path::PathBuf;
use text::phrase;

/// The result of everything in stridor that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Errors, by who can correct them.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The input is wrong; all faults that were found, at once. Exit code 2.
    #[error("{0}")]
    Input(Faults),
    /// The input is well formed, but the analysis cannot give an answer. Exit code 1.
    #[error("{}: {}. {}", phrase(what), phrase(found), sentence(help))]
    Analysis {
        /// The analysis and the step in it, such as `steady sliding, Newton iteration 25`.
        what: String,
        /// Description of the failure, with its figures.
        found: String,
        /// Next action of the user.
        help: String,
    },
    /// The machine refused: a full disk, a folder that is not writable. Exit code 1.
    #[error("{}: {}. {}", text::printable(&path.display().to_string()), phrase(&source.to_string()), sentence(help))]
    Io {
        /// The file or folder concerned.
        path: PathBuf,
        /// Error of the operating system or a file library.
        source: Box<dyn std::error::Error + Send + Sync>,
        /// Next action of the user.
        help: String,
    },
}

impl Clone for Error {
    /// The same error; of that of the operating system or a file library its words.
    fn clone(&self) -> Self {
        match self {
            Error::Input(faults) => Error::Input(faults.clone()),
            Error::Analysis { what, found, help } => Error::analysis(what, found, help),
            Error::Io { path, source, help } => Error::io(path, source.to_string(), help),
        }
    }
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
    /// Value found there.
    pub found: String,
    /// Values accepted there.
    pub expected: String,
    /// Corrective action; may be empty when `expected` says it all.
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

    /// The fault as a sentence, for a warning.
    pub fn warning(&self) -> String {
        let (place, found, expected) =
            (text::place(&self.place), phrase(&self.found), phrase(&self.expected));
        let words = format!("Found {found}, at {place}; expected {expected}. {}", sentence(&self.help));
        words.trim_end().to_string()
    }
}

/// Advice with its full stop.
fn sentence(help: &str) -> String {
    let stop = if help.is_empty() || help.ends_with(['.', '?']) { "" } else { "." };
    format!("{}{stop}", phrase(help))
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (place, found, expected) =
            (text::place(&self.place), phrase(&self.found), phrase(&self.expected));
        write!(f, "{place}: found {found}; expected {expected}.")?;
        if !self.help.is_empty() {
            write!(f, " {}", sentence(&self.help))?;
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

/// How many places a message lists for one fault, and how many faults of one kind.
const LISTED: usize = 12;

impl Faults {
    /// Faults that differ in nothing but their place as one, which lists the places.
    fn joined(&self) -> Vec<Fault> {
        let mut joined: Vec<(&Fault, Vec<&str>)> = Vec::new();
        let mut known = HashMap::new();
        for fault in &self.0 {
            let at = *known.entry((&fault.found, &fault.expected, &fault.help)).or_insert_with(|| {
                joined.push((fault, Vec::new()));
                joined.len() - 1
            });
            joined[at].1.push(&fault.place);
        }
        let one = |(fault, mut places): (&Fault, Vec<&str>)| {
            places.dedup();
            let more = places.len().saturating_sub(LISTED);
            let mut place = places[..places.len() - more].join(", ");
            if more > 0 {
                place += &format!(" and {more} more places");
            }
            Fault { place, ..fault.clone() }
        };
        joined.into_iter().map(one).collect()
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let faults = self.joined();
        if let [one] = faults.as_slice() {
            return write!(f, "{one}");
        }
        write!(f, "{} faults in the input:", faults.len())?;
        let mut of_kind: HashMap<(&str, &str), usize> = HashMap::new();
        for fault in &faults {
            let count = of_kind.entry((&fault.expected, &fault.help)).or_default();
            *count += 1;
            if *count <= LISTED {
                write!(f, "\n  - {fault}")?;
            }
        }
        let hidden: usize = of_kind.values().map(|count| count.saturating_sub(LISTED)).sum();
        if hidden > 0 {
            write!(f, "\n  … and {hidden} more of the same kind.")?;
        }
        Ok(())
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
    fn a_warning_is_a_sentence() {
        let fault = Fault::new("a.toml:3 `disc.thickness`", "1 m", "at most 20 mm");
        assert_eq!(fault.warning(), "Found 1 m, at a.toml:3 `disc.thickness`; expected at most 20 mm.");
        let words = fault.with_help("Is it in mm").warning();
        assert!(words.ends_with("expected at most 20 mm. Is it in mm."), "{words}");
    }

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
    fn one_cause_is_one_fault_and_long_lists_end() {
        let missing = |key: &str| Fault::new(key, "\"stel\"", "the name of a material (steel)");
        let two = Faults(vec![missing("`shell.disc.material`"), missing("`bar.bar.material`")]);
        let expected = "`shell.disc.material`, `bar.bar.material`: found \"stel\"; expected the name of a material (steel).";
        assert_eq!(two.to_string(), expected);
        let many = Faults((0..40).map(|k| missing(&format!("`shell.{k}.material`"))).collect());
        assert!(
            many.to_string().contains("`shell.11.material` and 28 more places: found \"stel\""),
            "{many}"
        );
        let cell = |k: usize| Fault::new(format!("a.csv:{k}"), format!("\"x{k}\""), "a finite number");
        let mut cells = Faults((0..40).map(cell).collect());
        cells.push(Fault::new("a.csv:50", "2 cells", "3, as in the heading"));
        let text = cells.to_string();
        assert_eq!(text.lines().count(), 1 + LISTED + 1 + 1, "{text}");
        assert!(
            text.contains("41 faults")
                && text.contains("3, as in")
                && text.ends_with("28 more of the same kind.")
        );
    }

    #[test]
    fn what_is_echoed_is_short_and_steers_no_terminal() {
        let fault =
            Fault::new("a.toml:1 `a\u{1b}[2J`", format!("\"{}\u{202e}\"", "x".repeat(300)), "a length");
        let errors = [
            Error::input(fault),
            Error::analysis("a\u{7}", "b\u{1b}", "c\r"),
            Error::io("/data/\u{1b}[31m", "no\u{9b}", "Try \u{2066}"),
        ];
        for error in errors {
            let text = error.to_string();
            assert!(!text.contains(|c: char| c.is_control() || "\u{202e}\u{2066}".contains(c)), "{text}");
            assert!(text.chars().count() < 160, "{text}");
        }
    }

    #[test]
    fn nearest_key_is_offered_only_when_near() {
        assert_eq!(nearest("thicknes", ["thickness", "material"]), Some("thickness"));
        assert_eq!(nearest("zzz", ["thickness", "material"]), None);
    }
}
