//! Points of a pair that may be kept, and the places of the body that they are means of.

use super::projection::{Foot, Vector, subtract};
use super::surfaces::Surfaces;
use crate::mesh::Cell;
use crate::structure::Moved;

/// Least cosine of the angle between the normals of the body and of the counter-face, turned against each other, where faces may touch: 60°.
pub(super) const FACING: f64 = 0.5;

/// What of the body moves a place.
#[derive(Clone, Copy)]
pub(super) enum On<'a> {
    Node(usize),
    /// A face at its reference coordinates.
    Face(&'a Cell, [f64; 3]),
}

/// A place of the body and its foot on the counter-face.
pub(super) struct Sample<'a> {
    pub(super) on: On<'a>,
    /// From the place to the point, as from the mid-surface of a plate to its face.
    pub(super) offset: Vector,
    pub(super) position: Vector,
    /// From the counter-face; over the tangent plane at its edge when the point stands beside it \[m\].
    pub(super) gap: f64,
    pub(super) foot: Foot,
}

/// A contact point: gap and directions are the sums of those of some samples, each times its share; the shares add up to 1.
pub(super) struct Point {
    pub(super) position: Vector,
    pub(super) weight: f64,
    pub(super) shares: Vec<f64>,
}

/// Points that may be kept: one of a node, those of one face of a solid.
pub(super) struct Candidate<'a> {
    pub(super) samples: Vec<Sample<'a>>,
    pub(super) points: Vec<Point>,
}

impl Candidate<'_> {
    /// The node of a point of a node.
    pub(super) fn node(&self) -> Option<usize> {
        match self.samples[..] {
            [Sample { on: On::Node(node), .. }] => Some(node),
            _ => None,
        }
    }
}

impl Sample<'_> {
    /// The place on the body.
    pub(super) fn place(&self) -> Vector {
        subtract(self.position, self.offset)
    }

    /// The displacement of the place on the body.
    pub(super) fn moved(&self, surfaces: &Surfaces<'_>) -> Vec<Moved> {
        match self.on {
            On::Node(node) => {
                (0..6).map(|k| (node, k, std::array::from_fn(|i| f64::from(u8::from(i == k))))).collect()
            }
            On::Face(face, at) => surfaces.body.displacement_at(surfaces.nodes, face, at),
        }
    }
}
