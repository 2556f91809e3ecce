//! Views of tensor fields, one file each: from a request to what is found, with its picture, its data for VTK and its
//! parameters.

pub mod ftle;
pub mod glyphs;
pub mod gradient;
pub mod lic;
pub mod light;
pub mod lines;
mod overlays;
mod reel;
pub mod ridges;
pub mod topology;
pub mod total_anisotropy;

pub use overlays::{line_overlay, point_overlays};
pub use reel::Reel;

use std::ops::Range;
use tigereye_core::{CellShape, Field, Grid, Point, Tensor2};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{DataArray, FieldEntry, FieldValues, ImageData, PROVENANCE, PolyData, Rows};
use tigereye_lines::{Axes, Following, is_complex};
use tigereye_render::{Overlay, PlainOptions};

/// The position of the cells of a field in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    geometry: PlaneGeometry,
    height: usize,
}

impl Placement {
    /// Of the cells of a grid.
    #[must_use]
    pub const fn new(geometry: PlaneGeometry, grid: Grid) -> Self {
        Self { geometry, height: grid.height() }
    }

    /// The position of a point of the grid in the world.
    #[must_use]
    pub fn place(&self, p: Point) -> [f64; 3] {
        self.geometry.place([p.x, (self.height - 1) as f64 - p.y])
    }

    /// The shape of a cell.
    #[must_use]
    pub fn cell(&self) -> CellShape {
        CellShape::of(self.geometry.spacing())
    }

    /// The geometry of the plane of cells.
    #[must_use]
    pub const fn geometry(&self) -> &PlaneGeometry {
        &self.geometry
    }
}

/// Scalars as image data in the frame of the field, with `samples` per cell along x and y: rows upwards, as the
/// parameters of its provenance say ([`tigereye_io::Rows::KEY`]).
#[must_use]
pub fn image(
    arrays: &[(&str, &Field<f64>)],
    samples: [usize; 2],
    placement: &Placement,
    story: &str,
) -> ImageData {
    let Some((name, first)) = arrays.first() else { return ImageData::empty([1, 1, 1]) };
    let (width, height) = (first.grid().width(), first.grid().height());
    let geometry = placement.geometry();
    let mut image = ImageData::empty([width, height, 1]);
    image.origin = geometry.corner();
    let spacing = geometry.spacing();
    let fine = [spacing[0] / samples[0] as f64, spacing[1] / samples[1] as f64];
    image.spacing = [fine[0], fine[1], 1.0];
    image.direction = geometry.direction();
    image.point_active.scalars = Some((*name).to_owned());
    for (name, field) in arrays {
        let values = Rows::Upwards.from_top(field.values(), [width, height], 1);
        image.point_arrays.push(DataArray::new(name, 1, values));
    }
    image.push_text(PROVENANCE, story);
    image
}

/// Appends a line and its points to poly data.
fn push_line(data: &mut PolyData, points: impl Iterator<Item = [f64; 3]>) {
    let line = push_points(data, points);
    data.lines.push(line);
}

/// Appends points and returns their indices.
fn push_points(data: &mut PolyData, points: impl Iterator<Item = [f64; 3]>) -> Range<usize> {
    let first = data.points.len();
    data.points.extend(points);
    first..data.points.len()
}

/// An array of integers.
fn counts(name: &str, values: impl IntoIterator<Item = i32>) -> DataArray {
    let values = values.into_iter().map(f64::from).collect();
    DataArray { scalar: tigereye_io::ScalarType::Int32, ..DataArray::new(name, 1, values) }
}

/// Adds the provenance that every written file carries.
fn push_story(data: &mut PolyData, story: &str) {
    let values = FieldValues::Text(vec![story.to_owned()]);
    data.field_data.push(FieldEntry { name: PROVENANCE.to_owned(), values });
}

/// Options of a map of lines and points: zero and non-finite tensors are hatched and, if lines follow eigenvectors,
/// tensors with complex eigenvalues are shaded.
fn plain_options(
    field: &Field<Tensor2>,
    following: Following,
    title: &str,
    description: &str,
    overlays: Vec<Overlay>,
) -> PlainOptions {
    let missing = field.iter().filter(|(_, t)| t.is_zero() || !t.is_finite()).map(|(cell, _)| cell);
    let has_eigenvectors = following.axes.axes() != Axes::HalfAxes;
    let plain = field.without_rounding();
    let complex = plain.iter().filter(|(_, t)| has_eigenvectors && is_complex(t)).map(|(cell, _)| cell);
    PlainOptions {
        cell: following.cell,
        title: title.to_owned(),
        description: description.to_owned(),
        overlays,
        missing: missing.collect(),
        missing_label: "no tensor".to_owned(),
        shaded: complex.collect(),
        shaded_label: "complex eigenvalues".to_owned(),
        ..PlainOptions::default()
    }
}
