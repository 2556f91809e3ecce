//! Distance to the borders of shapes, and the direction of the border there.

use tigereye_core::math;

/// Lengths below this are rounding, cells.
pub(crate) const ROUNDING: f64 = 1e-9;

/// The nearest places of a border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// How far they are, cells.
    pub(crate) distance: f64,
    /// Sum of the directions across the border there, all to the same side, y downwards; `[0, 0]` where they cancel.
    pub(crate) across: [f64; 2],
    /// Sum of the same directions at twice their angle, in which opposite ones agree: that of thin walls.
    pub(crate) doubled: [f64; 2],
}

impl Nearest {
    const NONE: Self = Self { distance: f64::INFINITY, across: [0.0; 2], doubled: [0.0; 2] };

    /// With one more direction across.
    fn add(&mut self, [x, y]: [f64; 2]) {
        self.across = [self.across[0] + x, self.across[1] + y];
        self.doubled = [self.doubled[0] + x * x - y * y, self.doubled[1] + 2.0 * x * y];
    }

    /// With one direction across.
    pub(crate) fn towards(distance: f64, across: [f64; 2]) -> Self {
        let mut nearest = Self { distance, ..Self::NONE };
        nearest.add(across);
        nearest
    }

    /// Direction along the border, degrees from 0 to 180; `None` where normals of all directions cancel, as in the
    /// middle of a disc.
    pub(crate) fn along_deg(self) -> Option<f64> {
        let (mut across, [c, s]) = (self.across, self.doubled);
        if math::hypot(across[0], across[1]) < ROUNDING {
            // Both sides of a thin wall are equally far, and their normals cancel.
            if math::hypot(c, s) < ROUNDING {
                return None;
            }
            let angle = 0.5 * math::atan2(s, c);
            across = [math::cos(angle), math::sin(angle)];
        }
        let [x, y] = across;
        // Across is (x, -y) with y upwards; a quarter turn from it is (y, x).
        let deg = math::degrees(math::atan2(x, y)).rem_euclid(180.0);
        // Corners of whole cells give 45 degrees but for rounding.
        let whole = math::round_ties_even(deg);
        Some(if (deg - whole).abs() < ROUNDING { whole % 180.0 } else { deg })
    }
}

/// Of a circle.
pub(crate) fn to_circle(p: [f64; 2], centre: [f64; 2], radius: f64) -> Nearest {
    let from = [p[0] - centre[0], p[1] - centre[1]];
    let r = math::hypot(from[0], from[1]);
    let across = if r > 0.0 { [from[0] / r, from[1] / r] } else { [0.0; 2] };
    Nearest::towards((r - radius).abs(), across)
}

/// Of a line between two points.
pub(crate) fn to_segment(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let q = foot(p, [a, b]);
    math::hypot(p[0] - q[0], p[1] - q[1])
}

/// The point of a line that is nearest to `p`.
fn foot(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let d = [b[0] - a[0], b[1] - a[1]];
    let squared = d[0] * d[0] + d[1] * d[1];
    let along = (p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1];
    let t = if squared > 0.0 { (along / squared).clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + t * d[0], a[1] + t * d[1]]
}

/// Of a closed polygon.
///
/// Beside a side that is the side's normal, off a corner the direction from the corner, and on a corner, or where two
/// sides are equally far, their mean.
pub(crate) fn to_polygon(p: [f64; 2], corners: &[[f64; 2]]) -> Nearest {
    let mut nearest = Nearest::NONE;
    let mut feet: Option<([f64; 2], [f64; 2])> = None;
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let q = foot(p, [a, b]);
        let away = [p[0] - q[0], p[1] - q[1]];
        let distance = math::hypot(away[0], away[1]);
        if distance > nearest.distance + ROUNDING {
            continue;
        }
        if distance < nearest.distance - ROUNDING {
            nearest = Nearest { distance, ..Nearest::NONE };
            feet = None;
        }
        let across = if distance > ROUNDING {
            // Two sides that share a corner would count it twice: one side and the next, or the last and the first.
            let is_foot = |f: [f64; 2]| math::hypot(f[0] - q[0], f[1] - q[1]) < ROUNDING;
            if feet.is_some_and(|(first, last)| is_foot(first) || is_foot(last)) {
                continue;
            }
            feet = Some((feet.map_or(q, |(first, _)| first), q));
            [away[0] / distance, away[1] / distance]
        } else {
            normal(a, b)
        };
        nearest.add(across);
    }
    nearest
}

