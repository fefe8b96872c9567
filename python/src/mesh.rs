//! Meshes of Python as Gmsh files, and meshes as arrays.

use crate::errors::raised;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stridor::error::{Error, Fault, Faults, Result};
use stridor::mesh::{Cell, CellKind, Mesh, Region, to_msh_exactly};

/// Cells of one type of VTK, a row a cell.
type Block<'py> = (i64, PyReadonlyArray2<'py, i64>);

/// The Gmsh file, in metres as `points` are, of cells on points and of regions: names, dimensions and the numbers of their cells, blocks one
/// after the other.
#[pyfunction]
pub fn mesh_text(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    blocks: Vec<Block<'_>>,
    regions: Vec<(String, usize, Vec<usize>)>,
) -> PyResult<String> {
    let points = points.as_array();
    let nodes = points.rows().into_iter();
    let nodes = nodes.map(|at| std::array::from_fn(|k| at.get(k).copied().unwrap_or(0.0)));
    let mut mesh = Mesh { nodes: nodes.collect(), ..Mesh::default() };
    let mut faults = Faults::new();
    for (index, (number, rows)) in blocks.iter().enumerate() {
        let place = format!("cells[{index}]");
        for (row, own) in rows.as_array().rows().into_iter().enumerate() {
            let own: Vec<i64> = own.iter().copied().collect();
            match cell(*number, &own, &mesh.nodes, &place, row) {
                Ok(cell) => mesh.elements.push(cell),
                Err(fault) => {
                    faults.push(fault);
                    break;
                }
            }
        }
    }
    let regions = regions.into_iter().map(|(name, dimension, elements)| Region { name, dimension, elements });
    mesh.regions = regions.collect();
    let text = faults.into_result(()).and_then(|()| py.detach(|| text(&mesh)));
    raised(py, text)
}

/// A dict of arrays, named as the geometry of results: places, and of each cell VTK's type and its nodes in VTK's order; and the regions.
pub fn arrays<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyDict>> {
    let kinds: Vec<i64> =
        mesh.elements.iter().map(|cell| i64::from(cell.kind().table().vtk.number)).collect();
    let nodes: Vec<i64> = mesh.elements.iter().flat_map(Cell::to_vtk).map(|node| node as i64).collect();
    let mut offsets = vec![0];
    offsets.extend(mesh.elements.iter().scan(0, |end, cell| {
        *end += cell.nodes().len() as i64;
        Some(*end)
    }));
    let regions = mesh.regions.iter().map(|own| (&own.name, own.dimension, own.elements.clone()));
    let dict = PyDict::new(py);
    dict.set_item("nodes", mesh.nodes.iter().flatten().copied().collect::<Vec<f64>>().into_pyarray(py))?;
    dict.set_item("element_kind", kinds.into_pyarray(py))?;
    dict.set_item("element_nodes", nodes.into_pyarray(py))?;
    dict.set_item("element_offsets", offsets.into_pyarray(py))?;
    dict.set_item("regions", regions.collect::<Vec<_>>())?;
    Ok(dict)
}

/// The cell of a row of a block.
fn cell(
    number: i64,
    own: &[i64],
    nodes: &[[f64; 3]],
    place: &str,
    row: usize,
) -> std::result::Result<Cell, Fault> {
    let Some((kind, _)) = CellKind::of_vtk(number) else {
        let names: Vec<&str> = CellKind::all().map(|kind| kind.table().name).collect();
        return Err(Fault::new(
            place,
            format!("VTK's type {number} of cells"),
            format!("one of {}", names.join(", ")),
        ));
    };
    let node = |point: &i64| usize::try_from(*point).ok().filter(|point| *point < nodes.len());
    let Some(points) = own.iter().map(node).collect::<Option<Vec<usize>>>() else {
        let found = format!("points {own:?} in row {row}");
        return Err(Fault::new(
            place,
            found,
            format!("numbers of points, 0 to {}", nodes.len().saturating_sub(1)),
        ));
    };
    Cell::from_vtk(number, &points, |node| nodes[node]).ok_or_else(|| {
        Fault::new(
            place,
            format!("{} points a row", own.len()),
            format!("{} of a {}", kind.n_nodes(), kind.table().name),
        )
    })
}

/// The text, once the cells of regions are there and have their dimension.
fn text(mesh: &Mesh) -> Result<String> {
    for Region { name, dimension, elements } in &mesh.regions {
        let wrong = elements
            .iter()
            .find(|k| mesh.elements.get(**k).is_none_or(|cell| cell.dimension() != *dimension));
        if let Some(wrong) = wrong {
            let found = format!("cell {wrong} in region \"{name}\"");
            let fault = Fault::new("regions", found, format!("cells of dimension {dimension} of the mesh"));
            return Err(Error::input(fault));
        }
    }
    to_msh_exactly(mesh)
}
