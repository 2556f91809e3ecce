//! Lines, ridges, glyphs and the topology of a field over pictures of something else.

use crate::lines::{LinesRequest, Seeds, lines};
use crate::ridges::line_overlay as ridge_overlay;
use crate::topology::topology;
use crate::{Placement, line_overlay, point_overlays};
use thiserror::Error;
use tigereye_core::{CellShape, Field, Point, Tensor2, choice};
use tigereye_io::PolyData;
use tigereye_lines::{
    ExtractionError, Family, Following, LineOptions, RidgeOptions, TensorLine, Threshold, ridge_lines,
    usual_axes,
};
use tigereye_render::{Overlay, Rgba};

/// What may be drawn over a picture, with the default settings of the command of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Added {
    /// Tensor lines along the major axis.
    Lines,
    /// Height ridges of what the picture shows.
    Ridges,
    /// Ellipses of the tensors.
    Glyphs,
    /// Degenerate points and separatrices.
    Topology,
}

choice!(Added {
    Lines = "lines": "Tensor lines along the major axis.",
    Ridges = "ridges": "Height ridges of what the picture shows.",
    Glyphs = "glyphs": "Ellipses of the tensors.",
    Topology = "topology": "Degenerate points and separatrices.",
});

/// Why something cannot be drawn over a picture.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AddedError {
    /// The picture shows no scalar.
    #[error("there is no scalar to find ridges of: expected a picture of light, FTLE or a gradient")]
    NoScalar,
    /// The picture is of a scene.
    #[error("a scene has no tensors: expected ridges")]
    NoTensors,
    /// Glyphs over diagrams of every cell.
    #[error("glyphs would hide the diagrams: expected --picture energy, or lines, ridges or topology")]
    Diagrams,
    /// Too many lines.
    #[error(transparent)]
    Lines(#[from] crate::lines::TooManyPoints),
    /// Ridges that cannot be found.
    #[error(transparent)]
    Ridges(#[from] ExtractionError),
    /// The data lies nowhere.
    #[error("the input has no coordinates to place them by: expected a file with a geometry")]
    Unplaced,
}

/// A picture's scalar: its values with the samples per side of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Scalars<'a> {
    /// The values, NaN where there is none.
    pub values: &'a Field<f64>,
    /// Samples per side of a cell.
    pub samples: usize,
}

/// What is drawn over a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Additions {
    /// Lines and points.
    pub overlays: Vec<Overlay>,
    /// Tensors to draw as ellipses.
    pub glyphs: Option<Field<Tensor2>>,
}

/// Distance of lines in parts of the longer side, and their longest length in longer sides, as `lines` has them.
const LINES_A_SIDE: f64 = 40.0;
const SIDES: f64 = 4.0;
/// Shortest ridge, cells, as `ridges` has it.
const LEAST_RIDGE: f64 = 2.0;
/// Colours that stand out from maps.
const RIDGES: Rgba = Rgba::hex(0xd62728);
const FILES: Rgba = Rgba::hex(0x1a1a1a);

/// Refuses what a picture cannot have: one of a scene, one without a scalar, or one with diagrams in every cell.
///
/// # Errors
/// See [`AddedError`].
pub fn check(
    wanted: &[Added],
    has_tensors: bool,
    has_scalar: bool,
    diagrams: bool,
) -> Result<(), AddedError> {
    for added in wanted {
        match added {
            Added::Ridges if !has_scalar => return Err(AddedError::NoScalar),
            Added::Glyphs if diagrams => return Err(AddedError::Diagrams),
            Added::Lines | Added::Glyphs | Added::Topology if !has_tensors => {
                return Err(AddedError::NoTensors);
            }
            _ => {}
        }
    }
    Ok(())
}

