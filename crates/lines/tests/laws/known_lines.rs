//! Lines of fields whose lines are known.

use core::f64::consts::TAU;
use tigereye_core::{CellShape, Field, Point, Tensor2, Vector, length, math};
use tigereye_lines::{
    Axes, Family, Interpolated, LineEnd, LineOptions, Method, TensorLine, ellipse_tensors, half_line_end,
    tensor_line,
};
use tigereye_test_support::field;

fn line(field: &Field<Tensor2>, seed: Point, family: Family, extent: f64) -> TensorLine {
    let between = Interpolated::new(field).with_axes(Axes::Eigenvectors);
    let options = LineOptions { length: extent, step: 0.05, ..LineOptions::default() };
    tensor_line(&between, seed, family, &options, &mut |_| true)
}

/// Range of a quantity along a line.
fn spread(line: &TensorLine, quantity: impl Fn(Point) -> f64) -> f64 {
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
    let load = Point::new(0.5 * (size - 1) as f64, -0.5);
    for seed in [(50.0, 40.0), (70.0, 30.0), (20.0, 50.0)].map(Point::from) {
        let circle = line(&field, seed, Family::Major, 30.0);
        let ray = line(&field, seed, Family::Minor, 20.0);
        assert!(circle.points.len() > 500 && ray.points.len() > 500);
        // Components fall with the third power of the distance: at r cells interpolation is wrong by some 1 / r^2.
        let radius = spread(&circle, |p| length(p - load));
        assert!(radius < 0.02, "{seed:?}: {radius}");
        let angle = spread(&ray, |p| math::atan2(p.y - load.y, p.x - load.x));
        assert!(angle < 0.001, "{seed:?}: {angle}");
    }
}

/// Rays of the star end in its middle; circles about it close.
#[test]
fn stars_have_rays_and_circles() {
    let field = ellipse_tensors(&field("star:size=61"));
    let middle = Point::new(30.0, 30.0);
    for turn in [0.03, 0.21, 0.45, 0.7] {
        let seed = Point::new(30.0 + 20.0 * math::cos(TAU * turn), 30.0 + 20.0 * math::sin(TAU * turn));
        let ray = line(&field, seed, Family::Major, 12.0);
        let bent = spread(&ray, |p| {
            let angle = math::atan2(p.y - middle.y, p.x - middle.x);
            (angle - TAU * turn + 9.0 * core::f64::consts::PI).rem_euclid(TAU)
        });
        assert!(bent < 1e-3, "{turn}: {bent}");
        let circle = line(&field, seed, Family::Minor, 1000.0);
        assert_eq!(circle.ends, [LineEnd::Closed; 2], "{turn}");
        // Between cells that are 1 / 20 rad apart the axis is wrong by less than a thousandth of that.
        assert!(
            circle.gap < 0.01 && spread(&circle, |p| length(p - middle)) < 0.02,
            "{turn}: {}",
            circle.gap
        );
        assert!((circle.length(CellShape::SQUARE) - TAU * 20.0).abs() < 0.05);
    }
}

