//! Where the contacts act at one moment.

use super::model::TransientModel;
use super::track::Shares;
use crate::linalg::SparseVector;
use crate::linalg::multivector::gram;
use faer::{ColRef, Mat, MatMut, MatRef};
use std::ops::Range;

/// D(t): the directions in which contacts and imported terms act, as mixes of the constant columns P of the model; and how
/// close the points are.
#[derive(Debug, Clone)]
pub(super) struct TravellingInterface {
    /// For each direction its columns of P with their shares.
    pub(super) mixes: Vec<Shares>,
    /// The gap of each point \[m\].
    pub(super) gaps: Vec<f64>,
    /// The approach of each pair \[m\]: approach − gap is δ at gᵀu = 0.
    pub(super) approaches: Vec<f64>,
    /// ∫V dt \[m\] of each pair since t = 0.
    pub(super) travel: Vec<f64>,
}

impl TravellingInterface {
    /// That of a model at t = 0.
    pub(super) fn new(model: &TransientModel<'_>) -> Self {
        let mut at = TravellingInterface {
            mixes: vec![[(0, 0.0); 4]; model.n_directions()],
            gaps: vec![0.0; model.points.len()],
            approaches: model.approaches.clone(),
            travel: vec![0.0; model.velocities.len()],
        };
        at.locate(model, 0.0);
        at
    }

    /// Where the contacts act at a time \[s\].
    pub(super) fn locate(&mut self, model: &TransientModel<'_>, time: f64) {
        let travelled =
            model.velocities.iter().zip(&model.profiles).map(|(v, profile)| v * profile.integral(time));
        self.travel.iter_mut().zip(travelled).for_each(|(at, travel)| *at = travel);
        // The first column of the pair, and the first of its points.
        let (mut column, mut first) = (0, 0);
        for (pair, track) in model.tracks.iter().enumerate() {
            let count = model.points[first..].iter().take_while(|point| point.pair == pair).count();
            let shares = track.map(|track| track.shares(self.travel[pair]));
            if let Some(loading) = &model.loadings[pair]
                && model.held_load(pair, time).is_none()
            {
                self.approaches[pair] = loading.approach(time);
            }
            for p in 0..count {
                let point = &model.points[first + p];
                let mut gap = point.gap;
                if let (Some(track), Some(shares)) = (track, &shares) {
                    gap = shares.iter().map(|(station, share)| share * track.stations[*station][p].gap).sum();
                }
                self.gaps[first + p] = gap;
                for c in 0..3 {
                    self.mixes[3 * (first + p) + c] = match &shares {
                        Some(shares) => {
                            shares.map(|(station, share)| (column + 3 * (station * count + p) + c, share))
                        }
                        None => alone(column + 3 * p + c),
                    };
                }
            }
            first += count;
            column += 3 * count * track.map_or(1, |track| track.stations.len());
        }
        for (k, mix) in self.mixes[3 * first..].iter_mut().enumerate() {
            *mix = alone(column + k);
        }
    }

    /// DᵀX of every column.
    pub(super) fn motions(&self, model: &TransientModel<'_>, x: MatRef<'_, f64>, mut out: MatMut<'_, f64>) {
        let lifted = model.lifted(x);
        let acted = lifted.as_ref().map_or(x, Mat::as_ref);
        let points = 3 * model.points.len();
        for k in 0..x.ncols() {
            let [own, acted] = [x, acted].map(|x| slice(x.col(k)));
            for (index, mix) in self.mixes.iter().enumerate() {
                let of = if index < points { acted } else { own };
                out[(index, k)] =
                    parts(mix).map(|(column, share)| share * model.columns[column].dot(of)).sum();
            }
        }
    }

    /// x += factor · D r.
    pub(super) fn add_reactions(&self, model: &TransientModel<'_>, factor: f64, r: &[f64], x: &mut [f64]) {
        let add = |range: Range<usize>, x: &mut [f64]| {
            for (mix, r) in self.mixes[range.clone()].iter().zip(&r[range]).filter(|(_, r)| **r != 0.0) {
                parts(mix).for_each(|(column, share)| model.columns[column].add_to(factor * share * r, x));
            }
        };
        let points = 3 * model.points.len();
        let Some(basis) = model.basis else { return add(0..r.len(), x) };
        let mut acting = Mat::zeros(basis.nrows(), 1);
        add(0..points, acting.col_as_slice_mut(0));
        add(points..r.len(), x);
        let seen = gram(basis.as_ref(), acting.as_ref());
        x.iter_mut().zip(seen.col_as_slice(0)).for_each(|(x, force)| *x += force);
    }

    /// A direction as it is now.
    pub(super) fn direction(&self, model: &TransientModel<'_>, index: usize) -> SparseVector {
        let entries = parts(&self.mixes[index])
            .flat_map(|(column, share)| model.columns[column].iter().map(move |(i, v)| (i, share * v)));
        SparseVector::from_entries(entries)
    }
}

/// A column of a matrix.
fn slice(x: ColRef<'_, f64>) -> &[f64] {
    x.try_as_col_major().expect("the columns of a matrix are in one piece").as_slice()
}

/// A vector as a matrix of one column.
pub(super) fn column(x: &[f64]) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(x, x.len(), 1)
}

/// One column as it is.
fn alone(column: usize) -> [(usize, f64); 4] {
    [(column, 1.0), (column, 0.0), (column, 0.0), (column, 0.0)]
}

/// The columns of a mix that have a share.
pub(super) fn parts(mix: &Shares) -> impl Iterator<Item = (usize, f64)> + '_ {
    mix.iter().copied().filter(|(_, share)| *share != 0.0)
}
