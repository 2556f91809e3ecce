//! Bands of varying width along lines, such as hyperstreamlines (Delmarcelle and Hesselink 1993).

use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::scene::{PagePoint, PageVector, PathBuilder};
use tigereye_core::{Point, length};

/// Bands drawn over a map, below its [`crate::Overlay`]s. Widths count in the smaller side of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Ribbon {
    /// Label in the legend; if empty, the ribbon does not appear there.
    pub label: String,
    /// Points of the middle line. One that is not finite, or lies several maps away, interrupts the
    /// band, so that one ribbon holds many.
    pub points: Vec<Point>,
    /// Half the width at every point, measured across the line. One that is missing, negative or not finite
    /// interrupts the band.
    pub half_widths: Vec<f64>,
    /// Colour of the edges; the band itself is transparent.
    pub colour: Rgba,
}

impl Default for Ribbon {
    fn default() -> Self {
        Self { label: String::new(), points: Vec::new(), half_widths: Vec::new(), colour: Rgba::INK }
    }
}

const OPACITY: f64 = 0.35;
const EDGE_PX: f64 = 1.0;

/// Draws bands cut at the frame of the map.
pub(crate) fn draw(page: &mut MapFrame, ribbons: &[Ribbon], legend: &mut Vec<Entry>) {
    for ribbon in ribbons {
        let low = PagePoint::new(page.left, page.top);
        let frame = Frame { low, high: low + PageVector::new(page.width(), page.height()) };
        let (mut areas, mut edges) = (PathBuilder::default(), PathBuilder::default());
        for run in runs(ribbon, page) {
            let sides = sides(&run);
            add_areas(&mut areas, &sides, &frame);
            add_edges(&mut edges, &sides, &frame);
        }
        if !areas.is_empty() {
            page.scene.fill(areas.finish(), ribbon.colour.with_opacity(OPACITY));
        }
        if !edges.is_empty() {
            // A white outline keeps edges visible on every colour of a map.
            let segments = edges.finish();
            page.scene.stroke(segments.clone(), Rgba::WHITE.with_opacity(0.8), 2.4 * EDGE_PX);
            page.scene.stroke(segments, ribbon.colour, EDGE_PX);
        }
        if !ribbon.label.is_empty() {
            let mark = Mark::Outlined(ribbon.colour.with_opacity(OPACITY), ribbon.colour);
            legend.push(Entry::of(mark, ribbon.label.clone()));
        }
    }
}

/// A point with half a width, in pixels.
type Station = (PagePoint, f64);

