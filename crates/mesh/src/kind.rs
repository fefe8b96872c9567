//! Kinds of cells: one table, a row a kind.
//!
//! Nodes are in the order of VTK, which is that of Abaqus, too, but for the 27-node hexahedron: corners; then the middles of edges,
//! those of faces and of the cell. A node that is no corner is the middle of some corners, so an order of another program is the
//! list of those corners in its order ([`CellKind::gmsh_order`]).

/// A kind of cell, by shape and number of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum CellKind {
    Point1,
    Line2,
    Line3,
    Triangle3,
    Triangle6,
    Quadrilateral4,
    Quadrilateral8,
    Quadrilateral9,
    Tetrahedron4,
    Tetrahedron10,
    Hexahedron8,
    Hexahedron20,
    Hexahedron27,
    Wedge6,
    Wedge15,
    Wedge18,
    Pyramid5,
    Pyramid13,
}

/// A row of the table.
#[derive(Debug)]
pub struct CellTable {
    /// The kind.
    pub kind: CellKind,
    /// What it is called in messages.
    pub name: &'static str,
    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub dimension: usize,
    /// The corners that each node is the middle of, in the order of the nodes; a corner is its own.
    pub middles: &'static [&'static [u8]],
    /// The same in the order of Gmsh.
    gmsh_middles: &'static [&'static [u8]],
    /// Reference coordinates (ξ, η, ζ) of the corners.
    pub corners: &'static [[f64; 3]],
    /// Faces of a solid, or edges of a face: the kind and its nodes, seen from outside counter-clockwise.
    pub sides: &'static [(CellKind, &'static [u8])],
    /// Number of the type in Gmsh files.
    pub gmsh: i64,
    /// Number of the type in VTK files.
    pub vtk: u8,
}

use CellKind::*;

