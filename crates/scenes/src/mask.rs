//! Cells marked one by one.

use tigereye_core::Cell;

/// Marked cells of a rectangle, row-major: a bitmap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: usize,
    marked: Vec<bool>,
}

/// Which neighbours lie beside each diagonal one, by direction.
const BESIDE: [(usize, [usize; 2]); 4] = [(1, [0, 2]), (3, [2, 4]), (5, [4, 6]), (7, [6, 0])];

impl Mask {
    /// Marks in rows of `width`; a last row that is not full is left out.
    #[must_use]
    pub fn new(width: usize, mut marked: Vec<bool>) -> Self {
        let rows = marked.len().checked_div(width).unwrap_or(0);
        marked.truncate(rows * width);
        Self { width, marked }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }
    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        match self.marked.len().checked_div(self.width) {
            Some(rows) => rows,
            None => 0,
        }
    }
    /// Whether a cell is marked; outside none is.
    #[must_use]
    pub fn contains(&self, cell: Cell) -> bool {
        cell.x < self.width && cell.y < self.height() && self.marked[cell.y * self.width + cell.x]
    }

    /// The direction of the surface in a cell of a scene that has the mask's upper left one at `at`, degrees from 0 to 180: at right
    /// angles to the free cells about it, a diagonal one counting where both beside it are free. 0 where they have no direction. The
    /// wall is what is marked, or else everything else.
    pub(crate) fn surface_deg(&self, at: Cell, cell: Cell, marked: bool) -> f64 {
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
            return 0.0;
        }
        let normal = 0.5 * tigereye_core::math::degrees(tigereye_core::math::atan2(diagonals, sides));
        (normal + 90.0).rem_euclid(180.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mask(rows: &[&str]) -> Mask {
        let width = rows[0].len();
        Mask::new(width, rows.iter().flat_map(|r| r.bytes().map(|b| b == b'#')).collect())
    }

    #[test]
    fn surfaces_follow_the_marks() {
        let thin = mask(&[".....", "####.", "#..#.", "#..#.", "####."]);
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(1, 1), true), 0.0);
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(0, 3), true), 90.0);
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(0, 1), true), 45.0, "upper left corner");
        assert_eq!(thin.surface_deg(Cell::new(0, 0), Cell::new(3, 1), true), 135.0, "upper right corner");
        let solid = mask(&[".....", ".###.", ".###.", ".###."]);
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(2, 1), true), 0.0);
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(3, 2), true), 90.0);
        assert_eq!(solid.surface_deg(Cell::new(0, 0), Cell::new(1, 1), true), 45.0);
        assert_eq!(
            solid.surface_deg(Cell::new(0, 0), Cell::new(2, 2), true),
            0.0,
            "inside there is no direction"
        );
    }

    #[test]
    fn marks_outside_are_not_there() {
        let m = mask(&["##", "##"]);
        assert!(m.contains(Cell::new(1, 1)) && !m.contains(Cell::new(2, 0)) && !m.contains(Cell::new(0, 2)));
        assert_eq!((Mask::new(0, vec![true; 3]).height(), Mask::new(2, vec![true; 5]).height()), (0, 2));
    }
}
