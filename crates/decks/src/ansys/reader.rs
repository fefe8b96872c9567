//! Lines of an archive, and commands in them.

use super::model::Model;
use crate::deck::Place;
use crate::ledger::Weight;
use crate::text::Files;
use stridor_base::numbers::parse;

/// A command with its arguments.
#[derive(Debug, Clone)]
pub(super) struct Command<'a> {
    /// Its name in capitals.
    pub name: String,
    /// What stands after the name, between commas, without the blanks about it.
    pub args: Vec<&'a str>,
    /// Where it stands.
    pub place: Place,
}

impl<'a> Command<'a> {
    /// An argument from 0; empty where there is none.
    pub fn arg(&self, k: usize) -> &'a str {
        self.args.get(k).copied().unwrap_or("")
    }

    /// An argument in capitals.
    pub fn word(&self, k: usize) -> String {
        self.arg(k).to_ascii_uppercase()
    }
}

/// The lines of a file.
#[derive(Debug, Clone)]
struct Lines<'a> {
    rest: &'a str,
    number: u32,
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
        self.rest = rest;
        self.number += 1;
        Some(line.strip_suffix('\r').unwrap_or(line))
    }
}

/// Reads a file into a model.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    pub files: &'a mut Files,
    pub model: Model,
    /// Work that selections may still make.
    pub budget: usize,
    /// Members of components and selections that may still be kept.
    pub members_left: usize,
    /// Whether one of both is used up: no more is read.
    pub over: bool,
    file: u32,
    lines: Lines<'a>,
}

