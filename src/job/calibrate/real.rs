//! Levels of real modes: the same ones at every value of the parameters, and their slopes.

use super::super::modes::{identify, labels, part_assembled};
use super::super::prepared::Prepared;
use super::super::sensors::Sensors;
use super::follow::{Picks, most_alike};
use super::neighbours::Change;
use super::shapes::{Observation, ObservedModes};
use crate::calibration::Level;
use crate::error::Result;
use crate::linalg::multivector::gram;
use crate::linalg::sparse::times;
use crate::modal::{self, DiscModeName, ModesWanted, RealModes, levels};
use crate::structure::Assembled;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Name of a mode: the part that moves most, and its disc name.
type Name = (Option<String>, Option<DiscModeName>);

/// The real modes of one analysis of the case at some values of the parameters.
pub struct Solved {
    assembled: Arc<Assembled>,
    modes: RealModes,
    /// Factor on computed frequencies before they are compared with measured ones.
    pub scale: f64,
    /// Name and label of every mode; none where shapes identify the modes.
    names: Option<(Vec<Name>, Vec<String>)>,
    observation: Option<Observation>,
}

impl Solved {
    /// Computes all modes of the analysis `name` below a frequency, without their names where they have the degrees of
    /// freedom of `like`; the `sensors`, if there are any, will measure them.
    pub fn new(
        prepared: &Prepared,
        (name, below_hz): (&str, f64),
        sensors: Option<Sensors>,
        like: Option<&Solved>,
    ) -> Result<Solved> {
        let (model, assembled) = part_assembled(prepared, name)?;
        let (modes, factor) = modal::compute(&assembled.structure, ModesWanted::BelowHz(below_hz), &())?;
        let scale = prepared.case.modes[name].frequency_scale;
        let observation = sensors.map(|sensors| Observation {
            forms: sensors.forms(&prepared.model.nodes, &assembled.dofs),
            factor,
        });
        let mut solved = Solved { assembled, modes, scale, names: None, observation };
        if like.is_none_or(|like| like.n_dofs() != solved.n_dofs()) {
            let identities = identify(prepared, &solved.modes, (&model, &solved.assembled));
            let labels = labels(&identities, &solved.modes);
            solved.names = Some((identities, labels));
        }
        Ok(solved)
    }

    /// The modes as the test sees them, if it measured shapes.
    pub fn seen(&self) -> Option<ObservedModes<'_>> {
        let observation = self.observation.as_ref()?;
        Some(ObservedModes { structure: &self.assembled.structure, modes: &self.modes, observation })
    }

    fn n_dofs(&self) -> usize {
        self.assembled.dofs.n_dofs()
    }

    fn name(&self, k: usize) -> Option<&Name> {
        self.names.as_ref().map(|(names, _)| &names[k])
    }

    /// The modes as levels, those of rigid bodies left out.
    pub fn levels(&self) -> Picks {
        let rest = self.modes.rigid_bodies..self.modes.len();
        let hz: Vec<f64> = rest.clone().map(|k| self.modes.frequency_hz(k)).collect();
        let names: Vec<_> = rest.clone().map(|k| self.name(k).and_then(|name| name.1)).collect();
        levels(&hz, &names).into_iter().map(|level| level.map(|k| rest.start + k).collect()).collect()
    }

    /// Name of each of `levels`.
    pub fn labels(&self, levels: &Picks) -> Vec<String> {
        let label = |k: usize| match &self.names {
            Some((_, labels)) => labels[k].clone(),
            None => format!("{:.0} Hz", self.modes.frequency_hz(k)),
        };
        levels.iter().map(|level| label(level[0])).collect()
    }

    /// `levels` of `self` among the modes of `other`, an empty one where it is not found, and whether that is sure.
    ///
    /// By shape where both have the same degrees of freedom: the modes of `other` that have the largest share of themselves,
    /// Σ (φᵢᵀMφ)²/φᵀMφ, in the level. By name, and the order among equal names, where the mesh is another.
    pub fn follow(&self, levels: &Picks, other: &Solved) -> (Picks, bool) {
        if self.n_dofs() != other.n_dofs() {
            return (self.follow_by_name(levels, other), true);
        }
        let (here, there) = (&self.modes, &other.modes);
        let mass = times(&self.assembled.structure.mass, there.shapes.as_ref());
        let products = gram(here.shapes.as_ref(), mass.as_ref());
        let size = |k: usize| there.shapes.col(k).iter().zip(mass.col(k).iter()).map(|(a, b)| a * b).sum();
        let sizes: Vec<f64> = (0..there.len()).map(size).collect();
        let share = |level: usize, k: usize| -> f64 {
            levels[level].iter().map(|i| products[(*i, k)].powi(2)).sum::<f64>() / sizes[k]
        };
        most_alike(levels, there.rigid_bodies..there.len(), share)
    }

    fn follow_by_name(&self, levels: &Picks, other: &Solved) -> Picks {
        let of_name = |of: &Solved, wanted: &Name| -> Vec<usize> {
            (of.modes.rigid_bodies..of.modes.len()).filter(|k| of.name(*k) == Some(wanted)).collect()
        };
        let there = |k: &usize| {
            let wanted = self.name(*k)?;
            let order = of_name(self, wanted).iter().position(|j| j == k)?;
            of_name(other, wanted).get(order).copied()
        };
        let level = |level: &Vec<usize>| level.iter().map(there).collect::<Option<_>>().unwrap_or_default();
        levels.iter().map(level).collect()
    }

    fn omega2(&self, k: usize) -> f64 {
        self.modes.eigenvalues[k]
    }

    /// The frequency of a level, √(mean ω²)/2π times the scale of the analysis, and its slopes by the `changes` of K and M
    /// with each unknown; `None` for an unknown that K and M do not depend on.
    ///
    /// On the modes Φ of the level, ΦᵀMΦ = 1, the matrix Φᵀ(∂K − ω²∂M)Φ has the derivatives of ω² of its modes as its
    /// eigenvalues (Fox and Kapoor, AIAA J. 6 (1968) 2426; for double modes Ojalvo, AIAA J. 26 (1988) 361). Their mean is what
    /// the level feels, half of their distance is its split.
    pub fn level(&self, level: &[usize], changes: &[Option<Change>]) -> Level {
        let mean = level.iter().map(|k| self.omega2(*k)).sum::<f64>() / level.len() as f64;
        let of = |change: &Option<Change>| -> [f64; 2] {
            let Some(change) = change else { return [0.0; 2] };
            let shapes = self.modes.shapes.as_ref();
            let column = |k: usize| shapes.subcols(k, 1);
            let form = |i: usize, j: usize| {
                let s = if i == j { self.omega2(level[i]) } else { mean };
                let (a, b) = (column(level[i]), column(level[j]));
                let on = |matrix| gram(a, times(matrix, b).as_ref())[(0, 0)];
                on(&change.stiffness) - s * on(&change.mass)
            };
            let diagonal: Vec<f64> = (0..level.len()).map(|i| form(i, i)).collect();
            let rise = diagonal.iter().sum::<f64>() / level.len() as f64;
            let split = match diagonal[..] {
                [a, b] => (0.5 * (a - b)).hypot(form(0, 1)),
                _ => 0.0,
            };
            [rise, split].map(|rate| 0.5 * rate / mean)
        };
        let rates: Vec<[f64; 2]> = changes.iter().map(of).collect();
        Level {
            frequency_hz: self.scale * mean.max(0.0).sqrt() / TAU,
            slope: rates.iter().map(|r| r[0]).collect(),
            split: rates.iter().map(|r| r[1]).collect(),
            span: None,
        }
    }
}
