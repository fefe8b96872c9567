//! The files of a deck: executive and case control, bulk data, INCLUDE, comments.

use super::bulk::Bulk;
use super::card::{Card, Line, LineKind};
use super::control::Control;
use super::names::Names;
use super::notes::Notes;
use super::repeat::{self, Asked, Repeat};
use crate::deck::Place;
use crate::ledger::Weight;
use std::path::{Path, PathBuf};
use stridor_base::error::{Error, Result};

/// What is read of a deck.
pub(super) struct Source<'a, 'n> {
    pub notes: &'a mut Notes<'n>,
    pub control: Control,
    pub names: Names,
    pub bulk: Bulk,
    card: Card,
    /// What changes in cards that repeat the one before them, and how many more may.
    changes: Repeat,
    may_repeat: u64,
    section: Section,
    /// The first file.
    first: PathBuf,
    /// Files that were read.
    known: Vec<PathBuf>,
    /// How many of these are open.
    depth: usize,
}

/// The section of a deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Executive,
    Case,
    Bulk,
    /// The bulk data of a superelement.
    Superelement,
    End,
}

/// The most cards that are repeated ones.
const MOST_REPEATED: u64 = 100_000;
/// The most files that include each other.
const DEEPEST: usize = 50;

impl<'a, 'n> Source<'a, 'n> {
    /// Reads the deck in a file.
    pub fn read(path: &Path, notes: &'a mut Notes<'n>) -> Result<Self> {
        let (file, text) = notes.files.read(path)?;
        notes.members_left += 4 * text.len();
        let mut source = Source {
            notes,
            control: Control::default(),
            names: Names::default(),
            bulk: Bulk::default(),
            card: Card::default(),
            changes: Repeat::default(),
            may_repeat: MOST_REPEATED,
            section: first_section(&text),
            first: path.to_path_buf(),
            known: vec![real_path(path)],
            depth: 1,
        };
        source.text(path, file, &text);
        source.end_card();
        if matches!(source.section, Section::Executive | Section::Case) {
            let place = Place { file, line: text.lines().count() as u32 };
            source.notes.files.fault(
                place,
                "the end of a deck without BEGIN BULK",
                "BEGIN BULK before the bulk data",
            );
        }
        Ok(source)
    }

    fn text(&mut self, path: &Path, file: u32, text: &str) {
        let mut lines = text.lines().zip(1..);
        while let Some((line, number)) = lines.next() {
            let place = Place { file, line: number };
            if self.section == Section::End || self.notes.files.too_many() {
                return;
            }
            if let Some(rest) = included(line) {
                // Its name may be on several lines.
                let mut name = rest.trim().to_string();
                let quote = name.chars().next().filter(|c| "'\"".contains(*c));
                while quote.is_some_and(|quote| name.matches(quote).count() < 2) {
                    let Some((more, _)) = lines.next() else { break };
                    name.push_str(more.trim());
                }
                self.include(path, &name, place);
                continue;
            }
            match line.split_once('$') {
                Some((before, comment)) => {
                    self.line(before, place);
                    if self.section == Section::Bulk {
                        self.names.comment(comment);
                    }
                }
                None => self.line(line, place),
            }
        }
    }

    fn line(&mut self, line: &str, place: Place) {
        if line.trim().is_empty() {
            return;
        }
        let upper = line.trim().to_ascii_uppercase();
        let mut words = upper.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        let (first, rest) = (words.next().unwrap_or_default(), words.collect::<Vec<_>>());
        match self.section {
            Section::Executive if first == "CEND" => self.section = Section::Case,
            _ if first == "BEGIN" => {
                self.end_card();
                self.begin(&rest, place);
            }
            Section::Executive => Control::executive(&upper, place, self.notes),
            Section::Case if first == "PARAM" => self.bulk_line(line, place),
            Section::Case => {
                self.end_card();
                self.control.case(line.trim(), place, self.notes);
            }
            Section::Bulk if upper.starts_with("ENDDATA") => {
                self.end_card();
                self.section = Section::End;
            }
            Section::Bulk => self.bulk_line(line, place),
            Section::Superelement if upper.starts_with("ENDDATA") => self.section = Section::End,
            Section::Superelement | Section::End => {}
        }
    }

    /// BEGIN BULK, BEGIN SUPER=n.
    fn begin(&mut self, words: &[&str], place: Place) {
        let words = words.join(" ").replace(' ', "");
        let own = words.is_empty() || words == "BULK" || words.ends_with("SUPER=0");
        self.section = if own { Section::Bulk } else { Section::Superelement };
        if !own {
            let what = format!("BEGIN {words}");
            self.notes.ledger.note(
                Weight::Matters,
                what,
                "the bulk data of a part of its own is not read",
                place,
            );
        }
    }

