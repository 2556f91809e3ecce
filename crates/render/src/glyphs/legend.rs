//! Legend entries of glyphs.

use super::arrows;
use super::kind::GlyphColour;
use super::layers::{COMPRESSION, DASH_PX, Layer, MIXED, TENSION};
use super::note::Note;
use super::turned;
use crate::colour::Rgba;
use crate::legend::{Entry, Mark};
use crate::scene::{PagePoint, PathBuilder, Scene};
use crate::shapes::Marker;
use tigereye_core::{Vector, math};

impl Note {
    pub(super) fn entry(self, colour: GlyphColour) -> Entry {
        let signed = |own: Rgba| if colour == GlyphColour::AxisSign { own } else { Rgba::MUTED };
        let filled = |own: Rgba| Mark::Outlined(own.with_opacity(0.35), own);
        match self {
            Self::Tension => Entry::of(filled(TENSION), "tension (both axes ≥ 0)"),
            Self::Compression => Entry::of(filled(COMPRESSION), "compression (both axes ≤ 0)"),
            Self::Mixed => Entry::of(filled(MIXED), "mixed signs (line colour: major axis)"),
            Self::PositiveLobe => {
                Entry::of(filled(signed(TENSION)), "filled: n·T n > 0 (tension), its size towards n")
            }
            Self::NegativeLobe => {
                let mark = Mark::Outlined(Rgba::WHITE, signed(COMPRESSION));
                Entry::of(mark, "hollow: n·T n < 0 (compression)")
            }
            Self::ArrowsOutwards => Entry::of(arrow(signed(TENSION), false), "tension along an axis"),
            Self::ArrowsInwards => Entry::of(arrow(signed(COMPRESSION), true), "compression along an axis"),
            Self::TurnedLeft => {
                Entry::of(sector(false, colour), "turned counter-clockwise onto the major axis")
            }
            Self::TurnedRight => Entry::of(sector(true, colour), "turned clockwise onto the major axis"),
            Self::Mirrored => {
                let dash_px = DASH_PX.to_vec();
                let line = Mark::Line { colour: Rgba::INK, width_px: 1.2, dash_px, marker: None };
                Entry::of(line, "mirrored (determinant < 0) at this line")
            }
            Self::SymmetricPart => Entry::of(Mark::None, "asymmetric tensors: symmetric part only"),
            Self::NoSymmetricPart => Entry::of(Mark::Ring(Rgba::MUTED), "zero, or no symmetric part"),
            Self::Zero => Entry::of(Mark::Ring(Rgba::MUTED), "zero tensor"),
            Self::Broken => Entry::of(Mark::Point(Marker::Cross, Rgba::NOT_FINITE), "tensor not finite"),
        }
    }
}

fn arrow(colour: Rgba, inwards: bool) -> Mark {
    let mut layer = Layer::default();
    arrows::add_axis(&mut layer, PagePoint::zero(), Vector::new(1.0, 0.0), 11.0, 5.0, inwards);
    let mut scene = Scene::sized(0.0, 0.0);
    layer.draw(&mut scene, colour);
    Mark::Drawing(scene.items)
}

fn sector(clockwise: bool, colour: GlyphColour) -> Mark {
    let span = math::radians(if clockwise { -50.0 } else { 50.0 });
    let mut path = PathBuilder::default();
    for end in [0.0, math::PI] {
        turned::add_sector(&mut path, PagePoint::zero(), 8.0, end - span, span);
    }
    let mut scene = Scene::sized(0.0, 0.0);
    if clockwise {
        turned::paint_right(&mut scene, path.finish(), colour);
    } else {
        turned::paint_left(&mut scene, path.finish(), colour);
    }
    let mut axis = PathBuilder::default();
    axis.line([-11.0, 0.0], [11.0, 0.0]);
    scene.stroke(axis.finish(), Rgba::MUTED, 0.7);
    Mark::Drawing(scene.items)
}
