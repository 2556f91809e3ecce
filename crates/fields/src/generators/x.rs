//! X: constant, major axis horizontal.
//!
//! ```text
//!   - - -
//!   - - -     phi = 0
//!   - - -
//! ```
//! Source: the thesis's synthetic test fields.

use crate::Generator;
use crate::geometry::{glyph, index_field};
use crate::parameter::ANISOTROPY;

pub(crate) const GENERATOR: Generator = Generator {
    name: "x",
    summary: "constant, major axis horizontal",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: true,
    build: |s| index_field(s, |_| glyph(s.number("anisotropy"), 0.0)),
};
