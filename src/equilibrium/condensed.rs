//! Equilibrium condensed to the contact: the static compliance seen from the contact points.

use super::linear::{Spring, directions};
use super::point_laws::respond;
use crate::error::{Error, Result};
use crate::linalg::SymmetricFactor;
use crate::linalg::factor::is_singular;
use crate::linalg::sparse::{add_scaled, is_unresisted, sum_of_squares};
use crate::linalg::{SparseMatrix, SparseVector};
use crate::system::{ContactPoint, System};
use faer::Mat;

/// The structure with its contact springs closed, A = K + Σ d g gᵀ, factorised, and what it answers to a unit force
/// on every contact direction.
///
/// K alone may be singular (a body that only the contact holds), A is not, unless nothing holds the body at all.
/// The identity K u + U R = f ⇔ A u = f − U R + Σ g d gᵀu is exact, so the d > 0 only decide the conditioning:
/// they are taken from the law's own stiffness. A depends on neither load, friction nor velocity.
pub(super) struct Condensed {
    factor: Box<dyn SymmetricFactor>,
    /// d \[N/m\] of each point.
    pub(super) closed: Vec<f64>,
    /// X = A⁻¹ G, n × points.
    pub(super) responses: Mat<f64>,
    /// gᵀA⁻¹g, gᵀA⁻¹t₁, gᵀA⁻¹t₂: points × points each \[m/N\].
    pub(super) compliance: [Mat<f64>; 3],
    /// The external load f of the system it was made for, and what it does to every point, e₀ = gᵀA⁻¹f.
    load: Vec<f64>,
    unloaded: Vec<f64>,
}

impl Condensed {
    /// Factorises A for the stiffness `k` (K, or K + K_σ).
    ///
    /// # Errors
    /// A rigid motion that not even the closed contact resists.
    pub(super) fn new(system: &System, k: &SparseMatrix) -> Result<Self> {
        let n = system.n_dofs();
        let points: Vec<&ContactPoint> = system.points().map(|(_, point)| point).collect();
        let (factor, closed) = closed_factor(system, k)?;
        let mut responses = Mat::<f64>::zeros(n, points.len());
        for (p, point) in points.iter().enumerate() {
            point.normal.iter().for_each(|(i, v)| responses[(i, p)] = v);
        }
        factor.solve_in_place(responses.as_mut());
        let seen_by = |c: usize| {
            Mat::from_fn(points.len(), points.len(), |p, q| {
                directions(points[q])[c].iter().map(|(i, v)| v * responses[(i, p)]).sum()
            })
        };
        let compliance = [seen_by(0), seen_by(1), seen_by(2)];
        let load = system.load.clone();
        let unloaded = answers(&responses, &load);
        Ok(Condensed { factor, closed, responses, compliance, load, unloaded })
    }

    /// e₀ = gᵀA⁻¹f of each point for an external load f; kept for the load of the system it was made for.
    pub(super) fn unloaded(&self, load: &[f64]) -> Vec<f64> {
        if load == self.load { self.unloaded.clone() } else { answers(&self.responses, load) }
    }

    /// A⁻¹ x.
    pub(super) fn solve(&self, x: &[f64]) -> Vec<f64> {
        let mut y = Mat::from_fn(x.len(), 1, |i, _| x[i]);
        self.factor.solve_in_place(y.as_mut());
        y.col_as_slice(0).to_vec()
    }
}

/// The factors of A = K + Σ d g gᵀ, in which every contact point is closed, and the d of the points; along t₁ and t₂, too, where they stick.
///
/// # Errors
/// A rigid motion that not even the closed contact resists.
pub(super) fn closed_factor(
    system: &System,
    k: &SparseMatrix,
) -> Result<(Box<dyn SymmetricFactor>, Vec<f64>)> {
    let (a, springs) = closed_stiffness(system, k);
    let closed = springs.iter().take(system.points().count()).map(|(d, _)| *d).collect();
    let factor = system.structure.engine.factorize(&a).map_err(|error| match is_singular(&error) {
        true => nothing_holds(error.to_string().trim_end_matches('.')),
        // Memory that does not suffice has another remedy.
        false => error,
    })?;
    check_held(&a, &*factor)?;
    Ok((factor, closed))
}

