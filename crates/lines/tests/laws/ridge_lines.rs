//! Laws of ridge lines: exactly known crests, symmetries, and fields without ridges.

use tigereye_core::{Cell, Field, Grid, Point, SplitMix64, math};
use tigereye_lines::{ExtractionError, NearestSegment, RidgeLines, RidgeOptions, Threshold, ridge_lines};

fn field(width: usize, height: usize, f: impl Fn(f64, f64) -> f64) -> Field<f64> {
    Field::from_fn(Grid::new(width, height).expect("a size"), |c| f(c.x as f64, c.y as f64))
}

fn ridges(field: &Field<f64>) -> RidgeLines {
    ridge_lines(field, &RidgeOptions::default()).expect("good options")
}

/// A sine has weaker crests of its own, across the outer side of each bend, where the value is largest by symmetry.
fn strong_ridges(field: &Field<f64>) -> RidgeLines {
    let options = RidgeOptions { least_strength: Threshold::Part(0.3), ..RidgeOptions::default() };
    ridge_lines(field, &options).expect("good options")
}

fn gauss(d: f64, width: f64) -> f64 {
    math::exp(-0.5 * d * d / (width * width))
}

/// Largest deviation of points from where they should be, in cells.
fn worst(found: &RidgeLines, deviation: impl Fn(Point) -> f64) -> f64 {
    found.shape.points.iter().map(|p| deviation(*p).abs()).fold(0.0, f64::max)
}

/// Position error of the interpolation for a crest two cells wide (standard deviation), in cells.
const CREST: f64 = 0.01;

/// The slope across a straight crest is zero on it by symmetry, whatever the profile.
#[test]
fn straight_crests_are_found_at_any_angle() {
    for degrees in [0.0, 17.0, 45.0, 63.0, 90.0, 135.0, 160.0] {
        let (s, c) = (math::sin(math::radians(degrees)), math::cos(math::radians(degrees)));
        let across = |x: f64, y: f64| -s * (x - 20.3) + c * (y - 19.8);
        let found = ridges(&field(41, 41, |x, y| 3.0 * gauss(across(x, y), 2.0)));
        assert_eq!(found.length.len(), 1, "{degrees}: {:?}", found.length);
        assert!(worst(&found, |p| across(p.x, p.y)) < CREST, "{degrees}");
        assert!(found.length[0] > 37.0, "{degrees}: {}", found.length[0]);
        // The second derivative of the profile on the crest, 3 / w^2; splines know it to second order.
        assert!(found.strength.iter().all(|v| (v - 0.75).abs() < 0.03), "{degrees}");
        assert!(found.value.iter().all(|v| (v - 3.0).abs() < 0.03), "{degrees}");
    }
}

#[test]
fn crests_through_samples_are_one_line() {
    let found = ridges(&field(30, 21, |_, y| -(y - 10.0) * (y - 10.0)));
    assert_eq!((found.length.len(), found.shape.lines[0].closed), (1, false));
    // Rounding: a parabola is reproduced.
    assert!(worst(&found, |p| p.y - 10.0) < 1e-12);
    assert!((found.length[0] - 27.0).abs() < 1e-9);
}

/// A radial function has its crest where it is largest, as its Hessian's axes are radial.
#[test]
fn round_crests_close() {
    for radius in [9.0, 11.3, 15.0] {
        let r = |x: f64, y: f64| math::hypot(x - 23.2, y - 22.7);
        let parabola = |x: f64, y: f64| -(r(x, y) - radius) * (r(x, y) - radius);
        let bump = |x: f64, y: f64| gauss(r(x, y) - radius, 2.0);
        for f in [&parabola as &dyn Fn(f64, f64) -> f64, &bump] {
            let found = ridges(&field(47, 47, f));
            assert_eq!(found.length.len(), 1, "{radius}: {:?}", found.length);
            assert!(found.shape.lines[0].closed);
            assert!(worst(&found, |p| r(p.x, p.y) - radius) < CREST, "{radius}");
            // A polygon with sides below one cell is shorter by less than 1/(24 r^2) of the circle.
            let circle = math::TAU * radius;
            assert!((found.length[0] / circle - 1.0).abs() < 2e-3, "{radius}: {}", found.length[0] / circle);
        }
    }
}

/// A crest along a sine, and its height ridge by bisection of the analytic derivatives: the ridge of a function of
/// y - A sin(k x) is not the sine itself.
struct SineCrest {
    amplitude: f64,
    wave: f64,
    width: f64,
}

