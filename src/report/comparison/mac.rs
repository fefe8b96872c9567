//! `mac_<name>.svg`: how like each measured shape is to each level of computed modes.

use super::super::colours::{INK, MEASURED, MUTED, sequential};
use super::super::format::{fixed, given, hertz};
use super::super::svg::{Sheet, ink, outlined, stroke};
use super::level::level_name;
use crate::report::section::Picture;
use crate::results::{MeasuredComparison, NamedModes, file_name};

const CELL: [f64; 2] = [46.0, 30.0];
/// Space for the labels of the rows, and of the columns.
const MARGIN: [f64; 2] = [130.0, 112.0];
/// Columns beyond the highest paired level are of no interest; and there are at most so many.
const BEYOND: usize = 2;
const MOST: usize = 40;
/// Space for the note below.
const NARROWEST: f64 = 500.0;

pub(super) fn picture(comparison: &MeasuredComparison, set: &NamedModes) -> Option<Picture> {
    let rows: Vec<usize> = (0..comparison.rows.len()).filter(|k| !comparison.mac[*k].is_empty()).collect();
    let hz =
        |level: usize| comparison.frequency_scale * set.modes.frequency_hz(comparison.levels[level].start);
    let highest = rows.iter().map(|k| comparison.rows[*k].frequency_hz).fold(0.0, f64::max);
    let paired = rows.iter().filter_map(|k| comparison.level_of(comparison.rows[*k].mode?)).max();
    let inside = (0..comparison.levels.len()).filter(|level| hz(*level) <= highest).count();
    let columns = inside.max(paired.map_or(0, |level| level + 1)) + BEYOND;
    let columns = columns.min(comparison.levels.len()).min(MOST);
    if rows.is_empty() || columns == 0 {
        return None;
    }
    let (width, height) = (columns as f64 * CELL[0], rows.len() as f64 * CELL[1]);
    let mut sheet = Sheet::new((MARGIN[0] + width + 30.0).max(NARROWEST), MARGIN[1] + height + 34.0);
    let small = ink(12.5, INK);
    for column in 0..columns {
        let x = MARGIN[0] + (column as f64 + 0.5) * CELL[0];
        let name = level_name(set, &comparison.levels[column]);
        // Two lines and the frequency, so that labels of neighbours do not touch.
        let (first, second) = name.split_once(" ×").map_or((name.as_str(), ""), |(a, b)| (a, b));
        let lines = [first.to_string(), if second.is_empty() { String::new() } else { format!("×{second}") }];
        for (k, line) in lines.iter().enumerate() {
            sheet.text([x, MARGIN[1] - 40.0 + 15.0 * k as f64], line, small.middle());
        }
        sheet.text([x, MARGIN[1] - 10.0], &hertz(hz(column), 0), ink(12.5, MUTED).middle());
    }
    let title = "MAC: squared cosine between shapes";
    sheet.text([MARGIN[0], 24.0], title, ink(14.0, INK).bold());
    sheet.text([MARGIN[0], 46.0], "computed [Hz]", small);
    sheet.text([12.0, MARGIN[1] - 10.0], "measured [Hz]", ink(12.5, MEASURED));
    let style = stroke(MEASURED, 2.4);
    for (place, k) in rows.iter().enumerate() {
        let row = &comparison.rows[*k];
        let y = MARGIN[1] + place as f64 * CELL[1];
        let label = ink(12.5, MEASURED).end();
        sheet.text([MARGIN[0] - 10.0, y + 20.0], &given(row.frequency_hz), label);
        for (column, like) in comparison.mac[*k][..columns].iter().enumerate() {
            let corner = [MARGIN[0] + column as f64 * CELL[0], y];
            sheet.rectangle(corner, CELL, &outlined(&sequential(*like), "#ffffff", 1.0));
            let colour = if *like > 0.55 { "#ffffff" } else { INK };
            let middle = [corner[0] + 0.5 * CELL[0], y + 20.0];
            sheet.text(middle, &fixed(*like, 2), ink(12.5, colour).middle());
        }
    }
    for (place, k) in rows.iter().enumerate() {
        let level = comparison.rows[*k].mode.and_then(|mode| comparison.level_of(mode));
        if let Some(column) = level.filter(|level| *level < columns) {
            let corner = [MARGIN[0] + column as f64 * CELL[0], MARGIN[1] + place as f64 * CELL[1]];
            sheet.rectangle(corner, CELL, &style);
        }
    }
    let note = "Framed: paired. A level of several modes counts as the space they span.";
    sheet.text([12.0, MARGIN[1] + height + 22.0], note, ink(12.5, MUTED));
    let caption = format!("MAC of the measured shapes ({}) with the computed ones.", comparison.name);
    Some(Picture { file: file_name("mac", &comparison.name), caption, svg: sheet.finish() })
}
