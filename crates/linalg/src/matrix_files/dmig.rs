//! DMIG cards of NASTRAN: a matrix by grid points and components.
//!
//! The first card of a matrix has 0 as its second field, then its form (1 square, 2 or 9 rectangular, 6 symmetric), the kind of its numbers
//! (1, 2 real; 3, 4 complex) and whether these are amplitude and phase in degrees. Every other card is a column: grid point and component,
//! then, four fields each, grid point, component, and real and imaginary part of a row. Source: MSC Nastran *Quick Reference Guide*, DMIG.

use super::found::{File, Found, Label, Labelled, Wrong, wanted};
use crate::c64;
use crate::matrix_market::{Lines, shown};
use std::collections::BTreeMap;
use stridor_base::error::{Error, Fault, Result};
use stridor_base::numbers;

/// A card: its fields after the name, each with its line.
struct Card<'f> {
    fields: Vec<(&'f [u8], usize)>,
    line: usize,
}

/// A matrix while its cards are read.
#[derive(Default)]
struct Matrix {
    entries: Vec<(Label, Label, c64)>,
    form: Option<Form>,
}

#[derive(Debug, Clone, Copy)]
struct Form {
    rectangular: bool,
    complex: bool,
    polar: bool,
}

/// The name of the card in the first field of a line, without the mark of large fields; empty where it is blank.
fn head(line: &[u8]) -> (String, bool) {
    let free = line.iter().position(|byte| *byte == b',').filter(|at| *at <= 8);
    let first =
        String::from_utf8_lossy(&line[..free.unwrap_or(line.len()).min(8)]).trim().to_ascii_uppercase();
    let name = first.split_whitespace().next().unwrap_or_default();
    (name.trim_end_matches('*').to_string(), name.ends_with('*'))
}

pub(super) fn is(bytes: &[u8]) -> bool {
    let mut lines = Lines::of(bytes);
    std::iter::from_fn(|| lines.next()).any(|line| line.len() > 4 && head(line).0 == "DMIG")
}

/// The fields of a line after the first.
fn fields(line: &[u8], large: bool) -> Vec<&[u8]> {
    let line = line.split(|byte| *byte == b'$').next().unwrap_or_default();
    let most = if large { 4 } else { 8 };
    let mut found: Vec<&[u8]> = if line.contains(&b',') {
        line.split(|byte| *byte == b',').skip(1).take(most).collect()
    } else {
        let body = line.get(8..72.min(line.len())).unwrap_or_default();
        body.chunks(if large { 16 } else { 8 }).collect()
    };
    found.resize(most, b"");
    found.iter().map(|field| field.trim_ascii()).collect()
}

/// The cards called DMIG.
fn cards(bytes: &[u8]) -> Vec<Card<'_>> {
    let mut cards: Vec<Card<'_>> = Vec::new();
    let mut open = false;
    let mut lines = Lines::of(bytes);
    while let Some(line) = lines.next() {
        let line = line.trim_ascii_end();
        if line.is_empty() || line.starts_with(b"$") {
            continue;
        }
        let (name, large) = head(line);
        let goes_on = name.is_empty() || name.starts_with('+') || line.starts_with(b"*");
        if name == "DMIG" {
            cards.push(Card { fields: Vec::new(), line: lines.number });
        }
        open = name == "DMIG" || open && goes_on;
        if let Some(card) = cards.last_mut().filter(|_| open) {
            let large = large || line.starts_with(b"*");
            card.fields.extend(fields(line, large).into_iter().map(|field| (field, lines.number)));
        }
    }
    cards
}

fn text(field: &[u8]) -> &str {
    std::str::from_utf8(field).unwrap_or("?")
}

impl Card<'_> {
    fn field(&self, k: usize) -> &str {
        self.fields.get(k).map_or("", |(field, _)| text(field))
    }

    /// A node and a component, from a field on.
    fn label(&self, k: usize) -> Option<Label> {
        let component = self.field(k + 1);
        let component = if component.is_empty() { Some(0) } else { component.parse().ok() };
        Some((self.field(k).parse().ok()?, component.filter(|component| *component <= 6)?))
    }

    fn form(&self) -> Option<Form> {
        let number =
            |k: usize| if self.field(k).is_empty() { Some(0) } else { self.field(k).parse::<u8>().ok() };
        let (form, kind, polar) = (number(2)?, number(3)?, number(5)?);
        let known = matches!(form, 1 | 2 | 6 | 9) && (1..=4).contains(&kind);
        known.then_some(Form { rectangular: matches!(form, 2 | 9), complex: kind > 2, polar: polar > 0 })
    }
}

pub(super) fn read(file: &File) -> Result<Found> {
    let mut all: BTreeMap<String, Matrix> = BTreeMap::new();
    let mut wrong = Wrong::default();
    for card in cards(file.bytes) {
        let place = |line: usize| format!("{}:{line}", file.name);
        let matrix = all.entry(card.field(0).to_uppercase()).or_default();
        if card.field(1) == "0" {
            matrix.form = card.form();
            if matrix.form.is_none() {
                let found = format!("form {} and kind {} of DMIG", card.field(2), card.field(3));
                wrong.push(place(card.line), found, "form 1, 2, 6 or 9, kind 1 to 4");
            }
            continue;
        }
        let Some(column) = card.label(1) else {
            let found = format!("`{}`, `{}`", card.field(1), card.field(2));
            wrong.push(place(card.line), found, "a grid point and a component of a column");
            continue;
        };
        for (first, entry) in card.fields.chunks(4).enumerate().skip(1) {
            if entry.iter().all(|(field, _)| field.is_empty()) {
                continue;
            }
            let (k, line) = (4 * first, entry[0].1);
            let real = |k: usize| {
                let field = card.field(k);
                if field.is_empty() { Some(0.0) } else { numbers::parse(field).filter(|x| x.is_finite()) }
            };
            match (card.label(k), real(k + 2), real(k + 3)) {
                (Some(row), Some(re), Some(im)) => matrix.entries.push((row, column, c64::new(re, im))),
                _ => {
                    let words: Vec<&str> = entry.iter().map(|(field, _)| text(field)).collect();
                    let found = format!("`{}`", shown(words.join(" ").as_bytes()));
                    wrong.push(place(line), found, "a grid point, a component, one or two finite numbers");
                }
            }
        }
    }
    wrong.into_result(file.name, ())?;
    let (name, Matrix { mut entries, form }) = wanted(file.name, file.initial, all.into_iter().collect())?;
    let place = format!("{} {name}", file.name);
    let Some(form) = form else {
        let expected = "a card `DMIG, NAME, 0, form, kind`";
        return Err(Error::input(Fault::new(place, "columns alone", expected)));
    };
    if form.complex && form.polar {
        entries.iter_mut().for_each(|(.., z)| {
            *z = c64::new(z.re * z.im.to_radians().cos(), z.re * z.im.to_radians().sin())
        });
    }
    let Form { complex, rectangular, .. } = form;
    Ok(Found::Labelled(Labelled { entries, complex, rectangular, place }))
}
