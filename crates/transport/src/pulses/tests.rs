//! Laws of pulses: what they must not depend on, and what they must agree with.

use super::*;
use crate::{
    EightLobe, Engine, LaneOutcome, Level, Light, Outcome, Problem, PulseSolver, Scattering, Scheme,
    SharedWeights, Stopping, StoppingRule, l1_difference,
};
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};

const SAMPLES: usize = 16;
/// Inner, border and corner cells, one of them absorbing.
const SOURCES: [Cell; 5] =
    [Cell::new(3, 2), Cell::new(4, 2), Cell::new(6, 3), Cell::new(0, 0), Cell::new(2, 4)];

/// No symmetry: random axes, weaker cells that absorb a part and some that absorb everything.
fn rough_field(width: usize, height: usize) -> TransmissionField {
    // The recorded bits below belong to the numbers of this generator, a linear congruential one.
    let mut seed = 7_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let field = Field::from_fn(Grid::new(width, height).expect("a grid"), |c| {
        let axes = Tensor2::from_axes(6.0 * random(), 1.0 + 2.0 * random(), 0.02 + random());
        if (c.x + 3 * c.y) % 10 == 4 { Tensor2::default() } else { axes }
    });
    let directions = Directions::new(SAMPLES).expect("directions");
    TransmissionField::from_tensors(&field, directions, Normalization::Global).expect("a field")
}

