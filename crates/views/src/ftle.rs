//! Finite-time Lyapunov exponents of tensor lines.

use tigereye_core::{CellShape, Field, Tensor2};
use tigereye_lines::{Family, Followed, Following, Ftle, FtleOptions, OrderedAxes, SamplingError, ftle};
use tigereye_render::{HeatOptions, Overlay, Scene, heat_map};

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
pub fn picture(
    found: &Ftle,
    axes: OrderedAxes,
    title: &str,
    overlays: Vec<Overlay>,
    cell_px: Option<usize>,
) -> Scene {
    let is_square = found.cell == CellShape::SQUARE;
    let unit = if is_square { "1/cell" } else { "1/smaller cell side" };
    let options = HeatOptions {
        title: title.to_owned(),
        quantity: format!("FTLE on tensor lines / ({unit})"),
        note: Some(format!("lines along {}", axes.words())),
        samples_a_cell: found.samples,
        cell: found.cell,
        overlays,
        cell_px,
        missing: Some("no line, or one that leaves the field".to_owned()),
        ..HeatOptions::default()
    };
    heat_map(&found.larger, &options)
}
