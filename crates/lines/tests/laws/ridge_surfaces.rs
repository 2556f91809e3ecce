//! Laws of ridge surfaces: exactly known crests in periodic and open volumes.

use tigereye_core::math;
use tigereye_lines::{ExtractionError, RidgeOptions, RidgeSurface, Threshold, Volume, ridge_surface};

fn values(size: [usize; 3], f: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
    let at =
        |i: usize| f((i % size[0]) as f64, (i / size[0] % size[1]) as f64, (i / (size[0] * size[1])) as f64);
    (0..size.iter().product()).map(at).collect()
}

fn ridges_with(values: &[f64], size: [usize; 3], round: bool, options: &RidgeOptions) -> RidgeSurface {
    let volume = Volume::new(values, size, [false, false, round]).expect("a volume");
    ridge_surface(&volume, options).expect("good options")
}

fn ridges(values: &[f64], size: [usize; 3], round: bool) -> RidgeSurface {
    ridges_with(values, size, round, &RidgeOptions::default())
}

fn gauss(d: f64, width: f64) -> f64 {
    math::exp(-0.5 * d * d / (width * width))
}

fn worst(found: &RidgeSurface, deviation: impl Fn([f64; 3]) -> f64) -> f64 {
    found.shape.points.iter().map(|p| deviation(*p).abs()).fold(0.0, f64::max)
}

/// Number of triangles of each edge, with the two sides of the seam identified. `inside` tells which points are away
/// from the border.
fn edges_by_use(found: &RidgeSurface, period: f64, inside: impl Fn([f64; 3]) -> bool) -> [usize; 4] {
    let mut places: Vec<([u64; 3], usize)> = Vec::new();
    for (i, p) in found.shape.points.iter().enumerate() {
        let z = if p[2] == period { 0.0 } else { p[2] };
        places.push(([p[0], p[1], z].map(f64::to_bits), i));
    }
    places.sort_unstable();
    let mut name = vec![0; places.len()];
    for (n, same) in places.chunk_by(|a, b| a.0 == b.0).enumerate() {
        same.iter().for_each(|(_, i)| name[*i] = n);
    }
    let mut edges = Vec::new();
    for t in &found.shape.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (a, b) = (a as usize, b as usize);
            if inside(found.shape.points[a]) && inside(found.shape.points[b]) {
                edges.push((name[a].min(name[b]), name[a].max(name[b])));
            }
        }
    }
    edges.sort_unstable();
    let mut counts = [0; 4];
    for same in edges.chunk_by(|a, b| a == b) {
        counts[same.len().min(4) - 1] += 1;
    }
    counts
}

/// Position error of the interpolation for a crest two samples wide (standard deviation).
const CREST: f64 = 0.01;

#[test]
fn planes_are_found_at_any_angle() {
    let size = [17, 16, 15];
    for n in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0]] {
        for middle in [[8.0, 7.0, 7.0], [7.6, 8.3, 7.1]] {
            let d = |x: f64, y: f64, z: f64| {
                n[0] * (x - middle[0]) + n[1] * (y - middle[1]) + n[2] * (z - middle[2])
            };
            let found = ridges(&values(size, |x, y, z| gauss(d(x, y, z), 2.0)), size, false);
            assert_eq!(found.area.len(), 1, "{n:?}: {:?}", found.area);
            assert!(worst(&found, |[x, y, z]| d(x, y, z)) < CREST, "{n:?}");
            assert!(found.strength.iter().all(|s| (s - 0.25).abs() < 0.01), "{n:?}");
            // The section of the box with the plane, at least over the whole of its shadow along the longest axis.
            let shadow = [13.0 * 12.0, 14.0 * 12.0, 14.0 * 13.0];
            let most = (0..3).max_by(|&a, &b| n[a].abs().total_cmp(&n[b].abs())).expect("three");
            assert!(found.area[0] < 1.01 * shadow[most] / n[most].abs(), "{n:?} {:?}", found.area);
            if n[most] == 1.0 {
                assert!((found.area[0] - shadow[most]).abs() < 0.02 * shadow[most], "{:?}", found.area);
            }
        }
    }
}

#[test]
fn a_cylinder_closes_around_and_over_the_seam() {
    let size = [33, 33, 8];
    let r = |x: f64, y: f64| math::hypot(x - 16.2, y - 15.7);
    let found = ridges(&values(size, |x, y, _| gauss(r(x, y) - 8.0, 2.0)), size, true);
    assert_eq!(found.area.len(), 1, "{:?}", found.area);
    assert!(worst(&found, |[x, y, _]| r(x, y) - 8.0) < CREST);
    let area = math::TAU * 8.0 * 8.0;
    assert!((found.area[0] / area - 1.0).abs() < 5e-3, "{}", found.area[0] / area);
    // A closed surface without a border: every edge is in two triangles.
    let [one, two, three, more] = edges_by_use(&found, 8.0, |_| true);
    assert!(one == 0 && three == 0 && more == 0 && two > 1000, "{one} {two} {three} {more}");
    assert!(found.shape.points.iter().all(|p| (0.0..=8.0).contains(&p[2])));
}