/// FNV-1a.
fn digest(numbers: impl IntoIterator<Item = u64>) -> u64 {
    let bytes = numbers.into_iter().flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

fn bits<T: Real>(b: &PulseDistribution<T>) -> impl Iterator<Item = u64> {
    b.lobes().iter().flatten().map(|v| v.to_f64().to_bits())
}

/// The pulses of `cell` in `samples`.
fn solved<T: Real>(
    solver: &mut PulseSolver<'_, T>,
    cells: usize,
    cell: Cell,
    samples: &[usize],
    stopping: &Stopping,
) -> (Vec<PulseDistribution<T>>, Vec<LaneOutcome>) {
    let mut results = vec![PulseDistribution::dark(cells); samples.len()];
    let outcomes = solver.solve(cell, samples, stopping, &mut results);
    (results, outcomes)
}

/// Digests of distributions, of work and of L1 differences, solved `lanes` at a time.
fn digests<T: Real>(level: Level, lanes: usize, rule: StoppingRule) -> [u64; 3] {
    let transmission = rough_field(7, 6);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let stopping = Stopping { rule, max_iterations: 1000 };
    let mut solver = PulseSolver::<T>::new(&field, level);
    let (mut pulses, mut outcomes) = (Vec::new(), Vec::new());
    for cell in SOURCES {
        for samples in (0..SAMPLES).collect::<Vec<_>>().chunks(lanes) {
            let (p, o) = solved(&mut solver, field.grid().cells(), cell, samples, &stopping);
            pulses.extend(p);
            outcomes.extend(o);
        }
    }
    let work = outcomes.iter().flat_map(|o| [o.work.steps as u64, o.work.cell_updates]);
    let next_cell = pulses.iter().zip(&pulses[SAMPLES..]);
    let next_sample = pulses.iter().zip(&pulses[1..]);
    let differences = next_cell.chain(next_sample).map(|(a, b)| l1_difference(&field, level, a, b).to_bits());
    [digest(pulses.iter().flat_map(bits)), digest(work), digest(differences)]
}

#[test]
fn every_level_and_number_of_lanes_gives_the_recorded_bits() {
    let cases = [
        (
            StoppingRule::Steps(9),
            [
                [15436707899097629073, 3635352777914271429, 4819976183661182098],
                [10749958460738642214, 3635352777914271429, 6082555188957304257],
            ],
        ),
        (
            StoppingRule::FluxChange { threshold: 0.05 },
            [
                [608513116187185598, 125480817402246269, 6442999338018779797],
                [14255152564751880274, 125480817402246269, 9726068219827111182],
            ],
        ),
        (
            StoppingRule::Converged { tolerance: 1e-5 },
            [
                [8634834734490127335, 12550491639398725833, 759078722201143854],
                [939915316943524241, 12550491639398725833, 4974298056648731522],
            ],
        ),
    ];
    for (rule, [double, single]) in cases {
        for level in Level::available() {
            for lanes in [1, 3, 4, 7, 8] {
                assert_eq!(digests::<f64>(level, lanes, rule), double, "{}, {lanes}, {rule:?}", level.name());
            }
            for lanes in [1, 8, 11, 16] {
                assert_eq!(digests::<f32>(level, lanes, rule), single, "{}, {lanes}, {rule:?}", level.name());
            }
        }
    }
}

fn eight_lobe(
    scheme: &Scheme,
    transmission: &TransmissionField,
    light: Light,
    stopping: Stopping,
) -> Outcome {
    EightLobe.propagate(&Problem { scheme, transmission, lights: &[light], stopping }).expect("a propagation")
}

/// Largest difference of fluxes relative to the largest flux (1): another order of summation. Single precision keeps 24
/// bits over some hundred steps.
fn assert_pulses_agree<T: Real>(tolerance: f64) {
    let transmission = rough_field(11, 9);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let mut solver = PulseSolver::<T>::new(&field, Level::detect());
    let samples = [0, 3, 4, 9, 14];
    for rule in [
        StoppingRule::Steps(1),
        StoppingRule::Steps(2),
        StoppingRule::Steps(40),
        StoppingRule::FluxChange { threshold: 0.5 },
        StoppingRule::FluxChange { threshold: 0.01 },
        StoppingRule::DistributionChange { threshold: 0.5 },
    ] {
        let stopping = Stopping { rule, max_iterations: 1000 };
        for cell in SOURCES {
            let (pulses, outcomes) = solved(&mut solver, field.grid().cells(), cell, &samples, &stopping);
            for ((pulse, outcome), &t) in pulses.iter().zip(outcomes).zip(&samples) {
                let other = eight_lobe(&scheme, &transmission, Light::pulse(cell, t), stopping);
                assert_eq!(outcome.work, other.work, "{cell:?} {t} {rule:?}");
                assert_eq!(outcome.stop, other.stop, "{cell:?} {t} {rule:?}");
                let lobes = other.distribution.incoming().values();
                let largest = lobes.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
                for (a, b) in pulse.lobes().iter().flatten().zip(lobes.iter().flatten()) {
                    let difference = (a.to_f64() - b).abs();
                    assert!(difference <= tolerance * largest, "{cell:?} {t} {rule:?}: {a:?} and {b}");
                }
            }
        }
    }
}

#[test]
fn pulses_are_those_of_the_plain_engine() {
    assert_pulses_agree::<f64>(2e-15);
}

#[test]
fn pulses_in_single_precision_are_those_of_the_plain_engine() {
    assert_pulses_agree::<f32>(2e-6);
}

#[test]
fn fused_steps_give_the_bits_of_single_ones() {
    let grids = [(1, 1), (1, 5), (5, 1), (2, 2), (3, 7), (8, 3)];
    let few = grids.into_iter().flat_map(|g| [1, 2, 3, 7, 8, 9, 20].map(|n| (g, n)));
    // Wide enough, and long enough, to be cut into strips.
    for ((width, height), steps) in few.chain([((430, 2), 440)]) {
        let transmission = rough_field(width, height);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let field = Scattering::new(&scheme, &transmission);
        // A rule that looks at the change never fuses; this one never holds, so the limit ends it.
        let rule = StoppingRule::DistributionChange { threshold: 0.0 };
        let single = Stopping { rule, max_iterations: steps - 1 };
        let mut solver = PulseSolver::<f64>::new(&field, Level::detect());
        // One solver for all: each source finds it dark.
        for cell in field.grid().iter().step_by(1 + width / 2) {
            let mut of = |stopping: &Stopping| {
                let samples = [1, 6, 11, 12, 0, 3, 5, 15];
                let (pulses, outcomes) = solved(&mut solver, field.grid().cells(), cell, &samples, stopping);
                let work = outcomes.iter().map(|o| o.work.cell_updates);
                digest(pulses.iter().flat_map(bits).chain(work))
            };
            let name = format!("{width}x{height}, {steps} steps from {cell:?}");
            assert_eq!(of(&Stopping::steps(steps)), of(&single), "{name}");
        }
    }
}

/// The light of a lane that stops is that of so many steps, wherever among fused steps the stop falls.
#[test]
fn stops_inside_fused_steps_lose_nothing() {
    let transmission = rough_field(9, 8);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let mut solver = PulseSolver::<f64>::new(&field, Level::detect());
    let samples: Vec<usize> = (0..8).collect();
    for i in 0..60 {
        let threshold = 6.0 * tigereye_core::math::pow(0.8, f64::from(i));
        let stopping = Stopping { rule: StoppingRule::FluxChange { threshold }, max_iterations: 1000 };
        let (pulses, outcomes) = solved(&mut solver, 72, Cell::new(4, 3), &samples, &stopping);
        for l in 0..samples.len() {
            let exactly = Stopping::steps(outcomes[l].work.steps);
            let (again, _) = solved(&mut solver, 72, Cell::new(4, 3), &samples[l..=l], &exactly);
            assert!(bits(&pulses[l]).eq(bits(&again[0])), "threshold {threshold}, lane {l}");
        }
    }
}

#[test]
fn l1_differences_are_sums_over_cells_and_samples() {
    for samples in [8, 16, 24, 32, 40, 64] {
        let tensors = Field::from_fn(Grid::new(5, 4).expect("a grid"), |c| {
            Tensor2::from_axes(c.x as f64 + 0.3 * c.y as f64, 3.0, 1.0)
        });
        let directions = Directions::new(samples).expect("directions");
        let transmission =
            TransmissionField::from_tensors(&tensors, directions, Normalization::Local).expect("a field");
        let scheme = Scheme::new(directions, SharedWeights::Thesis);
        let field = Scattering::new(&scheme, &transmission);
        let mut solver = PulseSolver::<f64>::new(&field, Level::detect());
        let mut pulse = |cell, t| solved(&mut solver, 20, cell, &[t], &Stopping::steps(7)).0.remove(0);
        let (here, there, turned) =
            (pulse(Cell::new(1, 1), 3), pulse(Cell::new(3, 1), 3), pulse(Cell::new(1, 1), 5));
        let value = |b: &PulseDistribution<f64>, i: usize, t: usize| {
            let own = field.grid().index(b.source()) == i && b.sample() == t;
            if own { 0.0 } else { scheme.intensity(&b.lobes()[i], t) }
        };
        for (a, b) in [(&here, &there), (&here, &turned)] {
            let cell = |i: usize| (0..samples).map(|t| (value(a, i, t) - value(b, i, t)).abs()).sum::<f64>();
            let expected: f64 = (0..20).map(cell).sum();
            for level in Level::available() {
                let got = l1_difference(&field, level, a, b);
                assert!((got - expected).abs() < 1e-13 * expected, "S = {samples}: {got} and {expected}");
            }
        }
    }
}

#[test]
fn light_of_earlier_pulses_leaves_no_trace() {
    let transmission = rough_field(13, 12);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let cells = field.grid().cells();
    let mut solver = PulseSolver::<f64>::new(&field, Level::detect());
    let mut used = vec![PulseDistribution::dark(cells); 3];
    // Wide and narrow windows in turn, apart from each other and overlapping.
    let turns =
        [(2, 3, 30), (9, 8, 2), (10, 8, 3), (1, 1, 1), (12, 11, 4), (6, 6, 12), (0, 11, 0), (6, 5, 5)];
    let mut last: Option<Vec<PulseDistribution<f64>>> = None;
    for (x, y, steps) in turns {
        let (cell, stopping) = (Cell::new(x, y), Stopping::steps(steps));
        let samples = [0, 5, 11];
        solver.solve(cell, &samples, &stopping, &mut used);
        let (fresh, _) = solved(&mut solver, cells, cell, &samples, &stopping);
        for (used, fresh) in used.iter().zip(&fresh) {
            assert!(bits(used).eq(bits(fresh)), "{cell:?} after {steps} steps");
        }
        // A difference looks where either has light, and no further.
        for (a, b) in last.iter().flatten().zip(&fresh) {
            let plain: f64 = a.lobes().iter().zip(b.lobes()).map(|(a, b)| by_sample(&scheme, a, b)).sum();
            let own = |b: &PulseDistribution<f64>, other: &PulseDistribution<f64>| {
                let i = field.grid().index(b.source());
                let [own, other] = [b, other].map(|p| scheme.intensity(&p.lobes()[i], b.sample()));
                other.abs() - (own - other).abs()
            };
            let expected = plain + own(a, b) + own(b, a);
            let got = l1_difference(&field, Level::detect(), a, b);
            assert!((got - expected).abs() <= 1e-13 * expected, "{cell:?}: {got} and {expected}");
        }
        last = Some(fresh);
    }
}

/// The L1 difference of two cells' light over all samples.
fn by_sample(scheme: &Scheme, a: &[f64; 8], b: &[f64; 8]) -> f64 {
    (0..SAMPLES).map(|t| (scheme.intensity(a, t) - scheme.intensity(b, t)).abs()).sum()
}

/// The light after so many plain steps that it is far within the tolerance.
fn brute_force(scheme: &Scheme, transmission: &TransmissionField, light: Light) -> Outcome {
    let rule = StoppingRule::Converged { tolerance: 1e-15 };
    eight_lobe(scheme, transmission, light, Stopping { rule, max_iterations: 20_000 })
}

fn l1(a: &[[f64; 8]], b: &[[f64; 8]]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).sum()
}

