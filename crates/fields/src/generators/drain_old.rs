//! Drain, first variant: rays from a point as far below the middle as the field is high.
//!
//! ```text
//!   \ | /         phi = atan2(n-1-round(j-c), round(i-c)), c = (n-1)/2
//!   \ | /         the identity if both arguments are 0
//!   \ | /
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph_along, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math::round_ties_even};

pub(crate) const GENERATOR: Generator = Generator {
    name: "drain_old",
    summary: "rays of a point below the field",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        Known::MajorAxis("size=13", [12, 12], 45.0),
        Known::MajorAxis("size=13", [0, 12], 135.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let dy = p.last_j - round_ties_even(p.below_middle());
        glyph_along(q, dy, round_ties_even(p.right_of_middle()))
    })
}
