//! Laws of the direct solution of the linear scheme.

use super::*;
use crate::{Level, Scattering, Scheme, SharedWeights, TransportError};
use tigereye_core::{
    Cell, Directions, Field, Grid, NEIGHBOUR_OFFSETS, Normalization, Reflection, Tensor2, TransmissionField,
};

/// Tensors of all kinds.
fn transmission(width: usize, height: usize) -> TransmissionField {
    let directions = Directions::new(16).expect("directions");
    let grid = Grid::new(width, height).expect("a grid");
    let field = Field::from_fn(grid, |c| {
        let i = (c.x * 7 + c.y * 11 + c.x * c.y) as f64;
        Tensor2::from_axes(0.37 * i, 1.0 + 9.0 * (0.71 * i).sin().abs(), 1.0)
    });
    TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field")
}

fn scheme() -> Scheme {
    Scheme::new(Directions::new(16).expect("directions"), SharedWeights::Thesis)
}

fn with_linear<R>(transmission: &TransmissionField, run: impl FnOnce(&LinearScattering<'_>) -> R) -> R {
    let scheme = scheme();
    let scattering = Scattering::new(&scheme, transmission);
    run(&LinearScattering::new(&scattering))
}

/// `a = A a + q` by plain steps until nothing changes any more.
fn by_steps(field: &LinearScattering<'_>, q: &[f64]) -> Vec<f64> {
    let grid = field.grid();
    let mut a = q.to_vec();
    loop {
        let mut next = q.to_vec();
        for cell in grid.iter() {
            let i = grid.index(cell) * 8;
            let phi = field.passed(cell, &std::array::from_fn(|k| a[i + k]));
            for (k, phi) in phi.iter().enumerate() {
                if let Some(there) = grid.neighbour(cell, k) {
                    next[grid.index(there) * 8 + k] += phi;
                }
            }
        }
        let change: f64 = a.iter().zip(&next).map(|(a, b)| (a - b).abs()).sum();
        a = next;
        if change < 1e-15 {
            return a;
        }
    }
}

/// Numbers between 0 and 1 on the edges inside the grid, 0 on those that lead in from outside.
fn sources(grid: Grid, lane: usize) -> Vec<f64> {
    let of_edge = |e: usize| {
        let inside = grid.neighbour(grid.cell(e / 8), (e + 4) % 8).is_some();
        if inside { ((e * 37 + lane * 101) % 97) as f64 / 97.0 } else { 0.0 }
    };
    (0..grid.cells() * 8).map(of_edge).collect()
}

fn solved<T: crate::Real, const N: usize>(
    field: &LinearScattering<'_>,
    course: Course,
    level: Level,
    q: &dyn Fn(usize) -> Vec<f64>,
) -> Vec<Lanes<T, N>> {
    let dissection = Dissection::<T, N>::new(field, course, level, &Serial).expect("light that leaves");
    let mut edges = vec![Lanes::zero(); field.grid().cells() * 8];
    for lane in 0..N {
        for (to, q) in edges.iter_mut().zip(q(lane)) {
            to.0[lane] = T::from_f64(q);
        }
    }
    dissection.solve(&mut edges, &mut dissection.workspace());
    edges
}

#[test]
fn direct_solution_is_the_limit_of_plain_steps() {
    for (width, height) in [(1, 1), (1, 7), (2, 2), (9, 5), (16, 13)] {
        with_linear(&transmission(width, height), |field| {
            let grid = field.grid();
            let edges = solved::<f64, 32>(field, Course::FromSources, Level::detect(), &|l| sources(grid, l));
            for lane in [0, 31] {
                let expected = by_steps(field, &sources(grid, lane));
                for (e, (got, expected)) in edges.iter().zip(expected).enumerate() {
                    assert!((got.0[lane] - expected).abs() < 1e-12 * (1.0 + expected), "edge {e}");
                }
            }
        });
    }
}

#[test]
fn following_light_back_gives_the_adjoint() {
    with_linear(&transmission(11, 8), |field| {
        let grid = field.grid();
        let q = |lane| sources(grid, lane);
        // What each edge is worth to a receiver. Light enters edge (cell, k) from the cell behind it, where it leaves
        // towards k.
        let r = |lane| sources(grid, lane + 50);
        let back = |lane: usize| {
            let mut edges = vec![0.0; grid.cells() * 8];
            for (e, v) in r(lane).iter().enumerate() {
                if let Some(behind) = grid.neighbour(grid.cell(e / 8), (e + 4) % 8) {
                    edges[grid.index(behind) * 8 + (e + 4) % 8] = *v;
                }
            }
            edges
        };
        let light = solved::<f64, 32>(field, Course::FromSources, Level::detect(), &q);
        let worth = solved::<f64, 32>(field, Course::ToReceivers, Level::detect(), &back);
        for lane in 0..32 {
            let received: f64 = light.iter().zip(r(lane)).map(|(a, r)| a.0[lane] * r).sum();
            let mut sent = 0.0;
            for (e, q) in q(lane).iter().enumerate() {
                if let Some(behind) = grid.neighbour(grid.cell(e / 8), (e + 4) % 8) {
                    sent += q * worth[grid.index(behind) * 8 + (e + 4) % 8].0[lane];
                }
            }
            assert!((received - sent).abs() < 1e-12 * received, "{received} and {sent}");
        }
    });
}

#[test]
fn levels_lanes_and_near_sources_give_the_same_bits() {
    with_linear(&transmission(14, 9), |field| {
        let grid = field.grid();
        let q = |lane| sources(grid, lane);
        let of = |level| solved::<f64, 32>(field, Course::FromSources, level, &q);
        let first = of(Level::BASELINE);
        for level in Level::available() {
            for (a, b) in first.iter().zip(&of(level)) {
                assert_eq!(a.0.map(f64::to_bits), b.0.map(f64::to_bits), "{}", level.name());
            }
        }
        let lit = [Cell::new(3, 4), Cell::new(4, 4), Cell::new(0, 8)];
        let mut near = vec![Lanes::<f64, 32>::zero(); grid.cells() * 8];
        for (lane, cell) in lit.iter().enumerate() {
            for (k, _) in NEIGHBOUR_OFFSETS.iter().enumerate() {
                if let Some(there) = grid.neighbour(*cell, k) {
                    near[grid.index(there) * 8 + k].0[lane] = 1.0 + k as f64;
                }
            }
        }
        let mut all = near.clone();
        let dissection =
            Dissection::<f64, 32>::new(field, Course::FromSources, Level::detect(), &Serial).expect("light");
        dissection.solve(&mut all, &mut dissection.workspace());
        dissection.solve_near(&lit, &mut near, &mut dissection.workspace());
        for (a, b) in all.iter().zip(&near) {
            assert_eq!(a.0.map(f64::to_bits), b.0.map(f64::to_bits));
        }
    });
}

#[test]
fn single_precision_stays_near_double() {
    with_linear(&transmission(17, 21), |field| {
        let grid = field.grid();
        let q = |lane| sources(grid, lane);
        let double = solved::<f64, 32>(field, Course::FromSources, Level::detect(), &q);
        let single = solved::<f32, 64>(field, Course::FromSources, Level::detect(), &q);
        for (a, b) in double.iter().zip(&single) {
            assert!((a.0[5] - f64::from(b.0[5])).abs() <= 1e-5 * a.0[5]);
        }
    });
}

#[test]
fn columns_add_up_to_the_transmission_rate() {
    let t = transmission(6, 4);
    with_linear(&t, |field| {
        for cell in t.grid().iter() {
            let p = field.matrix(cell);
            for j in 0..8 {
                let sum: f64 = (0..8).map(|k| p[k][j]).sum();
                assert!((sum - t.rate(cell)).abs() < 1e-15, "{cell:?}, {j}: {sum}");
            }
            let a: [f64; 8] = std::array::from_fn(|j| 1.0 + j as f64);
            let plain: [f64; 8] = std::array::from_fn(|k| (0..8).map(|j| p[k][j] * a[j]).sum());
            let banded = field.passed(cell, &a);
            assert!((0..8).all(|k| (plain[k] - banded[k]).abs() < 1e-14));
        }
    });
}

#[test]
fn light_between_perfect_mirrors_is_trapped() {
    let t = transmission(7, 7);
    // Each cell of a closed ring sends everything back where it came from.
    let mut shares = [[0.0; 8]; 8];
    for (j, column) in (0..8).map(|j| (j, (j + 4) % 8)) {
        shares[column][j] = 1.0;
    }
    let mirror = Reflection::new(shares).expect("a reflection");
    let ring = t.grid().iter().filter(|c| c.x.abs_diff(3).max(c.y.abs_diff(3)) == 2);
    let room = t.clone().with_reflections(ring.map(|c| (c, mirror.clone())));
    with_linear(&room, |field| {
        let trapped = Dissection::<f64, 32>::new(field, Course::FromSources, Level::detect(), &Serial);
        assert!(matches!(trapped.err(), Some(TransportError::Trapped { .. })));
    });
}
