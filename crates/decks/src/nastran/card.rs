//! A card of the bulk data, gathered from its lines: small, large or free fields.
//!
//! A line of *small* fields has ten of eight columns: the name, eight of data and the label of the line that continues it. A line of *large*
//! fields, whose name ends in `*` or which begins with it, has four of data of sixteen columns. A line with a comma is *free*: its fields are
//! between commas. A line goes on with the card before it where it begins with a blank field, `+`, `*` or a comma. Source: MSC Nastran Quick
//! Reference Guide, *Bulk data entries: Format*. A tab goes to the next column that is a multiple of eight.

use crate::deck::Place;

/// A card. Its fields of data are numbered from 1, eight a line of small fields.
#[derive(Debug, Default)]
pub(super) struct Card {
    pub name: String,
    pub place: Place,
    text: String,
    spans: Vec<Span>,
    /// The number of the first field of each line, and its place.
    lines: Vec<(u32, Place)>,
    /// The number of the first field of the line that follows.
    next: u32,
    /// Whether the last line ends in a comma.
    comma: bool,
}

/// A field that is not blank.
#[derive(Debug, Clone, Copy)]
struct Span {
    number: u32,
    start: u32,
    end: u32,
}

/// What a line of the bulk data is.
#[derive(Debug, PartialEq)]
pub(super) enum LineKind {
    /// The first of a card of this name.
    First(String),
    /// It goes on with the card before it.
    Next,
    /// It repeats the card before it with changes.
    Repeat,
    /// It begins as no line does.
    Bad(String),
}

/// A line of the bulk data without its comment: capital letters, no tabs, and one byte a character.
#[derive(Debug, Default)]
pub(super) struct Line {
    text: String,
    free: bool,
}

/// Columns of a line of fixed fields.
const COLUMNS: usize = 80;

impl Line {
    /// Whether columns past the last one are left out is the second value.
    pub fn of(text: &str) -> (Line, bool) {
        let free = text.contains(',');
        let mut line = Line { text: String::with_capacity(text.len().min(2 * COLUMNS)), free };
        let out = &mut line.text;
        let mut cut = false;
        for c in text.trim_end().chars() {
            if !free && out.len() >= COLUMNS {
                cut = cut || !c.is_whitespace();
                continue;
            }
            match c {
                '\t' if free => out.push(' '),
                '\t' => out.extend(std::iter::repeat_n(' ', 8 - out.len() % 8)),
                _ if c.is_ascii_graphic() => out.push(c.to_ascii_uppercase()),
                _ if c.is_whitespace() => out.push(' '),
                _ => out.push('?'),
            }
        }
        (line, cut)
    }

    fn columns(&self, first: usize, width: usize) -> &str {
        let end = (first + width).min(self.text.len());
        self.text.get(first..end).unwrap_or_default().trim()
    }

    /// Its first field.
    pub fn head(&self) -> &str {
        match self.free {
            true => self.text.split(',').next().unwrap_or_default().trim(),
            false => self.columns(0, 8),
        }
    }

    /// `previous` is the card before it.
    pub fn kind(&self, previous: &Card) -> LineKind {
        let head = self.head();
        match head.chars().next() {
            None | Some('+' | '*') => LineKind::Next,
            Some(c) if c.is_ascii_alphabetic() => {
                let name = head.split([' ', '*']).next().unwrap_or_default();
                LineKind::First(name.to_string())
            }
            Some('=') => LineKind::Repeat,
            Some(_) if self.free && previous.comma => LineKind::Next,
            Some(_) => LineKind::Bad(head.to_string()),
        }
    }
}

impl Card {
    /// Begins anew.
    pub fn begin(&mut self, name: String, place: Place) {
        let Card { text, spans, lines, .. } = self;
        text.clear();
        spans.clear();
        lines.clear();
        (self.name, self.place, self.next, self.comma) = (name, place, 1, false);
    }

    /// Adds the fields of a line.
    pub fn add(&mut self, line: &Line, place: Place) {
        let head = line.head();
        let first = self.lines.is_empty();
        let blanks = !line.free && first && head.contains(' ') && !head.ends_with('*');
        let large = if first { head.ends_with('*') } else { head.starts_with('*') };
        let width: u32 = if large { 4 } else { 8 };
        // Four large fields and four more are a line of small ones.
        let start = if large { self.next } else { (self.next - 1).div_ceil(8) * 8 + 1 };
        self.lines.push((start, place));
        self.comma = line.free && line.text.ends_with(',');
        let mut used = width;
        if line.free || blanks {
            let mut fields: Vec<&str> = if blanks {
                line.text.split_whitespace().collect()
            } else {
                line.text.split(',').map(str::trim).collect()
            };
            // A line that goes on after a comma may begin with data.
            if first || head.is_empty() || head.starts_with(['+', '*']) {
                fields.remove(0);
            }
            let width = width as usize;
            if fields.get(width).is_some_and(|field| is_label(field))
                && fields[width + 1..].iter().all(|f| f.is_empty())
            {
                fields.truncate(width);
            }
            // A list may be longer than a line.
            used = (fields.len() as u32).max(1).div_ceil(width as u32) * width as u32;
            for (k, field) in fields.iter().enumerate() {
                self.put(start.saturating_add(k as u32), field);
            }
        } else {
            let columns = if large { 16 } else { 8 };
            for k in 0..width {
                self.put(start.saturating_add(k), line.columns(8 + k as usize * columns, columns));
            }
        }
        self.next = start.saturating_add(used);
    }

