//! Laws of the direct solution of the linear scheme.

use super::*;
use crate::{
    EightLobe, Engine, Level, Light, Problem, SampleSpace, Scattering, ScatteringRule, Scheme, SharedWeights,
    Stopping, StoppingRule, TransportError,
};
use tigereye_core::{
    Cell, Directions, Field, Grid, LightDistribution, NEIGHBOUR_OFFSETS, Normalization, PolarProfile,
    Reflection, Tensor2, TransmissionField, math,
};

/// Tensors of all kinds.
fn transmission(width: usize, height: usize) -> TransmissionField {
    let directions = Directions::new(16).expect("directions");
    let grid = Grid::new(width, height).expect("a grid");
    let field = Field::from_fn(grid, |c| {
        let i = (c.x * 7 + c.y * 11 + c.x * c.y) as f64;
        Tensor2::from_axes(0.37 * i, 1.0 + 9.0 * math::sin(0.71 * i).abs(), 1.0)
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
    operator: Operator,
    level: Level,
    q: &dyn Fn(usize) -> Vec<f64>,
) -> Vec<Lanes<T, N>> {
    let dissection = Dissection::<T, N>::new(field, operator, level, &Serial).expect("light that leaves");
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
            let edges = solved::<f64, 32>(field, Operator::Forward, Level::detect(), &|l| sources(grid, l));
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
        let light = solved::<f64, 32>(field, Operator::Forward, Level::detect(), &q);
        let worth = solved::<f64, 32>(field, Operator::Adjoint, Level::detect(), &back);
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
fn sweeps_settle_on_the_direct_solution() {
    with_linear(&transmission(41, 37), |field| {
        let grid = field.grid();
        for operator in [Operator::Forward, Operator::Adjoint] {
            let direct = solved::<f64, 32>(field, operator, Level::detect(), &|l| sources(grid, l));
            let q: Vec<[f64; 8]> = sources(grid, 3).as_chunks().0.to_vec();
            let mut told = 0;
            let watch = &mut |sweeps, _| {
                told = sweeps;
                std::ops::ControlFlow::Continue(())
            };
            let settled = stationary(field, operator, &q, 1e-12, watch).expect("light that leaves");
            assert_eq!(told, settled.sweeps);
            let narrow = solved::<f32, 32>(field, operator, Level::detect(), &|l| sources(grid, l));
            let wide = solved::<f32, 64>(field, operator, Level::detect(), &|l| sources(grid, l));
            for (narrow, wide) in narrow.iter().zip(&wide) {
                assert_eq!(narrow.0.map(f32::to_bits)[..], wide.0.map(f32::to_bits)[..32], "{operator:?}");
            }
            let all: f64 = direct.iter().map(|lanes| lanes.0[3]).sum();
            let apart: f64 =
                settled.lobes.as_flattened().iter().zip(&direct).map(|(a, b)| (a - b.0[3]).abs()).sum();
            assert!(apart < 1e-10 * all, "{operator:?}: {}", apart / all);
        }
    });
}

#[test]
fn light_that_is_gone_after_a_few_steps_and_faint_light_are_found() {
    // Totally anisotropic cells absorb what does not come along their axis.
    let directions = Directions::new(16).expect("directions");
    let grid = Grid::new(9, 9).expect("a grid");
    let tensors = Field::from_fn(grid, |c| Tensor2::from_axes(0.37 * (c.x * 7 + c.y * 11) as f64, 1.0, 0.0));
    let needles =
        TransmissionField::from_tensors(&tensors, directions, Normalization::Local).expect("a field");
    for (t, strength) in [(&needles, 1.0), (&transmission(9, 9), 1e-170), (&transmission(9, 9), 1e90)] {
        with_linear(t, |field| {
            for source in (0..81 * 8).step_by(5) {
                if field.grid().neighbour(field.grid().cell(source / 8), (source + 4) % 8).is_none() {
                    continue;
                }
                let mut q = vec![[0.0; 8]; 81];
                q[source / 8][source % 8] = strength;
                let watch = &mut |_, _| std::ops::ControlFlow::Continue(());
                let settled = stationary(field, Operator::Forward, &q, 1e-10, watch);
                let settled = settled.unwrap_or_else(|e| panic!("source {source}: {e}"));
                let one: Vec<f64> = q.as_flattened().iter().map(|v| v / strength).collect();
                let expected = by_steps(field, &one);
                for (got, expected) in settled.lobes.as_flattened().iter().zip(expected) {
                    assert!((got / strength - expected).abs() < 1e-7, "source {source}");
                }
            }
        });
    }
}

#[test]
fn sweeps_grow_no_faster_than_fields() {
    let sweeps = |n: usize| {
        with_linear(&transmission(n, n), |field| {
            let mut q = vec![[0.0; 8]; n * n];
            q[n * n / 2] = [1.0; 8];
            let watch = &mut |_, _| std::ops::ControlFlow::Continue(());
            stationary(field, Operator::Forward, &q, 1e-6, watch).expect("light that leaves").sweeps
        })
    };
    let [small, large] = [24, 96].map(sweeps);
    assert!(large <= 4 * small && large < 200, "{small} and {large}");
}

#[test]
fn importance_is_the_adjoint_of_light() {
    let t = transmission(15, 12);
    let scheme = scheme().with_scattering(ScatteringRule::Linear);
    let scattering = Scattering::new(&scheme, &t);
    let field = LinearScattering::new(&scattering);
    let directions = scheme.directions();
    let h = directions.step_rad();
    let sensitivity: Vec<f64> = (0..16).map(|t| 1.0 + math::sin(t as f64).abs()).collect();
    let receiver = Cell::new(9, 4);
    let (importance, _) =
        importance(&field, receiver, &sensitivity, 1e-13, &mut |_, _| std::ops::ControlFlow::Continue(()))
            .expect("a receiver");
    let light =
        |cell, f: &dyn Fn(usize) -> f64| Light::continuous(cell, PolarProfile::from_fn(directions, f));
    let lights = [
        light(Cell::new(2, 3), &|t| 1.0 + t as f64),
        light(Cell::new(14, 0), &|_| 0.5),
        light(Cell::new(9, 5), &|t| if t == 4 { 2.0 } else { 0.0 }),
    ];
    let stopping = Stopping { rule: StoppingRule::Converged { tolerance: 1e-13 }, max_iterations: 100_000 };
    let problem = Problem { scheme: &scheme, transmission: &t, lights: &lights, stopping };
    let outcome = EightLobe.propagate(&problem).expect("a propagation");
    let arrived = outcome.distribution.profile(receiver);
    let received: f64 = h * arrived.iter().zip(&sensitivity).map(|(i, s)| i * s).sum::<f64>();
    let mut sent = 0.0;
    for light in &lights {
        let f = light.initial_profile(directions);
        sent += h * importance.profile(light.cell).iter().zip(f.samples()).map(|(i, f)| i * f).sum::<f64>();
    }
    assert!((received - sent).abs() < 1e-11 * sent, "{received} and {sent}");
}

/// What is left of a difference of two distributions, as a part of the larger.
fn difference(a: &LightDistribution, b: &LightDistribution) -> f64 {
    let largest = b.samples().iter().fold(0.0_f64, |m, v| m.max(*v));
    let apart = a.samples().iter().zip(b.samples()).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    apart / largest
}

#[test]
fn oracle_and_lobes_agree_on_linear_steps_and_light_superposes() {
    let t = transmission(9, 8);
    let scheme = scheme().with_scattering(ScatteringRule::Linear);
    let directions = scheme.directions();
    let profile = |f: &dyn Fn(usize) -> f64| PolarProfile::from_fn(directions, f);
    let lights = [
        Light::continuous(Cell::new(2, 3), profile(&|t| 1.0 + t as f64)),
        Light::impulse(Cell::new(5, 5), profile(&|t| (t % 3) as f64)),
        Light::pulse(Cell::new(8, 0), 9),
    ];
    for steps in [1, 2, 13] {
        let stopping = Stopping::steps(steps);
        let run = |engine: &dyn Engine, lights: &[Light]| {
            let problem = Problem { scheme: &scheme, transmission: &t, lights, stopping };
            engine.propagate(&problem).expect("a propagation").distribution
        };
        let [oracle, lobes] = [run(&SampleSpace, &lights), run(&EightLobe, &lights)];
        assert!(difference(&oracle, &lobes) < 1e-14, "{steps} steps");
        let mut sum = vec![0.0; lobes.samples().len()];
        for light in &lights {
            let alone = run(&EightLobe, std::slice::from_ref(light));
            sum.iter_mut().zip(alone.samples()).for_each(|(sum, v)| *sum += v);
        }
        let sum = LightDistribution::new(directions, sum, lobes.incoming().clone());
        assert!(difference(&sum, &lobes) < 1e-14, "{steps} steps: superposition");
    }
}

#[test]
fn a_single_lobe_is_scattered_as_the_joint_scheme_does() {
    // One step after a pulse each lit cell holds one lobe, so the second step is the same in both schemes.
    let t = transmission(9, 9);
    for sample in [0, 1, 2, 7] {
        let lights = [Light::impulse(
            Cell::new(4, 4),
            PolarProfile::from_fn(scheme().directions(), |t| if t == sample { 1.0 } else { 0.0 }),
        )];
        let [joint, linear] = [ScatteringRule::Joint, ScatteringRule::Linear].map(|rule| {
            let scheme = scheme().with_scattering(rule);
            let problem =
                Problem { scheme: &scheme, transmission: &t, lights: &lights, stopping: Stopping::steps(2) };
            EightLobe.propagate(&problem).expect("a propagation").distribution
        });
        assert!(difference(&joint, &linear) < 1e-14, "sample {sample}");
    }
}

#[test]
fn levels_lanes_and_near_sources_give_the_same_bits() {
    with_linear(&transmission(14, 9), |field| {
        let grid = field.grid();
        let q = |lane| sources(grid, lane);
        let of = |level| solved::<f64, 32>(field, Operator::Forward, level, &q);
        let first = of(Level::BASELINE);
        for level in Level::available() {
            for (a, b) in first.iter().zip(&of(level)) {
                assert_eq!(a.0.map(f64::to_bits), b.0.map(f64::to_bits), "{}", level.name());
            }
        }
        let lit = [Cell::new(3, 4), Cell::new(4, 4), Cell::new(0, 8)];
        let mut all = vec![Lanes::<f64, 32>::zero(); grid.cells() * 8];
        let mut placed = Vec::new();
        for (lane, cell) in lit.iter().enumerate() {
            for (k, _) in NEIGHBOUR_OFFSETS.iter().enumerate() {
                if let Some(there) = grid.neighbour(*cell, k) {
                    let edge = grid.index(there) * 8 + k;
                    all[edge].0[lane] = 1.0 + k as f64;
                    placed.push((edge, lane, 1.0 + k as f64));
                }
            }
        }
        // Rubbish on the edges that are not to be read.
        let mut near = vec![Lanes::<f64, 32>::zero(); grid.cells() * 8];
        for (e, lanes) in near.iter_mut().enumerate() {
            if grid.neighbour(grid.cell(e / 8), (e + 4) % 8).is_some() {
                lanes.0 = [7.0; 32];
            }
        }
        let dissection =
            Dissection::<f64, 32>::new(field, Operator::Forward, Level::detect(), &Serial).expect("light");
        dissection.solve(&mut all, &mut dissection.workspace());
        dissection.solve_near(&lit, &placed, &mut near, &mut dissection.workspace());
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
        let double = solved::<f64, 32>(field, Operator::Forward, Level::detect(), &q);
        let single = solved::<f32, 64>(field, Operator::Forward, Level::detect(), &q);
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
        let trapped = Dissection::<f64, 32>::new(field, Operator::Forward, Level::detect(), &Serial);
        assert!(matches!(trapped.err(), Some(TransportError::Trapped { .. })));
    });
}