/// Unit normal of a side, to the left of its way for all sides of a polygon.
fn normal(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let d = [b[0] - a[0], b[1] - a[1]];
    let length = math::hypot(d[0], d[1]);
    if length == 0.0 { [0.0; 2] } else { [d[1] / length, -d[0] / length] }
}

/// Whether a point lies in a polygon, by the even-odd rule; its border belongs to it.
pub(crate) fn inside_polygon(p: [f64; 2], corners: &[[f64; 2]]) -> bool {
    let mut inside = false;
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if to_segment(p, [a, b]) <= ROUNDING {
            return true;
        }
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            inside ^= p[0] < x;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[2.0, 2.0], [8.0, 2.0], [8.0, 8.0], [2.0, 8.0]];

    #[test]
    fn sides_and_corners_of_a_square_have_their_directions() {
        let mut reversed = SQUARE;
        reversed.reverse();
        for corners in [SQUARE, reversed] {
            let along = |x, y| to_polygon([x, y], &corners).along_deg();
            assert_eq!((along(5.0, 2.0), along(8.0, 4.0)), (Some(0.0), Some(90.0)));
            assert_eq!((along(2.0, 2.0), along(8.0, 2.0)), (Some(45.0), Some(135.0)), "on the corner");
            assert_eq!(along(1.0, 1.0), Some(45.0), "off the corner, outside");
            assert_eq!(along(3.0, 3.0), Some(45.0), "off the corner, inside");
            assert_eq!(along(1.0, 2.0), Some(90.0), "beside the left side");
            assert_eq!(along(5.0, 5.0), None, "in the middle");
        }
    }

    /// The sides of a turned square are equally far from its middle up to rounding, and all four count.
    #[test]
    fn distances_that_differ_by_rounding_are_equal() {
        let turned = |deg: f64| {
            let (c, s) = (math::cos(math::radians(deg)), math::sin(math::radians(deg)));
            SQUARE.map(|[x, y]| [x - 5.0, y - 5.0]).map(|[x, y]| [5.0 + c * x - s * y, 5.0 + s * x + c * y])
        };
        for deg in 0..90 {
            assert_eq!(to_polygon([5.0, 5.0], &turned(f64::from(deg))).along_deg(), None, "{deg}");
        }
    }

    #[test]
    fn a_corner_counts_once_although_two_sides_meet_there() {
        // A hook with a short and a long arm, and a point as far from the corner of the short one as from the long one.
        let hook =
            [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [5.0, 6.0], [5.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let (corner, p) = ([1.0, 3.0], [2.71875, 4.5]);
        let distance = 5.0 - p[0];
        let found = to_polygon(p, &hook);
        assert!((found.distance - distance).abs() < 1e-12);
        let mean = [(p[0] - corner[0]) / distance - 1.0, (p[1] - corner[1]) / distance];
        assert!((0..2).all(|i| (found.across[i] - mean[i]).abs() < 1e-12), "{found:?}, {mean:?}");
    }

    #[test]
    fn borders_belong_to_polygons() {
        assert!(inside_polygon([5.0, 5.0], &SQUARE) && inside_polygon([2.0, 5.0], &SQUARE));
        assert!(inside_polygon([8.0, 8.0], &SQUARE) && !inside_polygon([8.1, 5.0], &SQUARE));
        let bow = [[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]];
        assert!(inside_polygon([3.5, 2.0], &bow) && !inside_polygon([2.0, 3.5], &bow));
    }

    #[test]
    fn circles_are_crossed_along_their_radius() {
        let n = to_circle([3.0, 4.0], [0.0, 0.0], 7.0);
        assert!((n.distance - 2.0).abs() < 1e-15);
        // The radius points down to the right at -53.13 degrees.
        let along = n.along_deg().expect("a direction");
        assert!((along - (90.0 - 53.130_102_354_155_98)).abs() < 1e-12);
        assert_eq!(to_circle([0.0; 2], [0.0; 2], 7.0).along_deg(), None);
    }
}
