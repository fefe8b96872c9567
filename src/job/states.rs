//! The members of a sweep: a case with some scalars at other values → its sliding state, or its whole analysis.

use super::clock::Clock;
use super::complex::band_modes;
use super::contacts::with_laws;
use super::forces::external_load;
use super::known::Reference;
use super::modes::add_modal_damping;
use super::operating_point::OperatingPoint;
use super::prepared::Prepared;
use super::studies::{SHARED, studies};
use crate::case::{Case, CeaAnalysis, Invalidates, VariedCase};
use crate::equilibrium::{self, PointState, SteadySolver, tangent_stiffness};
use crate::error::{Error, Result};
use crate::linalg::c64;
use crate::linalg::multivector::gram;
use crate::modal::RealModes;
use crate::stability::{ClosedContact, ComplexMode, Family, FamilyCheck, SlidingState, closed_modes};
use crate::sweep::{AtOnce, Checked, MeasuredProblem, Modes, SweepProblem};
use crate::system::Damping;
use faer::Mat;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// The path of ζ.
pub(super) const RATIO: &str = "damping.modal_ratio";

/// Whether a change of the scalar at `path` leaves M, K and the contact directions alone, and C affine in it.
pub(super) fn keeps_the_structure(case: &Case, path: &str) -> Result<bool> {
    let chooses_modes =
        path == "damping.modal_below" || path.starts_with("damping.modal_ratios.") && path.ends_with(".0");
    Ok(case.parameter(path)?.invalidates <= Invalidates::Equilibrium && !chooses_modes)
}

/// Every damping scalar that a study or the verdicts vary: path, its value, another value that the case accepts.
fn dampings(whole: &Case, case: &Case) -> Result<Vec<(String, f64, f64)>> {
    let mut found: Vec<(String, f64, f64)> = Vec::new();
    let all = SHARED.into_iter().flat_map(|analysis| studies(whole, analysis));
    for (path, ends) in all.flat_map(|study| study.paths.into_iter().zip(study.bounds)) {
        let parameter = case.parameter(&path)?;
        let known = found.iter().any(|(other, ..)| *other == path);
        if parameter.invalidates == Invalidates::Damping && keeps_the_structure(case, &path)? && !known {
            let other = if ends[0] == parameter.value { ends[1] } else { ends[0] };
            found.push((path, parameter.value, other));
        }
    }
    let ratio = case.damping.modal_ratio;
    if ratio > 0.0 && !found.iter().any(|(path, ..)| path == RATIO) {
        found.push((RATIO.into(), ratio, 0.5 * ratio));
    }
    Ok(found)
}

/// The damping of the structure with one scalar at its other value.
fn other_damping(
    nominal: &OperatingPoint,
    case: &Case,
    (path, _, value): &(String, f64, f64),
) -> Result<Damping> {
    let case = case.with_parameter(path, *value)?;
    let mut structure = nominal.prepared.rebuilt(&case)?.system.structure;
    add_modal_damping(&mut structure, &nominal.real, &case)?;
    Ok(structure.damping)
}

/// Data that all studies of a case start from.
pub(super) struct Start<'a> {
    pub(super) nominal: &'a OperatingPoint<'a>,
    /// The case without its studies.
    pub(super) case: Case,
    solver: SteadySolver<'a>,
    /// The structure with its contact closed and its real modes, where that has more directions than there are real modes.
    closed: Option<(ClosedContact, RealModes)>,
    dampings: Vec<(String, f64, f64)>,
    /// The damping of the structure with each of them at its other value.
    pub(super) others: Vec<Damping>,
    pub(super) reference: Reference,
}

impl<'a> Start<'a> {
    pub(super) fn new(nominal: &'a OperatingPoint<'a>) -> Result<Self> {
        let case = nominal.prepared.case.without_studies();
        let dampings = dampings(nominal.prepared.case, &case)?;
        let others = dampings.iter().map(|d| other_damping(nominal, &case, d)).collect::<Result<_>>()?;
        let OperatingPoint { system, steady, real, closed, .. } = nominal;
        let k = tangent_stiffness(system, &steady.displacement)?;
        let solver = SteadySolver::new(system, k)?.near(steady);
        let reference = Reference::new(system, real);
        let top = TAU * case.cea.as_ref().expect("a case with complex modes").band[1];
        let closed = match closed {
            Some(_) => None,
            None => closed_modes((system, steady), real, top, &())?.map(|(closed, own, _)| (closed, own)),
        };
        Ok(Start { nominal, case, solver, closed, dampings, others, reference })
    }

