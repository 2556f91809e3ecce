//! Degenerate points, where both semi-axes are equally long, classified by the rotation of the axes around them.
//!
//! By the two numbers of [`Conformal`], the longer semi-axis lies at `(arg E + arg F) / 2`. It has no direction where
//! `F` or `E` is zero; on a closed path around such a point it rotates by half of the winding of that number. Symmetric
//! tensors have a real `E`, so their degenerate points are the zeros of `F` (the classical ones of Delmarcelle and
//! Hesselink 1994).

use core::f64::consts::TAU;
use tigereye_core::{Cell, Complex, Conformal, Field, Grid, Point, Tensor2, math};

/// The pattern of the lines around a degenerate point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DegenerateKind {
    /// Index 1/2.
    Wedge,
    /// Index -1/2.
    Trisector,
    /// Several of them merged: any other index, as a number of half turns.
    Merged(i32),
}

/// A point at which the axes are undefined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DegeneratePoint {
    /// Where it is.
    pub position: Point,
    /// Its type.
    pub kind: DegenerateKind,
}

impl DegeneratePoint {
    /// Half turns of the axes, counter-clockwise, on a counter-clockwise path around the point: twice the index.
    #[must_use]
    pub const fn half_turns(&self) -> i32 {
        match self.kind {
            DegenerateKind::Wedge => 1,
            DegenerateKind::Trisector => -1,
            DegenerateKind::Merged(n) => n,
        }
    }
}

/// Numbers below this fraction of their tensor's largest component count as zero: they are rounding errors.
const ROUNDING: f64 = 1e-12;

/// All degenerate points between the centres of cells, row by row, of tensors interpolated component by component.
/// A connected region of isotropic cells is one point at its centre, with the index of the path around the region.
/// Regions at the border, around which no path lies inside the field, are omitted, as are points and lines of index 0.
#[must_use]
pub fn degenerate_points(field: &Field<Tensor2>) -> Vec<DegeneratePoint> {
    zeros(field, &[field.map(|t| Conformal::of(t).f), field.map(|t| Conformal::of(t).e)])
}

/// The degenerate points of eigenvectors and dual eigenvectors: the zeros of the stretching `F`.
pub(crate) fn points_of_stretching(field: &Field<Tensor2>) -> Vec<DegeneratePoint> {
    zeros(field, &[field.map(|t| Conformal::of(t).f)])
}

fn zeros(field: &Field<Tensor2>, numbers: &[Field<Complex<f64>>]) -> Vec<DegeneratePoint> {
    let grid = field.grid();
    if grid.width() < 2 || grid.height() < 2 {
        return Vec::new();
    }
    let mut found: Vec<DegeneratePoint> = numbers.iter().flat_map(|n| Plane::new(field, n).zeros()).collect();
    found.sort_by(|a, b| {
        let key = |p: &DegeneratePoint| (p.position.y, p.position.x);
        key(a).partial_cmp(&key(b)).unwrap_or(core::cmp::Ordering::Equal)
    });
    found
}

/// One complex number per cell.
struct Plane<'a> {
    grid: Grid,
    numbers: &'a Field<Complex<f64>>,
    /// Whether the number of a cell is zero.
    zero: Vec<bool>,
}

/// The corners of a quad counter-clockwise (y downwards: left bottom, right bottom, right top, left top), relative to
/// its upper left cell.
const CORNERS: [(usize, usize); 4] = [(0, 1), (1, 1), (1, 0), (0, 0)];

impl<'a> Plane<'a> {
    fn new(field: &Field<Tensor2>, numbers: &'a Field<Complex<f64>>) -> Self {
        let is_zero = |(z, t): (&Complex<f64>, &Tensor2)| math::hypot(z.re, z.im) <= ROUNDING * t.max_abs();
        let zero = numbers.values().iter().zip(field.values()).map(is_zero).collect();
        Self { grid: field.grid(), numbers, zero }
    }

    fn corners(&self, quad: Cell) -> [Cell; 4] {
        CORNERS.map(|(dx, dy)| Cell::new(quad.x + dx, quad.y + dy))
    }

    /// Magnitude of a cell's number, 0 if it is a rounding error.
    fn size(&self, cell: Cell) -> f64 {
        let z = self.numbers.at(cell);
        if self.is_zero(cell) { 0.0 } else { math::hypot(z.re, z.im) }
    }

