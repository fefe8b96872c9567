//! `transient_spectrogram.svg`: which frequencies sound when.

use super::raster::image;
use super::spectra::highest_frequency;
use crate::report::axes::{WIDTH, Words, labelled};
use crate::report::chart::{Area, colour, sheet, text};
use crate::report::colours::{INK, MEASURED, sequential};
use crate::report::format::{given, multiple, significant};
use crate::report::section::Picture;
use crate::results::{Channel, RunResults, TransientResult};
use crate::signal::Spectrogram;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// Decades between the lightest and the darkest colour.
const DECADES: f64 = 3.0;
/// Columns that the colour bar takes.
const BAR: u32 = 140;

/// Motion and friction over time and frequency.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let shown: Vec<&(usize, Spectrogram)> =
        run.diagnostics.spectrograms.iter().filter(|(_, s)| alive(s)).collect();
    let (_, first) = shown.first()?;
    let (end, duration) = (highest_frequency(run), run.len().saturating_sub(1) as f64 * run.time_step);
    let measured = |channel: usize| -> &[f64] {
        run.spectra.iter().find(|of| of.channel == channel).map_or(&[], |of| &of.measured)
    };
    let mut images = String::new();
    let svg = sheet((WIDTH, 360 * shown.len() as u32), |area| {
        for (k, (part, (channel, of))) in area.split_evenly((shown.len(), 1)).iter().zip(&shown).enumerate() {
            let below = (k + 1 == shown.len()).then_some("time [s]");
            images += &panel(part, &run.channels[*channel], of, [duration, end], measured(*channel), below)?;
        }
        Ok(())
    })?;
    // Right after the white sheet, so that axes and marks lie on the colours.
    let at = svg.find("/>").map_or(0, |at| at + 2);
    let svg = format!("{}\n{images}{}", &svg[..at], &svg[at..]);
    let blue = if run.spectra.iter().all(|of| of.measured.is_empty()) { "" } else { " Blue: measured." };
    let caption = format!(
        "Spectrograms (Hann window of {} s, amplitude of a sine, three decades below the highest).{blue}",
        significant(first.segment, 2)
    );
    Some(Picture { file: "transient_spectrogram".into(), caption, svg })
}

fn highest(of: &Spectrogram) -> f64 {
    of.amplitude.iter().filter(|a| a.is_finite()).fold(0.0, |m: f64, a| m.max(*a))
}

fn alive(of: &Spectrogram) -> bool {
    of.rows > 2 && highest(of) > 0.0
}

/// One channel; gives the image that belongs below its axes.
fn panel(
    area: &Area,
    channel: &Channel,
    of: &Spectrogram,
    [duration, end]: [f64; 2],
    measured: &[f64],
    below: Option<&str>,
) -> Result<String, Box<dyn Error>> {
    let (main, bar) = area.split_horizontally(WIDTH - BAR);
    let rows = (1 + (end / of.resolution_hz) as usize).clamp(3, of.rows);
    let top = (rows as f64 - 0.5) * of.resolution_hz;
    let words = Words {
        below,
        beside: "frequency [Hz]",
        across: &given,
        up: &given,
        labels: 10,
        decades: 0.0,
        grid: false,
    };
    let mut chart = labelled(&main, (0.0..duration, 0.0..top), &words)?;
    for hz in measured.iter().filter(|hz| **hz < top) {
        let line = [(0.0, *hz), (duration, *hz)];
        chart.draw_series([PathElement::new(line, colour(MEASURED).mix(0.55).stroke_width(1))])?;
        let (x, y) = chart.backend_coord(&(0.0, *hz));
        let (left, upper) = main.get_base_pixel();
        main.draw_text(&given(*hz), &text(11.5, MEASURED), (x - left + 5, y - upper - 16))?;
    }
    let most = highest(of);
    // Row 0 is the mean, which is taken off.
    let cells: Vec<f64> = (1..rows)
        .rev()
        .flat_map(|row| (0..of.columns()).map(move |column| of.column(column)[row]))
        .map(|a| 1.0 + (a / most).max(1e-30).log10() / DECADES)
        .collect();
    let at = |t: f64, hz: f64| chart.backend_coord(&(t, hz));
    let begin = of.begin - 0.5 * of.hop;
    let (left, upper) = at(begin, top);
    let (right, lower) = at(begin + of.columns() as f64 * of.hop, 0.5 * of.resolution_hz);
    let place = [left, upper, right - left, lower - upper].map(f64::from);
    scale(&bar, channel, most)?;
    Ok(image(place, of.columns(), &cells, sequential))
}

/// The colours and what they mean.
fn scale(bar: &Area, channel: &Channel, most: f64) -> Result<(), Box<dyn Error>> {
    let (_, height) = bar.dim_in_pixel();
    let (top, length, steps) = (44, height as i32 - 44 - 60, 48);
    for k in 0..steps {
        // One pixel into the next, so that no seam shows.
        let corner = [(4, top + length * k / steps), (20, top + length * (k + 1) / steps + 1)];
        let shade = sequential(1.0 - k as f64 / (steps - 1) as f64);
        bar.draw(&Rectangle::new(corner, colour(&shade).filled()))?;
    }
    let left = text(11.5, INK).pos(Pos::new(HPos::Left, VPos::Center));
    let unit = multiple(most, channel.unit);
    for decade in 0..=DECADES as i32 {
        let y = top + (f64::from(decade) / DECADES * f64::from(length)) as i32;
        bar.draw_text(&significant(most / unit.size * 10f64.powi(-decade), 2), &left, (26, y))?;
    }
    let name = channel.words();
    let words: Vec<&str> = name.rsplitn(2, ' ').collect();
    let [last, first] = [words[0], words.get(1).copied().unwrap_or_default()];
    bar.draw_text(first, &left, (2, 12))?;
    bar.draw_text(&format!("{last} [{}]", unit.unit), &left, (2, 27))?;
    Ok(())
}