/// No step of up to a cell jumps across the middle, where the tensor is isotropic.
#[test]
fn rays_end_at_the_middle_of_a_star() {
    let field = ellipse_tensors(&field("star:size=61"));
    let middle = Point::new(30.0, 30.0);
    let between = Interpolated::new(&field);
    let dormand_prince = Method::DormandPrince { tolerance: 1e-6 };
    for method in [Method::RungeKutta4, dormand_prince] {
        for step in [0.05, 0.25, 0.7, 1.0] {
            let options = LineOptions { method, step, length: 25.0, ..LineOptions::default() };
            for seed in [(40.0, 40.0), (19.0, 41.0), (30.0, 44.5), (41.3, 30.0)].map(Point::from) {
                let inwards = Vector::new(middle.x - seed.x, seed.y - middle.y) / length(middle - seed);
                let (end, why) = half_line_end(&between, seed, inwards, Family::Major, &options);
                // Lines end at a thousandth, and on diagonals the anisotropy grows with the square of the distance.
                let off = length(end - middle);
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
        let ring = line(&field, Point::new(25.0 + radius, 25.0), Family::Major, 1.1 * TAU * radius);
        assert!(ring.length(CellShape::SQUARE) > TAU * (radius - 1.0));
        assert!(spread(&ring, |p| length(p - Point::new(25.0, 25.0))) < 1.0);
    }
}

/// Follows an axis given by a formula, in steps small enough to be exact.
fn reference(tensor: &dyn Fn(Point) -> Tensor2, seed: Point, family: Family, extent: f64) -> Point {
    let axis = |p: Point, from: Vector| {
        let axis = Axes::Eigenvectors.of(&tensor(p), 0.0).expect("axes").axes[family as usize];
        if axis.dot(from) < 0.0 { -axis } else { axis }
    };
    let (mut at, mut from, h) = (seed, Vector::new(1.0, 0.0), 0.005);
    for _ in 0..(extent / h).round() as usize {
        let ahead = |k: Vector, h: f64| CellShape::SQUARE.ahead(at, k, h);
        let a = axis(at, from);
        let b = axis(ahead(a, 0.5 * h), a);
        let c = axis(ahead(b, 0.5 * h), b);
        let d = axis(ahead(c, h), c);
        at = ahead((a + b * 2.0 + c * 2.0 + d) / 6.0, h);
        from = d;
    }
    at
}

/// Distance between the ends of the line to the right of a seed and of that of the formula, in widths of the field.
fn deviation(
    spec: &dyn Fn(usize) -> String,
    size: usize,
    tensor: &dyn Fn(Point) -> Tensor2,
    seed: Point,
    family: Family,
) -> f64 {
    let cells = (size - 1) as f64;
    let field = field(&spec(size));
    let seed = seed * cells;
    let found = line(&field, seed, family, 0.2 * cells);
    assert_eq!(found.ends, [LineEnd::Length; 2], "{seed:?}");
    let [first, last] = [found.points[0], found.points[found.points.len() - 1]];
    let right = if first.x > last.x { first } else { last };
    let expected = reference(&|p| tensor(p / cells), seed, family, 0.2 * cells);
    length(right - expected) / cells
}

/// Whether an error falls with the square of the size of a cell.
fn is_of_second_order(coarse: f64, fine: f64, bound: f64) -> bool {
    // A factor of 4 in the limit, with a margin.
    fine < bound && (coarse < 1e-6 || fine < 0.5 * coarse)
}

/// Trajectories of the beam: `tan 2 phi = 2 sxy / sxx`.
#[test]
fn cantilever_has_the_trajectories_of_its_formula() {
    let spec = |size: usize| format!("cantilever:width={size},height={}", (size - 1) / 2 + 1);
    // Positions in widths of the field; the beam is half as high and c is 1/4 of the width.
    let tensor = |p: Point| {
        let (x, y, c) = (p.x, 0.25 - p.y, 0.25);
        let inertia = 2.0 * c * c * c / 3.0;
        Tensor2::symmetric(-x * y / inertia, -(c * c - y * y) / (2.0 * inertia), 0.0)
    };
    for seed in [(0.45, 0.22), (0.5, 0.28)].map(Point::from) {
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
    let tensor = |p: Point| {
        let (x, y) = (8.0 * (p.x - 0.5), 8.0 * (0.5 - p.y));
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
    for seed in [(0.4, 0.3), (0.5, 0.25)].map(Point::from) {
        let [coarse, fine] = [81, 161].map(|size| deviation(&spec, size, &tensor, seed, Family::Major));
        assert!(is_of_second_order(coarse, fine, 1e-3), "{seed:?}: {coarse} {fine}");
    }
}

/// Both integration methods follow the same line.
#[test]
fn methods_agree_where_both_are_exact() {
    let field = ellipse_tensors(&field("inverse:size=61"));
    let between = Interpolated::new(&field);
    let seed = Point::new(40.0, 14.0);
    let fixed = LineOptions { step: 0.01, length: 8.0, ..LineOptions::default() };
    let method = Method::DormandPrince { tolerance: 1e-8 };
    let adaptive = LineOptions { method, step: 1.0, length: 8.0, ..LineOptions::default() };
    let [a, b] = [fixed, adaptive].map(|o| tensor_line(&between, seed, Family::Major, &o, &mut |_| true));
    let last = |l: &TensorLine| l.points[l.points.len() - 1];
    assert!(length(last(&a) - last(&b)) < 1e-5, "{:?} {:?}", last(&a), last(&b));
    assert!(4 * b.points.len() < a.points.len(), "{} {}", b.points.len(), a.points.len());
}
