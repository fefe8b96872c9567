//! Quantities of a run in time.

use super::record::ChannelRecord;
use super::reference::{ChannelWindow, Measure};
use super::run::CaseRun;
use super::two_dof::TwoDof;
use crate::results::TransientResult;

/// `measure` of a channel; `None` when the run does not have the channel.
pub(super) fn measured(run: &CaseRun, span: &ChannelWindow, measure: &Measure) -> Option<f64> {
    let record = record(run, span)?;
    let earlier = |window: &[f64; 2]| self::record(run, &ChannelWindow { window: *window, ..span.clone() });
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
pub(super) fn deviation(run: &CaseRun, span: &ChannelWindow, model: &TwoDof) -> Option<f64> {
    let found = record(run, span)?;
    let step = run.results.get::<TransientResult>()?.time_step;
    let exact = model.displacement(step, (span.window[1] / step).round() as usize);
    let exact = ChannelRecord::new(&exact, step, span.window);
    (found.values.len() == exact.values.len()).then(|| {
        let pairs = found.values.iter().zip(exact.values);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / exact.amplitude()
    })
}

fn record<'a>(run: &'a CaseRun, span: &ChannelWindow) -> Option<ChannelRecord<'a>> {
    let step = run.results.get::<TransientResult>()?.time_step;
    Some(ChannelRecord::new(run.histories.of(&span.channel)?, step, span.window))
}
