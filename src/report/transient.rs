//! `transient.svg` and `transient_spectrum.svg`: motion and friction over time, and over frequency; and the table.

use super::chart::{Area, above, bold, colour, sheet, text, widened};
use super::colours::{ALARM, INK, MEASURED, MUTED};
use super::format::{fixed, given, power, signed, significant};
use super::html::Picture;
use super::tables::Table;
use crate::results::{Channel, RunResults, SpectrumOf, TransientResult};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::error::Error;
use std::f64::consts::TAU;
use std::ops::Range;

const SIZE: (u32, u32) = (980, 640);
/// Decades below the highest line that a spectrum shows.
const DECADES: f64 = 5.0;

type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Motion and forces over time.
pub(super) fn history(results: &RunResults) -> Option<Picture> {
    let run = results.transient.as_ref().filter(|run| run.len() > 1)?;
    let svg = sheet(SIZE, |area| {
        let shown = panels(run);
        let parts = area.split_evenly((shown.len(), 1));
        for (k, (part, channel)) in parts.iter().zip(&shown).enumerate() {
            let ink = if k == 0 { ALARM } else { MEASURED };
            panel(part, channel, (run.len() - 1) as f64 * run.time_step, ink, k + 1 == shown.len())?;
        }
        Ok(())
    })?;
    let motion = &run.channels[run.shown[0]].about;
    let caption = format!(
        "Motion in time from steady sliding ({}): {motion}; friction; penetration of the point that carries most.",
        run.scheme
    );
    Some(Picture { file: "transient.svg", caption, svg })
}

/// The channels of the picture.
fn panels(run: &TransientResult) -> Vec<&Channel> {
    let named = |name: &str| run.channels.iter().find(|c| c.name == name);
    let varies = |c: &&Channel| c.range[0] != c.range[1];
    let sliding = run.channels.iter().find(|c| c.name.ends_with("_sliding_velocity")).filter(varies);
    let shown = run.shown.iter().map(|k| &run.channels[*k]);
    shown.chain(named("penetration")).chain(sliding).collect()
}

fn panel(area: &Area, channel: &Channel, end: f64, ink: &str, last: bool) -> Result<(), Box<dyn Error>> {
    let [low, high] = channel.range;
    let below = last.then_some("time [s]");
    // A tick that is zero but for round-off.
    let label = |v: f64| significant(if v.abs() < 1e-9 * (high - low) { 0.0 } else { v }, 3);
    let mut chart = axes(area, (0.0..end, widened(low, high, 0.08)), below, channel, label)?;
    let line = PathElement::new(channel.line.clone(), colour(ink).stroke_width(2));
    chart.draw_series([line])?;
    Ok(())
}

/// The axes of one of several panels above each other; the words below stand under the last only.
fn axes<'a>(
    area: &Area<'a>,
    (across, up): (Range<f64>, Range<f64>),
    below: Option<&str>,
    channel: &Channel,
    label: impl Fn(f64) -> String,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin_left(16)
        .margin_right(20)
        .margin_top(10)
        .x_label_area_size(if below.is_some() { 46 } else { 22 })
        .y_label_area_size(84)
        .build_cartesian_2d(across, up)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(12.0, INK))
        .axis_desc_style(text(13.0, INK))
        .x_desc(below.unwrap_or_default())
        .y_desc(channel.heading())
        .x_labels(10)
        .y_labels(5)
        .x_label_formatter(&|x| given(*x))
        .y_label_formatter(&|y| label(*y))
        .draw()?;
    Ok(chart)
}

/// Motion and friction over frequency.
pub(super) fn spectra(results: &RunResults) -> Option<Picture> {
    let run = results.transient.as_ref()?;
    let known = |of: &&SpectrumOf| of.spectrum.amplitude.iter().any(|a| *a > 0.0);
    let shown: Vec<&SpectrumOf> = run.spectra.iter().filter(known).collect();
    let first = shown.first()?;
    // Where something is to be seen: up to a third beyond the last named peak, and some harmonics of the strongest.
    let peaks = || shown.iter().flat_map(|of| &of.peaks);
    let last = peaks().map(|p| p.frequency_hz).fold(0.0, f64::max);
    let strongest = first.peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let harmonics = strongest.map_or(f64::INFINITY, |p| 6.5 * p.frequency_hz);
    let nyquist = first.spectrum.frequency_hz(first.spectrum.amplitude.len() - 1);
    let end = if last > 0.0 { (1.33 * last).min(harmonics).min(nyquist) } else { nyquist };
    let svg = sheet(SIZE, |area| {
        for (k, (part, of)) in area.split_evenly((shown.len(), 1)).iter().zip(&shown).enumerate() {
            let ink = if k == 0 { ALARM } else { MEASURED };
            lines(part, of, &run.channels[of.channel], end, ink, k + 1 == shown.len())?;
        }
        Ok(())
    })?;
    let [begin, stop] = first.window;
    let caption = format!(
        "Spectra from {} to {} s (Welch, Hann window, amplitude of a sine, lines every {} Hz).",
        given(begin),
        given(stop),
        significant(first.spectrum.resolution_hz, 3)
    );
    Some(Picture { file: "transient_spectrum.svg", caption, svg })
}

