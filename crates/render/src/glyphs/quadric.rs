//! Ellipses, boxes and superquadrics: outlines about the semi-axes.

use super::kind::{GlyphColour, GlyphKind};
use super::layers::{Layers, Tone};
use super::note::Note;
use super::scaling::{Scaling, towards};
use crate::scene::{PagePoint, PageVector, PathBuilder};
use tigereye_core::{Anisotropy, AxisSign, Eigenvalues, Svd, Tensor2, is_totally_anisotropic, length, math};

pub(super) fn add(layers: &mut Layers, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
    let tone = tone(t);
    if layers.colour == GlyphColour::AxisSign {
        layers.notes.insert(match tone {
            Tone::Tension => Note::Tension,
            Tone::Compression => Note::Compression,
            _ => Note::Mixed,
        });
        add_signed_line(layers, centre, t, scaling);
    }
    add_outline(layers, centre, t, scaling, tone);
}

/// The outline with its major axis in the layer of `tone`; a segment for total anisotropy.
pub(super) fn add_outline(
    layers: &mut Layers,
    centre: PagePoint,
    t: &Tensor2,
    scaling: &Scaling,
    tone: Tone,
) {
    let kind = layers.kind;
    let layer = layers.layer(t, tone);
    let svd = Svd::of(t);
    let [a, b] = scaling.axes(&svd);
    let axis = svd.major();
    let (from, to) = major_axis(centre, &svd, scaling);
    if is_totally_anisotropic(t) {
        layer.segments.line(from, to);
        return;
    }
    // In pixels y points downwards; the minor axis is a quarter turn clockwise from the major one.
    let (major, minor) = (PageVector::new(axis.x, -axis.y) * a, PageVector::new(axis.y, axis.x) * b);
    match kind {
        GlyphKind::Box => rectangle(&mut layer.areas, centre, major, minor),
        GlyphKind::Superquadric { gamma } if has_major_axis(&svd) => {
            superellipse(&mut layer.areas, centre, major, minor, sharpness(t, gamma));
        }
        _ => layer.areas.ellipse(centre, major, minor),
    }
    if has_major_axis(&svd) {
        layer.lines.line(from, to);
    }
}

fn tone(t: &Tensor2) -> Tone {
    let signs = Eigenvalues::of(t).axis_signs();
    let has = |sign: AxisSign| signs.contains(&sign);
    match (has(AxisSign::Tension), has(AxisSign::Compression)) {
        (true, false) => Tone::Tension,
        (false, true) => Tone::Compression,
        _ => Tone::Mixed,
    }
}

/// For axes of opposite signs, a major axis in the colour of its own sign.
fn add_signed_line(layers: &mut Layers, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
    let eigenvalues = Eigenvalues::of(t);
    if eigenvalues.is_indefinite() && has_major_axis(&Svd::of(t)) {
        let major = eigenvalues.axis_signs()[0];
        let (from, to) = major_axis(centre, &Svd::of(t), scaling);
        layers.signed_lines[usize::from(major == AxisSign::Compression)].line(from, to);
    }
}

/// Whether the ellipse is not a circle.
fn has_major_axis(svd: &Svd) -> bool {
    svd.axis_ratio() < 1.0 - 1e-9
}

/// Both ends of the major axis in pixels.
fn major_axis(centre: PagePoint, svd: &Svd, scaling: &Scaling) -> (PagePoint, PagePoint) {
    let a = scaling.axes(svd)[0];
    (towards(centre, svd.major(), -a), towards(centre, svd.major(), a))
}

fn rectangle(path: &mut PathBuilder, centre: PagePoint, a: PageVector, b: PageVector) {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    path.polyline(&corners.map(|(u, v)| centre + a * u + b * v), true);
}

/// The exponent `e` of [`GlyphKind::Superquadric`].
fn sharpness(t: &Tensor2, gamma: f64) -> f64 {
    let gamma = if gamma.is_nan() { GlyphKind::GAMMA } else { gamma.clamp(0.0, 100.0) };
    math::pow(Anisotropy::of(t).spherical.clamp(0.0, 1.0), gamma)
}

/// `|u|^(2/e) + |v|^(2/e) = 1` with u along `a` and v along `b`, as straight pieces.
fn superellipse(path: &mut PathBuilder, centre: PagePoint, a: PageVector, b: PageVector, e: f64) {
    // Straight pieces per eighth of a turn: their error is a few hundredths of a pixel.
    let pieces = (1.5 * length(a).sqrt()).ceil().clamp(3.0, 24.0) as usize;
    let points: Vec<PagePoint> = (0..8 * pieces)
        .map(|i| {
            let angle = math::FRAC_PI_4 * i as f64 / pieces as f64;
            let (c, s) = (math::cos(angle), math::sin(angle));
            let r = superellipse_radius(c.abs(), s.abs(), 2.0 / e);
            centre + a * (r * c) + b * (r * s)
        })
        .collect();
    path.polyline(&points, true);
}

/// Distance of `|u|^p + |v|^p = 1` from its centre in the direction of the unit vector (c, s), both >= 0.
fn superellipse_radius(c: f64, s: f64, p: f64) -> f64 {
    // The larger one taken out keeps powers finite for every p, infinity included.
    let (large, small) = (c.max(s), c.min(s));
    math::pow(1.0 + math::pow(small / large, p), -1.0 / p) / large
}