    /// Change of the argument from one cell to the next along the shorter arc; `None` if neither arc is shorter.
    fn turn(&self, from: Cell, to: Cell) -> Option<f64> {
        if self.is_zero(from) || self.is_zero(to) {
            return None;
        }
        let (a, b) = (self.numbers.at(from), self.numbers.at(to));
        let (cross, dot) = (a.re * b.im - a.im * b.re, a.re * b.re + a.im * b.im);
        // Opposite numbers have no shorter arc: real numbers of both signs, which vanish on lines rather than at
        // points.
        let opposite = cross.abs() <= ROUNDING * dot.abs() && dot < 0.0;
        let angle = math::atan2(cross, dot);
        (angle.is_finite() && !opposite).then_some(angle)
    }

    fn is_zero(&self, cell: Cell) -> bool {
        self.zero[self.grid.index(cell)]
    }

    /// Quads are merged across an edge on which [`Self::turn`] is undefined: the number vanishes on that edge.
    fn zeros(&self) -> Vec<DegeneratePoint> {
        let mut found = Vec::new();
        let mut seen = vec![false; self.grid.cells()];
        for y in 0..self.grid.height() - 1 {
            for x in 0..self.grid.width() - 1 {
                let quad = Cell::new(x, y);
                if !core::mem::replace(&mut seen[self.grid.index(quad)], true) {
                    found.extend(self.around(quad, &mut seen));
                }
            }
        }
        found
    }

    /// The neighbouring quad across each edge, if it exists: below, right, above, left.
    fn beyond(&self, quad: Cell) -> [Option<Cell>; 4] {
        [
            (quad.y + 2 < self.grid.height()).then(|| Cell::new(quad.x, quad.y + 1)),
            (quad.x + 2 < self.grid.width()).then(|| Cell::new(quad.x + 1, quad.y)),
            quad.y.checked_sub(1).map(|y| Cell::new(quad.x, y)),
            quad.x.checked_sub(1).map(|x| Cell::new(x, quad.y)),
        ]
    }

    /// The degenerate point of a quad and those merged with it, if the path around them lies inside the field and its
    /// index is not 0.
    fn around(&self, first: Cell, seen: &mut [bool]) -> Option<DegeneratePoint> {
        let mut quads = vec![first];
        let (mut total, mut next, mut leaves) = (0.0, 0, false);
        // Sum and count of the zeros on edges.
        let (mut middle, mut count) = (Point::zero(), 0.0);
        while next < quads.len() {
            let corners = self.corners(quads[next]);
            for (i, beyond) in self.beyond(quads[next]).into_iter().enumerate() {
                let (from, to) = (corners[i], corners[(i + 1) % 4]);
                // Edges between two merged quads are traversed in both directions and cancel.
                if let Some(turn) = self.turn(from, to) {
                    total += turn;
                    continue;
                }
                let (a, b) = (self.size(from), self.size(to));
                // Paths around cells that are not finite are undefined.
                leaves |= !(a + b).is_finite();
                let t = if a + b > 0.0 { a / (a + b) } else { 0.5 };
                middle.x += (1.0 - t) * from.x as f64 + t * to.x as f64;
                middle.y += (1.0 - t) * from.y as f64 + t * to.y as f64;
                count += 1.0;
                match beyond {
                    None => leaves = true,
                    Some(q) if !seen[self.grid.index(q)] => {
                        seen[self.grid.index(q)] = true;
                        quads.push(q);
                    }
                    Some(_) => {}
                }
            }
            next += 1;
        }
        let half_turns = half_turns_of(total);
        if leaves || half_turns == 0 {
            return None;
        }
        let position = if count > 0.0 { middle / count } else { self.zero_in(first) };
        Some(DegeneratePoint { position, kind: kind_of(half_turns) })
    }

