//! Cells marked one by one.

use std::sync::Arc;
use tigereye_core::{Cell, Grid};

/// Marked cells of a rectangle, row-major: a bitmap. Copies share the marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: usize,
    marked: Arc<[bool]>,
}

/// Which neighbours lie beside each diagonal one, by direction.
const BESIDE: [(usize, [usize; 2]); 4] = [(1, [0, 2]), (3, [2, 4]), (5, [4, 6]), (7, [6, 0])];

impl Mask {
    /// The cells of `width` columns and `height` rows for which `is_marked` holds.
    #[must_use]
    pub fn from_fn(width: usize, height: usize, mut is_marked: impl FnMut(Cell) -> bool) -> Self {
        let cells = (0..height).flat_map(|y| (0..width).map(move |x| Cell::new(x, y)));
        Self { width, marked: cells.map(&mut is_marked).collect() }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }
    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.marked.len().checked_div(self.width).unwrap_or(0)
    }
    /// Whether a cell is marked; outside none is.
    #[must_use]
    pub fn contains(&self, cell: Cell) -> bool {
        cell.x < self.width && cell.y < self.height() && self.marked[cell.y * self.width + cell.x]
    }

    /// The direction of the surface in a cell of a scene that has the mask's upper left one at `at`, degrees from 0 to
    /// 180: at right angles to the free cells about it, a diagonal one counting where both beside it are free. `None`
    /// where they have no direction: a single cell, or one with no free cell beside it. The wall is what is marked, or
    /// else everything else. Beyond the rim of the scene, where a bitmap cannot go on, lies what lies at the rim.
    pub(crate) fn surface_deg(&self, grid: Grid, at: Cell, cell: Cell, marked: bool) -> Option<f64> {
        let free = |k: usize| {
            let (dx, dy) = tigereye_core::NEIGHBOUR_OFFSETS[k];
            let inside = |c: usize, d: isize, cells: usize| c.saturating_add_signed(d).min(cells - 1);
            let (x, y) = (inside(cell.x, dx, grid.width()), inside(cell.y, dy, grid.height()));
            let is_marked = match (x.checked_sub(at.x), y.checked_sub(at.y)) {
                (Some(x), Some(y)) => self.contains(Cell::new(x, y)),
                _ => false,
            };
            is_marked != marked
        };
        let one = |yes: bool| f64::from(u8::from(yes));
        // Twice the angles of the normals, so that opposite ones agree: 0 and 180 degrees for the sides, 90 and 270 for
        // diagonals.
        let sides = one(free(0)) + one(free(4)) - one(free(2)) - one(free(6));
        let diagonals: f64 = BESIDE
            .iter()
            .map(|&(k, [a, b])| one(free(k) && free(a) && free(b)) * if k % 4 == 1 { 1.0 } else { -1.0 })
            .sum();
        if sides == 0.0 && diagonals == 0.0 {
            return None;
        }
        let normal = 0.5 * tigereye_core::math::degrees(tigereye_core::math::atan2(diagonals, sides));
        Some((normal + 90.0).rem_euclid(180.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(rows: &[&str]) -> Mask {
        Mask::from_fn(rows[0].len(), rows.len(), |c| rows[c.y].as_bytes()[c.x] == b'#')
    }

    /// That of a mask whose scene has its rim far away.
    fn surface(mask: &Mask, x: usize, y: usize) -> Option<f64> {
        mask.surface_deg(Grid::new(20, 20).expect("a grid"), Cell::new(5, 6), Cell::new(5 + x, 6 + y), true)
    }

    #[test]
    fn surfaces_go_on_beyond_the_rim_of_the_scene() {
        let floor = mask(&["....", "....", "####", "####"]);
        let tight = Grid::new(4, 4).expect("a grid");
        for x in 0..4 {
            assert_eq!(floor.surface_deg(tight, Cell::new(0, 0), Cell::new(x, 2), true), Some(0.0), "{x}");
        }
        assert_eq!(surface(&floor, 3, 2), Some(135.0), "ends there");
        let column = mask(&["#...", "#...", "#..."]);
        let tight = Grid::new(4, 3).expect("a grid");
        for y in 0..3 {
            assert_eq!(column.surface_deg(tight, Cell::new(0, 0), Cell::new(0, y), true), Some(90.0), "{y}");
        }
    }

    #[test]
    fn surfaces_follow_the_marks() {
        let thin = mask(&[".....", "####.", "#..#.", "#..#.", "####."]);
        assert_eq!(surface(&thin, 1, 1), Some(0.0));
        assert_eq!(surface(&thin, 0, 3), Some(90.0));
        assert_eq!(surface(&thin, 0, 1), Some(45.0), "upper left corner");
        assert_eq!(surface(&thin, 3, 1), Some(135.0), "upper right corner");
        let solid = mask(&[".....", ".###.", ".###.", ".###."]);
        assert_eq!(surface(&solid, 2, 1), Some(0.0));
        assert_eq!(surface(&solid, 3, 2), Some(90.0));
        assert_eq!(surface(&solid, 1, 1), Some(45.0));
        assert_eq!(surface(&solid, 2, 2), None, "inside there is no direction");
    }

    #[test]
    fn marks_outside_are_not_there() {
        let m = mask(&["##", "##"]);
        assert!(m.contains(Cell::new(1, 1)) && !m.contains(Cell::new(2, 0)) && !m.contains(Cell::new(0, 2)));
        let none = Mask::from_fn(0, 3, |_| true);
        assert!(none.height() == 0 && !none.contains(Cell::new(0, 0)));
    }

    #[test]
    fn single_cells_have_no_direction() {
        let dot = mask(&["...", ".#.", "..."]);
        assert_eq!(surface(&dot, 1, 1), None);
        let bar = mask(&["#..", "#..", "#.."]);
        assert_eq!(surface(&bar, 0, 1), Some(90.0), "at its place");
    }
}
