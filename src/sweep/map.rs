//! Maps: the strongest growth over two parameters.

use super::answers::{answer, points};
use super::{Axis, SweepProblem, unstable};
use crate::error::Result;
use crate::linalg::c64;
use crate::progress::Observer;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Points that are computed and recorded together.
const CHUNK: usize = 32;

/// Values of a map at one point; not numbers where the point has no modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// The largest σ \[1/s\].
    pub growth_rate: f64,
    /// ω/2π of that mode \[Hz\].
    pub frequency_hz: f64,
    /// How many modes grow.
    pub unstable: u32,
}

impl MapPoint {
    /// A point without an answer.
    pub const NONE: MapPoint = MapPoint { growth_rate: f64::NAN, frequency_hz: f64::NAN, unstable: 0 };

    pub(super) fn of(eigenvalues: &[c64]) -> Self {
        let strongest = eigenvalues.iter().max_by(|a, b| a.re.total_cmp(&b.re));
        strongest.map_or(MapPoint::NONE, |z| MapPoint {
            growth_rate: z.re,
            frequency_hz: z.im / TAU,
            unstable: eigenvalues.iter().filter(|z| unstable(**z)).count() as u32,
        })
    }
}

/// Every point of the grid, the first parameter running fastest, and why points have no answer, if any has none.
///
/// `known` are the first points of an earlier run, which are not computed again. `record` is called with each new chunk
/// and the index of its first point, in order. The numbers depend on neither the chunks nor the number of threads.
///
/// # Errors
/// Those of `record`.
pub fn map(
    problem: &dyn SweepProblem,
    axes: &[Axis; 2],
    known: &[MapPoint],
    record: &mut dyn FnMut(usize, &[MapPoint]) -> Result<()>,
    observer: &dyn Observer,
) -> Result<(Vec<MapPoint>, Option<String>)> {
    let total = points(axes);
    let mut points: Vec<MapPoint> = known[..known.len().min(total)].to_vec();
    let mut failure = None;
    observer.begin("map", Some(total as u64));
    observer.advance(points.len() as u64);
    while points.len() < total {
        let first = points.len();
        let solve = |k: usize| {
            let point = answer(problem, axes, k).map(|modes| MapPoint::of(&modes.eigenvalues));
            observer.advance(1);
            point
        };
        let chunk = first..total.min(first + CHUNK);
        let solved: Vec<Result<MapPoint>> = match problem.parallel() {
            true => chunk.into_par_iter().map(solve).collect(),
            false => chunk.map(solve).collect(),
        };
        for point in solved {
            points.push(point.unwrap_or_else(|error| {
                failure.get_or_insert_with(|| error.to_string());
                MapPoint::NONE
            }));
        }
        record(first, &points[first..])?;
    }
    observer.end();
    Ok((points, failure))
}
