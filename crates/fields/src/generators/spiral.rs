//! Spiral: an Archimedean spiral whose lines are rotated inwards.
//!
//! ```text
//!   r = 0.1 theta, theta = 0 .. 260 pi in whole degrees, phi = theta + 90 degrees - 0.5 rad
//! ```
//! Drawn as [`super::rings`] are. The centre and cells the spiral never visits are isotropic: those farther from the
//! centre than 81 cells. Source: the thesis's synthetic test fields.

use super::curve::Curve;
use crate::geometry::glyph;
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Settings};
use tigereye_core::math::{FRAC_PI_2, radians};
use tigereye_core::{Field, Tensor2};

/// 260 pi in degrees.
const LAST_DEGREE: u32 = 260 * 180;

pub(crate) const GENERATOR: Generator = Generator {
    name: "spiral",
    summary: "a spiral about the centre",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY],
    determinant_one: true,
    symmetric: false,
    known: &[Known::Circles("size=13", 1), Known::Index("", 1.0)],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let (grid, q) = (settings.grid(), settings.number("anisotropy"));
    let mut curve = Curve::new(grid);
    for degree in 0..=LAST_DEGREE {
        let theta = radians(f64::from(degree));
        curve.visit(0.1 * theta, theta, theta + FRAC_PI_2 - 0.5);
    }
    Field::from_fn(grid, |cell| match curve.angle(cell) {
        Some(phi) if cell != grid.centre() => glyph(q, phi),
        _ => Tensor2::IDENTITY,
    })
}
