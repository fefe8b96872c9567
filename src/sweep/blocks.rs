//! Blocks of a grid, by which several processes share a sweep or a map: not only its points, but also what is looked for between
//! them, which often takes longer (steps that are halved, critical values, interactions, the boundary of stability).

use super::answers::{answer, points};
use super::at_once::solve_all;
use super::boundary::boundary;
use super::map::MapPoint;
use super::points::reasoned;
use super::track::follow_block;
use super::{Axis, SweepProblem};
use crate::error::Result;
use crate::progress::Observer;

/// The first and the last point of a block along each axis. Neighbouring blocks share the points between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Block(pub Vec<[usize; 2]>);

/// Blocks that cover the grid of these axes: `most`, or fewer where the grid cannot be cut into so many.
pub fn blocks(axes: &[Axis], most: usize) -> Vec<Block> {
    let cells: Vec<usize> = axes.iter().map(|axis| axis.points - 1).collect();
    let cut = |cells: usize, into: usize| {
        (0..into).map(move |k| [cells * k / into, cells * (k + 1) / into]).collect::<Vec<_>>()
    };
    match cells[..] {
        [across, up] => {
            let [columns, rows] = columns_and_rows([across, up], most);
            let columns = cut(across, columns);
            let row = |up: [usize; 2]| columns.iter().map(move |across| Block(vec![*across, up]));
            cut(up, rows).into_iter().flat_map(row).collect()
        }
        _ => cut(cells[0], most.min(cells[0])).into_iter().map(|along| Block(vec![along])).collect(),
    }
}

/// Numbers of columns and rows of blocks, `most` or a little fewer blocks, nearly square.
fn columns_and_rows([across, up]: [usize; 2], most: usize) -> [usize; 2] {
    let shape = |count: usize| {
        let fit =
            (1..=count.min(across)).filter(|columns| count.is_multiple_of(*columns) && count / columns <= up);
        let length = |columns: &usize| across.div_ceil(*columns) + up.div_ceil(count / columns);
        fit.min_by_key(length).map(|columns| [columns, count / columns])
    };
    (1..=most.min(across * up)).rev().find_map(shape).unwrap_or([1, 1])
}

impl Block {
    /// Its points by their numbers in the grid of these axes.
    pub fn points(&self, axes: &[Axis]) -> Vec<usize> {
        let inside = |k: &usize| {
            let mut rest = *k;
            axes.iter().zip(&self.0).all(|(axis, [first, last])| {
                let along = rest % axis.points;
                rest /= axis.points;
                (*first..=*last).contains(&along)
            })
        };
        (0..points(axes)).filter(inside).collect()
    }

    /// Asks `problem` for its points, then for every place inside that a sweep or a map with its boundary asks for, located to
    /// `tolerance`. Places without an answer are passed over; what is left out is what a sweep looks for at the first point.
    ///
    /// # Errors
    /// [`Error::Io`](crate::error::Error::Io) at a place, or of the store of `problem`; the first error between the points.
    pub fn solve(
        &self,
        problem: &dyn SweepProblem,
        axes: &[Axis],
        tolerance: f64,
        observer: &dyn Observer,
    ) -> Result<()> {
        let own = self.points(axes);
        observer.begin("points", Some(own.len() as u64));
        let solve = |k: usize| {
            let found = answer(problem, axes, own[k]);
            observer.advance(1);
            Ok((own[k], reasoned(found)?.ok()))
        };
        let found = solve_all(problem.at_once(), 0..own.len(), &solve)?;
        observer.end();
        if let [across, up] = axes {
            let mut map = vec![MapPoint::NONE; points(axes)];
            for (k, modes) in found {
                map[k] = modes.map_or(MapPoint::NONE, |modes| MapPoint::of(&modes.eigenvalues));
            }
            return boundary(problem, &[*across, *up], &map, tolerance, observer).map(|_| ());
        }
        follow_block(problem, &axes[0], self.0[0], tolerance, observer)
    }
}
