//! Degenerate points and separatrices.

use super::{Placement, counts, line_overlay, plain_options, point_overlays, push_line, push_story};
use serde_json::{Value, json};
use tigereye_core::{Field, Tensor2};
use tigereye_io::PolyData;
use tigereye_lines::{DegeneratePoint, Family, LineEnd, LineOptions, TensorLine, Topology, evenly_spaced};
use tigereye_lines::{Followed, Following};
use tigereye_render::{Overlay, PlainOptions, Rgba, Scene, plain_map};

/// The skeleton of a field.
#[must_use]
pub fn topology(
    field: &Field<Tensor2>,
    following: Following,
    families: &[Family],
    options: &LineOptions,
) -> Topology {
    let followed = Followed::new(field, following);
    Topology::of(&followed.interpolated(), families, options)
}

/// Points and separatrices over thin lines of the same axes.
#[must_use]
pub fn picture(
    topology: &Topology,
    field: &Field<Tensor2>,
    following: Following,
    families: &[Family],
    options: PlainOptions,
) -> Scene {
    let longest = following.longer_side(field.grid());
    let mut overlays = Vec::new();
    for &family in families {
        let lines: Vec<&TensorLine> =
            topology.separatrices.iter().filter(|s| s.family == family).map(|s| &s.line).collect();
        let line_options = LineOptions { step: 0.2, length: longest, ..LineOptions::default() };
        let followed = Followed::new(field, following);
        let around =
            evenly_spaced(&followed.interpolated(), family, (longest / LINES_A_SIDE).max(0.5), &line_options);
        let label = format!("{} lines: {}", family.name(), following.axes.words());
        overlays.push(Overlay { colour: CONTEXT, width_px: 0.8, ..line_overlay(&around, family, &label) });
        if !lines.is_empty() {
            let label = format!("separatrices of the {} axis", family.name());
            overlays.push(Overlay { width_px: 1.8, ..line_overlay(lines, family, &label) });
        }
    }
    overlays.extend(point_overlays(&topology.points));
    overlays.extend(options.overlays.iter().cloned());
    let options = PlainOptions { overlays, ..options };
    let description = "Degenerate points and separatrices";
    plain_map(field.grid(), &plain_options(field, following, description, options))
}

/// Distance of the thin lines in parts of the longer side.
const LINES_A_SIDE: f64 = 40.0;
/// Their colour.
const CONTEXT: Rgba = Rgba::hex(0xb4b4b4);

/// Points as vertices and separatrices as lines. Cell arrays: `half_turns` (twice the index; for a line that of its
/// point), and `family` (0 major, 1 minor, -1 for points).
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

/// The skeleton for machines: the axes it is of, positions in cells (y downwards), indices, and where separatrices
/// lead.
#[must_use]
pub fn summary(topology: &Topology, following: Following) -> Value {
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
        .map(|p| json!({ "x": p.position.x, "y": p.position.y, "index": 0.5 * f64::from(p.half_turns()) }))
        .collect();
    let separatrices: Vec<Value> = topology
        .separatrices
        .iter()
        .map(|s| {
            json!({
                "point": s.point,
                "family": s.family.name(),
                "length": s.line.length(following.cell),
                "end": end(s.line.ends[1]),
            })
        })
        .collect();
    let sum = 0.5 * f64::from(topology.points.iter().map(DegeneratePoint::half_turns).sum::<i32>());
    json!({
        "axes": following.axes.axes().name(),
        "major": following.axes.major().name(),
        "points": points,
        "separatrices": separatrices,
        "index_sum": sum,
    })
}
