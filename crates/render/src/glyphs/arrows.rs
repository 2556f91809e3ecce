//! Principal axes as arrows, as structural mechanics draws stresses.

use super::layers::{Layer, Layers, Tone};
use super::note::Note;
use super::scaling::{Scaling, towards};
use super::signed::NEGLIGIBLE;
use crate::scene::PagePoint;
use tigereye_core::{PrincipalAxes, Tensor2, Vector, quarter_turned};

/// Length of a head as a fraction of the length that fills a cell, limited to [`MOST_OF_AXIS`] of its axis.
const HEAD: f64 = 0.36;
const MOST_OF_AXIS: f64 = 0.7;
/// Half width of a head by its length.
const SLENDER: f64 = 0.5;

pub(super) fn add(layers: &mut Layers, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
    let axes = PrincipalAxes::of(t);
    let size = axes.values[0].abs().max(axes.values[1].abs());
    for (value, axis) in axes.values.into_iter().zip([axes.first, axes.second()]) {
        if value.abs() <= NEGLIGIBLE * size {
            continue;
        }
        let (tone, note) = if value > 0.0 {
            (Tone::Tension, Note::ArrowsOutwards)
        } else {
            (Tone::Compression, Note::ArrowsInwards)
        };
        layers.notes.insert(note);
        let length = scaling.length(value.abs(), size);
        let head = (HEAD * scaling.radius).min(MOST_OF_AXIS * length);
        add_axis(layers.layer(t, tone), centre, axis, length, head, value < 0.0);
    }
}

/// A line with two heads that reaches `length` pixels from `centre` to both sides.
pub(super) fn add_axis(
    layer: &mut Layer,
    centre: PagePoint,
    axis: Vector,
    length: f64,
    head: f64,
    inwards: bool,
) {
    layer.segments.line(towards(centre, axis, head - length), towards(centre, axis, length - head));
    let across = quarter_turned(axis);
    for sign in [-1.0, 1.0] {
        let (outer, inner) = (sign * length, sign * (length - head));
        let (tip, base) = if inwards { (inner, outer) } else { (outer, inner) };
        let base = towards(centre, axis, base);
        let half = SLENDER * head;
        let corners = [towards(centre, axis, tip), towards(base, across, half), towards(base, across, -half)];
        layer.heads.polyline(&corners, true);
    }
}
