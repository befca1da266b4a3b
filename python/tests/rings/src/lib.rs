//! What is in the crate `outside`, for Python.

use pyo3::prelude::*;

/// Snell with rings, beams, stripes and grain.
#[pymodule]
fn rings(module: &Bound<'_, PyModule>) -> PyResult<()> {
    snell_native::fill(module, outside::renderer)
}
