//! Step after step, from a state to the end.

use super::energy_balance::Work;
use super::model::TransientModel;
use super::scheme::Scheme;
use super::solver::StepFailure;
use super::state::State;
use super::stepper::{StepMethod, Stepper};
use crate::error::{Error, Result};
use crate::progress::Observer;
use crate::system::FrictionAtRest;

/// A step that fails is split into 2, 4 … 2^SPLITS parts.
const SPLITS: usize = 10;

/// How to march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// The scheme.
    pub scheme: Scheme,
    /// Δt \[s\].
    pub step: f64,
    /// How many of them.
    pub steps: usize,
    /// How each is solved.
    pub method: StepMethod,
    /// The local error that each may have at most, see [`Control`]; any when absent.
    pub tolerance: Option<f64>,
}

/// How finely steps are split for the error they make.
///
/// The local error of Newmark's displacement is |β − 1/6| Δt² Δa (O. C. Zienkiewicz & Y. M. Xie, Earthq. Eng. Struct. Dyn.
/// 20 (1991) 871). As a part of the way Δt |v| that the motion makes at its fastest,
///
/// η = |β − 1/6| Δt ‖Δa‖_M/max ‖v‖_M,
///
/// it is the relative error of the frequency of a harmonic motion, (ωΔt)²/12 for β = ¼. A step with η above the tolerance
/// is done again in twice as many parts; one with less than an eighth of it lets the next have half as many.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Control {
    /// Steps are split into 2^level parts.
    pub level: usize,
    /// max vᵀMv so far.
    pub fastest: f64,
    /// Parts done in all.
    pub parts: usize,
}

/// State of an integration after a step: the motion, its work and statistics, and all that is needed to resume.
#[derive(Debug, Clone)]
pub struct Marched {
    /// When it began \[s\].
    pub begin: f64,
    /// Steps done.
    pub step: usize,
    /// The motion.
    pub state: State,
    /// All work since the start.
    pub work: Work,
    /// The largest |residual| of the energy balance of one step, as a part of the turnover of that step.
    pub worst_residual: f64,
    /// Steps that had to be split, and into how many parts at most.
    pub split: (usize, usize),
    /// How finely.
    pub control: Control,
}

impl From<State> for Marched {
    /// The first state, nothing done.
    fn from(state: State) -> Self {
        let begin = state.time;
        let (work, control) = (Work::default(), Control::default());
        Marched { begin, step: 0, state, work, worst_residual: 0.0, split: (0, 1), control }
    }
}

/// Marches from `start`; `record` sees the start and the end of every step.
///
/// # Errors
/// A step without a solution even when split; what `record` returns.
pub fn march(
    model: &TransientModel<'_>,
    start: State,
    plan: &Plan,
    observer: &dyn Observer,
    record: &mut dyn FnMut(&Marched) -> Result<()>,
) -> Result<Marched> {
    let mut marched = Marched::from(start);
    record(&marched)?;
    resume(model, &mut marched, plan, observer, record)?;
    Ok(marched)
}

/// Resumes to the end of the plan; `record` sees the end of every step. The motion is that of one march, bit for bit.
///
/// # Errors
/// As [`march`]; `marched` is then where the last good step ended.
pub fn resume(
    model: &TransientModel<'_>,
    marched: &mut Marched,
    plan: &Plan,
    observer: &dyn Observer,
    record: &mut dyn FnMut(&Marched) -> Result<()>,
) -> Result<()> {
    let mut steppers = Steppers { model, plan, levels: Vec::new(), sticking: Vec::new() };
    let mut next = State::empty(model);
    observer.begin("transient", Some(plan.steps as u64));
    observer.advance(marched.step as u64);
    for step in marched.step + 1..=plan.steps {
        let ends = [step - 1, step].map(|k| marched.begin + k as f64 * plan.step);
        let (done, parts) = steppers.advance(&mut marched.state, &mut next, ends, &mut marched.control)?;
        if parts > 1 {
            marched.split = (marched.split.0 + 1, marched.split.1.max(parts));
        }
        let left = done.residual().abs() / done.turnover().max(f64::MIN_POSITIVE);
        marched.worst_residual = marched.worst_residual.max(left);
        marched.work.add(&done);
        marched.step = step;
        record(marched)?;
        observer.advance(1);
    }
    observer.end();
    Ok(())
}

