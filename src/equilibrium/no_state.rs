//! Why no steady state was found: what the contacts do where the solution is lost.
//!
//! With load and friction growing together from nothing, a solution that exists for a part of them and for no more ends in one of three ways.
//! A pair that does not slide holds its body by friction up to μN: where its points are at that limit, no force is left that could grow. A face on
//! which friction μN acts at a height h above where the body is held carries on one edge alone once μ h is as long as the way to that edge: then
//! the body tips. Friction that drives a body into its counter-body adds μ times a part of N to what presses: N grows beyond all
//! bounds where that part is one, or an approach falls to nothing at a given N: the contact locks.

use super::PointState;
use super::balance::by_pair;
use crate::numbers::significant;
use crate::system::{Closing, ContactPair};

/// A state on the way.
#[derive(Debug, Clone)]
pub(super) struct Reached {
    /// Part of load and friction.
    pub(super) fraction: f64,
    pub(super) points: Vec<PointState>,
    pub(super) approach: Vec<f64>,
}

/// The part of the closed points of a pair that is at its limit from which on friction does not hold the body.
const AT_THE_LIMIT: f64 = 1.0 / 3.0;
/// The part of its weight on which a pair carries when it stands on an edge.
pub const EDGE: f64 = 0.25;
/// How many times as much of the load a contact carries as at first, when friction drives it in.
const DRIVEN: f64 = 3.0;

/// What is seen in the state at which an iteration ended, where the friction of a pair that does not slide is used up, and what to do.
pub(super) fn account_of_lost(pairs: &[ContactPair], points: &[PointState]) -> Vec<(String, &'static str)> {
    let held = by_pair(pairs, points).filter(|(pair, _)| pair.sticks());
    held.flat_map(|(pair, own)| slides_away(pair, own)).collect()
}

/// What is seen, and what to do; empty where nothing is. `first` and `last` are the states that were found in load steps.
pub(super) fn account(pairs: &[ContactPair], first: &Reached, last: &Reached) -> Vec<(String, &'static str)> {
    let mut all = Vec::new();
    let both = by_pair(pairs, &first.points).zip(by_pair(pairs, &last.points)).zip(&last.approach);
    for (((pair, before), (_, now)), approach) in both {
        if pair.sticks() {
            all.extend(slides_away(pair, now));
        } else {
            all.extend(tips(pair, now));
            all.extend(locks(pair, *approach, [(first, before), (last, now)]));
        }
    }
    all
}

/// A pair that does not slide, and whose friction is used up.
fn slides_away(pair: &ContactPair, points: &[PointState]) -> Vec<(String, &'static str)> {
    let closed = points.iter().filter(|point| point.closed()).count();
    let limit = points.iter().filter(|point| point.closed() && point.slips).count();
    if limit == 0 || (limit as f64) < AT_THE_LIMIT * closed as f64 {
        return Vec::new();
    }
    let does = if limit == closed { "slides away" } else { "begins to slide" };
    let found = format!(
        "`{}`, which does not slide, has {limit} of its {closed} closed points at the limit μN of friction: its body {does}",
        pair.name
    );
    let help = "raise the friction of the contact that does not slide or what presses it, or hold its body along the face by a [support], [spring] or [tie]";
    vec![(found, help)]
}

/// The part of the weights of its points, their area on faces, on which a pair carries.
pub fn carrying_share(pair: &ContactPair, points: &[PointState]) -> f64 {
    let weight = |closed: bool| {
        let those = pair.points.iter().zip(points).filter(|(_, state)| !closed || state.closed());
        those.map(|(point, _)| point.weight).sum::<f64>()
    };
    weight(true) / weight(false)
}

/// A pair that carries on an edge.
fn tips(pair: &ContactPair, points: &[PointState]) -> Option<(String, &'static str)> {
    let share = carrying_share(pair, points);
    (points.len() > 3 && share > 0.0 && share < EDGE).then(|| {
        let found = format!("`{}` carries on {} % of its points: its body tips", pair.name, significant(100.0 * share, 2));
        (found, "lower the friction, press nearer to the middle of the face, or support the body nearer to its face and against turning")
    })
}

/// A pair that friction drives in.
fn locks(
    pair: &ContactPair,
    approach: f64,
    [(first, before), (last, now)]: [(&Reached, &[PointState]); 2],
) -> Option<(String, &'static str)> {
    let force = |points: &[PointState]| points.iter().map(|point| point.forces.normal).sum::<f64>();
    let touch = pair.least_gap();
    let driven = match pair.closing {
        Closing::Load(_) if approach < touch => {
            format!("which carries its load {} µm apart", significant(1e6 * (touch - approach), 3))
        }
        Closing::Approach(_) => {
            let times = force(now) / last.fraction / (force(before) / first.fraction);
            if times.is_nan() || times < DRIVEN {
                return None;
            }
            format!(
                "which presses {} times as much for each newton of load as at first",
                significant(times, 2)
            )
        }
        _ => return None,
    };
    let found = format!("friction drives the body of `{}` in, {driven}: it locks", pair.name);
    Some((found, "lower the friction, or support the body nearer to its face"))
}
