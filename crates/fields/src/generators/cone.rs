//! Cone: one diagonal line whose anisotropy fades.
//!
//! ```text
//!   \ o o         on i = j: phi = 135 degrees (published as -45: the same axis),
//!   o \ o         q from anisotropy (top left) falling linearly with i to 1
//!   o o \         identity elsewhere
//! ```
//! On a field that is not square the line joins the corners. Source: the thesis's synthetic test fields.

use crate::geometry::{Place, glyph, index_field};
use crate::parameter::anisotropy;
use crate::{Generator, Known, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "cone",
    summary: "a diagonal line whose anisotropy falls to 1 in an isotropic field",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[anisotropy(4)],
    determinant_one: true,
    symmetric: false,
    known: &[Known::MajorAxis("size=7", [2, 2], 135.0), Known::Circles("size=7", 49 - 6)],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let q = settings.number("anisotropy");
    index_field(settings, |p: &Place| {
        if p.on_falling_diagonal() {
            // The longer axis counts, so that every cell of the line differs.
            let along = if p.last_i >= p.last_j { p.along() } else { 1.0 - p.up() };
            glyph(q - (q - 1.0) * along, -p.diagonal_rad())
        } else {
            Tensor2::IDENTITY
        }
    })
}
