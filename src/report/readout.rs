//! What the script of the page reads from a chart: its axes, and titles of points.
//!
//! plotters writes marks but no attributes of one's own. The elements are therefore drawn as texts that begin with a
//! character for private use, and [`super::chart_elements::elements`] replaces them by `<rect class="axes" data-…>` and
//! `<circle><title>…</title></circle>`, both invisible.

use super::chart::{Area, text};
use super::chart_elements::{ELEMENT, FIELD};
use super::colours::INK;
use super::curve::LinearChart;
use std::error::Error;
use std::fmt::Write;

/// Name with unit and scale of an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisScale<'a> {
    pub name: &'a str,
    /// 0 where places on the axis are the values; ±1 where a value is ±10^place.
    pub decades: f64,
}

/// A linear axis.
pub(super) fn linear(name: &str) -> AxisScale<'_> {
    AxisScale { name, decades: 0.0 }
}

/// The axes of `chart`: its rectangle on the sheet, the ranges across it, names and scales.
pub(super) fn axes_of(
    area: &Area,
    chart: &LinearChart,
    [x, y]: [AxisScale; 2],
) -> Result<(), Box<dyn Error>> {
    let plot = chart.plotting_area();
    let (across, up) = (plot.get_x_axis_pixel_range(), plot.get_y_axis_pixel_range());
    let (wide, high) = (chart.x_range(), chart.y_range());
    let mut words = format!("{ELEMENT}a");
    let pixels = [across.start, up.start, across.end - across.start, up.end - up.start];
    for number in pixels.map(f64::from).into_iter().chain([wide.start, wide.end, high.start, high.end]) {
        write!(words, "{number}{FIELD}")?;
    }
    write!(words, "{}{FIELD}{}{FIELD}{}{FIELD}{}", x.decades, y.decades, x.name, y.name)?;
    area.draw_text(&words, &text(1.0, INK), (0, 0))?;
    Ok(())
}

/// A title at a pixel of the whole sheet, shown while the pointer is there.
pub(super) fn title_at(area: &Area, (x, y): (i32, i32), title: &str) -> Result<(), Box<dyn Error>> {
    area.draw_text(&format!("{ELEMENT}t{x}{FIELD}{y}{FIELD}{title}"), &text(1.0, INK), (0, 0))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::axes::axes;
    use crate::report::chart::sheet;

    #[test]
    fn a_chart_carries_its_axes_and_titles() {
        let svg = sheet((400, 300), |area| {
            let chart =
                axes(area, (0.0..10.0, -2.0..2.0), Some("time \"t\" [s]"), "force [N]", |v| format!("{v}"))?;
            title_at(area, chart.backend_coord(&(5.0, 0.0)), "mode <1>")
        })
        .unwrap();
        // 16 + 104 to the left, 10 above, 20 to the right, 46 below; the upper end stands on the last pixel.
        assert!(
            svg.contains("<rect class=\"axes\" x=\"120\" y=\"10\" width=\"259\" height=\"243\""),
            "{svg}"
        );
        assert!(svg.contains(
            "data-x=\"0 10 0\" data-y=\"-2 2 0\" data-names=\"time &quot;t&quot; [s]|force [N]\"/>"
        ));
        assert!(
            svg.contains("cx=\"249\" cy=\"132\"") && svg.contains("<title>mode &lt;1&gt;</title>"),
            "{svg}"
        );
        assert!(!svg.contains([ELEMENT, FIELD]));
    }

    #[test]
    fn user_text_with_these_characters_makes_no_element() {
        let svg = sheet((100, 100), |area| {
            area.draw_text("\u{e000}t1\u{e001}</text><script>", &text(9.0, INK), (5, 5))?;
            Ok(())
        })
        .unwrap();
        assert!(svg.ends_with("</svg>\n") && !svg.contains("<script") && !svg.contains(ELEMENT));
    }
}
