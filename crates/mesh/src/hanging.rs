//! Nodes that lie on the edge of a face, or on a line, without being its nodes.

use super::quality::{dot, minus, norm};
use super::{Cell, Mesh};

/// How far from an edge a node of it may lie, as a share of its length: more than the sagitta of an arc that is divided into 12.
const NEAR: f64 = 0.03;
/// A node nearer to an end of the edge than this share of its length coincides with it, which is another finding.
const END: f64 = 0.01;

/// The most nodes that are compared with edges: many times those of any sound mesh, whose edges are short.
const VISITS: usize = 200_000_000;

/// The same of solids, whose cells meet along straight edges or share the nodes in their middle.
const NEAR_SOLID: f64 = 1e-3;

/// What an edge is of.
#[derive(Clone, Copy)]
enum Of {
    /// One face or line.
    One,
    /// Several faces.
    Several,
    /// A face of the skin of solids.
    Solids,
}

/// An edge with the nodes of its element.
struct Edge<'a> {
    ends: [usize; 2],
    own: &'a [usize],
    of: Of,
}

/// A node on an edge that does not have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hanging {
    pub node: usize,
    /// The ends of the edge.
    pub edge: [usize; 2],
}

/// The nodes of faces and lines that lie between the ends of an edge which one face alone has, and which are no nodes of that face, and
/// those between the ends of a line that is no edge of a face, as of a bar along a plate; the nodes on edges of a face of solids which
/// does not have them, as of cells of first order beside those of second. Each node is there once, in ascending order.
pub(super) fn hanging(mesh: &Mesh) -> Vec<Hanging> {
    let of = |dimension: usize| {
        mesh.elements.iter().enumerate().filter(move |(_, element)| element.dimension() == dimension)
    };
    // The faces that one solid alone has: with unlike cells side by side also those between them.
    let skin: Vec<Cell> = mesh.skin(0..mesh.elements.len()).into_iter().map(|side| mesh.side(side)).collect();
    let mut of_skin = vec![false; mesh.nodes.len()];
    let mut edges: Vec<Edge> = Vec::new();
    let mut all: Vec<([usize; 2], usize)> = Vec::new();
    let (mut of_face, mut of_line) = (vec![false; mesh.nodes.len()], vec![false; mesh.nodes.len()]);
    for (e, face) in of(2) {
        face.nodes().iter().for_each(|node| of_face[*node] = true);
        let n = face.corners();
        all.extend((0..n.len()).map(|i| {
            let (a, b) = (n[i], n[(i + 1) % n.len()]);
            ([a.min(b), a.max(b)], e)
        }));
    }
    all.sort_unstable();
    for (_, line) in of(1) {
        let n = line.nodes();
        n.iter().for_each(|node| of_line[*node] = true);
        let key = [n[0].min(n[1]), n[0].max(n[1])];
        if all.binary_search_by(|edge| edge.0.cmp(&key)).is_err() {
            edges.push(Edge { ends: key, own: n, of: Of::One });
        }
    }
    for (face, n) in skin.iter().map(|face| (face.nodes(), face.corners())) {
        face.iter().for_each(|node| of_skin[*node] = true);
        edges.extend((0..n.len()).map(|i| Edge {
            ends: [n[i], n[(i + 1) % n.len()]],
            own: face,
            of: Of::Solids,
        }));
    }
    for same in all.chunk_by(|a, b| a.0 == b.0) {
        let first = mesh.elements[same[0].1].nodes();
        // A face may be listed twice, once for each of two regions.
        let alone =
            same[1..].iter().all(|(_, e)| mesh.elements[*e].nodes().iter().all(|node| first.contains(node)));
        edges.push(Edge { ends: same[0].0, own: first, of: if alone { Of::One } else { Of::Several } });
    }
    // Along a skew direction few nodes are between the ends of an edge.
    let along = |node: usize| dot(mesh.nodes[node], [0.577, 0.613, 0.541]);
    let mut order: Vec<(f64, usize)> = (0..mesh.nodes.len())
        .filter(|node| of_face[*node] || of_line[*node] || of_skin[*node])
        .map(|node| (along(node), node))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut found: Vec<Hanging> = Vec::new();
    let mut visits = VISITS;
    for Edge { ends, own, of } in edges {
        let [a, b] = ends;
        let way = minus(mesh.nodes[b], mesh.nodes[a]);
        let length = norm(way);
        let [low, high] = [along(a).min(along(b)) - NEAR * length, along(a).max(along(b)) + NEAR * length];
        let begin = order.partition_point(|(s, _)| *s < low);
        let between = order[begin..].iter().take_while(|(s, _)| *s <= high);
        for (_, node) in between.take(visits) {
            visits -= 1;
            let from = minus(mesh.nodes[*node], mesh.nodes[a]);
            let t = dot(from, way) / length.powi(2);
            let off = norm([0, 1, 2].map(|k| from[k] - t * way[k]));
            let (counts, near) = match of {
                Of::One => (of_face[*node] || of_line[*node], NEAR),
                // A node of a face beside an edge between two others is that of another surface.
                Of::Several => (of_line[*node] && !of_face[*node], NEAR),
                Of::Solids => (of_skin[*node], NEAR_SOLID),
            };
            if counts && (END..=1.0 - END).contains(&t) && off <= near * length && !own.contains(node) {
                found.push(Hanging { node: *node, edge: ends });
            }
        }
    }
    found.sort_by_key(|hanging| (hanging.node, hanging.edge));
    found.dedup_by_key(|hanging| hanging.node);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose;
    use crate::generate::{Faces, structured_box, structured_plate};

    /// Bars of two boxes of solids that share the nodes at equal places.
    #[test]
    fn unlike_solids_side_by_side_are_found() {
        use crate::CellKind::{self, *};
        let joined = |left: (CellKind, usize), right: (CellKind, usize)| {
            let of = |(kind, n): (CellKind, usize)| structured_box(kind, [1.0; 3], [n; 3]).unwrap();
            let (mut mesh, mut other) = (of(left), of(right));
            [&mut mesh, &mut other].into_iter().for_each(|mesh| {
                mesh.regions.truncate(1);
                mesh.elements.truncate(mesh.regions[0].elements.len());
            });
            let mut number = Vec::new();
            for x in other.nodes.iter().map(|x| [x[0] + 1.0, x[1], x[2]]) {
                let same = mesh.nodes.iter().position(|y| norm(minus(x, *y)) < 1e-9);
                number.push(same.unwrap_or_else(|| {
                    mesh.nodes.push(x);
                    mesh.nodes.len() - 1
                }));
            }
            let first = mesh.elements.len();
            mesh.elements.extend(other.elements.iter().map(|cell| cell.renumbered(|node| number[node])));
            mesh.regions[0].elements.extend(first..mesh.elements.len());
            hanging(&mesh).len()
        };
        for kind in [Hexahedron8, Hexahedron20, Hexahedron27] {
            assert_eq!(joined((kind, 2), (kind, 2)), 0, "{kind:?}");
            assert!(joined((kind, 1), (kind, 2)) > 0, "{kind:?}");
        }
        // The middles of the twelve edges of four faces.
        assert_eq!(joined((Hexahedron8, 2), (Hexahedron20, 2)), 12);
        assert_eq!(joined((Hexahedron20, 2), (Hexahedron8, 2)), 12);
    }

    /// Two plates side by side, of `left` and `right` cells along the seam, which share the nodes at equal places.
    fn side_by_side(
        [left, right]: [usize; 2],
        faces: Faces,
        seam: impl Fn(f64) -> f64,
        reverse: bool,
    ) -> Mesh {
        let mut mesh = structured_plate(1.0, 1.0, 4, left, faces).unwrap();
        mesh.regions.truncate(1);
        mesh.elements.truncate(mesh.regions[0].elements.len());
        let mut other = structured_plate(1.0, 1.0, 4, right, faces).unwrap();
        other.regions.truncate(1);
        other.elements.truncate(other.regions[0].elements.len());
        let [low, high] = crate::check::bounds(&mesh).unwrap();
        let width = high[0] - low[0];
        other.nodes.iter_mut().for_each(|x| x[0] += width);
        // The right one's nodes in another order.
        let count = other.nodes.len();
        let turn = |node: usize| if reverse { count - 1 - node } else { node };
        if reverse {
            other.nodes.reverse();
        }
        let mut of = vec![0; count];
        for (node, x) in other.nodes.iter().enumerate() {
            let same = mesh.nodes.iter().position(|y| norm(minus(*x, *y)) < 1e-9);
            of[node] = same.unwrap_or_else(|| {
                mesh.nodes.push(*x);
                mesh.nodes.len() - 1
            });
        }
        let first = mesh.elements.len();
        mesh.elements.extend(other.elements.iter().map(|cell| cell.renumbered(|node| of[turn(node)])));
        let elements = first..mesh.elements.len();
        mesh.regions[0].elements.extend(elements);
        // The seam as an arc.
        for x in &mut mesh.nodes {
            x[2] += seam(x[1]);
        }
        mesh
    }

    /// The nodes of a seam that only one side has.
    fn alone(left: usize, right: usize) -> usize {
        let both = |k: &usize| left.is_multiple_of(*k) && right.is_multiple_of(*k);
        left + right - 2 * (1..=left).rev().find(both).unwrap()
    }

    /// All divisions of two halves: as many nodes hang as the seam has that the sides do not share.
    #[test]
    fn every_node_that_only_one_side_of_a_seam_has_is_found() {
        for faces in [Faces::Triangles, Faces::Quadrilaterals] {
            for (left, right) in (3..=9).flat_map(|left| (3..=9).map(move |right| (left, right))) {
                for reverse in [false, true] {
                    let mesh = side_by_side([left, right], faces, |_| 0.0, reverse);
                    let expected = alone(left, right);
                    assert_eq!(hanging(&mesh).len(), expected, "{left} {right}");
                    let told =
                        diagnose(&mesh).warnings.iter().any(|w| w.found.contains("nodes on edges of faces"));
                    assert_eq!(told, expected > 0);
                }
            }
        }
    }

    /// A bar along a line of a plate, with as many elements, more or fewer: the nodes that only one of both has.
    #[test]
    fn nodes_that_a_bar_along_a_plate_does_not_share_are_found() {
        for faces in [Faces::Triangles, Faces::Quadrilaterals] {
            for (of_plate, of_bar) in (2..=8).flat_map(|plate| (1..=9).map(move |bar| (plate, bar))) {
                let mut mesh = structured_plate(1.0, 1.0, of_plate, 2, faces).unwrap();
                let places: Vec<usize> = (0..=of_bar)
                    .map(|k| {
                        let place = [k as f64 / of_bar as f64 - 0.5, 0.0, 0.0];
                        let same = mesh.nodes.iter().position(|x| norm(minus(*x, place)) < 1e-9);
                        same.unwrap_or_else(|| {
                            mesh.nodes.push(place);
                            mesh.nodes.len() - 1
                        })
                    })
                    .collect();
                mesh.add_region("bar", 1, places.windows(2).map(|pair| Cell::line([pair[0], pair[1]])));
                let expected = alone(of_plate, of_bar);
                assert_eq!(hanging(&mesh).len(), expected, "{of_plate} {of_bar}");
            }
        }
    }

    /// On an arc of 60° the nodes of one side lie off the chords of the other.
    #[test]
    fn nodes_on_arcs_are_found() {
        for (left, right) in [(12, 13), (13, 12), (8, 24), (11, 17)] {
            let mesh = side_by_side([left, right], Faces::Triangles, |y| (1.0 - y * y).sqrt(), false);
            assert!(10 * hanging(&mesh).len() >= 8 * alone(left, right), "{left} {right}");
        }
    }
}