impl<'a> Reader<'a> {
    pub fn new(files: &'a mut Files, file: u32, text: &'a str) -> Reader<'a> {
        // Work of selections in proportion to the file, so that no file takes quadratic time.
        let budget = text.len().saturating_mul(10) + 10_000_000;
        let members_left = text.len() + 1_000_000;
        let model = Model::default();
        Reader {
            files,
            model,
            budget,
            members_left,
            over: false,
            file,
            lines: Lines { rest: text, number: 0 },
        }
    }

    /// Reads the whole file.
    pub fn run(&mut self) {
        while let Some((line, place)) = self.line() {
            if self.files.too_many() || self.over {
                break;
            }
            let line = without_header(line).split('!').next().unwrap_or("");
            let first = line.trim_start().bytes().next();
            match first {
                None => {}
                Some(b'0'..=b'9' | b'-' | b'+' | b'.' | b':' | b'(') => {
                    let why =
                        "lines that begin with no command: data of a command that is not read, or a header";
                    self.note(Weight::Nothing, "lines of data", why, place);
                }
                Some(b'/' | b'*') => self.single(line, place),
                Some(_) => line.split('$').for_each(|part| self.single(part, place)),
            }
        }
    }

    fn single(&mut self, text: &'a str, place: Place) {
        let text = text.trim();
        if text.is_empty() {
            return;
        }
        if let Some((name, value)) = text.split_once('=') {
            if is_name(name.trim()) {
                return self.assign(name, value, place);
            }
            if name.split_once('(').is_some_and(|(name, _)| is_name(name)) {
                let why = "tables of parameters";
                return self.note(Weight::Nothing, "parameters with an index", why, place);
            }
        }
        let end = text.find([',', ' ', '\t']).unwrap_or(text.len());
        let name = text[..end].to_ascii_uppercase();
        let rest = text[end..].trim_start();
        let rest = rest.strip_prefix(',').unwrap_or(rest);
        let mut args: Vec<&'a str> = rest.split(',').map(str::trim).collect();
        while args.last().is_some_and(|last| last.is_empty()) {
            args.pop();
        }
        self.command(&Command { name, args, place });
    }

    /// Gives a parameter its value.
    pub fn assign(&mut self, name: &str, value: &str, place: Place) {
        let name = name.trim().to_ascii_uppercase();
        match self.value(value) {
            Some(value) => _ = self.model.parameters.insert(name, value),
            // A value that is text, or blank: the parameter is deleted.
            None => {
                self.model.parameters.remove(&name);
                if !value.trim().is_empty() && !value.trim_start().starts_with('\'') {
                    let why = "expressions are not evaluated";
                    self.note(Weight::Perhaps, "parameters by expressions", why, place);
                }
            }
        }
    }

    /// The next line.
    pub fn line(&mut self) -> Option<(&'a str, Place)> {
        let line = self.lines.next()?;
        Some((line, self.here()))
    }

    /// The next line, which stays the next one.
    pub fn peek(&self) -> Option<&'a str> {
        self.lines.clone().next()
    }

    /// The place of the line that was read last.
    pub fn here(&self) -> Place {
        Place { file: self.file, line: self.lines.number }
    }

    pub fn fault(&mut self, place: Place, found: impl Into<String>, expected: impl Into<String>) {
        self.files.fault(place, found, expected);
    }

    pub fn note(&mut self, weight: Weight, what: impl Into<String>, why: impl Into<String>, place: Place) {
        self.model.ledger.note(weight, what, why, place);
    }

    /// The number that a text is: a number, or the name of a parameter with or without a sign.
    pub fn value(&self, text: &str) -> Option<f64> {
        let text = text.trim();
        let plain = parse(text).filter(|value| value.is_finite() && text.bytes().any(|b| b.is_ascii_digit()));
        plain.or_else(|| {
            let (sign, name) = text.strip_prefix('-').map_or((1.0, text), |name| (-1.0, name));
            self.model.parameters.get(&name.trim().to_ascii_uppercase()).map(|value| sign * value)
        })
    }

    /// The number of an argument, zero where it is blank; none where it is no number, which is noted.
    pub fn real(&mut self, command: &Command<'_>, k: usize) -> Option<f64> {
        let text = command.arg(k);
        if text.is_empty() {
            return Some(0.0);
        }
        let value = self.value(text);
        if value.is_none() {
            let what = format!("`{}` of {}", shown(text), command.name);
            if text.bytes().next().is_some_and(|b| b.is_ascii_digit()) && !text.contains(['*', '/', '(', '^'])
            {
                self.fault(command.place, what, "a number");
            } else {
                let why = "an expression or a parameter that is not known: the command is not read";
                self.note(Weight::Matters, what, why, command.place);
            }
        }
        value
    }

    /// The whole number of an argument, zero where it is blank.
    pub fn whole(&mut self, command: &Command<'_>, k: usize) -> Option<i64> {
        let value = self.real(command, k)?;
        if value.fract() != 0.0 || value.abs() > 9e15 {
            self.fault(
                command.place,
                format!("`{}` of {}", shown(command.arg(k)), command.name),
                "a whole number",
            );
            return None;
        }
        Some(value as i64)
    }

    /// The number of a type, a material and the like.
    pub fn id(&mut self, command: &Command<'_>, k: usize) -> Option<u32> {
        let number = self.whole(command, k)?;
        let id = u32::try_from(number).ok().filter(|id| *id > 0);
        if id.is_none() {
            let found = format!("`{}` of {}", shown(command.arg(k)), command.name);
            self.fault(command.place, found, "a whole number above zero");
        }
        id
    }
}

/// A line without what stands in its columns 73 to 80 where an archive has a header of IGES: `S      1`.
fn without_header(line: &str) -> &str {
    match line.split_at_checked(72) {
        Some((text, mark)) if mark.len() == 8 => {
            let (letter, number) = mark.split_at_checked(1).unwrap_or(("", mark));
            let is_mark =
                matches!(letter, "S" | "G" | "T") && number.trim().bytes().all(|b| b.is_ascii_digit());
            if is_mark { text } else { line }
        }
        _ => line,
    }
}

/// Whether a text can be the name of a parameter.
fn is_name(text: &str) -> bool {
    let mut bytes = text.bytes();
    bytes.next().is_some_and(|b| b.is_ascii_alphabetic() || b == b'_')
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_')
}

/// A text for a message.
pub(super) fn shown(text: &str) -> String {
    text.trim().chars().take(40).collect()
}
