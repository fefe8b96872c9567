//! Branches: every mode followed along one parameter.

use super::answers::answer;
use super::assign::{Link, assign};
use super::at_once::solve_all;
use super::branch::{Branch, Sample};
use super::critical::{Critical, critical_values};
use super::interaction::{Interaction, interactions};
use super::points::{Unanswered, reasoned};
use super::{Axis, SweepProblem};
use crate::error::Result;
use crate::progress::Observer;
use std::ops::Range;

/// Halvings of a step at most where the MAC of shapes leaves a doubt.
const HALVINGS: usize = 7;
/// A halving that raises the MAC of what is in doubt by less than this does not help.
const SURER: f64 = 0.02;
/// Relative length to which interactions are narrowed at least.
const CLOSE: f64 = 1e-7;

/// The modes along one parameter.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// Every value at which modes were computed, in the order of the sweep: those requested, and more between them
    /// where shapes change quickly.
    pub values: Vec<f64>,
    /// One a mode, those that begin at the first value first.
    pub branches: Vec<Branch>,
    /// Where branches become unstable or stable, in the order of the sweep.
    pub critical: Vec<Critical>,
    /// Where two branches come near each other.
    pub interactions: Vec<Interaction>,
    /// The values without an answer, by their indices: branches end before them, and others begin behind.
    pub unanswered: Unanswered,
    /// Steps that were not halved, though another link of their modes would be about as good, as the limit of solutions was reached.
    pub doubtful_steps: usize,
}

impl Sweep {
    /// How many branches begin or end between two values with an answer: modes that enter or leave the band, or that are not followed.
    /// Between those values nothing is known of them.
    pub fn broken(&self) -> usize {
        let answered = |k: usize| k < self.values.len() && self.unanswered.iter().all(|(none, _)| *none != k);
        let broken = |branch: &&Branch| {
            let begins = branch.first.checked_sub(1).is_some_and(answered);
            begins || answered(branch.first + branch.eigenvalues.len())
        };
        self.branches.iter().filter(broken).count()
    }

    /// The values with an answer.
    pub fn answered(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        let all = self.values.iter().enumerate();
        all.filter(|(k, _)| self.unanswered.iter().all(|(none, _)| none != k)).map(|(_, value)| *value)
    }
}

/// Follows every mode of `problem` along `axis`; critical values are located to `tolerance`, relative to the value.
///
/// The values of the axis are solved at once, then linked in their order by their shapes; a step is halved where another
/// link would be about as good. Steps, critical values and interactions take
/// [`SweepProblem::solutions_between`] solutions each at most, and are given as they are then. At a coalescence no step is small
/// enough: there the nearest eigenvalue continues the branch.
///
/// # Errors
/// [`Error::Io`](crate::error::Error::Io) at a value. Any other error of a value, such as a contact that opens, leaves that value without an
/// answer.
pub fn sweep(
    problem: &dyn SweepProblem,
    axis: &Axis,
    tolerance: f64,
    observer: &dyn Observer,
) -> Result<Sweep> {
    let Chain { samples, links, doubtful: doubtful_steps, .. } =
        Chain::along(problem, axis, 0..axis.points, observer)?;
    let branches = branches(&samples, &links);
    let most = problem.solutions_between(axis.points);
    let critical = critical_values(problem, axis, tolerance, &samples, &branches, most, observer)?;
    let interactions = interactions(problem, axis, tolerance.max(CLOSE), &samples, &branches, most)?;
    let values = samples.iter().map(|s| s.value).collect();
    let unanswered = samples.into_iter().enumerate().filter_map(|(k, s)| Some((k, s.why_none?))).collect();
    Ok(Sweep { values, branches, critical, interactions, unanswered, doubtful_steps })
}

/// Asks `problem` for every place that [`sweep`] asks for between two points of the axis, and for what interacts at the last one.
pub(super) fn follow_block(
    problem: &dyn SweepProblem,
    axis: &Axis,
    [first, last]: [usize; 2],
    tolerance: f64,
    observer: &dyn Observer,
) -> Result<()> {
    // Whether branches are nearest at the last point shows in the step behind it.
    let points = first..(last + 2).min(axis.points);
    let Chain { samples, links, .. } = Chain::along(problem, axis, points, observer)?;
    let end = samples.iter().position(|sample| sample.value == axis.value(last));
    let end = end.expect("the last point is one of the chain") + 1;
    let own = &samples[..end];
    let most = problem.solutions_between(axis.points);
    critical_values(problem, axis, tolerance, own, &branches(own, &links), most, observer)?;
    let own = &samples[..samples.len().min(end + 1)];
    interactions(problem, axis, tolerance.max(CLOSE), own, &branches(own, &links), most).map(|_| ())
}

