//! Point load: Boussinesq's solution for a half space, any plane parallel to the axes.
//!
//! ```text
//!         | load                 z = extent: the surface
//!   ______V______                with z up, d = extent - z the depth, R = distance from the load,
//!   |           |                k = load / (2 pi), n = 1 - 2 poisson:
//!   |           |   szz = -3 k d^3 / R^5,  sxz = 3 k x d^2 / R^5,  syz = 3 k y d^2 / R^5
//!   |___________|   sxx = -k/R^2 (3 x^2 d/R^3 - n (d/R - R/(R+d) + x^2 w)),  syy likewise with y
//!                   sxy = -k/R^2 (3 x y d/R^3 - n x y w),  w = (2R+d) / (R (R+d)^2)
//! ```
//! The load acts in the middle of the top face of the box |x|, |y|, |z| <= extent, as in VTK's vtkPointLoad, whose
//! values these are. In an upright picture row 0 is the surface. The tensor at the load itself, where the stress is
//! infinite, and outside the body is zero. Compression is negative.
//! Source: Boussinesq 1885; Saada, "Elasticity: Theory and Applications", chapter 14.

use crate::geometry::{Plane, Window, plane_parameter};
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "point_load",
    summary: "point load on a half space (Boussinesq), a plane of it",
    source: "Boussinesq 1885; the field of VTK's vtkPointLoad",
    own_parameters: &[
        Parameter::real("load", 100.0, -1e6, 1e6, "force, downwards"),
        Parameter::real("poisson", 0.3, 0.0, 0.5, "Poisson's ratio"),
        Parameter::real("extent", 10.0, 1e-3, 1e3, "half of the longer side, length"),
        plane_parameter(&["xz", "yz", "xy"]),
        Parameter::real("offset", 0.0, -1e3, 1e3, "position of the plane along its normal, length"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[
        Known::Symmetries("", &[Mirror::LeftRight]),
        Known::Symmetries("plane=xy,offset=3", &[Mirror::LeftRight, Mirror::UpDown, Mirror::QuarterTurn]),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let [load, poisson, extent, offset] =
        ["load", "poisson", "extent", "offset"].map(|name| settings.number(name));
    let plane = [Plane::Xz, Plane::Yz, Plane::Xy][settings.number("plane") as usize];
    let window = Window::new(settings.grid(), extent);
    Field::from_fn(settings.grid(), |cell| {
        let up = match plane {
            Plane::Xy => window.y(cell),
            Plane::Xz | Plane::Yz => extent - cell.y as f64 * window.spacing,
        };
        let [x, y, z] = plane.point(window.x(cell), up, offset);
        plane.section(&stress(load, poisson, [x, y, extent - z], extent))
    })
}

/// Stress at `(x, y)` and depth `d` in the frame x, y, z up; lengths below `1e-12 unit` are those of the load itself.
fn stress(load: f64, poisson: f64, [x, y, d]: [f64; 3], unit: f64) -> [[f64; 3]; 3] {
    let r = (x * x + y * y + d * d).sqrt();
    // The rounding of extent - z may leave the surface a little above itself.
    let d = if d.abs() < 1e-12 * unit { 0.0 } else { d };
    if d < 0.0 || r < 1e-12 * unit {
        return [[0.0; 3]; 3];
    }
    let (k, n) = (load / math::TAU, 1.0 - 2.0 * poisson);
    let (r2, r3) = (r * r, r * r * r);
    let w = (2.0 * r + d) / (r * (r + d) * (r + d));
    let normal = |a: f64| -k / r2 * (3.0 * a * a * d / r3 - n * (d / r - r / (r + d) + a * a * w));
    let upright = |a: f64| 3.0 * k * a * d * d / (r2 * r3);
    let xy = -k / r2 * (3.0 * x * y * d / r3 - n * x * y * w);
    let (xz, yz) = (upright(x), upright(y));
    [[normal(x), xy, xz], [xy, normal(y), yz], [xz, yz, -upright(d)]]
}
