//! `measured_frf_<name>.svg`: measured over computed responses, one panel each.

use super::super::format::fixed;
use super::super::magnitude::{ResponseCurve, ResponsePanel, computed_line, measured_line, stacked};
use crate::linalg::c64;
use crate::report::section::Picture;
use crate::report::svg::Style;
use crate::results::{MeasuredResponses, ResponsePair, file_name};

/// Panels in one picture; the others are in the table.
pub(in crate::report) const MOST: usize = 6;
/// Heights of the charts of magnitude and phase \[px\].
pub(in crate::report) const HEIGHTS: [f64; 2] = [204.0, 90.0];

pub(super) fn picture(responses: &MeasuredResponses) -> Option<Picture> {
    let panel = |pair: &ResponsePair| {
        let curve = |words: String, style: Style, values: &[c64]| ResponseCurve {
            words,
            style,
            sizes: values.iter().map(|v| v.norm()).collect(),
            phases: values.iter().map(|v| v.arg()).collect(),
        };
        let short = pair.name.chars().take(36).collect::<String>();
        let place = pair.place.replace('_', " ");
        let computed = format!("computed: {place}, FRAC {}", fixed(pair.assurance, 3));
        ResponsePanel {
            frequencies_hz: pair.frequencies_hz.clone(),
            quantity: pair.quantity,
            curves: vec![
                curve(computed, computed_line(), &pair.computed),
                curve(format!("measured: {short}"), measured_line(), &pair.measured),
            ],
            natural_hz: Vec::new(),
            measured_hz: Vec::new(),
            heights: HEIGHTS,
        }
    };
    let panels: Vec<ResponsePanel> = responses.pairs.iter().take(MOST).map(panel).collect();
    let svg = stacked(&panels)?;
    let more = if responses.pairs.len() > MOST { format!("; the first {MOST}") } else { String::new() };
    let caption = format!(
        "Measured responses ({}, dashed) over the computed ones ({}, solid){more}. FRAC is 1 where they are alike over the band.",
        responses.name, responses.frf
    );
    Some(Picture { file: file_name("measured_frf", &responses.name), caption, svg })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::report::colours::{ALARM, MEASURED};

    #[test]
    fn a_measured_curve_is_dashed_over_a_computed_one_that_is_equal() {
        let results = sample::rig();
        let mut responses = results.all::<MeasuredResponses>()[0].clone();
        for pair in &mut responses.pairs {
            pair.measured = pair.computed.clone();
        }
        responses.pairs.truncate(1);
        let svg = picture(&responses).unwrap().svg;
        let lines: Vec<&str> =
            svg.split("<path ").skip(1).map(|rest| rest.split("/>").next().unwrap()).collect();
        let of = |hex: &str| lines.iter().position(|line| line.contains(hex) && line.len() > 300).unwrap();
        let (below, above) = (lines[of(ALARM)], lines[of(MEASURED)]);
        let points = |line: &str| line.split('"').nth(1).unwrap().to_string();
        assert!(of(ALARM) < of(MEASURED) && points(below) == points(above));
        assert!(!below.contains("dasharray") && above.contains("dasharray=\"7 5\""), "{above}");
    }
}
