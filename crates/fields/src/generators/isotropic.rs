//! Isotropic: the identity everywhere. Light spreads alike in all directions.
//!
//! Formula: `phi = 0`, both axes 1. Source: the thesis's synthetic test fields.

use crate::{Generator, Known, Mirror};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "isotropic",
    summary: "the identity everywhere",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[],
    determinant_one: true,
    symmetric: true,
    known: &[Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown, Mirror::QuarterTurn])],
    build: |s| Field::from_fn(s.grid(), |_| Tensor2::IDENTITY),
};
