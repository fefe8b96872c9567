//! The tables: measured modes and responses, each beside the computed one.

use super::super::format::{fixed, given, hertz, signed, significant};
use super::super::table::{ReportTable, idle};
use super::level::level_name;
use crate::results::{MeasuredComparison, MeasuredResponses, NamedModes};

/// The measured modes of a comparison, one row each.
pub(super) fn modes_table(comparison: &MeasuredComparison, set: &NamedModes) -> ReportTable {
    let headings = ["measured [Hz]", "± [%]", "ζ [%]", "<computed", "f [Hz]", "ζ [%]", "diff. [%]", "MAC"];
    let caption = format!("Measured beside computed modes: {} ({})", comparison.name, set.name);
    let mut table = ReportTable::new(caption, &headings);
    let none = String::new;
    for row in &comparison.rows {
        let level = row.mode.and_then(|mode| comparison.level_of(mode)).map(|at| &comparison.levels[at]);
        let cells = vec![
            given(row.frequency_hz),
            row.deviation.map_or(none(), |d| significant(100.0 * d, 2)),
            row.damping_ratio.map_or(none(), |z| significant(100.0 * z, 3)),
            level.map_or("none".into(), |level| level_name(set, level)),
            row.computed_hz.map_or(none(), |hz| hertz(hz, 1)),
            row.computed_damping_ratio.map_or(none(), |z| significant(100.0 * z, 3)),
            row.difference_percent().map_or(none(), |d| signed(d, 2)),
            row.mac.map_or(none(), |like| fixed(like, 2)),
        ];
        table.row(cells, row.mode.is_none());
    }
    let mut table = table.without_columns(idle);
    let alone = comparison.computed_alone();
    let levels = comparison.levels.iter().zip(&comparison.levels_hz);
    let named = levels.filter(|(level, _)| alone.contains(level));
    let list: Vec<String> =
        named.map(|(level, hz)| format!("{} {} Hz", level_name(set, level), hertz(*hz, 1))).collect();
    table.notes.push(match list.len() {
        0 => "Every computed level between the measured frequencies has a measured mode.".into(),
        n => format!("Computed without a measured mode beside it ({n}): {}.", list.join(", ")),
    });
    if let Some(placed) = comparison.placed {
        table.notes.push(format!(
            "Shapes at {} points ({} directions); from its node each is {} mm at most, {} mm in the mean.",
            placed.points,
            placed.dofs,
            fixed(1e3 * placed.largest, 2),
            fixed(1e3 * placed.mean, 2)
        ));
    }
    if comparison.rows.iter().any(|row| row.deviation.is_some()) {
        table.notes.push("±: standard deviation of the measured frequency.".into());
    }
    if comparison.frequency_scale != 1.0 {
        let scale = given(comparison.frequency_scale);
        table.notes.push(format!("Computed frequencies times {scale}, an assumption of the case."));
    }
    if !comparison.source.is_empty() {
        table.notes.push(format!("Measured: {}.", comparison.source));
    }
    table
}

/// The measured responses beside a computed one.
pub(super) fn responses_table(responses: &MeasuredResponses) -> ReportTable {
    let headings = ["<measured", "<place", "<", "off [mm]", "lines", "from [Hz]", "to [Hz]", "FRAC"];
    let caption = format!("Measured beside computed responses: {} ({})", responses.name, responses.frf);
    let mut table = ReportTable::new(caption, &headings);
    for pair in &responses.pairs {
        let end = |hz: Option<&f64>| hz.map_or(String::new(), |hz| given(*hz));
        let cells = vec![
            pair.name.clone(),
            pair.place.replace('_', " "),
            if pair.swapped { "force and motion changed".into() } else { String::new() },
            fixed(1e3 * pair.away[0].max(pair.away[1]), 2),
            pair.frequencies_hz.len().to_string(),
            end(pair.frequencies_hz.first()),
            end(pair.frequencies_hz.last()),
            fixed(pair.assurance, 3),
        ];
        table.row(cells, false);
    }
    if !responses.pairs.is_empty() {
        table
            .notes
            .push("FRAC: 1 where the responses are alike over the band; off: places of the test.".into());
    }
    table.notes.extend(responses.measured_alone.iter().map(|alone| format!("Not compared: {alone}.")));
    if !responses.computed_alone.is_empty() {
        let list = responses.computed_alone.join(", ");
        table.notes.push(format!("Computed without a measured response beside it: {list}."));
    }
    if !responses.source.is_empty() {
        table.notes.push(format!("Measured: {}.", responses.source));
    }
    table
}
