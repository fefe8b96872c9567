//! The skin of solids: the faces that one cell alone has.

use super::{Cell, Mesh};
use std::collections::HashMap;

/// A face of a solid: the cell, an index into [`Mesh::elements`], and the number of its side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Side {
    /// The cell.
    pub cell: usize,
    /// Which of its sides, in the order of [`crate::CellTable::sides`].
    pub side: usize,
}

/// What two cells that share a face have in common: its corners, ascending, and the number of its nodes.
type Key = ([usize; 4], usize);

fn key(face: &Cell) -> Key {
    let mut corners = [usize::MAX; 4];
    corners[..face.corners().len()].copy_from_slice(face.corners());
    corners.sort_unstable();
    (corners, face.nodes().len())
}

/// The sides that one cell alone has, of cells with their numbers, in their order.
fn outer_sides<'a>(cells: impl Iterator<Item = (usize, &'a Cell)>) -> Vec<Side> {
    let mut all: Vec<(Side, Key)> = Vec::new();
    let mut count: HashMap<Key, usize> = HashMap::new();
    for (cell, sides) in cells.map(|(number, cell)| (number, cell.sides())) {
        for (side, face) in sides.enumerate() {
            let key = key(&face);
            *count.entry(key).or_default() += 1;
            all.push((Side { cell, side }, key));
        }
    }
    all.into_iter().filter(|(_, key)| count[key] == 1).map(|(side, _)| side).collect()
}

/// The outer faces of solids, each seen from outside counter-clockwise, in the order of the cells.
pub fn outer_faces<'a>(solids: impl Iterator<Item = &'a Cell>) -> Vec<Cell> {
    let all: Vec<&Cell> = solids.collect();
    let sides = outer_sides(all.iter().copied().enumerate());
    sides.into_iter().filter_map(|Side { cell, side }| all[cell].sides().nth(side)).collect()
}

/// `faces` as seen from outside of some solids counter-clockwise; `None` where some are no outer faces of these.
pub fn outward<'a>(solids: impl Iterator<Item = &'a Cell>, faces: &[Cell]) -> Option<Vec<Cell>> {
    let skin: HashMap<Key, Cell> = outer_faces(solids).into_iter().map(|face| (key(&face), face)).collect();
    faces.iter().map(|face| skin.get(&key(face)).cloned()).collect()
}

impl Mesh {
    /// The outer faces of the solids among `cells`, in the order of the cells.
    pub fn skin(&self, cells: impl IntoIterator<Item = usize>) -> Vec<Side> {
        let cells = cells.into_iter().map(|cell| (cell, &self.elements[cell]));
        outer_sides(cells.filter(|(_, cell)| cell.dimension() == 3))
    }

    /// A face of a solid as a cell of its own, seen from outside counter-clockwise.
    pub fn side(&self, side: Side) -> Cell {
        self.elements[side.cell].sides().nth(side.side).expect("a side of the cell")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellKind;
    use crate::quality::{cross, dot, minus};
    use stridor_base::bounds::{Origin::*, within};

    /// A box of n × n × n hexahedra, each of them cut into six pyramids about a node in its middle, or into two wedges, or whole.
    fn boxes(n: usize, kind: CellKind) -> Mesh {
        let mut mesh = Mesh::default();
        let node = |i: usize, j: usize, k: usize| i + (n + 1) * (j + (n + 1) * k);
        for (k, j, i) in (0..=n).flat_map(|k| (0..=n).flat_map(move |j| (0..=n).map(move |i| (k, j, i)))) {
            mesh.nodes.push([i, j, k].map(|c| c as f64 / n as f64));
        }
        for (k, j, i) in (0..n).flat_map(|k| (0..n).flat_map(move |j| (0..n).map(move |i| (k, j, i)))) {
            let whole = Cell::new(
                CellKind::Hexahedron8,
                &[
                    node(i, j, k),
                    node(i + 1, j, k),
                    node(i + 1, j + 1, k),
                    node(i, j + 1, k),
                    node(i, j, k + 1),
                    node(i + 1, j, k + 1),
                    node(i + 1, j + 1, k + 1),
                    node(i, j + 1, k + 1),
                ],
            )
            .unwrap();
            let c = whole.nodes();
            match kind {
                CellKind::Pyramid5 => {
                    let middle = mesh.nodes.len();
                    mesh.nodes.push([0, 1, 2].map(|a| 0.5 * (mesh.nodes[c[0]][a] + mesh.nodes[c[6]][a])));
                    let cut: Vec<Cell> = whole
                        .sides()
                        .map(|face| {
                            // The base of a pyramid looks away from its apex.
                            let mut nodes = face.turned_over().nodes().to_vec();
                            nodes.push(middle);
                            Cell::new(kind, &nodes).unwrap()
                        })
                        .collect();
                    mesh.elements.extend(cut);
                }
                CellKind::Wedge6 => {
                    for [a, b, d] in [[0, 1, 2], [0, 2, 3]] {
                        let nodes = [c[a], c[b], c[d], c[a + 4], c[b + 4], c[d + 4]];
                        mesh.elements.push(Cell::new(kind, &nodes).unwrap());
                    }
                }
                _ => mesh.elements.push(whole.clone()),
            }
        }
        mesh
    }

    /// The skin of a cube has its area, and encloses its volume: ∮ x·n dA = 3 V.
    #[test]
    fn the_skin_of_a_cube_encloses_it() {
        for kind in [CellKind::Hexahedron8, CellKind::Wedge6, CellKind::Pyramid5] {
            let mesh = boxes(3, kind);
            let (mut area, mut volume) = (0.0, 0.0);
            for side in mesh.skin(0..mesh.elements.len()) {
                let face = mesh.side(side);
                let at = |k: usize| mesh.nodes[face.corners()[k]];
                for k in 2..face.corners().len() {
                    let normal = cross(minus(at(k - 1), at(0)), minus(at(k), at(0)));
                    area += 0.5 * dot(normal, normal).sqrt();
                    volume += dot(at(0), normal) / 6.0;
                }
            }
            assert!(
                within((area - 6.0).abs(), 1e-12, RoundOff) && within((volume - 1.0).abs(), 1e-12, RoundOff),
                "{kind:?} {area} {volume}"
            );
        }
    }
}
