//! The solver of a study, on its reduced model or by whole analyses.

use super::explore::{Explorer, Problem};
use super::studies::{Points, Study};
use crate::error::Result;
use crate::progress::Observer;
use crate::sweep::{AnswerStore, Answered, Block, Filled, Modes, Paired, SampleModes, sampled};

/// Solves the places of a study, the same in every process.
pub(super) struct StudySolver<'s> {
    study: &'s Study,
    pub(super) problem: Problem<'s>,
    /// The modes with which those of samples are paired.
    pub(super) reference: Option<Modes>,
}

impl StudySolver<'_> {
    /// Computes a block; its answers are in `store`, or put there.
    pub(super) fn solve(
        &self,
        block: &Block,
        store: &dyn AnswerStore,
        observer: &dyn Observer,
    ) -> Result<()> {
        match &self.study.points {
            Points::Grid(axes) => {
                let tolerance = self.problem.tolerance(axes);
                block.solve(&Answered::new(self.problem.of(), store), axes, tolerance, observer)
            }
            Points::Samples { places, .. } => {
                let [first, last] = block.0[0];
                self.sampled(&places[first..=last], store, observer).map(|_| ())
            }
        }
    }

    /// As [`sampled`]; answers are in `store`, or put there.
    pub(super) fn sampled(
        &self,
        places: &[Vec<f64>],
        store: &dyn AnswerStore,
        observer: &dyn Observer,
    ) -> Result<Filled<SampleModes>> {
        let reference = self.reference.as_ref().expect("the modes of a study of samples");
        let paired = Paired::new(self.problem.of(), reference);
        sampled(&Answered::new(&paired, store), places, observer)
    }
}

impl Explorer<'_> {
    /// The solver of a study.
    /// Fails where a reduced model cannot be trained, and where a study of samples has no answer at the values of the case.
    pub(super) fn solver<'s>(&'s self, study: &'s Study) -> Result<StudySolver<'s>> {
        let mut problem = self.problem(study)?;
        let reference = match &study.points {
            Points::Grid(_) => None,
            Points::Samples { places, .. } => {
                self.train(&mut problem, places)?;
                Some(self.reference(problem.of(), study)?)
            }
        };
        Ok(StudySolver { study, problem, reference })
    }
}
