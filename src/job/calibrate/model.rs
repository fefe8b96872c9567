//! The frequencies of a case as functions of the numbers that are to be found.

use super::super::modes::{damped_without_band, modal_ratios, part_assembled};
use super::super::prepared::Prepared;
use super::super::scalars::{CaseScalar, ScalarKind, same_structure, scalar};
use super::super::sensors::Sensors;
use super::coordinate::Coordinate;
use super::facts::{MeasuredModeSet, Measurements, ModeKind};
use super::follow::{Path, Picks};
use super::neighbours::{Change, Neighbour, derivatives};
use super::real::Solved;
use super::responses::{self, MeasuredFrfData, ResponsePlaces};
use super::unstable::Sliding;
use crate::calibration::{CalibrationModel, Computed, LIKE, Span};
use crate::case::{Case, CeaAnalysis};
use crate::error::{Error, Result};
use crate::modal::RealModes;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Real modes are computed up to this many times the highest measured frequency, so that none of those that may be measured
/// leaves the range.
const RANGE: f64 = 1.4;

/// Modes of one kind at the start, which all others are followed from.
enum LevelSource {
    Real { name: String, below_hz: f64, solved: Box<Solved>, sensors: Option<Sensors> },
    Unstable(Box<Sliding>),
}

/// One kind of modes.
pub struct Set {
    start: LevelSource,
    /// The modes of each level at the start.
    pub levels: Picks,
    /// Name of each level.
    pub names: Vec<String>,
    /// Whether a measured shape is at all like each level.
    pub like: Vec<bool>,
}

/// A case with numbers to be found.
pub struct CaseModel<'a> {
    prepared: &'a Prepared<'a>,
    /// With nothing to do but what is compared.
    case: Case,
    coordinates: &'a [Coordinate<'a>],
    start: Vec<f64>,
    /// The kinds of modes, in the order of the facts.
    pub sets: Vec<Set>,
    responses: &'a [MeasuredFrfData],
}

