//! Markers, dashed lines and hatching.

use crate::colour::Rgba;
use crate::scene::{Item, PagePoint, Path, PathBuilder, Scene, Segment, Stroke};
use tigereye_core::math;

/// Markers of points, distinguishable without colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// Filled circle.
    Circle,
    /// Filled square.
    Square,
    /// Filled triangle, point up.
    Triangle,
    /// Filled square standing on a corner.
    Diamond,
    /// Two crossing diagonals.
    Cross,
    /// Hollow circle.
    Ring,
    /// Five-pointed star, used for light sources.
    Star,
}

impl Marker {
    /// The markers given to series in turn.
    pub const SERIES: [Self; 6] =
        [Self::Circle, Self::Square, Self::Triangle, Self::Diamond, Self::Cross, Self::Ring];

    pub(crate) fn draw(self, scene: &mut Scene, centre: impl Into<PagePoint>, radius: f64, colour: Rgba) {
        let mut path = PathBuilder::default();
        self.add_to(&mut path, centre.into(), radius);
        match self {
            Self::Cross => scene.stroke(path.finish(), colour, 1.5),
            Self::Ring => scene.paint(path.finish(), Rgba::WHITE, colour, 1.3),
            // A thin white outline separates a marker from what lies under it.
            _ => scene.paint(path.finish(), colour, Rgba::WHITE, 0.6),
        }
    }

    fn add_to(self, path: &mut PathBuilder, centre: PagePoint, r: f64) {
        let PagePoint { x, y, .. } = centre;
        match self {
            Self::Circle | Self::Ring => path.circle(centre, r),
            Self::Square => path.rect(x - 0.88 * r, y - 0.88 * r, 1.76 * r, 1.76 * r),
            Self::Triangle => path.polyline(&regular(centre, 1.2 * r, 3, 1.0), true),
            Self::Diamond => path.polyline(&regular(centre, 1.2 * r, 4, 1.0), true),
            Self::Star => path.polyline(&regular(centre, 1.35 * r, 10, 0.45), true),
            Self::Cross => {
                path.line([x - r, y - r], [x + r, y + r]);
                path.line([x - r, y + r], [x + r, y - r]);
            }
        }
    }
}

/// Corners of a regular polygon with a corner on top; every second one at `inner` times the radius.
fn regular(centre: PagePoint, radius: f64, corners: usize, inner: f64) -> Vec<PagePoint> {
    (0..corners)
        .map(|i| {
            let angle = math::FRAC_PI_2 + math::TAU * i as f64 / corners as f64;
            let r = if i % 2 == 1 { radius * inner } else { radius };
            PagePoint::new(centre.x + r * math::cos(angle), centre.y - r * math::sin(angle))
        })
        .collect()
}

/// A line, dashed unless `dash_px` is empty.
pub(crate) fn dashed(
    scene: &mut Scene,
    segments: Vec<Segment>,
    colour: Rgba,
    width_px: f64,
    dash_px: &[f64],
) {
    let stroke = Some(Stroke { colour, width_px, dash_px: dash_px.to_vec() });
    scene.items.push(Item::Path(Path { segments, fill: None, stroke }));
}

/// A line simplified by dropping points that lie within `tolerance` of the rest (Douglas and Peucker 1973).
pub(crate) fn simplified(points: &[PagePoint], tolerance: f64) -> Vec<PagePoint> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let mut farthest = (first, tolerance * tolerance);
        for i in first + 1..last {
            let d = squared_distance(points[i], points[first], points[last]);
            if d > farthest.1 {
                farthest = (i, d);
            }
        }
        if farthest.0 != first {
            keep[farthest.0] = true;
            open.push((first, farthest.0));
            open.push((farthest.0, last));
        }
    }
    points.iter().zip(keep).filter_map(|(p, k)| k.then_some(*p)).collect()
}

/// Squared distance of `p` from the line segment `a` to `b`.
fn squared_distance(p: PagePoint, a: PagePoint, b: PagePoint) -> f64 {
    let (along, to) = (b - a, p - a);
    let length = along.square_length();
    let t = if length > 0.0 { (to.dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (to - along * t).square_length()
}
