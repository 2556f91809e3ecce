//! Laws of lines and surfaces of equal value.

use tigereye_core::{Cell, Field, Grid, math};
use tigereye_lines::{Surface, Volume, isolines, isosurface};

fn field(width: usize, height: usize, f: impl Fn(f64, f64) -> f64) -> Field<f64> {
    Field::from_fn(Grid::new(width, height).expect("a size"), |c| f(c.x as f64, c.y as f64))
}

fn surface(size: [usize; 3], periodic: [bool; 3], level: f64, f: impl Fn([f64; 3]) -> f64) -> Surface {
    let at = |i: usize| f([i % size[0], i / size[0] % size[1], i / (size[0] * size[1])].map(|v| v as f64));
    let values: Vec<f64> = (0..size.iter().product()).map(at).collect();
    isosurface(&Volume::new(&values, size, periodic).expect("a volume"), level)
}

#[test]
fn a_circle_is_closed_and_round() {
    let r = |x: f64, y: f64| math::hypot(x - 15.3, y - 14.8);
    for radius in [3.0, 9.7] {
        let found = isolines(&field(31, 31, |x, y| -r(x, y)), -radius);
        assert_eq!((found.lines.len(), found.lines[0].closed), (1, true));
        // On an edge the distance is off from linear by at most 1 / (8 r).
        let off = found.points.iter().map(|p| (r(p.x, p.y) - radius).abs()).fold(0.0, f64::max);
        assert!(off < 1.0 / (8.0 * (radius - 1.0)), "{off}");
        let length = found.length(&found.lines[0], [1.0, 1.0]);
        assert!((length / (math::TAU * radius) - 1.0).abs() < 0.02, "{length}");
    }
}

#[test]
fn lines_of_linear_values_are_exact() {
    let found = isolines(&field(20, 15, |x, y| 2.0 * x + y), 21.0);
    assert_eq!((found.lines.len(), found.lines[0].closed), (1, false));
    assert!(found.points.iter().all(|p| (2.0 * p.x + p.y - 21.0).abs() < 1e-12));
    assert!((found.length(&found.lines[0], [1.0, 1.0]) - 14.0 * 1.25_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn levels_at_samples_give_each_point_once() {
    let found = isolines(&field(9, 9, |x, y| -((x - 4.0).abs() + (y - 4.0).abs())), -3.0);
    assert_eq!((found.lines.len(), found.lines[0].closed), (1, true));
    assert!((found.length(&found.lines[0], [1.0, 1.0]) - 12.0 * 2.0_f64.sqrt()).abs() < 1e-12);
    let mut places: Vec<[u64; 2]> = found.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), found.points.len());
}

/// In a square with two opposite high corners, the value at the saddle decides which corners are connected: the
/// contours of the bilinear function never leave their branch of the hyperbola.
#[test]
fn ambiguous_squares_follow_the_bilinear_function() {
    for (corners, joined) in [([3.0, 0.0, 0.0, 3.0], true), ([1.2, -3.0, -3.0, 1.2], false)] {
        // Corners in rows; high on the diagonal from the upper left.
        let found = isolines(&field(2, 2, |x, y| corners[(2.0 * y + x) as usize]), 1.0);
        assert_eq!(found.lines.len(), 2);
        for line in &found.lines {
            let sums: Vec<f64> =
                line.points.iter().map(|&p| found.points[p as usize]).map(|p| p.x + p.y).collect();
            // Joined high corners leave lines around the low ones, on either side of the diagonal x = y.
            let sides: Vec<bool> =
                line.points.iter().map(|&p| found.points[p as usize]).map(|p| p.x > p.y).collect();
            let around_low = sides[0] == sides[1];
            let around_high = (sums[0] < 1.0) == (sums[1] < 1.0);
            assert_eq!((around_low, around_high), (joined, !joined), "{corners:?}");
        }
    }
}

#[test]
fn missing_cells_end_lines() {
    let mut f = field(20, 9, |_, y| y);
    let i = f.grid().index(Cell::new(10, 4));
    f.values_mut()[i] = f64::NAN;
    let found = isolines(&f, 4.5);
    assert_eq!(found.lines.len(), 2);
    assert!(found.points.iter().all(|p| p.x <= 9.0 || p.x >= 11.0));
    for (w, h) in [(1, 1), (1, 7), (7, 1)] {
        assert!(isolines(&field(w, h, |x, y| x + y), 2.5).lines.is_empty());
    }
    for level in [f64::NAN, f64::INFINITY, -1.0, 100.0] {
        assert!(isolines(&f, level).lines.is_empty());
    }
}

#[test]
fn extreme_values_do_not_overflow() {
    let found = isolines(&field(3, 3, |x, _| (x - 1.0) * f64::MAX), 0.5 * f64::MAX);
    assert!(found.points.iter().all(|p| p.x == 1.5), "{found:?}");
}

/// Edges that do not belong to exactly two triangles.
fn open_edges(surface: &Surface) -> usize {
    let mut edges = Vec::new();
    for t in &surface.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            edges.push((a.min(b), a.max(b)));
        }
    }
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|same| same.len() != 2).count()
}

