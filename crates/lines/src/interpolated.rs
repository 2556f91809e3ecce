//! Tensors and their axes between the centres of cells.

use crate::slope::{self, Numbers};
use crate::{Axes, Family, Frame, OrderedAxes};
use tigereye_core::{CellShape, Field, Grid, Point, Svd, Tensor2, Vector, bilinear};

/// The symmetric tensor with the same ellipse for every cell: `U S U^T` for a tensor `U S V^T`, its left stretch
/// tensor. Light depends only on the ellipse. Asymmetric tensors should be interpolated in this form: their own
/// components may cancel between cells whose ellipses agree.
#[must_use]
pub fn ellipse_tensors(field: &Field<Tensor2>) -> Field<Tensor2> {
    field.map(|t| {
        let svd = Svd::of(t);
        if t.is_finite() { Tensor2::from_eigen(svd.phi_rad(), svd.s[0], svd.s[1]) } else { *t }
    })
}

/// The same with signed semi-axes: an axis `u` has the sign of `u . T u`. A symmetric tensor is unchanged. This is the
/// form to interpolate for semi-axes ordered by value ([`crate::Major`]): in pure shear both are equally long, but one
/// is in tension and the other in compression.
#[must_use]
pub fn signed_ellipse_tensors(field: &Field<Tensor2>) -> Field<Tensor2> {
    field.map(|t| {
        if !t.is_finite() || t.asymmetry() == 0.0 {
            return *t;
        }
        let svd = Svd::of(t);
        // Along the longer axis u . T u has the sign of the trace, along the other that of the trace times the
        // determinant.
        let longer = if t.trace() < 0.0 { -svd.s[0] } else { svd.s[0] };
        let shorter = if (t.trace() < 0.0) == (t.determinant() < 0.0) { svd.s[1] } else { -svd.s[1] };
        Tensor2::from_eigen(svd.phi_rad(), longer, shorter)
    })
}

/// Largest distance outside the field, in cells, at which a point still counts as on the border: rounding moves a line
/// along the border by some 1e-16 of the coordinate per step.
const ROUNDING: f64 = 1e-9;

/// Where points lie among the cells of a grid, without branches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Within {
    /// Coordinates of the last cell.
    last: [f64; 2],
    /// Column and row of the last square between four cells.
    last_square: [i32; 2],
    /// Cells per row. A grid has fewer than 2^31 cells.
    width: i32,
    /// Distances in memory to the next column and row; 0 on a grid one cell wide or high, where cells repeat.
    next: [usize; 2],
}

/// A point within the square of four cells.
pub(crate) struct Place {
    /// Index of the square's upper left cell.
    pub(crate) square: i32,
    /// The part of the way to the next column and row.
    pub(crate) parts: [f64; 2],
    /// Whether the point lies in the field, up to rounding.
    pub(crate) is_inside: bool,
}

impl Within {
    #[inline(always)]
    pub(crate) fn new(grid: Grid) -> Self {
        let [width, height] = [grid.width(), grid.height()];
        Self {
            last: [(width - 1) as f64, (height - 1) as f64],
            last_square: [width, height].map(|n| n.saturating_sub(2) as i32),
            width: width as i32,
            next: [usize::from(width > 1), if height > 1 { width } else { 0 }],
        }
    }

    #[inline(always)]
    pub(crate) fn place(&self, x: f64, y: f64) -> Place {
        let is_within = |v: f64, last: f64| (v >= -ROUNDING) & (v <= last + ROUNDING);
        let is_inside = is_within(x, self.last[0]) & is_within(y, self.last[1]);
        // Comparisons rather than `max` and `min`, which take three instructions each because of NaN.
        let along = |v: f64, last: f64, last_square: i32| {
            let v = if v > 0.0 { v } else { 0.0 };
            let v = if v < last { v } else { last };
            let before = (v as i32).min(last_square);
            (before, v - f64::from(before))
        };
        let (i, u) = along(x, self.last[0], self.last_square[0]);
        let (j, v) = along(y, self.last[1], self.last_square[1]);
        Place { square: j * self.width + i, parts: [u, v], is_inside }
    }

    /// The four cells of a square: upper left, upper right, lower left, lower right.
    #[inline(always)]
    pub(crate) fn corners(&self, square: i32) -> [usize; 4] {
        let square = square as usize;
        let [right, down] = self.next;
        [square, square + right, square + down, square + right + down]
    }
}

/// The bilinear polynomial with given values at the corners of a square: 1, u, v and u v, where u and v are the parts
/// of the way to the next column and row.
#[inline(always)]
pub(crate) fn polynomial([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, b - a, c - a, (d - c) - (b - a)]
}

/// The value of such a polynomial.
#[inline(always)]
pub(crate) fn evaluated([one, along_u, along_v, along_both]: [f64; 4], [u, v]: [f64; 2]) -> f64 {
    (one + along_u * u) + (along_v + along_both * u) * v
}

