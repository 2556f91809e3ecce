//! Tensor fields of images, derived from scalars and vectors on a grid.
//!
//! | tensor | of | |
//! | --- | --- | --- |
//! | gradient | a vector field (u, v) | [[du/dx, du/dy], [dv/dx, dv/dy]]; not symmetric |
//! | strain rate | a vector field | the symmetric part of the gradient; indefinite |
//! | Hessian | a scalar field | second derivatives; indefinite |
//! | structure J | a scalar field | gradient times its transpose, averaged over a window; positive semidefinite, its major axis **across** stripes |
//! | orientation | a scalar field | trace(J) I - J: J with its eigenvalues exchanged, its major axis **along** stripes |
//!
//! Derivatives are those of the field smoothed by a Gaussian of `sigma` cells (correlation with the Gaussian's
//! derivatives), divided by the distance of the cells; `sigma` 0 means differences of neighbours.
//!
//! Samples may be missing (`None`), and always are beyond the border. They are not replaced: differences
//! are one-sided there (`stencils.rs`), and where the Gaussian reaches a border or a hole, a polynomial is fitted to
//! the existing samples (`fit.rs`). Both are exact for polynomials of degree 2 where there are samples enough, as
//! inside. A cell without sample has no tensor, nor has one whose neighbours are too few for a derivative that the
//! tensor needs.
//!
//! Sources: Lindeberg, Scale-Space Theory in Computer Vision, 1994 (derivatives at a scale); Bigün and Granlund,
//! Optimal orientation detection of linear symmetry, ICCV 1987 (structure tensor).

mod fit;
mod kernel;
mod resample;
mod stencils;

pub use crate::limits::{MAX_RESAMPLED, MAX_RESAMPLED_CELLS};
pub use resample::resampled;

use kernel::{Kernel, NARROW, Order, along_rows, columns_of, turned};
use tigereye_core::{Field, Tensor2};

/// Largest Gaussian, cells.
pub const MAX_SIGMA: f64 = 100.0;

/// Samples; `None` where one is missing.
type Samples = Field<Option<f64>>;

const VALUE: Order = Order::Value;
const FIRST: Order = Order::First;
const SECOND: Order = Order::Second;

/// Derivatives of the `wanted` orders along columns and rows (downwards), per cell.
fn derivatives<const N: usize>(field: &Samples, wanted: [[Order; 2]; N], sigma: f64) -> [Samples; N] {
    let filled = field.map(|v| v.unwrap_or(0.0));
    let present = field.map(Option::is_some);
    let mut beside = present.map(|_| false);
    let mut found = wanted.map(|orders| {
        let [x, y] = orders.map(|order| Kernel::of_order(order, sigma));
        let whole = complete(&present, [x.radius(), y.radius()]);
        let smooth = columns_of(&along_rows(&filled, &x), &y);
        let rest = (sigma <= NARROW).then(|| stencils::derivative(field, orders));
        for (b, (whole, present)) in
            beside.values_mut().iter_mut().zip(whole.values().iter().zip(present.values()))
        {
            *b |= *present && !*whole;
        }
        Field::from_fn(field.grid(), |c| match &rest {
            _ if *whole.at(c) => Some(*smooth.at(c)),
            Some(rest) => *rest.at(c),
            None => None,
        })
    });
    if sigma > NARROW {
        let grid = field.grid();
        // All kernels of a Gaussian reach equally far.
        fit::each_fit(field, &beside, sigma, |cell, fit| {
            for (derivative, orders) in found.iter_mut().zip(wanted) {
                derivative.values_mut()[grid.index(cell)] = fit.derivative(orders);
            }
        });
    }
    found
}

/// Cells around which no sample is missing, as far as the radii along columns and rows reach.
fn complete(present: &Field<bool>, [x, y]: [usize; 2]) -> Field<bool> {
    turned(&complete_in_rows(&turned(&complete_in_rows(present, x)), y))
}

fn complete_in_rows(present: &Field<bool>, radius: usize) -> Field<bool> {
    let mut out = present.clone();
    let width = present.grid().width();
    for (row, to) in present.values().chunks(width).zip(out.values_mut().chunks_mut(width)) {
        // Number of consecutive samples that end here.
        let mut run = 0;
        to.fill(false);
        for (x, present) in row.iter().enumerate() {
            run = if *present { run + 1 } else { 0 };
            if run > 2 * radius {
                to[x - radius] = true;
            }
        }
    }
    out
}

/// First derivatives along x (right) and y (up), per unit of `spacing`.
fn gradient(field: &Samples, spacing: [f64; 2], sigma: f64) -> [Samples; 2] {
    let [x, y] = derivatives(field, [[FIRST, VALUE], [VALUE, FIRST]], sigma);
    // Rows run downwards, y upwards.
    [scaled(&x, 1.0 / spacing[0]), scaled(&y, -1.0 / spacing[1])]
}

