//! The sweeps, maps and studies of uncertain scalars of a case as points that are independent of each other.

use crate::case::{Case, MapAnalysis, SweepAnalysis, UncertaintyAnalysis, VariedParameter};
use crate::sweep::{self, Axis, Block, blocks};
use crate::uncertainty::{Distribution, samples};

/// A study with more scalars than this starts its reduced model from samples: there are too many ends of ranges.
const SCALARS: usize = 8;

/// The analyses whose points several processes can share.
pub const SHARED: [&str; 2] = ["sweep", UNCERTAINTY];
/// The one whose studies are samples.
pub(super) const UNCERTAINTY: &str = "uncertainty";

/// The points of a sweep, of a map or of samples.
pub(super) struct Study {
    /// Its table in the case: `sweep.NAME`, `map.NAME`, `uncertainty.NAME`.
    pub(super) name: String,
    /// The paths of the scalars that it varies.
    pub(super) paths: Vec<String>,
    /// Their bounds.
    pub(super) bounds: Vec<[f64; 2]>,
    pub(super) points: Points,
}

/// Values of the scalars of a study.
pub(super) enum Points {
    /// The grid of these axes, the first running fastest.
    Grid(Vec<Axis>),
    /// Each by itself, and the places on which a reduced model is trained first.
    Samples { places: Vec<Vec<f64>>, training: Vec<Vec<f64>> },
}

impl Study {
    fn new<'a>(
        name: String,
        ranges: impl IntoIterator<Item = (&'a String, [f64; 2])>,
        points: Points,
    ) -> Self {
        let (paths, bounds) = ranges.into_iter().map(|(path, bounds)| (path.clone(), bounds)).unzip();
        Study { name, paths, bounds, points }
    }

    pub(super) fn of_sweep(name: &str, of: &SweepAnalysis) -> Self {
        let axis = Axis { from: of.from, to: of.to, points: of.points, log: of.log };
        let range = (&of.parameter, [of.from, of.to]);
        Study::new(format!("sweep.{name}"), [range], Points::Grid(vec![axis]))
    }

    pub(super) fn of_map(name: &str, of: &MapAnalysis) -> Self {
        let axis = |k: usize| Axis { from: of.from[k], to: of.to[k], points: of.points[k], log: of.log[k] };
        let ranges = [0, 1].map(|k| (&of.parameters[k], [of.from[k], of.to[k]]));
        Study::new(format!("map.{name}"), ranges, Points::Grid([0, 1].map(axis).to_vec()))
    }

    pub(super) fn of_samples(name: &str, of: &UncertaintyAnalysis) -> Self {
        let parameters: Vec<&VariedParameter> = of.parameter.values().collect();
        let distributions: Vec<Distribution> = parameters.iter().map(|p| p.distribution()).collect();
        let values = samples(&distributions, of.samples, of.sampling, of.seed as u64);
        // A parameter may have several scalars of one value.
        let place = |values: &Vec<f64>| -> Vec<f64> {
            let each = parameters.iter().zip(values);
            each.flat_map(|(parameter, value)| vec![*value; parameter.path.len()]).collect()
        };
        let middle: Vec<f64> = distributions.iter().map(|of| of.quantile(0.5)).collect();
        let mut training = vec![place(&middle)];
        for (j, of) in distributions.iter().enumerate().take_while(|_| distributions.len() <= SCALARS) {
            for end in of.between {
                let at = middle.iter().enumerate().map(|(k, own)| if k == j { end } else { *own });
                training.push(place(&at.collect()));
            }
        }
        let places: Vec<Vec<f64>> = values.iter().map(place).collect();
        if distributions.len() > SCALARS {
            training.extend(places.iter().take(2 * SCALARS).cloned());
        }
        let ranges = parameters.iter().flat_map(|of| of.path.iter().map(|path| (path, of.between)));
        Study::new(format!("uncertainty.{name}"), ranges, Points::Samples { places, training })
    }

    /// The axes of a grid; none of samples.
    pub(super) fn axes(&self) -> &[Axis] {
        match &self.points {
            Points::Grid(axes) => axes,
            Points::Samples { .. } => &[],
        }
    }

