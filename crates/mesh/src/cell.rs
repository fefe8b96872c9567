//! A cell: its kind and its nodes.

use super::CellKind;
use nalgebra::Vector3;

/// One cell; its nodes index [`super::Mesh::nodes`], in the order of [`CellKind`].
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Cell {
    kind: CellKind,
    nodes: Nodes,
}

/// Nodes of first-order cells without memory of their own.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Nodes {
    Few([usize; 4]),
    Many(Box<[usize]>),
}

impl Cell {
    /// A cell of any kind; none where the kind has another number of nodes.
    pub fn new(kind: CellKind, nodes: &[usize]) -> Option<Cell> {
        if nodes.len() != kind.n_nodes() {
            return None;
        }
        let mut few = [0; 4];
        let nodes = match few.get_mut(..nodes.len()) {
            Some(part) => {
                part.copy_from_slice(nodes);
                Nodes::Few(few)
            }
            None => Nodes::Many(nodes.into()),
        };
        Some(Cell { kind, nodes })
    }

    fn few<const N: usize>(kind: CellKind, nodes: [usize; N]) -> Cell {
        let mut few = [0; 4];
        few[..N].copy_from_slice(&nodes);
        Cell { kind, nodes: Nodes::Few(few) }
    }

    /// A point: a single node.
    pub fn point(node: usize) -> Cell {
        Cell::few(CellKind::Point1, [node])
    }

    /// A straight line.
    pub fn line(nodes: [usize; 2]) -> Cell {
        Cell::few(CellKind::Line2, nodes)
    }

    /// A triangle of straight edges.
    pub fn triangle(nodes: [usize; 3]) -> Cell {
        Cell::few(CellKind::Triangle3, nodes)
    }

    /// A quadrilateral of straight edges, nodes in order around it.
    pub fn quadrilateral(nodes: [usize; 4]) -> Cell {
        Cell::few(CellKind::Quadrilateral4, nodes)
    }

    /// The kind.
    pub fn kind(&self) -> CellKind {
        self.kind
    }

    /// The nodes.
    pub fn nodes(&self) -> &[usize] {
        match &self.nodes {
            Nodes::Few(nodes) => &nodes[..self.kind.n_nodes()],
            Nodes::Many(nodes) => nodes,
        }
    }

    /// The corners, which are the first nodes.
    pub fn corners(&self) -> &[usize] {
        &self.nodes()[..self.kind.n_corners()]
    }

    /// The two ends of a line.
    pub fn ends(&self) -> Option<[usize; 2]> {
        self.corners().try_into().ok()
    }

    /// 0 for a point, 1 for a line, 2 for a face, 3 for a solid.
    pub fn dimension(&self) -> usize {
        self.kind.dimension()
    }

