//! Lines and surfaces as points with lists of indices.

use tigereye_core::{Point, math};

/// Connected lines over shared points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polylines {
    /// The points.
    pub points: Vec<Point>,
    /// The lines.
    pub lines: Vec<Polyline>,
}

/// One line, as the indices of its points in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polyline {
    /// Indices of points. The first is not repeated at the end of a closed line.
    pub points: Vec<u32>,
    /// Whether the last point is connected with the first.
    pub closed: bool,
}

impl Polylines {
    /// Length of a line in cells, with each axis scaled by `cell`.
    #[must_use]
    pub fn length(&self, line: &Polyline, cell: [f64; 2]) -> f64 {
        line.segments()
            .map(|ends| {
                let [p, q] = ends.map(|i| self.points[i as usize]);
                math::hypot(cell[0] * (q.x - p.x), cell[1] * (q.y - p.y))
            })
            .sum()
    }
}

impl Polyline {
    /// The pairs of connected points, in order.
    pub fn segments(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let back =
            self.closed.then(|| self.points.last().copied().zip(self.points.first().copied())).flatten();
        self.points.windows(2).map(|w| [w[0], w[1]]).chain(back.map(|(a, b)| [a, b]))
    }
}

/// Triangles over shared points. No triangle crosses the seam of a periodic axis: those on either side end at it with
/// separate points at the same position, so that the surface fits into the box of the volume.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Points `[x, y, third]`: x and y in cells (y downwards), the third coordinate in the volume's unit
    /// ([`crate::Volume`]).
    pub points: Vec<[f64; 3]>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Area of a triangle, with each axis scaled by `cell`.
    #[must_use]
    pub fn area_of(&self, triangle: [u32; 3], cell: [f64; 3]) -> f64 {
        let [p, q, r] = triangle.map(|i| self.points[i as usize]);
        let side = |to: [f64; 3]| [0, 1, 2].map(|d| cell[d] * (to[d] - p[d]));
        let n = cross(side(q), side(r));
        0.5 * dot(n, n).sqrt()
    }
    /// Area of all triangles, with each axis scaled by `cell`.
    #[must_use]
    pub fn area(&self, cell: [f64; 3]) -> f64 {
        self.triangles.iter().map(|&t| self.area_of(t, cell)).sum()
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
