//! The classical pictures of tensor fields, computed by `lines`, as figures and as VTK data.

pub mod agreement;
pub mod fine;
pub mod glyphs;
pub mod lines;
mod overlays;
pub mod ridges;
pub mod topology;

pub use overlays::{line_overlay, point_overlays};

use std::ops::Range;
use tigereye_core::{Field, Grid, Tensor2};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{DataArray, FieldEntry, FieldValues, PROVENANCE, PolyData};
use tigereye_lines::{Axes, Decomposition, Domain, Family, Interpolated, ellipse_tensors};
use tigereye_render::{Overlay, PlainOptions};

/// Part of its largest component by which a tensor's two shear components differ at most to count as symmetric.
const SYMMETRIC_BELOW: f64 = 1e-9;

/// The axes that are usual for a field: eigenvectors where all tensors are symmetric, half-axes otherwise.
#[must_use]
pub fn usual_axes(field: &Field<Tensor2>) -> Axes {
    let symmetric =
        field.values().iter().all(|t| t.asymmetry() <= SYMMETRIC_BELOW * t.max_abs() || !t.is_finite());
    if symmetric { Axes::Eigenvectors } else { Axes::HalfAxes }
}

/// Whether the eigenvalues of a tensor are complex: it turns more than it stretches.
#[must_use]
pub fn is_complex(t: &Tensor2) -> bool {
    t.is_finite() && Decomposition::of(t).domain() == Domain::Complex
}

/// The name of axes as the options and files spell it.
#[must_use]
pub const fn axes_name(axes: Axes) -> &'static str {
    match axes {
        Axes::HalfAxes => "half",
        Axes::Eigenvectors => "eigen",
        Axes::DualEigenvectors => "dual",
    }
}

/// The name of a family as the options and files spell it.
#[must_use]
pub const fn family_name(family: Family) -> &'static str {
    match family {
        Family::Major => "major",
        Family::Minor => "minor",
    }
}

/// A field whose axes are followed between its cells. Half-axes are those of the ellipses, because the components of tensors that
/// are not symmetric may cancel between cells whose ellipses agree.
#[derive(Clone, Debug)]
pub struct Followed {
    tensors: Field<Tensor2>,
    axes: Axes,
}

impl Followed {
    /// The tensors to interpolate for these axes.
    #[must_use]
    pub fn new(field: &Field<Tensor2>, axes: Axes) -> Self {
        let tensors = match axes {
            Axes::HalfAxes => ellipse_tensors(field),
            Axes::Eigenvectors | Axes::DualEigenvectors => field.clone(),
        };
        Self { tensors, axes }
    }

    /// The field between its cells.
    #[must_use]
    pub const fn interpolated(&self) -> Interpolated<'_> {
        Interpolated::new(&self.tensors).with_axes(self.axes)
    }
}

/// Where the cells of a field lie, counted with y downwards as fields count them.
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

    /// The place of a point in cells, y downwards.
    #[must_use]
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        self.geometry.place([x, (self.height - 1) as f64 - y])
    }

    /// Where the cells lie.
    #[must_use]
    pub const fn geometry(&self) -> &PlaneGeometry {
        &self.geometry
    }
}

/// Adds lines to poly data; the points of each follow those of the one before.
fn push_line(data: &mut PolyData, points: impl Iterator<Item = [f64; 3]>) {
    let line = push_points(data, points);
    data.lines.push(line);
}

/// Adds points; which they are.
fn push_points(data: &mut PolyData, points: impl Iterator<Item = [f64; 3]>) -> Range<usize> {
    let first = data.points.len();
    data.points.extend(points);
    first..data.points.len()
}

/// Whole numbers as an array.
fn counts(name: &str, values: impl IntoIterator<Item = i32>) -> DataArray {
    let values = values.into_iter().map(f64::from).collect();
    DataArray { scalar: tigereye_io::ScalarType::Int32, ..DataArray::new(name, 1, values) }
}

/// Where the data come from, as every written file says.
fn push_story(data: &mut PolyData, story: &str) {
    let values = FieldValues::Text(vec![story.to_owned()]);
    data.field_data.push(FieldEntry { name: PROVENANCE.to_owned(), values });
}

/// Lines and points over a field of which zero tensors and those that are not finite are hatched, and, where lines follow eigenvectors,
/// those with complex eigenvalues shaded.
fn plain_options(
    field: &Field<Tensor2>,
    axes: Axes,
    title: &str,
    description: &str,
    overlays: Vec<Overlay>,
) -> PlainOptions {
    let missing = field.iter().filter(|(_, t)| t.is_zero() || !t.is_finite()).map(|(cell, _)| cell);
    let complex = field.iter().filter(|(_, t)| axes != Axes::HalfAxes && is_complex(t)).map(|(cell, _)| cell);
    PlainOptions {
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
