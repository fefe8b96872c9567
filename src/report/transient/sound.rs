//! `sound.svg` and the table: how loud it is.

use super::spectra::highest_frequency;
use crate::report::chart::{Axis, Chart, WIDTH, ends, wide};
use crate::report::colours::{ALARM, INK, MEASURED, MUTED, SECOND};
use crate::report::format::{fixed, given, hertz, significant};
use crate::report::section::Picture;
use crate::report::svg::{Sheet, ink, stroke};
use crate::report::table::ReportTable;
use crate::results::{MicrophoneSound, RunResults, Sound, TransientResult};
use crate::sound::{power_level, pressure_level};

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
    let mut sheet = Sheet::new(WIDTH, 640.0);
    let parts = if microphones.is_empty() { 1.0 } else { 2.0 };
    let height = 618.0 / parts;
    let below = if microphones.is_empty() { "frequency [Hz]" } else { "" };
    let mut chart =
        lines(&mut sheet, [10.0, height - 30.0], sound, &whole, end, ["power level [dB re 1 pW]", below]);
    label(&mut chart, sound, &whole[0].0, end);
    chart.draw(&mut sheet);
    if !microphones.is_empty() {
        let names = ["pressure level [dB re 20 µPa]", "frequency [Hz]"];
        lines(&mut sheet, [height + 10.0, 2.0 * height - 30.0], sound, &microphones, end, names)
            .draw(&mut sheet);
    }
    let names: Vec<&str> = sound.microphones.iter().map(|m| m.name.as_str()).collect();
    let at = match names.len() {
        0 => String::new(),
        1 => format!("; pressure at microphone {}", names[0]),
        _ => format!("; pressure at the microphones {}", names.join(", ")),
    };
    let caption = format!(
        "Sound from {} to {} s, level of each line of {} Hz: power of all plates, both sides, and faces of solids{at}. Each as if in an infinite rigid baffle.",
        given(sound.window[0]),
        given(sound.window[1]),
        significant(sound.resolution_hz, 3)
    );
    Some(Picture { file: "sound".into(), caption, svg: sheet.finish() })
}

/// A panel with curves between two heights, named in its upper right corner.
fn lines(
    sheet: &mut Sheet,
    [upper, lower]: [f64; 2],
    sound: &Sound,
    curves: &Curves,
    end: f64,
    [beside, below]: [&str; 2],
) -> Chart {
    let [_, highest] = ends(curves.iter().flat_map(|(levels, ..)| levels.iter().skip(1).copied()));
    let highest = if highest.is_finite() { highest } else { 0.0 };
    let (top, floor) = (highest + NAME * (1.0 + curves.len() as f64), highest - DEPTH);
    let mut chart = Chart::new(wide(upper, lower), Axis::new(below, 0.0..end), Axis::new(beside, floor..top));
    let several = curves.len() > 1;
    for (k, (levels, hex, words)) in curves.iter().enumerate() {
        let points = levels.iter().enumerate().skip(1).map(|(k, l)| [sound.frequency_hz(k), l.max(floor)]);
        // Later ones are thinner, so that equal curves do not hide each other.
        let width = 1 + (curves.len() - 1 - k).min(3);
        chart.line(points, &stroke(hex, width as f64));
        let [x, y] = [WIDTH - 30.0, upper + 18.0 + 18.0 * k as f64];
        sheet.text([if several { x - 26.0 } else { x }, y], words, ink(13.0, INK).bold().end());
        if several {
            sheet.line([[x - 20.0, y - 4.0], [x, y - 4.0]], &stroke(hex, 3.0));
        }
    }
    chart
}

/// The frequencies of the tones.
fn label(chart: &mut Chart, sound: &Sound, levels: &[f64], end: f64) {
    let mut tones: Vec<_> = sound.tones.iter().filter(|tone| tone.peak.frequency_hz < end).collect();
    tones.sort_by(|a, b| b.power.total_cmp(&a.power));
    for hz in tones.iter().map(|tone| tone.peak.frequency_hz) {
        let line = (hz / sound.resolution_hz).round() as usize;
        chart.label_if_free([hz, levels[line.min(levels.len() - 1)]], &format!("{} Hz", hertz(hz, 0)));
    }
}

/// How loud a run is.
pub(in crate::report) fn table(run: &TransientResult) -> Option<ReportTable> {
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
    let mut modes: Vec<(f64, &String)> = sound.mode_shares.iter().copied().zip(&sound.mode_names).collect();
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