/// Finds what is to be drawn over a picture of `field` that shows `scalars`.
///
/// # Errors
/// See [`AddedError`].
pub fn additions(
    wanted: &[Added],
    field: Option<&Field<Tensor2>>,
    cell: CellShape,
    scalars: Option<Scalars<'_>>,
) -> Result<Additions, AddedError> {
    let mut found = Additions::default();
    for added in wanted {
        match added {
            Added::Ridges => found.overlays.push(ridges(scalars.ok_or(AddedError::NoScalar)?, cell)?),
            Added::Glyphs => found.glyphs = Some(field.ok_or(AddedError::NoTensors)?.clone()),
            Added::Lines => found.overlays.push(along(field.ok_or(AddedError::NoTensors)?, cell)?),
            Added::Topology => found.overlays.extend(skeleton(field.ok_or(AddedError::NoTensors)?, cell)),
        }
    }
    Ok(found)
}

fn usual(field: &Field<Tensor2>, cell: CellShape) -> (Following, LineOptions) {
    let following = Following { axes: usual_axes(field).into(), cell };
    let length = SIDES * following.longer_side(field.grid());
    (following, LineOptions { step: 0.1, length, ..LineOptions::default() })
}

fn along(field: &Field<Tensor2>, cell: CellShape) -> Result<Overlay, AddedError> {
    let (following, options) = usual(field, cell);
    let separation = (following.longer_side(field.grid()) / LINES_A_SIDE).max(0.5);
    let (families, seeds) = (vec![Family::Major], Seeds::Even(separation));
    let found = lines(field, &LinesRequest { following, families, seeds, options, ribbon: None })?;
    let label = format!("{} lines: {}", Family::Major.name(), following.axes.words());
    Ok(line_overlay(found.lines.iter().map(|line| &line.line), Family::Major, &label))
}

fn skeleton(field: &Field<Tensor2>, cell: CellShape) -> Vec<Overlay> {
    let (following, options) = usual(field, cell);
    let found = topology(field, following, &[Family::Major], &options);
    let lines: Vec<&TensorLine> = found.separatrices.iter().map(|s| &s.line).collect();
    let label = format!("separatrices of the {} axis", Family::Major.name());
    let mut overlays = Vec::new();
    if !lines.is_empty() {
        overlays.push(Overlay { width_px: 1.8, ..line_overlay(lines, Family::Major, &label) });
    }
    overlays.extend(point_overlays(&found.points));
    overlays
}

fn ridges(scalars: Scalars<'_>, cell: CellShape) -> Result<Overlay, ExtractionError> {
    let samples = scalars.samples.max(1);
    let [dx, dy] = cell.sides();
    let options = RidgeOptions {
        cell: [dx, dy, 1.0],
        least_strength: Threshold::Part(0.05),
        least_extent: LEAST_RIDGE,
        ..RidgeOptions::default()
    };
    let found = ridge_lines(scalars.values, &options)?;
    let mut overlay = ridge_overlay(&found.shape, "height ridges", RIDGES);
    overlay.points.iter_mut().for_each(|p| *p /= samples as f64);
    Ok(overlay)
}

/// The lines and points of a VTK file at their places among the cells.
///
/// # Errors
/// [`AddedError::Unplaced`].
pub fn of_poly_data(data: &PolyData, placement: &Placement, label: &str) -> Result<Vec<Overlay>, AddedError> {
    if !placement.geometry().is_placed() {
        return Err(AddedError::Unplaced);
    }
    let at = |i: usize| data.points.get(i).map_or(Point::splat(f64::NAN), |p| placement.cells_of(*p));
    let mut points = Vec::new();
    for line in data.lines.iter() {
        points.extend(line.iter().map(|&i| at(i)));
        points.push(Point::splat(f64::NAN));
    }
    for area in data.polys.iter() {
        points.extend(area.iter().chain(area.first()).map(|&i| at(i)));
        points.push(Point::splat(f64::NAN));
    }
    let mut overlays = Vec::new();
    if !points.is_empty() {
        let label = label.to_owned();
        overlays.push(Overlay { label, points, colour: FILES, width_px: 1.2, ..Overlay::default() });
    }
    let points: Vec<Point> = data.verts.iter().flatten().map(|&i| at(i)).collect();
    if !points.is_empty() {
        let label = if overlays.is_empty() { label.to_owned() } else { String::new() };
        let marker = Some(tigereye_render::Marker::Circle);
        overlays.push(Overlay { label, points, marker, colour: FILES, ..Overlay::default() });
    }
    Ok(overlays)
}
