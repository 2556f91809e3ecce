//! Lines and degenerate points as overlays of maps.

use tigereye_core::Point;
use tigereye_lines::{DegeneratePoint, Family, TensorLine};
use tigereye_render::{Marker, Overlay, Rgba};

/// Colours of the two families; dark enough for every map.
const MAJOR: Rgba = Rgba::hex(0x262626);
const MINOR: Rgba = Rgba::hex(0x8a5a00);
const POINTS: Rgba = Rgba::hex(0xd55e00);

/// Lines of one family; the label is empty if only one family is drawn.
#[must_use]
pub fn line_overlay<'a>(
    lines: impl IntoIterator<Item = &'a TensorLine>,
    family: Family,
    label: &str,
) -> Overlay {
    let mut points = Vec::new();
    for line in lines {
        points.extend_from_slice(&line.points);
        points.push(Point::splat(f64::NAN));
    }
    let colour = if family == Family::Major { MAJOR } else { MINOR };
    Overlay { label: label.to_owned(), points, colour, width_px: 1.0, ..Overlay::default() }
}

/// Degenerate points by their kind; kinds that do not occur have no overlay.
#[must_use]
pub fn point_overlays(points: &[DegeneratePoint]) -> Vec<Overlay> {
    let kinds = [
        ("wedge (index 1/2)", Marker::Circle, Some(1)),
        ("trisector (index −1/2)", Marker::Triangle, Some(-1)),
        ("several merged, other index", Marker::Diamond, None),
    ];
    let mut overlays = Vec::new();
    for (label, marker, turns) in kinds {
        let is_kind = |n: i32| turns.map_or(n.abs() != 1, |t| n == t);
        let positions = points.iter().filter(|p| is_kind(p.half_turns())).map(|p| p.position);
        let points: Vec<Point> = positions.collect();
        if !points.is_empty() {
            let (label, marker) = (label.to_owned(), Some(marker));
            overlays.push(Overlay { label, points, marker, colour: POINTS, ..Overlay::default() });
        }
    }
    overlays
}
