//! Structured meshes for convergence studies: every refinement is similar to the one before.

use super::plate::add_edges;
use super::{Faults, require_positive};
use crate::{Cell, Mesh};
use std::f64::consts::TAU;
use stridor_base::error::{Fault, Result};

/// Shape of the faces of a structured plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Faces {
    /// Two triangles a cell, diagonals alternating.
    Triangles,
    /// One quadrilateral a cell.
    Quadrilaterals,
}

/// A rectangle of `nx` × `ny` equal cells in the plane z = 0, centre at the origin, normals +z; regions
/// `plate` and `plate_edge_x_min` …. With even `nx` and `ny` it is its own mirror image in x and y.
///
/// # Errors
/// Lengths that are not positive, no cells or too many.
///
/// ```
/// use stridor_mesh::generate::{Faces, structured_plate};
/// let mesh = structured_plate(1.0, 0.5, 4, 2, Faces::Quadrilaterals)?;
/// assert_eq!((mesh.nodes.len(), mesh.region("plate").unwrap().elements.len()), (15, 8));
/// # Ok::<(), stridor_base::error::Error>(())
/// ```
pub fn structured_plate(length: f64, width: f64, nx: usize, ny: usize, faces: Faces) -> Result<Mesh> {
    let mut faults = require_positive("plate", &[("length", length), ("width", width)]);
    require_cells(&mut faults, "plate", nx, ny);
    faults.into_result(())?;
    let mut mesh = Mesh::default();
    for j in 0..=ny {
        for i in 0..=nx {
            // Symmetric about zero bit for bit, ends exact: (2i − n)/n only changes its sign.
            let at = |i: usize, n: usize, whole: f64| whole / 2.0 * (((2 * i) as f64 - n as f64) / n as f64);
            mesh.nodes.push([at(i, nx, length), at(j, ny, width), 0.0]);
        }
    }
    let node = |i: usize, j: usize| j * (nx + 1) + i;
    let cells = (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j)));
    let elements: Vec<Cell> = cells
        .flat_map(|(i, j)| {
            cell([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)], i + j, faces)
        })
        .collect();
    mesh.add_region("plate", 2, elements);
    add_edges(&mut mesh, "plate", length, width);
    Ok(mesh)
}

/// Triangles of an annulus b ≤ r ≤ a, or of a disc with a node in the middle where b = 0, in the plane x = 0, normals +x, with equal steps in radius and angle; the
/// first node of each ring is at the bottom (y = 0, z = −r). `n_angular` must be even: diagonals alternate, so that
/// the mesh is its own mirror image in y and repeats itself every two cells.
/// Regions `disc` (faces), `rim` and, where b > 0, `hub` (lines).
///
/// # Errors
/// Radii that are not 0 ≤ b < a, an odd `n_angular` or fewer than 6, no cells or too many.
pub fn structured_annulus(b: f64, a: f64, n_radial: usize, n_angular: usize) -> Result<Mesh> {
    let mut faults = require_positive("annulus", &[("outer radius", a)]);
    if b != 0.0 {
        faults.0.extend(require_positive("annulus", &[("hub radius", b)]).0);
    }
    require_cells(&mut faults, "annulus", n_radial, n_angular);
    if b >= a {
        let found = format!("{b} m, not smaller than the outer radius, {a} m");
        faults.push(Fault::new("annulus hub radius", found, "a smaller one"));
    }
    if n_angular < 6 || n_angular % 2 == 1 {
        faults.push(Fault::new("annulus `n_angular`", n_angular.to_string(), "an even number of at least 6"));
    }
    faults.into_result(())?;
    let mut mesh = Mesh::default();
    let whole = b == 0.0;
    if whole {
        mesh.nodes.push([0.0; 3]);
    }
    for i in usize::from(whole)..=n_radial {
        let r = if i == n_radial { a } else { b + (a - b) * i as f64 / n_radial as f64 };
        mesh.nodes.extend((0..n_angular).map(|j| {
            let [y, z] = on_circle(j, n_angular);
            [0.0, r * y, r * z]
        }));
    }
    let node = |i: usize, j: usize| match (whole, i) {
        (true, 0) => 0,
        (true, _) => 1 + (i - 1) * n_angular + j % n_angular,
        (false, _) => i * n_angular + j % n_angular,
    };
    let cells = (0..n_radial).flat_map(|i| (0..n_angular).map(move |j| (i, j)));
    let elements: Vec<Cell> = cells
        .flat_map(|(i, j)| match whole && i == 0 {
            true => vec![Cell::triangle([0, node(1, j), node(1, j + 1)])],
            false => cell(
                [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)],
                i + j,
                Faces::Triangles,
            ),
        })
        .collect();
    mesh.add_region("disc", 2, elements);
    mesh.add_region("rim", 1, (0..n_angular).map(|j| Cell::line([node(n_radial, j), node(n_radial, j + 1)])));
    if !whole {
        mesh.add_region("hub", 1, (0..n_angular).map(|j| Cell::line([node(0, j), node(0, j + 1)])));
    }
    Ok(mesh)
}

/// (sin, −cos) of j/n of a turn; node n − j is the exact mirror image of node j.
fn on_circle(j: usize, n: usize) -> [f64; 2] {
    let mirrored = 2 * j > n;
    let j = if mirrored { n - j } else { j };
    let (sin, cos) = (TAU * j as f64 / n as f64).sin_cos();
    match (j == 0, 2 * j == n) {
        (true, _) => [0.0, -1.0],
        (_, true) => [0.0, 1.0],
        _ => [if mirrored { -sin } else { sin }, -cos],
    }
}

/// One cell as a quadrilateral or as two triangles; the diagonal turns with the parity.
fn cell([a, b, c, d]: [usize; 4], parity: usize, faces: Faces) -> Vec<Cell> {
    match (faces, parity % 2) {
        (Faces::Quadrilaterals, _) => vec![Cell::quadrilateral([a, b, c, d])],
        (Faces::Triangles, 0) => vec![Cell::triangle([a, b, c]), Cell::triangle([a, c, d])],
        (Faces::Triangles, _) => vec![Cell::triangle([a, b, d]), Cell::triangle([b, c, d])],
    }
}

fn require_cells(faults: &mut Faults, part: &str, n: usize, m: usize) {
    if n == 0 || m == 0 || n.saturating_mul(m) > super::MOST_NODES as usize {
        let expected = format!("at least one in each direction and at most {:.0} in all", super::MOST_NODES);
        faults.push(Fault::new(format!("{part} cells"), format!("{n} × {m}"), expected));
    }
}
