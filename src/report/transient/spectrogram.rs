//! `transient_spectrogram.svg`: which frequencies sound when.

use super::raster::image;
use super::spectra::highest_frequency;
use crate::report::chart::{Axis, Chart, WIDTH};
use crate::report::colours::{INK, MEASURED, sequential};
use crate::report::format::{given, multiple, significant};
use crate::report::section::Picture;
use crate::report::svg::{Sheet, ink, sheer, stroke};
use crate::results::{Channel, RunResults, TransientResult};
use crate::signal::Spectrogram;

/// Decades between the lightest and the darkest colour.
const DECADES: f64 = 3.0;
/// Columns that the colour bar takes.
const BAR: f64 = 140.0;
/// Height of a channel, and of its part between the axes \[px\].
const HEIGHTS: [f64; 2] = [350.0, 308.0];

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
    let mut sheet = Sheet::new(WIDTH, HEIGHTS[0] * shown.len() as f64 + 22.0);
    for (k, (channel, of)) in shown.iter().enumerate() {
        let time = Axis::new(if k + 1 == shown.len() { "time [s]" } else { "" }, 0.0..duration).bare();
        let place = (10.0 + HEIGHTS[0] * k as f64, time);
        panel(&mut sheet, place, (&run.channels[*channel], of), end, measured(*channel));
    }
    let blue = if run.spectra.iter().all(|of| of.measured.is_empty()) { "" } else { " Blue: measured." };
    let caption = format!(
        "Spectrograms (Hann window of {} s, amplitude of a sine, three decades below the highest).{blue}",
        significant(first.segment, 2)
    );
    Some(Picture { file: "transient_spectrogram".into(), caption, svg: sheet.finish() })
}

fn highest(of: &Spectrogram) -> f64 {
    of.amplitude.iter().filter(|a| a.is_finite()).fold(0.0, |m: f64, a| m.max(*a))
}

fn alive(of: &Spectrogram) -> bool {
    of.rows > 2 && highest(of) > 0.0
}

/// One channel from an upper edge on, with its colours and what they mean.
fn panel(
    sheet: &mut Sheet,
    (top, time): (f64, Axis),
    (channel, of): (&Channel, &Spectrogram),
    end: f64,
    measured: &[f64],
) {
    let rows = (1 + (end / of.resolution_hz) as usize).clamp(3, of.rows);
    let head = (rows as f64 - 0.5) * of.resolution_hz;
    let up = Axis::new("frequency [Hz]", 0.0..head).bare();
    let right = WIDTH - BAR - 22.0;
    let mut chart = Chart::new([112.0, top, right, top + HEIGHTS[1]], time, up);
    let most = highest(of);
    // Row 0 is the mean, which is taken off.
    let cells: Vec<f64> = (1..rows)
        .rev()
        .flat_map(|row| (0..of.columns()).map(move |column| of.column(column)[row]))
        .map(|a| 1.0 + (a / most).max(1e-30).log10() / DECADES)
        .collect();
    let begin = of.begin - 0.5 * of.hop;
    let finish = begin + of.columns() as f64 * of.hop;
    let corners = [[begin, head], [finish, 0.5 * of.resolution_hz]];
    chart.put(corners, |place| image(place, of.columns(), &cells, sequential));
    for hz in measured.iter().filter(|hz| **hz < head) {
        chart.rule(1, *hz, &sheer(stroke(MEASURED, 1.0), 0.55));
        chart.text([0.0, *hz], [5.0, -4.0], &given(*hz), ink(11.5, MEASURED));
    }
    chart.draw(sheet);
    let unit = multiple(most, channel.unit);
    let decade = |k: i32| significant(most / unit.size * 10f64.powi(-k), 2);
    let ticks = (0..=DECADES as i32).map(|k| (1.0 - f64::from(k) / DECADES, decade(k)));
    sheet.colour_bar([right + 26.0, top + 36.0], HEIGHTS[1] - 42.0, sequential, ticks);
    let name = channel.words();
    let (first, last) = name.rsplit_once(' ').unwrap_or(("", &name));
    sheet.text([right + 24.0, top + 10.0], first, ink(11.5, INK));
    sheet.text([right + 24.0, top + 25.0], &format!("{last} [{}]", unit.unit), ink(11.5, INK));
}
