//! Kinds of cells in universal files, dataset 2412.

use super::CellKind::{self, *};

/// A kind in a universal file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UniversalKind {
    /// FE descriptor.
    pub descriptor: u32,
    /// Nodes in the order of the file: along the edges of each layer, corners and the middles between them in turn.
    pub order: &'static [u8],
}

impl CellKind {
    /// Its kind in universal files (SDRC, *Universal File Datasets Summary*): beams, thin shells, solids. Nodes in the middle of faces and
    /// cells are left out; pyramids are bricks of which one face is a point, points are none.
    pub fn universal(self) -> Option<UniversalKind> {
        let (descriptor, order): (u32, &'static [u8]) = match self {
            Point1 => return None,
            Line2 => (21, &[0, 1]),
            Line3 => (24, &[0, 2, 1]),
            Triangle3 => (91, &[0, 1, 2]),
            Triangle6 => (92, &[0, 3, 1, 4, 2, 5]),
            Quadrilateral4 => (94, &[0, 1, 2, 3]),
            Quadrilateral8 | Quadrilateral9 => (95, &[0, 4, 1, 5, 2, 6, 3, 7]),
            Tetrahedron4 => (111, &[0, 1, 2, 3]),
            Tetrahedron10 => (118, &[0, 4, 1, 5, 2, 6, 7, 8, 9, 3]),
            Wedge6 => (112, &[0, 1, 2, 3, 4, 5]),
            Wedge15 | Wedge18 => (113, &[0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11]),
            Hexahedron8 => (115, &[0, 1, 2, 3, 4, 5, 6, 7]),
            Hexahedron20 | Hexahedron27 => {
                (116, &[0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15])
            }
            Pyramid5 | Pyramid13 => (115, &[0, 1, 2, 3, 4, 4, 4, 4]),
        };
        Some(UniversalKind { descriptor, order })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A node between two others of its layer is the middle of these: no node is out of place, whatever the kind.
    #[test]
    fn middles_stand_between_their_corners() {
        for kind in CellKind::all() {
            let Some(UniversalKind { order, .. }) = kind.universal() else { continue };
            let middles = kind.table().middles;
            let ends = |place: u8| middles[usize::from(place)];
            assert!(order.iter().filter(|place| ends(**place).len() == 1).count() >= kind.n_corners());
            if kind.is_first_order() || matches!(kind, CellKind::Pyramid13) {
                continue;
            }
            let edges = middles.iter().filter(|corners| corners.len() == 2).count();
            assert_eq!(order.len(), kind.n_corners() + edges, "{kind:?}");
            // Layers: runs of corners and middles in turn, closed but for a line; between them the middles of what joins two layers.
            for (k, place) in order.iter().enumerate().filter(|(_, place)| ends(**place).len() == 2) {
                let [a, b] = [ends(*place)[0], ends(*place)[1]];
                let neighbour = |step: isize| order.get(k.wrapping_add_signed(step)).copied();
                let beside = [neighbour(-1), neighbour(1)];
                let of = |corner: u8| beside.contains(&Some(corner));
                // The last of a layer goes back to its first; an edge between layers has its lower corner at its place there.
                let layer = k - k
                    % (2 * match kind.n_corners() {
                        6 => 3,
                        8 => 4,
                        n => n.min(3),
                    });
                let closes = of(a.max(b)) || order.get(layer).is_some_and(|first| *first == a || *first == b);
                assert!(of(a) && of(b) || closes || k >= order.len() / 3, "{kind:?} {k}");
            }
        }
    }
}
