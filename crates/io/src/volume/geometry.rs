//! Where the cells of a plane lie in the world of their file.

use super::choice::{Axis, Crop};
use super::meaning::World;
use tigereye_core::math::hypot;

/// Difference of a direction from a world axis that counts as rounding: files hold directions in single precision.
const ROUNDING: f64 = 1e-6;
/// The first two axes of a world.
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];

/// Where the cells of a plane lie: in the world of the file, or, where the input has none, in a flat frame of their
/// own, x to the right and y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneGeometry {
    corner: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    spacing: [f64; 2],
    is_placed: bool,
}

impl PlaneGeometry {
    /// Cells of distance 1, the lower left one at 0: what has no geometry of its own.
    pub const UNPLACED: Self =
        Self { corner: [0.0; 3], right: X, up: Y, spacing: [1.0; 2], is_placed: false };

    /// From the position of the centre of the lower left cell, unit vectors to the right and up, and the distances of
    /// the cells along them. Without a place in the world where one of these is no finite number, or a distance not
    /// positive.
    #[must_use]
    pub fn new(corner: [f64; 3], right: [f64; 3], up: [f64; 3], spacing: [f64; 2]) -> Self {
        let numbers = [&corner[..], &right, &up, &spacing].concat();
        let is_placed = numbers.iter().all(|v| v.is_finite()) && spacing.iter().all(|s| *s > 0.0);
        // The negative of 0 is 0 again, so that files do not tell which way an axis ran.
        let clean = |v: [f64; 3]| v.map(|v| v + 0.0);
        let geometry =
            Self { corner: clean(corner), right: clean(right), up: clean(up), spacing, is_placed: true };
        if is_placed { geometry } else { geometry.flat() }
    }

    /// The same cells in a flat frame of their own: the position keeps its coordinates along right and up.
    #[must_use]
    pub fn flat(&self) -> Self {
        let along = |v: [f64; 3]| dot(self.corner, v) + 0.0;
        let corner = [along(self.right), along(self.up), 0.0];
        Self { corner, right: X, up: Y, spacing: self.spacing, is_placed: false }
    }

    /// How a plane of tensors along right and up is written: in the world where these are its x and y (up to rounding),
    /// else in a flat frame of its own.
    #[must_use]
    pub fn upright(&self) -> Self {
        let near = |v: [f64; 3], axis: [f64; 3]| (0..3).all(|i| (v[i] - axis[i]).abs() <= ROUNDING);
        if near(self.right, X) && near(self.up, Y) { Self { right: X, up: Y, ..*self } } else { self.flat() }
    }

    /// Whether right or up is along no axis of the world, up to rounding.
    #[must_use]
    pub fn is_oblique(&self) -> bool {
        let along_an_axis = |v: [f64; 3]| v.iter().any(|c| c.abs() >= 1.0 - ROUNDING);
        !(along_an_axis(self.right) && along_an_axis(self.up))
    }

    /// Position of the centre of the lower left cell, in the file's unit.
    #[must_use]
    pub const fn corner(&self) -> [f64; 3] {
        self.corner
    }

    /// The unit vector to the right.
    #[must_use]
    pub const fn right(&self) -> [f64; 3] {
        self.right
    }

    /// The unit vector up.
    #[must_use]
    pub const fn up(&self) -> [f64; 3] {
        self.up
    }

    /// Distances of the cells along right and up, in the file's unit.
    #[must_use]
    pub const fn spacing(&self) -> [f64; 2] {
        self.spacing
    }

    /// Whether the input says where it lies. Arrays, pictures, generators and formulas do not.
    #[must_use]
    pub const fn is_placed(&self) -> bool {
        self.is_placed
    }

    /// The unit vector towards the viewer: right x up.
    #[must_use]
    pub fn normal(&self) -> [f64; 3] {
        let ([a, b, c], [d, e, f]) = (self.right, self.up);
        let n = [b * f - c * e, c * d - a * f, a * e - b * d];
        let length = hypot(hypot(n[0], n[1]), n[2]);
        // Axes along each other have none.
        if length > 0.0 { n.map(|v| v / length + 0.0) } else { [0.0, 0.0, 1.0] }
    }

    /// Right, up and the normal as columns, row by row; `None` where they are the axes of the world.
    #[must_use]
    pub fn direction(&self) -> Option<[f64; 9]> {
        let columns = [self.right, self.up, self.normal()];
        let direction = std::array::from_fn(|i| columns[i % 3][i / 3]);
        (direction != super::matrix3::IDENTITY).then_some(direction)
    }

    /// Position of a point in cells: columns from the leftmost, rows **upwards** from the lowest.
    #[must_use]
    pub fn place(&self, [column, row]: [f64; 2]) -> [f64; 3] {
        let step = self.along([column * self.spacing[0], row * self.spacing[1]]);
        [0, 1, 2].map(|i| self.corner[i] + step[i])
    }

    /// A vector of the plane, along right and up, along the axes of the world.
    #[must_use]
    pub fn along(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|i| x * self.right[i] + y * self.up[i])
    }

    fn with_corner_at(self, cell: [f64; 2]) -> Self {
        Self { corner: self.place(cell), ..self }
    }

    /// The same corner with other distances of the cells.
    #[must_use]
    pub const fn with_spacing(self, spacing: [f64; 2]) -> Self {
        Self { spacing, ..self }
    }

    /// A part of `height` rows.
    #[must_use]
    pub fn cropped(self, crop: Crop, height: usize) -> Self {
        self.with_corner_at([crop.x[0] as f64, height.saturating_sub(crop.y[1]) as f64])
    }

    /// Other numbers of cells for the same picture: cells are rectangles around their points, and the outermost keep
    /// their outer sides.
    #[must_use]
    pub fn resampled(self, before: [usize; 2], after: [usize; 2]) -> Self {
        let ratio = [0, 1].map(|i| before[i] as f64 / after[i] as f64);
        let moved = self.with_corner_at(ratio.map(|r| 0.5 * (r - 1.0)));
        Self { spacing: [0, 1].map(|i| self.spacing[i] * ratio[i]), ..moved }
    }

    /// Every `stride`-th column from the left and row from the top, of `height` rows.
    #[must_use]
    pub fn strided(self, stride: usize, height: usize) -> Self {
        let left_below = height.saturating_sub(1) % stride.max(1);
        let moved = self.with_corner_at([0.0, left_below as f64]);
        Self { spacing: self.spacing.map(|s| s * stride as f64), ..moved }
    }
}

