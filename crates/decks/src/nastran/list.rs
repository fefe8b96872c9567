//! Lists of numbers: `1, 2, 5, THRU, 20, BY, 3, EXCEPT, 8`.

use super::fields::{Fields, integer};
use super::notes::Notes;
use super::table::Table;
use crate::deck::Place;

/// A part of a list.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Ids {
    One(u64),
    /// Those from one to another that there are.
    Range(Box<Range>),
    All,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Range {
    first: u64,
    last: u64,
    step: u64,
    except: Vec<u64>,
}

/// The list in the fields from `first` to `last`.
pub(super) fn read(fields: &mut Fields, first: usize, last: usize) -> Vec<Ids> {
    let mut list: Vec<Ids> = Vec::new();
    let mut words = fields.words(first, last).into_iter().peekable();
    let mut excepting = false;
    let number = |text: &str| integer(text).and_then(|k| u64::try_from(k).ok()).filter(|k| *k > 0);
    while let Some((at, word)) = words.next() {
        let follows = words.peek().and_then(|(_, text)| number(text));
        match (word, number(word)) {
            (_, Some(id)) => match list.last_mut() {
                Some(Ids::Range(range)) if excepting && id <= range.last => range.except.push(id),
                _ => {
                    excepting = false;
                    list.push(Ids::One(id));
                }
            },
            ("ALL", _) if list.is_empty() => list.push(Ids::All),
            ("THRU", _) => match (list.last(), follows) {
                (Some(Ids::One(first)), Some(last)) => {
                    let range = Range { first: *first, last, step: 1, except: Vec::new() };
                    list.pop();
                    list.push(Ids::Range(Box::new(range)));
                    words.next();
                    excepting = false;
                }
                _ => fields.fault(
                    at,
                    format!("THRU of {}", fields.name()),
                    "a number before it and one behind it",
                ),
            },
            ("BY", _) => match (list.last_mut(), follows) {
                (Some(Ids::Range(range)), Some(step)) => {
                    range.step = step;
                    words.next();
                }
                _ => fields.fault(
                    at,
                    format!("BY of {}", fields.name()),
                    "a range before it and a number behind it",
                ),
            },
            ("EXCEPT", _) if matches!(list.last(), Some(Ids::Range(_))) => excepting = true,
            _ => {
                let found = format!("`{word}` in field {} of {}", at + 1, fields.name());
                fields.fault(at, found, "a number of 1 or more, THRU, BY or EXCEPT");
            }
        }
    }
    for ids in &mut list {
        if let Ids::Range(range) = ids {
            range.except.sort_unstable();
        }
    }
    list
}

/// Indices in a table of the members of a list, ascending; and numbers that are not in it, but those of ranges.
pub(super) fn members<T: PartialEq>(
    list: &[Ids],
    table: &Table<T>,
    place: Place,
    notes: &mut Notes,
) -> (Vec<usize>, Vec<u64>) {
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    let rows = table.rows();
    for ids in list {
        match ids {
            Ids::One(id) => match table.find(*id) {
                Some(at) => found.push(at),
                None => missing.push(*id),
            },
            Ids::All => found.extend(0..if notes.may_list(rows.len(), place) { rows.len() } else { 0 }),
            Ids::Range(range) => {
                let of = table.range(range.first, range.last);
                if notes.may_list(of.len(), place) {
                    found.extend(of.filter(|at| ids.spans(rows[*at].number)));
                }
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    (found, missing)
}

impl Ids {
    /// The first and the last number that may be of it.
    pub fn bounds(&self) -> (u64, u64) {
        match self {
            Ids::One(id) => (*id, *id),
            Ids::Range(range) => (range.first, range.last),
            Ids::All => (0, u64::MAX),
        }
    }

    /// Whether a number is of it.
    pub fn spans(&self, id: u64) -> bool {
        match self {
            Ids::One(own) => *own == id,
            Ids::All => true,
            Ids::Range(range) => {
                (range.first..=range.last).contains(&id)
                    && (id - range.first).is_multiple_of(range.step)
                    && range.except.binary_search(&id).is_err()
            }
        }
    }
}

/// Those from one number to another.
pub(super) fn range(first: u64, last: u64) -> Ids {
    Ids::Range(Box::new(Range { first, last, step: 1, except: Vec::new() }))
}
