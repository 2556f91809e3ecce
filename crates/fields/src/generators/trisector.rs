//! Trisector: the degenerate point of index -1/2.
//!
//! ```text
//!   T = mean * I + [[p, q], [q, -p]],  p = x, q = -y,  x and y in [-1, 1], y up
//! ```
//! Eigenvalues `mean +- r`, major axis at half the angle of (p, q); `mean` above sqrt 2 keeps the tensor positive. The
//! longer side of the field reaches from -1 to 1. Source: Delmarcelle and Hesselink, "The topology of symmetric,
//! second-order tensor fields", IEEE Visualization 1994.

use super::degenerate_point;
use crate::{Generator, Known, Mirror, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "trisector",
    summary: "degenerate point of index -1/2 in the centre",
    source: "Delmarcelle and Hesselink 1994",
    own_parameters: &[degenerate_point::MEAN],
    determinant_one: false,
    symmetric: true,
    known: &[Known::Symmetries("", &[Mirror::UpDown]), Known::Index("", -0.5)],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    degenerate_point::field(settings, -1.0)
}
