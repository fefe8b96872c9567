//! DMIG cards of NASTRAN: a matrix by grid points and components.
//!
//! The first card of a matrix has 0 as its second field, then its form (1 square, 2 or 9 rectangular, 6 symmetric), the kind of its numbers
//! (1, 2 real; 3, 4 complex) and whether these are amplitude and phase in degrees. Every other card is a column: grid point and component,
//! then, four fields each, grid point, component, and real and imaginary part of a row. An entry is given once; of a symmetric matrix it may be
//! above or below the diagonal. The component of a scalar point is 0 or blank. Source: MSC Nastran *Quick Reference Guide*, DMIG.

use super::found::{Entries, File, Found, Label, Triangles, Wrong, wanted};
use crate::c64;
use crate::matrix_market::{Lines, shown};
use std::collections::BTreeMap;
use stridor_base::error::Result;
use stridor_base::numbers;

/// A card: its fields after the name, each with its line.
struct Card<'f> {
    fields: Vec<(&'f [u8], usize)>,
    line: usize,
}

/// A matrix while its cards are read.
#[derive(Default)]
struct Matrix {
    entries: Entries,
    /// What its header says, and the line of it.
    form: Option<(Form, usize)>,
    /// Whether a header that is missing or wrong is a fault already.
    refused: bool,
}

#[derive(Debug, Clone, Copy)]
struct Form {
    triangles: Triangles,
    complex: bool,
    polar: bool,
}

/// What was found, and what is expected.
type Deviation = (String, &'static str);

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

/// The fields of a line after the first, and what follows: the tenth, a mark that the card goes on.
fn fields(line: &[u8], large: bool) -> (Vec<&[u8]>, Vec<&[u8]>) {
    let line = line.split(|byte| *byte == b'$').next().unwrap_or_default();
    let most = if large { 4 } else { 8 };
    let mut found: Vec<&[u8]> = if line.contains(&b',') {
        line.split(|byte| *byte == b',').skip(1).collect()
    } else {
        let body = line.get(8..72.min(line.len())).unwrap_or_default();
        body.chunks(if large { 16 } else { 8 }).collect()
    };
    found.iter_mut().for_each(|field| *field = field.trim_ascii());
    found.resize(found.len().max(most), b"");
    let mut rest = found.split_off(most);
    if !line.contains(&b',') {
        rest.push(line.get(72..80.min(line.len())).unwrap_or_default().trim_ascii());
    }
    (found, rest)
}

/// The cards called DMIG; a continuation without its card, and a last card that says that it goes on, are faults.
fn cards<'f>(file: &File<'f>, wrong: &mut Wrong) -> Vec<Card<'f>> {
    let mut cards: Vec<Card<'_>> = Vec::new();
    let (mut open, mut any) = (false, false);
    let mut cut = None;
    let mut lines = Lines::of(file.bytes);
    while let Some(line) = lines.next() {
        let line = line.trim_ascii_end();
        if line.is_empty() || line.starts_with(b"$") {
            continue;
        }
        let place = || format!("{}:{}", file.name, lines.number);
        let (name, large) = head(line);
        let goes_on = name.is_empty() || name.starts_with('+') || line.starts_with(b"*");
        if name == "DMIG" {
            cards.push(Card { fields: Vec::new(), line: lines.number });
        } else if goes_on && !any {
            wrong.push(place(), format!("`{}`", shown(line)), "a card before the line that continues it");
        }
        any = true;
        open = name == "DMIG" || open && goes_on;
        cut = None;
        if let Some(card) = cards.last_mut().filter(|_| open) {
            let large = large || line.starts_with(b"*");
            let (fields, rest) = fields(line, large);
            card.fields.extend(fields.into_iter().map(|field| (field, lines.number)));
            let goes_on =
                |mark: &[u8]| !line.contains(&b',') || mark.starts_with(b"+") || mark.starts_with(b"*");
            match rest.as_slice() {
                [] => {}
                [mark] if mark.is_empty() || goes_on(mark) => {
                    cut = (!mark.is_empty()).then(|| (place(), text(mark)));
                }
                rest if rest.iter().all(|field| field.is_empty()) => {}
                rest => {
                    let found = format!("`{}` after the last field", text(rest[0]));
                    wrong.push(
                        place(),
                        found,
                        "four large or eight small fields, then a mark such as + or nothing",
                    );
                }
            }
        }
    }
    if let Some((place, mark)) = cut {
        wrong.push(
            place,
            format!("`{mark}` in field 10 and the end of the file"),
            "the line that continues the card",
        );
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
        let node = self.field(k).parse().ok().filter(|node| *node > 0)?;
        Some((node, component.filter(|component| *component <= 6)?))
    }

    fn form(&self) -> Option<Form> {
        let number =
            |k: usize| if self.field(k).is_empty() { Some(0) } else { self.field(k).parse::<u8>().ok() };
        let (form, kind, polar) = (number(2)?, number(3)?, number(5)?);
        let triangles = match form {
            1 => Triangles::Both,
            2 | 9 => Triangles::Rectangular,
            6 => Triangles::Symmetric,
            _ => return None,
        };
        (1..=4).contains(&kind).then_some(Form { triangles, complex: kind > 2, polar: polar > 0 })
    }

    /// The entry of a row, whose four fields begin with field `k`.
    fn entry(&self, k: usize, form: Form) -> std::result::Result<(Label, c64), Deviation> {
        let shown = || {
            let words: Vec<&str> =
                (k..k + 4).map(|k| self.field(k)).filter(|word| !word.is_empty()).collect();
            format!("`{}`", shown(words.join(" ").as_bytes()))
        };
        let row = self.label(k).ok_or_else(|| (shown(), "a grid point and a component of a row"))?;
        let number = |k: usize| numbers::parse(self.field(k)).filter(|x| x.is_finite());
        let value = match (number(k + 2), number(k + 3)) {
            (Some(size), Some(degrees)) if form.complex && form.polar => {
                let phase = degrees.to_radians();
                c64::new(size * phase.cos(), size * phase.sin())
            }
            (Some(re), Some(im)) if form.complex => c64::new(re, im),
            (Some(re), im) if !form.complex && (self.field(k + 3).is_empty() || im == Some(0.0)) => {
                c64::new(re, 0.0)
            }
            _ if form.complex => return Err((shown(), "a grid point, a component, two finite numbers")),
            _ => return Err((shown(), "a grid point, a component, one finite number, a blank field")),
        };
        Ok((row, value))
    }

    /// The entries of a column, each with its line.
    fn column(&self, form: Form, entries: &mut Entries) -> Vec<(usize, Deviation)> {
        let quoted = |k: usize, other: usize| format!("`{}`, `{}`", self.field(k), self.field(other));
        let Some(column) = self.label(1) else {
            return vec![(self.line, (quoted(1, 2), "a grid point and a component of a column"))];
        };
        if !self.field(3).is_empty() {
            return vec![(self.line, (quoted(2, 3), "a blank field after the component of the column"))];
        }
        let mut wrong = Vec::new();
        let mut count = 0;
        for (first, four) in self.fields.chunks(4).enumerate().skip(1) {
            if four.iter().all(|(field, _)| field.is_empty()) {
                continue;
            }
            count += 1;
            match self.entry(4 * first, form) {
                Ok((row, value)) => entries.push(row, column, value, four[0].1),
                Err(deviation) => wrong.push((four[0].1, deviation)),
            }
        }
        if count == 0 {
            wrong.push((
                self.line,
                (format!("column {}, {} without rows", column.0, column.1), "at least one row"),
            ));
        }
        wrong
    }
}

