//! Exponents of lines and flows that are known.

use euclid::Vector2D;
use rayon::prelude::*;
use tigereye_core::{Cell, Cells, Field, Grid, Point, Tensor2, length, math};
use tigereye_lines::{
    Axes, Family, Ftle, FtleOptions, Interpolated, NearestSegment, Polyline, Polylines, RidgeOptions,
    SamplingError, Threshold, advected, ellipse_tensors, exponents, ftle, ridge_lines,
};
use tigereye_test_support::field;

/// A displacement in cells, or in the units of a flow.
type Displacement = Vector2D<f64, Cells>;

fn of(field: &Field<Tensor2>, family: Family, length: f64, samples: usize) -> Ftle {
    let options = FtleOptions { length, samples, step: 0.1, ..FtleOptions::default() };
    ftle(&Interpolated::new(field), family, &options).expect("samples")
}

/// The larger singular value of a shear by s.
fn of_shear(s: f64) -> f64 {
    (1.0 + 0.5 * s * s + s * (1.0 + 0.25 * s * s).sqrt()).sqrt()
}

#[test]
fn parallel_lines_have_exponent_zero() {
    let straight = Field::from_fn(Grid::new(12, 9).expect("a size"), |_| Tensor2::from_axes(0.4, 3.0, 1.0));
    let found = of(&straight, Family::Major, 2.0, 3);
    assert_eq!((found.larger.grid().width(), found.larger.grid().height()), (34, 25));
    // Lines that leave the field have no exponent.
    let known = found.larger.values().iter().filter(|v| v.is_finite());
    assert!(known.clone().count() > 400 && known.into_iter().all(|v| v.abs() < 1e-9));
    assert!(found.left > 0.1 && found.left < 0.4, "{}", found.left);
}

/// Rays diverge like the circles they cross: outwards by (r + L) / r. Circles keep their distance, but inner ones
/// advance by a larger angle: a shear by L / r.
#[test]
fn rays_and_circles_have_their_formulas() {
    let field = ellipse_tensors(&field("star:size=61"));
    let length = 5.0;
    let (rays, circles) = (of(&field, Family::Major, length, 2), of(&field, Family::Minor, length, 2));
    for cell in rays.larger.grid().iter() {
        let (x, y) = (0.5 * cell.x as f64 - 30.0, 0.5 * cell.y as f64 - 30.0);
        let r = math::hypot(x, y);
        if !(12.0..22.0).contains(&r) {
            continue;
        }
        // Error of differences over a cell of functions that vary over r cells, and of the interpolated axes.
        let bend = 1.0 / (r * r);
        let outwards = math::ln(1.0 + length / r) / length;
        let ray = rays.larger.at(cell);
        assert!((ray - outwards).abs() < bend, "{cell:?}: {ray} {outwards}");
        let sheared = math::ln(of_shear(length / r)) / length;
        for circle in [circles.larger.at(cell), circles.smaller.at(cell)] {
            assert!((circle - sheared).abs() < bend, "{cell:?}: {circle} {sheared}");
        }
    }
}

/// The same formula wherever rays do not leave the field, including the diagonals, on which lines run inwards to the
/// middle: none crosses it.
#[test]
fn rays_end_in_the_middle_of_a_star() {
    let length = 10.0;
    // At a cell and between cells. Elsewhere interpolation splits the middle into two wedges, and lines pass between.
    for middle in [Point::new(30.0, 30.0), Point::new(29.5, 30.5)] {
        let field = Field::from_fn(Grid::new(61, 61).expect("a size"), |c| {
            let (x, y) = (c.x as f64 - middle.x, middle.y - c.y as f64);
            let is_round = x == 0.0 && y == 0.0;
            if is_round { Tensor2::IDENTITY } else { Tensor2::from_eigen(math::atan2(y, x), 2.0, 0.5) }
        });
        let options = FtleOptions { length, ..FtleOptions::default() };
        let found = ftle(&Interpolated::new(&field), Family::Major, &options).expect("samples").larger;
        let mut worst = (0.0, 0.0);
        for (cell, value) in found.iter() {
            let r = tigereye_core::length(Point::new(0.5 * cell.x as f64, 0.5 * cell.y as f64) - middle);
            if (3.0..18.0).contains(&r) {
                // Differences over half a cell to either side are off by their square over that of the distance.
                let off = (value - math::ln(1.0 + length / r) / length).abs() * r * r;
                worst = if off <= worst.0 { worst } else { (off, r) };
            }
        }
        assert!(worst.0 < 0.02, "{middle:?}: {worst:?}");
    }
}

