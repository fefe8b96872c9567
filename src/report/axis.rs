//! Axes of charts: their values, linear or logarithmic, and labels at round ones.

use super::format::rounded;
use crate::numbers::shortest;
use std::ops::Range;

/// Values of an axis.
#[derive(Debug, Clone)]
pub struct Axis {
    pub(super) name: String,
    /// Places at which it begins and ends.
    pub(super) ends: [f64; 2],
    /// 0 where places are the values; ±1 where a value is ±10^place.
    pub(super) decades: f64,
    /// Values with labels; round ones without.
    ticks: Option<Vec<(f64, String)>>,
    pub(super) grid: bool,
    /// Whether its name stands beside it.
    pub(super) titled: bool,
}

impl Axis {
    /// A linear axis; its name ends with the unit in brackets.
    pub fn new(name: impl Into<String>, ends: Range<f64>) -> Self {
        let ends = [ends.start, ends.end];
        Axis { name: name.into(), ends, decades: 0.0, ticks: None, grid: true, titled: true }
    }

    /// A logarithmic axis between decimal logarithms, of values with the sign of `sign`.
    pub fn log(name: impl Into<String>, decades: Range<f64>, sign: f64) -> Self {
        Axis { decades: sign.signum(), ..Axis::new(name, decades) }
    }

    /// Rows from the top, each as high as 1, with their names at the middle.
    pub fn rows(names: impl IntoIterator<Item = String>) -> Self {
        let ticks: Vec<_> = names.into_iter().enumerate().map(|(k, name)| (k as f64 + 0.5, name)).collect();
        Axis::new("", ticks.len() as f64..0.0).at(ticks).bare()
    }

    /// With labels at these values only.
    pub fn at(self, ticks: impl IntoIterator<Item = (f64, String)>) -> Self {
        Axis { ticks: Some(ticks.into_iter().collect()), ..self }
    }

    /// Without lines at the labels.
    pub fn bare(self) -> Self {
        Axis { grid: false, ..self }
    }

    /// With its name for the reader of values alone.
    pub fn untitled(self) -> Self {
        Axis { titled: false, ..self }
    }

    fn place(&self, value: f64) -> f64 {
        if self.decades == 0.0 { value } else { value.abs().log10() }
    }

    /// The value's part of the way from the beginning to the end.
    pub(super) fn part(&self, value: f64) -> f64 {
        (self.place(value) - self.ends[0]) / (self.ends[1] - self.ends[0])
    }

    /// Values with their labels, `most` about at most.
    pub(super) fn labelled(&self, most: f64) -> Vec<(f64, String)> {
        if let Some(ticks) = &self.ticks {
            return ticks.clone();
        }
        let [low, high] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let values = match (self.decades, high - low) {
            (0.0, _) => round_values([low, high], most),
            // Too short for powers of ten.
            (sign, span) if span < 0.7 => {
                round_values([low, high].map(|end| 10f64.powf(end)), most).iter().map(|v| sign * v).collect()
            }
            (sign, span) => {
                let parts: &[f64] = if 2.0 * span <= most { &[1.0, 2.0, 5.0] } else { &[1.0] };
                // Whole powers: no more than there are decades.
                let powers = round_values([low - 1.0, high], most.min(span + 1.0)).into_iter();
                let all =
                    powers.flat_map(|power| parts.iter().map(move |part| sign * part * 10f64.powf(power)));
                all.filter(|v| (low..=high).contains(&(self.place(*v)))).collect()
            }
        };
        let labels = tick_labels(&values, self.decades == 0.0 || high - low < 0.7);
        values.into_iter().zip(labels).collect()
    }

    /// Whether its values say something to the reader of the page.
    pub(super) fn readable(&self) -> bool {
        self.ticks.is_none() || !self.name.is_empty()
    }
}

/// How far a value may be from its multiple of the step, as a part of it.
const ROUND_OFF: f64 = 1e-9;

/// The most significant digits of a label.
const LONGEST: usize = 9;

