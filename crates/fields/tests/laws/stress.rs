//! Stress fields: equilibrium, boundary conditions, named values.

use crate::{at, field};
use tigereye_core::{Cell, Eigenvalues, Field, Svd, Tensor2, math};

/// Largest component of div sigma by central differences over the interior cells that `inside` accepts.
fn imbalance(f: &Field<Tensor2>, spacing: f64, inside: impl Fn(Cell) -> bool) -> f64 {
    let mut largest = 0.0_f64;
    for (cell, _) in f.iter().filter(|(c, _)| !f.grid().is_border(*c) && inside(*c)) {
        let [right, left] = [at(f, cell.x + 1, cell.y), at(f, cell.x - 1, cell.y)];
        let [above, below] = [at(f, cell.x, cell.y - 1), at(f, cell.x, cell.y + 1)];
        let x = right.xx() - left.xx() + above.xy() - below.xy();
        let y = right.xy() - left.xy() + above.yy() - below.yy();
        largest = largest.max(x.abs().max(y.abs()) / (2.0 * spacing));
    }
    largest
}

/// Halving the spacing must quarter the imbalance, within 20 %.
fn assert_second_order(coarse: f64, fine: f64, law: &str) {
    assert!(coarse / fine > 3.2, "{law}: {coarse:e} / {fine:e}");
}

#[test]
fn kirsch_plate_is_in_equilibrium() {
    // The same points of the plate, at r >= 1.5, at spacings 1/8 and 1/16.
    let run = |n: usize| {
        let (f, c) = (field(&format!("kirsch:size={}", 8 * n + 1)), 4 * n);
        imbalance(&f, 1.0 / n as f64, |cell| {
            let [x, y] = [cell.x.abs_diff(c), cell.y.abs_diff(c)];
            4 * (x * x + y * y) >= 9 * n * n
        })
    };
    assert_second_order(run(16), run(32), "div sigma = 0");
    assert!(run(64) < 5e-3, "{:e}", run(64));
}

#[test]
fn flamant_half_plane_is_in_equilibrium() {
    // Rows lie half a spacing below full multiples: points at depth above 0.5.
    let run = |n: usize| {
        let f = field(&format!("flamant:size={}", 2 * n + 1));
        imbalance(&f, 1.0 / n as f64, |cell| 2 * cell.y >= n)
    };
    assert_second_order(run(32), run(64), "div sigma = 0");
    assert!(run(128) < 5e-3, "{:e}", run(128));
}

#[test]
fn cantilever_is_in_equilibrium_with_its_load() {
    let f = field("cantilever:size=41,load=3,half_height=2");
    let h = 0.1;
    // The stress is quadratic: central differences are exact.
    assert!(imbalance(&f, h, |_| true) < 1e-13);
    for x in [0, 13, 40] {
        // Simpson's rule, exact here: the section carries the load and the moment load * x.
        let weight = |row: usize| match row {
            0 | 40 => h / 3.0,
            r if r % 2 == 1 => 4.0 * h / 3.0,
            _ => 2.0 * h / 3.0,
        };
        let shear: f64 = (0..41).map(|row| weight(row) * at(&f, x, row).xy()).sum();
        let moment: f64 = (0..41).map(|row| weight(row) * at(&f, x, row).xx() * (2.0 - h * row as f64)).sum();
        assert!((shear + 3.0).abs() < 1e-12 && (moment + 3.0 * h * x as f64).abs() < 1e-12);
        assert!(at(&f, x, 0).xy().abs() < 1e-14 && at(&f, x, 40).xy().abs() < 1e-14);
    }
}

#[test]
fn flamant_lines_are_rays_and_circles() {
    let f = field("flamant:size=41,load=2");
    let spacing = 1.0 / 20.0;
    for (cell, t) in f.iter() {
        let (x, y) = ((cell.x as f64 - 20.0) * spacing, -(cell.y as f64 + 0.5) * spacing);
        let r = math::hypot(x, y);
        let [l1, l2] = Eigenvalues::of(t).real_parts();
        let expected = 2.0 * 2.0 * y / (math::PI * r * r);
        assert!((l1 - expected).abs() < 1e-13 * expected.abs() && l2.abs() < 1e-13 * expected.abs());
        let [mx, my] = Svd::of(t).major().to_array();
        assert!((mx * y - my * x).abs() < 1e-12 * r, "{cell:?}: the major axis is the ray");
    }
}

#[test]
fn kirsch_concentrates_stress_threefold() {
    // Spacing 1: the hole's sides are samples.
    let f = field("kirsch:size=9,tension=2");
    let close = |x, y, expected: Tensor2| {
        let t = at(&f, x, y);
        assert!((t + expected.scaled(-1.0)).max_abs() < 1e-15, "({x}, {y}): {t:?}");
    };
    close(4, 3, Tensor2::symmetric(6.0, 0.0, 0.0));
    close(4, 5, Tensor2::symmetric(6.0, 0.0, 0.0));
    close(5, 4, Tensor2::symmetric(0.0, 0.0, -2.0));
    close(4, 4, Tensor2::ZERO);
    assert_eq!(f.values().iter().filter(|t| t.is_zero()).count(), 1);
    let far = at(&field("kirsch:size=9,extent=1000"), 8, 8);
    assert!((far + Tensor2::symmetric(-1.0, 0.0, 0.0)).max_abs() < 1e-5);
}

