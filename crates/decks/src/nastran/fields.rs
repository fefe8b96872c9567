//! Fields of a card as numbers and words. Every field that is not blank and was not asked for is noted.

use super::card::Card;
use super::notes::Notes;
use crate::deck::Place;
use crate::ledger::Weight;
use stridor_base::numbers;

/// A card that is read.
pub(super) struct Fields<'a, 'n> {
    card: &'a Card,
    taken: Vec<bool>,
    pub notes: &'a mut Notes<'n>,
}

impl<'a, 'n> Fields<'a, 'n> {
    pub fn of(card: &'a Card, notes: &'a mut Notes<'n>) -> Self {
        Fields { card, taken: vec![false; card.fields().count()], notes }
    }

    pub fn name(&self) -> &'a str {
        &self.card.name
    }

    pub fn place(&self) -> Place {
        self.card.place
    }

    /// The number of the last field that is not blank.
    pub fn last(&self) -> usize {
        self.card.last()
    }

    pub fn is_blank(&self, number: usize) -> bool {
        self.card.find(number).is_none()
    }

    /// The text of a field, empty where it is blank.
    pub fn word(&mut self, number: usize) -> &'a str {
        let Some((at, text)) = self.card.find(number) else { return "" };
        self.taken[at] = true;
        text
    }

    /// Fields that are not blank from `first` to `last`.
    pub fn words(&mut self, first: usize, last: usize) -> Vec<(usize, &'a str)> {
        let (start, words) = self.card.between(first, last);
        self.taken[start..start + words.len()].fill(true);
        words
    }

    /// Notes a fault at a field.
    pub fn fault(&mut self, number: usize, found: impl Into<String>, expected: impl Into<String>) {
        self.notes.files.fault(self.card.place_of(number), found, expected);
    }

    /// Notes what is not read of the card.
    pub fn note(&mut self, weight: Weight, why: impl Into<String>) {
        self.notes.ledger.note(weight, self.card.name.as_str(), why, self.card.place);
    }

    fn wrong(&mut self, number: usize, text: &str, expected: &str) {
        let found = match text {
            "" => format!("{} without field {}", self.card.name, number + 1),
            _ => format!("`{text}` in field {} of {}", number + 1, self.card.name),
        };
        self.fault(number, found, expected);
    }

    /// A number of a thing, at least 1.
    pub fn id(&mut self, number: usize) -> Option<u64> {
        let text = self.word(number);
        let id = integer(text).and_then(|k| u64::try_from(k).ok()).filter(|id| *id > 0);
        if id.is_none() {
            self.wrong(number, text, "a number of 1 or more");
        }
        id
    }

    /// The same, where a blank field is `default`; zero may be written.
    pub fn id_or(&mut self, number: usize, default: u64) -> Option<u64> {
        let text = self.word(number);
        if text.is_empty() {
            return Some(default);
        }
        let id = integer(text).and_then(|k| u64::try_from(k).ok());
        if id.is_none() {
            self.wrong(number, text, "a whole number that is not negative");
        }
        id
    }

    /// A whole number.
    pub fn integer_or(&mut self, number: usize, default: i64) -> Option<i64> {
        let text = self.word(number);
        if text.is_empty() {
            return Some(default);
        }
        let value = integer(text);
        if value.is_none() {
            self.wrong(number, text, "a whole number");
        }
        value
    }

    /// A real number.
    pub fn real(&mut self, number: usize) -> Option<f64> {
        let text = self.word(number);
        let value = real(text);
        if value.is_none() {
            self.wrong(number, text, "a finite number");
        }
        value
    }

    /// The same, where a blank field is `default`.
    pub fn real_or(&mut self, number: usize, default: f64) -> Option<f64> {
        if self.is_blank(number) { Some(default) } else { self.real(number) }
    }

    /// A real number, or none where the field is blank.
    pub fn real_if(&mut self, number: usize) -> Option<Option<f64>> {
        if self.is_blank(number) { Some(None) } else { self.real(number).map(Some) }
    }

    /// Three of them; blank fields are zero.
    pub fn vector(&mut self, first: usize) -> Option<[f64; 3]> {
        let [x, y, z] = [0, 1, 2].map(|k| self.real_or(first + k, 0.0));
        Some([x?, y?, z?])
    }

    /// A symmetric matrix of six by the rows of its upper or lower triangle.
    pub fn symmetric(&mut self, first: usize, upper: bool) -> Option<[[f64; 6]; 6]> {
        let mut matrix = [[0.0; 6]; 6];
        let all = (0..6).flat_map(|i| (0..6).map(move |j| (i, j)));
        for (number, (i, j)) in (first..).zip(all.filter(|(i, j)| if upper { i <= j } else { i >= j })) {
            let value = self.real_or(number, 0.0)?;
            (matrix[i][j], matrix[j][i]) = (value, value);
        }
        Some(matrix)
    }

    /// Degrees of freedom: digits of 1 to 6 in any order.
    pub fn components(&mut self, number: usize) -> Option<[bool; 6]> {
        let text = self.word(number);
        let found = components(text);
        if found.is_none() {
            self.wrong(number, text, "degrees of freedom: digits of 1 to 6");
        }
        found
    }

    /// Notes what is not blank of these fields, with a reason.
    pub fn unread(&mut self, first: usize, last: usize, weight: Weight, why: &str) {
        let zero = |text: &str| real(text) == Some(0.0);
        if self.words(first, last).iter().any(|(_, text)| !zero(text)) {
            self.note(weight, why);
        }
    }

    /// Notes every field that nobody asked for.
    pub fn end(self) {
        let card = self.card;
        for ((number, _), _) in card.fields().zip(&self.taken).filter(|(_, taken)| !**taken) {
            let why = match number {
                1..=40 => format!("field {} is not read", number + 1),
                _ => "fields past the fifth line are not read".into(),
            };
            self.notes.ledger.note(Weight::Perhaps, card.name.as_str(), why, card.place_of(number));
        }
    }
}

/// A whole number as a field has it.
pub(super) fn integer(text: &str) -> Option<i64> {
    text.strip_prefix('+').unwrap_or(text).parse().ok()
}

/// A finite real number as a field has it.
pub(super) fn real(text: &str) -> Option<f64> {
    numbers::parse(text).filter(|value| value.is_finite())
}

/// Degrees of freedom as digits of 1 to 6; none of them is `0`.
pub(super) fn components(text: &str) -> Option<[bool; 6]> {
    let mut held = [false; 6];
    for digit in text.bytes() {
        match digit {
            b'1'..=b'6' => held[usize::from(digit - b'1')] = true,
            b'0' => {}
            _ => return None,
        }
    }
    Some(held).filter(|_| !text.is_empty())
}
