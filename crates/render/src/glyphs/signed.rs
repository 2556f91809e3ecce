//! The normal component of a tensor in every direction, its sign shown.

use super::layers::{Layers, Tone};
use super::note::Note;
use super::scaling::{Scaling, towards};
use crate::scene::PagePoint;
use tigereye_core::{Eigenvalues, PrincipalAxes, Tensor2, math};

/// Smaller parts of the larger principal value are rounding.
pub(super) const NEGLIGIBLE: f64 = Eigenvalues::ROUNDING;

pub(super) fn add(layers: &mut Layers, centre: PagePoint, t: &Tensor2, scaling: &Scaling) {
    let axes = PrincipalAxes::of(t);
    let [l1, l2] = axes.values;
    let size = l1.abs().max(l2.abs());
    let [l1, l2] = axes.values.map(|l| if l.abs() <= NEGLIGIBLE * size { 0.0 } else { l });
    let curve = Curve { centre, axes, l1, l2, size, scaling };
    if l1 > 0.0 {
        layers.notes.insert(Note::PositiveLobe);
        // Along the first axis, or all around if the second value has the same sign.
        for lobe in curve.lobes(0.0, curve.border(l1, l2)) {
            layers.layer(t, Tone::Tension).areas.polyline(&lobe, true);
        }
    }
    if l2 < 0.0 {
        layers.notes.insert(Note::NegativeLobe);
        for lobe in curve.lobes(math::FRAC_PI_2, curve.border(l2, l1)) {
            layers.layer(t, Tone::Compression).hollow.polyline(&lobe, true);
        }
    }
}

struct Curve<'a> {
    centre: PagePoint,
    axes: PrincipalAxes,
    /// Principal values, the larger first.
    l1: f64,
    l2: f64,
    size: f64,
    scaling: &'a Scaling,
}

impl Curve<'_> {
    /// Angle between the axis of `own` and the direction in which the component vanishes; `None` if it never does.
    fn border(&self, own: f64, other: f64) -> Option<f64> {
        // own cos^2 w + other sin^2 w = 0
        (own.signum() != other.signum() || other == 0.0)
            .then(|| math::atan2(own.abs().sqrt(), other.abs().sqrt()))
    }

    /// Outlines about the axis at `middle` (radians from the first one) and the opposite one, or one outline all
    /// around.
    fn lobes(&self, middle: f64, half_angle: Option<f64>) -> Vec<Vec<PagePoint>> {
        let reach = self.scaling.length(self.size, self.size);
        // Straight pieces per quarter turn: their error is a few hundredths of a pixel.
        let pieces = (5.0 * reach.sqrt()).ceil().clamp(8.0, 96.0) as usize;
        let Some(half_angle) = half_angle else {
            let all = 4 * pieces;
            return vec![(0..all).map(|i| self.point(math::TAU * i as f64 / all as f64)).collect()];
        };
        let lobe = |middle: f64| {
            let at = |i: usize| middle + half_angle * (i as f64 / pieces as f64 - 1.0);
            let mut points = vec![self.centre];
            points.extend((1..2 * pieces).map(|i| self.point(at(i))));
            points
        };
        vec![lobe(middle), lobe(middle + math::PI)]
    }

    /// The curve in the direction at `angle` radians from the first axis.
    fn point(&self, angle: f64) -> PagePoint {
        let (c, s) = (math::cos(angle), math::sin(angle));
        // Divided first, and never above 1: the largest numbers would overflow.
        let share = (self.l1 / self.size * c * c + self.l2 / self.size * s * s).abs().min(1.0);
        let length = self.scaling.length(share * self.size, self.size);
        towards(self.centre, self.axes.first * c + self.axes.second() * s, length)
    }
}