    /// The zero of the bilinear number in a quad, by Newton's method; the centre of the quad if it does not converge.
    fn zero_in(&self, quad: Cell) -> Point {
        let at = |dx: usize, dy: usize| {
            let z = self.numbers.at(Cell::new(quad.x + dx, quad.y + dy));
            [z.re, z.im]
        };
        let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
        // p + q u + r v + s u v
        let coefficients = [0, 1].map(|i| (a[i], b[i] - a[i], c[i] - a[i], a[i] - b[i] - c[i] + d[i]));
        let newton = |start: [f64; 2]| {
            let [mut u, mut v] = start;
            for _ in 0..30 {
                let value = coefficients.map(|(p, q, r, s)| p + q * u + r * v + s * u * v);
                let along_u = coefficients.map(|(_, q, _, s)| q + s * v);
                let along_v = coefficients.map(|(_, _, r, s)| r + s * u);
                let determinant = along_u[0] * along_v[1] - along_u[1] * along_v[0];
                u -= (value[0] * along_v[1] - value[1] * along_v[0]) / determinant;
                v -= (along_u[0] * value[1] - along_u[1] * value[0]) / determinant;
            }
            ((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)).then_some([u, v])
        };
        let starts = [[0.5, 0.5], [0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]];
        let [u, v] = starts.into_iter().find_map(newton).unwrap_or([0.5; 2]);
        Point::new(quad.x as f64 + u, quad.y as f64 + v)
    }
}

/// A full turn of the number is half a turn of the axes.
fn half_turns_of(angle: f64) -> i32 {
    (angle / TAU).round() as i32
}

