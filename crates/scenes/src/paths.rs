//! Ways through a scene: the shortest one, and the one that light shows.

use std::collections::VecDeque;
use tigereye_core::{Cell, Field};

/// Cells from a start to an end, both included, each one of the eight neighbours of the one before: light knows no others.
pub type Path = Vec<Cell>;

/// The eight directions, those along rows and columns first.
const STRAIGHT_FIRST: [usize; 8] = [0, 2, 4, 6, 1, 3, 5, 7];

/// A shortest way from `start` to `end` through cells that are open, by breadth-first search; `None` where there is none.
///
/// Of equally short ones, one that goes straight where it can.
#[must_use]
pub fn shortest_path(open: &Field<bool>, start: Cell, end: Cell) -> Option<Path> {
    let grid = open.grid();
    if !grid.contains(start) || !grid.contains(end) || !*open.at(start) || !*open.at(end) {
        return None;
    }
    let mut next = vec![None; grid.cells()];
    next[grid.index(end)] = Some(end);
    let mut queue = VecDeque::from([end]);
    while let Some(cell) = queue.pop_front() {
        for near in STRAIGHT_FIRST.into_iter().filter_map(|k| grid.neighbour(cell, k)) {
            let place = &mut next[grid.index(near)];
            if *open.at(near) && place.is_none() {
                *place = Some(cell);
                queue.push_back(near);
            }
        }
    }
    let mut path = vec![start];
    let mut cell = start;
    while cell != end {
        cell = next[grid.index(cell)]?;
        path.push(cell);
    }
    Some(path)
}

/// The way from `start` that always goes on to the brightest open neighbour, against the light to its source, turned round: from
/// the light to `start`. `None` where it does not come to `light`: in the dark, or on a summit of its own.
#[must_use]
pub fn brightest_path(energy: &Field<f64>, open: &Field<bool>, start: Cell, light: Cell) -> Option<Path> {
    let grid = energy.grid();
    if open.grid() != grid || !grid.contains(start) || !grid.contains(light) {
        return None;
    }
    let mut path = vec![start];
    let mut cell = start;
    while cell != light {
        let brighter = (0..8)
            .filter_map(|k| grid.neighbour(cell, k))
            .filter(|near| *open.at(*near) && energy.at(*near) > energy.at(cell));
        // The first of equally bright ones.
        cell = brighter.reduce(|best, near| if energy.at(near) > energy.at(best) { near } else { best })?;
        path.push(cell);
    }
    path.reverse();
    Some(path)
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
}
