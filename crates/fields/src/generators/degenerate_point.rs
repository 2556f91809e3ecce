//! The linear field around a degenerate point of index +1/2 or -1/2.

use crate::geometry::Window;
use crate::{Parameter, Settings};
use tigereye_core::{Field, Tensor2};

/// The mean eigenvalue; above sqrt 2 it keeps the tensor positive.
pub(super) const MEAN: Parameter =
    Parameter::real("mean", 2.0, 1.5, 1e6, "mean eigenvalue, which keeps the tensor positive");

/// `mean * I + [[x, q], [q, -x]]` with `q = y` times `sign`.
pub(super) fn field(settings: &Settings, sign: f64) -> Field<Tensor2> {
    let (mean, window) = (settings.number("mean"), Window::new(settings.grid(), 1.0));
    Field::from_fn(settings.grid(), |cell| {
        let (p, q) = (window.x(cell), sign * window.y(cell));
        Tensor2::symmetric(mean + p, q, mean - p)
    })
}
