//! Studies of uncertain scalars: the complex modes of every sample, on one reduced model or by whole analyses.

use super::explore::{ACCURACY, Explorer, Problem, REFINEMENTS, RecordStage, worst_alone};
use super::sink::ResultStage;
use super::studies::{Points, Study};
use crate::case::UncertaintyAnalysis;
use crate::error::Result;
use crate::linalg::c64;
use crate::results::{CheckedSample, RunResults, SampledScalar, UncertaintyResult, UncertaintyStudy};
use crate::sweep::{MeasuredProblem, Modes, SampleModes, SweepProblem};
use faer::Mat;

/// Samples at which the reduced model is measured on the full order before it serves all, in each round.
const PROBES: usize = 6;
/// Samples that are measured afterwards: those nearest to the limit of stability, those that grow most, others evenly spread; on a
/// reduced model and by whole analyses.
const MEASURED: [[usize; 3]; 2] = [[4, 2, 4], [1, 1, 0]];

impl Explorer<'_> {
    /// Every study of uncertain scalars of the case.
    pub(super) fn uncertainty(&self, results: &mut RunResults, record: &mut RecordStage) -> Result<()> {
        for (name, analysis) in &self.whole_case().uncertainty {
            let (result, warning) = self.study(name, analysis, record)?;
            results.warnings.extend(warning);
            record(ResultStage::Found(&result))?;
            results.records.push(result);
        }
        Ok(())
    }

    fn study(
        &self,
        name: &str,
        analysis: &UncertaintyAnalysis,
        record: &mut RecordStage,
    ) -> Result<(UncertaintyResult, Option<String>)> {
        let study = Study::of_samples(name, analysis);
        let Points::Samples { places, .. } = &study.points else { unreachable!("samples") };
        let on = self.solver(&study)?;
        record(ResultStage::StudyBegins)?;
        let (modes, unanswered) = on.sampled(places, &self.known.of(&study.name, 0), self.observer)?;
        let warning = self.without_an_answer(&study, places.len(), &unanswered, |k| places[k].clone())?;
        let study = UncertaintyStudy {
            name: name.to_string(),
            scalars: self.scalars(analysis)?,
            // The first scalar of each parameter stands for all of it.
            values: places.iter().map(|at| first_of_each(analysis, at)).collect(),
            sampling: analysis.sampling.word(),
            seed: analysis.seed,
            confidence: analysis.confidence,
            reference: on.reference.iter().flat_map(|modes| modes.eigenvalues.clone()).collect(),
            modes,
            method: on.problem.method(),
        };
        let measured = self.measured(&on.problem, &study, places);
        Ok((UncertaintyResult::new(study, measured), warning))
    }

    /// A reduced model is measured at some of the samples and trained on those where it is not good enough, before it serves all of
    /// them.
    pub(super) fn train(&self, problem: &mut Problem, places: &[Vec<f64>]) -> Result<()> {
        let Problem::Reduced(on) = problem else { return Ok(()) };
        self.observer.begin("full-order check", Some((REFINEMENTS * PROBES).min(places.len()) as u64));
        for probes in places.chunks(PROBES).take(REFINEMENTS) {
            let mut poor = Vec::new();
            for at in probes {
                poor.extend(worst(on, at).filter(|worst| *worst > ACCURACY).map(|_| at));
                self.observer.advance(1);
            }
            if poor.is_empty() {
                break;
            }
            for at in poor {
                on.train(at)?;
            }
        }
        self.observer.end();
        Ok(())
    }

    /// The modes at the values of the case itself, by frequency.
    pub(super) fn reference(&self, problem: &dyn SweepProblem, study: &Study) -> Result<Modes> {
        let own = study.paths.iter().map(|path| Ok(self.case.parameter(path)?.value));
        let modes = problem.modes(&own.collect::<Result<Vec<f64>>>()?)?;
        let mut order: Vec<usize> = (0..modes.eigenvalues.len()).collect();
        order.sort_by(|a, b| modes.eigenvalues[*a].im.total_cmp(&modes.eigenvalues[*b].im));
        let vectors = Mat::from_fn(modes.vectors.nrows(), order.len(), |i, j| modes.vectors[(i, order[j])]);
        Ok(Modes { eigenvalues: order.iter().map(|k| modes.eigenvalues[*k]).collect(), vectors })
    }

    fn scalars(&self, analysis: &UncertaintyAnalysis) -> Result<Vec<SampledScalar>> {
        let scalar = |(name, of): (&String, &crate::case::VariedParameter)| {
            let first = self.case.parameter(&of.path[0])?;
            Ok(SampledScalar {
                name: name.clone(),
                paths: of.path.clone(),
                label: first.label,
                unit: first.unit.to_string(),
                distribution: of.distribution(),
                nominal: first.value,
            })
        };
        analysis.parameter.iter().map(scalar).collect()
    }

    /// Errors of all modes at full order at some of the samples.
    fn measured(
        &self,
        problem: &Problem,
        study: &UncertaintyStudy,
        places: &[Vec<f64>],
    ) -> Vec<CheckedSample> {
        let [near, grow, spread] = MEASURED[usize::from(matches!(problem, Problem::Whole(_)))];
        let growth = |modes: &SampleModes| {
            let rates = modes.iter().flatten().map(|z: &c64| z.re).filter(|rate| !rate.is_nan());
            rates.fold(f64::NEG_INFINITY, f64::max)
        };
        let rates: Vec<f64> = study.modes.iter().map(growth).collect();
        let mut order: Vec<usize> = (0..rates.len()).filter(|k| rates[*k].is_finite()).collect();
        order.sort_by(|a, b| rates[*a].abs().total_cmp(&rates[*b].abs()));
        let mut chosen: Vec<usize> = order.iter().take(near).copied().collect();
        order.sort_by(|a, b| rates[*b].total_cmp(&rates[*a]));
        chosen.extend(order.iter().take(grow));
        chosen.extend((0..spread).map(|k| (2 * k + 1) * places.len() / (2 * spread)));
        chosen.sort_unstable();
        chosen.dedup();
        self.observer.begin("full-order check", Some(chosen.len() as u64));
        let check = |sample: usize| {
            let error = worst(problem.of(), &places[sample]);
            self.observer.advance(1);
            error.map(|eigenvalue_error| CheckedSample { sample, eigenvalue_error })
        };
        let measured = chosen.into_iter().filter_map(check).collect();
        self.observer.end();
        measured
    }
}

/// The largest error of a mode at `at`, measured on the full order; none where there is no answer.
fn worst(problem: &dyn MeasuredProblem, at: &[f64]) -> Option<f64> {
    problem.check(at).ok().map(|checks| worst_alone(&checks))
}

/// The value of every parameter from those of its scalars.
fn first_of_each(analysis: &UncertaintyAnalysis, at: &[f64]) -> Vec<f64> {
    let mut next = 0;
    let first = |of: &crate::case::VariedParameter| {
        let value = at[next];
        next += of.path.len();
        value
    };
    analysis.parameter.values().map(first).collect()
}
