//! `growth_budget.svg`: which terms make each unstable mode grow, and which hold it back.

use super::chart::{Area, above, below, bold, colour, sheet, text, widened};
use super::colours::{INK, MUTED};
use super::format::{given, hertz, signed};
use super::html::described;
use super::section::Picture;
use crate::results::{ComplexResult, RunResults};
use crate::stability::{ComplexMode, GrowthBudget};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// The strongest modes get a bar.
const MOST: usize = 12;
const SIZE: (u32, u32) = (980, 460);

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
    let svg = sheet(SIZE, |area| draw(area, &modes))?;
    let caption =
        "Where the growth of each unstable mode comes from; the terms add up to σ (black line).".to_string();
    Some(Picture { file: "growth_budget".into(), caption, svg: described(&svg, &seen(&modes)) })
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
fn ends(budget: &GrowthBudget) -> (f64, f64) {
    let terms = TERMS.map(|(_, _, term)| term(budget));
    (terms.iter().map(|t| t.min(0.0)).sum(), terms.iter().map(|t| t.max(0.0)).sum())
}

fn draw(area: &Area, modes: &[&ComplexMode]) -> Result<(), Box<dyn Error>> {
    let (plot, legend) = area.split_horizontally(SIZE.0 - 190);
    let spans: Vec<(f64, f64)> = modes.iter().map(|m| ends(&m.growth)).collect();
    let low = spans.iter().map(|s| s.0).fold(0.0, f64::min);
    let high = spans.iter().map(|s| s.1).fold(0.0, f64::max);
    let up = widened(low, high, 0.1);
    let slots = modes.len().max(4) as f64;
    let mut chart = ChartBuilder::on(&plot)
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(78)
        .build_cartesian_2d(-0.5..slots - 0.5, up.clone())?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour("#e6e9ed"))
        .axis_style(colour(MUTED))
        .label_style(text(13.0, INK))
        .axis_desc_style(text(14.0, INK))
        .y_desc("part of the growth rate [1/s]")
        .x_labels(0)
        .y_label_formatter(&|sigma| given(*sigma))
        .draw()?;
    for (k, mode) in modes.iter().enumerate() {
        let (mut down, mut top) = (0.0, 0.0);
        let x = k as f64;
        for (_, hex, term) in TERMS {
            let value = term(&mode.growth);
            let base = if value < 0.0 { &mut down } else { &mut top };
            let bar = Rectangle::new([(x - 0.28, *base), (x + 0.28, *base + value)], colour(hex).filled());
            *base += value;
            chart.draw_series([bar])?;
        }
        let sigma = mode.growth_rate();
        chart
            .draw_series([PathElement::new([(x - 0.36, sigma), (x + 0.36, sigma)], BLACK.stroke_width(3))])?;
        let (px, py) = chart.backend_coord(&(x, top.max(sigma)));
        let label = above(bold(12.5, INK));
        plot.draw_text(&format!("σ {}", signed(sigma, 1)), &label, (px, py - 6))?;
        let (px, py) = chart.backend_coord(&(x, up.start));
        plot.draw_text(
            &format!("{} Hz", hertz(mode.frequency_hz(), 0)),
            &below(bold(13.5, INK)),
            (px, py + 8),
        )?;
    }
    chart.draw_series([PathElement::new([(-0.5, 0.0), (slots - 0.5, 0.0)], colour(INK).stroke_width(2))])?;
    let beside = |style: TextStyle<'static>| style.pos(Pos::new(HPos::Left, VPos::Center));
    for (k, (name, hex, _)) in TERMS.iter().enumerate() {
        let y = 40 + 28 * k as i32;
        legend.draw(&Rectangle::new([(4, y - 8), (20, y + 8)], colour(hex).filled()))?;
        legend.draw_text(name, &beside(text(13.5, INK)), (30, y))?;
    }
    let y = 40 + 28 * TERMS.len() as i32;
    legend.draw(&PathElement::new([(2, y), (22, y)], BLACK.stroke_width(3)))?;
    legend.draw_text("σ, their sum", &beside(text(13.5, INK)), (30, y))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn the_stack_ends_where_the_terms_do_and_adds_up() {
        let results = sample::rig();
        for mode in results.get::<ComplexResult>().unwrap().modes.modes.iter() {
            let (low, high) = ends(&mode.growth);
            assert!(low <= 0.0 && high >= 0.0 && (low + high - mode.growth_rate()).abs() < 1e-9);
        }
        let svg = picture(&results).unwrap().svg;
        assert!(["942 Hz", "σ +111.8", "mode coupling"].iter().all(|label| svg.contains(label)));
        assert!(!svg.contains("-642"), "stable modes have no bar");
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