/// Multiples of 1, 2 or 5 times a power of ten inside a range, `most` about at most.
fn round_values([low, high]: [f64; 2], most: f64) -> Vec<f64> {
    let least = (high - low) / most.max(1.0);
    let power = 10f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|part| part * power)
        .into_iter()
        .find(|step| *step >= (1.0 - ROUND_OFF) * least);
    let Some(step) = step.filter(|step| *step > 0.0 && step.is_finite()) else { return Vec::new() };
    let first = (low / step - ROUND_OFF).ceil();
    let values = (0..200).map(|k| (first + f64::from(k)) * step);
    values.take_while(|value| *value <= high + ROUND_OFF * step).collect()
}

/// Round values, as short as they can be, down to the digit of the step between them where they are `even`. Where that takes too many
/// digits, those behind the first stand as what is added to it: `1`, `+2e−12`, `+4e−12`.
fn tick_labels(values: &[f64], even: bool) -> Vec<String> {
    let step = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
    let power = |x: f64| x.abs().log10().floor();
    let digits = |value: f64| match power(value) - power(step * (1.0 + ROUND_OFF)) + 1.0 {
        digits if even && digits.is_finite() => digits.max(1.0) as usize,
        _ => 1,
    };
    let whole = |value: f64, digits: usize| {
        let text = shortest(value, digits.max(6));
        if text.contains('e') {
            format!("{:e}", rounded(value, digits.max(4))).replace('-', "−")
        } else {
            text
        }
    };
    let longest = values.iter().map(|value| digits(*value)).max().unwrap_or(0);
    let label = |(k, value): (usize, &f64)| match k {
        1.. if longest > LONGEST => format!("+{}", whole(rounded(value - values[0], 3), 3)),
        _ => whole(*value, digits(*value).min(LONGEST)),
    };
    values.iter().enumerate().map(label).collect()
}

/// The least and the largest of the finite values; infinite where there are none.
pub fn ends(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// `low..high` widened by `share` of itself on both sides; a range of no length becomes one about its value.
pub fn widened([low, high]: [f64; 2], share: f64) -> Range<f64> {
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
    fn labels_of_axes_are_round_and_few() {
        let labels =
            |axis: Axis| -> Vec<String> { axis.labelled(6.0).into_iter().map(|(_, words)| words).collect() };
        assert_eq!(labels(Axis::new("", -0.3..0.3)), ["−0.3", "−0.2", "−0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(
            labels(Axis::new("", 0.0..3e-9)),
            ["0", "5e−10", "1e−9", "1.5e−9", "2e−9", "2.5e−9", "3e−9"]
        );
        assert_eq!(labels(Axis::log("", -9.3..1.2, 1.0)), ["1e−8", "1e−6", "0.0001", "0.01", "1"]);
        assert_eq!(labels(Axis::log("", 2.0..3.1, -1.0)), ["−100", "−200", "−500", "−1000"]);
        assert_eq!(labels(Axis::log("", 0.0..0.3, 1.0)), ["1", "1.2", "1.4", "1.6", "1.8"]);
        // A span that is tiny beside the values.
        assert_eq!(
            labels(Axis::new("", 0.999997..1.000001)),
            ["0.999997", "0.999998", "0.999999", "1", "1.000001"]
        );
        assert_eq!(labels(Axis::new("", -12345678.4..-12345676.8))[..2], ["−1.2345678e7", "−1.23456775e7"]);
        assert_eq!(
            labels(Axis::new("", 1.0..1.0 + 1e-11)),
            ["1", "+2e−12", "+4e−12", "+6e−12", "+8e−12", "+1e−11"]
        );
        assert!(
            labels(Axis::new("", f64::NAN..1.0)).is_empty() && labels(Axis::new("", 1.0..1.0)).is_empty()
        );
    }

    #[test]
    fn ranges_have_a_length() {
        assert_eq!(widened([0.0, 10.0], 0.1), -1.0..11.0);
        assert_eq!(widened([5.0, 5.0], 0.1), 4.5..5.5);
        assert_eq!(widened(ends([f64::NAN]), 0.1), -1.0..1.0);
    }
}