    /// The values of the scalars at point `k`.
    pub(super) fn place(&self, k: usize) -> Vec<f64> {
        match &self.points {
            Points::Grid(axes) => sweep::place(axes, k),
            Points::Samples { places, .. } => places[k].clone(),
        }
    }

    /// Blocks that cover it: `most`, or fewer where it cannot be cut into so many.
    pub(super) fn blocks(&self, most: usize) -> Vec<Block> {
        match &self.points {
            Points::Grid(axes) => blocks(axes, most),
            Points::Samples { places, .. } => {
                let (all, blocks) = (places.len(), most.min(places.len()));
                (0..blocks).map(|k| Block(vec![[all * k / blocks, all * (k + 1) / blocks - 1]])).collect()
            }
        }
    }

    /// The points of a block by their numbers.
    pub(super) fn points_of(&self, block: &Block) -> Vec<usize> {
        match &self.points {
            Points::Grid(axes) => block.points(axes),
            Points::Samples { .. } => (block.0[0][0]..=block.0[0][1]).collect(),
        }
    }

    /// The places on which a reduced model is trained first.
    pub(super) fn training(&self) -> Vec<Vec<f64>> {
        match &self.points {
            Points::Grid(axes) => {
                let shares: &[&[f64]] = match axes[..] {
                    [_] => &[&[0.0], &[1.0], &[0.5]],
                    _ => &[&[0.0, 0.0], &[1.0, 1.0], &[0.0, 1.0], &[1.0, 0.0], &[0.5, 0.5]],
                };
                shares.iter().map(|shares| between(axes, shares)).collect()
            }
            Points::Samples { training, .. } => training.clone(),
        }
    }

    /// Places inside a map, at which its reduced model is measured on the full order.
    pub(super) fn inside(&self) -> Vec<Vec<f64>> {
        let shares: &[[f64; 2]] = if self.axes().len() == 2 { &[[0.3, 0.7], [0.75, 0.2]] } else { &[] };
        shares.iter().map(|shares| between(self.axes(), shares)).collect()
    }
}

/// The place at these shares of the way along axes.
fn between(axes: &[Axis], shares: &[f64]) -> Vec<f64> {
    axes.iter().zip(shares).map(|(axis, share)| axis.between(axis.from, axis.to, *share)).collect()
}

/// The studies of the case that the analysis of this name of [`SHARED`] takes, in their order.
pub(super) fn studies(case: &Case, analysis: &str) -> Vec<Study> {
    if analysis == UNCERTAINTY {
        return case.uncertainty.iter().map(|(name, of)| Study::of_samples(name, of)).collect();
    }
    let sweeps = case.sweep.iter().map(|(name, of)| Study::of_sweep(name, of));
    sweeps.chain(case.map.iter().map(|(name, of)| Study::of_map(name, of))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_cut_into_blocks_that_cover_them_once() {
        let case = format!(
            "{}\n[uncertainty.all]\nsamples = 25\n[uncertainty.all.parameter.springs]\n\
             path = [\"spring.k1.stiffness\", \"spring.k2.stiffness\"]\nbetween = [1, 2]\n\
             [uncertainty.all.parameter.mu]\npath = \"contact.belt.friction.mu0\"\nbetween = [1, 2]\n",
            include_str!("../../validation/two-dof/case.toml")
        );
        let case = Case::parse("case", &case, ".".into()).unwrap();
        let study = &studies(&case, "uncertainty")[0];
        for most in [1, 2, 7, 25, 40] {
            let blocks = study.blocks(most);
            assert_eq!(blocks.len(), most.min(25));
            let all: Vec<usize> = blocks.iter().flat_map(|block| study.points_of(block)).collect();
            assert_eq!(all, (0..25).collect::<Vec<_>>());
        }
        assert_eq!(study.training().len(), 5);
        // Friction, and two springs of one stiffness.
        let place = study.place(24);
        assert!(place.len() == 3 && place[1] == place[2] && place.iter().all(|x| (1.0..=2.0).contains(x)));
    }
}
