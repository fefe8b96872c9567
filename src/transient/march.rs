//! Step after step, from a state to the end.

use super::ledger::Work;
use super::model::Model;
use super::scheme::Scheme;
use super::state::State;
use super::stepper::{Method, Stepper, Stuck};
use crate::error::{Error, Result};
use crate::progress::Observer;

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
    pub method: Method,
}

/// Where a march stands after a step.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Steps done.
    pub step: usize,
    /// The motion.
    pub state: &'a State,
    /// All work since the start.
    pub work: &'a Work,
}

/// What a march leaves behind.
#[derive(Debug, Clone)]
pub struct Marched {
    /// The last state.
    pub state: State,
    /// All work.
    pub work: Work,
    /// The largest |residual| of the energy balance of one step, as a part of the turnover of that step.
    pub worst_residual: f64,
    /// Steps that had to be split, and into how many parts at most.
    pub split: (usize, usize),
}

/// Marches from `start`; `record` sees the start and the end of every step.
///
/// # Errors
/// A step without a solution even when split; what `record` returns.
pub fn march(
    model: &Model<'_>,
    start: State,
    plan: &Plan,
    observer: &dyn Observer,
    record: &mut dyn FnMut(&Moment<'_>) -> Result<()>,
) -> Result<Marched> {
    let begin = start.time;
    let mut steppers = Steppers { model, plan, levels: Vec::new() };
    let (mut now, mut next, mut work) = (start, State::empty(model), Work::default());
    let (mut worst_residual, mut split): (f64, (usize, usize)) = (0.0, (0, 1));
    record(&Moment { step: 0, state: &now, work: &work })?;
    observer.begin("transient", Some(plan.steps as u64));
    for step in 1..=plan.steps {
        let ends = [step - 1, step].map(|k| begin + k as f64 * plan.step);
        let (done, parts) = steppers.advance(&mut now, &mut next, ends)?;
        if parts > 1 {
            split = (split.0 + 1, split.1.max(parts));
        }
        worst_residual = worst_residual.max(done.residual().abs() / done.turnover().max(f64::MIN_POSITIVE));
        work.add(&done);
        record(&Moment { step, state: &now, work: &work })?;
        observer.advance(1);
    }
    observer.end();
    Ok(Marched { state: now, work, worst_residual, split })
}

/// The steps of Δt, Δt/2, Δt/4 …, each made ready when it is first needed.
struct Steppers<'a> {
    model: &'a Model<'a>,
    plan: &'a Plan,
    levels: Vec<Stepper<'a>>,
}

impl Steppers<'_> {
    /// Brings `now` from the first to the second time, in as many parts as it takes; says the work and the parts.
    fn advance(&mut self, now: &mut State, next: &mut State, ends: [f64; 2]) -> Result<(Work, usize)> {
        let mut stuck = Stuck::NotFinite;
        for level in 0..=SPLITS {
            if self.levels.len() == level {
                let step = self.plan.step / (1 << level) as f64;
                self.levels.push(Stepper::new(self.model, self.plan.scheme, step, self.plan.method)?);
            }
            let parts = 1usize << level;
            // What is kept to go back to; a step that is not split needs none.
            let before = (level > 0).then(|| now.clone());
            match self.parts(level, now, next, ends) {
                Ok(work) => return Ok((work, parts)),
                Err(why) => stuck = why,
            }
            if let Some(before) = before {
                *now = before;
            }
        }
        let why = match stuck {
            Stuck::Newton(length) => format!("Newton's method for the contact still steps by {length:.1e} m"),
            Stuck::NotFinite => "the motion is no longer finite".to_string(),
        };
        Err(Error::analysis(
            "transient",
            format!(
                "at t = {:.6e} s, in steps of {:.1e} s, {why}",
                ends[0],
                self.plan.step / (1 << SPLITS) as f64
            ),
            "Make the time step smaller or the friction law smoother (`friction.regularisation`)",
        ))
    }

    fn parts(
        &mut self,
        level: usize,
        now: &mut State,
        next: &mut State,
        ends: [f64; 2],
    ) -> std::result::Result<Work, Stuck> {
        let parts = 1usize << level;
        let mut work = Work::default();
        for part in 1..=parts {
            let time = if part == parts {
                ends[1]
            } else {
                ends[0] + (ends[1] - ends[0]) * part as f64 / parts as f64
            };
            next.act(self.model, time);
            work.add(&self.levels[level].step(now, next)?);
            std::mem::swap(now, next);
        }
        Ok(work)
    }
}