const SEGMENT: [[f64; 3]; 2] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const SQUARE: [[f64; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
const TETRAHEDRON: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const CUBE: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
const WEDGE: [[f64; 3]; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
const PYRAMID: [[f64; 3]; 5] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The table; a kind's row is at its place in [`CellKind`].
#[rustfmt::skip]
static TABLE: [CellTable; 18] = [
    CellTable {
        kind: Point1,
        name: "point",
        dimension: 0,
        middles: &[&[0]],
        gmsh_middles: &[&[0]],
        corners: &[[0.0; 3]],
        sides: &[],
        gmsh: 15,
        vtk: 1,
    },
    CellTable {
        kind: Line2,
        name: "2-node line",
        dimension: 1,
        middles: &[&[0], &[1]],
        gmsh_middles: &[&[0], &[1]],
        corners: &SEGMENT,
        sides: &[(Point1, &[0]), (Point1, &[1])],
        gmsh: 1,
        vtk: 3,
    },
    CellTable {
        kind: Line3,
        name: "3-node line",
        dimension: 1,
        middles: &[&[0], &[1], &[0, 1]],
        gmsh_middles: &[&[0], &[1], &[0, 1]],
        corners: &SEGMENT,
        sides: &[(Point1, &[0]), (Point1, &[1])],
        gmsh: 8,
        vtk: 21,
    },
    CellTable {
        kind: Triangle3,
        name: "3-node triangle",
        dimension: 2,
        middles: &[&[0], &[1], &[2]],
        gmsh_middles: &[&[0], &[1], &[2]],
        corners: &TRIANGLE,
        sides: &[(Line2, &[0, 1]), (Line2, &[1, 2]), (Line2, &[2, 0])],
        gmsh: 2,
        vtk: 5,
    },
    CellTable {
        kind: Triangle6,
        name: "6-node triangle",
        dimension: 2,
        middles: &[&[0], &[1], &[2], &[0, 1], &[1, 2], &[2, 0]],
        gmsh_middles: &[&[0], &[1], &[2], &[0, 1], &[1, 2], &[2, 0]],
        corners: &TRIANGLE,
        sides: &[(Line3, &[0, 1, 3]), (Line3, &[1, 2, 4]), (Line3, &[2, 0, 5])],
        gmsh: 9,
        vtk: 22,
    },
    CellTable {
        kind: Quadrilateral4,
        name: "4-node quadrilateral",
        dimension: 2,
        middles: &[&[0], &[1], &[2], &[3]],
        gmsh_middles: &[&[0], &[1], &[2], &[3]],
        corners: &SQUARE,
        sides: &[(Line2, &[0, 1]), (Line2, &[1, 2]), (Line2, &[2, 3]), (Line2, &[3, 0])],
        gmsh: 3,
        vtk: 9,
    },
    CellTable {
        kind: Quadrilateral8,
        name: "8-node quadrilateral",
        dimension: 2,
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        corners: &SQUARE,
        sides: &[(Line3, &[0, 1, 4]), (Line3, &[1, 2, 5]), (Line3, &[2, 3, 6]), (Line3, &[3, 0, 7])],
        gmsh: 16,
        vtk: 23,
    },
    CellTable {
        kind: Quadrilateral9,
        name: "9-node quadrilateral",
        dimension: 2,
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]],
        corners: &SQUARE,
        sides: &[(Line3, &[0, 1, 4]), (Line3, &[1, 2, 5]), (Line3, &[2, 3, 6]), (Line3, &[3, 0, 7])],
        gmsh: 10,
        vtk: 28,
    },
    CellTable {
        kind: Tetrahedron4,
        name: "4-node tetrahedron",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3]],
        gmsh_middles: &[&[0], &[1], &[2], &[3]],
        corners: &TETRAHEDRON,
        sides: &[(Triangle3, &[0, 2, 1]), (Triangle3, &[0, 1, 3]), (Triangle3, &[1, 2, 3]), (Triangle3, &[2, 0, 3])],
        gmsh: 4,
        vtk: 10,
    },
    CellTable {
        kind: Tetrahedron10,
        name: "10-node tetrahedron",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 0], &[0, 3], &[2, 3], &[1, 3]],
        corners: &TETRAHEDRON,
        sides: &[(Triangle6, &[0, 2, 1, 6, 5, 4]), (Triangle6, &[0, 1, 3, 4, 8, 7]), (Triangle6, &[1, 2, 3, 5, 9, 8]),
            (Triangle6, &[2, 0, 3, 6, 7, 9])],
        gmsh: 11,
        vtk: 24,
    },
    CellTable {
        kind: Hexahedron8,
        name: "8-node hexahedron",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7]],
        corners: &CUBE,
        sides: &[(Quadrilateral4, &[0, 3, 2, 1]), (Quadrilateral4, &[4, 5, 6, 7]), (Quadrilateral4, &[0, 1, 5, 4]),
            (Quadrilateral4, &[1, 2, 6, 5]), (Quadrilateral4, &[2, 3, 7, 6]), (Quadrilateral4, &[3, 0, 4, 7])],
        gmsh: 5,
        vtk: 12,
    },
    CellTable {
        kind: Hexahedron20,
        name: "20-node hexahedron",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[4, 5], &[5, 6], &[6, 7],
            &[7, 4], &[0, 4], &[1, 5], &[2, 6], &[3, 7]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 5], &[2, 3], &[2, 6],
            &[3, 7], &[4, 5], &[4, 7], &[5, 6], &[6, 7]],
        corners: &CUBE,
        sides: &[(Quadrilateral8, &[0, 3, 2, 1, 11, 10, 9, 8]), (Quadrilateral8, &[4, 5, 6, 7, 12, 13, 14, 15]),
            (Quadrilateral8, &[0, 1, 5, 4, 8, 17, 12, 16]), (Quadrilateral8, &[1, 2, 6, 5, 9, 18, 13, 17]),
            (Quadrilateral8, &[2, 3, 7, 6, 10, 19, 14, 18]), (Quadrilateral8, &[3, 0, 4, 7, 11, 16, 15, 19])],
        gmsh: 17,
        vtk: 25,
    },
    CellTable {
        kind: Hexahedron27,
        name: "27-node hexahedron",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[4, 5], &[5, 6], &[6, 7],
            &[7, 4], &[0, 4], &[1, 5], &[2, 6], &[3, 7], &[0, 3, 4, 7], &[1, 2, 5, 6], &[0, 1, 4, 5], &[2, 3, 6, 7], &[0, 1, 2, 3],
            &[4, 5, 6, 7], &[0, 1, 2, 3, 4, 5, 6, 7]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[6], &[7], &[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 5], &[2, 3], &[2, 6],
            &[3, 7], &[4, 5], &[4, 7], &[5, 6], &[6, 7], &[0, 1, 2, 3], &[0, 1, 4, 5], &[0, 3, 4, 7], &[1, 2, 5, 6], &[2, 3, 6, 7],
            &[4, 5, 6, 7], &[0, 1, 2, 3, 4, 5, 6, 7]],
        corners: &CUBE,
        sides: &[(Quadrilateral9, &[0, 3, 2, 1, 11, 10, 9, 8, 24]), (Quadrilateral9, &[4, 5, 6, 7, 12, 13, 14, 15, 25]),
            (Quadrilateral9, &[0, 1, 5, 4, 8, 17, 12, 16, 22]), (Quadrilateral9, &[1, 2, 6, 5, 9, 18, 13, 17, 21]),
            (Quadrilateral9, &[2, 3, 7, 6, 10, 19, 14, 18, 23]), (Quadrilateral9, &[3, 0, 4, 7, 11, 16, 15, 19, 20])],
        gmsh: 12,
        vtk: 29,
    },
    CellTable {
        kind: Wedge6,
        name: "6-node wedge",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5]],
        corners: &WEDGE,
        sides: &[(Triangle3, &[0, 2, 1]), (Triangle3, &[3, 4, 5]), (Quadrilateral4, &[0, 1, 4, 3]), (Quadrilateral4, &[1, 2, 5, 4]),
            (Quadrilateral4, &[2, 0, 3, 5])],
        gmsh: 6,
        vtk: 13,
    },
    CellTable {
        kind: Wedge15,
        name: "15-node wedge",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3], &[0, 3], &[1, 4], &[2, 5]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[0, 2], &[0, 3], &[1, 2], &[1, 4], &[2, 5], &[3, 4], &[3, 5],
            &[4, 5]],
        corners: &WEDGE,
        sides: &[(Triangle6, &[0, 2, 1, 8, 7, 6]), (Triangle6, &[3, 4, 5, 9, 10, 11]), (Quadrilateral8, &[0, 1, 4, 3, 6, 13, 9, 12]),
            (Quadrilateral8, &[1, 2, 5, 4, 7, 14, 10, 13]), (Quadrilateral8, &[2, 0, 3, 5, 8, 12, 11, 14])],
        gmsh: 18,
        vtk: 26,
    },
    CellTable {
        kind: Wedge18,
        name: "18-node wedge",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3], &[0, 3], &[1, 4], &[2, 5],
            &[0, 1, 3, 4], &[1, 2, 4, 5], &[0, 2, 3, 5]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[5], &[0, 1], &[0, 2], &[0, 3], &[1, 2], &[1, 4], &[2, 5], &[3, 4], &[3, 5],
            &[4, 5], &[0, 1, 3, 4], &[0, 2, 3, 5], &[1, 2, 4, 5]],
        corners: &WEDGE,
        sides: &[(Triangle6, &[0, 2, 1, 8, 7, 6]), (Triangle6, &[3, 4, 5, 9, 10, 11]),
            (Quadrilateral9, &[0, 1, 4, 3, 6, 13, 9, 12, 15]), (Quadrilateral9, &[1, 2, 5, 4, 7, 14, 10, 13, 16]),
            (Quadrilateral9, &[2, 0, 3, 5, 8, 12, 11, 14, 17])],
        gmsh: 13,
        vtk: 32,
    },
    CellTable {
        kind: Pyramid5,
        name: "5-node pyramid",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4]],
        corners: &PYRAMID,
        sides: &[(Quadrilateral4, &[0, 3, 2, 1]), (Triangle3, &[0, 1, 4]), (Triangle3, &[1, 2, 4]), (Triangle3, &[2, 3, 4]),
            (Triangle3, &[3, 0, 4])],
        gmsh: 7,
        vtk: 14,
    },
    CellTable {
        kind: Pyramid13,
        name: "13-node pyramid",
        dimension: 3,
        middles: &[&[0], &[1], &[2], &[3], &[4], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]],
        gmsh_middles: &[&[0], &[1], &[2], &[3], &[4], &[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 4], &[2, 3], &[2, 4], &[3, 4]],
        corners: &PYRAMID,
        sides: &[(Quadrilateral8, &[0, 3, 2, 1, 8, 7, 6, 5]), (Triangle6, &[0, 1, 4, 5, 10, 9]), (Triangle6, &[1, 2, 4, 6, 11, 10]),
            (Triangle6, &[2, 3, 4, 7, 12, 11]), (Triangle6, &[3, 0, 4, 8, 9, 12])],
        gmsh: 19,
        vtk: 27,
    },
];

