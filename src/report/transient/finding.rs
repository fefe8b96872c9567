//! What a run in time found: growth, how large the motion is at its end, how loud it is.

use super::table::by_integrator;
use crate::linalg::c64;
use crate::report::finding::{Finding, FindingClass};
use crate::report::format::{fixed, hertz, power, prefixed, rate, signed, significant};
use crate::results::TransientResult;
use crate::signal::{Growth, LimitCycle, Peak};
use std::f64::consts::TAU;

/// Growth of a small disturbance, where it was measured; the motion at the end; the energy balance.
pub(super) fn motion(run: &TransientResult) -> Finding {
    let mut class = FindingClass::Neutral;
    let mut parts: Vec<String> = Vec::new();
    if let Some((growth, found)) = run.growth.as_ref().and_then(|growth| Some((growth, growth.found?))) {
        let sigma = rate(c64::new(found.rate, TAU * found.frequency_hz));
        let does = match change(&found) {
            0 => "neither grows nor decays measurably".to_string(),
            1.. => {
                class = FindingClass::Bad;
                format!("grows with σ = {sigma} 1/s")
            }
            _ => format!("decays with σ = {sigma} 1/s"),
        };
        parts.push(format!(
            "a small disturbance {does} at {} Hz (the complex mode: {} 1/s at {} Hz)",
            hertz(found.frequency_hz, 1),
            rate(growth.eigenvalue),
            hertz(growth.eigenvalue.im / TAU, 1)
        ));
        parts.extend(by_integrator(growth).map(|words| format!("{words} of it")));
    } else if let Some(why) = run.growth.as_ref().and_then(|growth| growth.refused.as_ref()) {
        class = FindingClass::Attention;
        parts.push(format!("growth of the disturbance is not stated, as {why}"));
    }
    if run.diagnostics.cycles.is_empty() && run.growth.is_none() {
        parts.push(format!("{} steps of {} s", run.len().saturating_sub(1), power(run.time_step)));
    } else if let Some(words) = oscillation(run) {
        if !run.diagnostics.cycles.iter().all(|(_, cycle)| cycle.steady()) {
            class = class.min(FindingClass::Attention);
        }
        parts.push(words);
    }
    if run.spectra.iter().any(|of| of.beyond.is_some()) {
        class = class.min(FindingClass::Attention);
        parts.push("the strongest line is beyond the modes of the case, where damping is not known".into());
    }
    parts.push(format!("the energy balance of each step closes to {}", power(run.worst_residual)));
    Finding::new(class, format!("Motion in time: {}.", parts.join("; ")))
}

/// How large the oscillation of every analysed channel is at the end, at which frequency, and which of them are steady.
fn oscillation(run: &TransientResult) -> Option<String> {
    let cycles = &run.diagnostics.cycles;
    let sizes: Vec<String> = cycles
        .iter()
        .map(|(k, cycle)| {
            let channel = &run.channels[*k];
            format!("{} by ± {}", channel.words(), prefixed(cycle.amplitude, channel.unit, 3))
        })
        .collect();
    let first = cycles.iter().find_map(|(k, _)| strongest(run, *k)).map(|peak| peak.frequency_hz);
    let at = run.fundamental_hz.or(first).map_or(String::new(), |hz| format!(", at {} Hz", hertz(hz, 1)));
    let change = |(k, cycle): &(usize, LimitCycle)| {
        format!("{} ({} %)", run.channels[*k].words(), signed(100.0 * cycle.drift, 0))
    };
    let [still, moving]: [Vec<&(usize, LimitCycle)>; 2] =
        [true, false].map(|steady| cycles.iter().filter(|(_, cycle)| cycle.steady() == steady).collect());
    let steady = match (still.len(), moving.len()) {
        (_, 0) if cycles.len() == 1 => "steady".into(),
        (_, 0) => "all steady".into(),
        (0, _) => format!(
            "not steady from the first to the second half: {}",
            joined(moving.into_iter().map(change))
        ),
        _ => format!(
            "{} steady, not so from the first to the second half: {}",
            joined(still.iter().map(|(k, _)| run.channels[*k].words())),
            joined(moving.into_iter().map(change))
        ),
    };
    let from = significant(run.diagnostics.window[0], 3);
    (!sizes.is_empty())
        .then(|| format!("from {from} s on oscillation of {}{at}; {steady}", joined(sizes.into_iter())))
}

