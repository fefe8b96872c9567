//! Steady states of systems that differ little from one whose steady state is known: no new factorisation.

use super::SteadyOptions;
use super::SteadySliding;
use super::balance::{residual, states};
use super::linear::tangent_stiffness;
use super::point_laws::{State, norm};
use super::solver::SteadySolver;
use super::steady::solve_steady;
use crate::error::{Error, Fault, Result};
use crate::system::System;

/// A known steady state with the compliance of its contact.
///
/// A neighbour's state is found by Newton steps on the neighbour's own full residual f − K u − r_c, with the neighbour's
/// own laws but the compliance A⁻¹ of the known system. Laws, loads and velocities leave A as it is, so that the steps
/// converge quadratically; a structure that differs by ε of itself costs a factor of about ε a step.
pub struct Nearby<'a> {
    system: &'a System,
    steady: &'a SteadySliding,
    solver: SteadySolver<'a>,
}

impl<'a> Nearby<'a> {
    /// Factorises the closed structure of `system` at its steady state.
    ///
    /// # Errors
    /// A rigid motion that not even the closed contact resists.
    pub fn new(system: &'a System, steady: &'a SteadySliding) -> Result<Self> {
        let k = tangent_stiffness(system, &steady.displacement)?;
        Ok(Nearby { system, steady, solver: SteadySolver::new(system, k)? })
    }

    /// The steady state of `other`, which has the same degrees of freedom and contact points. Where the steps do not
    /// converge the state is found from nothing.
    ///
    /// # Errors
    /// Another number of degrees of freedom or contact points; no steady state.
    pub fn solve(&self, other: &System) -> Result<SteadySliding> {
        let size = |s: &System| (s.n_dofs(), s.pairs.iter().map(|p| p.points.len()).collect::<Vec<_>>());
        if size(other) != size(self.system) {
            let say = |(n, points): (usize, Vec<usize>)| {
                format!("{n} degrees of freedom, contact points {points:?}")
            };
            return Err(Error::input(Fault::new(
                "a neighbouring system",
                say(size(other)),
                say(size(self.system)),
            )));
        }
        match self.steps(other)? {
            Some(steady) => Ok(steady),
            None => solve_steady(other, &SteadyOptions::default(), &()),
        }
    }

    fn steps(&self, other: &System) -> Result<Option<SteadySliding>> {
        const STEPS: usize = 40;
        const SETTLED: f64 = 1e-15;
        const ACCEPTED: f64 = 1e-11;
        let problem = self.solver.problem(&other.pairs, &other.load, &SteadyOptions::default(), &());
        let mut state = State::of(self.steady);
        let mut last = f64::INFINITY;
        for iterations in 1..=STEPS {
            let k = tangent_stiffness(other, &state.displacement)?;
            let (r, _) = residual(
                other,
                &k,
                &state.displacement,
                &states(&other.pairs, &state.penetration, &state.displacement),
            );
            let Some(correction) = problem.correction(&state, &r) else { return Ok(None) };
            let size = norm(&state.displacement).max(norm(&state.approach)).max(f64::MIN_POSITIVE);
            let step = norm(&correction.displacement).max(norm(&correction.approach)) / size;
            // Round-off: the steps are small and shrink no more. The smaller step is the better state.
            let shrinks = step < 0.5 * last;
            if step.is_nan() || (!shrinks && last > ACCEPTED && iterations > 4) {
                return Ok(None);
            }
            state.add(1.0, &correction);
            if step <= SETTLED || (step <= ACCEPTED && !shrinks) {
                let State { displacement, approach, penetration } = state;
                let k = tangent_stiffness(other, &displacement)?;
                let points = states(&other.pairs, &penetration, &displacement);
                let residual = residual(other, &k, &displacement, &points).1;
                return Ok(Some(SteadySliding { displacement, approach, points, iterations, residual }));
            }
            last = step;
        }
        Ok(None)
    }
}
