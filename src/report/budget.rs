//! `growth_budget.svg`: which terms make each unstable mode grow, and which hold it back.

use super::chart::{Axis, Chart, WIDTH, ends, widened};
use super::colours::INK;
use super::format::{hertz, signed};
use super::html::described;
use super::section::Picture;
use super::svg::{Key, Sheet, fill, ink, stroke};
use crate::results::{ComplexResult, RunResults};
use crate::stability::{ComplexMode, GrowthBudget};

/// The strongest modes get a bar.
const MOST: usize = 12;
/// Left edge of the names of the terms \[px\].
const NAMES: f64 = 790.0;

/// A term's name, its colour and its part of the growth rate.
type BudgetTerm = (&'static str, &'static str, fn(&GrowthBudget) -> f64);

/// The terms in the order of the stack, with colours of Okabe and Ito's set.
const TERMS: [BudgetTerm; 4] = [
    ("mode coupling", "#d55e00", |b| b.mode_coupling),
    ("falling friction", "#e69f00", |b| b.falling_friction),
    ("transverse friction", "#56b4e9", |b| b.transverse_friction),
    ("structural damping", "#5f6b76", |b| b.structural_damping),
];

/// The picture, when a mode is unstable.
pub(super) fn picture(results: &RunResults) -> Option<Picture> {
    let all = &results.get::<ComplexResult>()?.modes.modes;
    let mut modes: Vec<&ComplexMode> =
        all.iter().filter(|m| m.unstable() && m.growth_rate().is_finite()).collect();
    modes.sort_by(|a, b| b.growth_rate().total_cmp(&a.growth_rate()));
    modes.truncate(MOST);
    modes.sort_by(|a, b| a.frequency_hz().total_cmp(&b.frequency_hz()));
    if modes.is_empty() {
        return None;
    }
    let caption =
        "Where the growth of each unstable mode comes from; the terms add up to σ (black line).".to_string();
    Some(Picture { file: "growth_budget".into(), caption, svg: described(&drawn(&modes), &seen(&modes)) })
}

/// The largest term of each mode that feeds it.
fn seen(modes: &[&ComplexMode]) -> String {
    let each = modes.iter().map(|mode| {
        let largest = TERMS.iter().max_by(|a, b| a.2(&mode.growth).total_cmp(&b.2(&mode.growth)));
        let (name, _, term) = largest.expect("there are four");
        format!("{} {} 1/s at {} Hz", name, signed(term(&mode.growth), 1), hertz(mode.frequency_hz(), 0))
    });
    format!("What feeds each unstable mode most: {}.", each.collect::<Vec<_>>().join("; "))
}

/// The ends of the stack: what feeds the mode and what takes from it.
fn span(budget: &GrowthBudget) -> [f64; 2] {
    let terms = TERMS.map(|(_, _, term)| term(budget));
    [terms.iter().map(|t| t.min(0.0)).sum(), terms.iter().map(|t| t.max(0.0)).sum()]
}

fn drawn(modes: &[&ComplexMode]) -> String {
    let up = widened(ends(modes.iter().flat_map(|m| span(&m.growth)).chain([0.0])), 0.1);
    let slots = modes.len().max(4) as f64;
    let mut sheet = Sheet::new(WIDTH, 460.0);
    let across = Axis::new("", -0.5..slots - 0.5).at([]).bare();
    let foot = up.start;
    let mut chart =
        Chart::new([94.0, 16.0, NAMES - 16.0, 404.0], across, Axis::new("part of the growth rate [1/s]", up));
    for (mode, x) in modes.iter().zip((0..).map(f64::from)) {
        let (mut down, mut top) = (0.0, 0.0);
        for (_, hex, term) in TERMS {
            let value = term(&mode.growth);
            let base = if value < 0.0 { &mut down } else { &mut top };
            chart.bar([[x - 0.28, *base], [x + 0.28, *base + value]], &fill(hex));
            *base += value;
        }
        let sigma = mode.growth_rate();
        chart.line([[x - 0.36, sigma], [x + 0.36, sigma]], &stroke("#000000", 3.0));
        let words = format!("σ {}", signed(sigma, 1));
        chart.text([x, top.max(sigma)], [0.0, -8.0], &words, ink(12.5, INK).bold().middle());
        let words = format!("{} Hz", hertz(mode.frequency_hz(), 0));
        chart.text([x, foot], [0.0, 20.0], &words, ink(13.5, INK).bold().middle());
    }
    chart.rule(1, 0.0, &stroke(INK, 2.0));
    chart.draw(&mut sheet);
    let terms = TERMS.map(|(name, hex, _)| (Key::Box(fill(hex)), name));
    let mut y = 32.0;
    for (key, name) in terms.into_iter().chain([(Key::Line(stroke("#000000", 3.0)), "σ, their sum")]) {
        y = sheet.keys([NAMES + 4.0, y], [(key, name.to_string())]) + 8.0;
    }
    sheet.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

    #[test]
    fn the_stack_ends_where_the_terms_do_and_adds_up() {
        let results = sample::rig();
        for mode in results.get::<ComplexResult>().unwrap().modes.modes.iter() {
            let [low, high] = span(&mode.growth);
            assert!(low <= 0.0 && high >= 0.0);
            // The terms are computed apart: their sum is σ but for round-off of λ.
            assert!(within(
                (low + high - mode.growth_rate()).abs(),
                1e-10 * mode.eigenvalue.norm(),
                RoundOff
            ));
        }
        let svg = picture(&results).unwrap().svg;
        assert!(["332 Hz", "σ +13.0", "mode coupling"].iter().all(|label| svg.contains(label)));
        assert!(!svg.contains("632 Hz"), "stable modes have no bar");
    }

    #[test]
    fn round_off_and_absurd_growth_draw_too() {
        for factor in [1e-300, 1e-15, 1e-6, 1e12, 1e300] {
            let mut results = sample::rig();
            for mode in &mut results.get_mut::<ComplexResult>().unwrap().modes.modes {
                mode.eigenvalue.re *= factor;
                mode.growth.mode_coupling *= factor;
            }
            assert_eq!(picture(&results).is_some(), factor >= 1e-6, "{factor}: nothing grows by round-off");
            assert!(super::super::growth::picture(&results).is_some(), "{factor}");
        }
    }
}
