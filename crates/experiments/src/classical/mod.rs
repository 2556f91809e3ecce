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
use tigereye_core::{CellShape, Field, Grid, Symmetry, Tensor2};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{DataArray, FieldEntry, FieldValues, PROVENANCE, PolyData};
use tigereye_lines::{
    Axes, Decomposition, Family, Interpolated, Major, OrderedAxes, ellipse_tensors, signed_ellipse_tensors,
};
use tigereye_render::{Overlay, PlainOptions};

/// The axes that are usual for a field: eigenvectors where it is symmetric ([`Symmetry`]), semi-axes otherwise.
#[must_use]
pub fn usual_axes(field: &Field<Tensor2>) -> Axes {
    if Symmetry::of(field).is_symmetric() { Axes::Eigenvectors } else { Axes::HalfAxes }
}

/// The part of the stretching by which the turning exceeds it at least: in simple shear both are equal but for rounding.
const COMPLEX_ABOVE: f64 = 1e-6;

/// Whether the eigenvalues of a tensor are complex: it turns more than it stretches. Ask it of [`Field::without_rounding`].
#[must_use]
pub fn is_complex(t: &Tensor2) -> bool {
    let Decomposition { rotation, stretching, .. } = Decomposition::of(t);
    t.is_finite() && rotation.abs() > (1.0 + COMPLEX_ABOVE) * stretching
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

/// The name of an order as the options and files spell it.
#[must_use]
pub const fn major_name(major: Major) -> &'static str {
    match major {
        Major::Value => "value",
        Major::Magnitude => "magnitude",
    }
}

/// What axes are in words.
#[must_use]
pub const fn axes_words(axes: OrderedAxes) -> &'static str {
    match (axes.axes(), axes.major()) {
        (Axes::HalfAxes, Major::Magnitude) => "semi-axes, major by magnitude (the longer one)",
        (Axes::HalfAxes, Major::Value) => "semi-axes, major by value (tension positive)",
        (Axes::Eigenvectors, Major::Magnitude) => "eigenvectors, major by magnitude (the larger size)",
        (Axes::Eigenvectors, Major::Value) => "eigenvectors, major by value (tension positive)",
        (Axes::DualEigenvectors, _) => "dual eigenvectors, the longer one major",
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

/// What lines follow: axes in an order, over cells of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// The axes, and which of them is major.
    pub axes: OrderedAxes,
    /// The shape of a cell.
    pub cell: CellShape,
}

impl Following {
    /// The longer side of a grid, in the unit of the smaller side of a cell.
    #[must_use]
    pub fn longer_side(&self, grid: Grid) -> f64 {
        self.cell.longer_side([grid.width(), grid.height()])
    }
}

/// A field whose axes are followed between its cells. Semi-axes are those of the ellipses, because the components of tensors that
/// are not symmetric may cancel between cells whose ellipses agree. What rounding made asymmetric is symmetric.
#[derive(Clone, Debug)]
pub struct Followed {
    tensors: Field<Tensor2>,
    following: Following,
}

impl Followed {
    /// The tensors to interpolate for these axes.
    #[must_use]
    pub fn new(field: &Field<Tensor2>, following: Following) -> Self {
        let plain = field.without_rounding();
        let tensors = match (following.axes.axes(), following.axes.major()) {
            (Axes::HalfAxes, Major::Magnitude) => ellipse_tensors(&plain),
            (Axes::HalfAxes, Major::Value) => signed_ellipse_tensors(&plain),
            (Axes::Eigenvectors | Axes::DualEigenvectors, _) => plain,
        };
        Self { tensors, following }
    }

    /// The field between its cells.
    #[must_use]
    pub fn interpolated(&self) -> Interpolated<'_> {
        Interpolated::new(&self.tensors).with_axes(self.following.axes).with_cell(self.following.cell)
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

    /// The shape of a cell.
    #[must_use]
    pub fn cell(&self) -> CellShape {
        CellShape::of(self.geometry.spacing())
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

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_fields::{generate, generators, parse_spec};

    /// What is symmetric has no asymmetry but rounding, and what is not has much: nothing lies near to the border.
    #[test]
    fn generators_are_judged_with_a_wide_margin() {
        let (mut symmetric, mut others) = (0, 0);
        for generator in generators() {
            let spec = parse_spec(generator.name).expect("a generator");
            let field = generate(&spec.name, &spec.arguments).expect("a field");
            let ratio = Symmetry::of(&field).ratio();
            let is_symmetric = usual_axes(&field) == Axes::Eigenvectors;
            assert!(!(1e-12..=0.05).contains(&ratio), "{}: {ratio}", generator.name);
            assert_eq!(is_symmetric, ratio < 1e-12, "{}", generator.name);
            symmetric += usize::from(is_symmetric);
            others += usize::from(!is_symmetric);
        }
        assert!(symmetric > 3 && others > 3, "{symmetric} {others}");
    }

    /// Simple shear stretches as much as it turns, in single precision, too.
    #[test]
    fn simple_shear_is_not_complex_by_rounding() {
        for rounding in [0.0, 6e-8, -6e-8] {
            assert!(!is_complex(&Tensor2::new(rounding, 1.0, rounding, -rounding)), "{rounding}");
        }
        assert!(is_complex(&Tensor2::new(0.0, 1.0, -1e-3, 0.0)));
    }
}
