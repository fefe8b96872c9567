//! `sensitivity.svg`: the scalars that move the growth rate of each chosen mode most, by 1 % of themselves.

use super::chart::WIDTH;
use super::colours::{ALARM, INK, MEASURED, MUTED};
use super::format::{hertz, signed, significant};
use super::section::Picture;
use super::svg::{Sheet, ink, stroke};
use crate::results::{ModeSensitivity, ParameterRate, RunResults, SensitivityResult};
use std::f64::consts::TAU;

/// Modes at most, the strongest growth first.
const MOST_MODES: usize = 6;
/// Scalars at most for each mode.
const MOST: usize = 9;
const LABELS: f64 = 330.0;
const ROW: f64 = 22.0;
const HEAD: f64 = 40.0;
const GAP: f64 = 14.0;

/// The picture, when some scalar moves some mode.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let all = &results.get::<SensitivityResult>()?.modes;
    let mut modes: Vec<&ModeSensitivity> = all.iter().filter(|mode| !strongest(mode).is_empty()).collect();
    modes.sort_by(|a, b| b.eigenvalue.re.total_cmp(&a.eigenvalue.re));
    modes.truncate(MOST_MODES);
    modes.sort_by(|a, b| a.eigenvalue.im.total_cmp(&b.eigenvalue.im));
    if modes.is_empty() {
        return None;
    }
    let height = |mode: &ModeSensitivity| HEAD + ROW * strongest(mode).len() as f64 + GAP;
    let total: f64 = modes.iter().map(|mode| height(mode)).sum();
    let mut sheet = Sheet::new(WIDTH, total + 34.0);
    let mut top = 8.0;
    for mode in &modes {
        draw(&mut sheet, top, mode);
        top += height(mode);
    }
    let foot = "change of the growth rate [1/s] when the scalar grows by 1 % of its value; orange: the mode grows faster";
    sheet.text([0.5 * WIDTH, top + 12.0], foot, ink(13.0, MUTED).middle());
    let caption =
        "Largest sensitivities of the growth rate of each mode, the steady state following every scalar."
            .to_string();
    Some(Picture { file: "sensitivity".into(), caption, svg: sheet.finish() })
}

/// The scalars with the largest effect, those that matter at all.
fn strongest(mode: &ModeSensitivity) -> Vec<&ParameterRate> {
    let effect = |p: &ParameterRate| p.growth_per_percent().abs();
    let largest = mode.parameters.iter().map(effect).filter(|e| e.is_finite()).fold(0.0, f64::max);
    let matters =
        |p: &&ParameterRate| p.moves_growth() && effect(p) > 1e-3 * largest && effect(p).is_finite();
    mode.parameters.iter().filter(matters).take(MOST).collect()
}

fn draw(sheet: &mut Sheet, top: f64, mode: &ModeSensitivity) {
    let title = format!(
        "{} Hz, growth rate {} 1/s",
        hertz(mode.eigenvalue.im / TAU, 0),
        signed(mode.eigenvalue.re, 2)
    );
    sheet.text([18.0, top + 22.0], &title, ink(15.0, INK).bold());
    let shown = strongest(mode);
    let largest = shown.iter().map(|p| p.growth_per_percent().abs()).fold(f64::MIN_POSITIVE, f64::max);
    // Space for the figures at both ends.
    let zero = LABELS + 0.5 * (WIDTH - LABELS);
    let reach = 0.5 * (WIDTH - LABELS) - 96.0;
    for (k, p) in shown.iter().enumerate() {
        let y = top + HEAD + ROW * k as f64;
        let effect = p.growth_per_percent();
        let dagger = if p.kink { " †" } else { "" };
        sheet.text([LABELS, y + 12.0], &format!("{}{dagger}", p.path), ink(13.0, INK).end());
        let (hex, sign) = if effect > 0.0 { (ALARM, "+") } else { (MEASURED, "") };
        let figure = format!("{sign}{}", significant(effect, 3));
        sheet.bar([zero, y - 1.0], [reach * effect / largest, ROW - 6.0], hex, &figure);
    }
    let bottom = top + HEAD + ROW * shown.len() as f64 - 4.0;
    sheet.line([[zero, top + HEAD - 5.0], [zero, bottom]], &stroke(INK, 1.2));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;

    #[test]
    fn the_strongest_scalars_have_bars_with_signs() {
        let mut results = sample::rig();
        let modes = &mut results.get_mut::<SensitivityResult>().unwrap().modes;
        let scalars = &mut modes[0].parameters;
        // 310 1/s × 0.6 × 1 % = 1.86; −1.05e4 × 0.0035 × 1 % = −0.3675.
        for scalar in scalars.iter_mut() {
            match scalar.path.as_str() {
                "contact.rim.friction.mu0" => scalar.rate.re = 310.0,
                "damping.modal_ratio" => scalar.rate.re = -1.05e4,
                path => scalar.kink = path.ends_with("lead_angle"),
            }
        }
        let svg = picture(&results).unwrap().svg;
        for label in ["contact.rim.friction.mu0", "+1.86", "−0.36", "lead_angle †", "332 Hz"] {
            assert!(svg.contains(label), "{label}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert!(picture(&RunResults::default()).is_none());
    }
}