/// What helps a step that fails: shorter steps, and a contact, if one is known, whose friction changes less abruptly at rest.
fn remedy(tolerance: Option<f64>, contact: Option<(&str, FrictionAtRest)>) -> String {
    let shorter = match tolerance {
        None => "or let `transient.tolerance = 1e-3` split steps before they fail".into(),
        Some(tolerance) => format!("or `transient.tolerance`, which is {tolerance:e}"),
    };
    let softer = contact.map_or(String::new(), |(name, at_rest)| match at_rest {
        FrictionAtRest::SetValued => format!(
            "; or let the contact give before it slips, `[contact.{name}.bristle]` with a `stiffness` as large as the normal one, or \
             smooth its friction law, `contact.{name}.friction.regularisation`"
        ),
        FrictionAtRest::Elastic => {
            format!("; or make its bristle softer, `contact.{name}.bristle.stiffness`, or damp it, `contact.{name}.bristle.damping`")
        }
        FrictionAtRest::Smoothed => format!(
            "; or let the contact give before it slips, `[contact.{name}.bristle]` with a `stiffness` as large as the normal one in \
             place of `contact.{name}.friction.regularisation`, or make that larger"
        ),
        FrictionAtRest::AsInSlip => String::new(),
    });
    format!("Make `transient.time_step` smaller, {shorter}{softer}")
}

/// The steps of Δt, Δt/2, Δt/4 …, each made ready when it is first needed.
struct Steppers<'a> {
    model: &'a TransientModel<'a>,
    plan: &'a Plan,
    levels: Vec<Stepper<'a>>,
    /// Those of the same length in which a point sticks, see [`Scheme::for_sticking`].
    sticking: Vec<Option<Stepper<'a>>>,
}

