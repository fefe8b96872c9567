//! The part of `summary.json` on motion in time.

use super::{Deviation, ReducedCheck, SpectrumOf, TransientResult};
use crate::signal::LimitCycle;
use crate::transient::EventKind;
use serde_json::{Value, json};
use std::f64::consts::TAU;

pub(super) fn transient(result: &TransientResult) -> Value {
    let channels: Vec<Value> = result
        .channels
        .iter()
        .map(|c| json!({ "name": c.name, "unit": c.unit, "range": c.range, "last": c.last }))
        .collect();
    let spectrum = |of: &SpectrumOf| {
        let peaks: Vec<Value> = of
            .peaks
            .iter()
            .map(|p| {
                json!({ "frequency_hz": p.frequency_hz, "amplitude": p.amplitude, "relation": p.relation })
            })
            .collect();
        let channel = &result.channels[of.channel];
        json!({
            "channel": channel.name,
            "unit": channel.unit,
            "window_s": of.window,
            "resolution_hz": of.spectrum.resolution_hz,
            "peaks": peaks,
            "measured_hz": of.measured,
            "strongest_beyond_hz": of.beyond,
        })
    };
    let growth = result.growth.as_ref().map(|g| {
        json!({
            "mode": g.mode + 1,
            "cea_growth_rate": g.eigenvalue.re,
            "cea_frequency_hz": g.eigenvalue.im / TAU,
            "growth_rate": g.found.map(|f| f.rate),
            "frequency_hz": g.found.map(|f| f.frequency_hz),
            "window_s": g.found.map(|f| f.window),
            "deviation": g.found.map(|f| f.deviation),
        })
    });
    let counts =
        EventKind::ALL.iter().zip(result.events).map(|(kind, n)| (kind.name().to_string(), n.into()));
    let events: serde_json::Map<String, Value> = counts.collect();
    let cycle = |(channel, cycle): &(usize, LimitCycle)| {
        let channel = &result.channels[*channel];
        json!({
            "channel": channel.name,
            "unit": channel.unit,
            "window_s": result.watched.window,
            "amplitude": cycle.amplitude,
            "rms": cycle.rms,
            "mean": cycle.mean,
            "drift": cycle.drift,
            "steady": cycle.steady(),
        })
    };
    let work = &result.work;
    let [open, sticking, backwards, _] = result.spent;
    json!({
        "time_step_s": result.time_step,
        "steps": result.len().saturating_sub(1),
        "duration_s": result.len().saturating_sub(1) as f64 * result.time_step,
        "scheme": result.scheme,
        "set_valued_friction": result.set_valued,
        "reduced": result.reduced.map(|[modes, attached]| json!({ "modes": modes, "attachment": attached })),
        "reduced_check": result.reduced_check.as_ref().map(reduced_check),
        "channels": channels,
        "spectrum": result.spectra.iter().map(spectrum).collect::<Vec<_>>(),
        "growth": growth,
        "events": events,
        "open_fraction": open,
        "backwards_fraction": backwards,
        "sticking_fraction": sticking,
        "steps_split": result.split.0,
        "parts": result.parts,
        "most_parts": result.split.1,
        "energy_j": {
            "stored": work.kinetic + work.strain,
            "external": work.external,
            "normal": work.normal,
            "drive": work.drive,
            "heat": work.heat,
            "damping": work.damping,
            "coupling": work.coupling,
            "algorithm": work.algorithm,
            "residual": work.residual(),
        },
        "worst_energy_residual": result.worst_residual,
        "limit_cycle": result.watched.cycles.iter().map(cycle).collect::<Vec<_>>(),
        "sound": result.sound.as_ref().map(|sound| sound.group().to_json()),
    })
}

/// A reduced model beside the full one.
fn reduced_check(check: &ReducedCheck) -> Value {
    let deviation = |of: Option<Deviation>| of.map(|d| json!({ "relative": d.relative, "mode": d.mode + 1 }));
    let motion = check.motion.as_ref().map(|m| {
        json!({
            "steps": m.steps,
            "probe": m.probe,
            "displacement": m.displacement,
            "normal_force": m.normal_force,
        })
    });
    json!({
        "modes": check.modes[0],
        "modes_found": check.modes[1],
        "eigenvalue": deviation(check.eigenvalue),
        "growth_rate": deviation(check.growth),
        "motion": motion,
    })
}