impl CellKind {
    /// All kinds, as the table has them.
    pub fn all() -> impl Iterator<Item = CellKind> {
        TABLE.iter().map(|row| row.kind)
    }

    /// Its row of the table.
    pub fn table(self) -> &'static CellTable {
        &TABLE[self as usize]
    }

    /// The kind with this number in Gmsh files.
    pub fn of_gmsh(number: i64) -> Option<CellKind> {
        TABLE.iter().find(|row| row.gmsh == number).map(|row| row.kind)
    }

    /// The number of nodes.
    pub fn n_nodes(self) -> usize {
        self.table().middles.len()
    }

    /// The number of corners; they are the first nodes.
    pub fn n_corners(self) -> usize {
        self.table().corners.len()
    }

    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub fn dimension(self) -> usize {
        self.table().dimension
    }

    /// Whether all nodes are corners.
    pub fn is_first_order(self) -> bool {
        self.n_nodes() == self.n_corners()
    }

    /// The place in Gmsh's order of every node: `nodes[k] = gmsh[order[k]]`.
    pub fn gmsh_order(self) -> Vec<usize> {
        let CellTable { middles, gmsh_middles, .. } = self.table();
        let sorted = |corners: &[u8]| {
            let mut corners = corners.to_vec();
            corners.sort_unstable();
            corners
        };
        let place = |own: &&[u8]| gmsh_middles.iter().position(|other| sorted(other) == sorted(own));
        middles.iter().map(|own| place(own).expect("the same nodes in both orders")).collect()
    }

    /// Nodes in the order of this kind, given in Gmsh's.
    pub fn from_gmsh<T: Copy>(self, nodes: &[T]) -> Vec<T> {
        self.gmsh_order().into_iter().map(|place| nodes[place]).collect()
    }

    /// Nodes in Gmsh's order.
    pub fn to_gmsh<T: Copy>(self, nodes: &[T]) -> Vec<T> {
        let mut list: Vec<(usize, T)> = self.gmsh_order().into_iter().zip(nodes.iter().copied()).collect();
        list.sort_by_key(|(place, _)| *place);
        list.into_iter().map(|(_, node)| node).collect()
    }

    /// Points, lines, triangles and quadrilaterals of first order that it can be drawn by: itself, or pieces between its nodes; none of a
    /// solid, whose sides are drawn.
    pub fn pieces(self) -> &'static [&'static [u8]] {
        match self {
            Point1 => &[&[0]],
            Line2 => &[&[0, 1]],
            Line3 => &[&[0, 2], &[2, 1]],
            Triangle3 => &[&[0, 1, 2]],
            Triangle6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
            Quadrilateral4 => &[&[0, 1, 2, 3]],
            Quadrilateral8 => &[&[0, 4, 7], &[4, 1, 5], &[5, 2, 6], &[7, 6, 3], &[4, 5, 6, 7]],
            Quadrilateral9 => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
            _ => &[],
        }
    }

    /// Its name for several: `3-node triangles`.
    pub fn plural(self) -> String {
        match self.table().name {
            name if name.ends_with("hedron") => format!("{}a", name.trim_end_matches("on")),
            name => format!("{name}s"),
        }
    }

    /// (ξ, η, ζ) of every node: a corner's own, and the mean of the corners of a middle.
    pub fn reference_coordinates(self) -> Vec<[f64; 3]> {
        let CellTable { middles, corners, .. } = self.table();
        let mean = |of: &&[u8]| {
            std::array::from_fn(|k| {
                of.iter().map(|c| corners[usize::from(*c)][k]).sum::<f64>() / of.len() as f64
            })
        };
        middles.iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::{cross, dot, minus};

    /// Every row is at the place of its kind, and orders hold each node once.
    #[test]
    fn rows_are_at_their_places_and_orders_are_permutations() {
        for (k, kind) in CellKind::all().enumerate() {
            assert_eq!(kind as usize, k);
            assert_eq!(CellKind::of_gmsh(kind.table().gmsh), Some(kind));
            let mut order = kind.gmsh_order();
            order.sort_unstable();
            assert!(order.into_iter().eq(0..kind.n_nodes()), "{kind:?}");
        }
    }

    /// The middle nodes of a side are the middles of the corners of the side, and sides of solids look outwards.
    #[test]
    fn sides_have_the_nodes_of_their_kind_and_look_outwards() {
        for kind in CellKind::all() {
            let places = kind.reference_coordinates();
            let centre: [f64; 3] = std::array::from_fn(|k| {
                kind.table().corners.iter().map(|c| c[k]).sum::<f64>() / kind.n_corners() as f64
            });
            for (side, nodes) in kind.table().sides {
                assert_eq!(nodes.len(), side.n_nodes());
                assert_eq!(side.dimension() + 1, kind.dimension());
                let at = |k: u8| places[usize::from(nodes[usize::from(k)])];
                for (k, corners) in side.table().middles.iter().enumerate() {
                    let mean: [f64; 3] = std::array::from_fn(|i| {
                        corners.iter().map(|c| at(*c)[i]).sum::<f64>() / corners.len() as f64
                    });
                    assert_eq!(mean, at(k as u8), "{kind:?} {nodes:?}");
                }
                if kind.dimension() == 3 {
                    let normal = cross(minus(at(1), at(0)), minus(at(2), at(0)));
                    assert!(dot(normal, minus(at(0), centre)) > 0.0, "{kind:?} {nodes:?}");
                }
            }
        }
    }

    /// Each edge of a solid is of two of its sides.
    #[test]
    fn sides_of_solids_are_closed() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let mut edges: Vec<(u8, u8)> = Vec::new();
            for (side, nodes) in kind.table().sides {
                let n = side.n_corners();
                edges.extend((0..n).map(|i| (nodes[i], nodes[(i + 1) % n])));
            }
            let twin = |(a, b): &(u8, u8)| edges.contains(&(*b, *a));
            assert!(edges.iter().all(twin), "{kind:?}");
            // Euler: corners − edges + sides = 2.
            assert_eq!(kind.n_corners() + kind.table().sides.len(), edges.len() / 2 + 2, "{kind:?}");
        }
    }
}
