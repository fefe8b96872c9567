//! *TRANSFORM: directions in which the degrees of freedom of a node count.

use super::reader::{Found, Reader};
use crate::deck::Frame;
use crate::ledger::Weight;

impl Reader {
    /// *TRANSFORM: two points of a frame for the degrees of freedom of a set.
    pub fn transform(&mut self, space: usize, found: Found<'_>) {
        let Some(name) = found.option("NSET") else {
            self.files.fault(found.place(), "*TRANSFORM without a set", "*TRANSFORM, NSET=…");
            return;
        };
        let nodes = self.nodes_of(space, name, found.place()).unwrap_or_default();
        let Some(row) = found.rows().next() else {
            self.files.fault(found.place(), "*TRANSFORM without data", "two points");
            return;
        };
        let Some([ax, ay, az, bx, by, bz]) = self.numbers::<6>(&row, 0) else { return };
        let placement = self.spaces[space].placement;
        let turn = |axis: [f64; 3]| placement.map_or(axis, |placement| placement.turn(axis));
        let place = |point: [f64; 3]| placement.map_or(point, |placement| placement.place(point));
        let axis = [bx - ax, by - ay, bz - az];
        let frame = match found.option("TYPE").unwrap_or("R").to_uppercase().as_str() {
            "C" if unit(axis).is_some() => Some(Frame::Cylindrical([place([ax, ay, az]), turn(axis)])),
            "C" | "S" => None,
            _ => turned([turn([ax, ay, az]), turn([bx, by, bz])]).map(Frame::Turned),
        };
        let Some(frame) = frame else {
            let why = "a frame on a sphere, or of points in one line, is not read";
            self.deck.ledger.note(Weight::Matters, "*TRANSFORM", why, found.place());
            return;
        };
        let number = self.frames.len();
        self.frames.push(frame);
        if let Frame::Cylindrical([point, axis]) = frame
            && nodes.iter().any(|node| radial(self.deck.nodes[*node].position, point, axis).is_none())
        {
            let why = "the directions of nodes on the axis are those of the coordinates";
            self.deck.ledger.note(Weight::Perhaps, "*TRANSFORM, TYPE=C", why, found.place());
        }
        self.frame_of.extend(nodes.into_iter().map(|node| (node, number)));
    }

    /// The directions of the degrees of freedom 1, 2 and 3 of a node, and of 4, 5 and 6; none where they are those of the coordinates.
    pub fn directions_at(&self, node: usize) -> Option<[[f64; 3]; 3]> {
        match self.frames[*self.frame_of.get(&node)?] {
            Frame::Global => None,
            Frame::Turned(axes) => Some(axes),
            Frame::Cylindrical([point, axis]) => {
                let axis = unit(axis)?;
                let radial = radial(self.deck.nodes[node].position, point, axis)?;
                Some([radial, cross(axis, radial), axis])
            }
        }
    }
}

/// The unit vector from an axis to a point, across the axis; none on the axis.
fn radial(position: [f64; 3], point: [f64; 3], axis: [f64; 3]) -> Option<[f64; 3]> {
    let axis = unit(axis)?;
    let from: [f64; 3] = std::array::from_fn(|k| position[k] - point[k]);
    let along: f64 = (0..3).map(|k| from[k] * axis[k]).sum();
    unit(std::array::from_fn(|k| from[k] - along * axis[k]))
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

pub(super) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

/// Unit vectors: the first along a, the third across the plane of a and b; none where these are in one line.
pub(super) fn turned([a, b]: [[f64; 3]; 2]) -> Option<[[f64; 3]; 3]> {
    let first = unit(a)?;
    let third = unit(cross(first, unit(b)?))?;
    Some([first, cross(third, first), third])
}

/// R = I cos α + (1 − cos α) n nᵀ + sin α n×: the rotation by α about a unit vector n.
pub(super) fn rotation(n: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = angle.sin_cos();
    let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let one = if i == j { cos } else { 0.0 };
            one + (1.0 - cos) * n[i] * n[j] + sin * cross[i][j]
        })
    })
}
