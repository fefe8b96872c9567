//! What the record of a run can bear: its step and its length beside the modes that are known, its forces beside the loads.

use super::in_time::InTime;
use super::plan;
use crate::case::{HoldChoice, TransientAnalysis};
use crate::linalg::c64;
use crate::numbers::significant;
use crate::results::Channel;
use crate::signal::Growth;
use crate::system::Closing;
use crate::transient::Plan;
use std::f64::consts::TAU;

/// Steps of a period at least where growth and frequency are read: Newmark's frequency is then off by (ωΔt)²/12 = 3 %.
const STEPS: f64 = 10.0;
/// Steps of a period below which peaks of a spectrum are not named: Newmark's frequency is off by 20 % there, and soon
/// lines are folded at 1/(2Δt).
const FEWEST: f64 = 4.0;
/// Periods at least from which growth is read.
const PERIODS: f64 = 3.0;
/// How far the frequency of what was fitted may be from that of the mode, as a part of it.
const OTHER: f64 = 0.1;
/// ΣN in motion, in loads at rest, beyond which it is named.
const PRESSED: f64 = 2.0;

/// Why the growth of a mode with the eigenvalue `lambda` cannot be read from a record in which it is small until `end` \[s\].
pub(super) fn unreadable(lambda: c64, plan: &Plan, end: f64) -> Option<String> {
    let (omega, step) = (lambda.norm(), plan.step);
    let hz = omega / TAU;
    if hz * step > 1.001 / STEPS {
        return Some(format!(
            "a period of the mode is {:.3} steps, at {hz:.1} Hz, and growth is read from {STEPS} steps of a period or more, \
             `transient.time_step` of {:.1e} s or less",
            1.0 / (hz * step),
            1.0 / (hz * STEPS)
        ));
    }
    if hz * end < PERIODS {
        return Some(format!(
            "the motion is small for {} s only, {:.2} periods of the mode at {hz:.1} Hz, and growth is read from {PERIODS} periods or \
             more: make `transient.duration` longer, or `transient.disturbance.amplitude` smaller",
            significant(end, 3),
            hz * end
        ));
    }
    None
}

/// The warning of steps of the motion, `taken` \[s\], or rows of the record, one `step` \[s\] apart, that are long beside the period of a
/// mode at `hz`.
fn long_steps(hz: f64, step: f64, taken: f64) -> Option<String> {
    let [rows, steps] = [step, taken].map(|length| 1.0 / (hz * length));
    let mode = format!("a period of the mode at {hz:.1} Hz, which grows or along which the motion starts,");
    let unread = "no frequency is read from the record";
    let rest = if rows < FEWEST { format!("; {unread}") } else { String::new() };
    let shorter = 1.0 / (hz * STEPS);
    match (steps < STEPS, rows < FEWEST) {
        (true, _) if taken < 0.999 * step => Some(format!(
            "`transient.tolerance`: {mode} is {steps:.3} steps, of {taken:.1e} s in the mean after they were split; the motion is not \
             followed below {STEPS}, {shorter:.1e} s{rest}."
        )),
        (true, _) => Some(format!(
            "`transient.time_step` = {step:e} s: {mode} is {steps:.3} steps; the motion is not followed below {STEPS}, \
             {shorter:.1e} s{rest}."
        )),
        (false, true) => Some(format!(
            "`transient.time_step` = {step:e} s: {mode} is {rows:.3} rows of the record; {unread} below {FEWEST}, {:.1e} s, though the \
             motion was followed in shorter steps.",
            1.0 / (hz * FEWEST)
        )),
        (false, false) => None,
    }
}

/// Why what was fitted is not the mode.
pub(super) fn another(lambda: c64, found: &Growth) -> Option<String> {
    let hz = lambda.im / TAU;
    ((found.frequency_hz - hz).abs() > OTHER * hz).then(|| {
        format!(
            "what was recorded turns at {:.1} Hz where the mode does at {hz:.1} Hz: it is not the motion of this mode alone",
            found.frequency_hz
        )
    })
}

