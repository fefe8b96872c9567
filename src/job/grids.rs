//! The sweeps and maps of a case as grids of points that are independent of each other.

use crate::case::{Case, MapAnalysis, SweepAnalysis};
use crate::sweep::Axis;

/// The points of a sweep or of a map.
pub(super) struct Grid {
    /// Its table in the case: `sweep.NAME`, `map.NAME`.
    pub(super) name: String,
    /// The paths of the scalars that it varies.
    pub(super) paths: Vec<String>,
    /// Their values, those of the first running fastest.
    pub(super) axes: Vec<Axis>,
}

impl Grid {
    pub(super) fn of_sweep(name: &str, of: &SweepAnalysis) -> Self {
        let axis = Axis { from: of.from, to: of.to, points: of.points, log: of.log };
        Grid { name: format!("sweep.{name}"), paths: vec![of.parameter.clone()], axes: vec![axis] }
    }

    pub(super) fn of_map(name: &str, of: &MapAnalysis) -> Self {
        let axis = |k: usize| Axis { from: of.from[k], to: of.to[k], points: of.points[k], log: of.log[k] };
        Grid { name: format!("map.{name}"), paths: of.parameters.to_vec(), axes: [0, 1].map(axis).to_vec() }
    }

    /// The place at these shares of the way along the axes.
    pub(super) fn between(&self, shares: &[f64]) -> Vec<f64> {
        let along = self.axes.iter().zip(shares);
        along.map(|(axis, share)| axis.between(axis.from, axis.to, *share)).collect()
    }

    /// The places on which a reduced model is trained first.
    pub(super) fn training(&self) -> Vec<Vec<f64>> {
        match self.axes[..] {
            [_] => [0.0, 1.0, 0.5].iter().map(|share| self.between(&[*share])).collect(),
            _ => {
                let shares = [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [0.5, 0.5]];
                shares.iter().map(|shares| self.between(shares)).collect()
            }
        }
    }
}

/// All sweeps of the case, then all maps, by their names.
pub(super) fn grids(case: &Case) -> Vec<Grid> {
    let sweeps = case.sweep.iter().map(|(name, of)| Grid::of_sweep(name, of));
    sweeps.chain(case.map.iter().map(|(name, of)| Grid::of_map(name, of))).collect()
}
