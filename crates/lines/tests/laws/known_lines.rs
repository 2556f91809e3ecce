//! Lines of fields whose lines are known.

use core::f64::consts::TAU;
use tigereye_core::{CellShape, Field, Tensor2, math};
use tigereye_lines::{
    Axes, Family, Interpolated, LineEnd, LineOptions, Method, TensorLine, ellipse_tensors, half_line_end,
    tensor_line,
};
use tigereye_test_support::field;

fn line(field: &Field<Tensor2>, seed: [f64; 2], family: Family, length: f64) -> TensorLine {
    let between = Interpolated::new(field).with_axes(Axes::Eigenvectors);
    let options = LineOptions { length, step: 0.05, ..LineOptions::default() };
    tensor_line(&between, seed, family, &options, &mut |_| true)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    math::hypot(a[0] - b[0], a[1] - b[1])
}

/// Largest and smallest of a quantity along a line, as a difference.
fn spread(line: &TensorLine, quantity: impl Fn([f64; 2]) -> f64) -> f64 {
    let values = line.points.iter().map(|p| quantity(*p));
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    high - low
}

/// Flamant's principal lines are circles about the load (tension, 0) and its rays (compression). The load lies half a
/// row above the first one.
#[test]
fn flamant_has_rays_and_circles() {
    let size = 101;
    let field = field(&format!("flamant:size={size}"));
    let load = [0.5 * (size - 1) as f64, -0.5];
    for seed in [[50.0, 40.0], [70.0, 30.0], [20.0, 50.0]] {
        let circle = line(&field, seed, Family::Major, 30.0);
        let ray = line(&field, seed, Family::Minor, 20.0);
        assert!(circle.points.len() > 500 && ray.points.len() > 500);
        // Components fall with the third power of the distance: at r cells interpolation is wrong by some 1 / r^2.
        let radius = spread(&circle, |p| distance(p, load));
        assert!(radius < 0.02, "{seed:?}: {radius}");
        let angle = spread(&ray, |p| math::atan2(p[1] - load[1], p[0] - load[0]));
        assert!(angle < 0.001, "{seed:?}: {angle}");
    }
}

/// Rays of the star end in its middle; circles about it close.
#[test]
fn stars_have_rays_and_circles() {
    let field = ellipse_tensors(&field("star:size=61"));
    let middle = [30.0, 30.0];
    for turn in [0.03, 0.21, 0.45, 0.7] {
        let seed = [30.0 + 20.0 * math::cos(TAU * turn), 30.0 + 20.0 * math::sin(TAU * turn)];
        let ray = line(&field, seed, Family::Major, 12.0);
        let bent = spread(&ray, |p| {
            let angle = math::atan2(p[1] - 30.0, p[0] - 30.0);
            (angle - TAU * turn + 9.0 * core::f64::consts::PI).rem_euclid(TAU)
        });
        assert!(bent < 1e-3, "{turn}: {bent}");
        let circle = line(&field, seed, Family::Minor, 1000.0);
        assert_eq!(circle.ends, [LineEnd::Closed; 2], "{turn}");
        // Between cells that are 1 / 20 rad apart the axis is wrong by less than a thousandth of that.
        assert!(
            circle.gap < 0.01 && spread(&circle, |p| distance(p, middle)) < 0.02,
            "{turn}: {}",
            circle.gap
        );
        assert!((circle.length(CellShape::SQUARE) - TAU * 20.0).abs() < 0.05);
    }
}

/// No step of a cell or less leads across the middle, where the tensor is round.
#[test]
fn rays_end_at_the_middle_of_a_star() {
    let field = ellipse_tensors(&field("star:size=61"));
    let between = Interpolated::new(&field);
    let dormand_prince = Method::DormandPrince { tolerance: 1e-6 };
    for method in [Method::RungeKutta4, dormand_prince] {
        for step in [0.05, 0.25, 0.7, 1.0] {
            let options = LineOptions { method, step, length: 25.0, ..LineOptions::default() };
            for seed in [[40.0, 40.0], [19.0, 41.0], [30.0, 44.5], [41.3, 30.0]] {
                let (end, why) = half_line_end(
                    &between,
                    seed,
                    [0, 1].map(|i| (30.0 - seed[i]) / distance(seed, [30.0; 2])),
                    Family::Major,
                    &options,
                );
                // Lines end at a thousandth, and on diagonals the anisotropy grows with the square of the distance.
                let off = distance(end, [30.0; 2]);
                assert!(why == LineEnd::Degenerate && off < 0.04, "{step} {seed:?}: {end:?} {why:?}");
            }
        }
    }
}

/// Cells of the rings take the angle of the curve point that is nearest, a whole degree of a whole radius: lines close
/// within the width of a cell.
#[test]
fn rings_are_circles_within_a_cell() {
    let field = ellipse_tensors(&field("rings:size=51"));
    for radius in [8.0, 14.0, 20.0] {
        let ring = line(&field, [25.0 + radius, 25.0], Family::Major, 1.1 * TAU * radius);
        assert!(ring.length(CellShape::SQUARE) > TAU * (radius - 1.0));
        assert!(spread(&ring, |p| distance(p, [25.0; 2])) < 1.0);
    }
}