/// A crest along direction phi(z) through the middle: over one period of z it rotates by half a turn and returns
/// to itself. Its value is 1 and nowhere larger, so the gradient on it is zero.
struct Helicoid {
    samples: usize,
}

impl Helicoid {
    fn value(&self, x: f64, y: f64, z: f64) -> f64 {
        let phi = math::PI * z / self.samples as f64;
        let across = -math::sin(phi) * (x - 10.0) + math::cos(phi) * (y - 10.0);
        gauss(across, 2.5)
    }
    fn deviation(&self, [x, y, z]: [f64; 3]) -> f64 {
        let phi = math::PI * z / self.samples as f64;
        -math::sin(phi) * (x - 10.0) + math::cos(phi) * (y - 10.0)
    }
    fn values(&self, shift: usize) -> Vec<f64> {
        values([21, 21, self.samples], |x, y, z| self.value(x, y, z + shift as f64))
    }
}

/// Winding crests have weaker ones beside them.
fn strong() -> RidgeOptions {
    RidgeOptions { least_strength: Threshold::Part(0.15), ..RidgeOptions::default() }
}

#[test]
fn a_helicoid_winds_through_the_seam() {
    let helicoid = Helicoid { samples: 24 };
    let size = [21, 21, 24];
    let found = ridges_with(&helicoid.values(0), size, true, &strong());
    assert_eq!(found.area.len(), 1, "{:?}", found.area);
    let error = worst(&found, |p| helicoid.deviation(p));
    assert!(error < CREST, "{error}");
    let inside = |p: [f64; 3]| p[0] > 2.0 && p[0] < 18.0 && p[1] > 2.0 && p[1] < 18.0;
    let [one, two, three, more] = edges_by_use(&found, 24.0, inside);
    assert!(one == 0 && three == 0 && more == 0 && two > 1000, "{one} {two} {three} {more}");
}

#[test]
fn shifting_the_direction_shifts_the_surface() {
    let helicoid = Helicoid { samples: 24 };
    let size = [21, 21, 24];
    let (plain, shifted) = (
        ridges_with(&helicoid.values(0), size, true, &strong()),
        ridges_with(&helicoid.values(5), size, true, &strong()),
    );
    // Points of the shifted surface are those of the original up to rounding of the periodic filter.
    let places = |found: &RidgeSurface, shift: f64| {
        let mut places: Vec<[i64; 3]> = Vec::new();
        for p in &found.shape.points {
            let z = (p[2] + shift).rem_euclid(24.0);
            places.push([p[0], p[1], if z > 23.999_99 { 0.0 } else { z }].map(|v| (v * 1e5).round() as i64));
        }
        places.sort_unstable();
        places.dedup();
        places
    };
    let (a, b) = (places(&plain, 0.0), places(&shifted, 5.0));
    let common = a.iter().filter(|p| b.binary_search(p).is_ok()).count();
    assert!(
        common as f64 > 0.98 * a.len() as f64 && a.len().abs_diff(b.len()) < a.len() / 50,
        "{common} {} {}",
        a.len(),
        b.len()
    );
    assert!((plain.area[0] / shifted.area[0] - 1.0).abs() < 1e-6);
}

/// Mirrored along any axis a volume has the mirrored surface, triangle by triangle: no diagonal is favoured.
#[test]
fn mirrored_volumes_have_mirrored_surfaces() {
    let size = [13, 15, 11];
    let bowl = |x: f64, y: f64, z: f64| gauss(z - 3.0 - 0.03 * ((x - 5.0) * (x - 5.0) + x * y / 4.0), 2.0);
    // To 1e-6: rounding of the filter differs between its two ends.
    let corners = |found: &RidgeSurface, side: &dyn Fn([f64; 3]) -> [f64; 3]| {
        let point = |i: u32| side(found.shape.points[i as usize]).map(|v| (v * 1e6).round() as i64);
        let mut triangles: Vec<_> = found.shape.triangles.iter().map(|t| t.map(point)).collect();
        triangles.iter_mut().for_each(|t| t.sort_unstable());
        triangles.sort_unstable();
        triangles
    };
    let plain = corners(&ridges(&values(size, bowl), size, false), &|p| p);
    assert!(plain.len() > 1000, "{}", plain.len());
    for axis in 0..3 {
        let mirror = |mut p: [f64; 3]| {
            p[axis] = (size[axis] - 1) as f64 - p[axis];
            p
        };
        let there = |x: f64, y: f64, z: f64| {
            let [x, y, z] = mirror([x, y, z]);
            bowl(x, y, z)
        };
        let mirrored = corners(&ridges(&values(size, there), size, false), &mirror);
        let common = mirrored.iter().filter(|t| plain.binary_search(t).is_ok()).count();
        // Some coordinates lie at the edge of rounding.
        assert!(
            mirrored.len() == plain.len() && common as f64 > 0.99 * plain.len() as f64,
            "{axis}: {common}"
        );
    }
}

