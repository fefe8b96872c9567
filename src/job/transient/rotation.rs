//! How far the cells of solids turn in motion.

use crate::structure::{Model, Part};
use crate::transient::Checkpoint;
use nalgebra::{Matrix3, Vector3};

/// The rotation \[rad\] up to which displacements are linear: the strain ½φ² that a rotation φ makes in linear theory is 0.5 % there.
const LINEAR: f64 = 0.1;

/// The largest rotations of the solids of a run.
pub(super) struct Rotations<'a> {
    solids: Vec<Turning<'a>>,
}

struct Turning<'a> {
    part: &'a Part,
    cells: Vec<CellArms>,
    /// max |φ| so far \[rad\].
    largest: f64,
}

/// A cell: its nodes with their places from its middle, and the inverse of Σ (r² I − r rᵀ).
struct CellArms {
    arms: Vec<(usize, Vector3<f64>)>,
    inverse: Matrix3<f64>,
}

impl<'a> Rotations<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let solids = model.parts.iter().filter(|part| part.kind.dimension() == 3);
        let turning = |part: &'a Part| Turning {
            part,
            cells: part.cells.iter().filter_map(|cell| CellArms::new(cell.nodes(), &model.nodes)).collect(),
            largest: 0.0,
        };
        Rotations { solids: solids.map(turning).collect() }
    }

    /// Whether there is nothing to look at.
    pub(super) fn are_none(&self) -> bool {
        self.solids.is_empty()
    }

    /// Looks at the displacement of all nodes.
    pub(super) fn take(&mut self, moved: &[[f64; 6]]) {
        for solid in &mut self.solids {
            let angles = solid.cells.iter().map(|cell| cell.rotation(moved).norm());
            solid.largest = angles.fold(solid.largest, f64::max);
        }
    }

    /// Adds what the warnings depend on.
    pub(super) fn put(&self, checkpoint: &mut Checkpoint) {
        let largest: Vec<f64> = self.solids.iter().map(|solid| solid.largest).collect();
        checkpoint.put("rotations", &largest);
    }

    /// Goes on from what was put away.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) -> crate::error::Result<()> {
        let mut largest = vec![0.0; self.solids.len()];
        checkpoint.get("rotations", &mut largest)?;
        self.solids.iter_mut().zip(largest).for_each(|(solid, largest)| solid.largest = largest);
        Ok(())
    }

    /// Solids that turn by more than the model can mean.
    pub(super) fn warnings(&self) -> Vec<String> {
        let words = |solid: &Turning| {
            format!(
                "In motion the solid {} turns by {:.2} rad: displacements are linear here, which rotations are up to about {LINEAR} rad. \
                 Amplitudes of this run have no meaning, only its beginning has.",
                solid.part.name, solid.largest
            )
        };
        self.solids.iter().filter(|solid| solid.largest > LINEAR).map(words).collect()
    }
}

impl CellArms {
    /// `None` of a cell without volume.
    fn new(nodes: &[usize], all: &[[f64; 3]]) -> Option<Self> {
        let at = |node: usize| Vector3::from(all[node]);
        let middle = nodes.iter().map(|node| at(*node)).sum::<Vector3<f64>>() / nodes.len() as f64;
        let arms: Vec<_> = nodes.iter().map(|node| (*node, at(*node) - middle)).collect();
        let inertia = arms.iter().map(|(_, r)| Matrix3::identity() * r.norm_squared() - r * r.transpose());
        let inverse = inertia.sum::<Matrix3<f64>>().try_inverse()?;
        Some(CellArms { arms, inverse })
    }

    /// φ of u = a + φ × r by least squares.
    fn rotation(&self, moved: &[[f64; 6]]) -> Vector3<f64> {
        let turned =
            |(node, r): &(usize, Vector3<f64>)| r.cross(&Vector3::from_column_slice(&moved[*node][..3]));
        self.inverse * self.arms.iter().map(turned).sum::<Vector3<f64>>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Origin::*, within};

    /// A cell that is moved, turned and stretched along its sides.
    #[test]
    fn the_rotation_of_a_cell_is_that_of_its_motion() {
        let nodes: Vec<[f64; 3]> = (0..8)
            .map(|k| [f64::from(k & 1) * 0.02, f64::from(k >> 1 & 1) * 0.01, f64::from(k >> 2) * 0.005])
            .collect();
        let cell = CellArms::new(&(0..8).collect::<Vec<_>>(), &nodes).unwrap();
        let turned = Vector3::new(0.03, -0.2, 0.1);
        let moved: Vec<[f64; 6]> = nodes
            .iter()
            .map(|x| {
                let x = Vector3::from(*x);
                let u = Vector3::new(1.0, 2.0, 3.0)
                    + turned.cross(&x)
                    + Vector3::new(0.01 * x[0], -0.02 * x[1], 0.03 * x[2]);
                [u[0], u[1], u[2], 0.0, 0.0, 0.0]
            })
            .collect();
        assert!(within((cell.rotation(&moved) - turned).norm(), 1e-11, RoundOff));
        let flat: Vec<[f64; 3]> = nodes.iter().map(|x| [x[0], 0.0, 0.0]).collect();
        assert!(CellArms::new(&(0..8).collect::<Vec<_>>(), &flat).is_none());
    }
}
