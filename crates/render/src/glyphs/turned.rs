//! Ellipses of asymmetric tensors, with the rotation or reflection they contain.

use super::kind::GlyphColour;
use super::layers::{COMPRESSION, Layers, TENSION, Tone};
use super::note::Note;
use super::quadric;
use super::scaling::{Scaling, towards};
use crate::colour::Rgba;
use crate::scene::{PagePoint, PathBuilder, Scene, Segment};
use tigereye_core::{OrthogonalFactor, Svd, Symmetry, Tensor2, Vector, math, quarter_turned};

/// Radius of sectors, as a fraction of the larger semi-axis.
const SECTOR: f64 = 0.6;
/// Smaller angles are rounding errors, radians: the rotation of a tensor whose asymmetry is [`Symmetry::ROUNDING`] of
/// its size. The same holds for deviations from half a turn.
const NO_TURN_RAD: f64 = Symmetry::ROUNDING;

pub(super) fn add(layers: &mut Layers, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
    let svd = Svd::of(t);
    let reach = scaling.axes(&svd)[0];
    match OrthogonalFactor::of(t) {
        OrthogonalFactor::Rotation { angle_rad } => {
            quadric::add_outline(layers, centre, t, scaling, Tone::Plain);
            if angle_rad.abs() <= NO_TURN_RAD {
                return;
            }
            let angle_rad = if angle_rad < NO_TURN_RAD - math::PI { math::PI } else { angle_rad };
            let clockwise = angle_rad < 0.0;
            layers.notes.insert(if clockwise { Note::TurnedRight } else { Note::TurnedLeft });
            // A circle has no major axis.
            let end = if svd.axis_ratio() < 1.0 - 1e-9 { svd.phi_rad() } else { 0.0 };
            let path = &mut layers.sectors[usize::from(clockwise)];
            for end in [end, end + math::PI] {
                add_sector(path, centre, SECTOR * reach, end - angle_rad, angle_rad);
            }
        }
        OrthogonalFactor::Reflection { axis_rad } => {
            quadric::add_outline(layers, centre, t, scaling, Tone::Mixed);
            layers.notes.insert(Note::Mirrored);
            let axis = unit(axis_rad);
            layers.mirrors.line(towards(centre, axis, -reach), towards(centre, axis, reach));
        }
    }
}

fn unit(angle_rad: f64) -> Vector {
    Vector::new(math::cos(angle_rad), math::sin(angle_rad))
}

/// A sector of `span` radians, counter-clockwise where positive, from the direction `start`.
pub(super) fn add_sector(path: &mut PathBuilder, centre: PagePoint, radius: f64, start: f64, span: f64) {
    let pieces = (span.abs() / math::FRAC_PI_2).ceil().clamp(1.0, 4.0) as usize;
    let step = span / pieces as f64;
    // Distance of the control points of a cubic from the ends of its arc.
    let handle = 4.0 / 3.0 * math::tan(0.25 * step) * radius;
    let on_arc = |angle: f64| towards(centre, unit(angle), radius);
    let along = |p, angle: f64, length: f64| towards(p, quarter_turned(unit(angle)), length);
    path.move_to(centre);
    path.line_to(on_arc(start));
    for i in 0..pieces {
        let (from, to) = (start + step * i as f64, start + step * (i + 1) as f64);
        path.cubic_to(along(on_arc(from), from, handle), along(on_arc(to), to, -handle), on_arc(to));
    }
    path.close();
}

/// Colours of counter-clockwise and clockwise sectors; distinct only if colours have no other meaning.
pub(super) fn sector_colours(colour: GlyphColour) -> [Rgba; 2] {
    match colour {
        GlyphColour::AxisSign => [TENSION, COMPRESSION],
        GlyphColour::Anisotropy => [Rgba::INK, Rgba::INK],
    }
}

pub(super) fn paint_left(scene: &mut Scene, segments: Vec<Segment>, colour: GlyphColour) {
    let [left, _] = sector_colours(colour);
    scene.paint(segments, left.with_opacity(0.55), left, 0.8);
}

pub(super) fn paint_right(scene: &mut Scene, segments: Vec<Segment>, colour: GlyphColour) {
    let [_, right] = sector_colours(colour);
    scene.stroke(segments, right, 1.1);
}