#[test]
fn stationary_states_are_those_of_plain_steps() {
    let directions = Directions::new(SAMPLES).expect("directions");
    let grid = Grid::new(13, 12).expect("a grid");
    let rings = Field::from_fn(grid, |c| {
        let (dx, dy) = (c.x as f64 - 6.0, 5.5 - c.y as f64);
        Tensor2::from_axes(tigereye_core::math::atan2(dx, -dy), 4.0, 1.0)
    });
    let isotropic = Field::from_fn(grid, |_| Tensor2::IDENTITY);
    let local = |f| TransmissionField::from_tensors(f, directions, Normalization::Local).expect("a field");
    for (name, transmission) in
        [("rough", rough_field(13, 12)), ("rings", local(&rings)), ("isotropic", local(&isotropic))]
    {
        let scheme = Scheme::new(directions, SharedWeights::Thesis);
        let field = Scattering::new(&scheme, &transmission);
        let samples = [0, 3, 9, 14];
        let mut solver = PulseSolver::<f64>::new(&field, Level::detect());
        for cell in [Cell::new(6, 6), Cell::new(1, 2), Cell::new(0, 11), Cell::new(12, 5)] {
            let (pulses, outcomes) = solved(&mut solver, grid.cells(), cell, &samples, &Stopping::STATIONARY);
            for ((pulse, outcome), &t) in pulses.iter().zip(outcomes).zip(&samples) {
                let exact = brute_force(&scheme, &transmission, Light::pulse(cell, t));
                let exact = exact.distribution.incoming().values();
                let plain = eight_lobe(&scheme, &transmission, Light::pulse(cell, t), Stopping::STATIONARY);
                let total: f64 = exact.iter().flatten().sum();
                assert_eq!(outcome.stop, plain.stop, "{name}, {cell:?}, {t}");
                // The tolerance is that of one plain step; what is left after it adds up.
                assert!(
                    l1(pulse.lobes(), exact) <= 2e-9 * total,
                    "{name}, {cell:?}, {t}: {} of {total}",
                    l1(pulse.lobes(), exact)
                );
                // Dark cells stay dark.
                let lit =
                    |lobes: &[[f64; 8]]| lobes.iter().map(|a| a.iter().any(|v| *v > 0.0)).collect::<Vec<_>>();
                assert_eq!(lit(pulse.lobes()), lit(exact), "{name}, {cell:?}, {t}");
            }
        }
    }
}