impl SineCrest {
    fn middle(&self, x: f64) -> f64 {
        20.0 + self.amplitude * math::sin(self.wave * x)
    }
    fn value(&self, x: f64, y: f64) -> f64 {
        gauss(y - self.middle(x), self.width)
    }
    /// Slope along the eigenvector of the smallest eigenvalue, oriented towards larger y.
    fn slope(&self, x: f64, y: f64) -> f64 {
        let (a, k, w) = (self.amplitude, self.wave, self.width);
        let d = y - self.middle(x);
        let (dx, dxx) = (-a * k * math::cos(k * x), a * k * k * math::sin(k * x));
        let f = self.value(x, y);
        // f' and f'' with respect to d.
        let (f1, f2) = (-d / (w * w) * f, (d * d / (w * w) - 1.0) / (w * w) * f);
        let (xx, xy, yy) = (f2 * dx * dx + f1 * dxx, f2 * dx, f2);
        // The axis of the larger eigenvalue lies at half the angle of (xx - yy, 2 xy); the other is normal to it.
        let angle = 0.5 * math::atan2(2.0 * xy, xx - yy) + math::FRAC_PI_2;
        let (c, s) = (math::cos(angle), math::sin(angle));
        let slope = c * f1 * dx + s * f1;
        if s < 0.0 { -slope } else { slope }
    }
    /// The ridge above `x`, from a bracket of half a width around the sine.
    fn ridge(&self, x: f64) -> f64 {
        let (mut low, mut high) = (self.middle(x) - 0.5 * self.width, self.middle(x) + 0.5 * self.width);
        assert!(self.slope(x, low) > 0.0 && self.slope(x, high) < 0.0);
        for _ in 0..60 {
            let y = 0.5 * (low + high);
            if self.slope(x, y) > 0.0 { low = y } else { high = y }
        }
        0.5 * (low + high)
    }
}

#[test]
fn a_sine_crest_has_its_analytic_ridge() {
    let crest = SineCrest { amplitude: 5.0, wave: math::TAU / 40.0, width: 2.5 };
    let found = strong_ridges(&field(61, 41, |x, y| crest.value(x, y)));
    assert_eq!(found.length.len(), 1, "{:?}", found.length);
    let error = worst(&found, |p| p.y - crest.ridge(p.x));
    assert!(error < CREST, "{error}");
    assert!(found.length[0] > 58.0);
}

#[test]
fn errors_fall_at_least_with_the_square_of_the_cell() {
    let error = |n: f64| {
        let crest = SineCrest { amplitude: 5.0 * n, wave: math::TAU / (40.0 * n), width: 2.0 * n };
        let side = |v: f64| (v * n) as usize + 1;
        let found = strong_ridges(&field(side(60.0), side(40.0), |x, y| crest.value(x, y + 20.0 - 20.0 * n)));
        worst(&found, |p| p.y - 20.0 * n + 20.0 - crest.ridge(p.x)) / n
    };
    let (coarse, fine) = (error(1.0), error(2.0));
    assert!(coarse / fine > 4.0, "{coarse} {fine}");
}

#[test]
fn a_saddle_has_the_crest_through_it() {
    let found = ridges(&field(21, 21, |x, y| (x - 9.7) * (x - 9.7) - (y - 10.4) * (y - 10.4)));
    assert_eq!(found.length.len(), 1);
    // Rounding: a parabola is reproduced.
    assert!(worst(&found, |p| p.y - 10.4) < 1e-10);
    assert!((found.length[0] - 18.0).abs() < 1e-9);
}

#[test]
fn valleys_ramps_constants_and_noise_have_no_ridges() {
    let mut numbers = SplitMix64::new(5);
    let mut noise = move || numbers.unit() - 0.5;
    let noisy = Field::from_fn(Grid::new(30, 30).expect("a size"), |_| 1.0 + 1e-15 * noise());
    let fields = [
        field(30, 25, |x, y| 0.3 * x - 0.7 * y + 5.0),
        field(30, 25, |x, y| (x + 0.4 * y - 15.0) * (x + 0.4 * y - 15.0)),
        field(30, 25, |x, y| math::hypot(x - 14.6, y - 12.1)),
        field(30, 25, |_, _| -4.2),
        field(30, 25, |_, _| 0.0),
        noisy,
    ];
    for (i, f) in fields.iter().enumerate() {
        assert_eq!(ridges(f).length, [0.0; 0], "field {i}");
    }
    // A rotationally symmetric peak has no crest except the peak itself.
    let peak = ridges(&field(41, 41, |x, y| gauss(math::hypot(x - 20.3, y - 19.6), 4.0)));
    assert!(peak.length.iter().all(|l| *l < 1.0), "{:?}", peak.length);
}