/// The axis along (x, -y): hyperbolas. A map along them by arc length has no formula; its gradient is taken of the
/// formula of the axis, in steps and differences so small that they are exact.
#[test]
fn exponents_of_hyperbolas_follow_their_formula() {
    let size = 61;
    let axis = |p: Point| {
        let (x, y) = (p.x - 30.0, 30.0 - p.y);
        // Along (x, -y) with y upwards, which is (x, y) with y downwards.
        Displacement::new(x, y) / math::hypot(x, y)
    };
    let field = Field::from_fn(Grid::new(size, size).expect("a size"), |c| {
        let along = axis(Point::new(c.x as f64, c.y as f64));
        Tensor2::from_eigen(math::atan2(-along.y, along.x), 3.0, 1.0)
    });
    let length = 6.0;
    let found = of(&field, Family::Major, length, 2);
    let velocity = |_: f64, p: Point| axis(p);
    for at in [(40.0, 20.0), (44.5, 18.0), (22.0, 41.5), (38.0, 37.0)].map(Point::from) {
        let end = |dx: f64, dy: f64, sign: f64| {
            advected(&velocity, at + Displacement::new(dx, dy), [0.0, sign * length], 400)
        };
        let exact = [1.0, -1.0].map(|sign| {
            let h = 1e-4;
            let ends = Field::from_fn(Grid::new(3, 3).expect("a size"), |c| {
                Some(end(h * (c.x as f64 - 1.0), h * (c.y as f64 - 1.0), sign))
            });
            *exponents(&ends, [h; 2], length).at(Cell::new(1, 1))
        });
        let expected = exact[0].max(exact[1]);
        let cell = Cell::new((2.0 * at.x) as usize, (2.0 * at.y) as usize);
        let value = found.larger.at(cell);
        assert!((value - expected).abs() < 0.02 * expected, "{at:?}: {value} {expected}");
    }
}

/// The rotated field has the same axes with other signs, and the same exponents.
#[test]
fn exponents_turn_with_the_field() {
    let field = ellipse_tensors(&field("bow:size=25"));
    let plain = of(&field, Family::Major, 6.0, 2).larger;
    let turned = of(&field.quarter_turned(), Family::Major, 6.0, 2).larger;
    let w = plain.grid().width();
    let mut compared = 0;
    for (c, v) in turned.iter() {
        let other = plain.at(Cell::new(w - 1 - c.y, c.x));
        if v.is_finite() || other.is_finite() {
            assert!((v - other).abs() < 1e-9, "{c:?}: {v} {other}");
            compared += 1;
        }
    }
    assert!(compared > 500);
}

/// Velocity of the double gyre (Shadden, Lekien and Marsden 2005) with an added shear, and its gradient.
struct Gyre {
    shear: f64,
}

impl Gyre {
    fn parts(t: f64, x: f64) -> [f64; 3] {
        let a = 0.25 * math::sin(0.2 * math::PI * t);
        [a * x * x + (1.0 - 2.0 * a) * x, 2.0 * a * x + 1.0 - 2.0 * a, 2.0 * a]
    }

    fn velocity(&self, t: f64, Point { x, y, .. }: Point) -> Displacement {
        let ([f, fx, _], pi) = (Self::parts(t, x), math::PI);
        Displacement::new(
            -0.1 * pi * math::sin(pi * f) * math::cos(pi * y) + self.shear * y,
            0.1 * pi * math::cos(pi * f) * math::sin(pi * y) * fx,
        )
    }

    /// Derivatives of the velocity, `[[ux, uy], [vx, vy]]`.
    fn gradient(&self, t: f64, Point { x, y, .. }: Point) -> [[f64; 2]; 2] {
        let ([f, fx, fxx], pi) = (Self::parts(t, x), math::PI);
        let (sf, cf, sy, cy) = (math::sin(pi * f), math::cos(pi * f), math::sin(pi * y), math::cos(pi * y));
        [
            [-0.1 * pi * pi * cf * fx * cy, 0.1 * pi * pi * sf * sy + self.shear],
            [0.1 * pi * (-pi * sf * fx * fx + cf * fxx) * sy, 0.1 * pi * pi * cf * cy * fx],
        ]
    }

