//! Tensor fields of images with known derivatives.

use tigereye_core::math::sin;
use tigereye_core::{Cell, Eigenvalues, Field, Grid, Svd, Tensor2};
use tigereye_fields::images::{
    gradient_tensors, hessian_tensors, orientation_tensors, strain_rate_tensors, structure_tensors,
};

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

/// Samples everywhere but in the cells of `holes`.
fn without<T: Copy>(field: &Field<T>, holes: &[Cell]) -> Field<Option<T>> {
    Field::from_fn(field.grid(), |c| (!holes.contains(&c)).then(|| *field.at(c)))
}

fn whole<T: Copy>(field: &Field<T>) -> Field<Option<T>> {
    without(field, &[])
}

/// A block of 3 x 2 cells, and one that leaves two columns beside the border.
fn holes() -> Vec<Cell> {
    let block = |x: std::ops::Range<usize>, y: std::ops::Range<usize>| {
        x.flat_map(move |x| y.clone().map(move |y| Cell::new(x, y)))
    };
    block(9..12, 6..8).chain(block(19..22, 13..14)).collect()
}

/// Scales: differences of neighbours, Gaussians without and with weight beyond the next cells.
const SIGMAS: [f64; 6] = [0.0, 0.2, 0.4, 0.7, 1.5, 3.0];
/// Rounding of a fit, relative to values up to 1500 and slopes and curvatures of about 1.
const FITTED: f64 = 1e-9;

/// Linear flows have constant gradients, up to the border and to holes, at every scale.
#[test]
fn gradients_of_linear_flows_are_exact() {
    let flow = field(|x, y| [1.0 + 2.0 * x - 3.0 * y, -4.0 + 0.5 * x + 0.25 * y]);
    for (sigma, holes) in SIGMAS.into_iter().flat_map(|s| [(s, vec![]), (s, holes())]) {
        let flow = without(&flow, &holes);
        for (cell, t) in gradient_tensors(&flow, SPACING, sigma).iter() {
            assert_eq!(t.is_none(), holes.contains(&cell), "{cell:?}, sigma {sigma}");
            if let Some(t) = t {
                near(t, [2.0, -3.0, 0.5, 0.25], FITTED, &format!("{cell:?}, sigma {sigma}"));
            }
        }
    }
}

/// Quadratic flows and hills have their derivatives up to the border and to holes, wherever three samples are in a row,
/// at every scale.
#[test]
fn derivatives_of_quadratic_fields_are_exact_up_to_borders_and_holes() {
    let place = |c: Cell| (c.x as f64 * SPACING[0], (H - 1 - c.y) as f64 * SPACING[1]);
    let hill = field(|x, y| 3.0 - x + 1.5 * x * x - 0.5 * x * y + 0.25 * y * y);
    let flow = hill.map(|h| [*h, -2.0 * h]);
    for (sigma, holes) in SIGMAS.into_iter().flat_map(|s| [(s, vec![]), (s, vec![Cell::new(9, 7)])]) {
        let hessian = hessian_tensors(&without(&hill, &holes), SPACING, sigma);
        let gradient = gradient_tensors(&without(&flow, &holes), SPACING, sigma);
        for (cell, t) in hessian.iter().filter(|(c, _)| !holes.contains(c)) {
            let what = format!("{cell:?}, sigma {sigma}, {} holes", holes.len());
            near(t.as_ref().expect("a tensor"), [3.0, -0.5, -0.5, 0.5], FITTED, &what);
            let (x, y) = place(cell);
            let (gx, gy) = (3.0 * x - 0.5 * y - 1.0, 0.5 * y - 0.5 * x);
            let t = gradient.at(cell).as_ref().expect("a tensor");
            near(t, [gx, gy, -2.0 * gx, -2.0 * gy], FITTED, &what);
        }
    }
}

