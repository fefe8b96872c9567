//! Errors of the library as exceptions of `stridor._errors`, with the same words.

use pyo3::prelude::*;
use stridor::error::{Error, Fault};

/// The exception for an error: `InputError` with its faults, `AnalysisError`, `MachineError`.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let raised = || {
        let errors = py.import("stridor._errors")?;
        let message = error.to_string();
        match error {
            Error::Input(faults) => {
                let parts = |fault: &Fault| {
                    let Fault { place, found, expected, help } = fault.clone();
                    (place, found, expected, help)
                };
                let faults: Vec<_> = faults.0.iter().map(parts).collect();
                errors.getattr("InputError")?.call1((message, faults))
            }
            Error::Analysis { .. } => errors.getattr("AnalysisError")?.call1((message,)),
            Error::Io { .. } => errors.getattr("MachineError")?.call1((message,)),
        }
    };
    raised().map_or_else(|failure| failure, PyErr::from_value)
}

/// The value, or the exception for the error.
pub fn raised<T>(py: Python<'_>, result: stridor::error::Result<T>) -> PyResult<T> {
    result.map_err(|error| exception(py, &error))
}
