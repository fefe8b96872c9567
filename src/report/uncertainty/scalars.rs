//! `uncertainty_<name>_scalars.svg`: which uncertain scalar decides the largest growth rate.

use super::words::file;
use crate::report::colours::{ALARM, INK, MEASURED, MUTED};
use crate::report::format::{signed, significant};
use crate::report::section::Picture;
use crate::report::svg::{Anchor, Ink, Sheet};
use crate::results::{ScalarStatistics, UncertaintyResult};

const WIDTH: f64 = 980.0;
const LABELS: f64 = 260.0;
const ROW: f64 = 26.0;
const HEAD: f64 = 48.0;
/// Left and right end of the bars of correlations, and of those of shares.
const COLUMNS: [[f64; 2]; 2] = [[300.0, 600.0], [670.0, 910.0]];

pub(super) fn picture(result: &UncertaintyResult) -> Option<Picture> {
    let mut rows: Vec<(&str, &ScalarStatistics)> =
        result.study.scalars.iter().map(|scalar| scalar.name.as_str()).zip(&result.scalars).collect();
    rows.retain(|(_, s)| s.correlation.is_finite() && s.first_order.is_finite());
    if rows.is_empty() {
        return None;
    }
    rows.sort_by(|a, b| b.1.first_order.total_cmp(&a.1.first_order));
    let mut sheet = Sheet::new(WIDTH, HEAD + ROW * rows.len() as f64 + 16.0);
    let head = Ink { size: 14.0, colour: INK, bold: true, anchor: Anchor::Middle };
    let middle = COLUMNS.map(|[left, right]| 0.5 * (left + right));
    sheet.text([middle[0], 22.0], "rank correlation with growth", head);
    sheet.text([middle[1], 22.0], "share of the variance [%]", head);
    let ink = Ink { size: 13.0, colour: INK, bold: false, anchor: Anchor::End };
    let half = 0.5 * (COLUMNS[0][1] - COLUMNS[0][0]);
    for (k, (name, s)) in rows.iter().enumerate() {
        let y = HEAD + ROW * k as f64;
        sheet.text([LABELS, y + 13.0], name, ink);
        let length = half * s.correlation.abs();
        let hex = if s.correlation > 0.0 { ALARM } else { MEASURED };
        let left = if s.correlation > 0.0 { middle[0] } else { middle[0] - length };
        sheet.rectangle([left, y], [length, ROW - 9.0], &format!("fill=\"{hex}\""));
        let (place, anchor) = match s.correlation > 0.0 {
            true => (left + length + 6.0, Anchor::Start),
            false => (left - 6.0, Anchor::End),
        };
        sheet.text([place, y + 13.0], &signed(s.correlation, 2), Ink { anchor, ..ink });
        let share = s.first_order.clamp(0.0, 1.0);
        let [left, right] = COLUMNS[1];
        sheet.rectangle([left, y], [(right - left) * share, ROW - 9.0], &format!("fill=\"{MUTED}\""));
        let place = left + (right - left) * share + 6.0;
        sheet.text([place, y + 13.0], &significant(100.0 * share, 2), Ink { anchor: Anchor::Start, ..ink });
    }
    let bottom = HEAD + ROW * rows.len() as f64 - 4.0;
    for zero in [middle[0], COLUMNS[1][0]] {
        let axis = [[zero, HEAD - 6.0], [zero, bottom]];
        sheet.lines([&axis[..]], &format!("stroke=\"{INK}\" stroke-width=\"1.2\""));
    }
    let caption = "What the largest growth rate of a sample depends on. Orange: it grows with the scalar; blue: it falls. \
                   Share of the variance: first-order Sobol index."
        .to_string();
    Some(Picture { file: file(result, "_scalars"), caption, svg: sheet.finish() })
}
