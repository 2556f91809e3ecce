//! Degenerate points and separatrices.

use super::{Followed, Placement, counts, family_name, line_overlay, point_overlays, push_line, push_story};
use serde_json::{Value, json};
use tigereye_core::{Field, Tensor2};
use tigereye_io::PolyData;
use tigereye_lines::{Axes, Family, LineEnd, LineOptions, TensorLine, Topology};
use tigereye_render::{OrientationOptions, Scene, orientation_map};

/// The skeleton of a field.
#[must_use]
pub fn topology(field: &Field<Tensor2>, axes: Axes, families: &[Family], options: &LineOptions) -> Topology {
    let followed = Followed::new(field, axes);
    Topology::of(&followed.interpolated(), families, options)
}

/// Points and separatrices over the directions of the major half-axis.
#[must_use]
pub fn picture(topology: &Topology, field: &Field<Tensor2>, title: &str) -> Scene {
    let mut overlays = Vec::new();
    for family in [Family::Major, Family::Minor] {
        let lines: Vec<&TensorLine> =
            topology.separatrices.iter().filter(|s| s.family == family).map(|s| &s.line).collect();
        if !lines.is_empty() {
            let label = format!("separatrices of the {} axis", family_name(family));
            let mut overlay = line_overlay(lines, family, &label);
            overlay.width_px = 1.6;
            overlays.push(overlay);
        }
    }
    overlays.extend(point_overlays(&topology.points));
    orientation_map(
        field,
        &OrientationOptions { title: title.to_owned(), overlays, ..OrientationOptions::default() },
    )
}

/// Points as vertices and separatrices as lines. Cell arrays: `half_turns` (twice the index; for a line that of its point), and
/// `family` (0 major, 1 minor, -1 for points).
#[must_use]
pub fn poly_data(topology: &Topology, placement: &Placement, story: &str) -> PolyData {
    let mut data = PolyData::default();
    let (mut turns, mut families) = (Vec::new(), Vec::new());
    for (i, point) in topology.points.iter().enumerate() {
        data.points.push(placement.place(point.position));
        data.verts.push([i]);
        turns.push(point.half_turns());
        families.push(-1);
    }
    for separatrix in &topology.separatrices {
        push_line(&mut data, separatrix.line.points.iter().map(|p| placement.place(*p)));
        turns.push(topology.points[separatrix.point].half_turns());
        families.push(separatrix.family as i32);
    }
    data.cell_arrays = vec![counts("half_turns", turns), counts("family", families)];
    push_story(&mut data, story);
    data
}

/// The skeleton for machines: positions in cells (y downwards), indices, and where separatrices lead.
#[must_use]
pub fn summary(topology: &Topology) -> Value {
    let end = |end: LineEnd| match end {
        LineEnd::Border => "border",
        LineEnd::Degenerate => "degenerate",
        LineEnd::Length => "length",
        LineEnd::Closed => "closed",
        LineEnd::Stopped => "stopped",
    };
    let points: Vec<Value> = topology
        .points
        .iter()
        .map(|p| json!({ "x": p.position[0], "y": p.position[1], "index": 0.5 * f64::from(p.half_turns()) }))
        .collect();
    let separatrices: Vec<Value> = topology
        .separatrices
        .iter()
        .map(|s| {
            json!({
                "point": s.point,
                "family": family_name(s.family),
                "length": s.line.length(),
                "end": end(s.line.ends[1]),
            })
        })
        .collect();
    let sum: f64 = topology.points.iter().map(|p| 0.5 * f64::from(p.half_turns())).sum();
    json!({ "points": points, "separatrices": separatrices, "index_sum": sum })
}
