//! The double gyre and the helix.

use crate::{at, field};
use tigereye_core::{Field, Tensor2, math};

#[test]
fn double_gyre_is_incompressible() {
    for time in [0.0, 1.3, 7.5] {
        let f = field(&format!("double_gyre:width=41,height=21,time={time}"));
        assert!(f.values().iter().all(|t| t.trace() == 0.0));
        assert!(f.values().iter().any(|t| t.asymmetry() > 0.5));
    }
}

#[test]
fn velocity_gradient_has_its_known_values() {
    // Without swinging: u = -pi a sin(pi x) cos(pi y), v = pi a cos(pi x) sin(pi y). Centre of the left gyre, a wall's
    // middle and a corner.
    let f = field("double_gyre:width=5,height=3,epsilon=0,a=0.1");
    let s = 0.1 * math::PI * math::PI;
    for (x, y, expected) in [
        (1, 1, Tensor2::new(0.0, s, -s, 0.0)),
        (2, 1, Tensor2::new(0.0, 0.0, 0.0, 0.0)),
        (0, 2, Tensor2::new(-s, 0.0, 0.0, s)),
        (0, 0, Tensor2::new(s, 0.0, 0.0, -s)),
    ] {
        let difference = (at(&f, x, y) + expected.scaled(-1.0)).max_abs();
        assert!(difference < 1e-15, "({x}, {y}): {:?}", at(&f, x, y));
    }
}

/// Cauchy-Green tensors of the double gyre.
fn cauchy_green(duration: f64, steps: usize) -> Field<Tensor2> {
    let sizes = "tensor=cauchy_green,width=21,height=11";
    field(&format!("double_gyre:{sizes},duration={duration},steps={steps}"))
}

#[test]
fn cauchy_green_keeps_the_area() {
    for duration in [10.0, -10.0] {
        for (cell, t) in cauchy_green(duration, 400).iter() {
            // Stretched 1e3 times, rounding of components of 1e6 in the last place dominates a determinant of 1.
            let rounding = 4.0 * f64::EPSILON * t.max_abs() * t.max_abs();
            let error = (t.determinant() - 1.0).abs();
            assert!(error < 1e-6 + rounding, "{cell:?}: {error:e}, rounding {rounding:e}");
        }
    }
}

#[test]
fn flow_map_is_of_fourth_order() {
    let error = |steps: usize| {
        let f = cauchy_green(2.0, steps);
        f.values().iter().map(|t| (t.determinant() - 1.0).abs()).fold(0.0, f64::max)
    };
    // Half the step, at most a sixteenth of the error (within 30 %).
    let (coarse, fine) = (error(10), error(20));
    assert!(coarse / fine > 11.0 && fine < 1e-3, "{coarse:e} / {fine:e}");
}

#[test]
fn cauchy_green_of_no_time_is_the_identity() {
    let f = field("double_gyre:tensor=cauchy_green,duration=0");
    assert!(f.values().iter().all(|t| *t == Tensor2::IDENTITY));
}

/// Flow map of the double gyre by many small midpoint steps.
fn flow_map(mut x: f64, mut y: f64) -> [f64; 2] {
    let velocity = |t: f64, x: f64, y: f64| {
        let e = 0.25 * math::sin(math::TAU * t / 10.0);
        let (f, fx) = (e * x * x + (1.0 - 2.0 * e) * x, 2.0 * e * x + 1.0 - 2.0 * e);
        let b = 0.1 * math::PI;
        let u = -b * math::sin(math::PI * f) * math::cos(math::PI * y);
        [u, b * math::cos(math::PI * f) * math::sin(math::PI * y) * fx]
    };
    let h = 1e-3;
    for step in 0..10_000 {
        let t = f64::from(step) * h;
        let [u, v] = velocity(t, x, y);
        let [u, v] = velocity(t + 0.5 * h, x + 0.5 * h * u, y + 0.5 * h * v);
        (x, y) = (x + h * u, y + h * v);
    }
    [x, y]
}

