//! `sound.svg` and the table: how loud it is.

use super::spectra::highest_frequency;
use crate::report::axes::{Chart, WIDTH, axes};
use crate::report::chart::{Area, above, bold, colour, sheet, text};
use crate::report::colours::{ALARM, INK, MEASURED, MUTED, SECOND};
use crate::report::format::{fixed, given, hertz, significant};
use crate::report::section::Picture;
use crate::report::table::ReportTable;
use crate::results::{MicrophoneSound, RunResults, Sound, TransientResult};
use crate::sound::{power_level, pressure_level};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// Decibels below the highest line that are shown.
const DEPTH: f64 = 70.0;
/// Height of the name of a curve above the highest line \[dB\].
const NAME: f64 = 7.0;
/// Colours of the microphones, in turn.
const INKS: [&str; 5] = [SECOND, MEASURED, "#cc79a7", "#b08a00", MUTED];
/// Modes that the table names.
const MODES: usize = 4;

/// Curves of one panel, each with its colour and the words that name it.
type Curves = Vec<(Vec<f64>, &'static str, String)>;

/// Sound power, and the pressure at every microphone, over frequency.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let run = results.get::<TransientResult>()?;
    let sound = run.sound.as_ref()?;
    let power: Vec<f64> = (0..sound.lines()).map(|k| power_level(sound.power(k))).collect();
    if !power.iter().any(|level| level.is_finite()) {
        return None;
    }
    let end = highest_frequency(run).min(sound.frequency_hz(sound.lines() - 1));
    let named = |name: &str, [level, weighted]: [f64; 2]| {
        format!("{name}: {} dB, {} dB(A)", fixed(level, 1), fixed(weighted, 1))
    };
    let pressure = |(k, microphone): (usize, &MicrophoneSound)| {
        let lines = 0..microphone.spectrum.amplitude.len();
        let levels = lines.map(|k| pressure_level(microphone.spectrum.mean_square(k))).collect();
        (levels, INKS[k % INKS.len()], named(&microphone.name, microphone.levels()))
    };
    let microphones: Curves = sound.microphones.iter().enumerate().map(pressure).collect();
    let whole: Curves = vec![(power, ALARM, named("sound power", sound.power_levels()))];
    let svg = sheet((WIDTH, 640), |area| {
        let parts = area.split_evenly((1 + usize::from(!microphones.is_empty()), 1));
        let last = |k: usize| (k + 1 == parts.len()).then_some("frequency [Hz]");
        let mut chart =
            lines(&parts[0], sound, &whole, end, ["power level [dB re 1 pW]", last(0).unwrap_or_default()])?;
        label(&parts[0], &mut chart, sound, &whole[0].0, end)?;
        if let Some(part) = parts.get(1) {
            lines(part, sound, &microphones, end, ["pressure level [dB re 20 µPa]", "frequency [Hz]"])?;
        }
        Ok(())
    })?;
    let names: Vec<&str> = sound.microphones.iter().map(|m| m.name.as_str()).collect();
    let at = match names.len() {
        0 => String::new(),
        1 => format!("; pressure at microphone {}", names[0]),
        _ => format!("; pressure at the microphones {}", names.join(", ")),
    };
    let caption = format!(
        "Sound from {} to {} s, level of each line of {} Hz: power of all plates, both sides{at}. Each plate as if in an infinite rigid baffle.",
        given(sound.window[0]),
        given(sound.window[1]),
        significant(sound.resolution_hz, 3)
    );
    Some(Picture { file: "sound".into(), caption, svg })
}

/// A panel with curves, named in its upper right corner.
fn lines<'a>(
    area: &Area<'a>,
    sound: &Sound,
    curves: &Curves,
    end: f64,
    [beside, below]: [&str; 2],
) -> Result<Chart<'a>, Box<dyn Error>> {
    let levels = curves.iter().flat_map(|(levels, ..)| levels.iter().skip(1));
    let highest = levels.filter(|l| l.is_finite()).fold(f64::NEG_INFINITY, |m, l| m.max(*l));
    let highest = if highest.is_finite() { highest } else { 0.0 };
    let (top, floor) = (highest + NAME * (1.0 + curves.len() as f64), highest - DEPTH);
    let below = Some(below).filter(|words| !words.is_empty());
    let mut chart = axes(area, (0.0..end, floor..top), below, beside, |v| fixed(v, 0))?;
    let (x, y) = chart.backend_coord(&(end, top));
    let (left, upper) = area.get_base_pixel();
    for (k, (levels, ink, words)) in curves.iter().enumerate() {
        let points = levels.iter().enumerate().skip(1).map(|(k, l)| (sound.frequency_hz(k), l.max(floor)));
        let path: Vec<(f64, f64)> = points.take_while(|(hz, _)| *hz <= end).collect();
        // Later ones are thinner, so that equal curves do not hide each other.
        let width = 1 + (curves.len() - 1 - k).min(3) as u32;
        chart.draw_series([PathElement::new(path, colour(ink).stroke_width(width))])?;
        let (x, y) = (x - left - 8, y - upper + 6 + 18 * k as i32);
        let style = bold(13.0, INK).pos(Pos::new(HPos::Right, VPos::Top));
        area.draw_text(words, &style, (x - 26 * i32::from(curves.len() > 1), y))?;
        if curves.len() > 1 {
            area.draw(&PathElement::new([(x - 20, y + 7), (x, y + 7)], colour(ink).stroke_width(3)))?;
        }
    }
    Ok(chart)
}

/// The frequencies of the tones.
fn label(
    area: &Area,
    chart: &mut Chart,
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
    for microphone in &sound.microphones {
        table.notes.push(format!(
            "sound_{}.wav: the pressure at that microphone, 48 kHz, full scale {} Pa.",
            microphone.name,
            significant(microphone.recording.full_scale(), 3)
        ));
    }
    let limits = "Rayleigh's integral: each plate in an infinite rigid baffle, nothing reflected; an upper estimate \
                  for frequencies at which bending waves are slower than sound.";
    table.notes.push(limits.into());
    Some(table)
}
