//! Shapes and the cells they cover.

use crate::border::{self, Nearest, ROUNDING};
use crate::{Fault, Mask};
use tigereye_core::{Cell, Grid};

/// A region of the plane. A cell belongs to it where the cell's centre does, the border included.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An upright rectangle between two opposite corners.
    Rectangle {
        /// One corner.
        from: [f64; 2],
        /// The opposite one.
        to: [f64; 2],
    },
    /// A disc.
    Disc {
        /// Its middle.
        centre: [f64; 2],
        /// Its radius, cells.
        radius: f64,
    },
    /// All points within half a thickness of a line.
    ///
    /// With a thickness of 1 upright and level walls are closed. Light passes diagonally between two cells that touch
    /// at a corner; a slanted wall is closed from a thickness of the square root of 2 on ([`crate::leaks`] finds the
    /// gaps).
    Segment {
        /// One end.
        from: [f64; 2],
        /// The other one.
        to: [f64; 2],
        /// Thickness, cells.
        thickness: f64,
    },
    /// A closed polygon; where its sides cross, by the even-odd rule.
    Polygon(Vec<[f64; 2]>),
    /// Marked cells.
    Bitmap {
        /// Cell of the mask's upper left corner.
        at: Cell,
        /// The marks.
        mask: Mask,
    },
    /// All points within half a thickness of the border of a rectangle, disc or polygon.
    Outline {
        /// The shape.
        of: Box<Shape>,
        /// Thickness, cells.
        thickness: f64,
    },
    /// Everything outside of a shape.
    Outside(Box<Shape>),
}

/// Coordinates beyond this are mistakes, and products of them would lose digits.
const LARGEST: f64 = 1e6;

