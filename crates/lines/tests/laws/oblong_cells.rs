//! Cells that are not square: a field has the same lines, points and exponents whatever cells sample it.

use tigereye_core::{Cell, CellShape, Field, Grid, PhysicalPoint, Point, Tensor2, length, math};
use tigereye_lines::{
    Axes, ConvolutionOptions, Family, Ftle, FtleOptions, Interpolated, LineOptions, Method, TensorLine,
    Topology, convolved, evenly_spaced, ftle, tensor_line,
};

/// Half of the side of the square that all fields cover.
const HALF: f64 = 12.0;
/// Square, wide and high cells; the smaller side is 1.
const SHAPES: [[f64; 2]; 3] = [[1.0, 1.0], [2.0, 1.0], [1.0, 3.0]];

/// A field of the position (x, y), y up, sampled in cells of a shape.
fn sampled(sides: [f64; 2], tensor: impl Fn(f64, f64) -> Tensor2) -> Field<Tensor2> {
    let [width, height] = sides.map(|s| (2.0 * HALF / s) as usize + 1);
    Field::from_fn(Grid::new(width, height).expect("a size"), |c| {
        tensor(c.x as f64 * sides[0] - HALF, HALF - c.y as f64 * sides[1])
    })
}

fn over(field: &Field<Tensor2>, sides: [f64; 2]) -> Interpolated<'_> {
    Interpolated::new(field).with_axes(Axes::Eigenvectors).with_cell(CellShape::of(sides))
}

/// The position, with its origin in the middle, of a point in cells.
fn place(p: Point, sides: [f64; 2]) -> PhysicalPoint {
    PhysicalPoint::new(p.x * sides[0] - HALF, HALF - p.y * sides[1])
}

/// The point in cells of a position with its origin in the middle.
fn cells((x, y): (f64, f64), sides: [f64; 2]) -> Point {
    Point::new((x + HALF) / sides[0], (HALF - y) / sides[1])
}

/// Components are linear: bilinear interpolation is exact whatever the cells. A trisector at (0.6, -0.4).
fn trisector(x: f64, y: f64) -> Tensor2 {
    let (x, y) = (x - 0.6, y + 0.4);
    Tensor2::symmetric(2.0 + x, -y + 0.2 * x, 2.0 - x)
}

/// Accumulated rounding of some hundred steps.
const ROUNDING: f64 = 1e-9;

fn farthest(a: &TensorLine, b: &TensorLine, sides: [f64; 2]) -> f64 {
    assert_eq!((a.points.len(), a.ends), (b.points.len(), b.ends));
    let off = |(p, q): (&Point, &Point)| length(place(*p, [1.0; 2]) - place(*q, sides));
    a.points.iter().zip(&b.points).map(off).fold(0.0, f64::max)
}

#[test]
fn lines_are_those_of_square_cells() {
    let square = sampled([1.0; 2], trisector);
    for sides in SHAPES {
        let field = sampled(sides, trisector);
        for family in [Family::Major, Family::Minor] {
            for method in [Method::RungeKutta4, Method::DormandPrince { tolerance: 1e-8 }] {
                let options = LineOptions { method, length: 6.0, ..LineOptions::default() };
                for seed in [(5.0, 3.0), (-4.0, 6.5), (1.5, -7.0)] {
                    let line = |field, sides| {
                        tensor_line(&over(field, sides), cells(seed, sides), family, &options, &mut |_| true)
                    };
                    let (expected, found) = (line(&square, [1.0; 2]), line(&field, sides));
                    assert!(farthest(&expected, &found, sides) < ROUNDING, "{sides:?} {seed:?}");
                    let (a, b) = (expected.length(CellShape::SQUARE), found.length(CellShape::of(sides)));
                    assert!(a > 5.0 && (a - b).abs() < ROUNDING, "{a} {b}");
                }
            }
        }
    }
}

/// For curved components, lines differ by the interpolation error of their direction: h^2 b / 8 / 2 rad for components
/// of size 2 with second derivative b in cells of size h, over a length of 8.
#[test]
fn lines_of_bent_components_differ_by_the_interpolation() {
    let bent = |x: f64, y: f64| Tensor2::from_eigen(0.08 * x - 0.05 * y, 3.0, 1.0);
    let square = sampled([1.0; 2], bent);
    for sides in SHAPES {
        let field = sampled(sides, bent);
        let options = LineOptions { length: 4.0, ..LineOptions::default() };
        let line = |field, sides| {
            tensor_line(&over(field, sides), cells((0.3, 0.2), sides), Family::Major, &options, &mut |_| true)
        };
        let h = sides[0].max(sides[1]);
        let bend = 4.0 * 0.08 * 0.08;
        let off = farthest(&line(&square, [1.0; 2]), &line(&field, sides), sides);
        assert!(off < 8.0 * h * h * bend / 16.0, "{sides:?}: {off}");
    }
}

#[test]
fn cells_of_any_unit_that_are_square_give_the_same_bits() {
    let field = sampled([1.0; 2], trisector);
    let options = LineOptions::default();
    let plain = Interpolated::new(&field);
    let lines = evenly_spaced(&plain, Family::Major, 1.5, &options);
    for spacing in [[0.3, 0.3], [7.0, -7.0], [f64::from(0.7_f32), 0.7]] {
        let other = plain.with_cell(CellShape::of(spacing));
        assert_eq!(evenly_spaced(&other, Family::Major, 1.5, &options), lines);
        let exponents =
            |of: &Interpolated<'_>| ftle(of, Family::Major, &FtleOptions::default()).expect("samples");
        // Compared as text, in which NaN equals NaN.
        assert_eq!(format!("{:?}", exponents(&other)), format!("{:?}", exponents(&plain)));
        let texture = |of: &Interpolated<'_>| {
            convolved(of, Family::Major, &ConvolutionOptions::default()).expect("samples")
        };
        assert_eq!(texture(&other), texture(&plain));
    }
}

