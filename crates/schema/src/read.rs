//! Tables from TOML text: reading, then checking, with every fault of both at its line.

use super::check::{Report, check};
use super::defaults::set_defaults;
use super::keys::dotted;
use super::raw::word_of;
use super::reader::{TableReader, read_parts};
use super::value::Blank;
use super::{By, Key, Places, Presence, Slot, Table, TableSlot, Variants, Visitor};
use stridor_base::error::{Error, Fault, Faults, Result};

/// A table that was read, and where its keys stand.
pub struct ReadTable<T> {
    /// The table.
    pub table: T,
    /// Where its keys stand.
    pub places: Places,
}

/// Reads a table from TOML `text` and checks it; `file` names it in faults, which have no lines where it is empty.
///
/// # Errors
/// Every fault of the text, each with its line and key.
pub fn read_table<T: Table + Blank>(file: &str, text: &str) -> Result<ReadTable<T>> {
    let mut report = Report::default();
    let mut table = T::blank();
    let (places, mut faults) = read_parts(file, text, |root| {
        read_into(&mut table, root, &mut report);
        root.places()
    })?;
    check(&mut table, &mut report);
    faults.extend(report.faults.into_iter().map(|fault| match places.with_line(fault) {
        // What the outermost table lacks is missed from its first line on.
        (0, fault) if !file.is_empty() => {
            let place = fault.place.replacen(&format!("{file} "), &format!("{file}:1 "), 1);
            (1, Fault { place, ..fault })
        }
        located => located,
    }));
    faults.sort_by_key(|(line, _)| *line);
    let faults: Vec<_> = faults.into_iter().map(|(_, fault)| fault).collect();
    if faults.is_empty() { Ok(ReadTable { table, places }) } else { Err(Error::Input(Faults(faults))) }
}

impl TableReader<'_> {
    /// A declared table that stands here, checked; `more` checks what its declaration does not know.
    pub fn declared<T: Table + Blank>(&self, more: impl FnOnce(&T, &mut Report)) -> T {
        let (table, faults) = read_section(self, more);
        let path = format!("`{}.", self.path);
        for fault in faults {
            let key = fault.place.strip_prefix(&path).unwrap_or("").trim_end_matches('`');
            self.fault(key, fault.found.as_str(), fault.expected.as_str(), &fault.help);
        }
        table
    }
}

/// A table that stands in a section, with the faults of its checks; `more` checks what its declaration does not know.
fn read_section<T: Table + Blank>(
    section: &TableReader,
    more: impl FnOnce(&T, &mut Report),
) -> (T, Vec<Fault>) {
    let mut report = Report::at(section.path_of(""));
    let mut table = T::blank();
    read_into(&mut table, section, &mut report);
    check(&mut table, &mut report);
    more(&table, &mut report);
    (table, report.faults)
}

fn read_into(table: &mut dyn Table, section: &TableReader, report: &mut Report) {
    table.visit(&mut Reading { section, report });
}

struct Reading<'a, 'b> {
    section: &'a TableReader<'b>,
    report: &'a mut Report,
}

impl Reading<'_, '_> {
    /// Notes that `key` has no value that says anything.
    fn unread(&mut self, key: &str) {
        self.report.unread.insert(self.section.path_of(&dotted(key)));
    }

    fn missing(&mut self, key: &str, expected: &str) {
        self.section.fault(key, "nothing", expected, "");
        self.unread(key);
    }
}

impl Visitor for Reading<'_, '_> {
    fn value(&mut self, key: Key, slot: &mut dyn Slot) {
        let Some(value) = self.section.get(key.name) else {
            if !slot.set_default() {
                self.missing(key.name, &slot.about().expected);
            }
            return;
        };
        if let Err(found) = slot.read(value.get_ref()) {
            self.section.fault(key.name, found, slot.about().expected.as_ref(), "");
            self.unread(key.name);
        }
        let given = slot.about().units.given.take();
        if !given.is_empty() {
            self.report.given.insert(self.section.path_of(&dotted(key.name)), given);
        }
    }

    fn table(&mut self, key: Key, slot: &mut dyn TableSlot) {
        let (section, report) = (self.section, &mut *self.report);
        let read = match (slot.presence(), section.has(key.name)) {
            (Presence::Named, _) => {
                section.named(key.name, |name, s| read_into(slot.make(name), s, report)).is_some()
            }
            (_, true) => section.section(key.name, |s| read_into(slot.make(""), s, report)).is_some(),
            (presence, false) => {
                section.skip(&[key.name]);
                match presence {
                    Presence::Required(expected) => return self.missing(key.name, expected),
                    Presence::Always => slot.each(&mut |_, table| set_defaults(table)),
                    Presence::Optional | Presence::Named => {}
                }
                true
            }
        };
        if !read {
            self.unread(key.name);
        }
    }

    fn variants(&mut self, variants: &Variants, _: usize, visit: &mut dyn FnMut(usize, &mut dyn Visitor)) {
        let words = variants.each.iter().map(|(word, _)| *word);
        let chosen = match variants.by {
            By::Tag(tag) => match self.section.get(tag) {
                None => variants.default.ok_or((tag, "nothing".to_string())),
                Some(value) => {
                    let indices: Vec<(&str, usize)> = words.clone().zip(0..).collect();
                    word_of(value.get_ref(), &indices).map_err(|found| (tag, found))
                }
            },
            By::Presence => {
                let present: Vec<usize> =
                    (0..variants.each.len()).filter(|k| self.section.has(variants.each[*k].0)).collect();
                let word = |k: usize| variants.each[k].0;
                match present[..] {
                    [] => variants.default.ok_or((word(0), "nothing".to_string())),
                    [k] => Ok(k),
                    [first, second, ..] => {
                        Err((word(second), format!("both `{}` and `{}`", word(first), word(second))))
                    }
                }
            }
        };
        match chosen {
            Ok(k) => visit(k, self),
            Err((key, found)) => {
                let list = words.collect::<Vec<_>>().join(", ");
                let expected = match variants.by {
                    By::Tag(_) => format!("one of {list}"),
                    By::Presence if found == "nothing" => format!("one of the keys {list}"),
                    By::Presence => "one of them".into(),
                };
                self.section.fault(key, found, expected, "");
                self.unread(if variants.by == By::Presence { variants.each[0].0 } else { key });
                for k in 0..variants.each.len() {
                    visit(k, &mut Known(self.section));
                }
            }
        }
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }

    fn free_keys(&mut self, is_key: fn(&str) -> bool, expected: &str) -> Option<Vec<String>> {
        let names = self.section.names();
        for name in names.iter().filter(|name| !is_key(name)) {
            self.section.fault(name, format!("the name {name:?}"), expected, "");
        }
        Some(names)
    }
}

/// Names the keys of a table without reading them.
struct Known<'a, 'b>(&'a TableReader<'b>);

impl Visitor for Known<'_, '_> {
    fn value(&mut self, key: Key, _: &mut dyn Slot) {
        self.0.skip(&[key.name]);
    }

    fn table(&mut self, key: Key, _: &mut dyn TableSlot) {
        self.0.skip(&[key.name]);
    }

    fn variants(&mut self, variants: &Variants, _: usize, visit: &mut dyn FnMut(usize, &mut dyn Visitor)) {
        if let By::Tag(tag) = variants.by {
            self.0.skip(&[tag]);
        }
        (0..variants.each.len()).for_each(|k| visit(k, self));
    }

    fn flat(&mut self, table: &mut dyn Table) {
        table.visit(self);
    }
}
