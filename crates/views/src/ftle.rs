//! Finite-time Lyapunov exponents of tensor lines.

use crate::masked;
use tigereye_core::{CellShape, Field, Tensor2};
use tigereye_lines::{Family, Followed, Following, Ftle, FtleOptions, OrderedAxes, SamplingError, ftle};
use tigereye_render::{HeatOptions, Scene, heat_map};

/// FTLE on the lines of a field.
///
/// # Errors
/// See [`SamplingError`].
pub fn exponents(
    field: &Field<Tensor2>,
    following: Following,
    family: Family,
    options: &FtleOptions,
) -> Result<Ftle, SamplingError> {
    ftle(&Followed::new(field, following).interpolated(), family, options)
}

/// The larger exponents in colours.
#[must_use]
pub fn picture(found: &Ftle, field: &Field<Tensor2>, axes: OrderedAxes, options: HeatOptions) -> Scene {
    let is_square = found.cell == CellShape::SQUARE;
    let unit = if is_square { "1/cell" } else { "1/smaller cell side" };
    let options = HeatOptions {
        quantity: format!("FTLE on tensor lines / ({unit})"),
        note: Some(format!("lines along {}", axes.words())),
        samples_a_cell: found.samples,
        cell: found.cell,
        missing: Some("no value (line too short)".to_owned()),
        masked: masked(field),
        ..options
    };
    heat_map(&found.larger, &options)
}
