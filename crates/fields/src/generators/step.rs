//! Step: isotropic above, horizontal below.
//!
//! ```text
//!   o o o         identity for rows j < round(c), c = (n-1)/2
//!   - - -         phi = 0 from there on
//!   - - -
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math::round_ties_even};

pub(crate) const GENERATOR: Generator = Generator {
    name: "step",
    summary: "horizontal in the lower half, isotropic in the upper",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: true,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        Known::MajorAxis("size=13", [4, 6], 0.0),
        Known::Circles("size=13", 6 * 13),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        if p.j >= round_ties_even(0.5 * p.last_j) { glyph(q, 0.0) } else { Tensor2::IDENTITY }
    })
}
