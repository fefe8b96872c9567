//! Steady sliding: K u₀ + Σ \[g N − t₁ F₁ − t₂ F₂\] = f with ΣN = load of each pair.

use super::condensed::Condensed;
use super::linear::{directions, tangent_stiffness};
use super::newton::{ContactProblem, ContactSolution, norm, respond};
use super::{PointState, SteadyOptions, SteadySliding};
use crate::error::{Error, Fault, Faults, Result};
use crate::linalg::SparseMatrix;
use crate::linalg::sparse::multiply_vector;
use crate::numbers::significant;
use crate::progress::Observer;
use crate::system::{Closing, ContactPair, ContactPoint, System};

/// The steady sliding state of `system` with the default options: see [`solve_steady`].
///
/// # Errors
/// As [`solve_steady`].
pub fn steady_sliding(system: &System) -> Result<SteadySliding> {
    solve_steady(system, &SteadyOptions::default(), &())
}

/// The steady sliding state under the system's load, its closing loads and sliding velocities.
///
/// Newton's method with the unsymmetric tangent on the problem condensed to the contact ([`Condensed`]): unknown are
/// the normal displacement gᵀu of each point and the approach of each pair closed by a load. When it fails, load and
/// friction grow in steps. The state is then refined against the residual of the *full* system. With a prestress the
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
/// No sliding velocity, no or a negative load, an unsymmetric stiffness beside contacts or loads.
pub fn check(system: &System) -> Result<()> {
    check_input(&system.pairs, &system.load, system.n_dofs())?;
    if !nothing_pushes(system)
        && let Some(rest) = &system.coupling
        && (rest.stiffness.norm_max() > 0.0
            || rest.skew.as_ref().is_some_and(|skew| skew.stiffness.val().iter().any(|v| *v != 0.0)))
    {
        return Err(Error::input(
            Fault::new(
                "steady sliding",
                "a stiffness that is not symmetric, with a contact or a load",
                "one or the other",
            )
            .with_help(
                "Friction of contacts belongs to the contacts of the case: export the stiffness without it",
            ),
        ));
    }
    Ok(())
}

/// One steady state for a stiffness that does not change, with a compliance that is already there: for sweeps over
/// load, friction and velocity.
pub fn solve_steady_with(
    system: &System,
    k: &SparseMatrix,
    condensed: &Condensed,
    options: &SteadyOptions,
) -> Result<SteadySliding> {
    let contact = ContactProblem::new(&system.pairs, &system.load, condensed);
    let mut refused = None;
    let found = contact.solve_accepted(options, |mut stage| {
        let (displacement, error) = refine(system, k, &contact, &mut stage);
        let points = states(&system.pairs, &stage.penetration);
        if let Err(fault) = check_contact(&system.pairs, &stage.approach, &points, options) {
            refused = Some(fault);
            return None;
        }
        // NaN is none.
        (error <= ACCEPTED).then(|| SteadySliding {
            residual: residual(system, k, &displacement, &points).1,
            displacement,
            approach: stage.approach,
            points,
            iterations: stage.iterations,
        })
    });
    found.map_err(|error| refused.unwrap_or(error))
}

/// The contact points alone at steady sliding, all that a linearisation needs where the stiffness is constant: no
/// displacement of the whole is formed, so that a point of a sweep costs Newton's method on the contact only.
///
/// `pairs` are those `condensed` was made for, with other laws, loads or velocities; `load` is the external load. The
/// penetrations carry the round-off of the condensed problem (about 1e-10 of themselves on fine meshes).
///
/// # Errors
/// As [`solve_steady`].
pub fn solve_points(
    pairs: &[ContactPair],
    load: &[f64],
    condensed: &Condensed,
    options: &SteadyOptions,
) -> Result<Vec<PointState>> {
    check_input(pairs, load, condensed.responses.nrows())?;
    let stage = ContactProblem::new(pairs, load, condensed).solve(options)?;
    let points = states(pairs, &stage.penetration);
    check_contact(pairs, &stage.approach, &points, options)?;
    Ok(points)
}

