//! Height ridges (Eberly, Ridges in Image and Data Analysis, 1996): lines of fields, surfaces of volumes.

mod crest;
mod lines;
mod mesh;
mod options;
mod surface;

pub use lines::{RidgeLines, ridge_lines};
pub use options::{RidgeBounds, RidgeOptions, Threshold};
pub use surface::{RidgeSurface, ridge_surface};
