//! Faces of bodies in contact with the contact points on them, for pictures and ParaView.

use crate::mesh::Cell;

/// Connected faces of the body of a contact pair that carry contact points, such as those of one of two pads.
#[derive(Debug, Clone)]
pub struct ContactSurface {
    /// The name of the pair.
    pub pair: String,
    /// The smallest region of the mesh with all of it, numbered where a pair has several surfaces there.
    pub name: String,
    /// Its faces, of a solid as seen from outside counter-clockwise, on the nodes of [`super::Geometry`].
    pub faces: Vec<ContactFace>,
}

/// One of these faces.
#[derive(Debug, Clone)]
pub struct ContactFace {
    /// The face.
    pub cell: Cell,
    /// Its contact points, indices into [`super::SteadyResult::points`]; one at a node is on every face there.
    pub points: Vec<usize>,
    /// The velocity of the counter-body relative to the body at the middle of these points \[m/s\].
    pub slides: [f64; 3],
}