fn lines(
    area: &Area,
    of: &SpectrumOf,
    channel: &Channel,
    end: f64,
    ink: &str,
    last: bool,
) -> Result<(), Box<dyn Error>> {
    let amplitude = &of.spectrum.amplitude;
    let highest = amplitude.iter().skip(2).fold(f64::MIN_POSITIVE, |m: f64, v| m.max(*v));
    let (top, floor) = (highest.log10() + 0.7, highest.log10() - DECADES);
    let below = last.then_some("frequency [Hz]");
    let mut chart = axes(area, (0.0..end, floor..top), below, channel, |v| format!("{:.0e}", 10f64.powf(v)))?;
    let line = amplitude
        .iter()
        .enumerate()
        .map(|(k, a)| (of.spectrum.frequency_hz(k), a.max(f64::MIN_POSITIVE).log10().max(floor)))
        .take_while(|(hz, _)| *hz <= end);
    chart.draw_series([PathElement::new(line.collect::<Vec<_>>(), colour(ink).stroke_width(1))])?;
    let (left, upper) = area.get_base_pixel();
    let mut taken: Vec<i32> = Vec::new();
    let mut strongest: Vec<_> = of.peaks.iter().collect();
    strongest.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    for peak in strongest.into_iter().filter(|peak| peak.frequency_hz < end) {
        let (x, y) = chart.backend_coord(&(peak.frequency_hz, peak.amplitude.log10()));
        if taken.iter().any(|u| (u - x).abs() < 60) {
            continue;
        }
        taken.push(x);
        let label = format!("{} Hz", fixed(peak.frequency_hz, 0));
        area.draw_text(&label, &above(bold(12.0, INK)), (x - left, y - upper - 4))?;
    }
    Ok(())
}

/// The figures of a run in time.
pub(super) fn table(run: &TransientResult) -> Table {
    let mut table = Table::new(
        format!(
            "Motion in time: {} steps of {} s, {}",
            run.len().saturating_sub(1),
            power(run.time_step),
            run.scheme
        ),
        &["<spectrum of", "peak [Hz]", "amplitude", "<unit", "<is"],
    );
    for of in &run.spectra {
        let channel = &run.channels[of.channel];
        for peak in &of.peaks {
            let cells = vec![
                channel.name.replace('_', " "),
                fixed(peak.frequency_hz, 1),
                significant(peak.amplitude, 3),
                channel.unit.to_string(),
                peak.relation.clone(),
            ];
            table.row(cells, false);
        }
    }
    if let Some([modes, attached]) = run.reduced {
        table.notes.push(format!(
            "Reduced model: {modes} real modes and {attached} shapes for the static response to contacts and forces."
        ));
    }
    if let Some(growth) = &run.growth {
        let (hz, sigma) = (growth.eigenvalue.im / TAU, growth.eigenvalue.re);
        table.notes.push(match growth.found {
            Some(found) => format!(
                "Small disturbance: σ = {}/s at {} Hz, measured over {} s; the complex mode says {}/s at {} Hz.",
                signed(found.rate, 2),
                fixed(found.frequency_hz, 2),
                significant(found.window[1] - found.window[0], 3),
                signed(sigma, 2),
                fixed(hz, 2)
            ),
            None => "The disturbance was too large, or the run too short, to measure how a small one grows.".into(),
        });
    }
    table.notes.push(format!(
        "The point that carries most was open {} %, stuck {} % and slid backwards {} % of the time.",
        fixed(100.0 * run.open, 1),
        fixed(100.0 * run.sticking, 1),
        fixed(100.0 * run.backwards, 1)
    ));
    let work = &run.work;
    table.notes.push(format!(
        "Energy: drives spent {} J, friction heat {} J, structural damping took {} J, the integrator {} J; the balance of each step closes to {}.",
        significant(work.drive, 4),
        significant(work.heat, 4),
        significant(-work.damping, 3),
        significant(-work.algorithm, 3),
        power(run.worst_residual)
    ));
    if run.split.0 > 0 {
        table.notes.push(format!(
            "{} steps were split, into up to {} parts: {} in all.",
            run.split.0, run.split.1, run.parts
        ));
    }
    table
}
