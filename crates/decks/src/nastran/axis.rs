//! A direction beside the line of a beam or a spring: a vector, or the way to a grid point.

use super::fields::{Fields, real};
use super::model::Model;
use crate::deck::Place;
use stridor_mesh::quality::minus;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Axis {
    /// In the system of the displacements of the first node.
    Vector([f64; 3]),
    Point(u64),
}

impl Axis {
    /// That in fields 5 to 7: one whole number, or three real ones; none where they are blank.
    pub fn read(fields: &mut Fields) -> Option<Option<Axis>> {
        let first = fields.word(5);
        let alone = fields.is_blank(6) && fields.is_blank(7);
        if alone && first.is_empty() {
            return Some(None);
        }
        if alone && !first.contains(['.', '-']) && real(first) != Some(0.0) {
            return Some(Some(Axis::Point(fields.id(5)?)));
        }
        Some(Some(Axis::Vector(fields.vector(5)?)))
    }

    /// The direction at the first node of what is called so.
    pub fn direction(&self, node: usize, what: &str, place: Place, model: &mut Model) -> Option<[f64; 3]> {
        let at = model.position(node);
        match self {
            Axis::Vector(components) => Some(model.displacements(node).vector(*components, at)),
            Axis::Point(id) => {
                let other = model.node(*id, what, place)?;
                Some(minus(model.position(other), at))
            }
        }
    }
}
