//! Scenes: shapes of walls, mirrors and crystals on a grid, and what light finds in each cell of them.
//!
//! The thesis (section 2.5) derives from the scheme a second use: with isotropic transmission everywhere and a geometry
//! given, it shows how light spreads in a scene, and its gradient where shadows and reflections separate, which is what
//! the finite-time path deflection of Zirr et al. (2015) shows of light paths. A wall costs nothing extra: where a cell
//! with a tensor has one 8 x 8 matrix, a cell of a wall has another ([`Reflection`](tigereye_core::Reflection)).
//!
//! Positions are in cells, `[x, y]` with `[0, 0]` the centre of the upper left cell and y **downwards**; angles are in
//! degrees, counter-clockwise from +x as everywhere.

mod border;
mod error;
mod leaks;
mod limits;
mod mask;
mod paths;
mod scene;
mod shape;
mod wall;

pub use error::{Fault, SceneError};
pub use leaks::leaks;
pub use mask::Mask;
pub use paths::{Path, brightest_path, climbing_steps, shortest_path, steps_to};
pub use scene::{Layout, Material, Part, Scene};
pub use shape::Shape;
