//! V: constant inclination left and right of the middle column, mirror images of each other.
//!
//! ```text
//!   / / | \ \     phi = 60 degrees left of the middle column, 90 in it, 120 right of it
//!   / / | \ \     (an even width has two middle columns)
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math::radians};

pub(crate) const GENERATOR: Generator = Generator {
    name: "v",
    summary: "two halves with inclined lines",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        Known::Symmetries("size=12", &[Mirror::LeftRight]),
        Known::MajorAxis("size=13", [0, 5], 60.0),
        Known::MajorAxis("size=13", [6, 5], 90.0),
        Known::MajorAxis("size=13", [7, 5], 120.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let side = p.right_of_middle();
        let degrees = match side {
            s if s <= -1.0 => 60.0,
            s if s >= 1.0 => 120.0,
            _ => 90.0,
        };
        glyph(q, radians(degrees))
    })
}
