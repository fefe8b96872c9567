//! Matrices that Abaqus writes with \*MATRIX GENERATE and \*MATRIX OUTPUT: node, degree of freedom, node, degree of freedom, value.
//!
//! A symmetric matrix is its lower or upper triangle, or both with the same values; an unsymmetric one is both. Nodes that Abaqus makes for
//! itself have negative numbers. A line \*MATRIX INPUT above names the matrix, may scale it, and says by TYPE which of the two it is.
//! Sources: Abaqus Analysis User's Guide, *Generating structural matrices*; Abaqus Keywords Reference Guide, *\*MATRIX INPUT*.

use super::found::{Entries, File, Found, Label, Triangles, Wrong, wanted};
use crate::c64;
use crate::matrix_market::{Lines, number, shown};
use std::str::FromStr;
use stridor_base::error::Result;
use stridor_base::numbers;

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|byte| *byte == b',' || byte.is_ascii_whitespace()).filter(|word| !word.is_empty())
}

/// A blank line, a comment or a keyword.
fn is_skipped(line: &[u8]) -> bool {
    line.iter().find(|byte| !byte.is_ascii_whitespace()).is_none_or(|byte| *byte == b'*')
}

/// The options of \*MATRIX INPUT in upper case, without blanks, each with its value.
fn matrix_input(line: &[u8]) -> Option<Vec<(String, String)>> {
    let line = String::from_utf8_lossy(line).to_ascii_uppercase();
    let mut parts = line.split(',').map(|part| part.split_whitespace().collect::<String>());
    (parts.next()? == "*MATRIXINPUT").then(|| {
        let pair = |part: String| match part.split_once('=') {
            Some((key, value)) => (key.to_string(), value.to_string()),
            None => (part, String::new()),
        };
        parts.map(pair).filter(|(key, _)| !key.is_empty()).collect()
    })
}

fn whole<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn entry(line: &[u8]) -> Option<(Label, Label, f64)> {
    let mut words = words(line);
    let mut label = || -> Option<Label> {
        let (node, dof) = (whole(words.next()?)?, whole(words.next()?)?);
        (dof > 0).then_some((node, dof))
    };
    let (row, column) = (label()?, label()?);
    let value = number(words.next()?)?;
    words.next().is_none().then_some((row, column, value))
}

pub(super) fn is(bytes: &[u8]) -> bool {
    let mut lines = Lines::of(bytes);
    std::iter::from_fn(|| lines.next())
        .find(|line| !is_skipped(line) || matrix_input(line).is_some())
        .is_some_and(|line| matrix_input(line).is_some() || line.contains(&b',') && entry(line).is_some())
}

/// A matrix while it is read.
struct Matrix {
    entries: Entries,
    triangles: Triangles,
    scale: f64,
}

/// What a line \*MATRIX INPUT begins.
fn begin(options: &[(String, String)]) -> std::result::Result<(String, Matrix), (String, &'static str)> {
    let mut matrix = Matrix { entries: Entries::default(), triangles: Triangles::Symmetric, scale: 1.0 };
    let mut name = String::new();
    for (key, value) in options {
        let found = || format!("`{key}={value}`");
        match (key.as_str(), value.as_str()) {
            ("NAME", _) => name.clone_from(value),
            ("TYPE", "SYMMETRIC") => {}
            ("TYPE", "UNSYMMETRIC") => matrix.triangles = Triangles::Both,
            ("TYPE", _) => return Err((found(), "TYPE=SYMMETRIC or TYPE=UNSYMMETRIC")),
            ("SCALEFACTOR", _) => {
                let scale = numbers::parse(value).filter(|scale| scale.is_finite() && *scale != 0.0);
                matrix.scale = scale.ok_or((found(), "SCALE FACTOR= and a number that is not zero"))?;
            }
            _ => return Err((found(), "NAME, TYPE or SCALE FACTOR, and the entries below")),
        }
    }
    Ok((name, matrix))
}

pub(super) fn read(file: &File) -> Result<Found> {
    let mut wrong = Wrong::default();
    let unnamed = Matrix { entries: Entries::default(), triangles: Triangles::Unsaid, scale: 1.0 };
    let mut all = vec![(String::new(), unnamed)];
    let mut lines = Lines::of(file.bytes);
    while let Some(line) = lines.next() {
        let place = || format!("{}:{}", file.name, lines.number);
        if let Some(options) = matrix_input(line) {
            match begin(&options) {
                Ok(matrix) => all.push(matrix),
                Err((found, expected)) => wrong.push(place(), found, expected),
            }
        }
        if is_skipped(line) {
            continue;
        }
        let Some((_, matrix)) = all.last_mut() else { unreachable!("the first is there") };
        let scaled = entry(line).map(|(row, column, value)| (row, column, matrix.scale * value));
        match scaled.filter(|(.., value)| value.is_finite()) {
            Some((row, column, value)) => {
                matrix.entries.push(row, column, c64::new(value, 0.0), lines.number);
            }
            None => {
                let expected = "node, degree of freedom, node, degree of freedom, a finite number";
                wrong.push(place(), format!("`{}`", shown(line)), expected);
            }
        }
    }
    std::mem::take(&mut wrong).into_result(file.name, ())?;
    if all.len() > 1 && all[0].1.entries.all.is_empty() {
        all.remove(0);
    }
    let (name, Matrix { entries, triangles, .. }) = wanted(file.name, file.initial, all)?;
    if entries.all.is_empty() {
        wrong.push(
            file.name.to_string(),
            format!("no entries of *MATRIX INPUT, NAME={name}"),
            "at least one",
        );
    }
    let matrix = entries.into_matrix(file, &name, triangles, false, &mut wrong);
    wrong.into_result(file.name, Found::Labelled(matrix))
}