#[test]
fn thin_and_empty_fields_have_no_ridges() {
    for (w, h) in [(1, 1), (1, 9), (9, 1), (2, 2), (3, 1)] {
        for bad in [0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(ridges(&field(w, h, |_, _| bad)).length, [0.0; 0]);
        }
        ridges(&field(w, h, |x, y| x * y - x));
    }
    // Two columns are enough for a crest along y.
    let two = ridges(&field(2, 9, |_, y| -(y - 4.3) * (y - 4.3)));
    assert_eq!(two.length.len(), 1);
}

#[test]
fn ridges_turn_with_the_field() {
    let crest = SineCrest { amplitude: 4.0, wave: math::TAU / 35.0, width: 2.0 };
    let plain = strong_ridges(&field(50, 41, |x, y| crest.value(x, y)));
    let turned = strong_ridges(&field(41, 50, |x, y| crest.value(49.0 - y, x)));
    assert_eq!(plain.length.len(), turned.length.len());
    let nearest = NearestSegment::new(&turned.shape);
    // Points lie on the same curve; between them it is a chord, off by an eighth of a squared step times the curvature.
    let away = |p: Point| nearest.distance(Point::new(p.y, 49.0 - p.x)).expect("a line");
    assert!(worst(&plain, away) < 0.01);
}

/// Four crests from the middle to the corners, weak beside the rest: those of one diagonal are found as those of the
/// other.
#[test]
fn mirrored_fields_have_mirrored_ridges() {
    let star = |x: f64, y: f64| {
        let (x, y) = (x - 20.0, y - 20.0);
        let r = math::hypot(x, y);
        6.0 * math::exp(-r * r / 8.0) - 0.004 * r * r + 0.4 * math::cos(8.0 * math::atan2(y, x))
    };
    for samples_per_cell in [2, 4] {
        let options = RidgeOptions { samples_per_cell, ..RidgeOptions::default() };
        let [plain, mirrored] = [false, true].map(|mirror| {
            let side = |x: f64| if mirror { 40.0 - x } else { x };
            ridge_lines(&field(41, 41, |x, y| star(side(x), y)), &options).expect("good options")
        });
        assert_eq!(plain.length.len(), mirrored.length.len());
        for found in [&plain, &mirrored] {
            let nearest = NearestSegment::new(&found.shape);
            let away = |p: Point| nearest.distance(Point::new(40.0 - p.x, p.y)).expect("a line");
            assert!(worst(found, away) < 1e-6, "its own mirror image");
        }
    }
}

#[test]
fn missing_cells_keep_ridges_away_and_elsewhere_unchanged() {
    let whole = field(41, 41, |x, y| gauss(y - 20.0 - 0.2 * (x - 20.0), 2.0));
    let mut masked = whole.clone();
    for y in 18..23 {
        for x in 15..21 {
            let i = masked.grid().index(Cell::new(x, y));
            masked.values_mut()[i] = if x == 18 { f64::INFINITY } else { f64::NAN };
        }
    }
    let found = ridges(&masked);
    assert_eq!(found.length.len(), 2, "{:?}", found.length);
    assert!(found.shape.points.iter().all(|p| p.x < 13.0 || p.x > 22.0));
    assert!(found.shape.points.iter().any(|p| p.x > 11.0 && p.x < 13.0));
    assert!(worst(&found, |p| p.y - 20.0 - 0.2 * (p.x - 20.0)) < CREST);
    // A missing border is cut off without effect.
    let inner = field(43, 43, |x, y| {
        let border = x == 0.0 || y == 0.0 || x == 42.0 || y == 42.0;
        if border { f64::NAN } else { gauss(y - 21.0 - 0.2 * (x - 21.0), 2.0) }
    });
    let (a, b) = (ridges(&whole), ridges(&inner));
    assert_eq!(a.value, b.value);
    assert!(a.shape.points.iter().zip(&b.shape.points).all(|(p, q)| q.x == p.x + 1.0 && q.y == p.y + 1.0));
}

