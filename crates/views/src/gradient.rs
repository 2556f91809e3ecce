//! Scalars of a light transport gradient in colours.

use tigereye_core::{Cell, Field, Surface};
use tigereye_render::{HeatOptions, Scene, heat_map};

/// Which scalar of a gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scalar {
    /// One direction, named elsewhere.
    #[default]
    Slice,
    /// One direction, degrees.
    SliceAt(f64),
    /// Mean over the directions.
    Mean,
    /// Maximum over the directions.
    Largest,
    /// Standard deviation over the directions.
    Deviation,
}

impl Scalar {
    /// Name and unit, for legends.
    #[must_use]
    pub fn label(self) -> String {
        match self {
            Self::Slice => "LTG / (W/rad)".to_owned(),
            Self::SliceAt(degrees) => format!("LTG at {degrees} degrees / (W/rad)"),
            Self::Mean => "mean LTG / (W/rad)".to_owned(),
            Self::Largest => "largest LTG / (W/rad)".to_owned(),
            Self::Deviation => "deviation of LTG / (W/rad)".to_owned(),
        }
    }
}

/// A scalar of a gradient at all cells, W/rad. Cells without a result are drawn as missing, so that they do not affect
/// the scale.
#[must_use]
pub fn picture(values: &Field<f64>, scalar: Scalar, options: HeatOptions) -> Scene {
    let inner = where_result(values, options.walls.as_ref());
    let missing = Some(missing_label(options.walls.as_ref()).to_owned());
    heat_map(&inner, &HeatOptions { quantity: scalar.label(), missing, ..options })
}

/// Label in the legend for the cells that [`where_result`] leaves out.
#[must_use]
pub fn missing_label(surfaces: Option<&Field<Option<Surface>>>) -> &'static str {
    match surfaces.is_some_and(|s| s.values().iter().flatten().any(Surface::is_wall)) {
        true => "border, or beside a wall",
        false => "border, 0 by definition",
    }
}

/// A gradient's scalar where it is meaningful, NaN elsewhere: at the border, where it is 0 by definition, and in and
/// beside the walls of a scene, where pulses are compared with one that is inside a wall and emits nothing.
#[must_use]
pub fn where_result(field: &Field<f64>, surfaces: Option<&Field<Option<Surface>>>) -> Field<f64> {
    let grid = field.grid();
    let is_wall_at = |cell: Cell| {
        let surface = surfaces.and_then(|s| *s.at(cell));
        surface.is_some_and(|s| s.is_wall())
    };
    let beside = |cell: Cell| [0, 2, 4, 6].iter().filter_map(|&k| grid.neighbour(cell, k)).any(is_wall_at);
    Field::from_fn(grid, |cell| {
        let missing = grid.is_border(cell) || is_wall_at(cell) || beside(cell);
        if missing { f64::NAN } else { *field.at(cell) }
    })
}