#[test]
fn kirsch_hole_is_free_of_traction() {
    // Twelve whole points lie on the circle of radius 5.
    let f = field("kirsch:size=21,extent=10,radius=5");
    for (x, y) in [(5, 0), (0, 5), (3, 4), (4, 3), (-3, 4), (-4, 3), (3, -4), (-5, 0)] {
        let t = at(&f, (10 + x) as usize, (10 - y) as usize);
        let (x, y) = (f64::from(x) / 5.0, f64::from(y) / 5.0);
        let traction = math::hypot(t.xx() * x + t.xy() * y, t.yx() * x + t.yy() * y);
        assert!(traction < 1e-15 && !t.is_zero(), "({x}, {y}): {traction:e}");
    }
}

/// The stress of the point load at grid point (x, y, z) of the box -10..10, all components, from its three sections.
fn boussinesq(n: usize, [i, j, k]: [usize; 3]) -> [[f64; 3]; 3] {
    let place = |k: usize| -10.0 + 20.0 * k as f64 / (n - 1) as f64;
    let section = |plane: &str, offset: usize, right: usize, up: usize| {
        at(&field(&format!("point_load:size={n},plane={plane},offset={}", place(offset))), right, n - 1 - up)
    };
    let [xy, xz, yz] = [section("xy", k, i, j), section("xz", j, i, k), section("yz", i, j, k)];
    assert!((xy.xx() - xz.xx()).abs() < 1e-12 && (xz.yy() - yz.yy()).abs() < 1e-12);
    [[xy.xx(), xy.xy(), xz.xy()], [xy.xy(), xy.yy(), yz.xy()], [xz.xy(), yz.xy(), xz.yy()]]
}

#[test]
fn point_load_has_the_values_of_vtk() {
    // Probes of vtkPointLoad's output, which is single precision: load 100, Poisson 0.3, 20 points from -10 to 10.
    type Probe = ([usize; 3], [[f64; 3]; 3]);
    let probes: [Probe; 3] = [
        (
            [0, 0, 0],
            [
                [-0.006497473455965519, -0.009319676086306572, -0.021658243611454964],
                [-0.009319676086306572, -0.006497473455965519, -0.021658243611454964],
                [-0.021658243611454964, -0.021658243611454964, -0.04331648722290993],
            ],
        ),
        ([10, 9, 19], [[0.0, -11.490986824035645, 0.0], [-11.490986824035645, 0.0, 0.0], [0.0; 3]]),
        (
            [5, 14, 12],
            [
                [-0.05685368552803993, 0.06745780259370804, -0.12538327276706696],
                [0.06745780259370804, -0.05685368552803993, 0.12538327276706696],
                [-0.12538327276706696, 0.12538327276706696, -0.19504064321517944],
            ],
        ),
    ];
    for (point, expected) in probes {
        let found = boussinesq(20, point);
        for r in 0..3 {
            for c in 0..3 {
                let difference = (found[r][c] - expected[r][c]).abs();
                assert!(difference < 1e-6 * expected[0][1].abs(), "{point:?} [{r}][{c}]: {found:?}");
            }
        }
    }
}

#[test]
fn point_load_half_space_is_in_equilibrium() {
    // Div sigma at (5, -2.5, 5), 7.4 from the load, at spacings 5/4 and 5/8.
    let run = |n: usize| {
        let (h, centre) = (20.0 / (n - 1) as f64, [(n - 1) * 3 / 4, (n - 1) * 3 / 8, (n - 1) * 3 / 4]);
        let mut divergence = [0.0; 3];
        for axis in 0..3 {
            let shifted = |by: isize| {
                let mut p = centre;
                p[axis] = p[axis].checked_add_signed(by).expect("inside");
                boussinesq(n, p)
            };
            let (ahead, behind) = (shifted(1), shifted(-1));
            for (r, d) in divergence.iter_mut().enumerate() {
                *d += (ahead[r][axis] - behind[r][axis]) / (2.0 * h);
            }
        }
        divergence.iter().fold(0.0_f64, |m, d| m.max(d.abs()))
    };
    assert_second_order(run(33), run(65), "div sigma = 0");
}

#[test]
fn every_level_of_the_half_space_carries_the_load() {
    // Vertical stress summed over squares of side 1 in the plane 10 below the load; 1e-4 of it acts outside.
    let n = 401;
    let vertical: f64 = (0..n)
        .map(|row| {
            let offset = row as f64 - 200.0;
            let f = field(&format!("point_load:width={n},height=11,extent=200,offset={offset}"));
            // Width 401 over -200..200: spacing 1, row 10 lies 10 deep.
            (0..n).map(|x| at(&f, x, 10).yy()).sum::<f64>()
        })
        .sum();
    assert!((vertical + 100.0).abs() < 0.03, "{vertical}");
}

#[test]
fn point_load_surface_is_free_and_the_outside_empty() {
    let f = field("point_load:size=21");
    for x in 0..21 {
        let t = at(&f, x, 0);
        assert!(t.yy() == 0.0 && t.xy() == 0.0);
        assert_eq!(t.is_zero(), x == 10, "only the load itself has no value");
    }
    let outside = field("point_load:size=21,plane=xy,offset=11");
    assert!(outside.values().iter().all(Tensor2::is_zero));
}
