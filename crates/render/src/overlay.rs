//! Points and lines over maps.

use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::map_frame::MapFrame;
use crate::scene::{PagePoint, PathBuilder};
use crate::shapes::Marker;
use tigereye_core::{Cell, Point};

/// Something drawn over a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Label in the legend; if empty, the overlay does not appear there.
    pub label: String,
    /// The points. One that is not finite or not on the map interrupts the line, so that one overlay holds many lines.
    pub points: Vec<Point>,
    /// Marker of every point; `None` draws a line through the points.
    pub marker: Option<Marker>,
    /// Colour.
    pub colour: Rgba,
    /// Width of a line in pixels.
    pub width_px: f64,
}

impl Default for Overlay {
    fn default() -> Self {
        Self { label: String::new(), points: Vec::new(), marker: None, colour: Rgba::INK, width_px: 1.8 }
    }
}

const SOURCE: Rgba = Rgba::hex(0xd55e00);

pub(crate) fn draw(page: &mut MapFrame, overlays: &[Overlay], legend: &mut Vec<Entry>) {
    for overlay in overlays {
        let mark = match overlay.marker {
            Some(marker) => {
                draw_points(page, overlay, marker);
                Mark::Point(marker, overlay.colour)
            }
            None => {
                draw_lines(page, overlay);
                let width_px = overlay.width_px;
                Mark::Line { colour: overlay.colour, width_px, dash_px: Vec::new(), marker: None }
            }
        };
        if !overlay.label.is_empty() {
            legend.push(Entry::of(mark, overlay.label.clone()));
        }
    }
}

fn on_map(page: &MapFrame, p: &Point) -> bool {
    let (width, height) = (page.grid.width() as f64, page.grid.height() as f64);
    (-0.5..=width - 0.5).contains(&p.x) && (-0.5..=height - 0.5).contains(&p.y)
}

fn draw_points(page: &mut MapFrame, overlay: &Overlay, marker: Marker) {
    let radius = (0.3 * page.smaller_side()).clamp(2.5, 5.0);
    for p in overlay.points.iter().filter(|p| on_map(page, p)).collect::<Vec<_>>() {
        let at = page.point(*p);
        marker.draw(&mut page.scene, at, radius, overlay.colour);
    }
}

/// Lines with a white outline, visible on every colour of a map.
fn draw_lines(page: &mut MapFrame, overlay: &Overlay) {
    let mut path = PathBuilder::default();
    for run in overlay.points.split(|p| !on_map(page, p)) {
        let points: Vec<PagePoint> = run.iter().map(|p| page.point(*p)).collect();
        path.polyline(&points, false);
    }
    if path.is_empty() {
        return;
    }
    let segments = path.finish();
    page.scene.stroke(segments.clone(), Rgba::WHITE.with_opacity(0.9), 2.0 * overlay.width_px);
    page.scene.stroke(segments, overlay.colour, overlay.width_px);
}

/// Marks cells with stars; `name` says what one of them is.
pub(crate) fn draw_sources(page: &mut MapFrame, sources: &[Cell], name: &str, legend: &mut Vec<Entry>) {
    for source in sources.iter().filter(|s| page.grid.contains(**s)).collect::<Vec<_>>() {
        let (at, radius) = (page.centre(*source), (0.38 * page.smaller_side()).clamp(4.0, 8.0));
        Marker::Star.draw(&mut page.scene, at, radius, SOURCE);
    }
    if !sources.is_empty() {
        let text = if sources.len() == 1 { name.to_owned() } else { format!("{name}s") };
        legend.push(Entry::of(Mark::Point(Marker::Star, SOURCE), text));
    }
}