/// Uninterrupted parts of two or more different points, in pixels.
fn runs(ribbon: &Ribbon, page: &MapFrame) -> Vec<Vec<Station>> {
    // A wider band covers the map anyway, and much larger numbers would overflow.
    let most = (page.grid.width() + page.grid.height()) as f64;
    let stations = ribbon.points.iter().zip(&ribbon.half_widths).map(|(p, width)| {
        let near = p.x.abs() <= 4.0 * most && p.y.abs() <= 4.0 * most;
        (near && *width >= 0.0 && width.is_finite())
            .then(|| (page.point(*p), width.min(most) * page.smaller_side()))
    });
    let mut runs: Vec<Vec<Station>> = vec![Vec::new()];
    for station in stations {
        let run = runs.last_mut();
        match (station, run) {
            (Some(station), Some(run)) if run.last().is_none_or(|last| last.0 != station.0) => {
                run.push(station)
            }
            (Some(_), _) => {}
            (None, _) => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// Both borders at every point: left and right of the line as it runs.
fn sides(run: &[Station]) -> Vec<[PagePoint; 2]> {
    (0..run.len())
        .map(|i| {
            let (at, half) = run[i];
            let (before, after) = (run[i.saturating_sub(1)].0, run[(i + 1).min(run.len() - 1)].0);
            // A line that turns back on itself has no direction at its tip: take that of its last piece.
            let along = if after == before { at - before } else { after - before };
            let across = PageVector::new(along.y, -along.x) * (half / length(along));
            [at + across, at - across]
        })
        .collect()
}

/// The band as one outline while it neither folds nor leaves the map, otherwise piece by piece. All pieces have the
/// same orientation, so that overlapping ones do not cancel.
fn add_areas(path: &mut PathBuilder, sides: &[[PagePoint; 2]], frame: &Frame) {
    let mut outline: Vec<[PagePoint; 2]> = Vec::new();
    for pair in sides.windows(2) {
        let ([l0, r0], [l1, r1]) = (pair[0], pair[1]);
        let smooth = turn(l0, l1, r0) >= 0.0 && turn(r0, l1, r1) >= 0.0;
        if smooth && [l0, r0, l1, r1].iter().all(|p| frame.contains(*p)) {
            if outline.is_empty() {
                outline.push(pair[0]);
            }
            outline.push(pair[1]);
            continue;
        }
        close_outline(path, &mut outline);
        for triangle in [[l0, l1, r0], [r0, l1, r1]] {
            let [a, b, c] = triangle;
            let clockwise = if turn(a, b, c) < 0.0 { [c, b, a] } else { triangle };
            let piece = frame.cut(&clockwise);
            if piece.len() > 2 {
                path.polyline(&piece, true);
            }
        }
    }
    close_outline(path, &mut outline);
}

fn close_outline(path: &mut PathBuilder, outline: &mut Vec<[PagePoint; 2]>) {
    let there = outline.iter().map(|s| s[0]);
    let back = outline.iter().rev().map(|s| s[1]);
    path.polyline(&there.chain(back).collect::<Vec<_>>(), true);
    outline.clear();
}

/// Twice the area of a triangle, positive for clockwise on the page.
fn turn(a: PagePoint, b: PagePoint, c: PagePoint) -> f64 {
    (b - a).cross(c - a)
}

fn add_edges(path: &mut PathBuilder, sides: &[[PagePoint; 2]], frame: &Frame) {
    for side in 0..2 {
        let edge: Vec<PagePoint> = sides.iter().map(|s| s[side]).collect();
        for part in edge.split(|p| !frame.contains(*p)).filter(|part| part.len() > 1) {
            path.polyline(part, false);
        }
    }
}

/// A rectangle in pixels.
struct Frame {
    low: PagePoint,
    high: PagePoint,
}

impl Frame {
    fn contains(&self, p: PagePoint) -> bool {
        (self.low.x..=self.high.x).contains(&p.x) && (self.low.y..=self.high.y).contains(&p.y)
    }

    /// The part of a convex polygon within (Sutherland and Hodgman 1974).
    fn cut(&self, polygon: &[PagePoint]) -> Vec<PagePoint> {
        let Self { low, high } = *self;
        let polygon = cut_at(polygon, |p| p.x - low.x);
        let polygon = cut_at(&polygon, |p| high.x - p.x);
        let polygon = cut_at(&polygon, |p| p.y - low.y);
        cut_at(&polygon, |p| high.y - p.y)
    }
}

/// The part of a polygon where `depth`, a linear function, is not negative.
fn cut_at(polygon: &[PagePoint], depth: impl Fn(PagePoint) -> f64) -> Vec<PagePoint> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &from) in polygon.iter().enumerate() {
        let to = polygon[(i + 1) % polygon.len()];
        let (a, b) = (depth(from), depth(to));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a < 0.0) != (b < 0.0) {
            let t = a / (a - b);
            kept.push(from + (to - from) * t);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Item, Segment, Stroke};
    use crate::style::Style;
    use tigereye_core::{Grid, math};

    const CELL_PX: f64 = 20.0;

    /// Polygons and edges of a ribbon on 10 x 10 cells, back in cells.
    fn drawn(points: Vec<Point>, half_widths: Vec<f64>) -> (Vec<Vec<Point>>, usize, usize) {
        let mut page = {
            let grid = Grid::new(10, 10).expect("a grid");
            MapFrame::begin(grid, (&Style::default(), ""), [CELL_PX; 2], &|_| 0.0)
        };
        let ribbon = Ribbon { label: "band".to_owned(), points, half_widths, ..Ribbon::default() };
        let mut legend = Vec::new();
        draw(&mut page, &[ribbon], &mut legend);
        let (left, top) = (page.left, page.top);
        let in_cells = |p: PagePoint| Point::new((p.x - left) / CELL_PX - 0.5, (p.y - top) / CELL_PX - 0.5);
        let colour = Rgba::INK;
        let edge = Some(Stroke { colour, width_px: EDGE_PX, dash_px: Vec::new() });
        let (mut areas, mut edges) = (Vec::new(), 0);
        for item in page.scene.items {
            let Item::Path(path) = item else { panic!("only paths") };
            for segment in path.segments {
                match (path.fill.is_some(), segment) {
                    (true, Segment::Move(p)) => areas.push(vec![in_cells(p)]),
                    (true, Segment::Line(p)) => areas.last_mut().expect("begun").push(in_cells(p)),
                    (false, Segment::Move(_)) if path.stroke == edge => edges += 1,
                    _ => {}
                }
            }
        }
        (areas, edges, legend.len())
    }

    /// Signed area in square cells.
    fn area(polygon: &[Point]) -> f64 {
        let next = |i: usize| polygon[(i + 1) % polygon.len()];
        0.5 * (0..polygon.len()).map(|i| polygon[i].to_vector().cross(next(i).to_vector())).sum::<f64>()
    }

    /// Rounding of coordinates in cells.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_band_is_as_wide_as_asked_for() {
        let (areas, edges, legend) =
            drawn([(1.0, 4.0), (3.0, 4.0), (7.0, 4.0)].map(Point::from).to_vec(), vec![0.5, 1.0, 0.0]);
        assert_eq!((areas.len(), edges, legend), (1, 2, 1));
        // Two trapezia: 2 long, 1 and 2 wide; 4 long, 2 and 0 wide.
        assert!((area(&areas[0]) - (3.0 + 4.0)).abs() < ROUNDING);
        let heights: Vec<f64> = areas[0].iter().map(|p| p.y - 4.0).collect();
        for (height, expected) in heights.iter().zip([-0.5, -1.0, 0.0, 0.0, 1.0, 0.5]) {
            assert!((height - expected).abs() < ROUNDING, "{heights:?}");
        }
    }

    #[test]
    fn missing_points_and_widths_interrupt() {
        let line: Vec<Point> = (0..8).map(|i| Point::new(f64::from(i), 2.0)).collect();
        let mut widths = vec![0.5; 8];
        assert_eq!(drawn(line.clone(), widths.clone()).0.len(), 1);
        widths[3] = f64::NAN;
        assert_eq!(drawn(line.clone(), widths.clone()).0.len(), 2);
        widths[6] = -0.1;
        // A single point remains of the second part.
        assert_eq!(drawn(line.clone(), widths).0.len(), 2);
        assert_eq!(drawn(line.clone(), vec![0.5; 5]).0[0].len(), 10);
        let mut broken = line;
        broken[0] = Point::new(f64::NAN, 0.0);
        broken[7] = Point::new(f64::INFINITY, 0.0);
        assert_eq!(drawn(broken, vec![0.5; 8]).0[0].len(), 12);
        assert!(drawn(vec![Point::new(1.0, 1.0); 3], vec![0.5; 3]).0.is_empty());
        assert!(drawn(Vec::new(), vec![0.5; 3]).0.is_empty());
    }

    #[test]
    fn bands_end_at_the_frame() {
        // Half of a band of width 2 lies above the map, and its ends lie outside.
        let (areas, ..) = drawn([(-5.0, -0.5), (20.0, -0.5)].map(Point::from).to_vec(), vec![1.0, 1.0]);
        let total: f64 = areas.iter().map(|a| area(a)).sum();
        assert!((total - 10.0).abs() < ROUNDING, "{total}");
        let (areas, ..) = drawn([(2.0, 2.0), (7.0, 3.0)].map(Point::from).to_vec(), vec![f64::MAX, 1e30]);
        let total: f64 = areas.iter().map(|a| area(a)).sum();
        let within = |v: f64| (-0.5 - ROUNDING..=9.5 + ROUNDING).contains(&v);
        assert!(areas.iter().flatten().all(|p| within(p.x) && within(p.y)));
        assert!(total > 40.0 && total <= 100.0 + ROUNDING, "{total}");
    }

    #[test]
    fn folds_never_cancel() {
        // A bend much tighter than the band is wide: the inner border runs backwards.
        let bend: Vec<Point> = (0..=12)
            .map(|i| {
                let angle = math::PI * f64::from(i) / 12.0;
                Point::new(5.0 + 0.5 * math::cos(angle), 5.0 + 0.5 * math::sin(angle))
            })
            .collect();
        let (areas, ..) = drawn(bend, vec![2.0; 13]);
        assert!(areas.len() > 1);
        assert!(areas.iter().all(|a| area(a) > -ROUNDING));
        let back = drawn([(2.0, 5.0), (6.0, 5.0), (2.0, 5.0)].map(Point::from).to_vec(), vec![1.0; 3]).0;
        assert!(back.iter().all(|a| area(a) > -ROUNDING) && !back.is_empty());
    }
}
