//! Where values reach a level: lines of fields, surfaces of volumes.

mod isolines;
mod isosurface;

pub use isolines::isolines;
pub use isosurface::isosurface;
