//! Steady states of systems on one structure, which is factorised once: few contact points condensed, many with the whole.

use super::assembled::{Assembled, WholeProblem};
use super::balance::{residual, states};
use super::condensed::Condensed;
use super::conditions::{check_contact, check_input};
use super::load_steps::{Newton, solve_accepted};
use super::newton::ContactProblem;
use super::point_laws::{PointLaws, State, norm};
use super::{PointState, SteadyOptions, SteadySliding};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::progress::Observer;
use crate::system::{ContactPair, Coupling, System};
use std::borrow::Cow;

/// Contact points beyond which the condensed problem costs more, in time and memory, than products with the whole structure.
pub const FEW_POINTS: usize = 500;

/// The largest error, relative to the forces and lengths, with which a steady state is an answer.
const ACCEPTED: f64 = 1e-6;

/// A structure with its contact closed, factorised: what steady states of systems are solved with that differ from one in laws,
/// loads and velocities.
pub struct SteadySolver<'a> {
    /// K, or K + K_σ.
    stiffness: Cow<'a, SparseMatrix>,
    method: Method<'a>,
    /// A state that is known.
    known: Option<State>,
}

enum Method<'a> {
    /// The compliance seen from the contact points, which is dense.
    Condensed(Box<Condensed>),
    /// Products with the sparse structure.
    Assembled(Assembled<'a>),
}

impl<'a> SteadySolver<'a> {
    /// Of `system` with the stiffness `k` (K, or K + K_σ).
    ///
    /// # Errors
    /// A rigid motion that not even the closed contact resists.
    pub fn new(system: &'a System, stiffness: Cow<'a, SparseMatrix>) -> Result<Self> {
        let unsymmetric = system.coupling.as_ref().is_some_and(Coupling::has_stiffness);
        let sticks = system.pairs.iter().any(ContactPair::sticks);
        let method = if unsymmetric || sticks || system.points().count() > FEW_POINTS {
            Method::Assembled(Assembled::new(system, &stiffness)?)
        } else {
            Method::Condensed(Condensed::new(system, &stiffness)?.into())
        };
        Ok(SteadySolver { stiffness, method, known: None })
    }

    /// The same for systems whose state is near one that is known.
    pub fn near(self, steady: &SteadySliding) -> Self {
        SteadySolver { known: Some(State::of(steady)), ..self }
    }

    /// The equilibrium of pairs and a load on the structure.
    pub(super) fn problem<'s>(
        &'s self,
        pairs: &'s [ContactPair],
        load: &'s [f64],
        options: &SteadyOptions,
        observer: &'s dyn Observer,
    ) -> Problem<'s> {
        let most = options.max_iterations;
        match &self.method {
            Method::Condensed(condensed) => {
                Problem::Condensed(ContactProblem::new((pairs, load), condensed, most, observer))
            }
            Method::Assembled(assembled) => Problem::Assembled(WholeProblem::new(
                (pairs, load),
                (assembled, &self.stiffness),
                (most, observer),
                self.known.as_ref(),
            )),
        }
    }

    /// The steady state of `system`, on the structure that the solver was made of.
    ///
    /// # Errors
    /// As [`super::solve_steady`].
    pub fn solve(
        &self,
        system: &System,
        options: &SteadyOptions,
        observer: &dyn Observer,
    ) -> Result<SteadySliding> {
        let problem = self.problem(&system.pairs, &system.load, options, observer);
        let mut refused = None;
        let mut accepted = |state: State, iterations: usize| {
            let (state, error) = refine(system, &self.stiffness, &problem, state);
            // NaN is none.
            if error.is_nan() || error > ACCEPTED {
                return None;
            }
            let points = states(&system.pairs, &state.penetration, &state.displacement);
            if let Err(fault) = check_contact(&system.pairs, &state.approach, &points, options) {
                refused = Some(fault);
                return None;
            }
            Some(SteadySliding {
                residual: residual(system, &self.stiffness, &state.displacement, &points).1,
                displacement: state.displacement,
                approach: state.approach,
                points,
                iterations,
            })
        };
        let found = match &problem {
            Problem::Condensed(contact) => {
                solve_accepted(contact, |stage, iterations| accepted(contact.whole(stage), iterations))
            }
            Problem::Assembled(contact) => solve_accepted(contact, accepted),
        };
        found.map_err(|error| refused.unwrap_or(error))
    }

    /// The contact points alone at steady sliding, all that a linearisation needs where the stiffness is constant: of few points
    /// no displacement of the whole is formed, so that a point of a sweep costs Newton's method on the contact only.
    ///
    /// `pairs` are those the solver was made for, with other laws, loads or velocities; `load` is the external load. The
    /// penetrations carry the round-off of the condensed problem (about 1e-10 of themselves on fine meshes).
    ///
    /// # Errors
    /// As [`super::solve_steady`].
    pub fn points(
        &self,
        pairs: &[ContactPair],
        load: &[f64],
        options: &SteadyOptions,
    ) -> Result<Vec<PointState>> {
        check_input(pairs, load, self.stiffness.nrows())?;
        let (points, approach) = match &self.problem(pairs, load, options, &()) {
            Problem::Condensed(contact) => solve_accepted(contact, |stage, _| Some(contact.state(&stage))),
            Problem::Assembled(contact) => solve_accepted(contact, |state, _| Some(contact.state(&state))),
        }?;
        check_contact(pairs, &approach, &points, options)?;
        Ok(points)
    }
}

