//! `sound.svg` and the table: how loud it is.

use super::spectra::highest_frequency;
use crate::report::axes::{WIDTH, axes};
use crate::report::chart::{Area, above, bold, colour, sheet, text};
use crate::report::colours::{ALARM, INK, SECOND};
use crate::report::format::{fixed, given, hertz, significant};
use crate::report::section::Picture;
use crate::report::table::ReportTable;
use crate::results::{RunResults, Sound, TransientResult};
use crate::sound::{power_level, pressure_level};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// Decibels below the highest line that are shown.
const DEPTH: f64 = 70.0;
/// Modes that the table names.
const MODES: usize = 4;

/// Sound power, and the pressure at the first microphone, over frequency.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let sound = run.sound.as_ref()?;
    let power: Vec<f64> = (0..sound.lines()).map(|k| power_level(sound.power(k))).collect();
    if !power.iter().any(|level| level.is_finite()) {
        return None;
    }
    let microphone = sound.microphones.first();
    let end = highest_frequency(run).min(sound.frequency_hz(sound.lines() - 1));
    let svg = sheet((WIDTH, 640), |area| {
        let parts = area.split_evenly((1 + usize::from(microphone.is_some()), 1));
        let last = |k: usize| (k + 1 == parts.len()).then_some("frequency [Hz]");
        let [level, weighted] = sound.power_levels();
        let words = format!("sound power {} dB, {} dB(A)", fixed(level, 1), fixed(weighted, 1));
        let beside = "power level [dB re 1 pW]";
        let mut chart = lines(&parts[0], sound, (&power, ALARM), end, [beside, &words], last(0))?;
        label(&parts[0], &mut chart, sound, &power, end)?;
        if let (Some(part), Some(microphone)) = (parts.get(1), microphone) {
            let count = microphone.spectrum.amplitude.len();
            let levels: Vec<f64> =
                (0..count).map(|k| pressure_level(microphone.spectrum.mean_square(k))).collect();
            let [level, weighted] = microphone.levels();
            let words = format!("{}: {} dB, {} dB(A)", microphone.name, fixed(level, 1), fixed(weighted, 1));
            let beside = "pressure level [dB re 20 µPa]";
            lines(part, sound, (&levels, SECOND), end, [beside, &words], last(1))?;
        }
        Ok(())
    })?;
    let caption = format!(
        "Sound from {} to {} s, level of each line of {} Hz: power of all plates, both sides{}. Each plate as if in an infinite rigid baffle.",
        given(sound.window[0]),
        given(sound.window[1]),
        significant(sound.resolution_hz, 3),
        microphone.map_or(String::new(), |h| format!("; pressure at microphone {}", h.name))
    );
    Some(Picture { file: "sound".into(), caption, svg })
}

fn lines<'a>(
    area: &Area<'a>,
    sound: &Sound,
    (levels, ink): (&[f64], &str),
    end: f64,
    [beside, words]: [&str; 2],
    below: Option<&str>,
) -> Result<crate::report::axes::Chart<'a>, Box<dyn Error>> {
    let highest = levels.iter().skip(1).filter(|l| l.is_finite()).fold(f64::NEG_INFINITY, |m, l| m.max(*l));
    let highest = if highest.is_finite() { highest } else { 0.0 };
    let (top, floor) = (highest + 14.0, highest - DEPTH);
    let mut chart = axes(area, (0.0..end, floor..top), below, beside, |v| fixed(v, 0))?;
    let points = levels.iter().enumerate().skip(1).map(|(k, l)| (sound.frequency_hz(k), l.max(floor)));
    let path: Vec<(f64, f64)> = points.take_while(|(hz, _)| *hz <= end).collect();
    chart.draw_series([PathElement::new(path, colour(ink).stroke_width(1))])?;
    let (x, y) = chart.backend_coord(&(end, top));
    let (left, upper) = area.get_base_pixel();
    let style = bold(13.0, INK).pos(Pos::new(HPos::Right, VPos::Top));
    area.draw_text(words, &style, (x - left - 8, y - upper + 6))?;
    Ok(chart)
}

