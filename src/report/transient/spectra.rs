//! `transient_spectrum.svg`: motion and friction over frequency.

use crate::report::axes::{Chart, WIDTH, Words, labelled};
use crate::report::chart::{Area, above, bold, colour, sheet, text};
use crate::report::colours::{ALARM, INK, MEASURED, SECOND};
use crate::report::format::{given, hertz, multiple, significant};
use crate::report::section::Picture;
use crate::results::{Channel, RunResults, SpectrumOf, TransientResult};
use plotters::prelude::*;
use std::error::Error;
use std::ops::Range;

/// Decades below the highest line that a spectrum shows.
const DECADES: f64 = 5.0;

/// Motion and friction over frequency.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let known = |of: &&SpectrumOf| of.spectrum.amplitude.iter().any(|a| *a > 0.0);
    let shown: Vec<&SpectrumOf> = run.spectra.iter().filter(known).collect();
    let first = shown.first()?;
    let end = highest_frequency(run);
    let measured = shown.iter().any(|of| !of.measured.is_empty());
    let svg = sheet((WIDTH, 320 * shown.len() as u32), |area| {
        for (k, (part, of)) in area.split_evenly((shown.len(), 1)).iter().zip(&shown).enumerate() {
            let ink = if k == 0 { ALARM } else { SECOND };
            let below = (k + 1 == shown.len()).then_some("frequency [Hz]");
            lines(part, (of, &run.channels[of.channel]), end, ink, below)?;
        }
        Ok(())
    })?;
    let [begin, stop] = first.window;
    let caption = format!(
        "Spectra from {} to {} s (Welch, Hann window, amplitude of a sine, lines every {} Hz).",
        given(begin),
        given(stop),
        significant(first.spectrum.resolution_hz, 3)
    ) + if measured { " Blue: measured." } else { "" };
    Some(Picture { file: "transient_spectrum".into(), caption, svg })
}

fn lines(
    area: &Area,
    (of, channel): (&SpectrumOf, &Channel),
    end: f64,
    ink: &str,
    below: Option<&str>,
) -> Result<(), Box<dyn Error>> {
    let amplitude = &of.spectrum.amplitude;
    let highest = amplitude.iter().skip(2).fold(f64::MIN_POSITIVE, |m: f64, v| m.max(*v));
    let (top, floor) = (highest.log10() + 0.7, highest.log10() - DECADES);
    let unit = multiple(highest, channel.unit);
    let heading = format!("{} [{}]", channel.words(), unit.unit);
    // Places are decimal logarithms of the values in that unit.
    let shift = unit.size.log10();
    let value = |v: f64| significant(10f64.powf(v), 1);
    let words =
        Words { below, beside: &heading, across: &given, up: &value, labels: 10, decades: 1.0, grid: true };
    let mut chart = labelled(area, (0.0..end, floor - shift..top - shift), &words)?;
    mark(area, &mut chart, &of.measured, end, floor - shift..top - shift)?;
    let line = amplitude
        .iter()
        .enumerate()
        .map(|(k, a)| (of.spectrum.frequency_hz(k), a.max(f64::MIN_POSITIVE).log10().max(floor) - shift))
        .take_while(|(hz, _)| *hz <= end);
    chart.draw_series([PathElement::new(line.collect::<Vec<_>>(), colour(ink).stroke_width(1))])?;
    let (left, upper) = area.get_base_pixel();
    let mut taken: Vec<i32> = Vec::new();
    let mut strongest: Vec<_> = of.peaks.iter().collect();
    strongest.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    for peak in strongest.into_iter().filter(|peak| peak.frequency_hz < end) {
        let (x, y) = chart.backend_coord(&(peak.frequency_hz, peak.amplitude.log10() - shift));
        if taken.iter().any(|u| (u - x).abs() < 60) {
            continue;
        }
        taken.push(x);
        let label = format!("{} Hz", hertz(peak.frequency_hz, 0));
        area.draw_text(&label, &above(bold(12.0, INK)), (x - left, y - upper - 4))?;
    }
    Ok(())
}

/// Lines at measured frequencies, each with its figure at the head, lower where it would hide another.
fn mark(
    area: &Area,
    chart: &mut Chart,
    measured: &[f64],
    end: f64,
    up: Range<f64>,
) -> Result<(), Box<dyn Error>> {
    let (left, upper) = area.get_base_pixel();
    let mut taken: Vec<(i32, i32)> = Vec::new();
    for hz in measured.iter().filter(|hz| **hz < end) {
        let line = [(*hz, up.start), (*hz, up.end)];
        chart.draw_series([PathElement::new(line, colour(MEASURED).mix(0.6).stroke_width(1))])?;
        let (x, mut y) = chart.backend_coord(&(*hz, up.end));
        while taken.iter().any(|(u, v)| (u - x).abs() < 36 && (v - y).abs() < 13) {
            y += 13;
        }
        taken.push((x, y));
        area.draw_text(&given(*hz), &text(11.5, MEASURED), (x - left + 4, y - upper))?;
    }
    Ok(())
}

/// Where something is to be seen: up to a third beyond the last peak, and some harmonics of the fundamental or the strongest.
pub(super) fn highest_frequency(run: &TransientResult) -> f64 {
    let Some(first) = run.spectra.first() else { return 0.0 };
    let peaks = || run.spectra.iter().flat_map(|of| &of.peaks);
    let last = peaks().map(|p| p.frequency_hz).fold(0.0, f64::max);
    let strongest = first.peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let first_hz = run.fundamental_hz.or(strongest.map(|p| p.frequency_hz));
    let harmonics = first_hz.map_or(f64::INFINITY, |hz| 6.5 * hz);
    let nyquist = first.spectrum.frequency_hz(first.spectrum.amplitude.len().saturating_sub(1));
    if last > 0.0 { (1.33 * last).min(harmonics).min(nyquist) } else { nyquist }
}
