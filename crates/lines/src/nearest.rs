//! Distance of points from lines.

use crate::Polylines;
use euclid::Vector2D;
use tigereye_core::{Point, length};

/// The segments of lines in a grid of squares, for finding the nearest one.
#[derive(Clone, Debug)]
pub struct NearestSegment {
    segments: Vec<[Point; 2]>,
    low: Point,
    side: f64,
    squares: [usize; 2],
    /// Segments of square i are `entries[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl NearestSegment {
    /// Index of the segments of lines; those with a non-finite end are omitted. Memory is proportional to the number of
    /// segments.
    #[must_use]
    pub fn new(lines: &Polylines) -> Self {
        let at = |[a, b]: [u32; 2]| [lines.points[a as usize], lines.points[b as usize]];
        let all = lines.lines.iter().flat_map(|l| {
            let single = (l.points.len() == 1).then(|| [l.points[0]; 2]);
            l.segments().chain(single)
        });
        let segments: Vec<_> = all.map(at).filter(|s| s.iter().all(|p| p.is_finite())).collect();
        let (mut low, mut high) = (Point::splat(f64::INFINITY), Point::splat(f64::NEG_INFINITY));
        for &p in segments.iter().flatten() {
            (low, high) = (low.min(p), high.max(p));
        }
        let mut found =
            Self { segments, low, side: 1.0, squares: [1, 1], starts: Vec::new(), entries: Vec::new() };
        found.choose_squares((high - low).max(Vector2D::zero()).to_array());
        found.sort_in();
        found
    }

    /// Chooses squares such that there are about as many as segments, and at most four times as many pieces of
    /// segments.
    fn choose_squares(&mut self, extent: [f64; 2]) {
        let count = self.segments.len().max(1) as f64;
        let total: f64 = self.segments.iter().map(|[p, q]| length(*q - *p)).sum();
        let by_area = (extent[0] * extent[1] / count).sqrt();
        let side = by_area.max(total / (4.0 * count)).max(extent[0].max(extent[1]) / count);
        if side > 0.0 && side.is_finite() {
            self.side = side;
            // A guard against rounding, far above what the sides allow.
            let most = 2.0 * count + 2.0;
            self.squares = extent.map(|e| (e / side).min(most) as usize + 1);
        } else {
            self.side = f64::INFINITY;
        }
    }

    fn square(&self, p: Point) -> [usize; 2] {
        let index = |offset: f64, squares: usize| ((offset / self.side).max(0.0) as usize).min(squares - 1);
        let offset = p - self.low;
        [index(offset.x, self.squares[0]), index(offset.y, self.squares[1])]
    }

    fn sort_in(&mut self) {
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (i, &[p, q]) in self.segments.iter().enumerate() {
            // A piece no longer than a square touches at most four squares.
            let pieces = (length(q - p) / self.side).ceil().max(1.0);
            let on = |t: f64| self.square(p + (q - p) * t);
            for n in 0..pieces as usize {
                let (a, b) = (on(n as f64 / pieces), on((n + 1) as f64 / pieces));
                for y in a[1].min(b[1])..=a[1].max(b[1]) {
                    for x in a[0].min(b[0])..=a[0].max(b[0]) {
                        pairs.push(((y * self.squares[0] + x) as u32, i as u32));
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        self.starts = vec![0; self.squares[0] * self.squares[1] + 1];
        for (square, _) in &pairs {
            self.starts[*square as usize + 1] += 1;
        }
        for i in 1..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.entries = pairs.into_iter().map(|(_, i)| i).collect();
    }

    /// Distance of a point to the nearest segment, in cells; `None` if there is no segment or the point is not finite.
    #[must_use]
    pub fn distance(&self, point: Point) -> Option<f64> {
        if self.segments.is_empty() || !point.is_finite() {
            return None;
        }
        let centre = self.square(point);
        let furthest = self.squares[0].max(self.squares[1]);
        let mut best = f64::INFINITY;
        // Rings of squares around that of the point; ring n is at least n - 1 sides away.
        for ring in 0..=furthest {
            if ring > 0 && best <= (ring - 1) as f64 * self.side {
                break;
            }
            self.each_in_ring(centre, ring, |segment| best = best.min(distance_to(segment, point)));
        }
        Some(best)
    }

    fn each_in_ring(&self, [cx, cy]: [usize; 2], ring: usize, mut f: impl FnMut([Point; 2])) {
        for y in cy.saturating_sub(ring)..=(cy + ring).min(self.squares[1] - 1) {
            let edge = y.abs_diff(cy) == ring;
            let inner = [cx.checked_sub(ring), Some(cx + ring).filter(|_| ring > 0)];
            let all = cx.saturating_sub(ring)..=cx + ring;
            let mut visit = |x: usize| {
                if x < self.squares[0] {
                    let i = y * self.squares[0] + x;
                    for &e in &self.entries[self.starts[i] as usize..self.starts[i + 1] as usize] {
                        f(self.segments[e as usize]);
                    }
                }
            };
            if edge {
                all.take_while(|&x| x < self.squares[0]).for_each(&mut visit);
            } else {
                inner.into_iter().flatten().for_each(&mut visit);
            }
        }
    }
}

/// Distance of a point to a segment.
fn distance_to([p, q]: [Point; 2], point: Point) -> f64 {
    let (along, to) = (q - p, point - p);
    let size = along.square_length();
    let t = if size > 0.0 { (to.dot(along) / size).clamp(0.0, 1.0) } else { 0.0 };
    length(to - along * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polyline;
    use tigereye_core::SplitMix64;

    #[test]
    fn the_nearest_of_all_segments_is_found() {
        let mut numbers = SplitMix64::new(3);
        let mut random = move || numbers.unit();
        // Short segments, long ones, all in one row, all at one point.
        for (steps, width, height) in [(300, 0.4, 0.4), (40, 30.0, 20.0), (50, 10.0, 0.0), (5, 0.0, 0.0)] {
            let mut at = Point::zero();
            let mut lines = Polylines::default();
            for i in 0..steps {
                at += Vector2D::new(width * (random() - 0.4), height * (random() - 0.5));
                lines.points.push(at);
                if i % 20 == 0 {
                    lines.lines.push(Polyline { points: Vec::new(), closed: i % 40 == 0 });
                }
                lines.lines.last_mut().expect("a line").points.push(i);
            }
            let nearest = NearestSegment::new(&lines);
            assert!(nearest.entries.len() < 50 * steps as usize);
            for _ in 0..500 {
                let p = Point::new(40.0 * random() - 20.0, 30.0 * random() - 15.0);
                let brute = nearest.segments.iter().map(|s| distance_to(*s, p)).fold(f64::INFINITY, f64::min);
                assert_eq!(nearest.distance(p), Some(brute));
            }
        }
    }

    #[test]
    fn no_segment_or_no_point_has_no_distance() {
        assert_eq!(NearestSegment::new(&Polylines::default()).distance(Point::zero()), None);
        let lines = Polylines {
            points: [(1.0, 1.0), (f64::NAN, 0.0), (4.0, 5.0)].map(Point::from).to_vec(),
            lines: vec![
                Polyline { points: vec![0, 1], closed: false },
                Polyline { points: vec![], closed: true },
                Polyline { points: vec![2], closed: false },
            ],
        };
        let nearest = NearestSegment::new(&lines);
        assert_eq!(nearest.distance(Point::new(1.0, 1.0)), Some(5.0));
        assert_eq!(nearest.distance(Point::new(f64::INFINITY, 1.0)), None);
    }
}
