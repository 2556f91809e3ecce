//! Double gyre: the standard benchmark of flow visualisation, as a tensor field.
//!
//! ```text
//!   u = -pi a sin(pi f) cos(pi y)           on [0, 2] x [0, 1], y up
//!   v =  pi a cos(pi f) sin(pi y) df/dx     f = e sin(wt) x^2 + (1 - 2 e sin(wt)) x,  w = 2 pi / period
//! ```
//! `gradient`: the velocity gradient [[u_x, u_y], [v_x, v_y]] at the given time, asymmetric, of trace 0.
//! `cauchy_green`: C = F^T F of the flow map from `time` over `duration` (which may be negative), of determinant 1; F
//! is integrated along with the particle, F' = grad(u) F, by the classical Runge-Kutta method of fourth order.
//!
//! The domain fills the field, including samples on its boundary: cells are square for width - 1 = 2 (height - 1).
//! Source: Shadden, Lekien and Marsden, "Definition and properties of Lagrangian coherent structures", Physica D 2005.

use crate::geometry::{Place, index_field};
use crate::{Generator, Known, Mirror, Parameter, Settings};
use tigereye_core::math::{PI, TAU, cos, sin};
use tigereye_core::{Field, Tensor2, runge_kutta_step};

pub(crate) const GENERATOR: Generator = Generator {
    name: "double_gyre",
    summary: "velocity gradient or Cauchy-Green tensor of the time-dependent double gyre",
    source: "Shadden, Lekien and Marsden 2005",
    own_parameters: &[
        Parameter::choice("tensor", &["gradient", "cauchy_green"], "which tensor"),
        Parameter::real("a", 0.1, -100.0, 100.0, "amplitude of the velocity"),
        Parameter::real("epsilon", 0.25, -1.0, 1.0, "amplitude of the swinging"),
        Parameter::real("period", 10.0, 1e-3, 1e6, "period of the swinging, time"),
        Parameter::real("time", 0.0, -1e6, 1e6, "instant, or start of the flow map"),
        Parameter::real("duration", 10.0, -1e3, 1e3, "length of the flow map, time"),
        Parameter::integer("steps", 200, 1, 100_000, "Runge-Kutta steps of the flow map"),
    ],
    determinant_one: false,
    symmetric: false,
    known: &[Known::Symmetries("width=41,height=21,epsilon=0", &[Mirror::HalfTurn])],
    build,
};

fn build(settings: &Settings) -> Field<Tensor2> {
    let [a, epsilon, period, time, duration] =
        ["a", "epsilon", "period", "time", "duration"].map(|name| settings.number(name));
    let flow = Flow { a, epsilon, omega: TAU / period };
    let (cauchy_green, steps) = (settings.is_set("tensor"), settings.number("steps") as usize);
    index_field(settings, |p: &Place| {
        let (x, y) = (2.0 * p.along(), p.up());
        if !cauchy_green {
            let [xx, xy, yx, yy] = flow.at(time, x, y).gradient;
            return Tensor2::new(xx, xy, yx, yy);
        }
        let [.., xx, xy, yx, yy] = flow.follow(x, y, time, duration, steps);
        Tensor2::symmetric(xx * xx + yx * yx, xx * xy + yx * yy, xy * xy + yy * yy)
    })
}

struct Flow {
    a: f64,
    epsilon: f64,
    omega: f64,
}

/// Velocity and its gradient row by row: u_x, u_y, v_x, v_y.
struct Motion {
    velocity: [f64; 2],
    gradient: [f64; 4],
}

/// A particle and its deformation: x, y, then F row by row.
type State = [f64; 6];

impl Flow {
    fn at(&self, t: f64, x: f64, y: f64) -> Motion {
        let e = self.epsilon * sin(self.omega * t);
        let f = e * x * x + (1.0 - 2.0 * e) * x;
        let (fx, fxx) = (2.0 * e * x + 1.0 - 2.0 * e, 2.0 * e);
        let (sf, cf) = (sin(PI * f), cos(PI * f));
        let (sy, cy) = (sin(PI * y), cos(PI * y));
        let b = PI * self.a;
        let stretch = b * PI * cf * fx * cy;
        Motion {
            velocity: [-b * sf * cy, b * cf * sy * fx],
            gradient: [-stretch, b * PI * sf * sy, b * sy * (cf * fxx - PI * sf * fx * fx), stretch],
        }
    }

    fn rate(&self, t: f64, [x, y, xx, xy, yx, yy]: State) -> State {
        let Motion { velocity: [u, v], gradient: [ux, uy, vx, vy] } = self.at(t, x, y);
        [u, v, ux * xx + uy * yx, ux * xy + uy * yy, vx * xx + vy * yx, vx * xy + vy * yy]
    }

    fn follow(&self, x: f64, y: f64, start: f64, duration: f64, steps: usize) -> State {
        let h = duration / steps as f64;
        let step = |s, i| runge_kutta_step(|t, s| self.rate(t, s), start + i as f64 * h, s, h);
        (0..steps).fold([x, y, 1.0, 0.0, 0.0, 1.0], step)
    }
}
