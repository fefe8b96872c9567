//! The solver of the blocks of a study, on its reduced model or by whole analyses.

use super::explore::{BOUNDARY, Explorer, LOCATED, Problem};
use super::studies::{Points, Study};
use super::uncertainty::ProblemOfSamples;
use crate::error::Result;
use crate::progress::Observer;
use crate::sweep::{AnswerStore, Answered, Axis, Block};

/// Computes blocks of a study.
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub(super) enum StudySolver<'s> {
    Grid { axes: &'s [Axis], problem: Problem<'s>, tolerance: f64 },
    Samples { places: &'s [Vec<f64>], problem: ProblemOfSamples<'s> },
}

impl StudySolver<'_> {
    /// Computes a block; its answers are in `store`, or put there.
    ///
    /// # Errors
    /// Those of [`Block::solve`]; the machine refuses.
    pub(super) fn solve(
        &self,
        block: &Block,
        store: &dyn AnswerStore,
        observer: &dyn Observer,
    ) -> Result<()> {
        match self {
            StudySolver::Grid { axes, problem, tolerance } => {
                block.solve(&Answered::new(problem.of(), store), axes, *tolerance, observer)
            }
            StudySolver::Samples { places, problem } => {
                let [first, last] = block.0[0];
                let places = &places[first..=last];
                problem.solve(places, &[], store, &mut |_, _| Ok(()), observer).map(|_| ())
            }
        }
    }
}

impl Explorer<'_> {
    /// The solver of the blocks of a study.
    ///
    /// # Errors
    /// A reduced model that cannot be trained.
    pub(super) fn solver<'s>(&'s self, study: &'s Study) -> Result<StudySolver<'s>> {
        match &study.points {
            Points::Grid(axes) => {
                let problem = self.problem(study)?;
                let tolerances = if axes.len() == 1 { LOCATED } else { BOUNDARY };
                let tolerance = tolerances[usize::from(matches!(problem, Problem::Whole(_)))];
                Ok(StudySolver::Grid { axes, problem, tolerance })
            }
            Points::Samples { places, .. } => {
                Ok(StudySolver::Samples { places, problem: self.problem_of_samples(study, places)? })
            }
        }
    }
}
