//! Helix: Kindlmann's test for diffusion tensor tools, a bundle of twisted fibres along a right-handed helix.
//!
//! ```text
//!   core: (R cos t, R sin t, S t / (2 pi))       R = major_radius, S = pitch
//!   a point at distance d from the core has the eigenvalues
//!     l1 along the fibre, l2 around the core, l3 away from it (radial)
//!   fibre = core's tangent rotated about the radial direction by twist * d / minor_radius
//! ```
//! Beyond `minor_radius` the eigenvalues fade to `background`, half way at that distance, over a width of about
//! `boundary`. The picture is a plane of space from -2 R to 2 R along its longer side, its tensor the part of the 3D
//! tensor in that plane.
//!
//! The construction and the default sizes are those of `tend helix` in Kindlmann's teem. Three things differ: the
//! core's tangent is the exact derivative (teem's is twice as steep along the axis), the fading is a tanh with the
//! slope of teem's error function, and the background is the mean of the eigenvalues (0.003, so that the 3D trace is
//! constant) instead of 0.5.
//! Source: Kindlmann, "Superquadric tensor glyphs", VisSym 2004, and teem.

use crate::geometry::{Plane, Window, plane_parameter};
use crate::{Generator, Known, Parameter, Settings};
use tigereye_core::{Field, Tensor2, math};

pub(crate) const GENERATOR: Generator = Generator {
    name: "helix",
    summary: "Kindlmann's helix of twisted fibres, a plane of it",
    source: "Kindlmann 2004 (teem's tend helix)",
    own_parameters: &[
        plane_parameter(&["xy", "xz", "yz"]),
        Parameter::real("offset", 0.0, -1e4, 1e4, "position of the plane along its normal, length"),
        Parameter::real("major_radius", 50.0, 1e-3, 1e3, "radius of the turns, length"),
        Parameter::real("minor_radius", 30.0, 1e-3, 1e3, "radius of the bundle, length"),
        Parameter::real("pitch", 100.0, 1e-3, 1e4, "distance of neighbouring turns, length"),
        Parameter::real("boundary", 10.0, 0.0, 1e3, "width of the bundle's fading, length"),
        Parameter::real(
            "twist_deg",
            60.0,
            -360.0,
            360.0,
            "turn of the fibres at the bundle's radius, degrees",
        ),
        Parameter::real("l1", 0.006, 0.0, 1e6, "eigenvalue along the fibre"),
        Parameter::real("l2", 0.002, 0.0, 1e6, "eigenvalue around the core"),
        Parameter::real("l3", 0.001, 0.0, 1e6, "eigenvalue away from the core"),
        Parameter::real("background", 0.003, 0.0, 1e6, "eigenvalue outside the bundle"),
    ],
    determinant_one: false,
    symmetric: true,
    known: &[
        // The core passes upwards and to the back.
        Known::Tensor("size=9,boundary=0", [6, 4], Tensor2::symmetric(0.001, 0.0, 0.005_632_001_326_598_5)),
    ],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let helix = Helix {
        radius: settings.number("major_radius"),
        rise: settings.number("pitch") / math::TAU,
        bundle: settings.number("minor_radius"),
        boundary: settings.number("boundary"),
        twist_rad: math::radians(settings.number("twist_deg")),
        eigenvalues: ["l1", "l2", "l3"].map(|name| settings.number(name)),
        background: settings.number("background"),
    };
    let plane = [Plane::Xy, Plane::Xz, Plane::Yz][settings.number("plane") as usize];
    let (window, offset) = (Window::new(settings.grid(), 2.0 * helix.radius), settings.number("offset"));
    Field::from_fn(settings.grid(), |cell| {
        plane.section(&helix.tensor(plane.point(window.x(cell), window.y(cell), offset)))
    })
}

struct Helix {
    radius: f64,
    /// Height gained per radian.
    rise: f64,
    bundle: f64,
    boundary: f64,
    twist_rad: f64,
    eigenvalues: [f64; 3],
    background: f64,
}

impl Helix {
    fn tensor(&self, at: [f64; 3]) -> [[f64; 3]; 3] {
        let t = self.nearest(at);
        let (cos, sin) = (math::cos(t), math::sin(t));
        let core = [self.radius * cos, self.radius * sin, self.rise * t];
        let away: [f64; 3] = core::array::from_fn(|k| at[k] - core[k]);
        let distance = dot(away, away).sqrt();
        let tangent = unit([-self.radius * sin, self.radius * cos, self.rise]);
        // On the core itself every radial direction is as good; the one away from the axis is taken.
        let outward = [cos, sin, 0.0];
        let radial = if distance > 1e-9 * self.radius { unit(away) } else { outward };
        let around = cross(tangent, radial);
        let twist = self.twist_rad * distance / self.bundle;
        let (c, s) = (math::cos(twist), math::sin(twist));
        let fibre: [f64; 3] = core::array::from_fn(|k| c * tangent[k] + s * around[k]);
        let across: [f64; 3] = core::array::from_fn(|k| c * around[k] - s * tangent[k]);
        let inside = self.inside(distance);
        let [l1, l2, l3] = self.eigenvalues.map(|l| self.background + inside * (l - self.background));
        let axes = [(l1, fibre), (l2, across), (l3, radial)];
        core::array::from_fn(|r| core::array::from_fn(|k| axes.iter().map(|(l, e)| l * e[r] * e[k]).sum()))
    }

    /// 1 in the bundle, 0 outside, 1/2 at its radius.
    fn inside(&self, distance: f64) -> f64 {
        let beyond = distance - self.bundle;
        if self.boundary == 0.0 {
            return if beyond <= 0.0 { 1.0 } else { 0.0 };
        }
        // 2 / sqrt(pi): the slope of the error function at 0.
        0.5 - 0.5 * math::tanh(core::f64::consts::FRAC_2_SQRT_PI * beyond / self.boundary)
    }

    /// Parameter t of the nearest point of the core.
    ///
    /// The squared distance has the derivative `2 (rho R sin(t - azimuth) + rise (rise t - z))`. Between the turn's
    /// azimuth nearest to the point's height and that height itself it is concave and changes sign exactly once.
    fn nearest(&self, [x, y, z]: [f64; 3]) -> f64 {
        let (rho, level) = (math::hypot(x, y), z / self.rise);
        let azimuth = math::atan2(y, x);
        let azimuth = azimuth + math::TAU * math::round_ties_even((level - azimuth) / math::TAU);
        let slope = |t: f64| rho * self.radius * math::sin(t - azimuth) + self.rise * self.rise * (t - level);
        let (mut low, mut high) = (azimuth.min(level), azimuth.max(level));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