#[test]
fn cauchy_green_is_that_of_the_flow_map() {
    let f = field("double_gyre:tensor=cauchy_green,width=21,height=11");
    for (i, j) in [(3, 4), (10, 5), (16, 8)] {
        let (x, y, d) = (0.1 * i as f64, 1.0 - 0.1 * j as f64, 1e-5);
        let [right, left] = [flow_map(x + d, y), flow_map(x - d, y)];
        let [above, below] = [flow_map(x, y + d), flow_map(x, y - d)];
        let column = |a: [f64; 2], b: [f64; 2]| [(a[0] - b[0]) / (2.0 * d), (a[1] - b[1]) / (2.0 * d)];
        let (p, q) = (column(right, left), column(above, below));
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let expected = Tensor2::symmetric(dot(p, p), dot(p, q), dot(q, q));
        let found = at(&f, i, j);
        let relative = (found + expected.scaled(-1.0)).max_abs() / expected.max_abs();
        assert!(relative < 1e-4, "({i}, {j}): {found:?}, {expected:?}");
    }
}

/// Tangent of the helix at (R, 0, 0), components y and z, for the default radius and pitch.
fn tangent() -> [f64; 2] {
    let (r, rise) = (50.0, 100.0 / math::TAU);
    [r, rise].map(|c| c / math::hypot(r, rise))
}

#[test]
fn helix_core_is_right_handed() {
    let [ty, tz] = tangent();
    // Spacing 25: the core passes (50, 0, 0) upwards and towards +y.
    let across = field("helix:size=9,boundary=0");
    let t = at(&across, 6, 4);
    assert!((t.xx() - 0.001).abs() < 1e-15 && t.xy().abs() < 1e-15);
    assert!((t.yy() - (0.006 * ty * ty + 0.002 * tz * tz)).abs() < 1e-15);
    let upright = at(&field("helix:size=9,boundary=0,plane=yz,offset=50"), 4, 4);
    assert!((upright.xy() - 0.004 * ty * tz).abs() < 1e-15 && upright.xy() > 0.0);
}

#[test]
fn helix_fibres_twist_with_the_distance() {
    let [ty, tz] = tangent();
    // (80, 0, 0) lies 30 outside the core: half of the bundle's radius, half of the twist.
    let t = at(&field("helix:size=11,boundary=0,minor_radius=60,plane=yz,offset=80"), 5, 5);
    let (c, s) = (math::cos(math::PI / 6.0), 0.5);
    let (fibre, across) = ([c * ty + s * tz, c * tz - s * ty], [c * tz - s * ty, -c * ty - s * tz]);
    let component = |a: usize, b: usize| 0.006 * fibre[a] * fibre[b] + 0.002 * across[a] * across[b];
    let expected = Tensor2::symmetric(component(0, 0), component(0, 1), component(1, 1));
    assert!((t + expected.scaled(-1.0)).max_abs() < 1e-15, "{t:?} {expected:?}");
}

#[test]
fn helix_is_its_own_screw() {
    // A quarter of the pitch up is a quarter turn, a whole pitch the identity.
    let flat = field("helix:size=31");
    for (spec, expected) in [("offset=25", flat.quarter_turned()), ("offset=100", flat)] {
        let f = field(&format!("helix:size=31,{spec}"));
        // Opposite the core two of its points are equally near.
        let tie =
            |x: usize, y: usize| if spec == "offset=25" { x == 15 && y >= 15 } else { y == 15 && x <= 15 };
        for (cell, t) in f.iter().filter(|(c, _)| !tie(c.x, c.y)) {
            let difference = (*t + expected.at(cell).scaled(-1.0)).max_abs();
            assert!(difference < 1e-15, "{spec} {cell:?}: {difference:e}");
        }
    }
}

#[test]
fn helix_trace_is_constant_and_far_away_is_background() {
    // (x, y, z) with x and y on the grid of the first, x and z = 0 on that of the second.
    let (flat, upright) = (field("helix:size=21"), field("helix:size=21,plane=xz,offset=20"));
    for i in 0..21 {
        // Spacing 10: row of y = 20, row of z = 0.
        let trace = at(&flat, i, 8).trace() + at(&upright, i, 10).yy();
        assert!((trace - 0.009).abs() < 1e-15, "column {i}: {trace}");
    }
    let far = at(&field("helix:size=9"), 4, 4);
    assert!((far + Tensor2::isotropic(-0.003)).max_abs() < 1e-4, "{far:?}");
}
