//! Quantities of a run in time.

use super::record::Record;
use super::reference::{Measure, Span};
use super::two_dof::TwoDof;
use crate::results::RunResults;

/// What `measure` says of a channel; `None` when the run does not have it.
pub(super) fn measured(results: &RunResults, span: &Span, measure: Measure) -> Option<f64> {
    let record = record(results, span)?;
    let earlier = |window: [f64; 2]| self::record(results, &Span { window, ..span.clone() });
    Some(match measure {
        Measure::Amplitude => record.amplitude(),
        Measure::AmplitudeOver(window) => record.amplitude() / earlier(window)?.amplitude(),
        Measure::GrowthSince(window) => {
            (record.amplitude() / earlier(window)?.amplitude()).ln() / (span.window[0] - window[0])
        }
        Measure::Highest => record.highest(),
        Measure::Lowest => record.lowest(),
        Measure::Period => record.period(),
        Measure::Rise => record.rise(),
    })
}

/// The largest deviation of a channel from the displacement x of `model`, as a part of its amplitude in the window.
pub(super) fn deviation(results: &RunResults, span: &Span, model: &TwoDof) -> Option<f64> {
    let found = record(results, span)?;
    let step = results.transient.as_ref()?.time_step;
    let exact = model.displacement(step, (span.window[1] / step).round() as usize);
    let exact = Record::new(&exact, step, span.window);
    (found.values.len() == exact.values.len()).then(|| {
        let pairs = found.values.iter().zip(exact.values);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / exact.amplitude()
    })
}

fn record<'a>(results: &'a RunResults, span: &Span) -> Option<Record<'a>> {
    let run = results.transient.as_ref()?;
    let channel = run.channels.iter().find(|channel| channel.name == span.channel)?;
    Some(Record::new(&channel.values, run.time_step, span.window))
}
