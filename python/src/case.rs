//! Cases: read from files, TOML text or tables, with scalars that can be changed.

use crate::errors::raised;
use crate::model::Parts;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::BTreeMap;
use std::ops::Bound;
use std::path::PathBuf;
use std::sync::Arc;
use stridor::error::{Error, Fault, Faults, Result};
use stridor::job::{Prepared, check_case};

/// A validated case.
#[pyclass(frozen, module = "stridor._native")]
pub struct Case {
    pub inner: Arc<stridor::case::Case>,
}

impl From<stridor::case::Case> for Case {
    fn from(case: stridor::case::Case) -> Self {
        Case { inner: Arc::new(case) }
    }
}

/// A number in SI units, or a text with a unit.
#[derive(FromPyObject)]
enum Amount {
    Number(f64),
    Text(String),
}

/// A number of a case: path, value, SI unit, lower and upper bound with whether each is allowed itself.
type Scalar = (String, f64, &'static str, (f64, bool), (f64, bool));

#[pymethods]
impl Case {
    /// The case of a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        raised(py, stridor::case::read_case(&path).map(Case::from))
    }

    /// The case of a template, written into a new folder.
    #[staticmethod]
    fn from_template(py: Python<'_>, folder: PathBuf, template: &str) -> PyResult<Self> {
        raised(py, stridor::cli::new_case(&folder, template))?;
        Self::read(py, folder.join("case.toml"))
    }

    /// The case made of a model of another program in a new folder, and what the user should know of it.
    #[staticmethod]
    fn from_deck(
        py: Python<'_>,
        file: PathBuf,
        unit: &str,
        folder: PathBuf,
        format: Option<&str>,
    ) -> PyResult<(Self, Vec<String>)> {
        let made = py.detach(|| stridor::cli::import_deck(&file, unit, format, &folder));
        let (_, made) = raised(py, made)?;
        let unread = made.ledger.rows().filter(|row| row.weight == stridor::decks::Weight::Matters);
        let unread: Vec<String> = unread.map(|row| format!("Not read: {}: {}", row.what, row.why)).collect();
        let warnings = made.warnings.iter().cloned().chain(unread).collect();
        Ok((Self::read(py, folder.join("case.toml"))?, warnings))
    }

    /// The case of TOML text; relative paths start from `folder`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, folder: PathBuf) -> PyResult<Self> {
        raised(py, stridor::case::Case::parse("", text, folder).map(Case::from))
    }

    /// The case of a JSON object with the keys of a case file.
    #[staticmethod]
    fn parse_json(py: Python<'_>, text: &str, folder: PathBuf) -> PyResult<Self> {
        let case = toml_of_json(text).and_then(|text| stridor::case::Case::parse("", &text, folder));
        raised(py, case.map(Case::from))
    }

    /// One line for reports.
    #[getter]
    fn title(&self) -> &str {
        &self.inner.title
    }

    /// The folder that relative paths start from.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.inner.folder.clone()
    }

    /// The case as TOML in SI units with every default written out.
    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    /// Every number of the case.
    fn scalars(&self) -> Vec<Scalar> {
        let bound = |bound: Bound<f64>, open: f64| match bound {
            Bound::Included(value) => (value, true),
            Bound::Excluded(value) => (value, false),
            Bound::Unbounded => (open, false),
        };
        let scalar = |p: stridor::case::Parameter| {
            let (low, high) = p.bounds;
            (p.path, p.value, p.unit, bound(low, f64::NEG_INFINITY), bound(high, f64::INFINITY))
        };
        self.inner.parameters().into_iter().map(scalar).collect()
    }

    /// The number at a path.
    fn scalar(&self, py: Python<'_>, path: &str) -> PyResult<f64> {
        raised(py, self.inner.parameter(path).map(|scalar| scalar.value))
    }

    /// The same case with other numbers at some paths.
    fn with_scalars(&self, py: Python<'_>, values: BTreeMap<String, Amount>) -> PyResult<Self> {
        let value = |(path, amount): (&String, &Amount)| match amount {
            Amount::Number(value) => Ok((path.clone(), *value)),
            Amount::Text(text) => Ok((path.clone(), self.inner.parameter_value(path, text)?)),
        };
        let case =
            values.iter().map(value).collect::<Result<Vec<_>>>().and_then(|values| {
                self.inner.with_parameters(values.iter().map(|(path, value)| (path, *value)))
            });
        raised(py, case.map(Case::from))
    }

    /// What the user should know of the case and its mesh.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let warnings = py.detach(|| {
            let warnings = check_case(&Prepared::new(&self.inner)?).map_err(|error| self.located(error))?;
            Ok(warnings.words().collect())
        });
        raised(py, warnings)
    }

    /// The mesh with its regions.
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<pyo3::Bound<'py, PyDict>> {
        let mesh = py.detach(|| Prepared::new(&self.inner).map(|prepared| prepared.regions.mesh));
        crate::mesh::arrays(py, &*raised(py, mesh)?)
    }

    /// M, C, K, the load, the degrees of freedom and the contact points.
    fn model<'py>(&self, py: Python<'py>) -> PyResult<pyo3::Bound<'py, PyDict>> {
        let parts = py.detach(|| Parts::of(&Prepared::new(&self.inner)?));
        raised(py, parts)?.into_python(py)
    }
}

impl Case {
    /// The same error with file and line of the keys that it names.
    pub fn located(&self, error: Error) -> Error {
        self.inner.places.locate(error)
    }
}

/// The TOML text of a JSON object.
fn toml_of_json(text: &str) -> Result<String> {
    let refused = |found: String| Error::input(Fault::new("case", found, "a table of keys"));
    let value: serde_json::Value = serde_json::from_str(text).map_err(|error| refused(error.to_string()))?;
    let mut faults = Faults::new();
    refuse_null(&value, "", &mut faults);
    faults.into_result(())?;
    toml::to_string(&value).map_err(|error| refused(error.to_string()))
}

/// A fault for each value that is not there: TOML has none.
fn refuse_null(value: &serde_json::Value, path: &str, faults: &mut Faults) {
    let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        serde_json::Value::Null => {
            let fault = Fault::new(format!("`{path}`"), "None", "a value");
            faults.push(fault.with_help("Leave the key out"));
        }
        serde_json::Value::Array(all) => {
            all.iter().enumerate().for_each(|(k, value)| refuse_null(value, &below(&k.to_string()), faults));
        }
        serde_json::Value::Object(all) => {
            all.iter().for_each(|(key, value)| refuse_null(value, &below(key), faults));
        }
        _ => {}
    }
}
