//! Gyre: the lines of four vortices.
//!
//! ```text
//!   dx = -pi sin(2 pi i/(n-1)) cos(2 pi up)       up = (n-1-j)/(n-1)
//!   dy =  pi cos(2 pi i/(n-1)) sin(2 pi up)       phi = atan2(dy, dx)
//! ```
//! Isotropic where i and j both lie in {0, c, n-1} or both in {c/2, 3c/2}, c = (n-1)/2: there the vector vanishes. As
//! in the published matrices, those cells keep the angle of its rounding errors, so they are rotations, which
//! transmit as the identity does.
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "gyre",
    summary: "four gyres",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("size=53", &[Mirror::HalfTurn]),
        Known::MajorAxis("size=13", [1, 1], 45.0),
        Known::MajorAxis("size=13", [3, 1], 0.0),
        Known::Circles("size=13", 13),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let (x, y) = (math::TAU * p.along(), math::TAU * p.up());
        let dx = -math::PI * math::sin(x) * math::cos(y);
        let dy = math::PI * math::cos(x) * math::sin(y);
        glyph(if is_stagnant(p) { 1.0 } else { q }, math::atan2(dy, dx))
    })
}

fn is_stagnant(p: &Place) -> bool {
    let (ci, cj) = (0.5 * p.last_i, 0.5 * p.last_j);
    let rim = [0.0, ci, p.last_i].contains(&p.i) && [0.0, cj, p.last_j].contains(&p.j);
    rim || ([0.5 * ci, 1.5 * ci].contains(&p.i) && [0.5 * cj, 1.5 * cj].contains(&p.j))
}