impl World {
    /// What a direction mainly along a world axis is, in words.
    pub(super) fn words(&self, axis: usize, direction: [f64; 3]) -> String {
        const ENDS: [[&str; 2]; 3] = [["left", "right"], ["posterior", "anterior"], ["inferior", "superior"]];
        let mainly = if direction[axis] < 1.0 - ROUNDING { "mainly " } else { "" };
        let name = Axis::ALL[axis].name();
        let patient = self.signs().map_or_else(String::new, |signs| {
            format!(", the patient's {}", ENDS[axis][usize::from(signs[axis] > 0.0)])
        });
        format!("{mainly}the world's +{name}{patient}")
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The world axis of each of three directions (any length): the assignment that makes the sum of the absolute cosines
/// largest. Among those that differ by rounding only, the one that keeps the order of the file; a direction without
/// length takes the axis that is left.
pub(crate) fn world_axes(axes: &[[f64; 3]; 3]) -> [usize; 3] {
    /// Difference of two sums of cosines that counts as rounding.
    const TIE: f64 = 1e-6;
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let cosines = axes.map(|axis| {
        let length = hypot(hypot(axis[0], axis[1]), axis[2]);
        if length > 0.0 && length.is_finite() { axis.map(|v| (v / length).abs()) } else { [0.0; 3] }
    });
    let sum = |order: &[usize; 3]| (0..3).map(|a| cosines[a][order[a]]).sum::<f64>();
    let best = ORDERS.iter().map(sum).fold(0.0, f64::max);
    // The identity where nothing is a number.
    ORDERS.into_iter().find(|order| sum(order) >= best - TIE).unwrap_or(ORDERS[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of positions of a few units.
    const POSITION: f64 = 1e-12;

    #[test]
    fn axes_go_to_the_world_axes_they_are_nearest_to_together() {
        assert_eq!(world_axes(&[[0.0, 0.0, -2.0], [1.0, 0.1, 0.0], [0.1, -1.0, 0.0]]), [2, 0, 1]);
        // Half-way between two axes, and off by rounding, the order is the file's.
        for off in [-1e-9, 0.0, 1e-9] {
            assert_eq!(world_axes(&[[1.0, 1.0 + off, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), [0, 1, 2]);
            assert_eq!(world_axes(&[[0.0, 0.0, 1.0], [1.0, 1.0 + off, 0.0], [-1.0, 1.0, 0.0]]), [2, 0, 1]);
        }
        assert_eq!(world_axes(&[[0.0, 3.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0]]), [1, 0, 2]);
        assert_eq!(world_axes(&[[f64::NAN; 3]; 3]), [0, 1, 2]);
    }

    #[test]
    fn parts_and_other_sizes_keep_the_place_of_what_they_show() {
        let plane = PlaneGeometry::new([1.0, 2.0, 3.0], [0.0, 0.6, 0.8], [-1.0, 0.0, 0.0], [2.0, 0.5]);
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < POSITION);
        let part = plane.cropped(Crop { x: [2, 4], y: [1, 3] }, 5);
        assert!(near(part.place([0.0, 0.0]), plane.place([2.0, 2.0])));
        let finer = plane.resampled([4, 5], [8, 10]);
        // The lower left and the upper right corner of the outermost cells.
        assert!(near(finer.place([-0.5, -0.5]), plane.place([-0.5, -0.5])));
        assert!(near(finer.place([7.5, 9.5]), plane.place([3.5, 4.5])));
        // Rows 0, 2 and 4 of 6 from the top: the lowest is the second.
        let every_other = plane.strided(2, 6);
        assert!(near(every_other.place([1.0, 0.0]), plane.place([2.0, 1.0])));
        assert!(near(every_other.place([0.0, 2.0]), plane.place([0.0, 5.0])));
    }

    #[test]
    fn frames_of_planes_are_right_handed() {
        let xz = PlaneGeometry::new([1.0, 2.0, 3.0], X, [0.0, 0.0, 1.0], [1.0; 2]);
        assert_eq!(xz.normal(), [0.0, -1.0, 0.0]);
        assert_eq!(xz.direction(), Some([1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0]));
        assert_eq!((xz.upright().corner(), xz.upright().direction()), ([1.0, 3.0, 0.0], None));
        let xy = PlaneGeometry::new([1.0, 2.0, 3.0], [1.0, 1e-9, 0.0], [-1e-9, 1.0, 0.0], [1.0; 2]);
        assert_eq!((xy.upright().corner(), xy.upright().direction()), ([1.0, 2.0, 3.0], None));
    }

    #[test]
    fn what_is_no_number_is_no_place() {
        let at = |corner, spacing| PlaneGeometry::new(corner, X, Y, spacing).is_placed();
        assert!(at([1.0; 3], [1.0; 2]) && !at([f64::NAN; 3], [1.0; 2]) && !at([1.0; 3], [0.0, 1.0]));
        assert!(!PlaneGeometry::UNPLACED.is_placed());
    }
}
