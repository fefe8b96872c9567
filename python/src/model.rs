//! M, C, K, the load, the degrees of freedom and the contact points of a case as arrays.

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stridor::job::Prepared;
use stridor::linalg::{SparseMatrix, SparseVector};
use stridor::system::{ConstantMatrices, ContactPair};

/// What a model consists of.
pub struct Parts {
    pub matrices: ConstantMatrices,
    /// f \[N, N m\].
    load: Vec<f64>,
    /// The node of each degree of freedom.
    nodes: Vec<i64>,
    /// The motion (ux, uy, uz, rx, ry, rz) of the node when it is one.
    directions: Vec<f64>,
    /// Where the node is \[m\].
    positions: Vec<f64>,
    pairs: Vec<ContactPair>,
}

impl Parts {
    /// Those of a prepared case.
    ///
    /// # Errors
    /// Not enough memory for the sums.
    pub fn of(prepared: &Prepared) -> stridor::error::Result<Self> {
        let places = prepared.geometry().nodes;
        let dofs = prepared.assembled.dofs.free_dofs();
        Ok(Parts {
            matrices: prepared.system.constant_matrices()?,
            load: prepared.system.load.clone(),
            nodes: dofs.iter().map(|dof| dof.node as i64).collect(),
            directions: dofs.iter().flat_map(|dof| dof.direction).collect(),
            positions: dofs.iter().flat_map(|dof| places[dof.node]).collect(),
            pairs: prepared.system.pairs.clone(),
        })
    }

    /// A dict of arrays; matrices as [`columns`].
    pub fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let n = self.load.len();
        let ConstantMatrices { mass, damping, stiffness, loss } = &self.matrices;
        let dict = PyDict::new(py);
        dict.set_item("mass", columns(py, mass)?)?;
        dict.set_item("damping", damping.as_ref().map(|c| columns(py, c)).transpose()?)?;
        dict.set_item("stiffness", columns(py, stiffness)?)?;
        dict.set_item("loss", loss.as_ref().map(|h| columns(py, h)).transpose()?)?;
        dict.set_item("load", self.load.into_pyarray(py))?;
        dict.set_item("node", self.nodes.into_pyarray(py))?;
        dict.set_item("direction", self.directions.into_pyarray(py))?;
        dict.set_item("position", self.positions.into_pyarray(py))?;
        let pairs = self.pairs.iter().map(|pair| contact(py, pair, n)).collect::<PyResult<Vec<_>>>()?;
        dict.set_item("contacts", pairs)?;
        Ok(dict)
    }
}

/// The points of a pair and their directions, n × points.
fn contact<'py>(py: Python<'py>, pair: &ContactPair, n: usize) -> PyResult<Bound<'py, PyDict>> {
    let points = &pair.points;
    let dict = PyDict::new(py);
    dict.set_item("name", &pair.name)?;
    dict.set_item("sliding_velocity", pair.sliding_velocity)?;
    let positions: Vec<f64> = points.iter().flat_map(|point| point.position).collect();
    dict.set_item("position", positions.into_pyarray(py))?;
    dict.set_item("gap", points.iter().map(|point| point.gap).collect::<Vec<_>>().into_pyarray(py))?;
    dict.set_item("weight", points.iter().map(|point| point.weight).collect::<Vec<_>>().into_pyarray(py))?;
    dict.set_item("normal", vectors(py, points.iter().map(|point| &point.normal), n)?)?;
    for (k, key) in ["tangent_1", "tangent_2"].into_iter().enumerate() {
        dict.set_item(key, vectors(py, points.iter().map(|point| &point.tangents[k]), n)?)?;
    }
    Ok(dict)
}

/// Values, row indices, starts of the columns and shape of a matrix in compressed columns.
type Columns<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<i32>>, (usize, usize));

fn columns<'py>(py: Python<'py>, matrix: &SparseMatrix) -> PyResult<Columns<'py>> {
    let pattern = matrix.symbolic();
    let rows = pattern.row_idx().iter().map(|row| index(*row as usize));
    let starts = pattern.col_ptr().iter().map(|start| index(*start as usize));
    Ok((
        matrix.val().to_vec().into_pyarray(py),
        rows.collect::<PyResult<Vec<_>>>()?.into_pyarray(py),
        starts.collect::<PyResult<Vec<_>>>()?.into_pyarray(py),
        (matrix.nrows(), matrix.ncols()),
    ))
}

/// Sparse vectors of length `n` as the columns of a matrix.
fn vectors<'py, 'v>(
    py: Python<'py>,
    vectors: impl Iterator<Item = &'v SparseVector>,
    n: usize,
) -> PyResult<Columns<'py>> {
    let (mut values, mut rows, mut starts) = (Vec::new(), Vec::new(), vec![0]);
    for vector in vectors {
        values.extend_from_slice(vector.values());
        rows.extend(vector.indices().iter().map(|row| index(*row)).collect::<PyResult<Vec<_>>>()?);
        starts.push(index(rows.len())?);
    }
    let shape = (n, starts.len() - 1);
    Ok((values.into_pyarray(py), rows.into_pyarray(py), starts.into_pyarray(py), shape))
}

/// An index as SciPy stores it.
fn index(value: usize) -> PyResult<i32> {
    let too_large = |_| pyo3::exceptions::PyOverflowError::new_err("a matrix of more than 2³¹ entries");
    i32::try_from(value).map_err(too_large)
}
