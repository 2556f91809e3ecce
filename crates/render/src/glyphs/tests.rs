//! Laws of glyphs.

use super::layers::{Layer, Layers};
use super::note::Note;
use super::{GlyphColour, GlyphKind, GlyphOptions, GlyphScale, Scaling, glyphs};
use crate::colour::ColourMap;
use crate::scene::{PagePoint, Segment};
use tigereye_core::{
    Field, Grid, OrthogonalFactor, PhysicalPoint, PrincipalAxes, Svd, Tensor2, Vector, length, math,
    quarter_turned,
};

/// Semi-axis of every glyph here, pixels.
const REACH: f64 = 100.0;
/// Rounding of coordinates of some hundred pixels, made of a few dozen operations; square roots of rounded zeros are
/// the worst. Pixels.
const ROUNDING_PX: f64 = 1e-5;

const SUPERQUADRIC: GlyphKind = GlyphKind::Superquadric { gamma: GlyphKind::GAMMA };
const KINDS: [GlyphKind; 7] = [
    GlyphKind::Ellipse,
    GlyphKind::Box,
    SUPERQUADRIC,
    GlyphKind::Superquadric { gamma: 100.0 },
    GlyphKind::Signed,
    GlyphKind::Arrows,
    GlyphKind::Asymmetric,
];

fn drawn(kind: GlyphKind, t: &Tensor2) -> Layers {
    let scaling = Scaling { kind: GlyphScale::Glyph, largest: kind.size(t), radius: REACH };
    let mut layers = Layers::of(kind, GlyphColour::AxisSign, ColourMap::Batlow);
    layers.add(PagePoint::zero(), t, &scaling);
    layers
}

/// Corners and ends of curves in the frame of the tensor.
fn points(segments: Vec<Segment>) -> Vec<PhysicalPoint> {
    let ends = segments.into_iter().filter_map(|segment| match segment {
        Segment::Move(p) | Segment::Line(p) | Segment::Quad(_, p) | Segment::Cubic(_, _, p) => Some(p),
        Segment::Close => None,
    });
    ends.map(|p| PhysicalPoint::new(p.x, -p.y)).collect()
}

fn parts(layer: Layer) -> [Vec<PhysicalPoint>; 5] {
    [layer.areas, layer.hollow, layer.lines, layer.segments, layer.heads].map(|p| points(p.finish()))
}

fn all_points(kind: GlyphKind, t: &Tensor2) -> Vec<PhysicalPoint> {
    let layers = drawn(kind, t);
    let marks = layers.sectors.into_iter().chain([layers.mirrors]).flat_map(|p| points(p.finish()));
    let mut all: Vec<_> = marks.collect();
    for layer in layers.tones {
        all.extend(parts(layer).concat());
    }
    all
}

fn extent(points: &[PhysicalPoint], along: Vector) -> f64 {
    points.iter().map(|p| p.to_vector().dot(along)).fold(f64::NEG_INFINITY, f64::max)
}

/// Largest distance of a point of one set from the other set.
fn apart(a: &[PhysicalPoint], b: &[PhysicalPoint]) -> f64 {
    let from = |a: &[PhysicalPoint], b: &[PhysicalPoint]| {
        let nearest = |p: &PhysicalPoint| b.iter().map(|q| length(*p - *q)).fold(f64::INFINITY, f64::min);
        a.iter().map(nearest).fold(0.0, f64::max)
    };
    from(a, b).max(from(b, a))
}

/// `Q t Q^T` for the rotation Q by `angle`.
fn rotated(t: &Tensor2, angle: f64) -> Tensor2 {
    let (c, s) = (math::cos(angle), math::sin(angle));
    let [p, q, r, u] = t.components();
    let [a, b, d, e] = [c * p - s * r, c * q - s * u, s * p + c * r, s * q + c * u];
    Tensor2::new(a * c - b * s, a * s + b * c, d * c - e * s, d * s + e * c)
}

fn samples() -> Vec<Tensor2> {
    vec![
        Tensor2::symmetric(3.0, 0.4, 1.0),
        Tensor2::symmetric(-3.0, 1.0, -0.9),
        Tensor2::symmetric(2.0, 0.7, -1.0),
        Tensor2::from_eigen(0.3, 1.0, 0.0),
        Tensor2::from_axes(1.1, 4.0, 1.5),
        Tensor2::new(0.3, -2.0, 1.0, 0.1),
        Tensor2::new(0.5, 3.0, 0.2, -1.0),
    ]
}

