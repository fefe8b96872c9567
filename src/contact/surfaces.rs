//! Two bodies that may touch.

use super::sliding::Sliding;
use crate::mesh::Cell;
use crate::structure::Part;

/// Two plates or solids that may touch.
///
/// The *counter-body* (slider) offers the faces that look towards the body, of a plate half its thickness from its mid-surface;
/// **n** is the outward normal there. The *body* (disc) touches with nodes of its edge, with the nodes of the faces of a plate, or with the faces of a solid.
#[derive(Debug, Clone, Copy)]
pub struct Surfaces<'a> {
    /// The name of the pair, for faults.
    pub name: &'a str,
    /// Coordinates of all nodes \[m\].
    pub nodes: &'a [[f64; 3]],
    /// The part that touches.
    pub body: &'a Part,
    /// What of it may touch, and how.
    pub side: ContactSide<'a>,
    /// The part whose faces are touched.
    pub counter: &'a Part,
    /// Those faces: cells of a plate, faces of a solid seen from outside counter-clockwise.
    pub faces: &'a [Cell],
    /// How the counter-body slides past the body; the part of its direction across n is t₁.
    pub sliding: Sliding,
    /// How many of the points are kept.
    pub patch: ContactPatch,
    /// How far the counter-body travels in all along t₁ \[m\], half of it either way; zero for none.
    pub stroke: f64,
}

impl<'a> Surfaces<'a> {
    /// The pair `name` of a body and a plate, of whose contact points those within 1 mm are kept, without travel.
    pub fn new(
        name: &'a str,
        nodes: &'a [[f64; 3]],
        [body, counter]: [&'a Part; 2],
        side: ContactSide<'a>,
        sliding: Sliding,
    ) -> Self {
        let patch = ContactPatch::Reach(1e-3);
        Surfaces { name, nodes, body, side, counter, faces: &counter.cells, sliding, patch, stroke: 0.0 }
    }
}

/// The part of the body that touches.
#[derive(Debug, Clone, Copy)]
pub enum ContactSide<'a> {
    /// Lines on the edge of the plate (a rim). Every node carries two points, at ±h/2 along the plate's normal: the
    /// two-point Lobatto rule over the thickness, each with half the node's tributary length \[m\].
    Edge(&'a [[usize; 2]]),
    /// Lines on the edge of the plate, with one point a node at the middle of the thickness: the line contact of an
    /// infinitely thin rim, which knows no moment about the line.
    Middle(&'a [[usize; 2]]),
    /// Faces of a solid as seen from outside counter-clockwise (a pad): three points of a triangle and 2 × 2 of a
    /// quadrilateral, three of what is partly beyond the counter-faces, with the area that each stands for \[m²\]; where one point is wanted, the nearest node. Faces of a plate: one point a node,
    /// h/2 towards the counter-body, with the node's tributary area \[m²\].
    Face(&'a [Cell]),
}

/// Which points are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactPatch {
    /// Those whose gap is at most this \[m\].
    Reach(f64),
    /// The node nearest to the counter-body only, or several that are equally near, of weight 1 in all (shared equally by
    /// their points), for a contact stiffness in N/m; an error when it is farther than this \[m\]. A face touches with its nodes, too.
    Nearest(f64),
}