    /// The exponent by the variational equation `F' = grad v F`, followed together with the particle.
    fn exponent(&self, start: Point, duration: f64) -> f64 {
        type State = [f64; 6];
        let slope = |t: f64, s: State| -> State {
            let p = Point::new(s[0], s[1]);
            let (v, g) = (self.velocity(t, p), self.gradient(t, p));
            let row = |i: usize, j: usize| g[i][0] * s[2 + j] + g[i][1] * s[4 + j];
            [v.x, v.y, row(0, 0), row(0, 1), row(1, 0), row(1, 1)]
        };
        let (mut s, steps) = ([start.x, start.y, 1.0, 0.0, 0.0, 1.0], 4000);
        let h = duration / f64::from(steps);
        for i in 0..steps {
            let t = f64::from(i) * h;
            let ahead = |k: State, h: f64| -> State { core::array::from_fn(|i| s[i] + h * k[i]) };
            let a = slope(t, s);
            let b = slope(t + 0.5 * h, ahead(a, 0.5 * h));
            let c = slope(t + 0.5 * h, ahead(b, 0.5 * h));
            let d = slope(t + h, ahead(c, h));
            s = ahead(core::array::from_fn(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0), h);
        }
        let [_, _, a, b, c, d] = s;
        let (p, q) = (math::hypot(a - d, b + c), math::hypot(a + d, c - b));
        math::ln(0.5 * (p + q)) / duration
    }
}

/// At the published setting (A = 0.1, epsilon = 0.25, omega = 2 pi / 10, T = 15) the exponent of the flow map is that
/// of the variational equation, and with a shear, which breaks the symmetry.
#[test]
fn double_gyre_has_the_exponents_of_its_variational_equation() {
    let duration = 15.0;
    for shear in [0.0, 0.03] {
        let gyre = Gyre { shear };
        for start in [(0.3, 0.4), (1.0, 0.5), (1.62, 0.27), (0.85, 0.91)].map(Point::from) {
            let h = 1e-5;
            let ends = Field::from_fn(Grid::new(3, 3).expect("a size"), |c| {
                let p = start + Displacement::new(c.x as f64 - 1.0, c.y as f64 - 1.0) * h;
                Some(advected(&|t, p| gyre.velocity(t, p), p, [0.0, duration], 1500))
            });
            let found = *exponents(&ends, [h; 2], duration).at(Cell::new(1, 1));
            let expected = gyre.exponent(start, duration);
            // Second differences of a map that stretches a hundredfold over 1e-5.
            assert!((found - expected).abs() < 1e-6, "{shear} {start:?}: {found} {expected}");
        }
    }
}

/// The exponents of the gyre at `across` samples over two units, and their ridges in units.
fn gyre_ridges(gyre: &Gyre, across: usize) -> Polylines {
    let grid = Grid::new(across, across / 2 + 1).expect("a size");
    let h = 2.0 / (across - 1) as f64;
    let ends: Vec<Point> = (0..grid.cells())
        .into_par_iter()
        .map(|i| {
            let c = grid.cell(i);
            let start = Point::new(h * c.x as f64, h * c.y as f64);
            advected(&|t, p| gyre.velocity(t, p), start, [0.0, 15.0], 150)
        })
        .collect();
    let found = exponents(&Field::from_fn(grid, |c| Some(ends[grid.index(c)])), [h; 2], 15.0);
    // The sharp crest that separates the gyres, without its folds, which only finer samples resolve.
    let options = RidgeOptions {
        least_value: Threshold::Part(0.8),
        least_strength: Threshold::Part(0.2),
        least_extent: 0.1 / h,
        ..RidgeOptions::default()
    };
    let mut ridges = ridge_lines(&found, &options).expect("a mesh").shape;
    ridges.points.iter_mut().for_each(|p| *p *= h);
    ridges
}