#[test]
fn quadrics_reach_their_semi_axes() {
    let t = Tensor2::from_axes(0.4, 3.0, 2.0);
    let svd = Svd::of(&t);
    let major = svd.major();
    for kind in [GlyphKind::Ellipse, GlyphKind::Box, SUPERQUADRIC, GlyphKind::Asymmetric] {
        let points = all_points(kind, &t);
        let minor = quarter_turned(major);
        assert!((extent(&points, major) - REACH).abs() < ROUNDING_PX, "{kind:?}");
        assert!((extent(&points, minor) - REACH * 2.0 / 3.0).abs() < ROUNDING_PX, "{kind:?}");
    }
}

#[test]
fn signed_glyphs_and_arrows_reach_the_principal_values() {
    for t in samples() {
        let axes = PrincipalAxes::of(&t);
        let size = axes.values[0].abs().max(axes.values[1].abs());
        for kind in [GlyphKind::Signed, GlyphKind::Arrows] {
            let points = all_points(kind, &t);
            for (value, axis) in axes.values.into_iter().zip([axes.first, axes.second()]) {
                // Lobes of the other axis are broad: only points on this one count.
                let beside = |p: &PhysicalPoint| p.to_vector().cross(axis).abs();
                let own: Vec<_> = points.iter().filter(|p| beside(p) < 1e-3).copied().collect();
                // Heads that point inwards have no point on the axis at their outer end.
                let reached = if kind == GlyphKind::Arrows && value < 0.0 {
                    let across: Vec<_> = points.iter().filter(|p| beside(p) < 0.2 * REACH).copied().collect();
                    extent(&across, axis)
                } else {
                    extent(&own, axis).max(0.0)
                };
                let expected = REACH * value.abs() / size;
                assert!((reached - expected).abs() < ROUNDING_PX, "{kind:?} {t:?}: {reached}, {expected}");
            }
        }
    }
}

#[test]
fn glyphs_turn_with_their_tensors() {
    for t in samples() {
        for kind in KINDS {
            let angle: f64 = 0.83;
            let (c, s) = (math::cos(angle), math::sin(angle));
            let rotate = |p: PhysicalPoint| PhysicalPoint::new(c * p.x - s * p.y, s * p.x + c * p.y);
            let before: Vec<_> = all_points(kind, &t).into_iter().map(rotate).collect();
            let after = all_points(kind, &rotated(&t, angle));
            let off = apart(&before, &after);
            assert!(off < ROUNDING_PX, "{kind:?} of {t:?}: off by {off} px");
        }
    }
}

#[test]
fn isotropic_superquadrics_are_circles() {
    for t in [Tensor2::isotropic(2.0), Tensor2::isotropic(-0.1), Tensor2::new(0.0, 1.0, -1.0, 0.0)] {
        let path = |kind| drawn(kind, &t).tones.map(parts);
        assert_eq!(path(SUPERQUADRIC), path(GlyphKind::Ellipse));
    }
}

#[test]
fn superquadrics_lie_between_ellipse_and_box_and_become_boxier() {
    let diagonal = |kind, ratio: f64| {
        let t = Tensor2::symmetric(1.0, 0.0, ratio);
        // The corner of the box is (1, 1) in units of the semi-axes.
        let along = |p: &PhysicalPoint| (p.x + p.y / ratio) / (2.0 * REACH);
        all_points(kind, &t).iter().map(along).fold(0.0, f64::max)
    };
    let round = core::f64::consts::FRAC_1_SQRT_2;
    let mut last = round;
    for ratio in [0.9, 0.7, 0.5, 0.3, 0.1] {
        let corner = diagonal(SUPERQUADRIC, ratio);
        assert!(corner > last && corner < 1.0, "{ratio}: {corner} after {last}");
        // At equal shares of both semi-axes each is 2^(-e/2).
        let e = math::pow(2.0 * ratio / (1.0 + ratio), 3.0);
        assert!((corner - math::pow(2.0, -0.5 * e)).abs() < 1e-12);
        last = corner;
    }
    let ellipse = diagonal(GlyphKind::Superquadric { gamma: 0.0 }, 0.5);
    assert!((ellipse - round).abs() < 1e-12);
    assert!((diagonal(GlyphKind::Box, 0.5) - 1.0).abs() < 1e-12);
    let broken = diagonal(GlyphKind::Superquadric { gamma: f64::NAN }, 0.5);
    assert_eq!(broken, diagonal(SUPERQUADRIC, 0.5));
}