/// A, and its springs.
pub(crate) fn closed_stiffness<'a>(system: &'a System, k: &SparseMatrix) -> (SparseMatrix, Vec<Spring<'a>>) {
    let springs = closed_springs(system, k);
    let sum = sum_of_squares(system.n_dofs(), springs.iter().copied());
    (add_scaled(&[(1.0, k), (1.0, &sum)]), springs)
}

/// The springs of the contact points where they are closed, on a structure with stiffness K: one along each normal, in the order of the
/// points, then those along the tangents of points that stick.
pub fn closed_springs<'a>(system: &'a System, k: &SparseMatrix) -> Vec<Spring<'a>> {
    let normals = system.points().map(|(pair, point)| {
        let law = respond(pair, point, FIRST_TOUCH, [0.0; 2]).1.by_penetration[0];
        (spring(&point.normal, law, k), &point.normal)
    });
    let sticking = system.points().filter(|(pair, _)| pair.sticks());
    let tangents = sticking.flat_map(|(pair, point)| {
        let law = respond(pair, point, FIRST_TOUCH, [0.0; 2]).1.by_slid;
        [0, 1].map(|c| (spring(&point.tangents[c], law[1 + c][c], k), &point.tangents[c]))
    });
    normals.chain(tangents).collect()
}

/// Xᵀ f.
fn answers(responses: &Mat<f64>, load: &[f64]) -> Vec<f64> {
    let dot = |p: usize| responses.col_as_slice(p).iter().zip(load).map(|(x, f)| x * f).sum();
    (0..responses.ncols()).map(dot).collect()
}

/// The penetration at first touch \[m\].
const FIRST_TOUCH: f64 = 1e-12;

/// The stiffness that represents a closed point along a direction: that of its `law` at first touch, but no stiffer than the structure
/// it acts on (A would lose digits), and not nothing (a purely cubic law).
fn spring(direction: &SparseVector, law: f64, k: &SparseMatrix) -> f64 {
    let norm: f64 = direction.values().iter().map(|v| v * v).sum();
    if norm == 0.0 {
        return 0.0;
    }
    let diagonal = |i: usize| k.get(i, i).copied().unwrap_or(0.0);
    let structure = direction.iter().map(|(i, v)| v * v * diagonal(i)).sum::<f64>() / (norm * norm);
    match (law > 0.0, structure > 0.0) {
        (true, true) => law.min(structure).max(1e-6 * structure),
        (true, false) => law,
        (false, true) => 1e-3 * structure,
        (false, false) => 1.0,
    }
}

/// Inverse iteration finds the softest motion x of A; when A x is no more than the round-off of forming it, x is a
/// motion that nothing resists. (The softest elastic motion of a fine plate stands four decades above that.)
fn check_held(a: &SparseMatrix, factor: &dyn SymmetricFactor) -> Result<()> {
    let n = a.nrows();
    // A start that no symmetry of a structure is likely to be orthogonal to.
    let mut x = Mat::from_fn(n, 1, |i, _| 1.0 + ((i as f64 + 1.0) * 0.618_033_988_749_895).fract());
    for _ in 0..2 {
        factor.solve_in_place(x.as_mut());
        let size = x.col_as_slice(0).iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if !size.is_finite() || size == 0.0 {
            return Err(nothing_holds("its equations have no solution"));
        }
        x.col_as_slice_mut(0).iter_mut().for_each(|v| *v /= size);
    }
    if is_unresisted(a, x.as_ref()) {
        let dof = (0..n).max_by(|i, j| x[(*i, 0)].abs().total_cmp(&x[(*j, 0)].abs())).unwrap_or(0);
        return Err(nothing_holds(&format!(
            "a rigid motion, largest at degree of freedom {dof}, meets no force"
        )));
    }
    Ok(())
}

fn nothing_holds(found: &str) -> Error {
    Error::analysis(
        "steady sliding",
        format!("nothing holds the structure, not even with every contact closed: {found}"),
        "Support it: clamp the bar or the slider, or give it springs to the ground",
    )
}
