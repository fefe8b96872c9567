//! The members of a sweep: a case with some scalars at other values → its sliding state, or its whole analysis.

use super::clock::Clock;
use super::complex::band_modes;
use super::contacts::with_laws;
use super::prepared::{Prepared, external_load};
use crate::case::{Case, CeaAnalysis, Invalidates};
use crate::equilibrium::{self, Condensed, PointState, solve_points};
use crate::error::Result;
use crate::linalg::c64;
use crate::linalg::multivector::gram;
use crate::stability::{ComplexMode, Family, FamilyCheck, SlidingState};
use crate::sweep::{AtOnce, Checked, MeasuredProblem, Modes, SweepProblem};
use faer::Mat;
use std::borrow::Cow;

/// Whether a change of the scalar at `path` leaves M, K and the contact directions alone, and C affine in it.
pub(super) fn keeps_the_structure(case: &Case, path: &str) -> Result<bool> {
    let chooses_modes =
        path == "damping.modal_below" || path.starts_with("damping.modal_ratios.") && path.ends_with(".0");
    Ok(case.parameter(path)?.invalidates <= Invalidates::Equilibrium && !chooses_modes)
}

/// The case with the scalars at `paths` set to `at`.
pub(super) fn varied(case: &Case, paths: &[String], at: &[f64]) -> Result<Case> {
    case.with_parameters(paths.iter().zip(at.iter().copied()))
}

/// Data common to the sliding states of a sweep.
pub(super) struct States<'a> {
    pub(super) prepared: &'a Prepared<'a>,
    /// The case without its sweeps.
    pub(super) case: &'a Case,
    pub(super) paths: Vec<String>,
    pub(super) condensed: &'a Condensed,
    /// The contact points of the case itself.
    pub(super) nominal: &'a [PointState],
    /// The damping scalars of all sweeps: path, value of the case, value of the other damping.
    pub(super) dampings: &'a [(String, f64, f64)],
}

impl States<'_> {
    /// The state at `at`.
    pub(super) fn at(&self, at: &[f64]) -> Result<SlidingState> {
        let case = varied(self.case, &self.paths, at)?;
        let touches = |path: &String| Ok(case.parameter(path)?.invalidates > Invalidates::Damping);
        let touched = self.paths.iter().map(touches).collect::<Result<Vec<bool>>>()?;
        let points = if touched.contains(&true) {
            let system = &self.prepared.system;
            let load = match self.paths.iter().any(|path| path.starts_with("force.")) {
                true => Cow::Owned(external_load(&case, &self.prepared.regions, &self.prepared.assembled)?),
                false => Cow::Borrowed(&system.load),
            };
            let options = self.prepared.steady_options();
            solve_points(&with_laws(&system.pairs, &case)?, &load, self.condensed, &options)?
        } else {
            self.nominal.to_vec()
        };
        let mut damping_weights = vec![1.0];
        for (path, own, other) in self.dampings {
            let value = self.paths.iter().position(|p| p == path).map_or(*own, |k| at[k]);
            let weight = (value - own) / (other - own);
            damping_weights.push(weight);
            damping_weights[0] -= weight;
        }
        Ok(SlidingState { points, damping_weights })
    }
}

/// The members of a sweep on one reduced model.
pub(super) struct OnFamily<'a> {
    pub(super) states: States<'a>,
    pub(super) family: Family<'a>,
}

impl OnFamily<'_> {
    /// Adds to the reduced model what the state at `at` needs.
    pub(super) fn train(&mut self, at: &[f64]) -> Result<()> {
        self.family.train(&self.states.at(at)?).map(|_| ())
    }
}

/// Vectors of a reduced model up to which a search takes all the solutions that it may: of more, the fewer the more one costs.
const CHEAP: f64 = 100.0;

impl SweepProblem for OnFamily<'_> {
    fn solutions_between(&self, points: usize) -> usize {
        let cost = (self.family.dimension() as f64 / CHEAP).powi(3).max(1.0);
        (((4000 + 20 * points) as f64 / cost) as usize).max(40 + 5 * points)
    }

    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let modes = self.family.modes(&self.states.at(at)?)?;
        Ok(Modes { eigenvalues: modes.eigenvalues, vectors: modes.vectors })
    }

    fn eigenvalues(&self, at: &[f64]) -> Result<Vec<c64>> {
        self.family.eigenvalues(&self.states.at(at)?)
    }
}

