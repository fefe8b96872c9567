//! `participation.svg`: the real modes that take part in each unstable mode, as stacked bars.

use super::chart::WIDTH;
use super::colours::{ALARM_TEXT, INK, MUTED};
use super::format::{fixed, hertz, signed};
use super::html::described;
use super::section::Picture;
use super::svg::{Sheet, ink, outlined, stroke};
use crate::results::{ComplexResult, RunResults};
use crate::stability::{ComplexMode, Verdict};

/// The strongest modes get a bar.
const MOST: usize = 12;
/// Where none is unstable, the modes nearest to it.
const NEAREST: usize = 6;
/// Smaller shares are among the others.
const SMALLEST: f64 = 0.05;
const LEFT: f64 = 140.0;
const LENGTH: f64 = WIDTH - LEFT - 24.0;
const HEAD: f64 = 12.0;
const ROW: f64 = 62.0;
const BAR: f64 = 26.0;
/// Width of a letter of a label, at most on average \[px\].
const LETTER: f64 = 6.8;
/// Light enough for dark letters; the same real mode has one colour in every bar.
pub(super) const FILLS: [&str; 12] = [
    "#9fc9e8", "#f5c98a", "#a5d9c4", "#e3b3d1", "#f2e58f", "#b9bfe6", "#f0b29c", "#c9d9a0", "#8fd3d9",
    "#d9c3a9", "#cfa9e0", "#b5c4cc",
];
pub(super) const OTHERS: &str = "#e2e5e9";

/// The picture, when the run has complex modes.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let complex = results.get::<ComplexResult>()?;
    let modes = chosen(&complex.modes.modes);
    let unstable = modes.first()?.unstable();
    let mut sheet = Sheet::new(WIDTH, HEAD + ROW * modes.len() as f64);
    let mut coloured = Vec::new();
    for (k, mode) in modes.iter().enumerate() {
        draw(&mut sheet, HEAD + ROW * k as f64, mode, complex, &mut coloured);
    }
    let which = if unstable {
        "each unstable mode"
    } else if complex.modes.modes.iter().all(|m| m.verdict() == Verdict::Stable) {
        "the modes that die away most slowly (none is unstable)"
    } else {
        "the modes that die away most slowly (none grows for certain)"
    };
    let percent = fixed(100.0 * SMALLEST, 0);
    let caption = format!(
        "The real modes that take part in {which}, by their share in its shape; those below {percent} % are the others."
    );
    let each = modes.iter().filter_map(|mode| {
        let (real, share) = mode.participation.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let name = complex.real_modes.get(*real).filter(|name| !name.is_empty());
        let name = name.cloned().unwrap_or_else(|| format!("mode {}", real + 1));
        Some(format!("{} Hz: {} % {name}", hertz(mode.frequency_hz(), 0), fixed(100.0 * share, 0)))
    });
    let seen = format!("The largest share of each mode: {}.", each.collect::<Vec<_>>().join("; "));
    Some(Picture { file: "participation".into(), caption, svg: described(&sheet.finish(), &seen) })
}

/// The unstable modes or, where there is none, those nearest to it; ascending in frequency.
pub(super) fn chosen(all: &[ComplexMode]) -> Vec<&ComplexMode> {
    let mut modes: Vec<&ComplexMode> = all.iter().filter(|m| m.growth_rate().is_finite()).collect();
    modes.sort_by(|a, b| b.growth_rate().total_cmp(&a.growth_rate()));
    let unstable = modes.iter().filter(|m| m.unstable()).count();
    modes.truncate(if unstable > 0 { unstable.min(MOST) } else { NEAREST });
    modes.sort_by(|a, b| a.frequency_hz().total_cmp(&b.frequency_hz()));
    modes
}

/// One bar; `coloured` are the real modes that have their colour already.
fn draw(sheet: &mut Sheet, top: f64, mode: &ComplexMode, complex: &ComplexResult, coloured: &mut Vec<usize>) {
    let colour = if mode.unstable() { ALARM_TEXT } else { INK };
    let name = format!("{} Hz", hertz(mode.frequency_hz(), 0));
    sheet.text([LEFT - 12.0, top + 13.0], &name, ink(14.0, colour).bold().end());
    let rate = format!("σ {} 1/s", signed(mode.growth_rate(), 2));
    sheet.text([LEFT - 12.0, top + 29.0], &rate, ink(12.0, MUTED).end());
    let shown = mode.participation.iter().filter(|(_, share)| *share >= SMALLEST);
    let mut parts: Vec<(String, &str, f64)> = shown
        .map(|(real, share)| {
            let place = coloured.iter().position(|other| other == real).unwrap_or_else(|| {
                coloured.push(*real);
                coloured.len() - 1
            });
            let label =
                complex.real_modes.get(*real).cloned().unwrap_or_else(|| format!("mode {}", real + 1));
            (format!("{label} {} %", fixed(100.0 * share, 0)), FILLS[place % FILLS.len()], *share)
        })
        .collect();
    let others = 1.0 - parts.iter().map(|(_, _, share)| share).sum::<f64>();
    if others > 5e-3 {
        parts.push((format!("others {} %", fixed(100.0 * others, 0)), OTHERS, others));
    }
    let mut start = LEFT;
    let mut narrow = Vec::new();
    let label = ink(12.0, INK).middle();
    for (text, fill, share) in &parts {
        let length = LENGTH * share;
        let middle = start + 0.5 * length;
        sheet.rectangle([start, top], [length, BAR], &outlined(fill, "#ffffff", 1.0));
        let width = LETTER * text.chars().count() as f64;
        if width + 6.0 <= length {
            sheet.text([middle, top + 17.0], text, label);
        } else {
            narrow.push((text, middle, width));
        }
        start += length;
    }
    // What does not fit stands below, from the right end on: the narrow parts are the last ones.
    let mut limit = LEFT + LENGTH;
    for (text, middle, width) in narrow.into_iter().rev() {
        let end = limit.min(middle + 0.5 * width);
        let below = [end - 0.5 * width, top + BAR + 16.0];
        sheet.line([[middle, top + BAR], [below[0], below[1] - 11.0]], &stroke(MUTED, 0.8));
        sheet.text(below, text, label);
        limit = end - width - 8.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn every_unstable_mode_has_a_bar_of_named_shares_and_the_rest() {
        let svg = picture(&sample::rig()).unwrap().svg;
        for label in ["276 Hz", "332 Hz", "569 Hz", "disc (0, 0) 67 %", "others 2 %"] {
            assert!(svg.contains(label), "{label} not in\n{svg}");
        }
        assert!(!svg.contains("632 Hz") && !svg.contains("NaN"), "stable modes have no bar");
    }

    #[test]
    fn without_an_unstable_mode_the_nearest_have_bars() {
        let mut results = sample::rig();
        let modes = &mut results.get_mut::<ComplexResult>().unwrap().modes.modes;
        modes.iter_mut().for_each(|m| m.eigenvalue.re -= 1000.0);
        modes[0].participation.clear();
        let picture = picture(&results).unwrap();
        assert!(picture.caption.contains("none is unstable"));
        assert_eq!(picture.svg.matches(" Hz<").count(), NEAREST);
        results.get_mut::<ComplexResult>().unwrap().modes.modes.clear();
        assert!(super::picture(&results).is_none());
    }
}
