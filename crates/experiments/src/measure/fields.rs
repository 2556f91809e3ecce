//! Numbers of tensor fields.

use super::worst;
use crate::runs::RunError;
use tigereye_core::{Anisotropy, Cell, Field, Svd, Tensor2, is_totally_anisotropic, math};
use tigereye_fields::{Expression, ExpressionField, variables};
use tigereye_lines::is_complex;
use tigereye_lines::{Family, OrderedAxes};

/// Half-axes that differ by less count as equal: their direction is arbitrary.
const ISOTROPIC_BELOW: f64 = 0.01;

fn is_isotropic(t: &Tensor2) -> bool {
    t.is_zero() || 1.0 - Svd::of(t).axis_ratio() <= ISOTROPIC_BELOW
}

pub(super) fn determinant_error(field: &Field<Tensor2>) -> f64 {
    worst(field.values().iter().map(|t| (t.determinant() - 1.0).abs()))
}

pub(super) fn major_axis_deg(field: &Field<Tensor2>, (x, y): (usize, usize)) -> Option<f64> {
    let cell = Cell::new(x, y);
    field.grid().contains(cell).then(|| math::degrees(Svd::of(field.at(cell)).phi_rad()).rem_euclid(180.0))
}

/// Largest angle between the major axis and `phi_deg`, degrees; that of tensors without these axes is not counted.
pub(super) fn major_axis_error_deg(
    field: &Field<Tensor2>,
    axes: OrderedAxes,
    phi_deg: &str,
) -> Result<f64, RunError> {
    let expression = Expression::parse(phi_deg, &ExpressionField::VARIABLES)
        .map_err(|e| RunError::Expression { expression: phi_deg.to_owned(), problem: e.to_string() })?;
    let grid = field.grid();
    let error = |(cell, t): (Cell, &Tensor2)| {
        let [x, y] = axes.of(t, 0.0)?.axes[Family::Major as usize];
        let expected = expression.eval(&variables(grid, cell));
        let off = (math::degrees(math::atan2(y, x)) - expected).rem_euclid(180.0);
        Some(off.min(180.0 - off))
    };
    Ok(worst(field.iter().filter(|(_, t)| !is_isotropic(t)).filter_map(error)))
}

pub(super) fn isotropic_share(field: &Field<Tensor2>) -> f64 {
    share(field, is_isotropic)
}

pub(super) fn total_anisotropy_share(field: &Field<Tensor2>) -> f64 {
    share(field, |t| !t.is_zero() && is_totally_anisotropic(t))
}

pub(super) fn complex_share(field: &Field<Tensor2>) -> f64 {
    share(&field.without_rounding(), is_complex)
}

pub(super) fn zero_share(field: &Field<Tensor2>) -> f64 {
    share(field, Tensor2::is_zero)
}

pub(super) fn largest_axis(field: &Field<Tensor2>) -> f64 {
    worst(field.values().iter().map(|t| Svd::of(t).s[0]))
}

fn share(field: &Field<Tensor2>, test: impl Fn(&Tensor2) -> bool) -> f64 {
    field.values().iter().filter(|t| test(t)).count() as f64 / field.values().len() as f64
}

/// Mean planar anisotropy of the semi-axes, for digests.
pub(crate) fn mean_anisotropy(field: &Field<Tensor2>) -> f64 {
    field.values().iter().map(|t| Anisotropy::of(t).planar).sum::<f64>() / field.values().len() as f64
}