impl MeasuredProblem for OnFamily<'_> {
    fn check(&self, at: &[f64]) -> Result<Vec<Checked>> {
        Ok(rows(self.family.check(&self.states.at(at)?)?))
    }

    fn check_nearest(&self, at: &[f64], near: c64) -> Result<Option<Checked>> {
        Ok(rows(self.family.check_nearest(&self.states.at(at)?, near)?).pop())
    }
}

fn rows(check: FamilyCheck) -> Vec<Checked> {
    let errors = check.backward_errors.into_iter().zip(check.eigenvalue_errors);
    let row = |(eigenvalue, (backward_error, eigenvalue_error))| Checked {
        eigenvalue,
        backward_error,
        eigenvalue_error,
    };
    check.eigenvalues.into_iter().zip(errors).map(row).collect()
}

/// Degrees of freedom up to which several analyses run at once: each takes some tens of megabytes at most, and has too little work for
/// several threads.
const SMALL: usize = 5000;

/// The members of a sweep by whole analyses, for scalars that change the structure.
pub struct Whole<'a> {
    case: Case,
    paths: Vec<String>,
    /// M Φ of real modes to which shapes are compared; those of the case itself.
    reference: Option<&'a Mat<f64>>,
}

impl<'a> Whole<'a> {
    /// For the scalars at `paths` of `case`. Shapes are followed in the coordinates Φᵀ M φ when `reference` = M Φ is
    /// given, as long as the degrees of freedom stay the same.
    pub fn new(case: &Case, paths: Vec<String>, reference: Option<&'a Mat<f64>>) -> Self {
        Whole { case: case.without_sweeps(), paths, reference }
    }

    fn analyse(&self, at: &[f64]) -> Result<Vec<ComplexMode>> {
        let case = varied(&self.case, &self.paths, at)?;
        let Some(cea) = &case.cea else { return Ok(Vec::new()) };
        let prepared = Prepared::new(&case)?;
        let steady = equilibrium::solve_steady(&prepared.system, &prepared.steady_options(), &())?;
        // Growth is read off the eigenvalues here, not counted.
        let cea = CeaAnalysis { certify: Some(false), left_vectors: false, ..cea.clone() };
        let (found, ..) = band_modes((&prepared, &steady), &cea, None, false, &mut Clock::default(), &())?;
        Ok(found.modes.modes)
    }
}

impl SweepProblem for Whole<'_> {
    /// Each is a whole analysis.
    fn solutions_between(&self, points: usize) -> usize {
        40 + 5 * points
    }

    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let modes = self.analyse(at)?;
        let eigenvalues: Vec<c64> = modes.iter().map(|m| m.eigenvalue).collect();
        let n = modes.first().map_or(0, |m| m.right.len());
        let vectors = match self.reference.filter(|r| r.nrows() == n) {
            None => Mat::zeros(0, modes.len()),
            Some(reference) => {
                let part = |f: fn(&c64) -> f64| {
                    let shapes = Mat::from_fn(n, modes.len(), |i, j| f(&modes[j].right[i]));
                    gram(reference.as_ref(), shapes.as_ref())
                };
                let (re, im) = (part(|z| z.re), part(|z| z.im));
                Mat::from_fn(re.nrows(), re.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]))
            }
        };
        Ok(Modes { eigenvalues, vectors })
    }

    fn at_once(&self) -> AtOnce {
        match self.reference {
            Some(reference) if reference.nrows() <= SMALL => AtOnce::Alone,
            _ => AtOnce::One,
        }
    }
}

impl MeasuredProblem for Whole<'_> {
    fn check(&self, at: &[f64]) -> Result<Vec<Checked>> {
        let checked = |m: &ComplexMode| Checked {
            eigenvalue: m.eigenvalue,
            backward_error: m.backward_error,
            eigenvalue_error: m.eigenvalue_error,
        };
        Ok(self.analyse(at)?.iter().map(checked).collect())
    }
}
