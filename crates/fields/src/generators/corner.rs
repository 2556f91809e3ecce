//! Corner: 45 degrees on the diagonal, steep below it, flat above it.
//!
//! ```text
//!   / - -         phi = atan2(j+1, i+1)
//!   | / -
//!   | | /
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph_along, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "corner",
    summary: "rays that leave the top left corner, mirrored at the horizontal",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::MajorAxis("size=13", [5, 5], 45.0),
        Known::MajorAxis("size=13", [0, 1], 63.43494882292201),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| glyph_along(q, p.j + 1.0, p.i + 1.0))
}
