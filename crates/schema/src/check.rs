//! Conditions on values, and between them.

use super::keys::dotted;
use super::{Key, Slot, Table, TableSlot, Variants, Visitor};
use std::collections::{BTreeMap, BTreeSet};
use stridor_base::error::Fault;

/// Faults of a table, each at the path of its key.
#[derive(Debug, Default)]
pub struct Report {
    path: String,
    /// Faults; the place is the path of a key in back-ticks.
    pub(super) faults: Vec<Fault>,
    /// Paths of keys that could not be read, or are absent though they must be there.
    pub(super) unread: BTreeSet<String>,
    /// Strings that were read in any unit, by path, with their entry of the list.
    pub(super) given: BTreeMap<String, Vec<(usize, String)>>,
}

impl Report {
    /// An empty report of the table at `path`.
    pub fn at(path: String) -> Report {
        Report { path, ..Report::default() }
    }

    /// Notes a fault of `key`, which may be the path of a key below this table.
    pub fn fault(&mut self, key: &str, found: impl Into<String>, expected: impl Into<String>, help: &str) {
        let place = format!("`{}`", self.path_of(key));
        self.faults.push(Fault::new(place, found, expected).with_help(help));
    }

    /// The faults, each at the path of its key in back-ticks.
    pub fn into_faults(self) -> Vec<Fault> {
        self.faults
    }

    /// The path of `key` in this table.
    pub fn path_of(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", _) => key.to_string(),
            (path, "") => path.to_string(),
            (path, _) => format!("{path}.{key}"),
        }
    }

    /// Whether `key` or what is below it could not be read, so that nothing can be said of its value.
    pub fn unread(&self, key: &str) -> bool {
        let path = self.path_of(key);
        let below = |other: &String| other.strip_prefix(&path).is_some_and(|rest| rest.starts_with('.'));
        self.unread.contains(&path) || self.unread.iter().any(below)
    }

    /// Whether the value of `key` could not be read, or is absent though it must be there.
    pub fn unread_itself(&self, key: &str) -> bool {
        self.unread.contains(&self.path_of(key))
    }

    /// Whether everything was read and nothing is wrong so far, but for what is in the tables `but`.
    pub fn is_sound(&self, but: &[&str]) -> bool {
        let beside = |path: &str| but.contains(&path.split('.').next().unwrap_or(path));
        let place = |fault: &Fault| beside(fault.place.trim_matches('`'));
        self.faults.iter().all(place) && self.unread.iter().all(|path| beside(path))
    }

    /// The strings that `key` was given in whatever unit, with their entry of the list.
    pub fn given(&self, key: &str) -> Vec<(usize, String)> {
        self.given.get(&self.path_of(key)).cloned().unwrap_or_default()
    }
}

struct Checking<'a> {
    report: &'a mut Report,
    /// Whether all values of this table were read.
    whole: bool,
}

/// Checks every value of `table` by itself, then every table.
pub fn check(table: &mut dyn Table, report: &mut Report) {
    let mut checking = Checking { report, whole: true };
    table.visit(&mut checking);
    let whole = checking.whole;
    // The outermost table names others in other tables, whatever is wrong with its own values.
    if whole || report.path.is_empty() {
        table.check(report);
    }
}

impl Visitor for Checking<'_> {
    fn value(&mut self, key: Key, slot: &mut dyn Slot) {
        let name = dotted(key.name);
        if self.report.unread.contains(&self.report.path_of(&name)) {
            self.whole = false;
            return;
        }
        for (found, expected) in slot.faults() {
            self.report.fault(&name, found, expected, "");
        }
    }

    fn table(&mut self, key: Key, slot: &mut dyn TableSlot) {
        let outer = self.report.path.clone();
        let path = self.report.path_of(&dotted(key.name));
        // A table that is missing is one fault.
        if self.report.unread.contains(&path) {
            return;
        }
        slot.each(&mut |name, table| {
            self.report.path = name.map_or(path.clone(), |name| format!("{path}.{}", dotted(name)));
            check(table, self.report);
        });
        self.report.path = outer;
    }

    fn variants(
        &mut self,
        variants: &Variants,
        current: usize,
        visit: &mut dyn FnMut(usize, &mut dyn Visitor),
    ) {
        let key = match variants.by {
            super::By::Tag(tag) => tag,
            super::By::Presence => variants.each[0].0,
        };
        if self.report.unread.contains(&self.report.path_of(key)) {
            self.whole = false;
            return;
        }
        visit(current, self);
    }

    fn flat(&mut self, table: &mut dyn Table) {
        let mut checking = Checking { report: &mut *self.report, whole: true };
        table.visit(&mut checking);
        let whole = checking.whole;
        self.whole &= whole;
        if whole {
            table.check(self.report);
        }
    }
}