#[test]
fn opposite_tensors_have_the_same_lobes_with_signs_swapped() {
    for t in samples() {
        let [tension, compression, ..] = drawn(GlyphKind::Signed, &t).tones.map(parts);
        let [opposite_tension, opposite_compression, ..] =
            drawn(GlyphKind::Signed, &t.scaled(-1.0)).tones.map(parts);
        let swapped = apart(&tension[0], &opposite_compression[1]);
        assert!(swapped < ROUNDING_PX, "{t:?}: {swapped}");
        assert!(apart(&compression[1], &opposite_tension[0]) < ROUNDING_PX);
        assert!(tension[1].is_empty() && compression[0].is_empty());
    }
}

#[test]
fn lobes_are_the_normal_component() {
    for t in samples() {
        let size = GlyphKind::Signed.size(&t);
        for PhysicalPoint { x, y, .. } in all_points(GlyphKind::Signed, &t) {
            let r = math::hypot(x, y);
            if r > ROUNDING_PX {
                let [n, m] = [x / r, y / r];
                let normal = t.xx() * n * n + (t.xy() + t.yx()) * n * m + t.yy() * m * m;
                assert!((r - REACH * normal.abs() / size).abs() < ROUNDING_PX);
            }
        }
    }
}

#[test]
fn arrows_do_not_see_the_antisymmetric_part() {
    for t in samples() {
        let arrows = |t| drawn(GlyphKind::Arrows, t).tones.map(parts);
        assert_eq!(arrows(&t), arrows(&t.transposed()));
    }
}

#[test]
fn heads_point_outwards_for_tension_and_inwards_for_compression() {
    let [tension, compression, ..] =
        drawn(GlyphKind::Arrows, &Tensor2::symmetric(1.0, 0.0, -1.0)).tones.map(parts);
    let tips = |heads: &[PhysicalPoint]| heads.iter().step_by(3).copied().collect::<Vec<_>>();
    assert_eq!(extent(&tips(&tension[4]), Vector::new(1.0, 0.0)), REACH);
    assert_eq!(extent(&tension[4], Vector::new(1.0, 0.0)), REACH);
    assert!(extent(&tips(&compression[4]), Vector::new(0.0, 1.0)) < 0.7 * REACH);
    assert_eq!(extent(&compression[4], Vector::new(0.0, 1.0)), REACH);
}

#[test]
fn sectors_span_the_rotation_and_end_at_the_major_axis() {
    for (turn, stretch) in [(0.7, [3.0, 1.0]), (-2.1, [2.0, 0.3]), (3.0, [1.0, 0.0]), (-0.2, [1.0, 0.9])] {
        // P R with P along 0.4 radians.
        let (p, c, s) = (Tensor2::from_eigen(0.4, stretch[0], stretch[1]), math::cos(turn), math::sin(turn));
        let t = Tensor2::new(
            p.xx() * c + p.xy() * s,
            p.xy() * c - p.xx() * s,
            p.yx() * c + p.yy() * s,
            p.yy() * c - p.yx() * s,
        );
        let layers = drawn(GlyphKind::Asymmetric, &t);
        assert!(layers.mirrors.is_empty());
        let [left, right] = layers.sectors.map(|p| points(p.finish()));
        let (own, other) = if turn > 0.0 { (left, right) } else { (right, left) };
        assert!(other.is_empty());
        let pieces = own.len() / 2;
        let angle = |p: PhysicalPoint| math::atan2(p.y, p.x);
        let (start, end) = (angle(own[1]), angle(own[pieces - 1]));
        let same = |a: f64, b: f64, period: f64| math::sin((a - b) * math::PI / period).abs() < 1e-9;
        assert!(same(end, 0.4, math::PI), "{turn}: ends at {end}");
        assert!(same(end - start, turn, math::TAU), "{turn}: from {start} to {end}");
    }
}

#[test]
fn reflections_show_the_line_they_keep_and_symmetric_tensors_no_rotation() {
    let t = Tensor2::new(0.5, 3.0, 0.2, -1.0);
    let OrthogonalFactor::Reflection { axis_rad } = OrthogonalFactor::of(&t) else {
        panic!("a negative determinant")
    };
    let layers = drawn(GlyphKind::Asymmetric, &t);
    assert_eq!(layers.notes.into_iter().collect::<Vec<_>>(), [Note::Mirrored]);
    let [a, b] = points(layers.mirrors.finish())[..] else { panic!("one line") };
    let direction = math::atan2(b.y - a.y, b.x - a.x);
    assert!(math::sin(direction - axis_rad).abs() < 1e-9);
    let plain = drawn(GlyphKind::Asymmetric, &Tensor2::symmetric(3.0, 1.0, 2.0));
    assert!(plain.mirrors.is_empty() && plain.sectors.iter().all(|p| p.is_empty()));
    assert!(plain.notes.is_empty());
}