    fn bulk_line(&mut self, text: &str, place: Place) {
        let (line, cut) = Line::of(text);
        if cut {
            let why = "what stands past column 80 is not read";
            self.notes.ledger.note(Weight::Perhaps, "lines", why, place);
        }
        match line.kind(&self.card) {
            LineKind::First(name) => {
                self.end_card();
                self.card.begin(name, place);
                self.card.add(&line, place);
            }
            LineKind::Next if self.card.name.is_empty() => {
                let expected = "the first line of a card, which begins with its name";
                self.notes.files.fault(
                    place,
                    "a line that goes on with a card, where none is before it",
                    expected,
                );
            }
            LineKind::Next => self.card.add(&line, place),
            LineKind::Repeat => self.repeat(&line, place),
            LineKind::Bad(head) if head.starts_with("-CONT-") => {
                let help = "Results are no model: give the deck that they belong to";
                self.notes.files.fault_with_help(place, "a punch file of results", "bulk data", help);
            }
            LineKind::Bad(head) => {
                let expected = "the name of a card, or blanks, `+`, `*` or a comma where a line goes on";
                self.notes.files.fault(place, format!("`{head}` in the first field"), expected);
            }
        }
    }

    /// A line that repeats the card before it.
    fn repeat(&mut self, line: &Line, place: Place) {
        let asked = repeat::read(line);
        let times = match asked {
            Some(Asked::Once(changes)) => {
                self.changes = changes;
                1
            }
            Some(Asked::More(times)) => times,
            None => 0,
        };
        if times == 0 || times > self.may_repeat || self.card.name.is_empty() {
            let found = format!("`{}` in the first field", line.head());
            let expected = format!(
                "`=` with changes of the card before it, or `=(n)`; {MOST_REPEATED} cards in all at most"
            );
            self.notes.files.fault(place, found, expected);
            return;
        }
        self.may_repeat -= times;
        for _ in 0..times {
            let Some(next) = self.changes.next(&self.card, place) else {
                self.notes.files.fault(
                    place,
                    "a number that is added to a field that has none",
                    "a field with a number",
                );
                return;
            };
            self.end_card();
            self.card = next;
        }
    }

    fn end_card(&mut self) {
        if !self.card.name.is_empty() {
            self.bulk.card(&self.card, &mut self.names, self.notes);
            self.card.begin(String::new(), Place::default());
        }
    }

    fn include(&mut self, from: &Path, name: &str, place: Place) {
        let name = match name.chars().next() {
            Some(quote @ ('\'' | '"')) => {
                name.trim_start_matches(quote).split(quote).next().unwrap_or_default()
            }
            _ => name.split_whitespace().next().unwrap_or_default(),
        };
        let name = name.replace('\\', "/");
        if name.is_empty() {
            self.notes.files.fault(place, "INCLUDE without the name of a file", "INCLUDE 'file'");
            return;
        }
        let path = self.find(from, &name);
        let real = real_path(&path);
        if self.known.contains(&real) {
            let why = "a file that is included again is read once";
            self.notes.ledger.note(Weight::Nothing, "INCLUDE", why, place);
            return;
        }
        if self.depth >= DEEPEST {
            self.notes.files.fault(
                place,
                format!("{} files that include each other", self.depth),
                format!("{DEEPEST} at most"),
            );
            return;
        }
        let (file, text) = match self.notes.files.read(&path) {
            Ok(read) => read,
            Err(error) => {
                let help = match name.find(':').is_some_and(|at| at > 1) {
                    true => {
                        "The name before the colon stands for a folder: set an environment variable of this name to it"
                    }
                    false => {
                        "A path is relative to the folder of the file that includes it, or of the first file"
                    }
                };
                let why = match &error {
                    Error::Input(faults) => {
                        faults.0.first().map(|fault| fault.found.clone()).unwrap_or_default()
                    }
                    other => other.to_string(),
                };
                let found = format!("INCLUDE of \"{}\": {why}", path.display());
                self.notes.files.fault_with_help(place, found, "a file that can be read", help);
                return;
            }
        };
        self.notes.members_left += 4 * text.len();
        self.known.push(real);
        self.depth += 1;
        self.text(&path, file, &text);
        self.depth -= 1;
    }
}

impl Source<'_, '_> {
    /// The file that INCLUDE names: in the folder of the file that includes it, or of the first one, or in that of an environment variable.
    fn find(&self, from: &Path, name: &str) -> PathBuf {
        let folder = |path: &Path| path.parent().unwrap_or(Path::new("")).to_path_buf();
        let symbol = name.split_once(':').filter(|(symbol, _)| symbol.len() > 1);
        if let Some((value, rest)) = symbol.and_then(|(symbol, rest)| Some((std::env::var_os(symbol)?, rest)))
        {
            return PathBuf::from(value).join(rest);
        }
        let near = folder(from).join(name);
        let first = folder(&self.first).join(name);
        if !near.exists() && first.exists() { first } else { near }
    }
}

/// What follows INCLUDE.
fn included(line: &str) -> Option<&str> {
    let line = line.trim();
    let (word, rest) = (line.get(..7)?, line.get(7..)?);
    let is = word.eq_ignore_ascii_case("INCLUDE") && rest.starts_with([' ', '\t', '\'', '"', ',']);
    is.then(|| rest.trim_start_matches(','))
}

fn real_path(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())
}

/// Where a file begins: with executive control, or with bulk data as punch files and parts of decks do.
fn first_section(text: &str) -> Section {
    let control = |line: &str| {
        let line = line.trim().to_ascii_uppercase();
        let mut words = line.split(|c: char| c.is_whitespace() || "=,$".contains(c));
        match words.next() {
            Some("BEGIN" | "CEND" | "SOL") => true,
            Some("SUBCASE") => words.next().is_some(),
            _ => false,
        }
    };
    if text.lines().any(control) { Section::Executive } else { Section::Bulk }
}
