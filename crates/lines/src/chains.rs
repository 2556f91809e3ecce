//! Joins segments into lines.

use crate::Polyline;
use tigereye_core::Point;

/// No neighbour.
const NONE: u32 = u32::MAX;

/// Joins segments between `points` points, each of which belongs to at most two segments: open lines first, starting
/// from the end with the lower index, then closed ones.
pub(crate) fn chained(points: usize, segments: &[[u32; 2]]) -> Vec<Polyline> {
    let mut neighbours = vec![[NONE; 2]; points];
    for &[a, b] in segments {
        for (from, to) in [(a, b), (b, a)] {
            let slots = &mut neighbours[from as usize];
            debug_assert!(slots[1] == NONE, "more than two segments at a point");
            slots[usize::from(slots[0] != NONE)] = to;
        }
    }
    let mut seen = vec![false; points];
    let mut lines = Vec::new();
    for closed in [false, true] {
        for start in 0..points {
            let [first, second] = neighbours[start];
            if seen[start] || first == NONE || (second == NONE) == closed {
                continue;
            }
            lines.push(Polyline { points: walk(&neighbours, &mut seen, start), closed });
        }
    }
    lines
}

fn walk(neighbours: &[[u32; 2]], seen: &mut [bool], start: usize) -> Vec<u32> {
    let mut line = Vec::new();
    let mut at = start;
    loop {
        seen[at] = true;
        line.push(at as u32);
        match neighbours[at].into_iter().find(|&n| n != NONE && !seen[n as usize]) {
            Some(next) => at = next as usize,
            None => return line,
        }
    }
}

/// Removes points that coincide with their predecessor to within `reach` along each axis: a line through a node of a
/// mesh crosses several edges there. Lines of fewer than two points, or three if closed, are removed.
pub(crate) fn without_repetitions(lines: &mut Vec<Polyline>, points: &[Point], reach: f64) {
    let same = |a: u32, b: u32| {
        let (p, q) = (points[a as usize], points[b as usize]);
        (p.x - q.x).abs() <= reach && (p.y - q.y).abs() <= reach
    };
    for line in lines.iter_mut() {
        line.points.dedup_by(|a, b| same(*a, *b));
        while line.closed && line.points.len() > 1 && same(line.points[0], line.points[line.points.len() - 1])
        {
            line.points.pop();
        }
    }
    lines.retain(|l| l.points.len() >= if l.closed { 3 } else { 2 });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_in_any_order_become_lines_and_loops() {
        let lines = chained(8, &[[3, 1], [7, 6], [1, 0], [5, 7], [6, 5]]);
        assert_eq!(
            lines,
            [
                Polyline { points: vec![0, 1, 3], closed: false },
                Polyline { points: vec![5, 7, 6], closed: true }
            ]
        );
        assert_eq!(lines[1].segments().collect::<Vec<_>>(), [[5, 7], [7, 6], [6, 5]]);
    }

    #[test]
    fn repeated_points_are_left_out() {
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)].map(Point::from);
        let mut lines = vec![
            Polyline { points: vec![0, 1, 2, 3, 4], closed: true },
            Polyline { points: vec![1, 2], closed: false },
        ];
        without_repetitions(&mut lines, &points, 1e-9);
        assert_eq!(lines, [Polyline { points: vec![0, 1, 3], closed: true }]);
    }
}
