//! Lines of equal value between the centres of cells.

use crate::Polylines;
use crate::chains::{chained, without_repetitions};
use tigereye_core::{Cell, Field, Point};

/// Points closer to each other than this, in cells, are merged.
const SAME: f64 = 1e-9;

/// The lines on which values, linear along the edges between centres of cells, equal `level` (marching squares,
/// Lorensen and Cline 1987). In an ambiguous square, with opposite corners on the same side, the bilinear value at its
/// saddle decides which corners are connected (the asymptotic decider, Nielson and Hamann 1991). Values equal to the
/// level count as above it. Lines end at the border and beside non-finite cells; lines that shrink to a point are
/// omitted. A level that is not finite has no lines.
#[must_use]
pub fn isolines(field: &Field<f64>, level: f64) -> Polylines {
    let grid = field.grid();
    let (width, height) = (grid.width(), grid.height());
    let at = |x: usize, y: usize| *field.at(Cell::new(x, y));
    let mut shape = Polylines::default();
    if !level.is_finite() {
        return shape;
    }
    // Points on the edges from each cell to the right and downwards.
    let mut on_edges = vec![[u32::MAX; 2]; grid.cells()];
    for y in 0..height {
        for x in 0..width {
            for (d, (dx, dy)) in [(1, 0), (0, 1)].into_iter().enumerate() {
                if x + dx < width
                    && y + dy < height
                    && let Some(t) = crossing(at(x, y), at(x + dx, y + dy), level)
                {
                    on_edges[y * width + x][d] = shape.points.len() as u32;
                    shape.points.push(Point::new(x as f64 + t * dx as f64, y as f64 + t * dy as f64));
                }
            }
        }
    }
    let mut segments = Vec::new();
    for y in 0..height - 1 {
        for x in 0..width - 1 {
            let i = y * width + x;
            let edges = [on_edges[i][0], on_edges[i + 1][1], on_edges[i + width][0], on_edges[i][1]];
            let corners = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            if corners.iter().all(|v| v.is_finite()) {
                segments.extend(in_square(corners, edges, level));
            }
        }
    }
    shape.lines = chained(shape.points.len(), &segments);
    without_repetitions(&mut shape.lines, &shape.points, SAME);
    compact(shape)
}

/// The fraction between two values at which the level is reached, if they are finite and lie on different sides of it.
pub(crate) fn crossing(a: f64, b: f64, level: f64) -> Option<f64> {
    if !(a.is_finite() && b.is_finite()) || (a >= level) == (b >= level) {
        return None;
    }
    // Halves do not overflow.
    Some(((0.5 * level - 0.5 * a) / (0.5 * b - 0.5 * a)).clamp(0.0, 1.0))
}

/// The segments in a square: corners in order, edge i from corner i to the next.
fn in_square(corners: [f64; 4], edges: [u32; 4], level: f64) -> impl Iterator<Item = [u32; 2]> {
    let crossed: Vec<u32> = edges.into_iter().filter(|&e| e != u32::MAX).collect();
    let pairs = match crossed[..] {
        [a, b] => [Some([a, b]), None],
        [a, b, c, d] => {
            // The first corner is cut off where the middle of the saddle lies on the other side.
            let [p, q, r, s] = corners.map(|v| 0.5 * v - 0.5 * level);
            let scale = [p, q, r, s].iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            let [p, q, r, s] = [p, q, r, s].map(|v| v / scale);
            let middle = (p * r - q * s) / (p - q + r - s);
            if (middle >= 0.0) == (p >= 0.0) {
                [Some([a, b]), Some([c, d])]
            } else {
                [Some([d, a]), Some([b, c])]
            }
        }
        _ => [None; 2],
    };
    pairs.into_iter().flatten()
}

/// Drops the points that belong to no line.
fn compact(shape: Polylines) -> Polylines {
    let mut found = Polylines::default();
    for mut line in shape.lines {
        for p in &mut line.points {
            found.points.push(shape.points[*p as usize]);
            *p = (found.points.len() - 1) as u32;
        }
        found.lines.push(line);
    }
    found
}
