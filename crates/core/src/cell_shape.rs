//! The shape of cells that need not be square, and lengths measured with it.

use crate::{PhysicalPoint, Point, Vector, length};

/// Sides that differ by less than this fraction are equal: files store spacings in single precision or as differences
/// of positions.
const SQUARE: f64 = 1e-6;

/// The sides of a cell. Points are counted in cells along x and y; directions, lengths and areas are physical, in units
/// of the smaller side. For square cells the two agree to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellShape {
    /// Along x and y, the smaller one 1.
    sides: [f64; 2],
    /// Cells per unit of length along x and y.
    per_unit: [f64; 2],
}

impl Default for CellShape {
    fn default() -> Self {
        Self::SQUARE
    }
}

impl CellShape {
    /// Cells as high as they are wide.
    pub const SQUARE: Self = Self { sides: [1.0; 2], per_unit: [1.0; 2] };

    /// Shape of cells at distances `spacing` along x and y, in any unit and of either sign; a square where a distance
    /// is zero or not finite.
    #[must_use]
    pub fn of(spacing: [f64; 2]) -> Self {
        let [dx, dy] = spacing.map(f64::abs);
        let smaller = dx.min(dy);
        let sides = [dx / smaller, dy / smaller];
        let is_possible = smaller > 0.0 && sides.iter().all(|s| s.is_finite());
        let differ = sides[0].max(sides[1]) - 1.0 > SQUARE;
        if is_possible && differ { Self { sides, per_unit: sides.map(f64::recip) } } else { Self::SQUARE }
    }

    /// The sides along x and y, the smaller one 1.
    #[must_use]
    pub const fn sides(self) -> [f64; 2] {
        self.sides
    }

    /// Cells per unit of length along x and y.
    #[must_use]
    pub const fn per_unit(self) -> [f64; 2] {
        self.per_unit
    }

    /// The physical position of a point in cells.
    #[must_use]
    pub fn physical(self, p: Point) -> PhysicalPoint {
        PhysicalPoint::new(p.x * self.sides[0], -(p.y * self.sides[1]))
    }

    /// The point in cells of a physical position.
    #[must_use]
    pub fn in_cells(self, p: PhysicalPoint) -> Point {
        Point::new(p.x / self.sides[0], -(p.y / self.sides[1]))
    }

    /// The point at `length` times a direction from another.
    #[must_use]
    pub fn ahead(self, from: Point, direction: Vector, length: f64) -> Point {
        let [across, down] = self.per_unit;
        Point::new(from.x + length * direction.x * across, from.y - length * direction.y * down)
    }

    /// Length of a line through points in cells.
    #[must_use]
    pub fn length(self, points: &[Point]) -> f64 {
        points.windows(2).map(|p| self.distance(p[0], p[1])).sum()
    }

    /// Distance of two points in cells.
    #[must_use]
    pub fn distance(self, a: Point, b: Point) -> f64 {
        length(self.physical(a) - self.physical(b))
    }

    /// The longer side of a grid of `width` x `height` cells, in units of the smaller side of a cell.
    #[must_use]
    pub fn longer_side(self, [width, height]: [usize; 2]) -> f64 {
        let [w, h] = self.sides;
        (width as f64 * w).max(height as f64 * h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smaller_side_is_the_unit() {
        for (spacing, sides) in [
            ([0.5, 0.5], [1.0, 1.0]),
            ([-2.0, 1.0], [2.0, 1.0]),
            ([0.25, 0.75], [1.0, 3.0]),
            ([f64::from(0.1_f32), 0.1], [1.0, 1.0]),
            ([0.0, 1.0], [1.0, 1.0]),
            ([f64::NAN, 1.0], [1.0, 1.0]),
            ([1e-300, 1e300], [1.0, 1.0]),
        ] {
            assert_eq!(CellShape::of(spacing).sides(), sides, "{spacing:?}");
        }
        let cell = CellShape::of([0.2, 0.1]);
        assert_eq!((cell.longer_side([3, 5]), cell.longer_side([2, 5])), (6.0, 5.0));
        assert_eq!(cell.distance(Point::new(1.0, 1.0), Point::new(3.0, 4.0)), 5.0);
        let p = Point::new(3.5, 7.25);
        assert_eq!(cell.physical(p), PhysicalPoint::new(7.0, -7.25));
        assert_eq!(cell.in_cells(cell.physical(p)), p);
        // Rows run downwards, directions upwards.
        assert_eq!(cell.ahead(p, Vector::new(1.0, 0.5), 4.0), Point::new(5.5, 5.25));
    }
}