/// Follows an axis that is given by a formula, in steps so small that they are exact.
fn reference(tensor: &dyn Fn([f64; 2]) -> Tensor2, seed: [f64; 2], family: Family, length: f64) -> [f64; 2] {
    let axis = |p: [f64; 2], from: [f64; 2]| {
        let [x, y] = Axes::Eigenvectors.of(&tensor(p), 0.0).expect("axes").axes[family as usize];
        let sign = if x * from[0] - y * from[1] < 0.0 { -1.0 } else { 1.0 };
        [sign * x, -sign * y]
    };
    let (mut at, mut from, h) = (seed, [1.0, 0.0], 0.005);
    for _ in 0..(length / h).round() as usize {
        let ahead = |k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
        let a = axis(at, from);
        let b = axis(ahead(a, 0.5 * h), a);
        let c = axis(ahead(b, 0.5 * h), b);
        let d = axis(ahead(c, h), c);
        at = ahead([0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0), h);
        from = d;
    }
    at
}

/// How far lines to the right of a seed end from where the formula leads, in parts of the field's width.
fn deviation(
    spec: &dyn Fn(usize) -> String,
    size: usize,
    tensor: &dyn Fn([f64; 2]) -> Tensor2,
    seed: [f64; 2],
    family: Family,
) -> f64 {
    let cells = (size - 1) as f64;
    let field = field(&spec(size));
    let seed = seed.map(|v| v * cells);
    let found = line(&field, seed, family, 0.2 * cells);
    assert_eq!(found.ends, [LineEnd::Length; 2], "{seed:?}");
    let [first, last] = [found.points[0], found.points[found.points.len() - 1]];
    let right = if first[0] > last[0] { first } else { last };
    let expected = reference(&|p| tensor(p.map(|v| v / cells)), seed, family, 0.2 * cells);
    distance(right, expected) / cells
}

/// A quantity that is wrong by the square of the cell's size.
fn is_of_second_order(coarse: f64, fine: f64, bound: f64) -> bool {
    // Four times smaller, and more or less because the order is that of a limit.
    fine < bound && (coarse < 1e-6 || fine < 0.5 * coarse)
}

/// Trajectories of the beam: `tan 2 phi = 2 sxy / sxx`.
#[test]
fn cantilever_has_the_trajectories_of_its_formula() {
    let spec = |size: usize| format!("cantilever:width={size},height={}", (size - 1) / 2 + 1);
    // Positions in widths of the field; the beam is half as high and c is 1/4 of the width.
    let tensor = |p: [f64; 2]| {
        let (x, y, c) = (p[0], 0.25 - p[1], 0.25);
        let inertia = 2.0 * c * c * c / 3.0;
        Tensor2::symmetric(-x * y / inertia, -(c * c - y * y) / (2.0 * inertia), 0.0)
    };
    for seed in [[0.45, 0.22], [0.5, 0.28]] {
        for family in [Family::Major, Family::Minor] {
            let [coarse, fine] = [41, 81].map(|size| deviation(&spec, size, &tensor, seed, family));
            assert!(is_of_second_order(coarse, fine, 1e-4), "{seed:?} {family:?}: {coarse} {fine}");
        }
    }
}

/// Stress trajectories around the hole, from its formula in polar coordinates.
#[test]
fn kirsch_has_the_trajectories_of_its_formula() {
    let spec = |size: usize| format!("kirsch:size={size}");
    let tensor = |p: [f64; 2]| {
        let (x, y) = (8.0 * (p[0] - 0.5), 8.0 * (0.5 - p[1]));
        let (r2, t) = (x * x + y * y, math::atan2(y, x));
        let (a2, a4) = (1.0 / r2, 1.0 / (r2 * r2));
        let (cos2, sin2) = (math::cos(2.0 * t), math::sin(2.0 * t));
        let rr = 0.5 * (1.0 - a2) + 0.5 * (1.0 - 4.0 * a2 + 3.0 * a4) * cos2;
        let tt = 0.5 * (1.0 + a2) - 0.5 * (1.0 + 3.0 * a4) * cos2;
        let rt = -0.5 * (1.0 + 2.0 * a2 - 3.0 * a4) * sin2;
        let (c, s) = (math::cos(t), math::sin(t));
        Tensor2::symmetric(
            rr * c * c + tt * s * s - 2.0 * rt * s * c,
            (rr - tt) * s * c + rt * (c * c - s * s),
            rr * s * s + tt * c * c + 2.0 * rt * s * c,
        )
    };
    for seed in [[0.4, 0.3], [0.5, 0.25]] {
        let [coarse, fine] = [81, 161].map(|size| deviation(&spec, size, &tensor, seed, Family::Major));
        assert!(is_of_second_order(coarse, fine, 1e-3), "{seed:?}: {coarse} {fine}");
    }
}

/// Both methods follow the same line.
#[test]
fn methods_agree_where_both_are_exact() {
    let field = ellipse_tensors(&field("inverse:size=61"));
    let between = Interpolated::new(&field);
    let seed = [40.0, 14.0];
    let fixed = LineOptions { step: 0.01, length: 8.0, ..LineOptions::default() };
    let method = Method::DormandPrince { tolerance: 1e-8 };
    let adaptive = LineOptions { method, step: 1.0, length: 8.0, ..LineOptions::default() };
    let [a, b] = [fixed, adaptive].map(|o| tensor_line(&between, seed, Family::Major, &o, &mut |_| true));
    let last = |l: &TensorLine| l.points[l.points.len() - 1];
    assert!(distance(last(&a), last(&b)) < 1e-5, "{:?} {:?}", last(&a), last(&b));
    assert!(4 * b.points.len() < a.points.len(), "{} {}", b.points.len(), a.points.len());
}