impl<'a> CaseModel<'a> {
    /// The model of `case`, which is prepared, for what was measured.
    ///
    /// # Errors
    /// Modes that cannot be computed.
    pub fn new(
        prepared: &'a Prepared<'a>,
        coordinates: &'a [Coordinate<'a>],
        measured: &'a Measurements,
    ) -> Result<Self> {
        let case = lean(prepared.case, measured);
        let value = |c: &Coordinate| Ok(c.x(case.parameter(&c.parameter.path[0])?.value));
        let start: Vec<f64> = coordinates.iter().map(value).collect::<Result<_>>()?;
        let responses = &measured.responses;
        let mut model = CaseModel { prepared, case, coordinates, start, sets: Vec::new(), responses };
        let here = prepared.rebuilt(&model.case)?;
        let sets = measured.modes.iter().map(|facts| model.set(&here, facts)).collect::<Result<_>>()?;
        drop(here);
        model.sets = sets;
        Ok(model)
    }

    fn set(&self, prepared: &Prepared, facts: &MeasuredModeSet) -> Result<Set> {
        match &facts.of {
            ModeKind::RealModes(name) => {
                let highest = facts.modes.iter().fold(0.0f64, |m, mode| m.max(mode.frequency_hz));
                let path = scale_path(name);
                let scaled = self.coordinates.iter().filter(|c| c.parameter.path.contains(&path));
                let least = scaled
                    .map(|c| c.parameter.between[0])
                    .fold(prepared.case.modes[name].frequency_scale, f64::min);
                let below_hz = RANGE * highest / least;
                let sensors = facts.sensors.clone();
                let solved =
                    Box::new(Solved::new(prepared, (name.as_str(), below_hz), sensors.clone(), None)?);
                let levels = solved.levels();
                let names = solved.labels(&levels);
                let like = levels.iter().map(|level| like(&solved, level, facts)).collect();
                let start = LevelSource::Real { name: name.clone(), below_hz, solved, sensors };
                Ok(Set { start, levels, names, like })
            }
            ModeKind::Unstable => {
                let sliding = Box::new(Sliding::new(prepared)?.0);
                let levels = sliding.levels();
                let names = sliding.names(&levels);
                let like = vec![false; levels.len()];
                Ok(Set { start: LevelSource::Unstable(sliding), levels, names, like })
            }
        }
    }

    /// The unknowns of the case itself.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// The set of every level, in their order.
    pub fn level_sets(&self) -> Vec<usize> {
        let of = |(k, set): (usize, &Set)| vec![k; set.levels.len()];
        self.sets.iter().enumerate().flat_map(of).collect()
    }

    /// How many modes every level has.
    pub fn level_modes(&self) -> Vec<usize> {
        self.sets.iter().flat_map(|set| set.levels.iter().map(Vec::len)).collect()
    }

    /// Name of each level.
    pub fn level_names(&self) -> Vec<String> {
        self.sets.iter().flat_map(|set| set.names.iter().cloned()).collect()
    }

    /// The values of the numbers at `x`.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        self.coordinates.iter().zip(x).map(|(c, x)| c.value(*x)).collect()
    }

    fn case_at(&self, x: &[f64]) -> Result<Case> {
        let all = self.coordinates.iter().zip(self.values(x));
        self.case.with_parameters(
            all.flat_map(|(c, value)| c.parameter.path.iter().map(move |path| (path, value))),
        )
    }

    /// Growth rate \[1/s\] of every level at `x`; none of real modes.
    pub fn growth(&self, x: &[f64]) -> Result<Vec<Option<f64>>> {
        let case = self.case_at(x)?;
        let prepared = self.prepared.rebuilt(&case)?;
        let mut all = Vec::new();
        for set in &self.sets {
            match &set.start {
                LevelSource::Real { .. } => all.extend(set.levels.iter().map(|_| None)),
                LevelSource::Unstable(start) => {
                    let (here, _) = Sliding::new(&prepared)?;
                    let picks = self.follow_sliding(start, &set.levels, (x, &here))?;
                    all.extend(here.growth(&picks));
                }
            }
        }
        Ok(all)
    }

    fn follow_sliding(&self, start: &Sliding, levels: &Picks, to: (&[f64], &Sliding)) -> Result<Picks> {
        let solve = |x: &[f64]| Ok(Sliding::new(&self.prepared.rebuilt(&self.case_at(x)?)?)?.0);
        let follow = |a: &Sliding, picks: &Picks, b: &Sliding| a.follow(picks, b);
        Path { solve: &solve, follow: &follow }.along((&self.start, start, levels), to)
    }

    /// Structures to solve for a case: every set of real modes, then every frequency response.
    fn views<'c>(
        &'c self,
        prepared: &Prepared<'c>,
        responses: &[MeasuredFrfData],
    ) -> Result<Vec<SolvedStructure<'c>>> {
        let real = self.sets.iter().filter_map(|set| match &set.start {
            LevelSource::Real { name, sensors, .. } => Some((name, sensors)),
            LevelSource::Unstable(_) => None,
        });
        let part = |(name, sensors): (&'c String, &Option<Sensors>)| {
            let on = |sensors: &Sensors| sensors.on(prepared, &prepared.case.modes[name]);
            Ok(SolvedStructure::Part(name, sensors.as_ref().map(on)))
        };
        let whole = |measured: &MeasuredFrfData| {
            Ok(SolvedStructure::Whole(ResponsePlaces::new(prepared, &measured.frf)?))
        };
        real.map(part).chain(responses.iter().map(whole)).collect()
    }

    /// ∂ of every view by every unknown; none by an unknown that no structure depends on.
    fn changes(
        &self,
        (case, prepared): (&Case, &Prepared),
        views: &[SolvedStructure],
        values: &[f64],
    ) -> Result<Vec<Option<Vec<Change>>>> {
        let of = |(c, value): (&Coordinate, &f64)| -> Result<Option<Vec<Change>>> {
            let scalars = scalars(case, c)?;
            let Some(first) =
                scalars.iter().find(|s| s.kind == ScalarKind::Structure).filter(|_| !views.is_empty())
            else {
                return Ok(None);
            };
            let build = |value: f64| {
                let case = with(case, c, value)?;
                let other = prepared.rebuilt(&case)?;
                same_structure(prepared, &other)?;
                views.iter().map(|view| view.of(&other)).collect()
            };
            let changes = derivatives(*value, first.step(), &build).map_err(|error| of_number(c, error))?;
            let rate = c.rate(*value);
            Ok(Some(changes.into_iter().map(|change| change.scaled(rate)).collect()))
        };
        self.coordinates.par_iter().zip(values).map(of).collect()
    }

    /// Every level, and the lines of `responses`, at `x`.
    fn at(&self, x: &[f64], responses: &[MeasuredFrfData]) -> Result<Computed> {
        let case = self.case_at(x)?;
        let values = self.values(x);
        let prepared = self.prepared.rebuilt(&case)?;
        let views = self.views(&prepared, responses)?;
        let mut changes = self.changes((&case, &prepared), &views, &values)?;
        let mut views = views.into_iter();
        // The changes of one view, taken from the front.
        let mut of_view = || -> Vec<Option<Change>> {
            changes.iter_mut().map(|all| all.as_mut().map(|all| all.remove(0))).collect()
        };
        let mut levels = Vec::new();
        for set in &self.sets {
            match &set.start {
                LevelSource::Real { name, below_hz, solved, .. } => {
                    let wanted = (name.as_str(), *below_hz);
                    let sensors = match views.next() {
                        Some(SolvedStructure::Part(_, sensors)) => sensors,
                        _ => None,
                    };
                    let here = Solved::new(&prepared, wanted, sensors, Some(solved))?;
                    let solve = |x: &[f64]| {
                        Solved::new(&self.prepared.rebuilt(&self.case_at(x)?)?, wanted, None, Some(solved))
                    };
                    let follow = |a: &Solved, picks: &Picks, b: &Solved| a.follow(picks, b);
                    let path = Path { solve: &solve, follow: &follow };
                    let picks = path.along((&self.start, solved, &set.levels), (x, &here))?;
                    let changes = of_view();
                    // What the scale of the analysis adds: ∂ ln f/∂x = (ds/dx)/s.
                    let by_scale: Vec<f64> = self
                        .coordinates
                        .iter()
                        .zip(&values)
                        .map(|(c, value)| match c.parameter.path.contains(&scale_path(name)) {
                            true => c.rate(*value) / here.scale,
                            false => 0.0,
                        })
                        .collect();
                    let mut spans = spans(&here, set, &picks, &changes)?.into_iter();
                    levels.extend(picks.iter().map(|pick| {
                        let span = spans.next().flatten();
                        let mut level = (!pick.is_empty()).then(|| here.level(pick, &changes))?;
                        level.span = span;
                        level.slope.iter_mut().zip(&by_scale).for_each(|(slope, more)| *slope += more);
                        Some(level)
                    }));
                }
                LevelSource::Unstable(start) => {
                    let (here, point) = Sliding::new(&prepared)?;
                    let picks = self.follow_sliding(start, &set.levels, (x, &here))?;
                    let unknowns: Vec<(Vec<CaseScalar>, f64)> = self
                        .coordinates
                        .iter()
                        .zip(&values)
                        .map(|(c, value)| Ok((scalars(&case, c)?, c.rate(*value))))
                        .collect::<Result<_>>()?;
                    levels.extend(here.slopes(&point, &picks, &unknowns)?);
                }
            }
        }
        let ratios = |real: &RealModes| -> Result<Vec<Option<Vec<f64>>>> {
            let each = self.coordinates.iter().zip(&values);
            each.map(|(c, value)| ratio_rates(&case, c, *value, real)).collect()
        };
        let mut lines = Vec::new();
        for (measured, view) in responses.iter().zip(views) {
            if let SolvedStructure::Whole(places) = view {
                lines.extend(responses::lines(&prepared, (measured, &places), &of_view(), &ratios)?);
            }
        }
        Ok(Computed { levels, lines })
    }
}

