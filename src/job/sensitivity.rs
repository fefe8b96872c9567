//! Sensitivities of the unstable modes of a case to its scalars and to small masses, springs and dampers at its nodes.

use super::modes::{damped_below, modal_ratios};
use super::operating_point::OperatingPoint;
use super::scalars::{CaseScalar, ScalarKind, chosen, same_structure};
use super::verify;
use crate::case::{Factor, SensitivityAnalysis};
use crate::error::{Error, Result};
use crate::linalg::{SparseVector, c64};
use crate::progress::Observer;
use crate::results::{AdviceField, ModeSensitivity, Mounted, ParameterRate, SensitivityResult};
use crate::stability::{ComplexMode, ComplexModes, Domain, PointRates, Rate, Sensitivity, near_mode};
use crate::system::System;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The most modes that are analysed, the strongest first.
const MOST_MODES: usize = 12;
/// Larger systems are built one at a time, so that memory holds one of them.
const ONE_AT_A_TIME: usize = 150_000;
/// The share of a thing that shows the slope.
const SMALL: f64 = 1e-3;

impl OperatingPoint<'_> {
    /// Sensitivities of its complex modes, advice and its proof, as `wanted`.
    ///
    /// # Errors
    /// An analysis without an answer.
    pub fn sensitivities(
        &self,
        modes: &ComplexModes,
        wanted: &SensitivityAnalysis,
        observer: &dyn Observer,
    ) -> Result<SensitivityResult> {
        let (scalars, mut left_out) = chosen(self.prepared.case, &wanted.parameters);
        let all = &modes.modes;
        let picked = chosen_modes(all, &wanted.modes)?;
        let modes: Vec<&ComplexMode> = picked.iter().map(|k| &all[*k]).collect();
        if modes.is_empty() {
            return Ok(SensitivityResult { modes: Vec::new(), left_out });
        }
        let sensitivity = Sensitivity::new(&self.system, &self.steady, self.open_modes(observer)?, &modes)?;

        observer.begin("sensitivities", Some(scalars.len() as u64));
        let of = |scalar: &CaseScalar| {
            let rates = self.rates(&sensitivity, scalar);
            observer.advance(1);
            rates
        };
        let rates: Vec<Result<Vec<Rate>>> = if self.system.n_dofs() > ONE_AT_A_TIME {
            scalars.iter().map(of).collect()
        } else {
            scalars.par_iter().map(of).collect()
        };
        observer.end();

        let mut results: Vec<ModeSensitivity> = picked
            .iter()
            .zip(&modes)
            .map(|(k, mode)| ModeSensitivity {
                mode: *k,
                eigenvalue: mode.eigenvalue,
                parameters: Vec::new(),
                advice: None,
                best: Vec::new(),
            })
            .collect();
        for (scalar, rates) in scalars.iter().zip(rates) {
            match rates {
                Ok(rates) => results.iter_mut().zip(rates).for_each(|(result, rate)| {
                    result.parameters.push(ParameterRate {
                        path: scalar.path.clone(),
                        value: scalar.value,
                        unit: scalar.unit.to_string(),
                        rate: rate.value,
                        error: rate.error,
                        kink: rate.kink,
                        size: result.eigenvalue.norm(),
                    });
                }),
                Err(error) => left_out.push((scalar.path.clone(), reason(&error))),
            }
        }
        for result in &mut results {
            result
                .parameters
                .sort_by(|a, b| b.growth_per_percent().abs().total_cmp(&a.growth_per_percent().abs()));
        }
        if wanted.advice {
            self.advise(wanted, &sensitivity, &mut results);
        }
        if wanted.verify {
            self.verify(all, &mut results, observer)?;
        }
        Ok(SensitivityResult { modes: results, left_out })
    }

    /// Mounts the best things really, and small parts of them.
    fn verify(
        &self,
        modes: &[ComplexMode],
        results: &mut [ModeSensitivity],
        observer: &dyn Observer,
    ) -> Result<()> {
        let all = results.iter().map(|r| r.best.len() as u64).sum();
        observer.begin("mounting what helps", Some(all));
        for result in results {
            let mode = &modes[result.mode];
            for mounted in &mut result.best {
                let change = |share: f64| -> Result<c64> {
                    let thing = Mounted { amount: share * mounted.amount, ..mounted.clone() };
                    Ok(verify::mounted(self.prepared, mode, &thing)? - mode.eigenvalue)
                };
                let (done, little) = (change(1.0)?, change(SMALL)? / SMALL);
                mounted.done = Some(done);
                mounted.slope_error = Some((little - mounted.predicted).norm() / mounted.predicted.norm());
                observer.advance(1);
            }
        }
        observer.end();
        Ok(())
    }

    /// dλ/dp of every chosen mode.
    pub(super) fn rates(&self, sensitivity: &Sensitivity, scalar: &CaseScalar) -> Result<Vec<Rate>> {
        let case = self.prepared.case;
        let value = scalar.value;
        if scalar.kind == ScalarKind::Ratio {
            // C is linear in the ratio, so that a step of any size gives the derivative.
            let step = if value > 0.5 { -0.1 } else { 0.1 };
            let below = case.cea.as_ref().map_or(f64::INFINITY, |cea| damped_below(case, cea));
            let here = modal_ratios(case, &self.real, below)?;
            let there = modal_ratios(&case.with_parameter(&scalar.path, value + step)?, &self.real, below)?;
            let change: Vec<f64> = there.iter().zip(&here).map(|(a, b)| (a - b) / step).collect();
            let exact = |value: c64| Rate { value, error: 0.0, kink: false };
            return Ok(sensitivity.change_by_ratios(&change).into_iter().map(exact).collect());
        }
        if let Some(slopes) = case.matrices.as_ref().and_then(|m| m.slopes(&scalar.path)) {
            return self.rates_of_factors(sensitivity, &slopes);
        }
        let build = |value: f64| scalar.system_at(self.prepared, value);
        let mut step = scalar.step();
        if value == 0.0 {
            step = self.step_from_zero(sensitivity, &build, (step, scalar.longest_step()))?;
        }
        let accepted = |p: f64| case.with_parameter(&scalar.path, p).is_ok();
        let domain = if accepted(value - 2.0 * step) { Domain::Inside } else { Domain::AtLowerBound };
        let rates = sensitivity.differentiate(value, step, domain, &build)?;
        // The nodes of a generated mesh may be the same in number and yet jump.
        let rough = |rate: &Rate| rate.kink || rate.error > 1e-3 * rate.value.norm();
        if scalar.path.starts_with("mesh.") && rates.iter().any(rough) {
            let found = "the generated mesh does not follow it smoothly";
            return Err(Error::analysis("derivative", found, "Leave the scalar out"));
        }
        Ok(rates)
    }

    /// dλ/dp where p moves the factors of added matrices at the rates `slopes`: Q is linear in the factors, so that a step of any
    /// size gives the derivative; it is as long as the largest factor.
    fn rates_of_factors(&self, sensitivity: &Sensitivity, slopes: &BTreeMap<&str, f64>) -> Result<Vec<Rate>> {
        let mut case = self.prepared.case.clone();
        let mut step = 0.0f64;
        if let Some(matrices) = &mut case.matrices {
            let values: BTreeMap<String, f64> = matrices
                .term
                .iter()
                .map(|(name, term)| (name.clone(), matrices.value(&term.factor)))
                .collect();
            let sizes = slopes.iter().map(|(name, slope)| values[*name].abs().max(1e-3) / slope.abs());
            step = sizes.fold(f64::INFINITY, f64::min);
            for (name, term) in &mut matrices.term {
                let slope = slopes.get(name.as_str()).copied().unwrap_or(0.0);
                let change = if slope == 0.0 { 0.0 } else { step * slope };
                term.factor = Factor::Number(values[name] + change);
            }
        }
        let exact = |value: c64| Rate { value, error: 0.0, kink: false };
        if !step.is_finite() {
            return Ok(sensitivity.eigenvalues().iter().map(|_| exact(c64::new(0.0, 0.0))).collect());
        }
        let other = self.prepared.rebuilt(&case)?;
        same_structure(self.prepared, &other)?;
        Ok(sensitivity.change(&other.system)?.into_iter().map(|change| exact(change / step)).collect())
    }

    /// A step from zero that changes some λ by about 1e-5 of itself, found from a guess and no longer than `longest`. Where the model
    /// does not bear a step, the one before it is kept.
    fn step_from_zero(
        &self,
        sensitivity: &Sensitivity,
        build: &dyn Fn(f64) -> Result<System>,
        (mut step, longest): (f64, f64),
    ) -> Result<f64> {
        const AIM: f64 = 1e-5;
        const TRIALS: usize = 4;
        let mut borne = None;
        for trial in 1..=TRIALS {
            let change = match build(step).and_then(|other| sensitivity.change(&other)) {
                Ok(change) => change,
                Err(error) => return borne.ok_or(error),
            };
            borne = Some(step);
            let sizes = change.iter().zip(sensitivity.eigenvalues()).map(|(d, l)| d.norm() / l.norm());
            let size = sizes.fold(0.0, f64::max);
            if size.is_nan() || size == 0.0 || (0.1..10.0).contains(&(size / AIM)) {
                break;
            }
            let next = (step * (AIM / size).clamp(1e-8, 1e8)).min(longest.max(step));
            if next == step || trial == TRIALS {
                break;
            }
            step = next;
        }
        Ok(step)
    }

    /// The fields, and the best places, of every chosen mode.
    fn advise(
        &self,
        wanted: &SensitivityAnalysis,
        sensitivity: &Sensitivity,
        results: &mut [ModeSensitivity],
    ) {
        let dofs = &self.prepared.assembled.dofs;
        let normals = self.node_normals();
        let n = self.prepared.model.nodes.len();
        let rows: Vec<SparseVector> = (0..n)
            .flat_map(|node| {
                let along = |d: [f64; 3]| dofs.reduce(&[0, 1, 2].map(|axis| (node, axis, d[axis])));
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], normals[node]].map(along)
            })
            .collect();
        for (result, rates) in results.iter_mut().zip(sensitivity.at(&rows)) {
            let four = |pick: fn(&PointRates) -> c64| -> Vec<[c64; 4]> {
                rates.chunks(4).map(|at| [0, 1, 2, 3].map(|d| pick(&at[d]))).collect()
            };
            let field = AdviceField {
                mass: rates.chunks(4).map(|at| at[0].by_mass + at[1].by_mass + at[2].by_mass).collect(),
                stiffness: four(|r| r.by_stiffness),
                damping: four(|r| r.by_damping),
            };
            result.best = self.best(wanted, &field, &normals);
            result.advice = Some(field);
        }
    }

    /// The node where the mass lowers σ most, and the node and direction for the damper.
    fn best(&self, wanted: &SensitivityAnalysis, field: &AdviceField, normals: &[[f64; 3]]) -> Vec<Mounted> {
        let least = |values: &mut dyn Iterator<Item = (usize, f64)>| {
            let first = values.reduce(|best, next| if next.1 < best.1 { next } else { best });
            first.filter(|(_, rate)| *rate < 0.0).map(|(k, _)| k)
        };
        let mounted = |kind, amount, unit, node: usize, direction, rate: c64| Mounted {
            kind,
            amount,
            unit,
            node,
            position: self.prepared.model.nodes[node],
            direction,
            predicted: rate * amount,
            done: None,
            slope_error: None,
        };
        let mut best = Vec::new();
        if let Some(node) = least(&mut field.mass.iter().map(|r| r.re).enumerate()) {
            best.push(mounted("mass", wanted.mass, "kg", node, None, field.mass[node]));
        }
        if let Some(k) = least(&mut field.damping.iter().flatten().map(|r| r.re).enumerate()) {
            let (node, axis) = (k / 4, k % 4);
            let mut direction = [0.0; 3];
            if axis < 3 {
                direction[axis] = 1.0;
            } else {
                direction = normals[node];
            }
            best.push(mounted(
                "damper",
                wanted.damper,
                "N s/m",
                node,
                Some(direction),
                field.damping[node][axis],
            ));
        }
        best
    }

    /// The mean normal of the shells at each node; zero off the shells.
    fn node_normals(&self) -> Vec<[f64; 3]> {
        use nalgebra::Vector3;
        let model = &self.prepared.model;
        let mut normals = vec![Vector3::<f64>::zeros(); model.nodes.len()];
        for face in model.shells().flat_map(|(part, _)| &part.cells) {
            let at = |k: usize| Vector3::from(model.nodes[face.nodes()[k]]);
            let area = (at(1) - at(0)).cross(&(at(2) - at(0)));
            face.nodes().iter().for_each(|node| normals[*node] += area);
        }
        normals.iter().map(|n| n.try_normalize(0.0).unwrap_or_default().into()).collect()
    }
}

