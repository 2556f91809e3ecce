//! Drain: lines that diverge about the middle column, more so towards the top.
//!
//! ```text
//!   \ | /         phi = atan2(n-1-(c-j), up * round(i-c)),
//!   \ | /         up = (n-1-j)/(n-1), c = (n-1)/2
//!   | | |
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph_along, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math::round_ties_even};

pub(crate) const GENERATOR: Generator = Generator {
    name: "drain",
    summary: "lines that diverge about the middle column",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        // c = 6: the top row of drain is atan2(6, i - 6).
        Known::MajorAxis("size=13", [0, 0], 135.0),
        Known::MajorAxis("size=13", [12, 0], 45.0),
        Known::MajorAxis("size=13", [6, 4], 90.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let dx = p.up() * round_ties_even(p.right_of_middle());
        glyph_along(q, p.last_j + p.below_middle(), dx)
    })
}
