//! Cantilever: a beam of unit thickness, fixed on the right, loaded at its free left end.
//!
//! ```text
//!    +--------------------//   y = c      sxx = -P x y / I
//!  P |                    //   y = 0      syy = 0
//!  ^ +--------------------//   y = -c     sxy = -P (c^2 - y^2) / (2 I),  I = 2 c^3 / 3
//!   x = 0               x = L
//! ```
//! In the frame x right, y up the load P acts upwards. The beam fills the field; cells are square, so the length
//! follows from the grid: L = 2 c (width-1) / (height-1). Source: Timoshenko and Goodier, "Theory of Elasticity",
//! article 21.

use crate::{Generator, Known, Parameter, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "cantilever",
    summary: "beam with a load at its free end",
    source: "Timoshenko and Goodier, article 21",
    own_parameters: &[
        Parameter::real("load", 1.0, -1e6, 1e6, "load at the free end, upwards"),
        Parameter::real("half_height", 1.0, 1e-3, 1e3, "half of the beam's height c, length"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[Known::Tensor("size=5", [0, 2], Tensor2::symmetric(0.0, -0.75, 0.0))],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let (load, c, grid) = (settings.number("load"), settings.number("half_height"), settings.grid());
    let spacing = 2.0 * c / (grid.height() - 1).max(1) as f64;
    let inertia = 2.0 * c * c * c / 3.0;
    Field::from_fn(grid, |cell| {
        let x = cell.x as f64 * spacing;
        let y = (0.5 * (grid.height() - 1) as f64 - cell.y as f64) * spacing;
        let shear = -load * (c * c - y * y) / (2.0 * inertia);
        Tensor2::symmetric(-load * x * y / inertia, shear, 0.0)
    })
}
