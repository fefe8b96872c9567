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

/// How far a march has come: what is seen of it after a step, what it leaves behind, and what it can go on from.
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
}

impl From<State> for Marched {
    /// The first state, nothing done.
    fn from(state: State) -> Self {
        let begin = state.time;
        Marched { begin, step: 0, state, work: Work::default(), worst_residual: 0.0, split: (0, 1) }
    }
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
    record: &mut dyn FnMut(&Marched) -> Result<()>,
) -> Result<Marched> {
    let mut marched = Marched::from(start);
    record(&marched)?;
    go_on(model, &mut marched, plan, observer, record)?;
    Ok(marched)
}

/// Marches on to the end of the plan; `record` sees the end of every step. The motion is that of one march, bit for bit.
///
/// # Errors
/// As [`march`]; `marched` is then where the last good step ended.
pub fn go_on(
    model: &Model<'_>,
    marched: &mut Marched,
    plan: &Plan,
    observer: &dyn Observer,
    record: &mut dyn FnMut(&Marched) -> Result<()>,
) -> Result<()> {
    let mut steppers = Steppers { model, plan, levels: Vec::new() };
    let mut next = State::empty(model);
    observer.begin("transient", Some(plan.steps as u64));
    observer.advance(marched.step as u64);
    for step in marched.step + 1..=plan.steps {
        let ends = [step - 1, step].map(|k| marched.begin + k as f64 * plan.step);
        let (done, parts) = steppers.advance(&mut marched.state, &mut next, ends)?;
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
