//! Random: smooth noise.
//!
//! ```text
//!   T---+---T     points x points control tensors over the whole field, corners included;
//!   |  .    |     sxx, syy, sxy uniform in [-1, 1), drawn in this order, row by row from the top left;
//!   T---+---T     bilinear in between
//! ```
//! Symmetric, often indefinite. Deterministic for a seed (SplitMix64); the thesis's own random numbers are
//! not known. Source: the thesis's synthetic test fields.

use crate::geometry::{Place, index_field};
use crate::{Generator, Known, Parameter, Settings};
use tigereye_core::{Field, SplitMix64, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "random",
    summary: "random symmetric control tensors, bilinear in between",
    source: "thesis, synthetic test fields (published matrices)",
    own_parameters: &[
        Parameter::integer("seed", 1, 0, 1 << 53, "seed of the random numbers"),
        Parameter::integer("points", 9, 2, 1024, "control tensors along each side"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[
        // From another implementation.
        Known::Tensor(
            "size=9,seed=1",
            [0, 0],
            Tensor2::symmetric(0.133_123_150_344_561_8, 0.942_005_507_173_592_4, 0.491_563_514_525_402_6),
        ),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let points = settings.number("points") as usize;
    let mut rng = SplitMix64::new(settings.number("seed") as u64);
    let controls: Vec<Tensor2> = (0..points * points)
        .map(|_| {
            let [xx, yy, xy] = core::array::from_fn(|_| rng.symmetric_unit());
            Tensor2::symmetric(xx, xy, yy)
        })
        .collect();
    index_field(settings, |p: &Place| {
        let (column, right) = interval(p.along(), points);
        let (row, down) = interval(1.0 - p.up(), points);
        let at = |dx: usize, dy: usize| controls[(row + dy) * points + column + dx];
        mix(mix(at(0, 0), at(1, 0), right), mix(at(0, 1), at(1, 1), right), down)
    })
}

/// The control interval a fraction of the side lies in, and the fraction of that interval.
fn interval(fraction: f64, points: usize) -> (usize, f64) {
    let position = fraction * (points - 1) as f64;
    let first = (position.floor() as usize).min(points - 2);
    (first, position - first as f64)
}

fn mix(a: Tensor2, b: Tensor2, t: f64) -> Tensor2 {
    a.scaled(1.0 - t) + b.scaled(t)
}
