//! Gaps through which light passes diagonally.

use crate::Layout;
use tigereye_core::Cell;

/// Pairs of walls' cells that touch at a corner only: light passes between them, as the eight neighbours of a cell
/// include the diagonal ones. Row-major by the upper cell.
#[must_use]
pub fn leaks(layout: &Layout) -> Vec<[Cell; 2]> {
    let grid = layout.surfaces.grid();
    let mut found = Vec::new();
    for cell in grid.iter().filter(|cell| layout.is_wall(*cell)) {
        for k in [5, 7] {
            let (Some(next), Some(beside)) = (grid.neighbour(cell, k), grid.neighbour(cell, 2 * (k - 3) % 8))
            else {
                continue;
            };
            let below = Cell::new(cell.x, next.y);
            if layout.is_wall(next) && !layout.is_wall(beside) && !layout.is_wall(below) {
                found.push([cell, next]);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, Part, Scene, Shape};
    use tigereye_core::Grid;

    fn wall(thickness: f64) -> Layout {
        let shape = Shape::Segment { from: [1.0, 5.0], to: [5.0, 1.0], thickness };
        let grid = Grid::new(7, 7).expect("a grid");
        let parts = vec![Part { shape, material: Material::Absorber }];
        Scene { grid, parts }.layout().expect("a layout")
    }

    #[test]
    fn thin_slanted_walls_have_gaps() {
        let thin = leaks(&wall(1.0));
        assert_eq!(thin.len(), 4);
        assert_eq!(thin[0], [Cell::new(5, 1), Cell::new(4, 2)]);
        assert!(leaks(&wall(1.42)).is_empty());
    }

    #[test]
    fn walls_of_two_parts_have_gaps_too() {
        let row = |from, to| Part {
            shape: Shape::Rectangle { from, to },
            material: Material::Mirror { reflectance: 1.0, angle_deg: None },
        };
        let parts = vec![row([0.0, 2.0], [3.0, 2.0]), row([4.0, 3.0], [6.0, 3.0])];
        let layout = Scene { grid: Grid::new(7, 7).expect("a grid"), parts }.layout().expect("a layout");
        assert_eq!(leaks(&layout), [[Cell::new(3, 2), Cell::new(4, 3)]]);
    }
}