    /// The structure with its contact closed and its real modes, where the family is that of this.
    pub(super) fn closed(&self) -> Option<(&ClosedContact, &RealModes)> {
        let known = self.nominal.closed.as_ref().map(|closed| (closed, &self.nominal.real));
        known.or(self.closed.as_ref().map(|(closed, real)| (closed, real)))
    }
}

/// The sliding states of a sweep.
pub(super) struct States<'a> {
    start: &'a Start<'a>,
    case: VariedCase,
    /// Whether the contact points depend on a scalar of the sweep, and the external force.
    touched: bool,
    forced: bool,
}

impl<'a> States<'a> {
    pub(super) fn new(start: &'a Start<'a>, paths: &[String]) -> Result<Self> {
        let touches = |path: &String| Ok(start.case.parameter(path)?.invalidates > Invalidates::Damping);
        let touched = paths.iter().map(touches).collect::<Result<Vec<bool>>>()?.contains(&true);
        let forced = paths.iter().any(|path| path.starts_with("force."));
        let case = VariedCase::new(start.case.clone(), paths.to_vec());
        Ok(States { start, case, touched, forced })
    }

    /// The state at `at`.
    pub(super) fn at(&self, at: &[f64]) -> Result<SlidingState> {
        let points = self.case.at(at, |case| self.points(case))?;
        let mut damping_weights = vec![1.0];
        for (path, own, other) in &self.start.dampings {
            let value = self.case.paths().iter().position(|p| p == path).map_or(*own, |k| at[k]);
            let weight = (value - own) / (other - own);
            damping_weights.push(weight);
            damping_weights[0] -= weight;
        }
        Ok(SlidingState { points, damping_weights })
    }

    /// The contact points of a case of the sweep.
    fn points(&self, case: &Case) -> Result<Vec<PointState>> {
        let OperatingPoint { prepared, steady, .. } = self.start.nominal;
        if !self.touched {
            return Ok(steady.points.clone());
        }
        let system = &prepared.system;
        let load = match self.forced {
            true => Cow::Owned(external_load(case, &prepared.regions, &prepared.model, &prepared.assembled)?),
            false => Cow::Borrowed(&system.load),
        };
        let pairs = with_laws(&system.pairs, case)?;
        if let Some((pair, _)) = pairs.iter().zip(&system.pairs).find(|(at, own)| at.sticks() != own.sticks())
        {
            let found = "the velocity is zero here: at rest it sticks, at any other velocity it slides";
            return Err(Error::analysis(
                format!("`contact.{}`", pair.name),
                found,
                "Vary the velocity on one side of zero",
            ));
        }
        self.start.solver.points(&pairs, &load, &prepared.steady_options())
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
    prepared: &'a Prepared<'a>,
    case: VariedCase,
    /// M Φ of real modes to which shapes are compared; those of the case itself.
    reference: Option<&'a Mat<f64>>,
}

impl<'a> Whole<'a> {
    /// For the scalars at `paths` of the case. Shapes are followed in the coordinates Φᵀ M φ when `reference` = M Φ is
    /// given, as long as the degrees of freedom stay the same.
    pub fn new(prepared: &'a Prepared<'a>, paths: Vec<String>, reference: Option<&'a Mat<f64>>) -> Self {
        Whole { prepared, case: VariedCase::new(prepared.case.without_studies(), paths), reference }
    }

    fn analyse(&self, at: &[f64]) -> Result<Vec<ComplexMode>> {
        self.case.at(at, |case| {
            let Some(cea) = &case.cea else { return Ok(Vec::new()) };
            let prepared = self.prepared.rebuilt(case)?;
            let steady = equilibrium::solve_steady(&prepared.system, &prepared.steady_options(), &())?;
            // Growth is read off the eigenvalues here, not counted.
            let cea = CeaAnalysis { certify: Some(false), left_vectors: false, ..cea.clone() };
            let (found, ..) =
                band_modes((&prepared, &steady), &cea, None, false, &mut Clock::default(), &())?;
            Ok(found.modes.modes)
        })
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