/// A point has components 1 to 6, or none: the same point with both is a grid point one of whose components is missing.
fn mixed_components(file: &File, entries: &Entries, rectangular: bool, wrong: &mut Wrong) {
    let all = || entries.all.iter().zip(&entries.lines);
    if !all().any(|((row, column, _), _)| row.1 == 0 || column.1 == 0) {
        return;
    }
    let mut first: BTreeMap<i64, (u8, u32)> = BTreeMap::new();
    for ((row, column, _), line) in all() {
        for (node, component) in std::iter::once(row).chain(Some(column).filter(|_| !rectangular)) {
            let (other, before) = *first.entry(*node).or_insert((*component, *line));
            if (other == 0) != (*component == 0) {
                let found = format!("components {component} and, in line {before}, {other} of point {node}");
                wrong.push(
                    format!("{}:{line}", file.name),
                    found,
                    "1 to 6 of a grid point, 0 of a scalar point",
                );
            }
        }
    }
}

pub(super) fn read(file: &File) -> Result<Found> {
    let mut all: BTreeMap<String, Matrix> = BTreeMap::new();
    let mut wrong = Wrong::default();
    let place = |line: usize| format!("{}:{line}", file.name);
    let (headers, columns): (Vec<Card>, Vec<Card>) =
        cards(file, &mut wrong).into_iter().partition(|card| card.field(1) == "0");
    for card in headers {
        let matrix = all.entry(card.field(0).to_uppercase()).or_default();
        let Some(form) = card.form() else {
            let found = format!("form {} and kind {} of DMIG", card.field(2), card.field(3));
            wrong.push(place(card.line), found, "form 1, 2, 6 or 9, kind 1 to 4");
            matrix.refused = true;
            continue;
        };
        match matrix.form {
            Some((_, before)) => {
                let found = format!("a second header of {}, after line {before}", card.field(0));
                wrong.push(place(card.line), found, "one of each matrix");
            }
            None => matrix.form = Some((form, card.line)),
        }
    }
    for card in columns {
        let matrix = all.entry(card.field(0).to_uppercase()).or_default();
        let Some((form, _)) = matrix.form else {
            if !std::mem::replace(&mut matrix.refused, true) {
                let found = format!("a column of {}, which has no header", card.field(0));
                wrong.push(place(card.line), found, "a card `DMIG, NAME, 0, form, kind`");
            }
            continue;
        };
        for (line, (found, expected)) in card.column(form, &mut matrix.entries) {
            wrong.push(place(line), found, expected);
        }
    }
    std::mem::take(&mut wrong).into_result(file.name, ())?;
    let (name, Matrix { entries, form, .. }) = wanted(file.name, file.initial, all.into_iter().collect())?;
    let (form, line) = form.expect("columns without a header are a fault");
    if entries.all.is_empty() {
        wrong.push(place(line), format!("a header of {name} without columns"), "at least one column");
    }
    mixed_components(file, &entries, form.triangles == Triangles::Rectangular, &mut wrong);
    let matrix = entries.into_matrix(file, &name, form.triangles, form.complex, &mut wrong);
    wrong.into_result(file.name, Found::Labelled(matrix))
}
