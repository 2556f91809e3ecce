//! Tensor fields of images: what scalars and vectors on a grid say about directions.
//!
//! | tensor | of | |
//! | --- | --- | --- |
//! | gradient | a vector field (u, v) | [[du/dx, du/dy], [dv/dx, dv/dy]]; not symmetric |
//! | Hessian | a scalar field | second derivatives; indefinite |
//! | structure | a scalar field | gradient times its transpose, averaged over a window; positive semidefinite |
//!
//! Derivatives are those of the field smoothed by a Gaussian of `sigma` cells (correlation with the Gaussian's
//! derivatives), divided by the distance of the cells; `sigma` 0 means differences of neighbours. Beyond the rim the field
//! goes on as its point reflection at the rim's cell, so derivatives of linear fields are exact up to the rim; second
//! derivatives vanish there.
//!
//! Sources: Lindeberg, Scale-Space Theory in Computer Vision, 1994 (derivatives at a scale); Bigün and Granlund, Optimal
//! orientation detection of linear symmetry, ICCV 1987 (structure tensor).

mod kernel;
mod resample;

pub use resample::{MAX_RESAMPLED, MAX_RESAMPLED_CELLS, resampled};

use kernel::{Beyond, Kernel, along_rows, columns_of};
use tigereye_core::{Field, Tensor2};

/// Largest Gaussian, cells.
pub const MAX_SIGMA: f64 = 100.0;

/// First derivatives along x (right) and y (up), per unit of `spacing`.
fn gradient(field: &Field<f64>, spacing: [f64; 2], sigma: f64) -> [Field<f64>; 2] {
    let (smooth, slope) = (Kernel::gauss(sigma), Kernel::first(sigma));
    // Rows run downwards, y upwards.
    [
        derivative(field, &slope, &smooth, 1.0 / spacing[0]),
        derivative(field, &smooth, &slope, -1.0 / spacing[1]),
    ]
}

fn derivative(field: &Field<f64>, x: &Kernel, y: &Kernel, factor: f64) -> Field<f64> {
    let rows = along_rows(field, x, Beyond::PointReflection);
    columns_of(&rows, y, Beyond::PointReflection).map(|v| v * factor)
}

/// The gradient tensor of a vector field whose components are along x (right) and y (up).
#[must_use]
pub fn gradient_tensors(vectors: &Field<[f64; 2]>, spacing: [f64; 2], sigma: f64) -> Field<Tensor2> {
    let [du, dv] = [0, 1].map(|i| gradient(&vectors.map(|v| v[i]), spacing, sigma));
    Field::from_fn(vectors.grid(), |c| Tensor2::new(*du[0].at(c), *du[1].at(c), *dv[0].at(c), *dv[1].at(c)))
}

/// The Hessian of a scalar field.
#[must_use]
pub fn hessian_tensors(scalars: &Field<f64>, spacing: [f64; 2], sigma: f64) -> Field<Tensor2> {
    let (smooth, slope, bend) = (Kernel::gauss(sigma), Kernel::first(sigma), Kernel::second(sigma));
    let [dx, dy] = spacing;
    let xx = derivative(scalars, &bend, &smooth, 1.0 / (dx * dx));
    let xy = derivative(scalars, &slope, &slope, -1.0 / (dx * dy));
    let yy = derivative(scalars, &smooth, &bend, 1.0 / (dy * dy));
    Field::from_fn(scalars.grid(), |c| Tensor2::symmetric(*xx.at(c), *xy.at(c), *yy.at(c)))
}

/// The structure tensor of a scalar field: products of derivatives, averaged by a Gaussian of `window` cells.
#[must_use]
pub fn structure_tensors(scalars: &Field<f64>, spacing: [f64; 2], sigma: f64, window: f64) -> Field<Tensor2> {
    let [gx, gy] = gradient(scalars, spacing, sigma);
    let average = Kernel::gauss(window);
    let averaged = |a: &Field<f64>, b: &Field<f64>| {
        let product = Field::from_fn(scalars.grid(), |c| a.at(c) * b.at(c));
        // A mirror keeps squares positive; a point reflection does not.
        let rows = along_rows(&product, &average, Beyond::Mirror);
        columns_of(&rows, &average, Beyond::Mirror)
    };
    let (xx, xy, yy) = (averaged(&gx, &gx), averaged(&gx, &gy), averaged(&gy, &gy));
    Field::from_fn(scalars.grid(), |c| Tensor2::symmetric(*xx.at(c), *xy.at(c), *yy.at(c)))
}