/// A tensor field interpolated between its cells.
#[derive(Clone, Copy, Debug)]
pub struct Interpolated<'a> {
    field: &'a Field<Tensor2>,
    axes: OrderedAxes,
    cell: CellShape,
    is_symmetric: bool,
}

impl<'a> Interpolated<'a> {
    /// Tensors between the centres of the square cells of `field`, and their semi-axes, the longer one major.
    #[must_use]
    pub fn new(field: &'a Field<Tensor2>) -> Self {
        let is_symmetric = field.values().iter().all(|t| t.xy() == t.yx() || !t.is_finite());
        Self { field, axes: Axes::HalfAxes.into(), cell: CellShape::SQUARE, is_symmetric }
    }

    /// The same field with other axes, in their usual order or in another ([`Axes::by`]).
    #[must_use]
    pub fn with_axes(self, axes: impl Into<OrderedAxes>) -> Self {
        Self { axes: axes.into(), ..self }
    }

    /// The same field with cells of another shape. Tensors stay what they are, in a frame of equal units along x and y.
    #[must_use]
    pub const fn with_cell(self, cell: CellShape) -> Self {
        Self { cell, ..self }
    }

    /// The axes.
    #[must_use]
    pub const fn axes(&self) -> OrderedAxes {
        self.axes
    }

    /// The shape of a cell.
    #[must_use]
    pub const fn cell(&self) -> CellShape {
        self.cell
    }

    /// Whether all finite tensors are symmetric, to the last bit.
    pub(crate) const fn is_symmetric(&self) -> bool {
        self.is_symmetric
    }