/// `a`, `a and b`, `a, b and c`.
fn joined(words: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = words.collect();
    match &words[..] {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

/// Change of ln|c| over the time of the fit that is smaller than this is no growth.
const LEAST_CHANGE: f64 = 0.01;

/// 1 when the disturbance grows, −1 when it decays, 0 when ln|c| changes over the time of the fit by less than it scatters
/// about its line, or by less than a hundredth.
fn change(found: &Growth) -> i32 {
    let change = found.rate * (found.window[1] - found.window[0]);
    if change.abs() > found.deviation.max(LEAST_CHANGE) { change.signum() as i32 } else { 0 }
}

/// The strongest peak of a channel.
fn strongest(run: &TransientResult, channel: usize) -> Option<&Peak> {
    let of = run.spectra.iter().find(|of| of.channel == channel)?;
    of.peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
}

/// The loudest microphone, or the sound power without one, and the strongest tone.
pub(super) fn sound(run: &TransientResult) -> Option<Finding> {
    let sound = run.sound.as_ref()?;
    let [level, weighted] = sound.power_levels();
    if !level.is_finite() {
        return Some(Finding::new(FindingClass::Neutral, "Sound: the plates send out no sound."));
    }
    let power = format!("sound power {} dB(A) re 1 pW", fixed(weighted, 1));
    let loudest = sound.microphones.iter().max_by(|a, b| a.levels()[1].total_cmp(&b.levels()[1]));
    let mut words = match loudest {
        Some(microphone) => {
            let weighted = fixed(microphone.levels()[1], 1);
            format!("Sound: {weighted} dB(A) re 20 µPa at microphone {}, {power}", microphone.name)
        }
        None => format!("Sound: {power}"),
    };
    let strongest = sound.tones.iter().max_by(|a, b| a.power.total_cmp(&b.power));
    if let Some(tone) = strongest {
        let (hz, share) = (hertz(tone.peak.frequency_hz, 1), fixed(100.0 * tone.share, 0));
        words += &format!("; the strongest tone, {hz} Hz, has {share} % of the power");
    }
    Some(Finding::new(FindingClass::Neutral, words + "."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::GrowthCompared;

    #[test]
    fn growth_decides_the_class_and_every_figure_has_its_unit() {
        let results = sample::rig();
        let mut run = results.get::<TransientResult>().unwrap().clone();
        let cycle = |k| (k, LimitCycle { amplitude: 1e-3, rms: 7e-4, mean: 0.0, drift: 0.2, pieces: 8 });
        run.diagnostics.cycles = vec![cycle(0), cycle(1)];
        let [first, second] = [0, 1].map(|k| run.channels[k].words());
        let window = [0.001, 0.021];
        let found = Growth { rate: 200.0, frequency_hz: 1668.0, window, deviation: 0.1 };
        let eigenvalue = c64::new(201.0, 1e4);
        run.growth =
            Some(GrowthCompared { mode: 0, eigenvalue, found: Some(found), refused: None, integrator: 0.0 });
        let finding = motion(&run);
        assert_eq!(finding.class, FindingClass::Bad, "{}", finding.words);
        assert!(
            finding.words.contains("grows with σ = +")
                && finding.words.contains(&format!("oscillation of {first} by ± "))
        );
        let loud = sound(&run).unwrap();
        assert!(loud.words.contains("dB(A)") && loud.class == FindingClass::Neutral, "{}", loud.words);
        // e^0.08 is less than the scatter.
        run.growth.as_mut().unwrap().found.as_mut().unwrap().rate = 4.0;
        assert!(motion(&run).words.contains("neither grows nor decays measurably"));
        run.growth.as_mut().unwrap().found.as_mut().unwrap().rate = -200.0;
        run.diagnostics.cycles.iter_mut().for_each(|(_, cycle)| cycle.drift = 0.0);
        assert!(motion(&run).words.contains(&format!("{second} by ± ")));
        assert!(motion(&run).words.contains("; all steady"));
        run.spectra.iter_mut().for_each(|of| of.beyond = None);
        assert_eq!(motion(&run).class, FindingClass::Neutral);
        run.diagnostics.cycles[0].1.drift = 0.5;
        let finding = motion(&run);
        assert_eq!(finding.class, FindingClass::Attention);
        let words = format!("{second} steady, not so from the first to the second half: {first} (+50 %)");
        assert!(finding.words.contains(&words), "{}", finding.words);
        run.growth = None;
        run.sound = None;
        assert!(!motion(&run).words.contains("disturbance") && sound(&run).is_none());
    }
}
