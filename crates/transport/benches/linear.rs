//! The linear scheme: preparing a field, solving many sources directly, one by sweeps, and L1 norms of combinations.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Duration;
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
use tigereye_transport::{
    Combination, Dissection, Lanes, Level, LinearScattering, Operator, Real, Scattering, Scheme, Serial,
    SharedWeights, l1_norms, stationary,
};

/// Axes that turn along both sides: no cell is like its neighbour.
fn transmission(side: usize) -> TransmissionField {
    let grid = Grid::new(side, side).expect("a grid");
    let field = Field::from_fn(grid, |c| Tensor2::from_axes(0.13 * c.x as f64 + 0.21 * c.y as f64, 4.0, 1.0));
    let directions = Directions::new(32).expect("directions");
    TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field")
}

fn direct<T: Real, const N: usize>(c: &mut Criterion) {
    for side in [51, 101] {
        let transmission = transmission(side);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &transmission);
        let field = LinearScattering::new(&scattering);
        let name = |what: &str| format!("{what}, {}, {side}x{side}", T::NAME);
        for level in Level::available() {
            let prepare = || Dissection::<T, N>::new(&field, Operator::Forward, level, &Serial);
            let mut group = c.benchmark_group(name("dissection"));
            group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
                b.iter(|| prepare().expect("light that leaves"));
            });
            group.finish();
            let dissection = prepare().expect("light that leaves");
            let mut workspace = dissection.workspace();
            let mut edges = vec![Lanes::<T, N>::zero(); 8 * side * side];
            let mut group = c.benchmark_group(name("solution"));
            group.throughput(Throughput::Elements(N as u64));
            group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
                b.iter(|| dissection.solve(black_box(&mut edges), &mut workspace));
            });
            group.finish();
        }
    }
}

fn sweeps(c: &mut Criterion) {
    let mut group = c.benchmark_group("stationary light by sweeps, 1e-6");
    for side in [51, 101, 201] {
        let transmission = transmission(side);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &transmission);
        let field = LinearScattering::new(&scattering);
        let mut q = vec![[0.0; 8]; side * side];
        q[side * side / 2] = [1.0; 8];
        let solve = || {
            stationary(&field, Operator::Forward, &q, 1e-6, &mut |_, _| ControlFlow::Continue(()))
                .expect("light that leaves")
        };
        group.throughput(Throughput::Elements((solve().sweeps * side * side) as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("{side}x{side}")), |b| b.iter(solve));
    }
    group.finish();
}

fn norms(c: &mut Criterion) {
    let side = 101;
    let transmission = transmission(side);
    let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let value = |i: usize| std::array::from_fn(|k| ((i * 31 + k * 17) % 101) as f64);
    let distributions: Vec<Vec<[f64; 8]>> =
        (0..16).map(|d| (0..side * side).map(|i| value(i + d)).collect()).collect();
    let distributions: Vec<&[[f64; 8]]> = distributions.iter().map(|d| &**d).collect();
    let combinations: Vec<Combination<f64>> =
        (0..16).map(|i| vec![(i, 0.4), ((i + 1) % 16, 0.6), ((i + 8) % 16, -1.0)]).collect();
    let mut group = c.benchmark_group("L1 norms, f64");
    group.throughput(Throughput::Elements((16 * side * side) as u64));
    for level in Level::available() {
        group.bench_function(BenchmarkId::from_parameter(level.name()), |b| {
            b.iter(|| l1_norms(&field, level, &distributions, &combinations));
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
    targets = direct::<f64, 32>, direct::<f32, 64>, sweeps, norms
}
criterion_main!(benches);