fn solve_prestressed(
    system: &System,
    options: &SteadyOptions,
    observer: &dyn Observer,
) -> Result<SteadySliding> {
    const ITERATIONS: usize = 40;
    let k = &system.structure.stiffness;
    let mut steady = solve_steady_with(system, k, &Condensed::new(system, k)?, options)?;
    observer.advance(1);
    if system.prestress.is_none() {
        return Ok(steady);
    }
    let mut iterations = steady.iterations;
    let mut change = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let k = tangent_stiffness(system, &steady.displacement)?;
        let condensed = Condensed::new(system, &k).map_err(buckled)?;
        let next = solve_steady_with(system, &k, &condensed, options)?;
        observer.advance(1);
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

/// The largest error, relative to the forces and lengths, with which a steady state is an answer.
const ACCEPTED: f64 = 1e-6;

/// Newton steps on the full system, by the same condensed tangent, until its residual is at round-off. Gives the
/// displacement and the error that is left.
fn refine(
    system: &System,
    k: &SparseMatrix,
    contact: &ContactProblem<'_>,
    stage: &mut ContactSolution,
) -> (Vec<f64>, f64) {
    let measure = |u: &[f64], approach: &[f64], penetration: &[f64]| {
        let (r, size) = residual(system, k, u, &states(&system.pairs, penetration));
        (r, norm(&[size, contact.mismatch(u, approach, penetration)]))
    };
    let mut u = contact.displacement(stage);
    let (mut r, mut size) = measure(&u, &stage.approach, &stage.penetration);
    for _ in 0..5 {
        if size <= 1e-15 {
            break;
        }
        let correction = contact.full_correction(&u, &stage.approach, &stage.penetration, &r);
        let Some(correction) = correction else { break };
        let (mut next, mut approach, mut penetration) =
            (u.clone(), stage.approach.clone(), stage.penetration.clone());
        correction.add_to(&mut next, &mut approach, &mut penetration);
        let (next_r, next_size) = measure(&next, &approach, &penetration);
        if next_size >= size || next_size.is_nan() {
            break;
        }
        (u, stage.approach, stage.penetration, r, size) = (next, approach, penetration, next_r, next_size);
    }
    (u, size)
}

/// f − K u − r_c, and its size relative to ‖f‖ + ‖r_c‖.
pub(super) fn residual(
    system: &System,
    k: &SparseMatrix,
    u: &[f64],
    states: &[PointState],
) -> (Vec<f64>, f64) {
    let mut contact = vec![0.0; u.len()];
    for ((_, point), state) in system.points().zip(states) {
        let [g, t1, t2] = directions(point);
        g.add_to(state.forces.normal, &mut contact);
        t1.add_to(-state.forces.friction[0], &mut contact);
        t2.add_to(-state.forces.friction[1], &mut contact);
    }
    let elastic = multiply_vector(k, u);
    let r: Vec<f64> = (0..u.len()).map(|i| system.load[i] - elastic[i] - contact[i]).collect();
    let scale = norm_2(&system.load) + norm_2(&contact);
    let size = if scale > 0.0 { norm_2(&r) / scale } else { norm_2(&r) };
    (r, size)
}

/// The law of every point at its penetration.
pub(super) fn states(pairs: &[ContactPair], penetrations: &[f64]) -> Vec<PointState> {
    let points = pairs.iter().flat_map(|pair| pair.points.iter().map(move |p| (pair, p)));
    let at = |((pair, point), penetration): ((&ContactPair, &ContactPoint), &f64)| {
        let (forces, tangent) = respond(pair, point, *penetration);
        PointState { penetration: *penetration, forces, tangent }
    };
    points.zip(penetrations).map(at).collect()
}

fn check_input(pairs: &[ContactPair], load: &[f64], n: usize) -> Result<()> {
    let mut faults = Faults::new();
    for pair in pairs {
        let v = pair.sliding_velocity;
        if !(v.is_finite() && v != 0.0) {
            let place = format!("contact `{}`, sliding velocity", pair.name);
            faults.push(
                Fault::new(place, format!("{v} m/s"), "a velocity other than zero")
                    .with_help("Steady sliding needs one: friction at rest can have any value up to μN"),
            );
        }
        let (place, bad) = match pair.closing {
            Closing::Load(load) => ("closing load", (!(load.is_finite() && load > 0.0)).then_some(load)),
            Closing::Approach(a) => ("approach", (!a.is_finite()).then_some(a)),
        };
        if let Some(value) = bad {
            let place = format!("contact `{}`, {place}", pair.name);
            faults.push(Fault::new(place, value.to_string(), "a finite value, positive for a load"));
        }
        if pair.points.is_empty() {
            faults.push(Fault::new(
                format!("contact `{}`", pair.name),
                "no point",
                "at least one contact point",
            ));
        }
    }
    if load.len() != n || load.iter().any(|f| !f.is_finite()) {
        let expected = format!("{n} finite forces");
        faults.push(Fault::new(
            "external load",
            format!("{} values, some not finite or too few", load.len()),
            expected,
        ));
    }
    faults.into_result(())
}

fn check_contact(
    pairs: &[ContactPair],
    approach: &[f64],
    points: &[PointState],
    options: &SteadyOptions,
) -> Result<()> {
    let mut first = 0;
    for (pair, approach) in pairs.iter().zip(approach) {
        let states = &points[first..first + pair.points.len()];
        first += pair.points.len();
        let deepest = states.iter().map(|s| s.penetration).fold(f64::NEG_INFINITY, f64::max);
        if states.iter().all(|s| s.forces.normal == 0.0) && !pair.is_bilateral() {
            return Err(Error::analysis(
                format!("steady sliding, contact `{}`", pair.name),
                format!(
                    "no point touches: the nearest stays {} m away at an approach of {} m",
                    significant(0.0 - deepest, 4),
                    significant(*approach, 4)
                ),
                "Close the contact with a load, move the bodies nearer or press harder",
            ));
        }
        if deepest > options.penetration_limit {
            let limit = options.penetration_limit;
            return Err(Error::analysis(
                format!("steady sliding, contact `{}`", pair.name),
                format!(
                    "the load crushes the bodies through: penetration {} m, limit {} m",
                    significant(deepest, 4),
                    significant(limit, 4)
                ),
                "Lower the load or raise the contact stiffness",
            ));
        }
    }
    Ok(())
}

/// ‖x‖₂.
fn norm_2(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
