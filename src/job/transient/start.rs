//! Where a run in time begins, and how the approach of a pair follows a load that runs in time.

use super::in_time::InTime;
use super::places::TransientPlaces;
use crate::case::{HoldChoice, StartChoice, TransientAnalysis};
use crate::equilibrium::{SteadyOptions, SteadySliding, solve_steady};
use crate::error::Result;
use crate::job::time_function::profile;
use crate::system::{Closing, ContactPair, System};
use crate::transient::{Loading, NO_LOAD};

/// Equilibria between the least and the greatest load; the approach is linear between two of them.
const EQUILIBRIA: usize = 33;

/// How a run begins.
pub(super) struct InitialState {
    /// The equilibrium it begins at.
    pub(super) state: SteadySliding,
    /// Whether nothing has slid yet.
    pub(super) at_rest: bool,
}

impl InTime<'_> {
    /// Steady sliding at the velocities and loads of t = 0; without friction where a pair stands still then, or all do.
    pub(super) fn start(&self, wanted: &TransientAnalysis, places: &TransientPlaces) -> Result<InitialState> {
        let velocity = |name: &str| profile(wanted.slide.get(name).map(|slide| &slide.course)).factor(0.0);
        let load = |name: &str| profile(wanted.load.get(name)).factor(0.0);
        let pairs = &self.point.system.pairs;
        let at_rest = wanted.start == StartChoice::Rest
            || (!pairs.is_empty() && pairs.iter().all(|p| velocity(&p.name) == 0.0));
        let as_given = |name: &str| velocity(name) == 1.0 && load(name) == 1.0;
        let pushed = places.pushes.iter().any(|push| push.factor(0.0) != 0.0);
        if !at_rest && !pushed && pairs.iter().all(|pair| as_given(&pair.name)) {
            return Ok(InitialState { state: (*self.point.steady).clone(), at_rest });
        }
        let mut system = (*self.point.system).clone();
        for (pair, still) in system.pairs.iter_mut().zip(&places.still) {
            // A pair that never slides keeps the friction that it sticks by.
            if !pair.sticks() && (at_rest || velocity(&pair.name) == 0.0) {
                pair.law = still.law.clone();
            } else {
                pair.sliding_velocity *= velocity(&pair.name);
            }
            press(&mut pair.closing, load(&pair.name));
        }
        for push in &places.pushes {
            push.direction.add_to(push.factor(0.0), &mut system.load);
        }
        Ok(InitialState { state: solve_steady(&system, &SteadyOptions::default(), &())?, at_rest })
    }

    /// How the approach of each pair follows its load, where that runs in time.
    pub(super) fn loadings(&self, wanted: &TransientAnalysis) -> Result<Vec<Option<Loading>>> {
        let pairs = self.point.system.pairs.iter().enumerate();
        let loading = |(k, pair): (usize, &ContactPair)| {
            let course = wanted.load.get(&pair.name);
            let (Some(course), Closing::Load(_)) = (course, pair.closing) else { return Ok(None) };
            let factors = course.range();
            let approach = |part: usize| {
                let share = part as f64 / (EQUILIBRIA - 1) as f64;
                let mut system: System = (*self.point.system).clone();
                press(&mut system.pairs[k].closing, factors[0] + share * (factors[1] - factors[0]));
                Ok(solve_steady(&system, &SteadyOptions::default(), &())?.approach[k])
            };
            let approaches = match wanted.hold_of(&pair.name) {
                HoldChoice::Approach => (0..EQUILIBRIA).map(approach).collect::<Result<Vec<f64>>>()?,
                HoldChoice::Load => vec![self.point.steady.approach[k]],
            };
            Ok(Some(Loading { profile: profile(Some(course)), approaches, factors }))
        };
        pairs.map(loading).collect()
    }

    /// The load \[N\] that each pair keeps in motion, where it keeps one.
    pub(super) fn loads(&self, wanted: &TransientAnalysis) -> Vec<Option<f64>> {
        let load = |pair: &ContactPair| match (wanted.hold_of(&pair.name), pair.closing) {
            (HoldChoice::Load, Closing::Load(load)) => Some(load),
            _ => None,
        };
        self.point.system.pairs.iter().map(load).collect()
    }
}

fn press(closing: &mut Closing, factor: f64) {
    if let Closing::Load(load) = closing {
        *load *= factor.max(NO_LOAD);
    }
}
