//! `uncertainty_<name>_scalars.svg`: which uncertain scalar decides the largest growth rate.

use super::words::file;
use crate::report::chart::WIDTH;
use crate::report::colours::{ALARM, INK, MEASURED, MUTED};
use crate::report::format::{signed, significant};
use crate::report::section::Picture;
use crate::report::svg::{Sheet, ink, stroke};
use crate::results::{ScalarStatistics, UncertaintyResult};

const LABELS: f64 = 260.0;
const ROW: f64 = 26.0;
const HEAD: f64 = 48.0;
/// Zero and largest length of the bars of correlations, and of those of shares \[px\].
const COLUMNS: [[f64; 2]; 2] = [[450.0, 150.0], [670.0, 240.0]];

pub(super) fn picture(result: &UncertaintyResult) -> Option<Picture> {
    let mut rows: Vec<(&str, &ScalarStatistics)> =
        result.study.scalars.iter().map(|scalar| scalar.name.as_str()).zip(&result.scalars).collect();
    rows.retain(|(_, s)| s.correlation.is_finite() && s.first_order.is_finite());
    if rows.is_empty() {
        return None;
    }
    rows.sort_by(|a, b| b.1.first_order.total_cmp(&a.1.first_order));
    let mut sheet = Sheet::new(WIDTH, HEAD + ROW * rows.len() as f64 + 16.0);
    let head = ink(14.0, INK).bold().middle();
    sheet.text([COLUMNS[0][0], 22.0], "rank correlation with growth", head);
    sheet.text([COLUMNS[1][0] + 0.5 * COLUMNS[1][1], 22.0], "share of the variance [%]", head);
    for (k, (name, s)) in rows.iter().enumerate() {
        let y = HEAD + ROW * k as f64;
        sheet.text([LABELS, y + 13.0], name, ink(13.0, INK).end());
        let hex = if s.correlation > 0.0 { ALARM } else { MEASURED };
        let share = s.first_order.clamp(0.0, 1.0);
        let bars =
            [(s.correlation, hex, signed(s.correlation, 2)), (share, MUTED, significant(100.0 * share, 2))];
        for ((part, hex, words), [zero, length]) in bars.into_iter().zip(COLUMNS) {
            sheet.bar([zero, y], [length * part, ROW - 9.0], hex, &words);
        }
    }
    let bottom = HEAD + ROW * rows.len() as f64 - 4.0;
    for [zero, _] in COLUMNS {
        sheet.line([[zero, HEAD - 6.0], [zero, bottom]], &stroke(INK, 1.2));
    }
    let caption = "What the largest growth rate of a sample depends on. Orange: it grows with the scalar; blue: it falls. \
                   Share of the variance: first-order Sobol index."
        .to_string();
    Some(Picture { file: file(result, "_scalars"), caption, svg: sheet.finish() })
}
