//! tigereye as a Python module: options and arrays in, results out. The package around it, `crates/python/tigereye`,
//! has the functions that people call, with their names, defaults and documentation.
//!
//! Like the program, this is an edge: it computes nothing itself. Unlike the program it writes no files; it returns
//! their bytes, which the package writes.

mod classical;
mod error;
mod gradient;
mod light;
mod picture;
mod plane;
mod scheme;
mod words;
mod work;

use pyo3::prelude::*;

/// The compiled part of tigereye. Use the package's functions instead.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<plane::TensorPlane>()?;
    module.add_class::<light::LightResult>()?;
    module.add_class::<gradient::GradientResult>()?;
    module.add_class::<classical::Drawing>()?;
    module.add_function(wrap_pyfunction!(plane::generated, module)?)?;
    module.add_function(wrap_pyfunction!(plane::generators, module)?)?;
    module.add_function(wrap_pyfunction!(plane::read, module)?)?;
    module.add_function(wrap_pyfunction!(plane::of_array, module)?)?;
    module.add_function(wrap_pyfunction!(light::propagate, module)?)?;
    module.add_function(wrap_pyfunction!(gradient::ltg, module)?)?;
    module.add_function(wrap_pyfunction!(classical::lines, module)?)?;
    module.add_function(wrap_pyfunction!(classical::topology, module)?)?;
    module.add_function(wrap_pyfunction!(classical::lic, module)?)?;
    module.add_function(wrap_pyfunction!(classical::ftle, module)?)?;
    module.add_function(wrap_pyfunction!(classical::glyphs, module)?)?;
    module.add_function(wrap_pyfunction!(classical::ridges, module)?)?;
    Ok(())
}
