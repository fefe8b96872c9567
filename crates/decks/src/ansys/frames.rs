//! Unit vectors: of three points, and of nodes that are turned.

use super::model::{Model, turned};
use crate::deck::Frame;

/// a − b.
pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// a × b.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The direction of a vector, if it has one.
pub(super) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    (size > 0.0 && size.is_finite()).then(|| a.map(|x| x / size))
}

/// x toward the second point, y toward the third one.
pub(super) fn axes_of(origin: [f64; 3], x: [f64; 3], y: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let x = unit(minus(x, origin))?;
    let z = unit(cross(x, minus(y, origin)))?;
    Some([x, cross(z, x), z])
}

impl Model {
    /// The frame of the degrees of freedom of a node.
    pub fn frame(&self, node: u64) -> Frame {
        match self.angles.get(&node) {
            None => Frame::Global,
            Some(angles) => Frame::Turned(turned(*angles)),
        }
    }

    /// A vector in the frame of a node, in x y z.
    pub fn in_global(&self, node: u64, own: [f64; 3]) -> [f64; 3] {
        match self.frame(node) {
            Frame::Turned(axes) => std::array::from_fn(|k| (0..3).map(|i| own[i] * axes[i][k]).sum()),
            _ => own,
        }
    }
}