fn scaled(field: &Samples, factor: f64) -> Samples {
    field.map(|v| v.map(|v| v * factor))
}

/// The gradient tensor of a vector field whose components are along x (right) and y (up); `None` where a vector or a
/// difference is missing.
#[must_use]
pub fn gradient_tensors(
    vectors: &Field<Option<[f64; 2]>>,
    spacing: [f64; 2],
    sigma: f64,
) -> Field<Option<Tensor2>> {
    let [du, dv] = [0, 1].map(|i| gradient(&vectors.map(|v| v.map(|v| v[i])), spacing, sigma));
    Field::from_fn(vectors.grid(), |c| {
        Some(Tensor2::new((*du[0].at(c))?, (*du[1].at(c))?, (*dv[0].at(c))?, (*dv[1].at(c))?))
    })
}

/// The rate of strain of a velocity: the symmetric part of [`gradient_tensors`].
#[must_use]
pub fn strain_rate_tensors(
    vectors: &Field<Option<[f64; 2]>>,
    spacing: [f64; 2],
    sigma: f64,
) -> Field<Option<Tensor2>> {
    let strain = |t: &Tensor2| {
        let rate = t.symmetric_part();
        if rate.max_abs() <= ROUNDING * t.max_abs() { Tensor2::ZERO } else { rate }
    };
    gradient_tensors(vectors, spacing, sigma).map(|t| t.as_ref().map(strain))
}

/// Part of a gradient below which its rate of strain is what differences of rounded velocities leave of a rigid
/// rotation.
const ROUNDING: f64 = 1e-12;

/// The Hessian of a scalar field; `None` where a sample or a difference is missing.
#[must_use]
pub fn hessian_tensors(scalars: &Samples, spacing: [f64; 2], sigma: f64) -> Field<Option<Tensor2>> {
    let [dx, dy] = spacing;
    let [xx, xy, yy] = derivatives(scalars, [[SECOND, VALUE], [FIRST, FIRST], [VALUE, SECOND]], sigma);
    let (xx, xy, yy) =
        (scaled(&xx, 1.0 / (dx * dx)), scaled(&xy, -1.0 / (dx * dy)), scaled(&yy, 1.0 / (dy * dy)));
    Field::from_fn(scalars.grid(), |c| Some(Tensor2::symmetric((*xx.at(c))?, (*xy.at(c))?, (*yy.at(c))?)))
}

/// The structure tensor of a scalar field: products of derivatives, averaged by a Gaussian of `window` cells over the
/// cells that have some. Its major axis is that of the strongest change, across stripes. `None` where a sample or a
/// difference is missing.
#[must_use]
pub fn structure_tensors(
    scalars: &Samples,
    spacing: [f64; 2],
    sigma: f64,
    window: f64,
) -> Field<Option<Tensor2>> {
    let [gx, gy] = gradient(scalars, spacing, sigma);
    let products = Field::from_fn(scalars.grid(), |c| {
        let (x, y) = ((*gx.at(c))?, (*gy.at(c))?);
        Some([x * x, x * y, y * y])
    });
    let [xx, xy, yy] = averages(&products, window);
    Field::from_fn(scalars.grid(), |c| {
        products.at(c).is_some().then(|| Tensor2::symmetric(*xx.at(c), *xy.at(c), *yy.at(c)))
    })
}

/// The orientation tensor of a scalar field: trace(J) I - J of the structure tensor J. It has the same trace and axes
/// with the eigenvalues exchanged, so that its major axis runs along stripes. In the plane this is J turned by a
/// quarter.
#[must_use]
pub fn orientation_tensors(
    scalars: &Samples,
    spacing: [f64; 2],
    sigma: f64,
    window: f64,
) -> Field<Option<Tensor2>> {
    structure_tensors(scalars, spacing, sigma, window).map(|t| t.map(|t| t.quarter_turned()))
}

/// Gaussian averages of the existing values. Beyond the border the field continues as its mirror image, which keeps
/// squares positive.
fn averages(products: &Field<Option<[f64; 3]>>, window: f64) -> [Field<f64>; 3] {
    let gauss = Kernel::gauss(window);
    let average = |field: &Field<f64>| columns_of(&along_rows(field, &gauss), &gauss);
    let share = |there| average(&products.map(|p| if p.is_some() == there { 1.0 } else { 0.0 }));
    let holes = products.values().iter().any(Option::is_none).then(|| (share(true), share(false)));
    [0, 1, 2].map(|i| {
        let mut sums = average(&products.map(|p| p.map_or(0.0, |p| p[i])));
        if let Some((there, missing)) = &holes {
            let shares = there.values().iter().zip(missing.values());
            for (sum, (there, missing)) in sums.values_mut().iter_mut().zip(shares) {
                // Away from holes the weights' sum is 1.
                if *missing > 0.0 && *there > 0.0 {
                    *sum /= there;
                }
            }
        }
        sums
    })
}