/// The frequencies of the tones.
fn label(
    area: &Area,
    chart: &mut crate::report::axes::Chart,
    sound: &Sound,
    levels: &[f64],
    end: f64,
) -> Result<(), Box<dyn Error>> {
    let (left, upper) = area.get_base_pixel();
    let mut taken: Vec<i32> = Vec::new();
    let mut tones: Vec<_> = sound.tones.iter().filter(|tone| tone.peak.frequency_hz < end).collect();
    tones.sort_by(|a, b| b.power.total_cmp(&a.power));
    for tone in tones {
        let line = (tone.peak.frequency_hz / sound.resolution_hz).round() as usize;
        let (x, y) = chart.backend_coord(&(tone.peak.frequency_hz, levels[line.min(levels.len() - 1)]));
        if taken.iter().all(|u| (u - x).abs() >= 60) {
            taken.push(x);
            let words = format!("{} Hz", hertz(tone.peak.frequency_hz, 0));
            area.draw_text(&words, &above(text(12.0, INK)), (x - left, y - upper - 4))?;
        }
    }
    Ok(())
}

/// How loud a run is.
pub(in crate::report) fn table(run: &TransientResult, real_modes: &[String]) -> Option<ReportTable> {
    let sound = run.sound.as_ref()?;
    let headings = ["tone [Hz]", "power level [dB]", "share of the power [%]", "<is"];
    let [level, weighted] = sound.power_levels();
    let caption = format!(
        "Sound power from {} to {} s: {} dB, {} dB(A) re 1 pW",
        given(sound.window[0]),
        given(sound.window[1]),
        fixed(level, 1),
        fixed(weighted, 1)
    );
    let mut table = ReportTable::new(caption, &headings);
    for tone in &sound.tones {
        let cells = vec![
            hertz(tone.peak.frequency_hz, 1),
            fixed(power_level(tone.power), 1),
            fixed(100.0 * tone.share, 1),
            tone.peak.relation.clone(),
        ];
        table.row(cells, false);
    }
    for microphone in &sound.microphones {
        let [level, weighted] = microphone.levels();
        let [x, y, z] = microphone.at.map(|c| fixed(c, 3));
        table.notes.push(format!(
            "Microphone {} at ({x}, {y}, {z}) m: {} dB, {} dB(A) re 20 µPa.",
            microphone.name,
            fixed(level, 1),
            fixed(weighted, 1)
        ));
    }
    let mean = sound.mean_levels(1.0);
    table.notes.push(format!(
        "Mean over all directions at 1 m: {} dB, {} dB(A). On a disc's axis only its modes without nodal diameters contribute.",
        fixed(mean[0], 1),
        fixed(mean[1], 1)
    ));
    let whole: f64 = sound.plates.iter().flat_map(|(_, lines)| lines).sum();
    let percent = |part: f64| format!("{} %", significant(100.0 * part, 3));
    let plates: Vec<String> = sound
        .plates
        .iter()
        .map(|(name, lines)| format!("{name} {}", percent(lines.iter().sum::<f64>() / whole)))
        .collect();
    let mut modes: Vec<(f64, &String)> = sound.mode_shares.iter().copied().zip(real_modes).collect();
    modes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let modes: Vec<String> =
        modes.iter().take(MODES).map(|(share, name)| format!("{name} {}", percent(*share))).collect();
    if whole > 0.0 {
        table.notes.push(format!("Of the power: {}. By modes: {}.", plates.join(", "), modes.join(", ")));
    }
    if let Some(first) = sound.microphones.first() {
        table.notes.push(format!(
            "sound_{}.wav: the pressure there, 48 kHz, full scale {} Pa.",
            first.name,
            significant(sound.recording.full_scale(), 3)
        ));
    }
    let limits = "Rayleigh's integral: each plate in an infinite rigid baffle, nothing reflected; an upper estimate \
                  for frequencies at which bending waves are slower than sound.";
    table.notes.push(limits.into());
    Some(table)
}