/// The samples so far and the links between neighbours.
struct Chain<'a> {
    problem: &'a dyn SweepProblem,
    axis: &'a Axis,
    samples: Vec<Sample>,
    links: Vec<Link>,
    /// Solutions that steps may still be halved by.
    left: usize,
    /// Steps that were not halved for want of them.
    doubtful: usize,
}

impl<'a> Chain<'a> {
    /// The samples at points of the axis, and those between them.
    fn along(
        problem: &'a dyn SweepProblem,
        axis: &'a Axis,
        points: Range<usize>,
        observer: &dyn Observer,
    ) -> Result<Self> {
        observer.begin("sweep", Some(points.len() as u64));
        let solve = |k: usize| {
            let modes = reasoned(answer(problem, std::slice::from_ref(axis), k))?;
            observer.advance(1);
            Ok(Sample::new(axis.value(k), modes))
        };
        let solved = solve_all(problem.at_once(), points, &solve);
        observer.end();
        let left = problem.solutions_between(axis.points);
        let mut chain = Chain { problem, axis, samples: Vec::new(), links: Vec::new(), left, doubtful: 0 };
        for sample in solved? {
            chain.reach(sample, HALVINGS)?;
        }
        Ok(chain)
    }

    /// Goes on to `next`, over the middle where the link is doubtful.
    fn reach(&mut self, next: Sample, halvings: usize) -> Result<()> {
        if let Some(last) = self.samples.last() {
            let link = assign(&last.modes, &next.modes);
            let middle = self.axis.between(last.value, next.value, 0.5);
            let halves = link.doubtful && halvings > 0 && middle != last.value && middle != next.value;
            self.doubtful += usize::from(halves && self.left == 0);
            if halves && self.left > 0 {
                self.left -= 1;
                let middle = Sample::new(middle, reasoned(self.problem.modes(&[middle]))?);
                let halves = [assign(&last.modes, &middle.modes), assign(&middle.modes, &next.modes)];
                let surer = halves.iter().all(|half| half.certainty > link.certainty + SURER);
                // Twin modes turn in their plane, and merging ones become one, however small the step.
                let helps = surer || link.exchange || halves.iter().any(|half| half.exchange);
                let left = if helps { halvings - 1 } else { 0 };
                self.reach(middle, left)?;
                return self.reach(next, left);
            }
            self.links.push(link);
        }
        self.samples.push(next);
        Ok(())
    }
}

fn branches(samples: &[Sample], links: &[Link]) -> Vec<Branch> {
    let mut branches: Vec<Branch> = Vec::new();
    // The branch that each mode of the current sample is on.
    let mut current: Vec<usize> = Vec::new();
    for (k, sample) in samples.iter().enumerate() {
        let mut next = vec![None; sample.modes.eigenvalues.len()];
        if k > 0 {
            for (i, to) in links[k - 1].to.iter().enumerate() {
                if let Some((j, mac)) = to {
                    next[*j] = Some((current[i], *mac));
                }
            }
        }
        current = next
            .into_iter()
            .enumerate()
            .map(|(j, from)| {
                let lambda = sample.modes.eigenvalues[j];
                let rounding = sample.modes.rounding(j);
                match from {
                    Some((b, mac)) => {
                        let branch = &mut branches[b];
                        branch.eigenvalues.push(lambda);
                        branch.places.push(j);
                        branch.rounding.push(rounding);
                        branch.lowest_mac = branch.lowest_mac.min(mac);
                        b
                    }
                    None => {
                        branches.push(Branch {
                            first: k,
                            eigenvalues: vec![lambda],
                            lowest_mac: 1.0,
                            places: vec![j],
                            rounding: vec![rounding],
                        });
                        branches.len() - 1
                    }
                }
            })
            .collect();
    }
    branches
}
