//! Inverse: the rays of a star with the rows upside down, a saddle.
//!
//! ```text
//!   / | \
//!   -   -         phi = atan2(round(j-c), round(i-c)), c = (n-1)/2
//!   \ | /         isotropic in the centre
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph_along, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math::round_ties_even};

pub(crate) const GENERATOR: Generator = Generator {
    name: "inverse",
    summary: "hyperbola-like lines about the centre: rays mirrored at the horizontal",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown]),
        Known::Symmetries("size=12", &[Mirror::LeftRight, Mirror::UpDown]),
        Known::Symmetries("width=21,height=9", &[Mirror::LeftRight, Mirror::UpDown]),
        Known::MajorAxis("size=13", [12, 0], 135.0),
        Known::MajorAxis("size=13", [6, 0], 90.0),
        Known::Circles("size=13", 1),
        Known::Circles("size=12", 4),
        Known::Index("", -1.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        glyph_along(q, round_ties_even(p.below_middle()), round_ties_even(p.right_of_middle()))
    })
}
