//! Scalars of a light transport gradient in colours.

use tigereye_core::{Cell, CellShape, Field, Surface};
use tigereye_render::{HeatOptions, Overlay, Scene, heat_map};

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

/// Which picture of a gradient.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Heading.
    pub title: String,
    /// Which scalar it is.
    pub scalar: Scalar,
    /// The surfaces of a scene.
    pub walls: Option<Field<Option<Surface>>>,
    /// Lines and points drawn on top.
    pub overlays: Vec<Overlay>,
    /// Pixels per cell; `None` for the default of the picture.
    pub cell_px: Option<usize>,
    /// The shape of a cell.
    pub cell: CellShape,
}

/// A scalar at all cells, W/rad. Cells without a result are drawn as missing, so that they do not affect the scale.
#[must_use]
pub fn picture(scalar: &Field<f64>, request: Request) -> Scene {
    let inner = where_result(scalar, request.walls.as_ref());
    let missing = missing_label(request.walls.as_ref()).to_owned();
    let options = HeatOptions {
        title: request.title,
        quantity: request.scalar.label(),
        missing: Some(missing),
        walls: request.walls,
        overlays: request.overlays,
        cell_px: request.cell_px,
        cell: request.cell,
        ..HeatOptions::default()
    };
    heat_map(&inner, &options)
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
