//! The boundary of stability in a map: the line on which the largest growth rate is zero.

use super::at_once::solve_all;
use super::map::MapPoint;
use super::points::reasoned;
use super::root::{Bracket, narrow};
use super::rounding::rounding;
use super::{Axis, SweepProblem};
use crate::error::Result;
use crate::progress::Observer;
use faer::Mat;
use std::collections::BTreeMap;

/// Located points of the boundary and the lines through them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Boundary {
    /// Places (first parameter, second parameter).
    pub points: Vec<[f64; 2]>,
    /// Lines, each a list of indices into `points`; closed where the last is the first.
    pub lines: Vec<Vec<usize>>,
}

/// An edge of the grid: its lower left end and whether it goes up.
type GridEdge = (usize, usize, bool);

/// Locates the boundary on every edge of the grid with a stable and an unstable end, to `tolerance` of the value, and
/// joins the points through the cells. Where all four edges of a cell are cut, the middle of the cell decides.
///
/// # Errors
/// [`Error::Io`](crate::error::Error::Io) at a place. Any other error of a place leaves the boundary there as exact as it is by then.
pub fn boundary(
    problem: &dyn SweepProblem,
    axes: &[Axis; 2],
    map: &[MapPoint],
    tolerance: f64,
    observer: &dyn Observer,
) -> Result<Boundary> {
    let grid = Grid { problem, axes, map };
    let edges = grid.cut_edges();
    observer.begin("stability boundary", Some(edges.len() as u64));
    let locate = |k: usize| {
        let place = grid.locate(&edges[k], tolerance)?;
        observer.advance(1);
        Ok(place)
    };
    let points: Result<Vec<[f64; 2]>> = solve_all(problem.at_once(), 0..edges.len(), &locate);
    observer.end();
    let points = points?;
    Ok(Boundary { lines: chains(points.len(), &grid.segments(&edges)?), points })
}

/// A map on the grid of its axes.
struct Grid<'a> {
    problem: &'a dyn SweepProblem,
    axes: &'a [Axis; 2],
    map: &'a [MapPoint],
}

impl Grid<'_> {
    /// Whether a point of the grid is unstable; `None` where there is no answer.
    fn unstable(&self, i: usize, j: usize) -> Option<bool> {
        let point = self.map.get(i + self.axes[0].points * j);
        point.filter(|p| p.growth_rate.is_finite()).map(|p| p.unstable > 0)
    }

    /// The edges with a stable and an unstable end.
    fn cut_edges(&self) -> Vec<GridEdge> {
        let [nx, ny] = [self.axes[0].points, self.axes[1].points];
        let differ = |a: (usize, usize), b: (usize, usize)| {
            let ends = self.unstable(a.0, a.1).zip(self.unstable(b.0, b.1));
            ends.is_some_and(|(a, b)| a != b)
        };
        let mut edges: Vec<GridEdge> = Vec::new();
        for j in 0..ny {
            for i in 0..nx {
                if i + 1 < nx && differ((i, j), (i + 1, j)) {
                    edges.push((i, j, false));
                }
                if j + 1 < ny && differ((i, j), (i, j + 1)) {
                    edges.push((i, j, true));
                }
            }
        }
        edges
    }

    /// The largest growth rate at a place \[1/s\], less round-off; not a number where it has no answer.
    fn growth(&self, at: &[f64]) -> Result<f64> {
        let Ok(all) = reasoned(self.problem.eigenvalues(at))? else { return Ok(f64::NAN) };
        let growth = (0..all.len()).map(|k| all[k].re - rounding(&all, &Mat::new(), k));
        Ok(growth.fold(f64::NEG_INFINITY, f64::max).max(-1e300))
    }

    /// Where the boundary cuts an edge, to `tolerance` of the value along it.
    fn locate(&self, &(i, j, rising): &GridEdge, tolerance: f64) -> Result<[f64; 2]> {
        let axis = &self.axes[usize::from(rising)];
        let place = |x: f64| if rising { [self.axes[0].value(i), x] } else { [x, self.axes[1].value(j)] };
        let k = if rising { j } else { i };
        let (a, b) = (axis.value(k), axis.value(k + 1));
        let known = |k: usize| {
            let at = if rising { i + self.axes[0].points * k } else { k + self.axes[0].points * j };
            let MapPoint { growth_rate, unstable, .. } = self.map[at];
            // Of a stable point what is above zero is rounding.
            if unstable > 0 { growth_rate } else { growth_rate.min(0.0) }
        };
        let (fa, fb) = (known(k), known(k + 1));
        let bracket = if fa > 0.0 {
            Bracket { below: (b, fb), above: (a, fa) }
        } else {
            Bracket { below: (a, fa), above: (b, fb) }
        };
        let (small, large) = (a.abs().min(b.abs()), a.abs().max(b.abs()));
        let width = tolerance * small.max(1e-3 * large);
        let found = narrow(bracket, width, usize::MAX, |x| self.growth(&place(x)))?;
        Ok(place(0.5 * (found.below.0 + found.above.0)))
    }

    /// Pairs of cut edges between which the boundary runs through a cell.
    fn segments(&self, edges: &[GridEdge]) -> Result<Vec<[usize; 2]>> {
        let [nx, ny] = [self.axes[0].points, self.axes[1].points];
        let index: BTreeMap<GridEdge, usize> = edges.iter().enumerate().map(|(k, e)| (*e, k)).collect();
        let mut segments = Vec::new();
        for j in 0..ny.saturating_sub(1) {
            for i in 0..nx.saturating_sub(1) {
                // Bottom, right, top, left.
                let around = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
                let cut: Vec<usize> = around.iter().filter_map(|e| index.get(e).copied()).collect();
                match cut[..] {
                    [a, b] => segments.push([a, b]),
                    [bottom, right, top, left] => {
                        let at = [(0, i), (1, j)].map(|(d, k)| {
                            let axis = &self.axes[d];
                            axis.between(axis.value(k), axis.value(k + 1), 0.5)
                        });
                        // The middle like the lower left corner: the two corners are joined, the others cut off.
                        let joined = (self.growth(&at)? > 0.0) == (self.unstable(i, j) == Some(true));
                        segments.extend(if joined {
                            [[bottom, right], [top, left]]
                        } else {
                            [[bottom, left], [top, right]]
                        });
                    }
                    _ => {}
                }
            }
        }
        Ok(segments)
    }
}

/// Joins segments that share an end into lines, open ones first.
fn chains(n: usize, segments: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); n];
    for (s, ends) in segments.iter().enumerate() {
        ends.iter().for_each(|e| at[*e].push(s));
    }
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    let starts = (0..n).filter(|p| at[*p].len() == 1).chain((0..n).filter(|p| at[*p].len() > 1));
    for start in starts.collect::<Vec<_>>() {
        let mut line = vec![start];
        while let Some(s) = at[line[line.len() - 1]].iter().copied().find(|s| !used[*s]) {
            used[s] = true;
            let [a, b] = segments[s];
            line.push(if a == line[line.len() - 1] { b } else { a });
        }
        if line.len() > 1 {
            lines.push(line);
        }
    }
    lines
}
