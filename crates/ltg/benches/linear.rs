//! Gradients of the linear scheme on rayon's global pool: exact, and from sketches (random numbers, solutions, look-ups
//! and logarithms together; the observer's phases tell them apart in `tigereye ltg --json`).

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
use tigereye_ltg::{
    LtgSettings, Shard, SketchSettings, SketchedGradient, linear_sweep_part, omega_step_of_volumes,
};
use tigereye_transport::{Level, LinearScattering, Scattering, Scheme, SharedWeights};

/// Axes that turn along both sides: no cell is like its neighbour.
fn transmission(side: usize, samples: usize) -> TransmissionField {
    let grid = Grid::new(side, side).expect("a grid");
    let field = Field::from_fn(grid, |c| Tensor2::from_axes(0.13 * c.x as f64 + 0.21 * c.y as f64, 4.0, 1.0));
    let directions = Directions::new(samples).expect("directions");
    TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field")
}

fn exact(c: &mut Criterion) {
    let mut group = c.benchmark_group("exact");
    for (side, samples) in [(13, 32), (29, 32)] {
        let transmission = transmission(side, samples);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &transmission);
        let field = LinearScattering::new(&scattering);
        let settings = LtgSettings::reference(transmission.directions());
        group.throughput(Throughput::Elements((side * side * samples) as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("{side}x{side}x{samples}")), |b| {
            b.iter(|| linear_sweep_part(&field, &settings, Shard::WHOLE, None, &()).expect("a sweep"));
        });
    }
    group.finish();
}

fn sketched(c: &mut Criterion) {
    let mut group = c.benchmark_group("256 sketches");
    for (side, samples) in [(29, 32), (51, 32), (101, 32)] {
        let transmission = transmission(side, samples);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &transmission);
        let field = LinearScattering::new(&scattering);
        let settings = SketchSettings {
            sketches: 256,
            seed: 0,
            omega_step: omega_step_of_volumes(transmission.directions()),
            slices: None,
            memory_bytes: 4 << 30,
            level: Level::detect(),
        };
        let gradient = SketchedGradient::new(&field, settings).expect("settings");
        group.throughput(Throughput::Elements((side * side * 256) as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("{side}x{side}x{samples}")), |b| {
            b.iter(|| gradient.run(Shard::WHOLE, gradient.sums(), &()).expect("sketches"));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = exact, sketched
}
criterion_main!(benches);
