//! What of a file was read in part, or not at all.

use crate::place::Place;
use std::collections::BTreeMap;

/// What was not read, each kind once with its first place and how often it stands there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ledger {
    entries: BTreeMap<(Weight, String, String), Entry>,
}

/// What a thing that was not read means for vibrations and squeal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// The model is another one without it.
    Matters,
    /// It may change the steady state, or it is taken as the nearest thing that is known.
    Perhaps,
    /// Output, loads of other steps, heat: nothing of the vibrations.
    Nothing,
}

impl Weight {
    /// `matters`, `perhaps` or `no`.
    pub fn word(self) -> &'static str {
        match self {
            Weight::Matters => "matters",
            Weight::Perhaps => "perhaps",
            Weight::Nothing => "no",
        }
    }
}

/// How often and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Entry {
    first: Place,
    count: usize,
}

/// A row of the ledger.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unread<'a> {
    /// The keyword, card or option.
    pub what: &'a str,
    /// What is missing, or what was taken instead.
    pub why: &'a str,
    /// What that means.
    pub weight: Weight,
    /// The first place.
    pub first: Place,
    /// How often.
    pub count: usize,
}

impl Ledger {
    /// Notes something that was not read, or not as it stands.
    pub fn note(&mut self, weight: Weight, what: impl Into<String>, why: impl Into<String>, place: Place) {
        let entry = self.entries.entry((weight, what.into(), why.into()));
        let entry = entry.or_insert(Entry { first: place, count: 0 });
        entry.count += 1;
        entry.first = entry.first.min(place);
    }

    /// All rows: what matters first, then by name.
    pub fn rows(&self) -> impl Iterator<Item = Unread<'_>> {
        self.entries.iter().map(|((weight, what, why), entry)| Unread {
            what,
            why,
            weight: *weight,
            first: entry.first,
            count: entry.count,
        })
    }
}
