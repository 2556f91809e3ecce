//! Sink: the star with the zero tensor in the centre, which swallows all light.
//!
//! ```text
//!   \ | /
//!   - 0 -         phi = atan2(round(n-1-j-c), round(i-c)), c = (n-1)/2
//!   / | \
//! ```
//! Source: the thesis's synthetic test fields.

use super::star::star;
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror};
use tigereye_core::Tensor2;

pub(crate) const GENERATOR: Generator = Generator {
    name: "sink",
    summary: "rays of the centre, whose tensor is zero: star with sink=true",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: false,
    symmetric: false,
    known: &[Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown, Mirror::QuarterTurn])],
    build: |s| star(s, Tensor2::ZERO),
};
