//! Described results as nested dicts: `{"description", "variables": {key: Variable}, "groups": {key: …}}`, laid out as in
//! `results.h5`.

use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{Element, IntoPyArray};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use stridor::dataset::{Entry, Group, Table, Values, Variable, link};

/// A group as a dict.
pub fn to_python<'py>(py: Python<'py>, group: &Group) -> PyResult<Bound<'py, PyDict>> {
    let node = node(py)?;
    add(&node, group)?;
    Ok(node)
}

/// Rows of a field that is worked out on request: the variable `key` of the group at `path`.
pub fn rows<'py>(
    py: Python<'py>,
    group: &Group,
    (path, key): (&[String], &str),
    rows: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let variable = find(group, path, key).ok_or_else(|| PyKeyError::new_err(key.to_string()))?;
    let mut shape = variable.shape();
    if let Some(first) = shape.first_mut() {
        *first = rows.len();
    }
    match &variable.values {
        Values::RealRows(row) => array(py, &shape, rows.iter().flat_map(|k| row(*k)).collect()),
        Values::ComplexRows(row) => array(py, &shape, rows.iter().flat_map(|k| row(*k)).collect()),
        _ => Err(PyKeyError::new_err(key.to_string())),
    }
}

fn node(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let node = PyDict::new(py);
    node.set_item("description", "")?;
    node.set_item("variables", PyDict::new(py))?;
    node.set_item("groups", PyDict::new(py))?;
    Ok(node)
}

fn part<'py>(node: &Bound<'py, PyDict>, key: &str) -> PyResult<Bound<'py, PyDict>> {
    let part = node.get_item(key)?.ok_or_else(|| PyKeyError::new_err(key.to_string()))?;
    Ok(part.cast_into()?)
}

/// The group `key` in a node, made where it is not there.
fn opened<'py>(parent: &Bound<'py, PyDict>, key: &str) -> PyResult<Bound<'py, PyDict>> {
    let groups = part(parent, "groups")?;
    let key = link(key);
    if !groups.contains(&key)? {
        groups.set_item(&key, node(parent.py())?)?;
    }
    part(&groups, &key)
}

/// Adds what a group holds to a node.
fn add(node: &Bound<'_, PyDict>, group: &Group) -> PyResult<()> {
    if !group.description.is_empty() {
        node.set_item("description", group.description)?;
    }
    for entry in &group.entries {
        match entry {
            Entry::Variable(variable) => add_variable(node, variable)?,
            Entry::Group(inner) => add(&opened(node, &inner.key)?, inner)?,
            Entry::Table(table) => add_table(node, table)?,
            Entry::List(key, groups) if !groups.is_empty() => {
                let list = opened(node, key)?;
                groups.iter().try_for_each(|inner| add(&opened(&list, &inner.key)?, inner))?;
            }
            Entry::Parts(key, _, tables) if !tables.is_empty() => {
                let list = opened(node, key)?;
                tables.iter().try_for_each(|table| add_table(&list, table))?;
            }
            Entry::List(..) | Entry::Parts(..) | Entry::Absent(_) => {}
        }
    }
    Ok(())
}

fn add_table(parent: &Bound<'_, PyDict>, table: &Table) -> PyResult<()> {
    let node = opened(parent, &table.key)?;
    table.columns.iter().chain(&table.fields).try_for_each(|variable| add_variable(&node, variable))
}

/// Adds `(dimensions, shape, values, unit, description)`, and the coordinates of its dimensions that are not there. The values are
/// an array, a list of texts, or the name of the type of a field that is worked out on request.
fn add_variable(node: &Bound<'_, PyDict>, variable: &Variable) -> PyResult<()> {
    let py = node.py();
    let variables = part(node, "variables")?;
    let shape = variable.shape();
    let dimensions: Vec<&str> = variable.dimensions.iter().map(|d| d.name).collect();
    let values = match &variable.values {
        Values::Flags(all) => array(py, &shape, all.clone())?,
        Values::Integers(all) => array(py, &shape, all.clone())?,
        Values::Sparse(all) => {
            let number = |value: &Option<i64>| value.map_or(f64::NAN, |value| value as f64);
            array(py, &shape, all.iter().map(number).collect())?
        }
        Values::Reals(all) => array(py, &shape, all.clone())?,
        Values::Complexes(all) => array(py, &shape, all.clone())?,
        Values::Texts(all) => PyList::new(py, all.iter().map(|t| t.as_deref().unwrap_or("")))?.into_any(),
        Values::RealRows(_) => "float64".into_pyobject(py)?.into_any(),
        Values::ComplexRows(_) => "complex128".into_pyobject(py)?.into_any(),
    };
    variables
        .set_item(&*variable.key, (dimensions, shape, values, &*variable.unit, &*variable.description))?;
    for dimension in &variable.dimensions {
        if !variables.contains(dimension.name)? && dimension.name != variable.key {
            add_variable(node, &dimension.coordinate())?;
        }
    }
    Ok(())
}

/// Values in rows as a NumPy array.
fn array<'py, T: Element>(py: Python<'py>, shape: &[usize], values: Vec<T>) -> PyResult<Bound<'py, PyAny>> {
    let array = ArrayD::from_shape_vec(IxDyn(shape), values)
        .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// The variable `key` of the group at `path`.
fn find<'g, 'a>(group: &'g Group<'a>, path: &[String], key: &str) -> Option<&'g Variable<'a>> {
    let named = |variable: &&Variable| variable.key == key;
    let in_table = |table: &'g Table<'a>, rest: &[String]| match rest {
        [own] if *own == link(&table.key) => table.columns.iter().chain(&table.fields).find(named),
        _ => None,
    };
    let in_group = |inner: &'g Group<'a>, rest: &[String]| match rest {
        [own, rest @ ..] if *own == link(&inner.key) => find(inner, rest, key),
        _ => None,
    };
    group.entries.iter().find_map(|entry| match (entry, path) {
        (Entry::Variable(variable), []) => Some(variable).filter(named),
        (Entry::Group(inner), _) => in_group(inner, path),
        (Entry::Table(table), _) => in_table(table, path),
        (Entry::List(own, groups), [first, rest @ ..]) if own == first => {
            groups.iter().find_map(|inner| in_group(inner, rest))
        }
        (Entry::Parts(own, _, tables), [first, rest @ ..]) if own == first => {
            tables.iter().find_map(|table| in_table(table, rest))
        }
        _ => None,
    })
}
