//! The borders of sets of cells.

use std::collections::BTreeMap;
use tigereye_core::{Cell, Field, Point};

/// Corners of cells, column and row; cell (x, y) lies between corners (x, y) and (x + 1, y + 1).
type Corner = (usize, usize);

/// Right, down, left, up: steps between corners.
const STEPS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The lines between the cells of a set and those that are not in it, for an [`Overlay`](crate::Overlay): one that is
/// not finite ends each line. The border of the map is no such line. Cells that touch at a corner are apart.
#[must_use]
pub fn outline(cells: &Field<bool>) -> Vec<Point> {
    let mut steps = border_steps(cells);
    let arrivals: Vec<Corner> =
        steps.iter().flat_map(|(corner, ways)| ways.iter().map(|&way| moved(*corner, way))).collect();
    let mut arriving = BTreeMap::new();
    arrivals.into_iter().for_each(|corner| *arriving.entry(corner).or_insert(0_usize) += 1);
    // Lines that begin at the border of the map come first; what is left are closed ones.
    let begins = |(corner, ways): (&Corner, &Vec<usize>)| {
        (ways.len() > arriving.get(corner).copied().unwrap_or(0)).then_some(*corner)
    };
    let open: Vec<Corner> = steps.iter().filter_map(begins).collect();
    let mut points = Vec::new();
    for corner in open {
        follow(corner, &mut steps, &mut points);
    }
    while let Some(corner) = steps.keys().next().copied() {
        follow(corner, &mut steps, &mut points);
    }
    points
}

/// From each corner the ways on along the border, with the set on the right.
fn border_steps(cells: &Field<bool>) -> BTreeMap<Corner, Vec<usize>> {
    let grid = cells.grid();
    let mut steps: BTreeMap<Corner, Vec<usize>> = BTreeMap::new();
    for Cell { x, y } in grid.iter().filter(|cell| *cells.at(*cell)) {
        // The side towards each neighbour (up, right, down, left) with the corner at which it begins.
        let sides = [(2, (x, y)), (0, (x + 1, y)), (6, (x + 1, y + 1)), (4, (x, y + 1))];
        for (way, (direction, corner)) in sides.into_iter().enumerate() {
            if grid.neighbour(Cell::new(x, y), direction).is_some_and(|other| !*cells.at(other)) {
                steps.entry(corner).or_default().push(way);
            }
        }
    }
    steps
}

fn moved((x, y): Corner, way: usize) -> Corner {
    let (dx, dy) = STEPS[way];
    (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy))
}

/// Appends the line from a corner and takes its steps away.
fn follow(start: Corner, steps: &mut BTreeMap<Corner, Vec<usize>>, points: &mut Vec<Point>) {
    let point = |(x, y): Corner| Point::new(x as f64 - 0.5, y as f64 - 0.5);
    let (mut corner, mut before) = (start, None);
    while let Some(way) = take_step(corner, before, steps) {
        if before != Some(way) {
            points.push(point(corner));
        }
        corner = moved(corner, way);
        before = Some(way);
    }
    points.extend([point(corner), Point::new(f64::NAN, f64::NAN)]);
}

/// The next step from a corner: where there are two, the turn that stays at the same cell.
fn take_step(
    corner: Corner,
    before: Option<usize>,
    steps: &mut BTreeMap<Corner, Vec<usize>>,
) -> Option<usize> {
    let ways = steps.get_mut(&corner)?;
    let right_turn = before.map(|way| (way + 1) % 4);
    let i = ways.iter().position(|&way| Some(way) == right_turn).unwrap_or(0);
    let way = ways.remove(i);
    if ways.is_empty() {
        steps.remove(&corner);
    }
    Some(way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn lines(rows: &[&str]) -> Vec<Vec<(f64, f64)>> {
        let grid = Grid::new(rows[0].len(), rows.len()).expect("a grid");
        let cells = Field::from_fn(grid, |c| rows[c.y].as_bytes()[c.x] == b'#');
        let points = outline(&cells);
        let split = points.split(|p| !p.x.is_finite());
        split.filter(|line| !line.is_empty()).map(|l| l.iter().map(|p| (p.x, p.y)).collect()).collect()
    }

    #[test]
    fn single_cells_are_squares() {
        let square = vec![(0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5), (0.5, 0.5)];
        assert_eq!(lines(&["...", ".#.", "..."]), [square]);
    }

    #[test]
    fn the_border_of_the_map_is_no_line() {
        assert_eq!(lines(&["##", "##"]), Vec::<Vec<_>>::new());
        assert_eq!(lines(&["..", ".."]), Vec::<Vec<_>>::new());
        assert_eq!(lines(&["#.", "#."]), [vec![(0.5, -0.5), (0.5, 1.5)]]);
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_apart() {
        let found = lines(&["....", ".#..", "..#.", "...."]);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|line| line.len() == 5 && line[0] == line[4]), "{found:?}");
    }

    /// Every side between a cell of the set and another is drawn once.
    #[test]
    fn lines_are_as_long_as_the_border() {
        let rows = ["#..#.##", ".##.#.#", "#.#.###", "..##..#", "####.#."];
        let at = |x: usize, y: usize| rows[y].as_bytes()[x];
        let across =
            (0..5).flat_map(|y| (0..6).map(move |x| (x, y))).filter(|&(x, y)| at(x, y) != at(x + 1, y));
        let down =
            (0..4).flat_map(|y| (0..7).map(move |x| (x, y))).filter(|&(x, y)| at(x, y) != at(x, y + 1));
        let length: f64 = lines(&rows)
            .iter()
            .flat_map(|line| line.windows(2).map(|p| (p[0].0 - p[1].0).abs() + (p[0].1 - p[1].1).abs()))
            .sum();
        assert_eq!(length, (across.count() + down.count()) as f64);
    }
}