#[test]
fn filters_keep_what_is_strong_high_and_long() {
    // Crests of height 1, and of 0.2 that falls to 0.1 halfway.
    let height = |x: f64| 0.15 - 0.05 * math::tanh((x - 29.5) / 2.0);
    let two = field(60, 60, |x, y| gauss(y - 15.2, 2.0) + height(x) * gauss(y - 44.7, 2.0));
    let with = |options: RidgeOptions| ridge_lines(&two, &options).expect("good options");
    let count = |options| with(options).shape.points.iter().filter(|p| p.y > 30.0).count();
    let plain = RidgeOptions::default();
    assert!(count(plain) > 100);
    assert_eq!(count(RidgeOptions { least_value: Threshold::Part(0.3), ..plain }), 0);
    assert_eq!(count(RidgeOptions { least_value: Threshold::Absolute(0.3), ..plain }), 0);
    assert_eq!(count(RidgeOptions { least_strength: Threshold::Part(0.3), ..plain }), 0);
    assert_eq!(count(RidgeOptions { least_strength: Threshold::Absolute(0.1), ..plain }), 0);
    let half = with(RidgeOptions { least_strength: Threshold::Part(0.15), ..plain });
    assert_eq!(half.length.len(), 2);
    assert!(half.length[0] > 56.0 && half.length[1] > 25.0 && half.length[1] < 32.0, "{:?}", half.length);
    let long = with(RidgeOptions { least_extent: 40.0, least_strength: Threshold::Part(0.15), ..plain });
    assert_eq!(long.length.len(), 1);
    assert!((long.bounds.strength / long.bounds.strongest - 0.15).abs() < 1e-15);
}

#[test]
fn scales_of_values_do_not_matter() {
    let at = |scale: f64| ridges(&field(31, 31, |x, y| scale * gauss(y - 15.3 - 0.1 * x, 2.0)));
    let plain = at(1.0);
    // Powers of two, so that nothing is rounded; the largest would overflow in sums.
    for exponent in [-900, 1000] {
        let scale = math::scale_by_power_of_two(1.0, exponent);
        assert_eq!(at(scale).shape, plain.shape, "2^{exponent}");
    }
}

#[test]
fn scaled_axes_are_those_of_the_scaled_field() {
    // The same crest on cells twice as high as wide.
    let f = |x: f64, y: f64| gauss(0.6 * (x - 20.0) + 0.8 * (y - 20.0), 3.0);
    let options = RidgeOptions { cell: [1.0, 2.0, 1.0], ..RidgeOptions::default() };
    let found = ridge_lines(&field(41, 21, |x, y| f(x, 2.0 * y)), &options).expect("good options");
    assert!(worst(&found, |p| 0.6 * (p.x - 20.0) + 0.8 * (2.0 * p.y - 20.0)) < CREST);
    assert!(found.strength.iter().all(|v| (v * 9.0 - 1.0).abs() < 0.05), "{:?}", &found.strength[..5]);
    // From column 1 to 39, and in y three quarters of it.
    assert!((found.length[0] - 47.5).abs() < 0.5, "{}", found.length[0]);
}

#[test]
fn impossible_options_are_refused() {
    let f = field(9, 9, |x, _| x);
    let plain = RidgeOptions::default();
    for bad in [
        RidgeOptions { samples_per_cell: 0, ..plain },
        RidgeOptions { cell: [1.0, 0.0, 1.0], ..plain },
        RidgeOptions { cell: [f64::NAN, 1.0, 1.0], ..plain },
        RidgeOptions { least_value: Threshold::Part(1.5), ..plain },
        RidgeOptions { least_strength: Threshold::Absolute(f64::NAN), ..plain },
        RidgeOptions { least_extent: -1.0, ..plain },
        RidgeOptions { rounding: f64::INFINITY, ..plain },
        RidgeOptions { most_nodes: usize::MAX, ..plain },
    ] {
        assert!(matches!(ridge_lines(&f, &bad), Err(ExtractionError::Option { .. })), "{bad:?}");
    }
    for samples_per_cell in [10_000, usize::MAX] {
        let result = ridge_lines(&f, &RidgeOptions { samples_per_cell, ..plain });
        assert!(matches!(result, Err(ExtractionError::MeshSize { .. })));
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let crest = SineCrest { amplitude: 4.0, wave: math::TAU / 35.0, width: 2.0 };
    let f = field(50, 41, |x, y| crest.value(x, y) + 0.5 * crest.value(y, x));
    let with = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        pool.install(|| ridges(&f))
    };
    assert_eq!(with(1), with(3));
}
