//! Kinds of cells: one table, a row a kind.
//!
//! A node that is no corner is the middle of some corners. Orders of other programs are in the table, too ([`Order`]).

mod order;
pub(super) mod products;
mod programs;
mod table;

pub use order::{NamedKind, NumberedKind, Order};
pub use programs::Program;
use table::TABLE;
pub use table::{CellKind, CellShape, CellTable};

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
        TABLE.iter().find(|row| i64::from(row.gmsh.number) == number).map(|row| row.kind)
    }

    /// The number of nodes.
    pub fn n_nodes(self) -> usize {
        self.table().middles.len()
    }

    /// The number of corners; they are the first nodes.
    pub fn n_corners(self) -> usize {
        self.corners().len()
    }

    /// Reference coordinates (ξ, η, ζ) of the corners.
    pub fn corners(self) -> &'static [[f64; 3]] {
        self.table().shape.corners()
    }

    /// 0 points, 1 lines, 2 faces, 3 solids.
    pub fn dimension(self) -> usize {
        self.table().shape.dimension()
    }

    /// Whether all nodes are corners.
    pub fn is_first_order(self) -> bool {
        self.n_nodes() == self.n_corners()
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
        let corners = self.corners();
        let mean = |of: &&[u8]| {
            std::array::from_fn(|k| {
                of.iter().map(|c| corners[usize::from(*c)][k]).sum::<f64>() / of.len() as f64
            })
        };
        self.table().middles.iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::{cross, dot, minus};

    #[test]
    fn rows_are_at_their_places() {
        for (k, kind) in CellKind::all().enumerate() {
            assert_eq!(kind as usize, k);
            assert_eq!(CellKind::of_gmsh(i64::from(kind.table().gmsh.number)), Some(kind));
        }
    }

    /// The middle nodes of a side are the middles of the corners of the side, and sides of solids look outwards.
    #[test]
    fn sides_have_the_nodes_of_their_kind_and_look_outwards() {
        for kind in CellKind::all() {
            let places = kind.reference_coordinates();
            let centre: [f64; 3] = std::array::from_fn(|k| {
                kind.corners().iter().map(|c| c[k]).sum::<f64>() / kind.n_corners() as f64
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
