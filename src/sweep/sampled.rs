//! Complex modes at places that are given one by one, each paired with a mode of a reference.

use super::assign::assign;
use super::points::{Filled, fill};
use super::{AtOnce, Modes, SweepProblem};
use crate::error::Result;
use crate::linalg::c64;
use crate::progress::Observer;
use faer::Mat;

/// λ of the modes at a place \[1/s\]: first that of each reference mode, not a number where it has none there, then the others; `None`
/// where the place has no answer.
pub type SampleModes = Option<Vec<c64>>;

/// A problem whose eigenvalues come in the order of reference modes, as [`SampleModes`] has them. Modes are paired by shape and
/// frequency ([`Modes`] that cannot be compared: by λ alone), each with one at most.
pub struct Paired<'a> {
    problem: &'a dyn SweepProblem,
    reference: &'a Modes,
}

impl<'a> Paired<'a> {
    /// The modes of `problem` as those of `reference`.
    pub fn new(problem: &'a dyn SweepProblem, reference: &'a Modes) -> Self {
        Paired { problem, reference }
    }
}

impl SweepProblem for Paired<'_> {
    fn modes(&self, at: &[f64]) -> Result<Modes> {
        let found = self.problem.modes(at)?;
        let links = assign(self.reference, &found).to;
        let of = |link: &Option<(usize, f64)>| {
            link.map_or(c64::new(f64::NAN, f64::NAN), |(k, _)| found.eigenvalues[k])
        };
        let others =
            (0..found.eigenvalues.len()).filter(|k| !links.iter().flatten().any(|(own, _)| own == k));
        let eigenvalues: Vec<c64> =
            links.iter().map(of).chain(others.map(|k| found.eigenvalues[k])).collect();
        Ok(Modes { vectors: Mat::zeros(0, eigenvalues.len()), eigenvalues })
    }

    fn at_once(&self) -> AtOnce {
        self.problem.at_once()
    }
}

/// The eigenvalues at each of `places`.
///
/// # Errors
/// [`Error::Io`](crate::error::Error::Io) at a place. Any other error of a place leaves that place without an answer.
pub fn sampled(
    problem: &dyn SweepProblem,
    places: &[Vec<f64>],
    observer: &dyn Observer,
) -> Result<Filled<SampleModes>> {
    let solve = |k: usize| problem.eigenvalues(&places[k]).map(Some);
    observer.begin("samples", Some(places.len() as u64));
    let filled = fill((places.len(), problem.at_once()), &solve, None, &mut |_, _| Ok(()), observer)?;
    observer.end();
    Ok(filled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Two modes whose frequencies cross at zero, and a third that is there below zero only; no answer above nine.
    struct Crossing(AtomicUsize);

    impl SweepProblem for Crossing {
        fn modes(&self, at: &[f64]) -> Result<Modes> {
            self.0.fetch_add(1, Ordering::Relaxed);
            if at[0] > 9.0 {
                return Err(crate::error::Error::analysis("test", "above nine", ""));
            }
            let mut all = vec![(100.0 + at[0], 0), (100.0 - at[0], 1)];
            if at[0] < 0.0 {
                all.push((300.0, 2));
            }
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let vectors =
                Mat::from_fn(3, all.len(), |i, j| c64::new(f64::from(u8::from(i == all[j].1)), 0.0));
            Ok(Modes { eigenvalues: all.iter().map(|(w, _)| c64::new(0.0, *w)).collect(), vectors })
        }
    }

    #[test]
    fn modes_are_paired_by_their_shapes() {
        let crossing = Crossing(AtomicUsize::new(0));
        let reference = crossing.modes(&[-1.0]).unwrap();
        let paired = Paired::new(&crossing, &reference);
        // The reference has the first shape below the second; on the other side of the crossing it is above.
        let frequencies =
            |at: f64| -> Vec<f64> { paired.eigenvalues(&[at]).unwrap().iter().map(|z| z.im).collect() };
        assert_eq!(frequencies(-2.0), [98.0, 102.0, 300.0]);
        let beyond = frequencies(2.0);
        assert!(beyond[..2] == [102.0, 98.0] && beyond[2].is_nan() && beyond.len() == 3, "{beyond:?}");
        // A mode that the reference does not have comes after those that it has.
        let few = crossing.modes(&[1.0]).unwrap();
        let extra = Paired::new(&crossing, &few).eigenvalues(&[-1.0]).unwrap();
        assert_eq!(extra.iter().map(|z| z.im).collect::<Vec<_>>(), [101.0, 99.0, 300.0]);
    }

    #[test]
    fn samples_without_an_answer_are_counted_and_the_first_failure_is_named() {
        let places: Vec<Vec<f64>> = (0..100).map(|k| vec![0.1 * f64::from(k)]).collect();
        let crossing = Crossing(AtomicUsize::new(0));
        let (all, unanswered) = sampled(&crossing, &places, &()).unwrap();
        assert!(unanswered[0].1.to_string().contains("above nine") && crossing.0.into_inner() == 100);
        assert_eq!(unanswered.iter().map(|(k, _)| *k).collect::<Vec<_>>(), (91..100).collect::<Vec<_>>());
        assert_eq!(all.iter().filter(|modes| modes.is_none()).count(), 9);
    }
}
