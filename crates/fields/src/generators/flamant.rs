//! Flamant: a line load on a half plane.
//!
//! ```text
//!        | P
//!   _____V_____   surface: the upper edge of the first row
//!     \  |  /     srr = -2 P d / (pi r^2), all other components 0
//!    (       )    d = depth, r = distance from the load
//! ```
//! Principal lines are the rays of the load and circles about it. With the textbook's y pointing into the body
//! `(sxx, syy, sxy) = -2P/(pi r^4) (x^2 y, y^3, x y^2)`; here y points up, so that sxy has the other sign. Compression
//! is negative. Samples lie in the middles of the rows, so none lies at the load itself.
//! Source: Flamant 1892; Timoshenko and Goodier, "Theory of Elasticity", article 36.

use crate::geometry::Window;
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "flamant",
    summary: "line load on a half plane: rays and circles",
    source: "Flamant 1892; Timoshenko and Goodier, article 36",
    own_parameters: &[
        Parameter::real("load", 1.0, -1e6, 1e6, "load per length, downwards"),
        Parameter::real("extent", 1.0, 1e-3, 1e3, "half of the longer side, length"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[Known::Symmetries("", &[Mirror::LeftRight])],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let load = settings.number("load");
    let window = Window::new(settings.grid(), settings.number("extent"));
    Field::from_fn(settings.grid(), |cell| {
        let (x, depth) = (window.x(cell), (cell.y as f64 + 0.5) * window.spacing);
        let r2 = x * x + depth * depth;
        let f = -2.0 * load * depth / (math::PI * r2 * r2);
        Tensor2::symmetric(f * x * x, -f * x * depth, f * depth * depth)
    })
}
