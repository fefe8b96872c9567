//! `transient_spectrum.svg`: motion and friction over frequency.

use crate::report::chart::{Axis, Chart, WIDTH, wide};
use crate::report::colours::{ALARM, MEASURED, SECOND};
use crate::report::format::{given, hertz, multiple, significant};
use crate::report::section::Picture;
use crate::report::svg::{Sheet, ink, sheer, stroke};
use crate::results::{Channel, RunResults, SpectrumOf, TransientResult};

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
    let mut sheet = Sheet::new(WIDTH, 310.0 * shown.len() as f64 + 22.0);
    for (k, of) in shown.iter().enumerate() {
        let style = stroke(if k == 0 { ALARM } else { SECOND }, 1.0);
        let below = if k + 1 == shown.len() { "frequency [Hz]" } else { "" };
        let top = 10.0 + 310.0 * k as f64;
        let across = Axis::new(below, 0.0..end);
        lines((top, across), (of, &run.channels[of.channel]), end, &style).draw(&mut sheet);
    }
    let [begin, stop] = first.window;
    let caption = format!(
        "Spectra from {} to {} s (Welch, Hann window, amplitude of a sine, lines every {} Hz).",
        given(begin),
        given(stop),
        significant(first.spectrum.resolution_hz, 3)
    ) + if measured { " Blue: measured." } else { "" };
    Some(Picture { file: "transient_spectrum".into(), caption, svg: sheet.finish() })
}

fn lines((top, across): (f64, Axis), (of, channel): (&SpectrumOf, &Channel), end: f64, style: &str) -> Chart {
    let amplitude = &of.spectrum.amplitude;
    let highest = amplitude.iter().skip(2).fold(f64::MIN_POSITIVE, |m: f64, v| m.max(*v));
    let unit = multiple(highest, channel.unit);
    let highest = (highest / unit.size).log10();
    let (head, floor) = (highest + 0.7, highest - DECADES);
    let up = Axis::log(format!("{} [{}]", channel.words(), unit.unit), floor..head, 1.0);
    let mut chart = Chart::new(wide(top, top + 268.0), across, up);
    for hz in of.measured.iter().filter(|hz| **hz < end) {
        chart.flag(*hz, &given(*hz), &sheer(stroke(MEASURED, 1.0), 0.6), ink(11.5, MEASURED));
    }
    let lowest = 10f64.powf(floor);
    let value = |(k, a): (usize, &f64)| [of.spectrum.frequency_hz(k), (a / unit.size).max(lowest)];
    chart.line(amplitude.iter().enumerate().map(value), style);
    let mut strongest: Vec<_> = of.peaks.iter().collect();
    strongest.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    for peak in strongest.into_iter().filter(|peak| peak.frequency_hz < end) {
        let at = [peak.frequency_hz, peak.amplitude / unit.size];
        chart.label_if_free(at, &format!("{} Hz", hertz(peak.frequency_hz, 0)));
    }
    chart
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
