//! X: constant, major axis horizontal.
//!
//! ```text
//!   - - -
//!   - - -     phi = 0
//!   - - -
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror};

pub(crate) const GENERATOR: Generator = Generator {
    name: "x",
    summary: "constant, major axis horizontal",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: true,
    known: &[Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown]), Known::MajorAxis("", [3, 9], 0.0)],
    build: |s| index_field(s, |_| glyph(s.number("anisotropy"), 0.0)),
};