    /// Its sides: the faces of a solid, the edges of a face.
    pub fn sides(&self) -> impl Iterator<Item = Cell> + '_ {
        let nodes = self.nodes();
        self.kind.table().sides.iter().map(|(kind, of)| {
            let nodes: Vec<usize> = of.iter().map(|k| nodes[usize::from(*k)]).collect();
            Cell::new(*kind, &nodes).expect("a side has the nodes of its kind")
        })
    }

    /// x(ξ) = Σ N_k(ξ) x_k \[m\] of nodes with the given coordinates.
    pub fn position(&self, nodes: &[[f64; 3]], at: [f64; 3]) -> [f64; 3] {
        let mut position = [0.0; 3];
        for (node, share) in self.nodes().iter().zip(self.kind.shape_functions(at)) {
            (0..3).for_each(|k| position[k] += share * nodes[*node][k]);
        }
        position
    }

    /// ∂x/∂ξ, ∂x/∂η, ∂x/∂ζ of nodes with the given coordinates \[m\]; those beyond its dimension are zero.
    pub fn tangents(&self, nodes: &[[f64; 3]], at: [f64; 3]) -> [[f64; 3]; 3] {
        let mut tangents = [[0.0; 3]; 3];
        for (node, gradient) in self.nodes().iter().zip(self.kind.shape_gradients(at)) {
            for (tangent, slope) in tangents.iter_mut().zip(gradient) {
                (0..3).for_each(|k| tangent[k] += slope * nodes[*node][k]);
            }
        }
        tangents
    }

    /// Its nodes in the order of VTK files.
    pub fn to_vtk(&self) -> Vec<usize> {
        self.kind.table().vtk.order.to_file(self.nodes())
    }

    /// The cell of VTK's type `number` on these points, whose coordinates `at` gives; none where there is no such kind, or where it has
    /// another number of points. Wedges come in both orders, of which the one that is not inside out is meant: that of VTK's manual, and
    /// the other one, which meshio and others write.
    pub fn from_vtk(number: i64, points: &[usize], at: impl Fn(usize) -> [f64; 3]) -> Option<Cell> {
        let (kind, order) = CellKind::of_vtk(number)?;
        let mut nodes = order.from_file(points)?;
        if kind == CellKind::Wedge6 {
            let [a, b, c] = [1, 2, 3].map(|k| Vector3::from(at(nodes[k])) - Vector3::from(at(nodes[0])));
            if a.cross(&b).dot(&c) < 0.0 {
                nodes = points.to_vec();
            }
        }
        Cell::new(kind, &nodes)
    }

    /// The nodes of the points, lines, triangles and quadrilaterals that it can be drawn by ([`super::CellTable::pieces`]).
    pub fn pieces(&self) -> impl Iterator<Item = Vec<usize>> + '_ {
        let nodes = self.nodes();
        self.kind.table().pieces.iter().map(|piece| piece.iter().map(|k| nodes[usize::from(*k)]).collect())
    }

    /// The same cell whose nodes have other numbers.
    pub fn renumbered(&self, number: impl Fn(usize) -> usize) -> Cell {
        let mut cell = self.clone();
        let count = self.kind.n_nodes();
        let nodes = match &mut cell.nodes {
            Nodes::Few(nodes) => &mut nodes[..count],
            Nodes::Many(nodes) => nodes,
        };
        nodes.iter_mut().for_each(|node| *node = number(*node));
        cell
    }

    /// A face turned over: the first corner stays, the others come in opposite order. Other cells as they are.
    pub fn turned_over(&self) -> Cell {
        if self.dimension() != 2 {
            return self.clone();
        }
        let (corners, nodes) = (self.kind.n_corners(), self.nodes());
        let place = |k: usize| match k {
            // Corner 0 stays, as does the middle of the face; the edge behind a corner becomes the one before it.
            _ if k < corners => (corners - k) % corners,
            _ if k < 2 * corners => 3 * corners - 1 - k,
            _ => k,
        };
        let turned: Vec<usize> = (0..nodes.len()).map(|k| nodes[place(k)]).collect();
        Cell::new(self.kind, &turned).expect("as many nodes")
    }
}

/// The nodes of some cells, ascending, each once.
pub fn cell_nodes<'a>(cells: impl IntoIterator<Item = &'a Cell>) -> Vec<usize> {
    let mut nodes: Vec<usize> = cells.into_iter().flat_map(Cell::nodes).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_turned_over_has_its_middles_between_the_same_corners() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 2) {
            let nodes: Vec<usize> = (10..10 + kind.n_nodes()).collect();
            let cell = Cell::new(kind, &nodes).unwrap();
            let turned = cell.turned_over();
            assert_eq!(turned.turned_over(), cell);
            assert_eq!((turned.nodes()[0], turned.nodes()[1]), (10, 10 + kind.n_corners() - 1));
            // Each edge with its middle, in either direction.
            let edges = |cell: &Cell| {
                let mut edges: Vec<Vec<usize>> = cell.sides().map(|side| side.nodes().to_vec()).collect();
                edges.iter_mut().for_each(|edge| edge.sort_unstable());
                edges.sort();
                edges
            };
            assert_eq!(edges(&cell), edges(&turned));
        }
    }

    #[test]
    fn a_cell_has_as_many_nodes_as_its_kind() {
        assert!(Cell::new(CellKind::Triangle3, &[0, 1]).is_none());
        let twenty: Vec<usize> = (0..20).collect();
        let cell = Cell::new(CellKind::Hexahedron20, &twenty).unwrap();
        assert_eq!((cell.nodes(), cell.corners().len()), (&twenty[..], 8));
        assert_eq!(cell.renumbered(|n| n + 5).nodes()[19], 24);
        assert_eq!(cell.sides().count(), 6);
    }
}
