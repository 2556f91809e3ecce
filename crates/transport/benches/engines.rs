//! The two engines side by side, and the pulse lanes at every level this processor has.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use tigereye_core::{
    Cell, Directions, Field, Grid, Normalization, PolarProfile, Tensor2, TransmissionField, math,
};
use tigereye_transport::{
    EightLobe, Engine, Level, Light, Problem, PulseBlock, PulseSolver, SampleSpace, Scattering, Scheme,
    SharedWeights, Stopping,
};

const SIDE: usize = 51;
const STEPS: usize = 20;
const LANES: usize = 8;

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

/// Eight pulses of the centre, S = 16, until they have reached the whole grid and as long again.
fn lanes(c: &mut Criterion) {
    let transmission = radial(16);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let (cell, stopping): (Cell, _) = (field.grid().centre(), Stopping::steps(SIDE));
    let samples = std::array::from_fn(|l| 2 * l);
    let mut block = PulseBlock::<LANES>::dark(field.grid().cells());
    let mut group = c.benchmark_group("pulse lanes");
    for level in Level::available() {
        let mut solver = PulseSolver::new(&field, level);
        let outcomes = solver.solve(cell, samples, &stopping, &mut block);
        group.throughput(Throughput::Elements(outcomes.iter().map(|o| o.work.cell_updates).sum()));
        group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
            b.iter(|| solver.solve(black_box(cell), samples, &stopping, &mut block));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = engines, lanes
}
criterion_main!(benches);