impl Shape {
    /// Checks the numbers.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        let point = |p: &[f64; 2]| match p.iter().find(|v| !(-LARGEST..=LARGEST).contains(*v)) {
            Some(&value) => Err(Fault::Coordinate { value }),
            None => Ok(()),
        };
        let positive = |what, value: f64| match value {
            v if v > 0.0 && v <= LARGEST => Ok(()),
            _ => Err(Fault::Extent { what, value }),
        };
        match self {
            Self::Rectangle { from, to } => point(from).and(point(to)),
            Self::Disc { centre, radius } => point(centre).and(positive("radius", *radius)),
            Self::Segment { from, to, .. } if from == to => Err(Fault::NoLength),
            Self::Segment { from, to, thickness } => {
                point(from).and(point(to)).and(positive("thickness", *thickness))
            }
            Self::Polygon(corners) if corners.len() < 3 => Err(Fault::Corners { corners: corners.len() }),
            Self::Polygon(corners) => corners.iter().try_for_each(point),
            Self::Bitmap { .. } => Ok(()),
            Self::Outline { of, thickness } => {
                positive("thickness", *thickness)?;
                match &**of {
                    Self::Bitmap { .. } => Err(Fault::Outline { what: "bitmap" }),
                    Self::Segment { .. } => Err(Fault::Outline { what: "segment" }),
                    Self::Outline { .. } => Err(Fault::Outline { what: "outline" }),
                    Self::Outside(_) => Err(Fault::Outline { what: "region outside of a shape" }),
                    shape => shape.check(),
                }
            }
            Self::Outside(of) => of.check(),
        }
    }

    /// Whether a cell belongs to the shape.
    #[must_use]
    pub fn contains(&self, cell: Cell) -> bool {
        let p = [cell.x as f64, cell.y as f64];
        match self {
            Self::Rectangle { from, to } => (0..2)
                .all(|i| (from[i].min(to[i]) - ROUNDING..=from[i].max(to[i]) + ROUNDING).contains(&p[i])),
            Self::Polygon(corners) => border::inside_polygon(p, corners),
            Self::Disc { centre, radius } => {
                tigereye_core::math::hypot(p[0] - centre[0], p[1] - centre[1]) <= radius + ROUNDING
            }
            Self::Segment { from, to, thickness } => {
                border::to_segment(p, [*from, *to]) <= 0.5 * thickness + ROUNDING
            }
            Self::Bitmap { at, mask } => match (cell.x.checked_sub(at.x), cell.y.checked_sub(at.y)) {
                (Some(x), Some(y)) => mask.contains(Cell::new(x, y)),
                _ => false,
            },
            Self::Outline { of, thickness } => {
                of.border(p).is_some_and(|b| b.distance <= 0.5 * thickness + ROUNDING)
            }
            Self::Outside(of) => !of.contains(cell),
        }
    }

    /// The direction of the shape's surface nearest to a cell, degrees from 0 to 180; `None` where it has none: a
    /// single cell, the middle of a disc or a square. `grid` is the scene's: bitmaps go on beyond its rim.
    #[must_use]
    pub fn surface_deg(&self, grid: Grid, cell: Cell) -> Option<f64> {
        match self {
            Self::Segment { from, to, .. } => {
                let across = [from[1] - to[1], to[0] - from[0]];
                Nearest::towards(0.0, across).along_deg()
            }
            Self::Bitmap { at, mask } => mask.surface_deg(grid, *at, cell, true),
            Self::Outline { of, .. } => of.surface_deg(grid, cell),
            Self::Outside(of) => match &**of {
                Self::Bitmap { at, mask } => mask.surface_deg(grid, *at, cell, false),
                of => of.surface_deg(grid, cell),
            },
            shape => shape.border([cell.x as f64, cell.y as f64]).and_then(Nearest::along_deg),
        }
    }

    fn border(&self, p: [f64; 2]) -> Option<Nearest> {
        match self {
            Self::Rectangle { .. } | Self::Polygon(_) => Some(border::to_polygon(p, &self.corners())),
            Self::Disc { centre, radius } => Some(border::to_circle(p, *centre, *radius)),
            _ => None,
        }
    }

    fn corners(&self) -> std::borrow::Cow<'_, [[f64; 2]]> {
        match self {
            Self::Rectangle { from: [x0, y0], to: [x1, y1] } => {
                vec![[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]].into()
            }
            Self::Polygon(corners) => corners.into(),
            _ => (&[][..]).into(),
        }
    }

    /// Tests that one cell takes, about.
    pub(crate) fn detail(&self) -> usize {
        match self {
            Self::Polygon(corners) => corners.len(),
            Self::Rectangle { .. } => 4,
            Self::Outline { of, .. } | Self::Outside(of) => of.detail(),
            _ => 1,
        }
    }

    /// The cells of a grid that may belong to the shape: columns and rows, the last included; `None` for none.
    pub(crate) fn window(&self, grid: Grid) -> Option<[[usize; 2]; 2]> {
        let (low, high) = match self {
            Self::Outside(_) => ([f64::MIN; 2], [f64::MAX; 2]),
            Self::Rectangle { .. } | Self::Polygon(_) => bounds(&self.corners(), 0.0),
            Self::Disc { centre, radius } => bounds(&[*centre], *radius),
            Self::Segment { from, to, thickness } => bounds(&[*from, *to], 0.5 * thickness),
            Self::Bitmap { at, mask } => {
                let first = [at.x as f64, at.y as f64];
                (first, [first[0] + mask.width() as f64 - 1.0, first[1] + mask.height() as f64 - 1.0])
            }
            Self::Outline { of, thickness } => match &**of {
                Self::Disc { centre, radius } => bounds(&[*centre], radius + 0.5 * thickness),
                shape => bounds(&shape.corners(), 0.5 * thickness),
            },
        };
        let side = |i: usize, cells: usize| {
            let first = (low[i] - ROUNDING).ceil().max(0.0);
            let last = (high[i] + ROUNDING).floor().min(cells as f64 - 1.0);
            (first <= last).then_some([first as usize, last as usize])
        };
        Some([side(0, grid.width())?, side(1, grid.height())?])
    }
}

