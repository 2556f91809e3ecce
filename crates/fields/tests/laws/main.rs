//! Known answers of the generators, and the laws of arguments and formulas.

mod arguments;
mod expression;
mod flow;
mod images;
mod known;
mod registry;
mod stress;
mod thesis;
mod topology;
mod user_field;

use tigereye_core::{Cell, Field, Svd, Tensor2};
use tigereye_test_support::field;

/// Direction of the major semi-axis in degrees, 0 to 180.
fn major_deg(t: &Tensor2) -> f64 {
    Svd::of(t).phi_rad().to_degrees().rem_euclid(180.0)
}

/// Difference of two axes in degrees, 0 to 90.
fn axis_difference(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(180.0);
    d.min(180.0 - d)
}

/// Whether two tensors make the same ellipse: equal `A A^T`.
fn same_ellipse(a: &Tensor2, b: &Tensor2, tolerance: f64) -> bool {
    let square = |t: &Tensor2| {
        let [p, q, r, s] = t.components();
        [p * p + q * q, p * r + q * s, r * r + s * s]
    };
    square(a).iter().zip(square(b)).all(|(x, y)| (x - y).abs() <= tolerance)
}

fn at(field: &Field<Tensor2>, x: usize, y: usize) -> Tensor2 {
    *field.at(Cell::new(x, y))
}