impl Steppers<'_> {
    /// Brings `now` from the first to the second time, in as many parts as it takes; says the work and the parts.
    fn advance(
        &mut self,
        now: &mut State,
        next: &mut State,
        ends: [f64; 2],
        control: &mut Control,
    ) -> Result<(Work, usize)> {
        let mut stuck = StepFailure::NotFinite;
        let tolerance = self.plan.tolerance.unwrap_or(f64::INFINITY);
        for level in control.level..=SPLITS {
            while self.levels.len() <= level {
                let step = self.plan.step / (1 << self.levels.len()) as f64;
                self.levels.push(Stepper::new(self.model, self.plan.scheme, step, self.plan.method)?);
                self.sticking.push(None);
            }
            let parts = 1usize << level;
            // What is kept to go back to; a single step that may fail but not err needs none.
            let before = (level > 0 || self.plan.tolerance.is_some()).then(|| now.clone());
            let mut fastest = control.fastest;
            match self.parts(level, now, next, ends, &mut fastest) {
                Ok((work, error)) if error <= tolerance || level == SPLITS => {
                    control.fastest = fastest;
                    control.parts += parts;
                    if self.plan.tolerance.is_some() {
                        control.level = if error < tolerance / 8.0 { level.saturating_sub(1) } else { level };
                    }
                    return Ok((work, parts));
                }
                Ok(_) => {}
                Err(why) => stuck = why,
            }
            if let Some(before) = before {
                *now = before;
            }
        }
        let why = match stuck {
            StepFailure::Newton { length, .. } => {
                format!("Newton's method for the contact still moves it by {length:.1e} m")
            }
            StepFailure::NotFinite => "the motion is no longer finite".to_string(),
        };
        let (place, contact) = match stuck {
            StepFailure::Newton { point: Some(point), .. } => {
                let (place, contact) = self.model.place(point);
                (place, Some(contact))
            }
            _ => (String::new(), None),
        };
        let found = format!(
            "at t = {:.6e} s, in steps of {:.1e} s, {why}{place}",
            ends[0],
            self.plan.step / (1 << SPLITS) as f64
        );
        let help = remedy(self.plan.tolerance, contact);
        Err(Error::analysis("transient", found, help))
    }

    /// One step of the scheme, or of the one that takes its place where a point sticks.
    fn step(
        &mut self,
        level: usize,
        now: &State,
        next: &mut State,
    ) -> std::result::Result<Work, StepFailure> {
        let Some(other) = self.plan.scheme.for_sticking() else {
            return self.levels[level].step(now, next);
        };
        if !now.rests(self.model) {
            let work = self.levels[level].step(now, next)?;
            if !next.rests(self.model) {
                return Ok(work);
            }
        }
        let damped = match &mut self.sticking[level] {
            Some(damped) => damped,
            absent => {
                let step = self.plan.step / (1 << level) as f64;
                let stepper = Stepper::new(self.model, other, step, self.plan.method);
                absent.insert(stepper.map_err(|_| StepFailure::NotFinite)?)
            }
        };
        damped.step(now, next)
    }

    /// The work of 2^level parts, and the largest error of one.
    fn parts(
        &mut self,
        level: usize,
        now: &mut State,
        next: &mut State,
        ends: [f64; 2],
        fastest: &mut f64,
    ) -> std::result::Result<(Work, f64), StepFailure> {
        let parts = 1usize << level;
        let (mut work, mut worst) = (Work::default(), 0.0f64);
        let length = (ends[1] - ends[0]) / parts as f64;
        for part in 1..=parts {
            let time = if part == parts { ends[1] } else { ends[0] + length * part as f64 };
            next.act(self.model, time);
            work.add(&self.step(level, now, next)?);
            std::mem::swap(now, next);
            if self.plan.tolerance.is_some() {
                // `next` is where the part began.
                let (mut jump, mut speed) = (0.0, 0.0);
                let [v, a, b] =
                    [(&*now, 1), (&*now, 2), (&*next, 2)].map(|(state, k)| state.motion.col_as_slice(k));
                let inertia =
                    [(&*now, 0), (&*now, 1), (&*next, 1)].map(|(state, k)| state.inertia.col_as_slice(k));
                for i in 0..v.len() {
                    speed += v[i] * inertia[0][i];
                    jump += (a[i] - b[i]) * (inertia[1][i] - inertia[2][i]);
                }
                *fastest = fastest.max(speed);
                let share = (self.plan.scheme.beta - 1.0 / 6.0).abs() * length;
                worst = worst.max(share * (jump.max(0.0) / fastest.max(f64::MIN_POSITIVE)).sqrt());
            }
        }
        Ok((work, worst))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_remedy_is_one_that_the_contact_does_not_have_yet() {
        let of = |at_rest| remedy(None, Some(("rim", at_rest)));
        assert!(of(FrictionAtRest::SetValued).contains("`[contact.rim.bristle]` with a `stiffness`"));
        let elastic = of(FrictionAtRest::Elastic);
        assert!(
            elastic.contains("bristle softer")
                && !elastic.contains("[contact")
                && !elastic.contains("regularisation")
        );
        assert!(
            of(FrictionAtRest::Smoothed)
                .ends_with("`contact.rim.friction.regularisation`, or make that larger")
        );
        assert!(!of(FrictionAtRest::AsInSlip).contains("contact"));
        let with_tolerance = remedy(Some(1e-3), None);
        assert!(
            with_tolerance.ends_with("or `transient.tolerance`, which is 1e-3")
                && !with_tolerance.contains("contact")
        );
    }
}
