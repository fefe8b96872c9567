//! Channels of a run in time: what is recorded at every step.

use crate::error::Result;
use std::ops::Range;

/// The time of each row, and when each event happened.
pub(crate) const TIME: &str = "time_s";
/// The unit of the acceleration of a real mode.
pub(crate) const MODAL_UNIT: &str = "sqrt(kg) m/s^2";
/// The acceleration of a real mode in words.
pub(crate) const MODAL_ABOUT: &str = "acceleration of a mass-normalised real mode";
/// Columns that a long record is drawn in, so that no spike is lost.
const COLUMNS: usize = 840;
/// Values of a channel that are processed together.
const BLOCK: usize = 1 << 16;

/// Quantity recorded at every step, the start included. The values themselves are in `results.h5`.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `rim_velocity`, `pad_friction_force`, `heat` …
    pub name: String,
    /// The SI unit.
    pub unit: &'static str,
    /// Description.
    pub about: String,
    /// The least and the greatest value.
    pub range: [f64; 2],
    /// The last value.
    pub last: Option<f64>,
    /// Time \[s\] and value along the line that draws the record: the values themselves or, where there are many, the
    /// least and the greatest of each of up to 840 columns, one above the other.
    pub line: Vec<(f64, f64)>,
}

impl Channel {
    /// A channel of which nothing is known yet.
    pub fn new(name: String, unit: &'static str, about: String) -> Self {
        let range = [f64::INFINITY, f64::NEG_INFINITY];
        Channel { name, unit, about, range, last: None, line: Vec::new() }
    }

    /// Looks at all `rows` values, `step` seconds apart, which `read` gives a part at a time.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn look(
        &mut self,
        rows: usize,
        step: f64,
        mut read: impl FnMut(Range<usize>) -> Result<Vec<f64>>,
    ) -> Result<()> {
        let each = rows.div_ceil(COLUMNS).max(1);
        let block = each * (BLOCK / each).max(1);
        for first in (0..rows).step_by(block) {
            let values = read(first..rows.min(first + block))?;
            for (k, column) in values.chunks(each).enumerate() {
                let begin = first + k * each;
                let wide = |[low, high]: [f64; 2], v: &f64| [low.min(*v), high.max(*v)];
                let [low, high] = column.iter().fold([f64::INFINITY, f64::NEG_INFINITY], wide);
                self.range = [self.range[0].min(low), self.range[1].max(high)];
                if each <= 2 {
                    let at = |(j, v): (usize, &f64)| ((begin + j) as f64 * step, *v);
                    self.line.extend(column.iter().enumerate().map(at));
                } else {
                    let time = (begin + column.len() / 2) as f64 * step;
                    // Up and down in turn, so that the line does not cross the column twice.
                    let ends = if (begin / each).is_multiple_of(2) { [low, high] } else { [high, low] };
                    self.line.extend(ends.map(|v| (time, v)));
                }
            }
            self.last = values.last().copied();
        }
        Ok(())
    }

    /// The name in words: `rim velocity`.
    pub fn words(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// The name under which the acceleration of real mode `mode`, an index, is recorded: it has the number from 1.
pub fn modal_channel(mode: usize) -> String {
    format!("modal_acceleration/{}", mode + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The record drawn and measured at once, without blocks.
    fn whole(values: &[f64], step: f64) -> ([f64; 2], Vec<(f64, f64)>) {
        let extent = |v: &[f64]| {
            [
                v.iter().copied().fold(f64::INFINITY, f64::min),
                v.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let each = values.len().div_ceil(840);
        let line = values.chunks(each).enumerate().flat_map(|(k, part)| {
            let [low, high] = extent(part);
            let time = (k * each + part.len() / 2) as f64 * step;
            if k % 2 == 0 { [(time, low), (time, high)] } else { [(time, high), (time, low)] }
        });
        (extent(values), line.collect())
    }

    #[test]
    fn a_record_processed_in_blocks_is_the_record() {
        let values: Vec<f64> =
            (0..300_001).map(|k| (0.37 * k as f64).sin() * (1.0 + 1e-5 * k as f64)).collect();
        let mut channel = Channel::new("v".into(), "m/s", String::new());
        let mut largest = 0;
        channel
            .look(values.len(), 1e-5, |part| {
                largest = largest.max(part.len());
                Ok(values[part].to_vec())
            })
            .unwrap();
        let (range, line) = whole(&values, 1e-5);
        assert_eq!((channel.range, channel.last), (range, values.last().copied()));
        assert!(channel.line == line && largest <= BLOCK);
        let mut short = Channel::new("v".into(), "m/s", String::new());
        short.look(1000, 1e-5, |part| Ok(values[part].to_vec())).unwrap();
        assert_eq!(short.line.len(), 1000);
        assert!(short.line.iter().zip(&values).all(|((_, a), b)| a == b));
    }
}
