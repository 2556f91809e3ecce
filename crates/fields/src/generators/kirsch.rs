//! Kirsch: an infinite plate with a round hole under tension along x.
//!
//! ```text
//!   <-       __       ->   srr = s/2 (1 - a2) + s/2 (1 - 4 a2 + 3 a4) cos 2t
//!   <- s    (__)    s ->   stt = s/2 (1 + a2) - s/2 (1 + 3 a4) cos 2t
//!   <-                ->   srt = -s/2 (1 + 2 a2 - 3 a4) sin 2t
//! ```
//! with a2 = (a/r)^2, a4 = (a/r)^4. Zero inside the hole; r = a belongs to the plate. The stress at the hole's sides
//! is 3 s. Source: Kirsch 1898; Timoshenko and Goodier, "Theory of Elasticity", article 35.

use crate::geometry::Window;
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::{Field, Tensor2};

pub(crate) const GENERATOR: Generator = Generator {
    name: "kirsch",
    summary: "plate with a hole under tension; zero inside the hole",
    source: "Kirsch 1898; Timoshenko and Goodier, article 35",
    own_parameters: &[
        Parameter::real("tension", 1.0, -1e6, 1e6, "stress far away, along x"),
        Parameter::real("radius", 1.0, 1e-3, 1e3, "radius of the hole, length"),
        Parameter::real("extent", 4.0, 1e-3, 1e3, "half of the longer side, length"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown])],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let (tension, radius) = (settings.number("tension"), settings.number("radius"));
    let window = Window::new(settings.grid(), settings.number("extent"));
    Field::from_fn(settings.grid(), |cell| stress(tension, radius, window.x(cell), window.y(cell)))
}

fn stress(tension: f64, radius: f64, x: f64, y: f64) -> Tensor2 {
    let r2 = x * x + y * y;
    if r2 < radius * radius {
        return Tensor2::ZERO;
    }
    let (a2, half) = (radius * radius / r2, 0.5 * tension);
    let a4 = a2 * a2;
    // cos^2, sin^2 and sin cos of the polar angle, without the angle.
    let (cc, ss, sc) = (x * x / r2, y * y / r2, x * y / r2);
    let (cos2t, sin2t) = (cc - ss, 2.0 * sc);
    let rr = half * (1.0 - a2) + half * (1.0 - 4.0 * a2 + 3.0 * a4) * cos2t;
    let tt = half * (1.0 + a2) - half * (1.0 + 3.0 * a4) * cos2t;
    let rt = -half * (1.0 + 2.0 * a2 - 3.0 * a4) * sin2t;
    Tensor2::symmetric(
        rr * cc + tt * ss - rt * sin2t,
        (rr - tt) * sc + rt * cos2t,
        rr * ss + tt * cc + rt * sin2t,
    )
}