#[test]
fn points_and_separatrices_are_those_of_square_cells() {
    let skeleton = |sides: [f64; 2]| {
        let field = sampled(sides, trisector);
        let found =
            Topology::of(&over(&field, sides), &[Family::Major, Family::Minor], &LineOptions::default());
        let points: Vec<_> =
            found.points.iter().map(|p| (place(p.position, sides), p.half_turns())).collect();
        let angles: Vec<f64> = found
            .separatrices
            .iter()
            .map(|s| {
                let (a, b) = (place(s.line.points[0], sides), place(s.line.points[1], sides));
                math::degrees(math::atan2(b.y - a.y, b.x - a.x))
            })
            .collect();
        (points, angles)
    };
    let (points, angles) = skeleton([1.0; 2]);
    assert_eq!((points.len(), angles.len(), points[0].1), (1, 6, -1));
    for sides in SHAPES {
        let (found, turned) = skeleton(sides);
        assert_eq!((found.len(), turned.len(), found[0].1), (1, 6, -1), "{sides:?}");
        for (p, q) in points.iter().zip(&found) {
            assert!(length(p.0 - q.0) < ROUNDING, "{sides:?}");
        }
        // Angles are found between directions a degree apart, linearly.
        assert!(
            angles.iter().zip(&turned).all(|(a, b)| (a - b).abs() < 1e-3),
            "{sides:?}: {angles:?} {turned:?}"
        );
    }
}

#[test]
fn exponents_are_those_of_square_cells() {
    // Samples half a unit apart or nearer.
    let exponents = |sides: [f64; 2], samples: usize| {
        let options = FtleOptions { length: 3.0, step: 0.1, samples, ..FtleOptions::default() };
        let field = sampled(sides, trisector);
        ftle(&over(&field, sides), Family::Major, &options).expect("samples")
    };
    let at = |found: &Ftle, p: (f64, f64), sides: [f64; 2]| {
        let [i, j] = cells(p, sides).to_array().map(|v| (v * found.samples as f64).round() as usize);
        *found.larger.at(Cell::new(i, j))
    };
    let square = exponents([1.0; 2], 6);
    for (sides, samples) in [([2.0, 1.0], 12), ([1.0, 3.0], 18)] {
        let oblong = exponents(sides, samples);
        let (mut compared, mut largest) = (0, 0.0_f64);
        for x in -6..=6 {
            for y in -6..=6 {
                let p = (f64::from(x), f64::from(y));
                let (a, b) = (at(&square, p, [1.0; 2]), at(&oblong, p, sides));
                // Near the point and its separatrices the exponent diverges, and differences depend on their distance.
                if a.is_nan() || b.is_nan() || a > 0.15 || math::hypot(p.0 - 0.6, p.1 + 0.4) < 2.0 {
                    continue;
                }
                assert!((a - b).abs() < 2e-3, "{sides:?} {p:?}: {a} {b}");
                largest = largest.max(a);
                compared += 1;
            }
        }
        assert!(compared > 100 && largest > 0.1, "{compared} {largest}");
    }
}

/// As far apart along the long side of a cell as along the short one.
#[test]
fn lines_keep_their_distance_in_the_unit_of_the_smaller_side() {
    let separation = 2.0;
    for sides in SHAPES {
        for phi in [0.0, 0.7, 0.5 * core::f64::consts::PI] {
            let field = sampled(sides, |_, _| Tensor2::from_eigen(phi, 3.0, 1.0));
            let between = over(&field, sides);
            let lines = evenly_spaced(&between, Family::Major, separation, &LineOptions::default());
            let cell = CellShape::of(sides);
            for (i, a) in lines.iter().enumerate() {
                let others = lines[i + 1..].iter().flat_map(|l| &l.points);
                let nearest = others.flat_map(|q| a.points.iter().map(|p| cell.distance(*p, *q)));
                // Parallel lines, up to the spacing of the compared points.
                assert!(nearest.fold(f64::INFINITY, f64::min) > 0.45 * separation, "{sides:?} {phi}");
            }
            for x in -10..=10 {
                for y in -10..=10 {
                    let p = cells((f64::from(x), f64::from(y)), sides);
                    let near = lines.iter().flat_map(|l| &l.points).map(|q| cell.distance(p, *q));
                    assert!(near.fold(f64::INFINITY, f64::min) < 1.5 * separation, "{sides:?} {phi} {p:?}");
                }
            }
        }
    }
}

/// Textures run along the physical axis, with a grain as wide as it is high.
#[test]
fn textures_run_along_the_physical_axis() {
    for sides in SHAPES {
        let field = sampled(sides, |_, _| Tensor2::from_eigen(0.25 * core::f64::consts::PI, 3.0, 1.0));
        let options = ConvolutionOptions { samples: 2, half_length: 4.0, seed: 3 };
        assert_eq!(options.samples_a_cell(CellShape::of(sides)), sides.map(|s| 2 * s as usize));
        let texture = convolved(&over(&field, sides), Family::Major, &options).expect("samples");
        let difference = |down: bool| {
            let (mut sum, mut count) = (0.0, 0.0);
            for (c, v) in texture.iter().filter(|(c, _)| c.x < 40 && (2..40).contains(&c.y)) {
                let y = if down { c.y + 1 } else { c.y - 1 };
                sum += (v - texture.at(Cell::new(c.x + 1, y))).abs();
                count += 1.0;
            }
            sum / count
        };
        // Up to the right is along, down to the right across.
        assert!(2.0 * difference(false) < difference(true), "{sides:?}");
    }
}