/// Away from the reach of holes tensors are the bits of those of the field without holes. One-sided stencils reach
/// three cells, and so does the narrowest fit.
#[test]
fn holes_change_nothing_out_of_reach() {
    let hill = field(|x, y| sin(0.7 * x) * sin(0.3 * y));
    let (whole, holed) = (whole(&hill), without(&hill, &holes()));
    for (sigma, reach) in [(0.0, 3), (0.2, 3), (0.4, 3), (0.7, 3), (1.5, 6)] {
        let far = |c: Cell| holes().iter().all(|h| h.x.abs_diff(c.x).max(h.y.abs_diff(c.y)) > reach);
        let (a, b) = (hessian_tensors(&whole, SPACING, sigma), hessian_tensors(&holed, SPACING, sigma));
        assert!(a.iter().filter(|(c, _)| far(*c)).all(|(c, t)| t == b.at(c)), "sigma {sigma}");
        // The window of half a cell reaches two cells further.
        let far = |c: Cell| holes().iter().all(|h| h.x.abs_diff(c.x).max(h.y.abs_diff(c.y)) > reach + 2);
        let (a, b) =
            (structure_tensors(&whole, SPACING, sigma, 0.5), structure_tensors(&holed, SPACING, sigma, 0.5));
        assert!(a.iter().filter(|(c, _)| far(*c)).all(|(c, t)| t == b.at(c)), "sigma {sigma}");
    }
}

/// A sample with a hole at both sides has no difference along that axis, and the cell no tensor.
#[test]
fn cells_without_neighbours_have_no_tensor() {
    let flow = field(|x, y| [x, y]);
    let beside = [Cell::new(9, 7), Cell::new(11, 7)];
    let tensors = gradient_tensors(&without(&flow, &beside), SPACING, 0.0);
    assert_eq!(tensors.iter().filter(|(_, t)| t.is_none()).count(), 3);
    assert_eq!(*tensors.at(Cell::new(10, 7)), None);
    // A Gaussian reaches across.
    let tensors = gradient_tensors(&without(&flow, &beside), SPACING, 1.0);
    assert!(tensors.at(Cell::new(10, 7)).is_some());
    let column = Field::from_fn(Grid::new(1, 9).expect("a size"), |c| Some([c.y as f64; 2]));
    for sigma in [0.0, 1.0] {
        assert!(gradient_tensors(&column, SPACING, sigma).values().iter().all(Option::is_none));
    }
}

#[test]
fn strain_rates_are_the_symmetric_parts_of_gradients() {
    let flow = whole(&field(|x, y| [x * y, x - y * y]));
    let gradient = gradient_tensors(&flow, SPACING, 0.0);
    for (t, cell) in strain_rate_tensors(&flow, SPACING, 0.0).values().iter().zip(gradient.values()) {
        assert_eq!(*t, cell.map(|t| t.symmetric_part()));
    }
}

/// Beside a wave the structure tensor's major axis is along the wave vector, the orientation tensor's along the crests,
/// and both have one trace.
#[test]
fn orientation_tensors_run_along_stripes() {
    let wave = whole(&field(|x, y| sin(0.8 * x + 0.3 * y)));
    let structure = structure_tensors(&wave, SPACING, 0.0, 2.0);
    let orientation = orientation_tensors(&wave, SPACING, 0.0, 2.0);
    for (cell, t) in orientation.iter() {
        let (j, t) = (structure.at(cell).expect("a tensor"), t.expect("a tensor"));
        assert_eq!(t.trace(), j.trace(), "{cell:?}");
        let (across, along) = (Svd::of(&j).major(), Svd::of(&t).major());
        assert!(across.dot(along).abs() < 1e-6, "{cell:?}");
    }
}

/// A plane wave has one orientation: that of its wave vector. Its mean square slope is half of the amplitude's square.
#[test]
fn structure_tensors_of_waves_have_one_direction() {
    let (kx, ky) = (0.8, 0.3);
    let wave = field(|x, y| sin(kx * x + ky * y));
    let structure = structure_tensors(&whole(&wave), SPACING, 0.0, 2.0);
    let t = structure.at(Cell::new(W / 2, H / 2)).expect("a tensor");
    let axes = Svd::of(&t);
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
    for t in structure_tensors(&without(&noise, &holes()), SPACING, 0.5, 1.5).values().iter().flatten() {
        let l = Eigenvalues::of(t).real_parts();
        assert!(l[1] >= -1e-14 * l[0] && t.xy() == t.yx(), "{t:?}");
    }
}
