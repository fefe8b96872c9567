//! `transient_contact.svg`: what the contact points do over time.

use crate::report::axes::axes;
use crate::report::chart::{Area, colour, sheet, text};
use crate::report::colours::{ALARM, INK, PARTS};
use crate::report::format::fixed;
use crate::report::section::Picture;
use crate::results::{ContactHistory, RunResults, TouchState, TransientResult};
use plotters::prelude::*;
use std::error::Error;

const SIZE: (u32, u32) = (980, 300);

fn ink(state: TouchState) -> &'static str {
    match state {
        TouchState::Open => PARTS[5][0],
        TouchState::Stick => PARTS[2][0],
        TouchState::Backwards => ALARM,
        TouchState::Forwards => PARTS[0][0],
    }
}

/// From the foot of the picture to its top.
const ORDER: [TouchState; 4] =
    [TouchState::Forwards, TouchState::Stick, TouchState::Backwards, TouchState::Open];

/// Shares of the states, one upon the other.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let history = Some(&run.diagnostics.contact).filter(|history| history.points > 0)?;
    let whole: u64 = history.counts.iter().flatten().sum();
    let part = |state: TouchState| {
        history.counts.iter().map(|c| c[state as usize]).sum::<u64>() as f64 / whole.max(1) as f64
    };
    let end = run.len().saturating_sub(1) as f64 * run.time_step;
    let svg = sheet(SIZE, |area| draw(area, history, end, &part))?;
    let points = match history.points {
        1 => "the one contact point that touches".to_string(),
        n => format!("the {n} contact points that touch"),
    };
    let caption =
        format!("What {points} did over time; a column lasts {} ms.", fixed(1e3 * history.column, 2));
    Some(Picture { file: "transient_contact".into(), caption, svg })
}

fn draw(
    area: &Area,
    history: &ContactHistory,
    end: f64,
    part: &dyn Fn(TouchState) -> f64,
) -> Result<(), Box<dyn Error>> {
    let (legend, main) = area.split_vertically(34);
    let percent = |v: f64| format!("{} %", fixed(100.0 * v, 0));
    let mut chart = axes(&main, (0.0..end, 0.0..1.0), Some("time [s]"), "share of the time", percent)?;
    let mut floor = vec![0.0; history.counts.len()];
    let mut x = 120;
    for state in ORDER {
        if part(state) == 0.0 {
            continue;
        }
        let share =
            |counts: &[u64; 4]| counts[state as usize] as f64 / counts.iter().sum::<u64>().max(1) as f64;
        let roof: Vec<f64> = history.counts.iter().zip(&floor).map(|(counts, f)| f + share(counts)).collect();
        let mut outline = steps(&roof, history.column, end);
        outline.extend(steps(&floor, history.column, end).into_iter().rev());
        chart.draw_series([Polygon::new(outline, colour(ink(state)).filled())])?;
        floor = roof;
        legend.draw(&Rectangle::new([(x, 12), (x + 16, 26)], colour(ink(state)).filled()))?;
        let words = format!("{} {} %", state.name(), fixed(100.0 * part(state), 1));
        legend.draw_text(&words, &text(13.0, INK), (x + 22, 11))?;
        x += 60 + 7 * words.len() as i32;
    }
    Ok(())
}

/// The corners of a stair.
fn steps(values: &[f64], column: f64, end: f64) -> Vec<(f64, f64)> {
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for (k, value) in values.iter().enumerate() {
        let [left, right] = [k, k + 1].map(|k| (k as f64 * column).min(end));
        match corners.last_mut() {
            Some(last) if last.1 == *value => last.0 = right,
            _ => corners.extend([(left, *value), (right, *value)]),
        }
    }
    corners
}
