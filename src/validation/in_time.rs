//! Quantities of a run in time.

use super::record::Record;
use super::reference::{Measure, Span};
use super::run::Run;
use super::two_dof::TwoDof;
use crate::results::TransientResult;

/// `measure` of a channel; `None` when the run does not have the channel.
pub(super) fn measured(run: &Run, span: &Span, measure: &Measure) -> Option<f64> {
    let record = record(run, span)?;
    let earlier = |window: &[f64; 2]| self::record(run, &Span { window: *window, ..span.clone() });
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
        Measure::Tone => record.tone().amplitude,
        Measure::ToneFrequency => record.tone().frequency_hz,
        Measure::PeakNear(near) => record.peak_near(near),
        Measure::Level(near) => record.level(near, true),
        Measure::OtherLevel(near) => record.level(near, false),
    })
}

/// The largest deviation of a channel from the displacement x of `model`, as a part of its amplitude in the window.
pub(super) fn deviation(run: &Run, span: &Span, model: &TwoDof) -> Option<f64> {
    let found = record(run, span)?;
    let step = run.results.get::<TransientResult>()?.time_step;
    let exact = model.displacement(step, (span.window[1] / step).round() as usize);
    let exact = Record::new(&exact, step, span.window);
    (found.values.len() == exact.values.len()).then(|| {
        let pairs = found.values.iter().zip(exact.values);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / exact.amplitude()
    })
}

fn record<'a>(run: &'a Run, span: &Span) -> Option<Record<'a>> {
    let step = run.results.get::<TransientResult>()?.time_step;
    Some(Record::new(run.histories.of(&span.channel)?, step, span.window))
}
