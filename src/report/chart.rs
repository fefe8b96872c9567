//! Common parts of the charts: a sheet of plotters' SVG backend, its text styles, axes that end on round numbers.

use super::chart_elements::elements;
use super::html::allowed;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// The typeface of the page and of the hand-drawn pictures.
const FONT: &str = "system-ui, 'Segoe UI', Helvetica, Arial, sans-serif";

/// A sheet, or a part of one, to draw on.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws on a white sheet of `size` pixels; `None` where plotters refuses, which a string never does.
pub(super) fn sheet(
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<(), Box<dyn Error>>,
) -> Option<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).ok()?;
        draw(&area).ok()?;
        area.present().ok()?;
    }
    // plotters writes control characters as they are.
    Some(allowed(&elements(&svg)))
}

/// A colour of [`super::colours`], written `#rrggbb`.
pub(super) fn colour(hex: &str) -> RGBColor {
    let channel = |k: usize| hex.get(k..k + 2).and_then(|two| u8::from_str_radix(two, 16).ok()).unwrap_or(0);
    RGBColor(channel(1), channel(3), channel(5))
}

/// Text of `pixels` height; plotters draws a font at 1/1.24 of the size it is given.
pub(super) fn text(pixels: f64, hex: &str) -> TextStyle<'static> {
    (FONT, pixels * 1.24).into_font().color(&colour(hex))
}

/// The same in bold.
pub(super) fn bold(pixels: f64, hex: &str) -> TextStyle<'static> {
    (FONT, pixels * 1.24).into_font().style(FontStyle::Bold).color(&colour(hex))
}

/// Hangs a text from the middle of its lower edge.
pub(super) fn above(style: TextStyle<'static>) -> TextStyle<'static> {
    style.pos(Pos::new(HPos::Center, VPos::Bottom))
}

/// Hangs a text from the middle of its upper edge.
pub(super) fn below(style: TextStyle<'static>) -> TextStyle<'static> {
    style.pos(Pos::new(HPos::Center, VPos::Top))
}

/// `low..high` widened by `share` of itself on both sides; a range of no length becomes one about its value.
pub(super) fn widened(low: f64, high: f64, share: f64) -> std::ops::Range<f64> {
    let length = high - low;
    if length > 0.0 && length.is_finite() {
        return low - share * length..high + share * length;
    }
    let half = if low == 0.0 || !low.is_finite() { 1.0 } else { 0.1 * low.abs() };
    let middle = if low.is_finite() { low } else { 0.0 };
    middle - half..middle + half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_a_length() {
        assert_eq!(widened(0.0, 10.0, 0.1), -1.0..11.0);
        assert_eq!(widened(5.0, 5.0, 0.1), 4.5..5.5);
        assert_eq!(widened(f64::INFINITY, f64::NEG_INFINITY, 0.1), -1.0..1.0);
    }

    #[test]
    fn colours_and_user_text_reach_the_sheet() {
        let svg = sheet((200, 100), |area| {
            area.draw_text("a < b\u{1b}\u{ffff}", &text(14.0, "#d55e00"), (10, 10))?;
            Ok(())
        })
        .unwrap();
        assert!(svg.contains("a &lt; b\\u{1b}\n") && svg.to_lowercase().contains("#d55e00"));
    }
}
