//! `transient_contact.svg`: what the contact points do over time.

use crate::report::chart::{Axis, Chart, WIDTH, wide};
use crate::report::colours::{ALARM, PARTS};
use crate::report::format::fixed;
use crate::report::section::Picture;
use crate::report::svg::{Key, Sheet, fill};
use crate::results::{ContactHistory, RunResults, TouchState, TransientResult};

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
    let points = match history.points {
        1 => "the one contact point that touches".to_string(),
        n => format!("the {n} contact points that touch"),
    };
    let caption =
        format!("What {points} did over time; a column lasts {} ms.", fixed(1e3 * history.column, 2));
    Some(Picture { file: "transient_contact".into(), caption, svg: drawn(history, end, part) })
}

fn drawn(history: &ContactHistory, end: f64, part: impl Fn(TouchState) -> f64) -> String {
    let up = Axis::new("share of the time [%]", 0.0..100.0);
    let mut chart = Chart::new(wide(38.0, 248.0), Axis::new("time [s]", 0.0..end), up);
    let mut floor = vec![0.0; history.counts.len()];
    let shown = || ORDER.into_iter().filter(|state| part(*state) > 0.0);
    for state in shown() {
        let share = |counts: &[u64; 4]| {
            100.0 * counts[state as usize] as f64 / counts.iter().sum::<u64>().max(1) as f64
        };
        let roof: Vec<f64> = history.counts.iter().zip(&floor).map(|(counts, f)| f + share(counts)).collect();
        let mut outline = steps(&roof, history.column, end);
        outline.extend(steps(&floor, history.column, end).into_iter().rev());
        chart.polygon(outline, &fill(ink(state)));
        floor = roof;
    }
    let mut sheet = Sheet::new(WIDTH, 300.0);
    let words = |state: TouchState| format!("{} {} %", state.name(), fixed(100.0 * part(state), 1));
    sheet.keys([112.0, 8.0], shown().map(|state| (Key::Box(fill(ink(state))), words(state))));
    chart.draw(&mut sheet);
    sheet.finish()
}

/// The corners of a stair.
fn steps(values: &[f64], column: f64, end: f64) -> Vec<[f64; 2]> {
    let mut corners: Vec<[f64; 2]> = Vec::new();
    for (k, value) in values.iter().enumerate() {
        let [left, right] = [k, k + 1].map(|k| (k as f64 * column).min(end));
        match corners.last_mut() {
            Some(last) if last[1] == *value => last[0] = right,
            _ => corners.extend([[left, *value], [right, *value]]),
        }
    }
    corners
}
