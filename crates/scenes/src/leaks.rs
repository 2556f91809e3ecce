//! Gaps through which light passes diagonally.

use crate::BuiltScene;
use tigereye_core::Cell;

/// Pairs of cells of one part's wall that touch at a corner only: light passes between them, as the eight neighbours of a cell
/// include the diagonal ones. Row-major by the upper cell.
#[must_use]
pub fn leaks(scene: &BuiltScene) -> Vec<[Cell; 2]> {
    let grid = scene.surfaces.grid();
    let wall = |cell: Cell| scene.is_wall(cell).then(|| *scene.parts.at(cell)).flatten();
    let mut found = Vec::new();
    for cell in grid.iter() {
        for k in [5, 7] {
            let (Some(next), Some(beside)) = (grid.neighbour(cell, k), grid.neighbour(cell, 2 * (k - 3) % 8))
            else {
                continue;
            };
            let below = Cell::new(cell.x, next.y);
            let same = wall(cell).is_some() && wall(cell) == wall(next);
            if same && !scene.is_wall(beside) && !scene.is_wall(below) {
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
    use tigereye_core::{Directions, Grid};

    fn wall(thickness: f64) -> BuiltScene {
        let shape = Shape::Segment { from: [1.0, 5.0], to: [5.0, 1.0], thickness };
        let grid = Grid::new(7, 7).expect("a grid");
        let parts = vec![Part { shape, material: Material::Absorber }];
        Scene { grid, parts }.built(Directions::new(8).expect("directions")).expect("a scene")
    }

    #[test]
    fn thin_slanted_walls_have_gaps() {
        let thin = leaks(&wall(1.0));
        assert_eq!(thin.len(), 4);
        assert_eq!(thin[0], [Cell::new(5, 1), Cell::new(4, 2)]);
        assert!(leaks(&wall(1.42)).is_empty());
    }
}