    /// The field.
    #[must_use]
    pub const fn field(&self) -> &'a Field<Tensor2> {
        self.field
    }

    /// The centre of the lower right cell, the last point with a tensor: (width - 1, height - 1).
    #[must_use]
    pub const fn last(&self) -> Point {
        let grid = self.field.grid();
        Point::new((grid.width() - 1) as f64, (grid.height() - 1) as f64)
    }

    /// The tensor at a point, bilinear in every component; `None` more than a billionth of a cell (rounding) outside
    /// the centres of the outermost cells, and where one of the four cells is not finite.
    #[must_use]
    pub fn at(&self, p: Point) -> Option<Tensor2> {
        let last = self.last();
        let is_within = |v: f64, last: f64| (-ROUNDING..=last + ROUNDING).contains(&v);
        if !(is_within(p.x, last.x) && is_within(p.y, last.y)) {
            return None;
        }
        let mut t = [0.0; 4];
        for (cell, weight) in bilinear(self.field.grid(), p) {
            t.iter_mut().zip(self.field.at(cell).components()).for_each(|(t, c)| *t += weight * c);
        }
        let t = Tensor2::new(t[0], t[1], t[2], t[3]);
        t.is_finite().then_some(t)
    }

    /// The numbers `E` and `F` at a point, as [`Self::at`] has the tensor; `None` outside the field. They are not
    /// finite where one of the four cells is not.
    #[inline(always)]
    pub(crate) fn numbers(&self, p: Point) -> Option<Numbers> {
        let within = Within::new(self.field.grid());
        let Place { square, parts, is_inside } = within.place(p.x, p.y);
        is_inside.then(|| {
            let of = |i: usize| slope::numbers(&self.field.values()[i]);
            let [a, b, c, d] = within.corners(square);
            let (a, b, c, d) = (of(a), of(b), of(c), of(d));
            let at = |n: usize| evaluated(polynomial([a[n], b[n], c[n], d[n]]), parts);
            [at(0), at(1), at(2), at(3)]
        })
    }

    /// The axes at a point (see [`Axes::of`] for `least`); `None` as for [`Self::at`], and where the
    /// tensor is degenerate.
    #[must_use]
    pub fn frame(&self, point: Point, least: f64) -> Option<Frame> {
        self.axes.of(&self.at(point)?, least)
    }

    /// Unit vector of an axis at a point, with either sign; `None` as for [`Self::frame`].
    #[must_use]
    pub fn direction(&self, point: Point, family: Family, least: f64) -> Option<Vector> {
        Some(self.frame(point, least)?.axes[family as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Major;
    use tigereye_core::{Cell, math, quarter_turned};

    #[test]
    fn bilinear_components_are_reproduced() {
        let grid = Grid::new(5, 4).expect("a size");
        let linear = |x: f64, y: f64| Tensor2::new(1.0 + x, 2.0 * y, x - y, 3.0 + x * y);
        let field = Field::from_fn(grid, |c| linear(c.x as f64, c.y as f64));
        let between = Interpolated::new(&field);
        for (x, y) in [(0.0, 0.0), (4.0, 3.0), (1.25, 2.75), (3.999, 0.5)] {
            let p = Point::new(x, y);
            let (found, expected) = (between.at(p).expect("inside").components(), linear(x, y).components());
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{p:?}");
        }
        assert_eq!(between.at(Point::new(-1e-15, 3.0 + 1e-15)), between.at(Point::new(0.0, 3.0)));
        for (x, y) in [(-1e-8, 1.0), (4.01, 1.0), (1.0, 3.2), (f64::NAN, 1.0)] {
            assert_eq!(between.at(Point::new(x, y)), None, "{x} {y}");
        }
    }

    #[test]
    fn directions_are_those_of_the_tensor() {
        let field = Field::from_fn(Grid::new(2, 2).expect("a size"), |_| Tensor2::from_axes(0.6, 3.0, 1.0));
        let between = Interpolated::new(&field);
        let major = between.direction(Point::new(0.5, 0.5), Family::Major, 1e-3).expect("an axis");
        let minor = between.direction(Point::new(0.5, 0.5), Family::Minor, 1e-3).expect("an axis");
        let off = |v: Vector, phi: f64| v.cross(Vector::new(math::cos(phi), math::sin(phi))).abs();
        assert!(off(major, 0.6) < 1e-12 && off(minor, 0.6 + math::FRAC_PI_2) < 1e-12);
        assert_eq!(between.direction(Point::new(0.5, 0.5), Family::Major, 0.7), None, "too round");
    }

    #[test]
    fn ellipse_tensors_are_symmetric_with_the_same_ellipse() {
        let tensors = [
            Tensor2::new(1.0, 2.0, -0.5, 0.25),
            Tensor2::from_axes(2.0, 3.0, 1.0),
            Tensor2::symmetric(-1.0, 0.5, 2.0),
            Tensor2::ZERO,
        ];
        for t in tensors {
            let field = Field::from_fn(Grid::new(1, 1).expect("a size"), |_| t);
            let s = *ellipse_tensors(&field).at(Cell::new(0, 0));
            assert!(s.asymmetry() < 1e-15);
            // Both make the same ellipse: t t^T = s s^T.
            let square = |t: Tensor2| {
                let [a, b, c, d] = t.components();
                [a * a + b * b, a * c + b * d, c * c + d * d]
            };
            assert!(square(s).iter().zip(square(t)).all(|(a, b)| (a - b).abs() < 1e-12), "{t:?}");
        }
    }

    /// Symmetric tensors are unchanged; others keep their ellipse, with the sign of `u . T u` along each of its axes.
    #[test]
    fn signed_ellipses_have_tension_and_compression_along_the_axes() {
        let tensors = [
            Tensor2::new(1.0, 2.0, -0.5, 0.25),
            Tensor2::new(-1.0, 2.0, -0.5, 0.25),
            Tensor2::new(-1.0, 2.0, 0.5, -0.25),
            Tensor2::new(1.0, -2.0, -0.5, -0.5),
            Tensor2::from_axes(2.0, 3.0, 1.0),
            Tensor2::symmetric(-1.0, 0.5, 2.0),
            Tensor2::symmetric(2.0, 0.0, -2.0),
        ];
        for t in tensors {
            let field = Field::from_fn(Grid::new(1, 1).expect("a size"), |_| t);
            let s = *signed_ellipse_tensors(&field).at(Cell::new(0, 0));
            if t.asymmetry() == 0.0 {
                assert_eq!(s, t);
                continue;
            }
            let along = |t: &Tensor2, Vector { x, y, .. }: Vector| {
                x * (t.xx() * x + t.xy() * y) + y * (t.yx() * x + t.yy() * y)
            };
            let svd = Svd::of(&t);
            for (axis, length) in [(svd.major(), svd.s[0]), (quarter_turned(svd.major()), svd.s[1])] {
                let (own, signed) = (along(&t, axis), along(&s, axis));
                assert!((signed.abs() - length).abs() < 1e-14 && own * signed > 0.0, "{t:?}: {own} {signed}");
            }
            // The axis of the larger eigenvalue of one is that of the larger u . T u of the other.
            let [by_value, eigen] =
                [Axes::HalfAxes.by(Major::Value).of(&t, 0.0), Axes::Eigenvectors.of(&s, 0.0)]
                    .map(|f| f.expect("axes").axes[0]);
            assert!(by_value.cross(eigen).abs() < 1e-14, "{t:?}");
        }
    }

    #[test]
    fn one_row_has_tensors_along_it() {
        let field = Field::from_fn(Grid::new(3, 1).expect("a size"), |c| Tensor2::isotropic(c.x as f64));
        assert_eq!(Interpolated::new(&field).at(Point::new(1.5, 0.0)), Some(Tensor2::isotropic(1.5)));
    }
}
