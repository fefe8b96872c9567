//! An error as JSON, for programs that call this one with `--json`.

use crate::error::{Error, Fault};
use serde_json::{Value, json};

/// `{"ok": false, "exit_code", "kind", "message", "faults"}`; `kind` is `input`, `analysis` or `machine`, and only input has faults.
pub fn error_json(error: &Error) -> Value {
    let (kind, faults) = match error {
        Error::Input(faults) => ("input", faults.0.iter().map(fault_json).collect()),
        Error::Analysis { .. } => ("analysis", Vec::new()),
        Error::Io { .. } => ("machine", Vec::new()),
    };
    json!({
        "ok": false,
        "exit_code": error.exit_code(),
        "kind": kind,
        "message": error.to_string(),
        "faults": faults,
    })
}

/// A command line that cannot be read.
pub fn usage_json(message: &str) -> Value {
    json!({ "ok": false, "exit_code": 2, "kind": "usage", "message": message, "faults": [] })
}

/// A fault or warning: where it is, `found`, `expected` and `help`.
pub fn fault_json(fault: &Fault) -> Value {
    let Place { file, line, key } = Place::of(&fault.place);
    json!({
        "place": fault.place,
        "file": file,
        "line": line,
        "key": key,
        "found": fault.found,
        "expected": fault.expected,
        "help": fault.help,
        "message": fault.to_string(),
    })
}

/// The parts of a place such as ``case.toml:12 `shell.disc.thickness` ``.
#[derive(Debug, PartialEq)]
struct Place<'a> {
    file: Option<&'a str>,
    line: Option<usize>,
    key: Option<&'a str>,
}

impl<'a> Place<'a> {
    fn of(place: &'a str) -> Self {
        let key = place.split('`').nth(1);
        let before = place.split('`').next().unwrap_or_default();
        let before = before.split(", column ").next().unwrap_or_default().trim_end();
        let numbered = before.rsplit_once(':').and_then(|(file, line)| Some((file, line.parse().ok()?)));
        let (file, line) = match numbered {
            Some((file, line)) => (Some(file), Some(line)),
            // A part of a file's name is a word with a full stop; others are the words of a place without a file.
            None => (Some(before).filter(|word| word.contains('.') && !word.contains(' ')), None),
        };
        Place { file, line, key }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_have_file_line_and_key_where_they_say_them() {
        for (place, file, line, key) in [
            (
                "a/case.toml:12 `shell.disc.thickness`",
                Some("a/case.toml"),
                Some(12),
                Some("shell.disc.thickness"),
            ),
            ("case.toml `mesh`", Some("case.toml"), None, Some("mesh")),
            ("C:/case.toml:3, column 9", Some("C:/case.toml"), Some(3), None),
            ("`contact.rim.reach`", None, None, Some("contact.rim.reach")),
            ("node 12 (line 9)", None, None, None),
        ] {
            assert_eq!(Place::of(place), Place { file, line, key }, "{place}");
        }
        let error = Error::input(Fault::new("case.toml:2 `mesh`", "1", "2").with_help("Take 2"));
        let json = error_json(&error);
        assert_eq!((&json["exit_code"], &json["faults"][0]["help"]), (&json!(2), &json!("Take 2")));
        assert_eq!(error_json(&Error::analysis("a", "b", "c"))["kind"], "analysis");
    }
}
