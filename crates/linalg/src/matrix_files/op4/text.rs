//! OUTPUT4 as text: whole numbers of eight characters, or sixteen where the first line ends in `|I16`, and values of the width that the first
//! line states, `1P,3E23.16`. Here the words of a dense column are its numbers.

use super::super::found::File;
use super::matrix::{Block, Deviation, Matrix, deviation};
use crate::matrix_market::{Lines, shown};
use stridor_base::numbers;

/// The first line of a matrix: four numbers, its name, characters of a value.
fn head(line: &[u8]) -> Option<([i64; 4], String, usize)> {
    let line = std::str::from_utf8(line).ok().filter(|line| line.is_ascii())?.trim_end();
    let (line, wide) = line.strip_suffix("|I16").map_or((line, 8), |line| (line, 16));
    let ends = [wide, 2 * wide, 2 * wide + 8, 2 * wide + 16, 2 * wide + 24];
    let number = |from: usize, to: usize| line.get(from..to)?.trim().parse::<i64>().ok();
    let four = [
        number(0, ends[0])?,
        number(ends[0], ends[1])?,
        number(ends[1], ends[2])?,
        number(ends[2], ends[3])?,
    ];
    // `1P,3E23.16`, `3D23.16`: the width stands after the letter; without a form it is that of 5E16.9.
    let form = line.get(ends[4]..).unwrap_or_default().trim().to_ascii_uppercase();
    let width = if form.is_empty() {
        16
    } else {
        let after = &form[form.find(['E', 'D'])? + 1..];
        after.split('.').next()?.parse().ok().filter(|width| (8..=64).contains(width))?
    };
    let name = line.get(ends[3]..ends[4].min(line.len()))?.trim();
    Some((four, name.to_string(), width))
}

pub(super) fn is(bytes: &[u8]) -> bool {
    Lines::of(bytes).next().is_some_and(|line| head(line).is_some())
}

/// Whole numbers, `count` of them, that a line consists of.
fn integers(line: Option<&[u8]>, count: usize, what: &str) -> std::result::Result<Vec<i64>, Deviation> {
    let text = line.and_then(|line| std::str::from_utf8(line).ok()).unwrap_or_default();
    let numbers: Option<Vec<i64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    let found = || line.map_or("the end of the file".to_string(), |line| format!("`{}`", shown(line)));
    numbers.filter(|numbers| numbers.len() == count).ok_or_else(|| (found(), what.to_string()))
}

/// The values below, as many as `count`.
fn values(lines: &mut Lines<'_>, count: i64, width: usize) -> std::result::Result<Vec<f64>, Deviation> {
    let mut found = Vec::new();
    while (found.len() as i64) < count {
        let left = count - found.len() as i64;
        let expected = || format!("{left} more numbers of {width} characters");
        let Some(line) = lines.next() else { return deviation("the end of the file", expected()) };
        let line = line.trim_ascii_end();
        let here: Option<Vec<f64>> = line
            .chunks(width)
            .map(|word| {
                let word = std::str::from_utf8(word).ok().filter(|word| word.len() == width)?;
                numbers::parse(word.trim())
            })
            .collect();
        match here {
            Some(here) if !here.is_empty() && here.len() as i64 <= left => found.extend(here),
            _ => return deviation(format!("`{}`", shown(line)), expected()),
        }
    }
    Ok(found)
}

/// Every matrix of a file, or the place of what is wrong.
pub(super) fn read(file: &File) -> std::result::Result<Vec<Matrix>, (String, Deviation)> {
    let mut lines = Lines::of(file.bytes);
    let mut all = Vec::new();
    loop {
        match matrix(file, &mut lines) {
            Ok(Some(matrix)) => all.push(matrix),
            Ok(None) => return Ok(all),
            Err(deviation) => return Err((format!("{}:{}", file.name, lines.number), deviation)),
        }
    }
}

fn matrix(file: &File, lines: &mut Lines<'_>) -> std::result::Result<Option<Matrix>, Deviation> {
    let first = loop {
        match lines.next() {
            None => return Ok(None),
            Some(line) if line.trim_ascii().is_empty() => {}
            Some(line) => break line,
        }
    };
    let Some((four, name, width)) = head(first) else {
        return deviation(
            format!("`{}`", shown(first)),
            "columns, rows, form, kind, name and form of numbers of the next matrix",
        );
    };
    let mut matrix = Matrix::new(four, name, 2, format!("{}:{}", file.name, lines.number))?;
    loop {
        let what = format!(
            "column, first row and number of words; column {} ends {}",
            matrix.columns + 1,
            matrix.name
        );
        let record = integers(lines.next(), 3, &what)?;
        let &[column, row, mut words] = record.as_slice() else { unreachable!("three") };
        if !matrix.begin(column)? {
            // A value that means nothing ends the matrix.
            lines.next();
            return Ok(Some(matrix));
        }
        if row != 0 {
            let block = matrix.checked(Block { row, numbers: words })?;
            let numbers = values(lines, block.numbers, width)?;
            matrix.push(block, &numbers)?;
            continue;
        }
        if words < 1 {
            return deviation(format!("{words} words in column {column}"), "one or more");
        }
        while words > 0 {
            let what = if matrix.header() == 2 {
                "length and first row of a string"
            } else {
                "length and first row of a string in one number"
            };
            let string = integers(lines.next(), matrix.header(), what)?;
            let (block, length) = matrix.string(&string)?;
            if length > words {
                return deviation(
                    format!("a string of {length} words in column {column}"),
                    format!("{words} at most"),
                );
            }
            words -= length;
            let numbers = values(lines, block.numbers, width)?;
            matrix.push(block, &numbers)?;
        }
    }
}
