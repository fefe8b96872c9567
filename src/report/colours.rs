//! Colours that stay apart in print and for the colour-blind.

/// Colour of emphasis: unstable, closed (vermilion of Okabe and Ito's set).
pub(super) const ALARM: &str = "#d55e00";
/// Text of that colour: darker, for a contrast of 5.5 to white.
pub(super) const ALARM_TEXT: &str = "#b04a00";
/// Neutral colour: stable, open.
pub(super) const CALM: &str = "#8a949e";
/// Colour of measured data (their blue).
pub(super) const MEASURED: &str = "#0072b2";
/// A second line beside one that stands out (their bluish green).
pub(super) const SECOND: &str = "#009e73";
/// Text and axes.
pub(super) const INK: &str = "#1b1f24";
/// Secondary text.
pub(super) const MUTED: &str = "#5b6570";
/// Points of a sweep or map without an answer.
pub(super) const NO_ANSWER: &str = "#c3c8ce";

/// Fill and outline of the parts, in turn: light fills, so that marks on them can be read.
pub(super) const PARTS: [[&str; 2]; 6] = [
    ["#bcd7ea", "#4a7fa5"],
    ["#efe3c8", "#a58a4c"],
    ["#59636e", "#2f363d"],
    ["#cfe6d8", "#4e9270"],
    ["#ead0de", "#a06488"],
    ["#dcdfe3", "#7b858f"],
];

/// Blue – white – red for `value` in \[−1, 1\]: equal lightness at equal distance from zero, so that red and blue are
/// not the only hint and the zero is light.
pub(super) fn diverging(value: f64) -> String {
    const STOPS: [Stop; 5] = [
        [33.0, 82.0, 156.0],
        [116.0, 167.0, 207.0],
        [247.0, 247.0, 247.0],
        [239.0, 153.0, 118.0],
        [172.0, 34.0, 44.0],
    ];
    between(&STOPS, 0.5 * (value.clamp(-1.0, 1.0) + 1.0))
}

/// White – orange – nearly black for `value` in \[0, 1\], ever darker.
pub(super) fn sequential(value: f64) -> String {
    const STOPS: [Stop; 5] = [
        [255.0, 255.0, 255.0],
        [250.0, 214.0, 165.0],
        [232.0, 138.0, 50.0],
        [172.0, 68.0, 0.0],
        [52.0, 16.0, 8.0],
    ];
    between(&STOPS, value.clamp(0.0, 1.0))
}

type Stop = [f64; 3];

/// The colour at a part of the way along the stops, from 0 to 1.
fn between(stops: &[Stop; 5], part: f64) -> String {
    let place = 4.0 * part;
    let k = (place as usize).min(stops.len() - 2);
    let t = place - k as f64;
    let [r, g, b] = [0, 1, 2].map(|c| (stops[k][c] + t * (stops[k + 1][c] - stops[k][c])).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_and_the_middle_are_where_they_belong() {
        assert_eq!(diverging(-1.0), "#21529c");
        assert_eq!(diverging(0.0), "#f7f7f7");
        assert_eq!(diverging(7.0), "#ac222c");
        assert_eq!([0.0, 0.5, 1.0].map(sequential), ["#ffffff", "#e88a32", "#341008"]);
    }
}
