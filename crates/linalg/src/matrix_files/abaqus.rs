//! Matrices that Abaqus writes with \*MATRIX GENERATE and \*MATRIX OUTPUT: node, degree of freedom, node, degree of freedom, value.
//!
//! A symmetric matrix is its lower triangle, an unsymmetric one both. Nodes that Abaqus makes for itself have negative numbers. Source:
//! Abaqus Analysis User's Guide, *Generating structural matrices*.

use super::found::{File, Found, Label, Labelled, Wrong};
use crate::c64;
use crate::matrix_market::{Lines, number, shown};
use std::str::FromStr;
use stridor_base::error::Result;

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|byte| *byte == b',' || byte.is_ascii_whitespace()).filter(|word| !word.is_empty())
}

/// A blank line, a comment or a keyword (\*MATRIX INPUT).
fn is_skipped(line: &[u8]) -> bool {
    line.iter().find(|byte| !byte.is_ascii_whitespace()).is_none_or(|byte| *byte == b'*')
}

fn whole<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn entry(line: &[u8]) -> Option<(Label, Label, f64)> {
    let mut words = words(line);
    let mut label = || -> Option<Label> { Some((whole(words.next()?)?, whole(words.next()?)?)) };
    let (row, column) = (label()?, label()?);
    let value = number(words.next()?)?;
    words.next().is_none().then_some((row, column, value))
}

pub(super) fn is(bytes: &[u8]) -> bool {
    let mut lines = Lines::of(bytes);
    let first = std::iter::from_fn(|| lines.next()).find(|line| !is_skipped(line));
    first.is_some_and(|line| line.contains(&b',') && entry(line).is_some())
}

pub(super) fn read(file: &File) -> Result<Found> {
    let (mut entries, mut wrong) = (Vec::new(), Wrong::default());
    let mut lines = Lines::of(file.bytes);
    while let Some(line) = lines.next() {
        if is_skipped(line) {
            continue;
        }
        match entry(line).filter(|(.., value)| value.is_finite()) {
            Some((row, column, value)) => entries.push((row, column, c64::new(value, 0.0))),
            None => {
                let expected = "node, degree of freedom, node, degree of freedom, a finite number";
                wrong.push(format!("{}:{}", file.name, lines.number), format!("`{}`", shown(line)), expected);
            }
        }
    }
    let place = file.name.to_string();
    let found = Labelled { entries, complex: false, rectangular: false, place };
    wrong.into_result(file.name, Found::Labelled(found))
}