impl CalibrationModel for CaseModel<'_> {
    fn compute(&self, x: &[f64]) -> Result<Computed> {
        self.at(x, self.responses)
    }

    fn levels(&self, x: &[f64]) -> Result<Computed> {
        self.at(x, &[])
    }
}

/// Structure to solve for a case.
enum SolvedStructure<'c> {
    /// The structure of `[modes.NAME]`, and where its shapes were measured.
    Part(&'c String, Option<Sensors>),
    /// The whole, and the places of its frequency responses.
    Whole(ResponsePlaces<'c>),
}

impl SolvedStructure<'_> {
    /// The same of a neighbouring case.
    fn of(&self, other: &Prepared) -> Result<Neighbour> {
        match self {
            SolvedStructure::Part(name, sensors) => {
                let (_, assembled) = part_assembled(other, name)?;
                let forms = |s: &Sensors| s.forms(&other.model.nodes, &assembled.dofs);
                Ok(Neighbour { seen: sensors.as_ref().map(forms).unwrap_or_default(), assembled })
            }
            SolvedStructure::Whole(places) => {
                Ok(Neighbour { seen: places.forms(other), assembled: other.assembled.clone() })
            }
        }
    }
}

/// ∂ζ/∂x of the modal damping of every real mode, in which it is linear; none by what it does not depend on.
fn ratio_rates(case: &Case, c: &Coordinate, value: f64, real: &RealModes) -> Result<Option<Vec<f64>>> {
    let all = scalars(case, c)?;
    let Some(first) = all.iter().find(|s| s.kind == ScalarKind::Ratio) else { return Ok(None) };
    let ratios = |case: &Case| modal_ratios(case, real, damped_without_band(case));
    let at = |step: f64| Ok((step, ratios(&with(case, c, value + step)?)?));
    let (step, there) = at(first.step()).or_else(|_: Error| at(-first.step()))?;
    let rate = c.rate(value) / step;
    let here = ratios(case)?;
    Ok(Some(there.iter().zip(&here).map(|(a, b)| rate * (a - b)).collect()))
}

