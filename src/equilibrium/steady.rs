//! Steady sliding: K u₀ + Σ \[g N − t₁ F₁ − t₂ F₂\] = f with ΣN = load of each pair.

use super::balance::{norm_2, residual};
use super::conditions::check_input;
use super::linear::tangent_stiffness;
use super::solver::SteadySolver;
use super::{SteadyOptions, SteadySliding};
use crate::error::{Error, Result};
use crate::progress::Observer;
use crate::system::System;
use std::borrow::Cow;

/// The steady sliding state of `system` with the default options: see [`solve_steady`].
///
/// # Errors
/// As [`solve_steady`].
pub fn steady_sliding(system: &System) -> Result<SteadySliding> {
    solve_steady(system, &SteadyOptions::default(), &())
}

/// The steady sliding state under the system's load, its closing loads and sliding velocities.
///
/// Newton's method with the unsymmetric tangent on the problem condensed to the contact, or, of many points, on the whole
/// ([`SteadySolver`]). When it fails, load and friction grow in steps. The state is then refined against the residual of the *full* system. With a prestress the
/// whole is repeated with K + K_σ(u₀) until u₀ stays.
///
/// # Errors
/// Input: no sliding velocity, no or a negative load. Analysis: nothing holds the structure; no point touches; the
/// contact is crushed deeper than the limit; no steady state is found.
pub fn solve_steady(
    system: &System,
    options: &SteadyOptions,
    observer: &dyn Observer,
) -> Result<SteadySliding> {
    check(system)?;
    if nothing_pushes(system) {
        // u₀ = 0 is exact, also where K is singular.
        return Ok(SteadySliding {
            displacement: vec![0.0; system.n_dofs()],
            approach: Vec::new(),
            points: Vec::new(),
            iterations: 0,
            residual: 0.0,
        });
    }
    observer.begin("steady sliding", None);
    let result = solve_prestressed(system, options, observer);
    observer.end();
    result
}

fn nothing_pushes(system: &System) -> bool {
    system.pairs.is_empty() && system.load.iter().all(|f| *f == 0.0)
}

/// Whether `system` is one that can slide steadily.
///
/// # Errors
/// No sliding velocity, no or a negative load.
pub fn check(system: &System) -> Result<()> {
    check_input(&system.pairs, &system.load, system.n_dofs())
}

fn solve_prestressed(
    system: &System,
    options: &SteadyOptions,
    observer: &dyn Observer,
) -> Result<SteadySliding> {
    const ITERATIONS: usize = 40;
    let k = &system.structure.stiffness;
    let mut steady = SteadySolver::new(system, Cow::Borrowed(k))?.solve(system, options, observer)?;
    if system.prestress.is_none() {
        return Ok(steady);
    }
    let mut iterations = steady.iterations;
    let mut change = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let k = tangent_stiffness(system, &steady.displacement)?;
        let solver = SteadySolver::new(system, k).map_err(buckled)?;
        let next = solver.solve(system, options, observer)?;
        iterations += next.iterations;
        let difference: Vec<f64> =
            next.displacement.iter().zip(&steady.displacement).map(|(a, b)| a - b).collect();
        let before = change;
        change = norm_2(&difference) / norm_2(&next.displacement).max(f64::MIN_POSITIVE);
        steady = next;
        // On fine plates the round-off of the two solutions is above 1e-12: then a change that no longer shrinks is it.
        if change <= 1e-12 || (change <= 1e-9 && change > 0.5 * before) {
            let k = tangent_stiffness(system, &steady.displacement)?;
            steady.residual = residual(system, &k, &steady.displacement, &steady.points).1;
            steady.iterations = iterations;
            return Ok(steady);
        }
    }
    Err(Error::analysis(
        "steady sliding, stiffness of the preload",
        format!("after {ITERATIONS} iterations the displacement still changes by {change:.1e} of itself"),
        "The preload may be near buckling: lower the load or leave the geometric stiffness out",
    ))
}

/// K holds the structure, K + K_σ does not.
fn buckled(error: Error) -> Error {
    let found = match error {
        Error::Analysis { found, .. } => found,
        other => return other,
    };
    Error::analysis(
        "steady sliding, stiffness of the preload",
        format!("the preload takes away the stiffness that held the structure, as in buckling ({found})"),
        "Lower the load, or leave the geometric stiffness out",
    )
}
