//! Y: constant, major axis vertical.
//!
//! ```text
//!   | | |
//!   | | |     phi = 90 degrees
//!   | | |
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror};

use tigereye_core::math::FRAC_PI_2;

pub(crate) const GENERATOR: Generator = Generator {
    name: "y",
    summary: "constant, major axis vertical",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown]),
        Known::MajorAxis("", [3, 9], 90.0),
        Known::Index("", 0.0),
    ],
    build: |s| index_field(s, |_| glyph(s.number("anisotropy"), FRAC_PI_2)),
};
