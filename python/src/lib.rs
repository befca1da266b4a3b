//! The compiled part of the Python package `snell`: it reads scenes and draws them. What scenes are made of it knows by
//! name alone, so that components of other crates work as the built-in ones do.

#![forbid(unsafe_code)]

mod picture;
mod renderer;

use pyo3::{create_exception, exceptions::PyValueError, prelude::*, types::PyCFunction};
use snell::Renderer;

create_exception!(snell, SceneError, PyValueError, "What is wrong with a scene, one fault a line.");

/// Fills a module with what `snell.Scene(native=…)` takes: a renderer with components of one's own.
///
/// ```ignore
/// #[pymodule]
/// fn rings(module: &Bound<'_, PyModule>) -> PyResult<()> {
///     snell_native::fill(module, || snell::Renderer::new().with_primitive::<Torus>())
/// }
/// ```
///
/// # Errors
/// What Python has against the module.
pub fn fill(module: &Bound<'_, PyModule>, make: impl Fn() -> Renderer + Send + Sync + 'static) -> PyResult<()> {
    module.add_class::<picture::Picture>()?;
    module.add("SceneError", module.py().get_type::<SceneError>())?;
    let renderer = move |_: &Bound<'_, pyo3::types::PyTuple>, _: Option<&Bound<'_, pyo3::types::PyDict>>| {
        Ok::<_, PyErr>(renderer::PyRenderer::new(make()))
    };
    module.add("renderer", PyCFunction::new_closure(module.py(), Some(c"renderer"), None, renderer)?)
}

/// The built-in components.
#[pymodule]
fn snell_native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    fill(module, Renderer::new)
}
