//! Rings: circles about the centre, drawn as the thesis draws them.
//!
//! ```text
//!   / - \         each whole degree theta of each integer radius r falls into the cell nearest to
//!   | o |         (r cos theta, r sin theta); of all points in a cell the one nearest to its middle
//!   \ - /         gives phi = theta + 90 degrees
//! ```
//! The radii cover a square wider than the field by 25 cells all round. Cells that catch no point stay isotropic, as in
//! the published matrices: 8 of them at 51 cells per side, all beyond radius 32, and a growing share of larger fields.
//! The centre is isotropic: a quarter turn, as published.
//! With `total` the minor axis is 0 and the major one 1. Source: the thesis's synthetic test fields.

use super::curve::{Curve, MARGIN};
use crate::geometry::glyph;
use crate::parameter::ANISOTROPY;
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::math::{FRAC_PI_2, radians};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "rings",
    summary: "circles about the centre",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[ANISOTROPY, Parameter::flag("total", "total anisotropy: axes 1 and 0")],
    determinant_one: true,
    symmetric: false,
    known: &[
        Known::Symmetries("", &[Mirror::QuarterTurn]),
        Known::MajorAxis("size=13", [12, 6], 90.0),
        Known::MajorAxis("size=13", [6, 0], 0.0),
        // The diagonal cell (3, 3) from the centre catches theta = 45 degrees best.
        Known::MajorAxis("size=13", [9, 3], 135.0),
        Known::Circles("size=13", 1),
        // Eight cells beyond radius 32 catch no point of a whole degree.
        Known::Circles("size=51", 9),
        Known::Index("", 1.0),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let (grid, q, total) = (settings.grid(), settings.number("anisotropy"), settings.is_set("total"));
    let centre = grid.centre();
    let curve = draw(settings);
    Field::from_fn(grid, |cell| {
        if cell == centre {
            return glyph(1.0, FRAC_PI_2);
        }
        match curve.angle(cell) {
            None => Tensor2::IDENTITY,
            Some(phi) if total => Tensor2::from_axes(phi, 1.0, 0.0),
            Some(phi) => glyph(q, phi),
        }
    })
}

fn draw(settings: &Settings) -> Curve {
    let grid = settings.grid();
    let mut curve = Curve::new(grid);
    let widest = grid.width().max(grid.height()) + 2 * MARGIN;
    for r in 1..widest.div_ceil(2) {
        for degree in 0..360 {
            let theta = radians(f64::from(degree));
            curve.visit(r as f64, theta, theta + FRAC_PI_2);
        }
    }
    curve
}
