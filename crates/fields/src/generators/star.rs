//! Star: rays of the centre.
//!
//! ```text
//!   \ | /
//!   - o -         phi = atan2(round(n-1-j-c), round(i-c)), c = (n-1)/2
//!   / | \         isotropic in the centre; with `sink` the zero tensor, which swallows all light
//! ```
//! Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::math::{atan2, round_ties_even};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "star",
    summary: "rays of the centre",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[
        ANISOTROPY,
        Parameter::flag("sink", "zero tensor in the centre instead of the identity"),
    ],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown, Mirror::QuarterTurn]),
        Known::MajorAxis("size=13", [12, 0], 45.0),
        Known::MajorAxis("size=13", [0, 6], 0.0),
        Known::Circles("size=13", 1),
        Known::Index("", 1.0),
    ],
    build: |s| star(s, if s.is_set("sink") { Tensor2::ZERO } else { Tensor2::IDENTITY }),
};

/// Rays about a given tensor in the centre.
pub(super) fn star(settings: &Settings, centre: Tensor2) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        let (dy, dx) = (round_ties_even(-p.below_middle()), round_ties_even(p.right_of_middle()));
        if dx == 0.0 && dy == 0.0 { centre } else { glyph(q, atan2(dy, dx)) }
    })
}
