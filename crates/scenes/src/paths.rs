//! Ways through a scene: the shortest one, and the one that light shows.

use std::collections::VecDeque;
use tigereye_core::{Cell, Field};

/// Cells from a start to an end, both included, each one of the eight neighbours of the one before: light knows no
/// others.
pub type Path = Vec<Cell>;

/// The eight directions, those along rows and columns first.
const STRAIGHT_FIRST: [usize; 8] = [0, 2, 4, 6, 1, 3, 5, 7];

/// Steps of a shortest way from each open cell to `end`, by breadth-first search; `None` where there is none.
#[must_use]
pub fn steps_to(open: &Field<bool>, end: Cell) -> Field<Option<usize>> {
    let grid = open.grid();
    let mut steps = vec![None; grid.cells()];
    let mut queue = VecDeque::new();
    if grid.contains(end) && *open.at(end) {
        steps[grid.index(end)] = Some(0);
        queue.push_back((end, 0));
    }
    while let Some((cell, count)) = queue.pop_front() {
        for near in (0..8).filter_map(|k| grid.neighbour(cell, k)) {
            let place = &mut steps[grid.index(near)];
            if *open.at(near) && place.is_none() {
                *place = Some(count + 1);
                queue.push_back((near, count + 1));
            }
        }
    }
    Field::from_fn(grid, |cell| steps[grid.index(cell)])
}

/// A shortest way from `start` to `end` through cells that are open; `None` where there is none.
///
/// Of equally short ones, one that goes straight where it can.
#[must_use]
pub fn shortest_path(open: &Field<bool>, start: Cell, end: Cell) -> Option<Path> {
    let grid = open.grid();
    if !grid.contains(start) {
        return None;
    }
    let steps = steps_to(open, end);
    let mut path = vec![start];
    let (mut cell, mut left) = (start, (*steps.at(start))?);
    while left > 0 {
        left -= 1;
        let mut near = STRAIGHT_FIRST.into_iter().filter_map(|k| grid.neighbour(cell, k));
        cell = near.find(|near| *steps.at(*near) == Some(left))?;
        path.push(cell);
    }
    Some(path)
}

/// The steepest ascent of brightness: the way from `start` that always goes on to the brightest open neighbour, against
/// the light to its source, turned round: from the light to `start`. `None` where it does not come to `light`: in the
/// dark, or on a summit of its own.
#[must_use]
pub fn brightest_path(energy: &Field<f64>, open: &Field<bool>, start: Cell, light: Cell) -> Option<Path> {
    let grid = energy.grid();
    if open.grid() != grid || !grid.contains(start) || !grid.contains(light) {
        return None;
    }
    let mut path = vec![start];
    let mut cell = start;
    while cell != light {
        cell = brightest_neighbour(energy, open, cell)?;
        path.push(cell);
    }
    path.reverse();
    Some(path)
}

/// The brightest of the open neighbours that are brighter than the cell, the first of equally bright ones.
fn brightest_neighbour(energy: &Field<f64>, open: &Field<bool>, cell: Cell) -> Option<Cell> {
    let grid = energy.grid();
    let brighter = (0..8)
        .filter_map(|k| grid.neighbour(cell, k))
        .filter(|near| *open.at(*near) && energy.at(*near) > energy.at(cell));
    brighter.reduce(|best, near| if energy.at(near) > energy.at(best) { near } else { best })
}

