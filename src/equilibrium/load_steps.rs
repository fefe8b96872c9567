//! Steady states at once, or in steps of load and friction.

use super::point_laws::Fraction;
use crate::error::{Error, Result};

/// Why no solution was accepted.
const NOT_MET: &str = "the equations are met to more than 1e-6 of the forces";

/// Newton's method on some form of the equilibrium of a system in contact.
pub(super) trait Newton {
    /// A solution, or where to begin.
    type Stage: Clone;

    /// Where to begin with a part of load and friction.
    fn starts(&self, fraction: Fraction) -> Vec<Self::Stage>;

    /// The solution from a start with its number of iterations, or why there is none.
    fn solve(
        &self,
        start: Self::Stage,
        fraction: Fraction,
    ) -> std::result::Result<(Self::Stage, usize), String>;
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
        match newton.solve(start, 1.0).map(|(stage, iterations)| accept(stage, iterations)) {
            Ok(Some(accepted)) => return Ok(accepted),
            Ok(None) => {}
            Err(failure) => last = Some(failure),
        }
    }
    let stepped = stepped(newton).map(|(stage, iterations)| accept(stage, iterations).ok_or(None));
    stepped.flatten().map_err(|failure| {
        let failure = failure.or(last).unwrap_or_else(|| NOT_MET.into());
        Error::analysis(
            "steady sliding",
            format!("no steady state was found, neither at once nor in load steps; {failure}"),
            "Check that the load presses against a support, or lower the friction: it may jam; that the stiffnesses of contacts, springs \
             and supports do not span too many orders of magnitude",
        )
    })
}

fn stepped<N: Newton>(newton: &N) -> std::result::Result<(N::Stage, usize), Option<String>> {
    let (mut done, mut step): (Fraction, Fraction) = (0.0, 0.125);
    let mut from: Option<N::Stage> = None;
    let mut iterations = 0;
    while done < 1.0 {
        let target = (done + step).min(1.0);
        let start = from.clone().map_or_else(|| newton.starts(target), |stage| vec![stage]);
        let mut failure = None;
        let found = start.into_iter().find_map(|s| match newton.solve(s, target) {
            Ok(found) => Some(found),
            Err(f) => {
                failure = Some(f);
                None
            }
        });
        match found {
            Some((stage, more)) => {
                iterations += more;
                from = Some(stage);
                done = target;
                step *= 1.5;
            }
            None if step > 1e-3 => step *= 0.5,
            None => return Err(failure),
        }
    }
    from.map(|stage| (stage, iterations)).ok_or(None)
}