/// The stable manifolds at time 0 of the saddles that move along the walls: short segments across each saddle at time
/// `late`, advected backwards, with points at most `spacing` apart.
fn stable_manifolds(gyre: &Gyre, late: f64, spacing: f64) -> Polylines {
    let back = |p: Point, from: f64, to: f64| {
        advected(&|t, p| gyre.velocity(t, p), p, [from, to], (40.0 * (from - to)) as usize)
    };
    let mut all = Polylines::default();
    // Between the gyres and at the upper corners, where the manifolds are the side walls unless there is shear.
    for wall in [(1.0, 0.0), (0.0, 1.0), (2.0, 1.0)].map(Point::from) {
        // Backwards in time a saddle attracts along the wall.
        let saddle = back(wall, late + 40.0, late);
        let inwards = if wall.y == 0.0 { 0.05 } else { -0.05 };
        let end = |share: f64| back(Point::new(saddle.x, wall.y + inwards * share), late, 0.0);
        let first = all.points.len() as u32;
        all.points.push(end(0.0));
        let mut open = vec![(0.0, end(0.0), 1.0, end(1.0))];
        while let Some((a, p, b, q)) = open.pop() {
            if length(p - q) <= spacing {
                all.points.push(q);
                continue;
            }
            let middle = 0.5 * (a + b);
            let between = end(middle);
            open.extend([(middle, between, b, q), (a, p, middle, between)]);
        }
        all.lines.push(Polyline { points: (first..all.points.len() as u32).collect(), closed: false });
    }
    all
}

/// The crest of the exponent is the stable manifold (Haller 2001; Shadden, Lekien and Marsden 2005), which is known
/// without an exponent: nine tenths of it lie within half a cell of 121 samples. The rest are folds thinner than a
/// cell. Doubling the samples does not reduce the distance, since the crest for a finite time lies beside the manifold.
#[test]
fn double_gyre_has_its_ridge_on_the_stable_manifold() {
    for shear in [0.0, 0.03] {
        let gyre = Gyre { shear };
        for across in [121, 241] {
            let cell = 2.0 / 120.0;
            let near = NearestSegment::new(&stable_manifolds(&gyre, 15.0, 0.1 * cell));
            let crest = gyre_ridges(&gyre, across);
            let length: f64 = crest.lines.iter().map(|l| crest.length(l, [1.0; 2])).sum();
            let mut off: Vec<f64> = crest.points.iter().filter_map(|p| near.distance(*p)).collect();
            off.sort_by(f64::total_cmp);
            let found = off[(0.9 * off.len() as f64) as usize] / cell;
            // The domain is 2 by 1, and the crest crosses it more than once.
            assert!(length > 3.0 && found < 0.5, "{shear} {across}: {length} {found}");
        }
    }
}

#[test]
fn degenerate_fields_have_no_exponent() {
    for t in [Tensor2::ZERO, Tensor2::IDENTITY, Tensor2::isotropic(f64::NAN)] {
        for (width, height) in [(1, 1), (1, 6), (7, 5)] {
            let field = Field::from_fn(Grid::new(width, height).expect("a size"), |_| t);
            for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
                let between = Interpolated::new(&field).with_axes(axes);
                let found = ftle(&between, Family::Major, &FtleOptions::default()).expect("samples");
                assert!(found.larger.values().iter().all(|v| v.is_nan()));
                assert_eq!(found.left, 0.0);
            }
        }
    }
    let thin = Field::from_fn(Grid::new(1, 9).expect("a size"), |_| Tensor2::from_axes(1.0, 2.0, 1.0));
    assert!(of(&thin, Family::Major, 2.0, 2).larger.values().iter().all(|v| v.is_nan()));
}

#[test]
fn impossible_sampling_is_refused() {
    let field = field("x:size=5");
    let between = Interpolated::new(&field);
    let with = |length, step, samples| {
        let options = FtleOptions { length, step, samples, ..FtleOptions::default() };
        ftle(&between, Family::Major, &options)
    };
    assert!(matches!(with(1.0, 0.1, 0), Err(SamplingError::Samples { .. })));
    assert!(matches!(with(1.0, 0.1, 65), Err(SamplingError::Samples { .. })));
    for (length, step) in
        [(0.0, 0.1), (f64::NAN, 0.1), (1.0, 0.0), (1.0, f64::NAN), (1e300, 1.0), (-1.0, 0.1)]
    {
        assert!(matches!(with(length, step, 1), Err(SamplingError::Length { .. })), "{length} {step}");
    }
    let large = Field::from_fn(Grid::new(2000, 2000).expect("a size"), |_| Tensor2::IDENTITY);
    let options = FtleOptions { samples: 64, ..FtleOptions::default() };
    assert!(matches!(
        ftle(&Interpolated::new(&large), Family::Major, &options),
        Err(SamplingError::TooManySamples { .. })
    ));
}