#[test]
fn a_crest_in_one_direction_lies_flat_wherever_the_direction() {
    let size = [5, 5, 16];
    for peak in [0, 3, 15] {
        let around = |z: f64| math::cos(math::TAU * (z - f64::from(peak)) / 16.0);
        let found = ridges(&values(size, |_, _, z| around(z)), size, true);
        let pieces = if peak == 0 { 2 } else { 1 };
        // At the seam the surface has points on both sides and is one piece, without duplicates.
        let at_seam = found.shape.points.iter().filter(|p| p[2] > 15.5).count();
        assert_eq!(found.area.len(), 1, "{peak}: {:?}", found.area);
        assert!(
            found.area[0] > 15.9 && found.area[0] < f64::from(pieces) * 16.1,
            "{peak}: {:?} {at_seam}",
            found.area
        );
        let off = |z: f64| (z - f64::from(peak)).abs().min((z - f64::from(peak) - 16.0).abs());
        assert!(worst(&found, |p| off(p[2])) < 1e-6, "{peak}");
    }
}

#[test]
fn ridges_depend_on_the_scale_of_directions() {
    // In samples the crest along x - z is at 45 degrees; if directions have a small scale, the strongest curvature is
    // along z.
    let size = [20, 5, 20];
    let f = values(size, |x, _, z| gauss((x - z) / 2.0_f64.sqrt(), 2.0) + 0.0 * x);
    for third in [0.5, 1.0, 2.0] {
        let options = RidgeOptions { cell: [1.0, 1.0, third], ..RidgeOptions::default() };
        let found = ridges_with(&f, size, false, &options);
        // The plane does not move; its strength is the curvature along the scaled normal.
        assert!(worst(&found, |p| p[0] - p[2]) < CREST, "{third}");
        let strength = 0.25 * 0.5 * (1.0 + 1.0 / (third * third));
        assert!(found.strength.iter().all(|s| (s / strength - 1.0).abs() < 0.05), "{third}");
        let area = 17.0 * 4.0 * (1.0 + third * third).sqrt();
        assert!((found.area[0] / area - 1.0).abs() < 0.02, "{third}: {}", found.area[0] / area);
    }
}

#[test]
fn constants_ramps_and_thin_volumes_have_no_ridges() {
    let options = RidgeOptions::default();
    for size in [[1, 1, 1], [9, 1, 9], [9, 9, 1], [1, 9, 9], [2, 2, 2], [7, 6, 5]] {
        for round in [false, true] {
            for f in [&(|_, _, _| 3.0) as &dyn Fn(f64, f64, f64) -> f64, &|_, _, _| f64::NAN, &|x, y, _| {
                x - 2.0 * y
            }] {
                let found = ridges_with(&values(size, f), size, round, &options);
                assert_eq!(found.area, [0.0; 0], "{size:?}");
            }
            ridges(&values(size, |x, y, z| x * y - z), size, round);
        }
    }
}

#[test]
fn missing_values_keep_surfaces_away() {
    let size = [20, 20, 8];
    let f = |x: f64, y: f64, z: f64| {
        let hole = (x - 9.5).abs() < 1.0 && (y - 9.5).abs() < 1.0 && z == 0.0;
        let border = x == 0.0 || y == 0.0 || x == 19.0 || y == 19.0;
        if hole || border { f64::NAN } else { gauss(y - 9.3, 2.0) }
    };
    let found = ridges(&values(size, f), size, true);
    assert_eq!(found.area.len(), 1, "{:?}", found.area);
    assert!(worst(&found, |p| p[1] - 9.3) < CREST);
    let away = |p: &[f64; 3]| {
        let z = p[2].min(8.0 - p[2]);
        (p[0] - 9.5).abs() > 2.0 || z > 2.0
    };
    assert!(found.shape.points.iter().all(away));
    // The rest of the 15 by 8 cells is complete.
    assert!(found.area[0] > 15.0 * 8.0 - 60.0 && found.area[0] < 15.0 * 8.0, "{:?}", found.area);
    assert!(
        found.shape.points.iter().any(|p| p[0] == 2.0) && found.shape.points.iter().any(|p| p[0] == 17.0)
    );
}

#[test]
fn meshes_too_large_are_refused() {
    let v = vec![0.0; 1000];
    let volume = Volume::new(&v, [10, 10, 10], [false; 3]).expect("a volume");
    for samples_per_cell in [100, usize::MAX] {
        let result = ridge_surface(&volume, &RidgeOptions { samples_per_cell, ..RidgeOptions::default() });
        assert!(matches!(result, Err(ExtractionError::MeshSize { .. })));
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let values = Helicoid { samples: 24 }.values(3);
    let with = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        pool.install(|| ridges(&values, [21, 21, 24], true))
    };
    assert_eq!(with(1), with(3));
}