impl InTime<'_> {
    /// The period of the fastest mode that grows, or along which the motion starts, in steps; none without one.
    fn steps_of_a_period(&self, disturbed: Option<c64>, step: f64) -> Option<(f64, f64)> {
        let grows =
            self.complex.modes.modes.iter().filter(|mode| mode.unstable()).map(|mode| mode.eigenvalue);
        let fastest = grows.chain(disturbed).map(|lambda| lambda.im / TAU).fold(0.0, f64::max);
        (fastest > 0.0).then(|| (1.0 / (fastest * step), fastest))
    }

    /// Whether peaks of spectra are frequencies of the motion at such steps.
    pub(super) fn names_peaks(&self, disturbed: Option<c64>, step: f64) -> bool {
        self.steps_of_a_period(disturbed, step).is_none_or(|(steps, _)| steps >= FEWEST)
    }

    /// Steps that are long beside a mode that matters, and forces beyond the load; `taken` is the mean length of the steps of the motion,
    /// the rows of the record being one time step apart.
    pub(super) fn motion_warnings(
        &self,
        wanted: &TransientAnalysis,
        disturbed: Option<c64>,
        taken: f64,
        channels: &[Channel],
    ) -> Vec<String> {
        let step = plan(wanted).step;
        let fastest = self.steps_of_a_period(disturbed, step);
        let mut all: Vec<String> =
            fastest.and_then(|(_, hz)| long_steps(hz, step, taken)).into_iter().collect();
        let grows = self.complex.modes.modes.iter().any(|mode| mode.unstable());
        for pair in &self.point.system.pairs {
            if let (Closing::Approach(_), Some(HoldChoice::Load)) = (pair.closing, wanted.hold) {
                all.push(format!(
                    "The contact {} is closed by an approach, and keeps it: `transient.hold = \"load\"` is for contacts with a `load`.",
                    pair.name
                ));
            }
            let holds = wanted.hold_of(&pair.name);
            if holds == HoldChoice::Load && wanted.hold.is_none() && grows {
                all.push(format!(
                    "The contact {} keeps its load in motion, which runs in time; in the complex eigenvalues, of which some grow, it \
                     keeps its approach. `transient.hold = \"approach\"` keeps that in motion, too.",
                    pair.name
                ));
            }
            let (Closing::Load(load), HoldChoice::Approach) = (pair.closing, holds) else { continue };
            let most = load * wanted.load.get(&pair.name).map_or(1.0, |course| course.range()[1]);
            let name = format!("{}_normal_force", pair.name);
            let reached =
                channels.iter().find(|channel| channel.name == name).map_or(0.0, |channel| channel.range[1]);
            if reached > PRESSED * most {
                all.push(format!(
                    "The contact {} is closed by {} N at rest and reaches {} N in motion, {:.1} times as much: its \
                     approach is kept in motion, as in the complex eigenvalues, not its load. `transient.hold = \"load\"` keeps \
                     the load.",
                    pair.name,
                    significant(most, 3),
                    significant(reached, 3),
                    reached / most
                ));
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::transient::{Scheme, StepMethod};

    /// Steps from 0.01 to 10 periods: growth is stated where it is right, of the root of the scheme that is followed.
    #[test]
    fn growth_is_not_read_from_steps_and_records_that_cannot_bear_it() {
        let hz = 1352.0;
        let lambda = c64::new(90.0, TAU * hz);
        for k in 0..=30 {
            let periods = 0.01 * 10f64.powf(0.1 * f64::from(k));
            let step = periods / hz;
            for scheme in [Scheme::TRAPEZOIDAL, Scheme::hht(-0.05)] {
                let plan = Plan { scheme, step, steps: 1000, method: StepMethod::Condensed, tolerance: None };
                let refused = unreadable(lambda, &plan, 1000.0 * step);
                if periods > 0.101 {
                    assert!(
                        refused.as_ref().is_some_and(|words| words.contains("time_step")),
                        "{periods} {refused:?}"
                    );
                } else if periods < 0.099 {
                    assert_eq!(refused, None, "{periods}");
                }
                assert!(unreadable(lambda, &plan, 2.9 / hz).is_some());
            }
        }
        let found = Growth { rate: 90.0, frequency_hz: 48.3, window: [0.0, 1.0], deviation: 0.0 };
        assert!(
            another(lambda, &found).is_some()
                && another(lambda, &Growth { frequency_hz: hz, ..found }).is_none()
        );
    }

    /// Steps and rows from 0.01 to 10 periods, split or not: the warning is of what is too long, and of nothing else.
    #[test]
    fn steps_that_were_split_are_judged_by_their_own_length() {
        let hz = 440.0;
        for k in 0..=30 {
            let step = 0.01 * 10f64.powf(0.1 * f64::from(k)) / hz;
            for parts in [1.0, 2.0, 4.0, 64.0, 4096.0] {
                let taken = step / parts;
                let words = long_steps(hz, step, taken).unwrap_or_default();
                let [followed, read] = [1.0 / (hz * taken) >= STEPS, 1.0 / (hz * step) >= FEWEST];
                assert_eq!(words.contains("not followed"), !followed, "{step} {parts}: {words}");
                assert_eq!(words.contains("no frequency is read"), !read, "{step} {parts}: {words}");
                assert_eq!(words.is_empty(), followed && read);
            }
        }
    }

    /// What a scheme adds to σ, against steps of an oscillator without damping.
    #[test]
    fn the_growth_of_a_scheme_is_that_of_its_steps() {
        for (scheme, damps) in
            [(Scheme::TRAPEZOIDAL, false), (Scheme::hht(-0.05), true), (Scheme::generalised_alpha(0.6), true)]
        {
            for turn in [0.05, 0.2, 0.6] {
                let Scheme { alpha_m, alpha_f, beta, gamma } = scheme;
                // Δt = 1, ω = `turn`, M = 1: energies over many steps.
                let k = turn * turn;
                let (mut u, mut v, mut a) = (1.0, 0.0, -k);
                let mut peaks = Vec::new();
                for _ in 0..2000 {
                    let predicted = u + v + (0.5 - beta) * a;
                    let rest = alpha_m * a + (1.0 - alpha_f) * k * predicted + alpha_f * k * u;
                    let next = -rest / (1.0 - alpha_m + (1.0 - alpha_f) * k * beta);
                    u = predicted + beta * next;
                    v += (1.0 - gamma) * a + gamma * next;
                    a = next;
                    peaks.push((v * v + k * u * u).ln() / 2.0);
                }
                // Whole turns, between which the ripple of the energy is the same.
                let fitted = (peaks[1900..].iter().sum::<f64>() - peaks[900..1000].iter().sum::<f64>())
                    / 100.0
                    / 1000.0;
                let own = scheme.own_growth(turn, 1.0);
                assert!(
                    within(own, 1e-12, RoundOff) && (own < -0.000_000_001) == damps,
                    "{scheme:?} {turn} {own}"
                );
                // Round-off and what is left of the ripple, over a thousand steps.
                assert!(
                    within((fitted - own).abs(), 2e-3 * own.abs() + 2e-5, Discretisation),
                    "{scheme:?} {turn}: {fitted} {own}"
                );
            }
        }
    }
}
