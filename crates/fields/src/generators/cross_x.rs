//! Cross: both diagonals conduct.
//!
//! ```text
//!   \ o /         phi = 135 degrees on i = j (published as -45: the same axis), 45 on i = n-1-j
//!   o o o         identity elsewhere; isotropic in the centre
//!   / o \
//! ```
//! As in the published matrix the centre keeps the angle of the falling diagonal and is a rotation, which transmits
//! as the identity does. On a field that is not square the lines join the corners. Source: the thesis's synthetic
//! test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::anisotropy;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "cross_x",
    summary: "two crossing diagonal lines in an isotropic field",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[anisotropy(4)],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown, Mirror::QuarterTurn]),
        Known::MajorAxis("size=13", [0, 0], 135.0),
        Known::MajorAxis("size=13", [12, 0], 45.0),
        Known::Circles("size=13", 169 - 24),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| match (p.on_falling_diagonal(), p.on_rising_diagonal()) {
        (true, true) => glyph(1.0, -p.diagonal_rad()),
        (true, false) => glyph(q, -p.diagonal_rad()),
        (false, true) => glyph(q, p.diagonal_rad()),
        (false, false) => Tensor2::IDENTITY,
    })
}
