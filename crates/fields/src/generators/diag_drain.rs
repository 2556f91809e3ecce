//! Diagonal drain: rays about the bottom left corner.
//!
//! ```text
//!   - - /         a = i/(n-1), b = (n-1-j)/(n-1)
//!   - / |         phi = atan2(a cos(ab), b cos(ab)): steep to the right, flat on top
//!   / | |         45 degrees in the bottom left cell
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "diag_drain",
    summary: "lines that run from the bottom left corner, bent about the diagonal",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::MajorAxis("size=13", [12, 0], 45.0),
        Known::MajorAxis("size=13", [0, 0], 0.0),
        Known::MajorAxis("size=13", [12, 12], 90.0),
        Known::MajorAxis("size=13", [0, 12], 45.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let (a, b) = (p.along(), p.up());
        let cos = math::cos(a * b);
        if a == 0.0 && b == 0.0 { glyph(q, math::FRAC_PI_4) } else { glyph(q, math::atan2(a * cos, b * cos)) }
    })
}
