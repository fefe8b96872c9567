//! Maps: the strongest growth over two parameters.

use super::answers::{answer, points};
use super::points::{Filled, RecordPoints, fill};
use super::rounding::rounding;
use super::{Axis, SweepProblem, unstable};
use crate::error::Result;
use crate::linalg::c64;
use crate::progress::Observer;
use faer::Mat;
use std::f64::consts::TAU;

/// Values of a map at one point; not numbers where the point has no modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// The largest σ \[1/s\].
    pub growth_rate: f64,
    /// ω/2π of that mode \[Hz\].
    pub frequency_hz: f64,
    /// How many modes grow, by more than rounding.
    pub unstable: u32,
}

impl MapPoint {
    /// A point without an answer.
    pub const NONE: MapPoint = MapPoint { growth_rate: f64::NAN, frequency_hz: f64::NAN, unstable: 0 };

    /// The values of a point with these λ \[1/s\].
    pub fn of(eigenvalues: &[c64]) -> Self {
        let grows = |k: usize| {
            let z = eigenvalues[k];
            unstable(z) && z.re > rounding(eigenvalues, &Mat::new(), k)
        };
        let strongest = eigenvalues.iter().max_by(|a, b| a.re.total_cmp(&b.re));
        strongest.map_or(MapPoint::NONE, |z| MapPoint {
            growth_rate: z.re,
            frequency_hz: z.im / TAU,
            unstable: (0..eigenvalues.len()).filter(|k| grows(*k)).count() as u32,
        })
    }
}

/// Every point of the grid, the first parameter running fastest, handed to `record` piece by piece.
///
/// # Errors
/// [`Error::Io`](crate::error::Error::Io) at a point; those of `record`. Any other error of a point leaves that point blank.
pub fn map(
    problem: &dyn SweepProblem,
    axes: &[Axis; 2],
    record: &mut RecordPoints<MapPoint>,
    observer: &dyn Observer,
) -> Result<Filled<MapPoint>> {
    let solve = |k: usize| answer(problem, axes, k).map(|modes| MapPoint::of(&modes.eigenvalues));
    observer.begin("map", Some(points(axes) as u64));
    let filled = fill((points(axes), problem.at_once()), &solve, MapPoint::NONE, record, observer)?;
    observer.end();
    Ok(filled)
}