const fn kind_of(half_turns: i32) -> DegenerateKind {
    match half_turns {
        1 => DegenerateKind::Wedge,
        -1 => DegenerateKind::Trisector,
        n => DegenerateKind::Merged(n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use tigereye_core::{SplitMix64, Svd};
    use tigereye_test_support::field;

    fn points(spec: &str) -> Vec<DegeneratePoint> {
        degenerate_points(&field(spec))
    }

    #[test]
    fn known_fields_have_their_points() {
        for (spec, kind) in [
            ("wedge:size=20", DegenerateKind::Wedge),
            ("wedge:size=21", DegenerateKind::Wedge),
            ("trisector:size=20", DegenerateKind::Trisector),
            ("trisector:size=21", DegenerateKind::Trisector),
        ] {
            let found = points(spec);
            assert_eq!(found.len(), 1, "{spec}: {found:?}");
            assert_eq!(found[0].kind, kind, "{spec}");
            let side: f64 = if spec.ends_with("20") { 20.0 } else { 21.0 };
            let middle = 0.5 * (side - 1.0);
            assert!(
                found[0].position.to_array().iter().all(|v| (v - middle).abs() < 1e-9),
                "{spec}: {found:?}"
            );
        }
        // A rotation times a diagonal matrix is not symmetric: both of its numbers have zeros of their own.
        for (spec, half_turns) in [("inverse:size=21", -2), ("star:size=21", 2), ("rings:size=21", 2)] {
            let found = points(spec);
            assert_eq!(
                found.iter().map(DegeneratePoint::half_turns).sum::<i32>(),
                half_turns,
                "{spec}: {found:?}"
            );
            assert!(found.iter().all(|p| (p.position.x - 10.0).abs() < 1.0), "{spec}: {found:?}");
        }
        // The ellipses, which pictures show, have one common point.
        for (spec, half_turns) in [
            ("inverse:size=21", -2),
            ("star:size=21", 2),
            ("rings:size=21", 2),
            ("wedge:size=21", 1),
            ("trisector:size=21", -1),
        ] {
            let ellipses = crate::ellipse_tensors(&field(spec));
            let found = degenerate_points(&ellipses);
            assert_eq!(found.len(), 1, "{spec}: {found:?}");
            assert_eq!(
                (found[0].position, found[0].half_turns()),
                (Point::new(10.0, 10.0), half_turns),
                "{spec}"
            );
        }
        for spec in ["x:size=9", "isotropic:size=9", "step:size=15", "cross_x:size=15", "drain:size=20"] {
            assert_eq!(points(spec), [], "{spec}");
        }
    }

    /// Points between cells are exact if the components are linear.
    #[test]
    fn positions_are_exact_for_linear_components() {
        let field = Field::from_fn(Grid::new(12, 9).expect("a size"), |c| {
            let (x, y) = (c.x as f64 - 6.3, 4.45 - c.y as f64);
            Tensor2::symmetric(50.0 + x + 0.4 * y, y, 50.0 - x - 0.4 * y)
        });
        let found = degenerate_points(&field);
        assert_eq!(found.len(), 1);
        assert!(
            (found[0].position.x - 6.3).abs() < 1e-9 && (found[0].position.y - 4.45).abs() < 1e-9,
            "{found:?}"
        );
    }

    /// The rotation of the axes along the border is the sum of the indices inside, for symmetric tensors and others.
    #[test]
    fn indices_add_up_to_that_of_the_border() {
        let mut numbers = SplitMix64::new(11);
        let mut random = move || numbers.unit() - 0.5;
        let mut with_points = 0;
        for round in 0..40 {
            let symmetric = round % 2 == 0;
            let coarse: Vec<[f64; 4]> = (0..25).map(|_| [random(), random(), random(), random()]).collect();
            // Smooth enough that axes turn by less than 45 degrees from cell to cell along the border.
            let field = Field::from_fn(Grid::new(161, 161).expect("a size"), |c| {
                let (u, v) = (c.x as f64 / 40.0001, c.y as f64 / 40.0001);
                let (i, j) = (u.floor() as usize, v.floor() as usize);
                let (u, v) = (u - i as f64, v - j as f64);
                let mix = |k: usize| {
                    let at = |i: usize, j: usize| coarse[j * 5 + i][k];
                    (1.0 - v) * ((1.0 - u) * at(i, j) + u * at(i + 1, j))
                        + v * ((1.0 - u) * at(i, j + 1) + u * at(i + 1, j + 1))
                };
                let (xy, yx) = (mix(1), mix(2));
                // Symmetric ones are positive: both semi-axes are also equally long along a line of zero trace.
                let more = if symmetric { 2.0 } else { 0.0 };
                Tensor2::new(more + mix(0), xy, if symmetric { xy } else { yx }, more + mix(3))
            });
            let phi = |x: usize, y: usize| Svd::of(field.at(Cell::new(x, y))).phi_rad();
            let mut path: Vec<f64> = (0..160).map(|x| phi(x, 160)).collect();
            path.extend((0..160).map(|y| phi(160, 160 - y)));
            path.extend((0..160).map(|x| phi(160 - x, 0)));
            path.extend((0..160).map(|y| phi(0, y)));
            let turn = |i: usize| {
                let off = path[(i + 1) % path.len()] - path[i];
                off - PI * (off / PI).round()
            };
            let border = ((0..path.len()).map(turn).sum::<f64>() / PI).round() as i32;
            let inside: i32 = degenerate_points(&field).iter().map(DegeneratePoint::half_turns).sum();
            assert_eq!(inside, border, "round {round}");
            with_points += usize::from(!degenerate_points(&field).is_empty());
        }
        assert!(with_points > 30);
    }

    /// The index around a non-finite cell is unknown.
    #[test]
    fn broken_cells_hide_what_is_around_them() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut wedge = field("wedge:size=21");
            let broken = wedge.grid().index(Cell::new(10, 10));
            wedge.values_mut()[broken] = Tensor2::isotropic(bad);
            assert_eq!(degenerate_points(&wedge), []);
            // Elsewhere it does not matter.
            let mut wedge = field("wedge:size=21");
            let broken = wedge.grid().index(Cell::new(3, 15));
            wedge.values_mut()[broken] = Tensor2::isotropic(bad);
            assert_eq!(degenerate_points(&wedge).len(), 1);
        }
    }

    /// The points do not depend on the magnitude of the tensors.
    #[test]
    fn scale_does_not_matter() {
        let plain = field("wedge:size=20");
        let mut strong = plain.map(|t| t.scaled(1e-9));
        strong.values_mut()[0] = Tensor2::symmetric(1e9, 0.0, 1.0);
        assert_eq!(degenerate_points(&strong).len(), degenerate_points(&plain).len());
    }

    #[test]
    fn thin_and_broken_fields_have_no_degenerate_points() {
        for (width, height) in [(1, 1), (1, 9), (9, 1), (2, 2)] {
            for t in [Tensor2::ZERO, Tensor2::isotropic(f64::NAN), Tensor2::from_axes(1.0, 2.0, 1.0)] {
                let field = Field::from_fn(Grid::new(width, height).expect("a size"), |_| t);
                assert_eq!(degenerate_points(&field), []);
            }
        }
    }
}
