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

    /// The order of the format from the table of kinds: each layer of corners round with the middles of its edges, between two layers the
    /// middles of the edges that join them.
    #[test]
    fn layers_follow_each_other_with_the_middles_between() {
        for kind in CellKind::all() {
            let Some(UniversalKind { order, .. }) = kind.universal() else { continue };
            let middles = kind.table().middles;
            let between = |a: u8, b: u8| {
                let ends = |own: &&[u8]| own.len() == 2 && own.contains(&a) && own.contains(&b);
                middles.iter().position(ends).map(|place| place as u8)
            };
            let round = |corners: &[u8]| -> Vec<u8> {
                let next = |k: usize| corners[(k + 1) % corners.len()];
                (0..corners.len())
                    .flat_map(|k| std::iter::once(corners[k]).chain(between(corners[k], next(k))))
                    .collect()
            };
            let joined =
                |pairs: &[[u8; 2]]| pairs.iter().filter_map(|[a, b]| between(*a, *b)).collect::<Vec<u8>>();
            let expected = match (kind.dimension(), kind.n_corners()) {
                (1, _) => [vec![0], joined(&[[0, 1]]), vec![1]].concat(),
                (2, 3) => round(&[0, 1, 2]),
                (2, _) => round(&[0, 1, 2, 3]),
                (_, 4) => [round(&[0, 1, 2]), joined(&[[0, 3], [1, 3], [2, 3]]), vec![3]].concat(),
                (_, 6) => [round(&[0, 1, 2]), joined(&[[0, 3], [1, 4], [2, 5]]), round(&[3, 4, 5])].concat(),
                (_, 8) => {
                    let up = joined(&[[0, 4], [1, 5], [2, 6], [3, 7]]);
                    [round(&[0, 1, 2, 3]), up, round(&[4, 5, 6, 7])].concat()
                }
                // A pyramid is a brick whose upper corners are one.
                _ => vec![0, 1, 2, 3, 4, 4, 4, 4],
            };
            assert_eq!(order, expected, "{kind:?}");
        }
    }
}