fn bounds(points: &[[f64; 2]], margin: f64) -> ([f64; 2], [f64; 2]) {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in points {
        for i in 0..2 {
            low[i] = low[i].min(p[i] - margin);
            high[i] = high[i].max(p[i] + margin);
        }
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(shape: &Shape, w: usize, h: usize) -> Vec<(usize, usize)> {
        let grid = Grid::new(w, h).expect("a grid");
        let by_window: Vec<_> = match shape.window(grid) {
            None => Vec::new(),
            Some([xs, ys]) => (ys[0]..=ys[1])
                .flat_map(|y| (xs[0]..=xs[1]).map(move |x| Cell::new(x, y)))
                .filter(|c| shape.contains(*c))
                .collect(),
        };
        let all: Vec<_> = grid.iter().filter(|c| shape.contains(*c)).collect();
        assert_eq!(by_window, all, "a window leaves no cell out");
        all.iter().map(|c| (c.x, c.y)).collect()
    }

    fn grid() -> Grid {
        Grid::new(20, 20).expect("a grid")
    }

    #[test]
    fn shapes_cover_the_cells_whose_centres_they_hold() {
        let r = Shape::Rectangle { from: [3.4, 1.0], to: [1.0, 2.6] };
        assert_eq!(covered(&r, 6, 6), [(1, 1), (2, 1), (3, 1), (1, 2), (2, 2), (3, 2)]);
        let d = Shape::Disc { centre: [2.0, 2.0], radius: 1.0 };
        assert_eq!(covered(&d, 6, 6), [(2, 1), (1, 2), (2, 2), (3, 2), (2, 3)]);
        let s = Shape::Segment { from: [1.0, 3.0], to: [4.0, 3.0], thickness: 1.0 };
        assert_eq!(covered(&s, 6, 6), [(1, 3), (2, 3), (3, 3), (4, 3)]);
        let p = Shape::Polygon(vec![[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]);
        assert_eq!(covered(&p, 6, 6), [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (0, 2)]);
        let o = Shape::Outline {
            of: Box::new(Shape::Rectangle { from: [1.0, 1.0], to: [3.0, 3.0] }),
            thickness: 1.0,
        };
        assert_eq!(covered(&o, 6, 6), [(1, 1), (2, 1), (3, 1), (1, 2), (3, 2), (1, 3), (2, 3), (3, 3)]);
        // 1.0000000000000002: more than one by rounding alone.
        let rounded = Shape::Rectangle { from: [1.1 + 0.1 - 0.2, 1.0], to: [3.0 - 1e-12, 1.0] };
        assert_eq!(covered(&rounded, 6, 6), [(1, 1), (2, 1), (3, 1)]);
        let m = Shape::Bitmap { at: Cell::new(4, 5), mask: Mask::from_fn(2, 2, |c| c != Cell::new(1, 0)) };
        assert_eq!(covered(&m, 6, 6), [(4, 5)]);
        let out = Shape::Outside(Box::new(Shape::Rectangle { from: [0.0, 0.0], to: [5.0, 4.0] }));
        assert_eq!(covered(&out, 6, 6).len(), 6);
        assert_eq!(covered(&Shape::Disc { centre: [-9.0, 2.0], radius: 3.0 }, 6, 6), []);
    }

    #[test]
    fn surfaces_lie_along_the_shape() {
        let s = Shape::Segment { from: [0.0, 4.0], to: [4.0, 0.0], thickness: 1.5 };
        assert_eq!(s.surface_deg(grid(), Cell::new(2, 2)), Some(45.0), "up to the right");
        let d = Shape::Disc { centre: [5.0, 5.0], radius: 3.0 };
        assert_eq!(d.surface_deg(grid(), Cell::new(5, 2)), Some(0.0));
        assert_eq!(d.surface_deg(grid(), Cell::new(3, 3)), Some(45.0));
        assert_eq!(d.surface_deg(grid(), Cell::new(5, 5)), None, "no direction in the middle");
    }

    #[test]
    fn the_outside_of_a_bitmap_has_the_surface_of_its_complement() {
        let room = Shape::Bitmap { at: Cell::new(2, 1), mask: Mask::from_fn(3, 4, |_| true) };
        let walls = Shape::Outside(Box::new(room));
        let surface =
            |x, y| walls.contains(Cell::new(x, y)).then(|| walls.surface_deg(grid(), Cell::new(x, y)));
        assert_eq!((surface(3, 2), surface(5, 3), surface(1, 2)), (None, Some(Some(90.0)), Some(Some(90.0))));
        assert_eq!((surface(3, 0), surface(3, 5)), (Some(Some(0.0)), Some(Some(0.0))));
    }

    #[test]
    fn faulty_shapes_are_refused() {
        let disc = |radius| Shape::Disc { centre: [0.0; 2], radius };
        assert_eq!(disc(-1.0).check(), Err(Fault::Extent { what: "radius", value: -1.0 }));
        assert!(disc(f64::NAN).check().is_err() && disc(f64::INFINITY).check().is_err());
        let r = Shape::Rectangle { from: [f64::NAN, 0.0], to: [1.0, 1.0] };
        assert!(matches!(r.check(), Err(Fault::Coordinate { .. })));
        assert_eq!(Shape::Polygon(vec![[0.0; 2]; 2]).check(), Err(Fault::Corners { corners: 2 }));
        let point = Shape::Segment { from: [1.0; 2], to: [1.0; 2], thickness: 1.0 };
        assert_eq!(point.check(), Err(Fault::NoLength));
        let twice = Shape::Outline {
            of: Box::new(Shape::Outline { of: Box::new(disc(2.0)), thickness: 1.0 }),
            thickness: 1.0,
        };
        assert_eq!(twice.check(), Err(Fault::Outline { what: "outline" }));
    }
}
