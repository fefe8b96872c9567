//! Boxes of solids of any kind.

use super::{MOST_NODES, require_positive};
use crate::{Cell, CellKind, CellShape, Mesh};
use std::collections::HashMap;
use stridor_base::error::{Error, Fault, Result};

/// A box from the origin to `lengths` \[m\] of `cells` × bricks, each made of one or some cells of `kind`: a hexahedron, two wedges, six
/// tetrahedra, or six pyramids around a node in its middle. Regions `solid`, and `x_min`, `x_max`, `y_min`, `y_max`, `z_min`, `z_max` (faces).
///
/// # Errors
/// Lengths that are not positive, no bricks, a kind that is no solid, absurdly many nodes.
///
/// ```
/// use stridor_mesh::{CellKind, generate::structured_box};
/// let mesh = structured_box(CellKind::Tetrahedron10, [1.0, 0.5, 0.2], [4, 2, 1])?;
/// assert_eq!(mesh.require("solid", 3)?.elements.len(), 48);
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn structured_box(kind: CellKind, lengths: [f64; 3], cells: [usize; 3]) -> Result<Mesh> {
    let [x, y, z] = lengths;
    let mut faults = require_positive("box", &[("length", x), ("width", y), ("height", z)]);
    let count: f64 = cells.iter().map(|n| *n as f64).product::<f64>() * 8.0;
    if count == 0.0 || count > MOST_NODES {
        faults.push(Fault::new(
            "box `cells`",
            format!("{cells:?}"),
            "one or more along each side, a million in all",
        ));
    }
    faults.into_result(())?;
    let (corners, bricks) = bricks(cells);
    let scaled = |at: [f64; 3]| std::array::from_fn(|k| lengths[k] * at[k] / cells[k] as f64);
    let mut mesh = Mesh { nodes: corners.into_iter().map(scaled).collect(), ..Mesh::default() };
    let mut solids = Vec::new();
    for brick in bricks {
        solids.extend(split(kind, brick, &mut mesh)?);
    }
    let solids = with_middles(kind, solids, &mut mesh);
    mesh.add_region("solid", 3, solids);
    let skin = mesh.skin(0..mesh.elements.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (end, at) in [("min", 0.0), ("max", lengths[axis])] {
            let on = |face: &Cell| {
                face.nodes().iter().all(|n| (mesh.nodes[*n][axis] - at).abs() < 1e-9 * lengths[axis])
            };
            let faces: Vec<Cell> = skin.iter().map(|side| mesh.side(*side)).filter(on).collect();
            mesh.add_region(&format!("{name}_{end}"), 2, faces);
        }
    }
    Ok(mesh)
}

/// The corners of bricks of unit sides, and each brick's eight in the order of a hexahedron.
fn bricks([nx, ny, nz]: [usize; 3]) -> (Vec<[f64; 3]>, Vec<[usize; 8]>) {
    let id = |i: usize, j: usize, k: usize| (k * (ny + 1) + j) * (nx + 1) + i;
    let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for k in 0..=nz {
        for j in 0..=ny {
            nodes.extend((0..=nx).map(|i| [i as f64, j as f64, k as f64]));
        }
    }
    let mut bricks = Vec::with_capacity(nx * ny * nz);
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let layer = |k: usize| [id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k)];
                let ([a, b, c, d], [e, f, g, h]) = (layer(k), layer(k + 1));
                bricks.push([a, b, c, d, e, f, g, h]);
            }
        }
    }
    (nodes, bricks)
}

/// The corners of the cells of `kind` in a brick; a pyramid's apex is a new node.
fn split(kind: CellKind, brick: [usize; 8], mesh: &mut Mesh) -> Result<Vec<Vec<usize>>> {
    use CellShape::*;
    let pick = |of: &[usize]| of.iter().map(|k| brick[*k]).collect::<Vec<_>>();
    Ok(match kind.table().shape {
        Hexahedron => vec![brick.to_vec()],
        Wedge => vec![pick(&[0, 1, 2, 4, 5, 6]), pick(&[0, 2, 3, 4, 6, 7])],
        // Around the diagonal from corner 0 to corner 6.
        Tetrahedron => [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
            .map(|t| pick(&t))
            .to_vec(),
        Pyramid => {
            mesh.nodes
                .push(std::array::from_fn(|k| brick.iter().map(|n| mesh.nodes[*n][k]).sum::<f64>() / 8.0));
            let apex = mesh.nodes.len() - 1;
            // A base is seen from inside counter-clockwise.
            let bases = CellKind::Hexahedron8.table().sides.iter().map(|(_, side)| {
                let mut base: Vec<usize> = side.iter().rev().map(|k| brick[usize::from(*k)]).collect();
                base.push(apex);
                base
            });
            bases.collect()
        }
        _ => {
            let found = kind.table().name;
            return Err(Error::input(Fault::new("box `kind`", found, "a kind of solids")));
        }
    })
}

/// Cells of `kind` with these corners, and with nodes in the middle of edges, faces and cells where it has them; cells share them.
fn with_middles(kind: CellKind, corners: Vec<Vec<usize>>, mesh: &mut Mesh) -> Vec<Cell> {
    let mut known: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut cell = |corners: Vec<usize>| {
        let node = |of: &&[u8]| {
            let mut own: Vec<usize> = of.iter().map(|k| corners[usize::from(*k)]).collect();
            if let [node] = own[..] {
                return node;
            }
            own.sort_unstable();
            let middle: [f64; 3] = std::array::from_fn(|k| {
                own.iter().map(|n| mesh.nodes[*n][k]).sum::<f64>() / own.len() as f64
            });
            *known.entry(own).or_insert_with(|| {
                mesh.nodes.push(middle);
                mesh.nodes.len() - 1
            })
        };
        let nodes: Vec<usize> = kind.table().middles.iter().map(node).collect();
        Cell::new(kind, &nodes).expect("a node of each row of the table")
    };
    corners.into_iter().map(&mut cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn boxes_of_every_kind_are_sound_and_have_their_volume() {
        for kind in CellKind::all().filter(|kind| kind.dimension() == 3) {
            let mesh = structured_box(kind, [1.0, 0.5, 0.2], [3, 2, 2]).unwrap();
            assert!(
                crate::diagnose(&mesh).faults.0.is_empty(),
                "{kind:?}: {:?}",
                crate::diagnose(&mesh).faults
            );
            let mut volume = 0.0;
            for cell in mesh.require("solid", 3).unwrap().elements.iter().map(|e| &mesh.elements[*e]) {
                for point in kind.quadrature(2) {
                    let mut j = nalgebra::Matrix3::<f64>::zeros();
                    for (node, g) in cell.nodes().iter().zip(kind.shape_gradients(point.at)) {
                        j += nalgebra::Vector3::from(mesh.nodes[*node]) * nalgebra::RowVector3::from(g);
                    }
                    assert!(j.determinant() > 0.0, "{kind:?}");
                    volume += point.weight * j.determinant();
                }
            }
            assert!(within((volume - 0.1).abs(), 1e-14, RoundOff), "{kind:?}: {volume}");
            // All of the skin is in one of the six faces.
            let skin = mesh.skin(0..mesh.elements.len()).len();
            let named: usize = mesh.regions[1..].iter().map(|region| region.elements.len()).sum();
            assert_eq!(skin, named, "{kind:?}");
        }
        assert!(structured_box(CellKind::Triangle3, [1.0; 3], [1; 3]).is_err());
        assert!(structured_box(CellKind::Wedge6, [1.0, f64::NAN, 1.0], [1, 0, 1]).is_err());
    }
}