/// Indices of the modes nearest to `frequencies`, or of the unstable ones, or of the one nearest to instability;
/// ascending.
/// Fails for a frequency that no mode is near.
fn chosen_modes(modes: &[ComplexMode], frequencies: &[f64]) -> Result<Vec<usize>> {
    let by_growth = |a: &usize, b: &usize| modes[*b].growth_rate().total_cmp(&modes[*a].growth_rate());
    let mut picked: Vec<usize> = if frequencies.is_empty() {
        let mut all: Vec<usize> = (0..modes.len()).collect();
        all.sort_by(by_growth);
        let unstable = all.iter().filter(|k| modes[**k].unstable()).count();
        all.truncate(unstable.clamp(1, MOST_MODES));
        all
    } else {
        let nearest = |hz: &f64| {
            near_mode(modes, *hz, |_| true).ok_or_else(|| {
                let found =
                    format!("no complex mode within 10 % of {hz} Hz, which `sensitivity.modes` names");
                Error::analysis(
                    "sensitivities",
                    found,
                    "Name frequencies near complex modes, or none for those that grow",
                )
            })
        };
        frequencies.iter().map(nearest).collect::<Result<_>>()?
    };
    picked.sort_unstable();
    picked.dedup();
    Ok(picked)
}

/// Why a scalar has no derivative, in a few words.
fn reason(error: &Error) -> String {
    match error {
        Error::Analysis { what, found, .. } if what == "derivative" => found.clone(),
        // The sentence that it stands in has its own full stop.
        other => other.to_string().trim_end_matches('.').to_string(),
    }
}
