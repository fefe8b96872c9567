//! The figures of a run in time.

use crate::report::format::{fixed, given, hertz, power, signed, significant};
use crate::report::table::Table;
use crate::results::TransientResult;
use std::f64::consts::TAU;

/// A measured peak stands beside one that differs from it by less than this part.
const NEAR: f64 = 0.05;

/// The figures of a run in time.
pub(in crate::report) fn table(run: &TransientResult) -> Table {
    let mut table = Table::new(
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
                channel.name.replace('_', " "),
                hertz(peak.frequency_hz, 1),
                significant(peak.amplitude, 3),
                channel.unit.to_string(),
                near(&of.measured, peak.frequency_hz),
                peak.relation.clone(),
            ];
            table.row(cells, false);
        }
    }
    for of in &run.spectra {
        let name = run.channels[of.channel].name.replace('_', " ");
        table.notes.extend(of.beyond.map(|hz| {
            format!(
                "The strongest line of {name} is at {} Hz, beyond the modes of the case, where a ratio given for them damps nothing: give [cea] a wider band or the materials `rayleigh` damping.",
                hertz(hz, 0)
            )
        }));
    }
    if let Some([modes, attached]) = run.reduced {
        table.notes.push(format!(
            "Reduced model: {modes} real modes and {attached} shapes for the static response to contacts and forces."
        ));
    }
    if let Some(growth) = &run.growth {
        let (hz, sigma) = (growth.eigenvalue.im / TAU, growth.eigenvalue.re);
        table.notes.push(match growth.found {
            Some(found) => format!(
                "Small disturbance: σ = {}/s at {} Hz, measured over {} s; the complex mode says {}/s at {} Hz.",
                signed(found.rate, 2),
                hertz(found.frequency_hz, 2),
                significant(found.window[1] - found.window[0], 3),
                signed(sigma, 2),
                hertz(hz, 2)
            ),
            None => "The disturbance was too large, or the run too short, to measure how a small one grows.".into(),
        });
    }
    for (channel, cycle) in &run.watched.cycles {
        let channel = &run.channels[*channel];
        let verdict = if cycle.steady() {
            "steady".to_string()
        } else {
            format!("not steady: {} % from the first to the second half", signed(100.0 * cycle.drift, 0))
        };
        table.notes.push(format!(
            "From {} s on {} swings by ± {} {} about {} (r.m.s. {}), {verdict}.",
            significant(run.watched.window[0], 3),
            channel.name.replace('_', " "),
            significant(cycle.amplitude, 3),
            channel.unit,
            significant(cycle.mean, 3),
            significant(cycle.rms, 3)
        ));
    }
    let [open, stuck, backwards, _] = run.spent.map(|share| fixed(100.0 * share, 1));
    table.notes.push(format!(
        "The point that carries most was open {open} %, stuck {stuck} % and slid backwards {backwards} % of the time."
    ));
    let stuck = run.stuck_without_give();
    if !stuck.is_empty() {
        table.notes.push(format!(
            "Assumed: friction of {} at rest is any force up to μ(0) N, so that its points stick without give; a `bristle` \
             gives before it slips.",
            stuck.join(", ")
        ));
    }
    let work = &run.work;
    table.notes.push(format!(
        "Energy: drives spent {} J, friction heat {} J, structural damping took {} J, the integrator {} J; the balance of each step closes to {}.",
        significant(work.drive, 4),
        significant(work.heat, 4),
        significant(-work.damping, 3),
        significant(-work.algorithm, 3),
        power(run.worst_residual)
    ));
    if run.split.0 > 0 {
        table.notes.push(format!(
            "{} steps were split, into up to {} parts: {} in all.",
            run.split.0, run.split.1, run.parts
        ));
    }
    table
}

/// The measured peak that is nearest to a frequency, if it is near.
fn near(measured: &[f64], hz: f64) -> String {
    let away = |other: &f64| (other / hz - 1.0).abs();
    let nearest = measured.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.filter(|other| away(other) < NEAR).map_or(String::new(), |hz| given(*hz))
}