/// Steps of the steepest ascent of brightness from each open cell to `light`; `None` where it ends before.
#[must_use]
pub fn climbing_steps(energy: &Field<f64>, open: &Field<bool>, light: Cell) -> Field<Option<usize>> {
    let grid = energy.grid();
    let mut steps: Vec<Option<usize>> = vec![None; grid.cells()];
    // A neighbour that is brighter has had its turn.
    let mut cells: Vec<Cell> = grid.iter().filter(|cell| open.grid() == grid && *open.at(*cell)).collect();
    cells.sort_by(|a, b| energy.at(*b).total_cmp(energy.at(*a)));
    for cell in cells {
        let next = brightest_neighbour(energy, open, cell);
        let of_next = next.and_then(|next| steps[grid.index(next)]).map(|steps| steps + 1);
        steps[grid.index(cell)] = if cell == light { Some(0) } else { of_next };
    }
    Field::from_fn(grid, |cell| steps[grid.index(cell)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn open(rows: &[&str]) -> Field<bool> {
        let grid = Grid::new(rows[0].len(), rows.len()).expect("a grid");
        Field::from_fn(grid, |c| rows[c.y].as_bytes()[c.x] == b'.')
    }

    #[test]
    fn shortest_paths_go_round_walls() {
        let maze = open(&[".#...", ".#.#.", "...#.", "####."]);
        let path = shortest_path(&maze, Cell::new(0, 0), Cell::new(4, 3)).expect("a way");
        // Corners are cut: eight cells instead of twelve.
        assert_eq!(path.len(), 8);
        assert_eq!((path[0], path[7]), (Cell::new(0, 0), Cell::new(4, 3)));
        assert!(path.windows(2).all(|w| w[0].x.abs_diff(w[1].x).max(w[0].y.abs_diff(w[1].y)) == 1));
        let hall = open(&[".....", ".....", "....."]);
        let straight = [(0, 1), (1, 1), (2, 1), (3, 1), (4, 0)].map(|(x, y)| Cell::new(x, y));
        assert_eq!(shortest_path(&hall, straight[0], straight[4]).as_deref(), Some(&straight[..]));
        let shut = open(&[".#.", ".#.", ".#."]);
        assert_eq!(shortest_path(&shut, Cell::new(0, 0), Cell::new(2, 2)), None);
        assert_eq!(shortest_path(&shut, Cell::new(1, 0), Cell::new(2, 2)), None, "from inside a wall");
        assert_eq!(shortest_path(&shut, Cell::new(0, 0), Cell::new(0, 9)), None, "outside");
    }

    #[test]
    fn brightest_paths_climb_to_the_light() {
        let maze = open(&["...", ".#.", "..."]);
        let brightness = [[9.0, 5.0, 3.0], [4.0, 100.0, 2.0], [3.0, 2.0, 1.0]];
        let energy = Field::from_fn(maze.grid(), |c| brightness[c.y][c.x]);
        let path = brightest_path(&energy, &maze, Cell::new(2, 2), Cell::new(0, 0));
        let cells = |p: &[(usize, usize)]| Some(p.iter().map(|&(x, y)| Cell::new(x, y)).collect::<Vec<_>>());
        assert_eq!(path, cells(&[(0, 0), (1, 0), (2, 1), (2, 2)]));
        let dark = Field::from_fn(maze.grid(), |_| 0.0);
        assert_eq!(brightest_path(&dark, &maze, Cell::new(2, 2), Cell::new(0, 0)), None);
    }

    #[test]
    fn steps_are_those_of_the_ways() {
        let maze = open(&[".#...", ".#.#.", "...#.", "####."]);
        let light = Cell::new(4, 3);
        // Brightness with a summit of its own in the upper left corner.
        let energy = Field::from_fn(maze.grid(), |c| {
            (c.x * c.x + 3 * c.y) as f64 + if c.x + c.y == 0 { 9.0 } else { 0.0 }
        });
        let (short, climb) = (steps_to(&maze, light), climbing_steps(&energy, &maze, light));
        for cell in maze.grid().iter() {
            let steps = |path: Option<Path>| path.map(|p| p.len() - 1);
            assert_eq!(*short.at(cell), steps(shortest_path(&maze, cell, light)), "{cell:?}");
            if *maze.at(cell) {
                assert_eq!(*climb.at(cell), steps(brightest_path(&energy, &maze, cell, light)), "{cell:?}");
            }
        }
        assert_eq!(
            (*short.at(Cell::new(1, 0)), *climb.at(Cell::new(0, 0))),
            (None, None),
            "a wall, a summit"
        );
        assert!(climb.values().iter().flatten().count() > 3);
    }
}
