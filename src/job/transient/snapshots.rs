//! The motion of all nodes at regular times.

use crate::reduction::Reduced;
use crate::results::{Fields, Geometry, NodalField};
use crate::structure::DofMap;
use crate::transient::State;

/// How often and of what snapshots are taken.
#[derive(Clone, Copy)]
pub(super) struct Snapshots<'a> {
    /// Steps between two.
    pub(super) every: usize,
    pub(super) geometry: &'a Geometry,
    pub(super) dofs: &'a DofMap,
    /// The way back from a reduced model.
    pub(super) reduced: Option<&'a Reduced>,
    /// u of steady sliding.
    pub(super) origin: &'a [f64],
}

impl<'a> Snapshots<'a> {
    /// Fields to be written of a run of so many steps of which so many were done, the start included.
    pub(super) fn fields(&self, steps: usize, done: usize, step: f64) -> Fields<'a> {
        let every = self.every as f64 * step;
        Fields {
            geometry: self.geometry,
            every,
            count: steps / self.every + 1,
            done: done.div_ceil(self.every),
        }
    }

    /// The displacement of every node from steady sliding, and its velocity.
    pub(super) fn take(&self, state: &State) -> [NodalField<f64>; 2] {
        let [u, v] = [0, 1].map(|k| state.motion.col_as_slice(k));
        let moved: Vec<f64> = u.iter().zip(self.origin).map(|(u, origin)| u - origin).collect();
        [&moved[..], v].map(|x| self.of_all(x))
    }

    /// A vector in the coordinates of the model, at every node.
    pub(super) fn of_all(&self, x: &[f64]) -> NodalField<f64> {
        match self.reduced {
            Some(reduced) => self.dofs.expand(&reduced.expand(x)),
            None => self.dofs.expand(x),
        }
    }
}
