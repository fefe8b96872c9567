//! Cards that repeat the one before them with other numbers: `=, *(1), =, *(0.5), ==`, then `=(8)` for eight more.
//!
//! `=` keeps a field, `==` all that follow, `*(x)` adds x to it; other fields are as they stand.

use super::card::{Card, Line};
use super::fields::{integer, real};
use crate::deck::Place;

/// What changes from a card to the next.
#[derive(Debug, Default)]
pub(super) struct Repeat {
    changes: Vec<(usize, Change)>,
    /// Fields from here on are kept.
    rest: Option<usize>,
}

#[derive(Debug)]
enum Change {
    Keep,
    Add(String),
    Is(String),
}

/// What a line asks for.
pub(super) enum Asked {
    /// A card with changes.
    Once(Repeat),
    /// So many more with the changes of the one before.
    More(u64),
}

/// The number in `*(x)`, `*x`, `=(n)` or `=n`.
fn inner(text: &str) -> &str {
    let text = &text[1..];
    text.strip_prefix('(').and_then(|text| text.strip_suffix(')')).unwrap_or(text)
}

/// A line whose first field begins with `=`; none where that is neither.
pub(super) fn read(line: &Line) -> Option<Asked> {
    let head = line.head();
    if head != "=" {
        return inner(head).parse().ok().map(Asked::More);
    }
    let mut fields = Card::default();
    fields.begin("=".into(), Place::default());
    fields.add(line, Place::default());
    let mut repeat = Repeat::default();
    for (number, text) in fields.fields() {
        match text {
            "=" => repeat.changes.push((number, Change::Keep)),
            "==" => repeat.rest = Some(number),
            _ if text.starts_with('*') => repeat.changes.push((number, Change::Add(inner(text).into()))),
            _ => repeat.changes.push((number, Change::Is(text.into()))),
        }
    }
    Some(Asked::Once(repeat))
}

impl Repeat {
    /// The card that follows; none where a number is to be added to what is none.
    pub fn next(&self, card: &Card, place: Place) -> Option<Card> {
        let mut next = Card::default();
        next.begin(card.name.clone(), place);
        let field = |number: usize| card.find(number).map_or("", |(_, text)| text);
        for (number, change) in &self.changes {
            let old = field(*number);
            let new = match change {
                Change::Keep => old.to_string(),
                Change::Is(text) => text.clone(),
                Change::Add(step) => match (integer(old), integer(step)) {
                    (Some(old), Some(step)) => old.checked_add(step)?.to_string(),
                    _ => format!("{:?}", real(old)? + real(step)?),
                },
            };
            next.append(*number, &new, place);
        }
        if let Some(rest) = self.rest {
            for (number, text) in card.fields().filter(|(number, _)| *number >= rest) {
                next.append(number, text, place);
            }
        }
        Some(next)
    }
}
