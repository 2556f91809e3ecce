//! Bow: a saddle whose vertical coordinate is replaced by a cosine of the column.
//!
//! ```text
//!   phi = atan2(round((n-1) cos(2 i/(n-1)) - c), round(j-c)), c = (n-1)/2
//! ```
//! The identity if both arguments are 0. The first argument depends on the column only and takes the width for n,
//! the second takes the height.
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph_along, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "bow",
    summary: "lines bent like a bow",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[Known::Symmetries("", &[Mirror::UpDown])],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let dy = p.last_i * math::cos(2.0 * p.along()) - 0.5 * p.last_i;
        glyph_along(q, math::round_ties_even(dy), math::round_ties_even(p.below_middle()))
    })
}
