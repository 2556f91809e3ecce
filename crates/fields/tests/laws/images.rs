//! Tensor fields of images with known derivatives.

use tigereye_core::math::sin;
use tigereye_core::{Cell, Eigenvalues, Field, Grid, Svd, Tensor2};
use tigereye_fields::images::{gradient_tensors, hessian_tensors, structure_tensors};

const W: usize = 24;
const H: usize = 20;
const SPACING: [f64; 2] = [0.5, 2.0];

/// A field by its value at (x, y), y upwards, in units of length.
fn field<T>(f: impl Fn(f64, f64) -> T) -> Field<T> {
    let place = |c: Cell| (c.x as f64 * SPACING[0], (H - 1 - c.y) as f64 * SPACING[1]);
    Field::from_fn(Grid::new(W, H).expect("a size"), |c| {
        let (x, y) = place(c);
        f(x, y)
    })
}

#[track_caller]
fn near(found: &Tensor2, expected: [f64; 4], tolerance: f64, what: &str) {
    let near = found.components().iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{what}: {found:?} instead of {expected:?}");
}

/// Linear flows have constant gradients, up to the rim, at every scale.
#[test]
fn gradients_of_linear_flows_are_exact() {
    let flow = field(|x, y| [1.0 + 2.0 * x - 3.0 * y, -4.0 + 0.5 * x + 0.25 * y]);
    for sigma in [0.0, 0.7, 3.0] {
        for (cell, t) in gradient_tensors(&flow, SPACING, sigma).iter() {
            near(t, [2.0, -3.0, 0.5, 0.25], 1e-12, &format!("{cell:?}, sigma {sigma}"));
        }
    }
}

/// Away from the rim by the kernel's radius, quadratic fields have their Hessian at every scale.
#[test]
fn hessians_of_quadratic_fields_are_exact_inside() {
    let hill = field(|x, y| 3.0 - x + 1.5 * x * x - 0.5 * x * y + 0.25 * y * y);
    for (sigma, radius) in [(0.0, 1), (0.6, 3), (1.5, 6)] {
        for (cell, t) in hessian_tensors(&hill, SPACING, sigma).iter() {
            let inside = |i: usize, n: usize| i >= radius && i + radius < n;
            if inside(cell.x, W) && inside(cell.y, H) {
                near(t, [3.0, -0.5, -0.5, 0.5], 1e-11, &format!("{cell:?}, sigma {sigma}"));
            }
        }
    }
}

/// A plane wave has one orientation: that of its wave vector. Its mean square slope is half of the amplitude's square.
#[test]
fn structure_tensors_of_waves_have_one_direction() {
    let (kx, ky) = (0.8, 0.3);
    let wave = field(|x, y| sin(kx * x + ky * y));
    let structure = structure_tensors(&wave, SPACING, 0.0, 2.0);
    let t = structure.at(Cell::new(W / 2, H / 2));
    let axes = Svd::of(t);
    assert!(axes.s[1] < 1e-12 * axes.s[0], "one direction: {:?}", axes.s);
    // Differences of neighbours see sin(k d) / d instead of k.
    let (gx, gy) = (sin(kx * SPACING[0]) / SPACING[0], sin(ky * SPACING[1]) / SPACING[1]);
    assert!((t.xy() / t.xx() - gy / gx).abs() < 1e-9, "{t:?}");
    assert!((t.xx() / (0.5 * gx * gx) - 1.0).abs() < 0.05, "{t:?}");
}

#[test]
fn structure_tensors_are_never_negative() {
    // Reproducible noise.
    let noise = field(|x, y| sin(127.1 * x + 311.7 * y + 0.3) * 43758.5453).map(|v: &f64| v - v.floor());
    for t in structure_tensors(&noise, SPACING, 0.5, 1.5).values() {
        let l = Eigenvalues::of(t).real_parts();
        assert!(l[1] >= -1e-14 * l[0] && t.xy() == t.yx(), "{t:?}");
    }
}