/// Whether a measured shape is at all like a level.
fn like(solved: &Solved, level: &[usize], facts: &MeasuredModeSet) -> bool {
    let Some(seen) = solved.seen() else { return false };
    let span = Span { motions: seen.motions(level), slopes: Vec::new() };
    facts.modes.iter().filter_map(|mode| mode.shape.as_ref()).any(|shape| span.mac(shape) >= LIKE)
}

/// Motion at the sensors of those levels that resemble a measured shape, with its derivatives.
/// Fails where the slopes of shapes do not converge.
fn spans(here: &Solved, set: &Set, picks: &Picks, changes: &[Option<Change>]) -> Result<Vec<Option<Span>>> {
    let Some(seen) = here.seen() else { return Ok(vec![None; picks.len()]) };
    let wanted: Vec<bool> =
        picks.iter().zip(&set.like).map(|(pick, like)| *like && !pick.is_empty()).collect();
    let chosen: Vec<&Vec<usize>> =
        picks.iter().zip(&wanted).filter(|(_, w)| **w).map(|(pick, _)| pick).collect();
    let mut found = seen.spans(&chosen, changes)?.into_iter();
    Ok(wanted.iter().map(|wanted| if *wanted { found.next() } else { None }).collect())
}

/// The case with one number at another value.
fn with(case: &Case, c: &Coordinate, value: f64) -> Result<Case> {
    case.with_parameters(c.parameter.path.iter().map(|path| (path, value)))
}

/// The scalars that a number sets, those of them that modes depend on.
pub fn scalars(case: &Case, c: &Coordinate) -> Result<Vec<CaseScalar>> {
    let all = c.parameter.path.iter().map(|path| scalar(case, path)).collect::<Result<Vec<_>>>()?;
    Ok(all.into_iter().flatten().collect())
}

fn scale_path(name: &str) -> String {
    format!("modes.{name}.frequency_scale")
}

fn of_number(c: &Coordinate, error: Error) -> Error {
    match error {
        Error::Analysis { what, found, help } => {
            Error::Analysis { what: format!("{what} by `{}`", c.parameter.path.join("`, `")), found, help }
        }
        other => other,
    }
}

/// The case without what is not compared.
fn lean(case: &Case, measured: &Measurements) -> Case {
    let compared = |name: &String| measured.responses.iter().any(|m| m.frf == *name);
    let frf = case.frf.iter().filter(|(name, _)| compared(name));
    let cea = case.cea.clone().map(|cea| CeaAnalysis { certify: Some(false), confirm: false, ..cea });
    Case {
        transient: None,
        frf: frf.map(|(name, frf)| (name.clone(), frf.clone())).collect(),
        measured: BTreeMap::new(),
        cea,
        ..case.without_studies()
    }
}