/// Volume inside a closed surface whose normals point outwards, by the divergence theorem.
fn volume_inside(surface: &Surface) -> f64 {
    let corner = |i: u32| surface.points[i as usize];
    let six = |t: &[u32; 3]| {
        let [p, q, r] = t.map(corner);
        p[0] * (q[1] * r[2] - q[2] * r[1])
            + p[1] * (q[2] * r[0] - q[0] * r[2])
            + p[2] * (q[0] * r[1] - q[1] * r[0])
    };
    surface.triangles.iter().map(six).sum::<f64>() / 6.0
}

#[test]
fn a_sphere_is_closed_with_its_area_and_volume() {
    for (middle, radius) in [([10.0, 10.0, 10.0], 7.0), ([9.7, 10.2, 10.4], 8.3)] {
        let f = |p: [f64; 3]| -(0..3).map(|d| (p[d] - middle[d]) * (p[d] - middle[d])).sum::<f64>();
        let found = surface([21, 21, 21], [false; 3], -radius * radius, f);
        assert_eq!(open_edges(&found), 0);
        let area = 2.0 * math::TAU * radius * radius;
        // A polyhedron with sides up to sqrt(3) cells: 1 to 2 per cent at these radii.
        assert!((found.area([1.0; 3]) / area - 1.0).abs() < 0.02, "{}", found.area([1.0; 3]) / area);
        let volume = area * radius / 3.0;
        assert!((volume_inside(&found) / volume - 1.0).abs() < 0.02, "{}", volume_inside(&found) / volume);
    }
}

#[test]
fn periodic_axes_close() {
    // A sphere around the corner of a periodic box: eight pieces that fit together.
    let size = [16, 16, 16];
    let near = |v: f64| v.min(16.0 - v);
    let f = |p: [f64; 3]| -(0..3).map(|d| near(p[d]) * near(p[d])).sum::<f64>();
    let mut found = surface(size, [true; 3], -25.3, f);
    assert!(found.points.iter().flatten().all(|v| (0.0..=16.0).contains(v)));
    let area = 2.0 * math::TAU * 25.3;
    assert!((found.area([1.0; 3]) / area - 1.0).abs() < 0.03);
    // With the two sides of each seam joined, the surface is closed.
    let mut places: Vec<([u64; 3], usize)> = Vec::new();
    for (i, p) in found.points.iter().enumerate() {
        places.push((p.map(|v| if v == 16.0 { 0.0_f64 } else { v }.to_bits()), i));
    }
    places.sort_unstable();
    let mut name = vec![0; places.len()];
    for (n, same) in places.chunk_by(|a, b| a.0 == b.0).enumerate() {
        same.iter().for_each(|(_, i)| name[*i] = n as u32);
    }
    for t in &mut found.triangles {
        *t = t.map(|v| name[v as usize]);
    }
    assert_eq!(open_edges(&found), 0);
}

#[test]
fn planes_through_samples_appear_once() {
    for level in [3.0, 3.5] {
        let found = surface([6, 7, 8], [false; 3], level, |p| p[2]);
        assert!((found.area([1.0; 3]) - 30.0).abs() < 1e-12, "{level}");
        assert!(found.points.iter().all(|p| (p[2] - level).abs() < 1e-12));
    }
}

#[test]
fn missing_samples_and_levels_give_nothing() {
    let hole = |p: [f64; 3]| if p == [3.0, 3.0, 3.0] { f64::NAN } else { p[0] };
    let found = surface([7, 7, 7], [false; 3], 3.5, hole);
    assert!(!found.triangles.is_empty());
    assert!(found.points.iter().all(|p| (p[0] - 3.5).abs() < 1e-12));
    assert!(found.area([1.0; 3]) < 36.0 && found.area([1.0; 3]) > 30.0);
    for (size, level) in [([1, 7, 7], 3.5), ([7, 7, 1], 3.5), ([7, 7, 7], f64::NAN), ([7, 7, 7], 99.0)] {
        assert!(surface(size, [true; 3], level, |p| p[0]).triangles.is_empty());
    }
}
