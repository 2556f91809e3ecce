//! Views of tensor fields, one file each: from a request to what is found, with its picture, its data for VTK and its
//! parameters.

pub mod added;
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
use tigereye_core::{Cell, CellShape, Field, Grid, Point, Tensor2};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{DataArray, FieldEntry, FieldValues, ImageData, PROVENANCE, PolyData, Rows};
use tigereye_lines::{Axes, Following, is_complex};
use tigereye_render::{Coordinates, PlainOptions};

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

    /// The point of the grid at a position in the world, or nearest to it in the plane.
    #[must_use]
    pub fn cells_of(&self, place: [f64; 3]) -> Point {
        let (corner, [dx, dy]) = (self.geometry.corner(), self.geometry.spacing());
        let along = |direction: [f64; 3]| (0..3).map(|i| (place[i] - corner[i]) * direction[i]).sum::<f64>();
        let (right, up) = (along(self.geometry.right()) / dx, along(self.geometry.up()) / dy);
        Point::new(right, (self.height - 1) as f64 - up)
    }

    /// The shape of a cell.
    #[must_use]
    pub fn cell(&self) -> CellShape {
        CellShape::of(self.geometry.spacing())
    }

    /// The coordinates of columns and rows; `None` where the input says nothing about its place. Along the axes of the
    /// world they are the world's, otherwise distances along the rows and columns.
    #[must_use]
    pub fn coordinates(&self) -> Option<[Coordinates; 2]> {
        const NAMES: [&str; 3] = ["x", "y", "z"];
        let geometry = self.geometry;
        if !geometry.is_placed() {
            return None;
        }
        let (corner, flat, [dx, dy]) = (geometry.corner(), geometry.flat().corner(), geometry.spacing());
        let along =
            |direction: [f64; 3]| (0..3).max_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs()));
        let on_axes = |direction: [f64; 3], other: usize, words: &str, step: f64| match along(direction) {
            Some(axis) if !geometry.is_oblique() => {
                (NAMES[axis].to_owned(), corner[axis], step * direction[axis])
            }
            _ => (words.to_owned(), flat[other], step),
        };
        let (name, first, step) = on_axes(geometry.right(), 0, "along the rows", dx);
        let x = Coordinates { name, first, step };
        let (name, lowest, up) = on_axes(geometry.up(), 1, "along the columns", dy);
        let first = lowest + up * self.height.saturating_sub(1) as f64;
        Some([x, Coordinates { name, first, step: -up }])
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

/// Options of a map of lines and points: tensors that lines cannot follow are grey and, if lines follow eigenvectors,
/// those with complex eigenvalues are shaded.
fn plain_options(
    field: &Field<Tensor2>,
    following: Following,
    description: &str,
    options: PlainOptions,
) -> PlainOptions {
    let has_eigenvectors = following.axes.axes() != Axes::HalfAxes;
    let plain = field.without_rounding();
    let complex = plain.iter().filter(|(_, t)| has_eigenvectors && is_complex(t)).map(|(cell, _)| cell);
    PlainOptions {
        cell: following.cell,
        description: description.to_owned(),
        masked: masked(field),
        shaded: complex.collect(),
        shaded_label: "complex eigenvalues".to_owned(),
        ..options
    }
}

/// Cells without a tensor, which every picture shows in grey: no material, a zero tensor, or one that is not finite.
#[must_use]
pub fn masked(field: &Field<Tensor2>) -> Vec<Cell> {
    field.iter().filter(|(_, t)| t.is_zero() || !t.is_finite()).map(|(cell, _)| cell).collect()
}
