//! Steady states at once, or in steps of load and friction.

use super::PointState;
use super::no_state::{Reached, account, account_of_lost};
use super::point_laws::{Fraction, Law, PointLaws};
use crate::error::text::capital;
use crate::error::{Error, Result};
use crate::numbers::significant;
use crate::progress::Observer;

/// Why no solution was accepted.
const NOT_MET: &str = "the equations are met to more than 1e-6 of the forces";
/// Iterations in which the shortest step has not become half as long, after which there is no convergence.
const STALLED: usize = 20;
/// The shortest load step.
const SHORTEST: f64 = 1e-3;

/// Newton's method on some form of the equilibrium of a system in contact.
pub(super) trait Newton {
    /// A solution, or where to begin.
    type Stage: Clone;

    /// The contact points.
    fn contact(&self) -> &PointLaws<'_>;

    /// Where to begin with a part of load and friction.
    fn starts(&self, fraction: Fraction) -> Vec<Self::Stage>;

    /// The solution from a start with its number of iterations, or why there is none.
    fn solve(
        &self,
        start: Self::Stage,
        fraction: Fraction,
    ) -> std::result::Result<(Self::Stage, usize), Lost<Self::Stage>>;

    /// The contact points of a stage, and the approaches of the pairs.
    fn state(&self, stage: &Self::Stage) -> (Vec<PointState>, Vec<f64>);
}

/// An iteration that ended without a solution.
pub(super) struct Lost<S> {
    /// Why.
    pub(super) why: String,
    /// Where.
    pub(super) at: S,
}

/// Watches an iteration: shows how far it is, and ends one that goes nowhere.
pub(super) struct Watch<'a> {
    observer: &'a dyn Observer,
    shortest: f64,
    since: usize,
    /// For each point whether it is closed, and whether its friction is at the limit.
    states: Vec<[bool; 2]>,
}

impl<'a> Watch<'a> {
    pub(super) fn new(observer: &'a dyn Observer) -> Self {
        Watch { observer, shortest: f64::INFINITY, since: 0, states: Vec::new() }
    }

    /// After the step of an iteration, of a length \[m\], from the state with these laws; why there is none to come.
    pub(super) fn step(
        &mut self,
        iteration: usize,
        length: f64,
        laws: &[Law],
    ) -> std::result::Result<(), String> {
        let state = |(forces, tangent): &Law| {
            let [_, along, across] = tangent.by_penetration;
            [forces.normal > 0.0, along != 0.0 || across != 0.0]
        };
        let now: Vec<[bool; 2]> = laws.iter().map(state).collect();
        let changed = now.iter().zip(&self.states).filter(|(a, b)| a != b).count();
        self.states = now;
        self.observer
            .status(&format!("iteration {iteration}, step {length:.1e} m, {changed} points changed"));
        self.observer.advance(1);
        self.since += 1;
        if length < 0.5 * self.shortest {
            (self.shortest, self.since) = (length, 0);
        }
        match self.since < STALLED {
            true => Ok(()),
            false => Err(format!(
                "at iteration {iteration} the Newton step is {length:.1e} m, no shorter than {STALLED} iterations before, and {changed} of {} points \
                 open, close, stick or slide anew",
                laws.len()
            )),
        }
    }
}

/// The first solution that is accepted, as `accept` gives it, from first touch; when that fails, in steps of load and friction. A
/// body that only closed contacts hold has, with every contact open, equations that are singular but for rounding, and a
/// solution far away that means nothing.
pub(super) fn solve_accepted<N: Newton, T>(
    newton: &N,
    mut accept: impl FnMut(N::Stage, usize) -> Option<T>,
) -> Result<T> {
    let mut last = None;
    for start in newton.starts(1.0) {
        match newton.solve(start, 1.0) {
            Ok((stage, iterations)) => {
                if let Some(accepted) = accept(stage, iterations) {
                    return Ok(accepted);
                }
            }
            Err(lost) => last = Some(lost),
        }
    }
    let (lost, way) = match stepped(newton) {
        Ok((stage, iterations)) => match accept(stage, iterations) {
            Some(accepted) => return Ok(accepted),
            None => (None, None),
        },
        Err(Ended { lost, way }) => (lost, way),
    };
    Err(failure(newton, lost.or(last), way))
}

/// The error of a solution that was lost, `way` being the first and the last state found in load steps.
fn failure<N: Newton>(
    newton: &N,
    lost: Option<Lost<N::Stage>>,
    way: Option<[(Fraction, N::Stage); 2]>,
) -> Error {
    let reached = |(fraction, stage): &(Fraction, N::Stage)| {
        let (points, approach) = newton.state(stage);
        Reached { fraction: *fraction, points, approach }
    };
    let pairs = newton.contact().pairs;
    let found = way.as_ref().map(|[first, last]| account(pairs, &reached(first), &reached(last)));
    let mut seen = found.unwrap_or_default();
    if let Some(lost) = lost.as_ref().filter(|_| seen.is_empty()) {
        seen = account_of_lost(pairs, &newton.state(&lost.at).0);
    }
    let why = lost.map_or_else(|| NOT_MET.into(), |lost| lost.why);
    let far = match &way {
        Some([_, (fraction, _)]) => format!("up to {} % of both", significant(100.0 * fraction, 3)),
        None => "not even for an eighth of both".into(),
    };
    if seen.is_empty() {
        return Error::analysis(
            "steady sliding",
            format!(
                "no steady state was found, neither at once nor in steps of load and friction ({far}); {why}"
            ),
            "Check that the load presses against a support, or lower the friction: it may jam; that the stiffnesses of contacts, springs \
             and supports do not span too many orders of magnitude",
        );
    }
    let (words, mut help): (Vec<String>, Vec<&str>) = seen.into_iter().unzip();
    help.dedup();
    Error::analysis(
        "steady sliding",
        format!(
            "the forces find no balance, neither at once nor in steps of load and friction ({far}): {}. {}",
            words.join("; "),
            capital(&why)
        ),
        capital(&help.join("; ")),
    )
}

/// Load steps that came to an end before the whole load.
struct Ended<S> {
    lost: Option<Lost<S>>,
    way: Option<[(Fraction, S); 2]>,
}

fn stepped<N: Newton>(newton: &N) -> std::result::Result<(N::Stage, usize), Ended<N::Stage>> {
    let (mut done, mut step): (Fraction, Fraction) = (0.0, 0.125);
    let mut way: Option<[(Fraction, N::Stage); 2]> = None;
    let mut iterations = 0;
    while done < 1.0 {
        let target = (done + step).min(1.0);
        let start = way.as_ref().map_or_else(|| newton.starts(target), |[_, (_, stage)]| vec![stage.clone()]);
        let mut failure = None;
        let found = start.into_iter().find_map(|s| match newton.solve(s, target) {
            Ok(found) => Some(found),
            Err(lost) => {
                failure = Some(lost);
                None
            }
        });
        match found {
            Some((stage, more)) => {
                iterations += more;
                let first = way.map_or_else(|| (target, stage.clone()), |[first, _]| first);
                way = Some([first, (target, stage)]);
                done = target;
                step *= 1.5;
            }
            None if step > SHORTEST => step *= 0.5,
            None => return Err(Ended { lost: failure, way }),
        }
    }
    match way {
        Some([_, (_, stage)]) => Ok((stage, iterations)),
        None => Err(Ended { lost: None, way: None }),
    }
}