/// Newton steps on the full system, by the tangent of `problem`, until its residual is at round-off. Gives the state and the
/// error that is left.
fn refine(system: &System, k: &SparseMatrix, problem: &Problem<'_>, mut state: State) -> (State, f64) {
    let measure = |state: &State| {
        let points = states(&system.pairs, &state.penetration, &state.displacement);
        let (r, size) = residual(system, k, &state.displacement, &points);
        (r, norm(&[size, problem.contact().mismatch(state)]))
    };
    let (mut r, mut size) = measure(&state);
    for _ in 0..5 {
        if size <= 1e-15 {
            break;
        }
        let Some(correction) = problem.correction(&state, &r) else { break };
        let mut next = state.clone();
        next.add(1.0, &correction);
        let (next_r, next_size) = measure(&next);
        if next_size >= size || next_size.is_nan() {
            break;
        }
        (state, r, size) = (next, next_r, next_size);
    }
    (state, size)
}

/// An equilibrium in either form.
pub(super) enum Problem<'s> {
    Condensed(ContactProblem<'s>),
    Assembled(WholeProblem<'s>),
}

impl Problem<'_> {
    /// The contact points.
    pub(super) fn contact(&self) -> &PointLaws<'_> {
        match self {
            Problem::Condensed(problem) => &problem.contact,
            Problem::Assembled(problem) => &problem.contact,
        }
    }

    /// The Newton correction of a state for its residual r = f − K u − r_c, of a K near that of the structure; `None` where the
    /// contact leaves a motion free.
    pub(super) fn correction(&self, state: &State, r: &[f64]) -> Option<State> {
        match self {
            Problem::Condensed(problem) => problem.correction(state, r),
            Problem::Assembled(problem) => problem.correction(state, r),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{random_system, skew_parts};
    use super::super::{contact_force, solve_steady};
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::linalg::random::Random;
    use crate::linalg::sparse::multiply_vector;

    fn assembled<'a>(system: &'a System) -> SteadySolver<'a> {
        let stiffness = Cow::Borrowed(&*system.structure.stiffness);
        let method = Method::Assembled(Assembled::new(system, &stiffness).unwrap());
        SteadySolver { stiffness, method, known: None }
    }

    /// The same states by both methods, some points open, and from a known state under other loads.
    #[test]
    fn the_whole_and_the_condensed_problem_have_the_same_states() {
        let mut open = 0;
        for seed in 0..24 {
            let load = 2.0 + seed as f64;
            let system = random_system(40 + 9 * seed as usize, 2 + seed as usize, load, 60 + seed);
            let condensed = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let solver = assembled(&system);
            let whole = solver.solve(&system, &SteadyOptions::default(), &()).unwrap();
            let near = |a: &SteadySliding, b: &SteadySliding| {
                let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let apart =
                    |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                let u = apart(&a.displacement, &b.displacement) / largest(&a.displacement);
                let force = |s: &SteadySliding| s.points.iter().map(|p| p.forces.normal).collect::<Vec<_>>();
                let n = apart(&force(a), &force(b)) / largest(&force(a));
                assert!(within(u.max(n), 1e-9, Tolerance), "seed {seed}: {u:e} {n:e}");
            };
            near(&condensed, &whole);
            assert!(within(whole.residual, 1e-13, RoundOff), "seed {seed}: {:e}", whole.residual);
            open += whole.points.iter().filter(|point| !point.closed()).count();
            let solver = solver.near(&whole);
            let mut other = system.clone();
            for pair in &mut other.pairs {
                pair.closing = crate::system::Closing::Load(1.3 * load);
                pair.sliding_velocity *= 0.7;
            }
            let exact = solve_steady(&other, &SteadyOptions::default(), &()).unwrap();
            near(&exact, &solver.solve(&other, &SteadyOptions::default(), &()).unwrap());
            let points = solver.points(&other.pairs, &other.load, &SteadyOptions::default()).unwrap();
            for (found, exact) in points.iter().zip(&exact.points) {
                let size = exact.forces.normal.abs().max(1e-3 * load);
                assert!(within((found.forces.normal - exact.forces.normal).abs(), 1e-8 * size, Tolerance));
            }
        }
        assert!(open > 20, "{open}");
    }

    #[test]
    fn many_points_are_solved_with_the_whole() {
        let system = random_system(900, FEW_POINTS + 20, 40.0, 1);
        let stiffness = Cow::Borrowed(&*system.structure.stiffness);
        let solver = SteadySolver::new(&system, stiffness).unwrap();
        assert!(matches!(solver.method, Method::Assembled(_)));
        let steady = solver.solve(&system, &SteadyOptions::default(), &()).unwrap();
        let carried: f64 = steady.points.iter().map(|point| point.forces.normal).sum();
        assert!(within(steady.residual, 1e-13, RoundOff) && within((carried - 40.0).abs(), 1e-9, Tolerance));
        assert!(steady.points.iter().any(|point| !point.closed()));
    }

    /// Under forces and contacts a stiffness that is not symmetric is part of the balance K u + N u + W k Wᵀu + r_c = f.
    #[test]
    fn an_unsymmetric_stiffness_takes_part_in_steady_sliding() {
        for seed in 0..8 {
            let (n, mut random) = (60, Random::seeded(70 + seed));
            let mut system = random_system(n, 5, 8.0, 80 + seed);
            system.coupling = Some(skew_parts(n, seed, 1.0, 40.0));
            system.load = (0..n).map(|_| 0.1 * random.next()).collect();
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let whole = system.constant_matrices().unwrap().stiffness.transpose().to_col_major().unwrap();
            let elastic = multiply_vector(&whole, &steady.displacement);
            let contact = contact_force(&system, &steady.approach, &steady.displacement, &vec![0.0; n]);
            let size = contact.iter().chain(&system.load).fold(0.0_f64, |m, f| m.max(f.abs()));
            for i in 0..n {
                let off = (elastic[i] + contact[i] - system.load[i]).abs();
                assert!(within(off, 1e-12 * size, RoundOff), "seed {seed}: {off:e}");
            }
            let without = System { coupling: None, ..system.clone() };
            let other = solve_steady(&without, &SteadyOptions::default(), &()).unwrap();
            let moved =
                (0..n).map(|i| (other.displacement[i] - steady.displacement[i]).abs()).fold(0.0, f64::max);
            assert!(moved > 1e-4 * other.displacement.iter().fold(0.0_f64, |m, u| m.max(u.abs())), "it acts");
        }
    }
}