#[test]
fn legends_name_only_what_occurs() {
    let notes = |kind, t: Tensor2| drawn(kind, &t).notes.into_iter().collect::<Vec<_>>();
    let (pulled, pressed) = (Tensor2::symmetric(2.0, 0.0, 1.0), Tensor2::symmetric(-2.0, 0.0, -1.0));
    assert_eq!(notes(GlyphKind::Ellipse, pulled), [Note::Tension]);
    assert_eq!(notes(GlyphKind::Box, pressed), [Note::Compression]);
    assert_eq!(notes(GlyphKind::Signed, pulled), [Note::PositiveLobe]);
    assert_eq!(notes(GlyphKind::Signed, pressed), [Note::NegativeLobe]);
    assert_eq!(notes(GlyphKind::Arrows, pulled), [Note::ArrowsOutwards]);
    // One axis is rounding.
    let line = Tensor2::new(1.0, 0.0, 1e-17, -1e-17);
    assert_eq!(notes(GlyphKind::Arrows, line), [Note::ArrowsOutwards]);
    assert_eq!(notes(GlyphKind::Signed, line), [Note::PositiveLobe]);
    let turning = Tensor2::new(0.0, -1.0, 1.0, 0.0);
    assert_eq!(notes(GlyphKind::Arrows, turning), [Note::SymmetricPart, Note::NoSymmetricPart]);
    assert_eq!(notes(GlyphKind::Asymmetric, turning), [Note::TurnedLeft]);
    let scaling = Scaling { kind: GlyphScale::Glyph, largest: 1.0, radius: REACH };
    for both in [[Tensor2::ZERO, turning], [turning, Tensor2::ZERO]] {
        let mut layers = Layers::of(GlyphKind::Arrows, GlyphColour::AxisSign, ColourMap::Batlow);
        both.iter().for_each(|t| layers.add(PagePoint::zero(), t, &scaling));
        let notes: Vec<Note> = layers.notes.into_iter().collect();
        assert_eq!(notes, [Note::SymmetricPart, Note::NoSymmetricPart]);
    }
    for kind in KINDS {
        assert_eq!(notes(kind, Tensor2::ZERO), [Note::Zero]);
        assert_eq!(notes(kind, Tensor2::new(1.0, f64::NAN, 0.0, 1.0)), [Note::Broken]);
    }
}

#[test]
fn glyphs_stay_within_their_cells() {
    for kind in KINDS {
        for i in 0..24 {
            let angle = math::PI * f64::from(i) / 24.0;
            for other in [-1.0, -0.9, -0.3, 0.0, 0.04, 0.3, 0.6, 0.9, 1.0] {
                let reached = |t: &Tensor2| {
                    let points = all_points(kind, t);
                    points.iter().fold(0.0, |m: f64, p| m.max(p.x.abs()).max(p.y.abs())) / REACH
                        * kind.radius()
                };
                // Of the distance to the next glyph; lines have a width, too.
                for t in [Tensor2::from_eigen(angle, 1.0, other), Tensor2::from_axes(angle, 1.0, other)] {
                    assert!(reached(&t) < 0.48, "{kind:?} of {t:?} reaches {}", reached(&t));
                }
            }
        }
    }
}

#[test]
fn awkward_tensors_give_finite_coordinates() {
    let numbers = [0.0, -0.0, 1.0, -1.0, 1e-300, -5e-324, 1e300, f64::MAX, f64::MIN, f64::INFINITY, f64::NAN];
    let all: Vec<Tensor2> = numbers
        .iter()
        .flat_map(|a| numbers.iter().map(move |b| (*a, *b)))
        .flat_map(|(a, b)| {
            [Tensor2::new(a, b, 1.0, -1.0), Tensor2::new(a, -1.0, b, a), Tensor2::symmetric(a, b, a)]
        })
        .collect();
    let grid = Grid::new(all.len(), 1).expect("a grid");
    let field = Field::from_values(grid, all.clone()).expect("a field");
    for kind in KINDS {
        for scale in [GlyphScale::Field, GlyphScale::SquareRoot, GlyphScale::Glyph] {
            for colour in [GlyphColour::AxisSign, GlyphColour::Anisotropy] {
                let options = GlyphOptions { kind, scale, colour, every: Some(1), ..GlyphOptions::default() };
                let svg = glyphs(&field, &options).to_svg().expect("a drawing");
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{kind:?} {scale:?} {colour:?}");
            }
        }
        for t in &all {
            assert!(all_points(kind, t).iter().all(|p| p.is_finite()), "{kind:?} of {t:?}");
        }
    }
}
