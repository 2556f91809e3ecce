//! Absorb: a light guide. The middle column transmits all, the rest a part.
//!
//! ```text
//!   . o .         identity in the middle column (two of them where the width is even),
//!   . o .         transmission * identity elsewhere
//!   . o .
//! ```
//! Not of determinant 1: meant for global normalisation. Source: the thesis's synthetic test fields.

use crate::geometry::{Place, index_field};
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "absorb",
    summary: "a transparent middle column in an absorbing field; use global normalisation",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[Parameter::real(
        "transmission",
        0.5,
        0.0,
        1.0,
        "transmission beside the middle column",
    )],
    determinant_one: false,
    symmetric: true,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown]),
        Known::Symmetries("size=12", &[Mirror::LeftRight, Mirror::UpDown]),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let beside = settings.number("transmission");
    index_field(settings, |p: &Place| {
        let in_guide = p.right_of_middle().abs() < 1.0;
        Tensor2::isotropic(if in_guide { 1.0 } else { beside })
    })
}
