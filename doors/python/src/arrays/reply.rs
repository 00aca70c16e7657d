//! Converts replies of libraries to dicts of Python.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

/// Returns a reply as the dict that its JSON describes. A number that is not finite becomes None.
pub(crate) fn dict_of<'py>(py: Python<'py>, reply: &impl Serialize) -> PyResult<Bound<'py, PyDict>> {
    let text = serde_json::to_string(reply).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(py.import("json")?.call_method1("loads", (text,))?.cast_into::<PyDict>()?)
}
