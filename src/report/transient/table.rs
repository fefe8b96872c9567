//! The figures of a run in time.

use crate::report::format::{fixed, given, hertz, power, prefixed, signed, significant};
use crate::report::table::ReportTable;
use crate::results::{ContactResponses, GrowthCompared, TransientResult};
use crate::signal::LimitCycle;
use std::f64::consts::TAU;

/// The part of a growth rate from which what the integrator adds is named.
const OWN: f64 = 0.2;

/// A measured peak is paired with one that differs from it by less than this part.
const NEAR: f64 = 0.05;

/// The figures of a run in time.
pub(in crate::report) fn table(run: &TransientResult) -> ReportTable {
    let mut table = ReportTable::new(
        format!(
            "Motion in time: {} steps of {} s, {}",
            run.len().saturating_sub(1),
            power(run.time_step),
            run.scheme
        ),
        &["<spectrum of", "peak [Hz]", "amplitude", "<unit", "measured [Hz]", "<is"],
    );
    for of in &run.spectra {
        let channel = &run.channels[of.channel];
        for peak in &of.peaks {
            let cells = vec![
                channel.words(),
                hertz(peak.frequency_hz, 1),
                significant(peak.amplitude, 3),
                channel.unit.to_string(),
                near(&of.measured, peak.frequency_hz),
                peak.relation.clone(),
            ];
            table.row(cells, false);
        }
    }
    table.notes.extend(run.fundamental_hz.map(|hz| {
        format!(
            "Fundamental of all channels: {} Hz. A peak has a relation to it where its amplitude and its phase keep to it.",
            hertz(hz, 1)
        )
    }));
    table.notes.extend(beyond(run));
    table.notes.extend(run.reduced.map(|[modes, attached]| {
        format!(
            "Reduced model: {modes} real modes and {attached} shapes for the static response to contacts and forces."
        )
    }));
    table.notes.extend(run.contact_responses.as_ref().map(responses));
    table.notes.extend(run.growth.as_ref().map(disturbance));
    table.notes.extend(run.diagnostics.cycles.iter().map(|(channel, cycle)| swing(run, *channel, cycle)));
    table.notes.extend(contact(run));
    table.notes.push(energy(run));
    if run.split.0 > 0 {
        table.notes.push(format!(
            "{} steps were split, into up to {} parts: {} in all.",
            run.split.0, run.split.1, run.parts
        ));
    }
    table
}

/// Lines that stand above all modes of the case.
fn beyond(run: &TransientResult) -> impl Iterator<Item = String> {
    run.spectra.iter().filter_map(|of| {
        let (name, hz) = (run.channels[of.channel].words(), hertz(of.beyond?, 0));
        Some(format!(
            "The strongest line of {name} is at {hz} Hz, beyond the modes of the case, where a ratio given for them damps nothing: give [cea] a wider band or the materials `rayleigh` damping."
        ))
    })
}

/// What the integrator adds to the growth, where that is more than [`OWN`] of it and of the growth of the mode.
pub(super) fn by_integrator(growth: &GrowthCompared) -> Option<String> {
    let measured = growth.found?.rate.abs();
    let most = OWN * measured.max(growth.eigenvalue.re.abs());
    // Below, the fit is round-off.
    let counts = growth.integrator.abs() > most.max(1e-9 * growth.eigenvalue.norm());
    counts.then(|| format!("the integrator adds {}/s", signed(growth.integrator, 4)))
}

/// How a small disturbance grows, beside the complex mode.
fn disturbance(growth: &GrowthCompared) -> String {
    let (hz, sigma) = (growth.eigenvalue.im / TAU, growth.eigenvalue.re);
    match growth.found {
        Some(found) => {
            format!(
                "Small disturbance: σ = {}/s at {} Hz, measured over {} s; the complex mode has {}/s at {} Hz.",
                signed(found.rate, 2),
                hertz(found.frequency_hz, 2),
                significant(found.window[1] - found.window[0], 3),
                signed(sigma, 2),
                hertz(hz, 2)
            ) + &by_integrator(growth).map_or(String::new(), |words| format!(" Of the measured σ {words}."))
        }
        None => match &growth.refused {
            Some(why) => format!("Growth of the disturbance is not stated, as {why}."),
            None => "The run is too short to measure how a small disturbance grows.".into(),
        },
    }
}

/// The limit cycle of a channel.
fn swing(run: &TransientResult, channel: usize, cycle: &LimitCycle) -> String {
    let channel = &run.channels[channel];
    let verdict = if cycle.steady() {
        "steady".to_string()
    } else {
        format!("not steady: {} % from the first to the second half", signed(100.0 * cycle.drift, 0))
    };
    format!(
        "From {} s on {} swings by ± {} about {} (r.m.s. {}), {verdict}.",
        significant(run.diagnostics.window[0], 3),
        channel.words(),
        prefixed(cycle.amplitude, channel.unit, 3),
        prefixed(cycle.mean, channel.unit, 3),
        prefixed(cycle.rms, channel.unit, 3)
    )
}

/// States of the most loaded contact point.
fn contact(run: &TransientResult) -> Vec<String> {
    let [open, stuck, backwards, _] = run.spent.map(|share| fixed(100.0 * share, 1));
    let mut notes = vec![format!(
        "The point that carries most was open {open} %, stuck {stuck} % and slid backwards {backwards} % of the time."
    )];
    let stuck = run.stuck_without_give();
    if !stuck.is_empty() {
        notes.push(format!(
            "Assumed: friction of {} at rest is any force up to μ(0) N, so that its points stick without give; a `bristle` \
             gives before it slips.",
            stuck.join(", ")
        ));
    }
    notes
}

/// How near the deflections of a reduced model are.
fn responses(of: &ContactResponses) -> String {
    let wide = if of.error > of.tolerance { ", more than `transient.contact_tolerance`" } else { "" };
    format!(
        "Deflections under the forces of the contacts, beside those of all degrees of freedom: a relative error of {}{wide}, estimated by {} random \
         motions; {:.0} % of all such motions have no larger one, with a probability of 95 %.",
        power(of.error),
        of.probes,
        100.0 * of.share()
    )
}

/// Where the energy went.
fn energy(run: &TransientResult) -> String {
    let work = &run.work;
    format!(
        "Energy: drives spent {} J, friction heat {} J, structural damping took {} J, the integrator {} J; the balance of each step closes to {}.",
        significant(work.drive, 4),
        significant(work.heat, 4),
        significant(-work.damping, 3),
        significant(-work.algorithm, 3),
        power(run.worst_residual)
    )
}

/// The measured peak that is nearest to a frequency, if it is near.
fn near(measured: &[f64], hz: f64) -> String {
    let away = |other: &f64| (other / hz - 1.0).abs();
    let nearest = measured.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.filter(|other| away(other) < NEAR).map_or(String::new(), |hz| given(*hz))
}