    /// Adds a field behind the others, of a line.
    pub fn append(&mut self, number: usize, field: &str, place: Place) {
        if self.lines.is_empty() {
            self.lines.push((1, place));
        }
        self.put(number as u32, field);
        self.next = self.next.max(number as u32 / 8 * 8 + 9);
    }

    fn put(&mut self, number: u32, field: &str) {
        if !field.is_empty() {
            let start = self.text.len() as u32;
            self.text.push_str(field);
            self.spans.push(Span { number, start, end: self.text.len() as u32 });
        }
    }

    /// Its fields that are not blank: number and text.
    pub fn fields(&self) -> impl Iterator<Item = (usize, &str)> {
        self.spans.iter().map(|span| (span.number as usize, self.of(*span)))
    }

    /// Those from `first` to `last`: the place of the first of them, and number and text of each.
    pub fn between(&self, first: usize, last: usize) -> (usize, Vec<(usize, &str)>) {
        let start = self.spans.partition_point(|span| (span.number as usize) < first);
        let of = self.spans[start..].iter().take_while(|span| span.number as usize <= last);
        (start, of.map(|span| (span.number as usize, self.of(*span))).collect())
    }

    fn of(&self, span: Span) -> &str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// The place among the fields that are not blank of field `number`, and its text.
    pub fn find(&self, number: usize) -> Option<(usize, &str)> {
        let at = self.spans.binary_search_by_key(&(number as u32), |span| span.number).ok()?;
        Some((at, self.of(self.spans[at])))
    }

    /// The line of field `number`.
    pub fn place_of(&self, number: usize) -> Place {
        let at = self.lines.partition_point(|(first, _)| *first as usize <= number);
        self.lines.get(at.saturating_sub(1)).map_or(self.place, |(_, place)| *place)
    }

    /// The number of the last field that is not blank.
    pub fn last(&self) -> usize {
        self.spans.last().map_or(0, |span| span.number as usize)
    }
}

/// Whether the field after those of data is the label of the line that follows, and no more data.
fn is_label(field: &str) -> bool {
    field.is_empty() || field.starts_with(['+', '*']) || stridor_base::numbers::parse(field).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(lines: &[&str]) -> Vec<(usize, String)> {
        let mut card = Card::default();
        for (k, text) in lines.iter().enumerate() {
            let (line, _) = Line::of(text);
            let place = Place { file: 0, line: k as u32 + 1 };
            match line.kind(&card) {
                LineKind::First(name) => card.begin(name, place),
                LineKind::Next => {}
                other => panic!("{other:?}"),
            }
            card.add(&line, place);
        }
        assert_eq!(card.name, "GRID");
        card.fields().map(|(k, text)| (k, text.to_string())).collect()
    }

    fn fields(of: &[(usize, &str)]) -> Vec<(usize, String)> {
        of.iter().map(|(k, text)| (*k, text.to_string())).collect()
    }

    #[test]
    fn all_forms_of_a_line_have_the_same_fields() {
        let expected = fields(&[(1, "12345678"), (3, "-1.5-3"), (4, "121.6843"), (9, "7")]);
        for lines in [
            &["GRID    12345678          -1.5-3121.6843                                +A", "+A      7"][..],
            &["grid    12345678          -1.5-3121.6843", "               7"],
            &["GRID,12345678,,-1.5-3,121.6843", ",7"],
            &["GRID, 12345678 ,,-1.5-3,121.6843,,,,,+X", "+X,7"],
            &["GRID,12345678,,-1.5-3,121.6843,,,,", "7"][..1],
            &[
                "GRID*   12345678                        -1.5-3          121.6843        *B",
                "*B",
                "*       7",
            ],
            &["GRID*   12345678                        -1.5-3          121.6843", "*", "+       7"],
            &["GRID*,12345678,,-1.5-3,121.6843,*B", "*B", "*,7"],
        ] {
            let found = card(lines);
            let expected = if lines.len() == 1 { &expected[..3] } else { &expected[..] };
            assert_eq!(found, expected, "{lines:?}");
        }
    }

    #[test]
    fn tabs_go_to_the_next_field() {
        assert_eq!(
            card(&["GRID\t12\t\t-1.5-3\t3.", "+\t7"]),
            fields(&[(1, "12"), (3, "-1.5-3"), (4, "3."), (9, "7")])
        );
    }

    #[test]
    fn lists_go_on_after_commas_and_past_the_tenth_field() {
        let all = |n: usize| (1..=n).map(|k| (k, k.to_string())).collect::<Vec<_>>();
        assert_eq!(card(&["GRID,1,2,3,4,5,6,7,8,9,10,11"]), all(11));
        assert_eq!(card(&["GRID,1,2,3,4,5,6,7,8,9"]), all(9));
        assert_eq!(card(&["GRID,1,2,3,4,5,6,7,8,", "9,10,"]), all(10));
        assert_eq!(card(&["GRID 1 2 3"]), all(3));
    }
}
