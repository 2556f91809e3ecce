//! Drain, final variant: horizontal in the top row, turning vertical towards the bottom.
//!
//! ```text
//!   - - -         phi = atan2(j, up * round(i-c)),
//!   \ | /         up = (n-1-j)/(n-1), c = (n-1)/2
//!   | | |
//! ```
//! If both arguments are 0 (top of the middle column), the angle is 0.
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{
    Field, Tensor2,
    math::{atan2, round_ties_even},
};

pub(crate) const GENERATOR: Generator = Generator {
    name: "drain_alt",
    summary: "lines that turn from horizontal on top to vertical at the bottom",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        Known::MajorAxis("size=13", [12, 0], 0.0),
        Known::MajorAxis("size=13", [0, 12], 90.0),
        Known::Circles("size=13", 0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let dx = p.up() * round_ties_even(p.right_of_middle());
        glyph(q, atan2(p.j, dx))
    })
}
