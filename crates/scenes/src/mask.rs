//! Cells marked one by one.

use std::sync::Arc;
use tigereye_core::Cell;

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

    /// The direction of the surface in a cell of a scene that has the mask's upper left one at `at`, degrees from 0 to 180: at right
    /// angles to the free cells about it, a diagonal one counting where both beside it are free. `None` where they have no
    /// direction: a single cell, or one with no free cell beside it. The wall is what is marked, or else everything else.
    pub(crate) fn surface_deg(&self, at: Cell, cell: Cell, marked: bool) -> Option<f64> {
        let free = |k: usize| {
            let (dx, dy) = tigereye_core::NEIGHBOUR_OFFSETS[k];
            let within = |c: usize, d: isize, first: usize| c.checked_add_signed(d)?.checked_sub(first);
            let is_marked = match (within(cell.x, dx, at.x), within(cell.y, dy, at.y)) {
                (Some(x), Some(y)) => self.contains(Cell::new(x, y)),
                _ => false,
            };
            is_marked != marked
        };
        let one = |yes: bool| f64::from(u8::from(yes));
        // Twice the angles of the normals, so that opposite ones agree: 0 and 180 degrees for the sides, 90 and 270 for diagonals.
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

    #[test]
    fn surfaces_follow_the_marks() {
        let thin = mask(&[".....", "####.", "#..#.", "#..#.", "####."]);
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(1, 1), true), Some(0.0));
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(0, 3), true), Some(90.0));
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(0, 1), true), Some(45.0), "upper left corner");
        assert_eq!(
            thin.surface_deg(Cell::new(0, 0), Cell::new(3, 1), true),
            Some(135.0),
            "upper right corner"
        );
        let solid = mask(&[".....", ".###.", ".###.", ".###."]);
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(2, 1), true), Some(0.0));
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(3, 2), true), Some(90.0));
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(1, 1), true), Some(45.0));
        assert_eq!(
            solid.surface_deg(Cell::new(0, 0), Cell::new(2, 2), true),
            None,
            "inside there is no direction"
        );
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
        assert_eq!(dot.surface_deg(Cell::new(0, 0), Cell::new(1, 1), true), None);
        let bar = mask(&["#..", "#..", "#.."]);
        assert_eq!(bar.surface_deg(Cell::new(4, 2), Cell::new(4, 3), true), Some(90.0), "at its place");
    }
}
