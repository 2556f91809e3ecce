//! The two engines side by side, and the pulse lanes at every level this processor has.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use tigereye_core::{
    Cell, Directions, Field, Grid, Normalization, PolarProfile, Tensor2, TransmissionField, math,
};
use tigereye_transport::{
    EightLobe, Engine, Level, Light, Problem, PulseDistribution, PulseSolver, Real, SampleSpace, Scattering,
    Scheme, SharedWeights, Stopping, l1_difference,
};

const SIDE: usize = 51;
const STEPS: usize = 20;

/// Ellipses of ratio 4 that point away from the centre.
fn radial(samples: usize) -> TransmissionField {
    let grid = Grid::new(SIDE, SIDE).expect("a grid");
    let centre = grid.centre();
    let field = Field::from_fn(grid, |c| {
        let (dx, dy) = (c.x as f64 - centre.x as f64, c.y as f64 - centre.y as f64);
        Tensor2::from_axes(math::atan2(dx, dy), 4.0, 1.0)
    });
    let directions = Directions::new(samples).expect("directions");
    TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field")
}

/// One continuous light in the centre, S = 32.
fn engines(c: &mut Criterion) {
    let transmission = radial(32);
    let directions = transmission.directions();
    let scheme = Scheme::new(directions, SharedWeights::Thesis);
    let lights = [Light::continuous(transmission.grid().centre(), PolarProfile::constant(directions, 1.0))];
    let problem = Problem {
        scheme: &scheme,
        transmission: &transmission,
        lights: &lights,
        stopping: Stopping::steps(STEPS),
    };
    let mut group = c.benchmark_group("engines");
    for engine in [&SampleSpace as &dyn Engine, &EightLobe] {
        group.bench_function(engine.name(), |b| {
            b.iter(|| engine.propagate(black_box(&problem)).expect("a propagation"));
        });
    }
    group.finish();
}

/// Full lanes of pulses of the centre until they have reached the whole grid and as long again, and the L1 difference
/// of two of them.
fn pulses<T: Real>(c: &mut Criterion) {
    let transmission = radial(32);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let (cell, stopping): (Cell, _) = (field.grid().centre(), Stopping::steps(SIDE));
    let samples: Vec<usize> = (0..T::LANES).collect();
    let mut results = vec![PulseDistribution::<T>::dark(field.grid().cells()); T::LANES];
    let name = |what: &str| format!("{what}, {}", T::NAME);
    for level in Level::available() {
        let mut group = c.benchmark_group(name("pulse lanes"));
        let mut solver = PulseSolver::<T>::new(&field, level);
        let outcomes = solver.solve(cell, &samples, &stopping, &mut results);
        group.throughput(Throughput::Elements(outcomes.iter().map(|o| o.work.cell_updates).sum()));
        group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
            b.iter(|| solver.solve(black_box(cell), &samples, &stopping, &mut results));
        });
        group.finish();
        let mut group = c.benchmark_group(name("L1 difference"));
        group.throughput(Throughput::Elements(field.grid().cells() as u64));
        group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
            b.iter(|| l1_difference(&field, level, black_box(&results[0]), &results[1]));
        });
        group.finish();
    }
}

fn pulses_f64(c: &mut Criterion) {
    pulses::<f64>(c);
}

fn pulses_f32(c: &mut Criterion) {
    pulses::<f32>(c);
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = engines, pulses_f64, pulses_f32
}
criterion_main!(benches);
