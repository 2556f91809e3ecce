//! Whole sweeps of small fields on rayon's global pool: cell updates per second, comparisons included.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField, math};
use tigereye_ltg::{LtgSettings, sweep};
use tigereye_transport::{Scattering, Scheme, SharedWeights};

/// Ellipses of ratio 4 that point away from the centre.
fn radial(side: usize, samples: usize) -> TransmissionField {
    let grid = Grid::new(side, side).expect("a grid");
    let centre = grid.centre();
    let field = Field::from_fn(grid, |c| {
        let (dx, dy) = (c.x as f64 - centre.x as f64, c.y as f64 - centre.y as f64);
        Tensor2::from_axes(math::atan2(dx, dy), 4.0, 1.0)
    });
    let directions = Directions::new(samples).expect("directions");
    TransmissionField::from_tensors(&field, directions, Normalization::Local).expect("a field")
}

fn sweeps(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep");
    for (side, samples) in [(13, 32), (21, 16)] {
        let transmission = radial(side, samples);
        let scheme = Scheme::new(transmission.directions(), SharedWeights::Thesis);
        let field = Scattering::new(&scheme, &transmission);
        let settings = LtgSettings::reference(transmission.directions());
        let work = sweep(&field, &settings, &()).expect("a sweep").work;
        group.throughput(Throughput::Elements(work.cell_updates));
        group.bench_function(BenchmarkId::from_parameter(format!("{side}x{side}x{samples}")), |b| {
            b.iter(|| sweep(&field, &settings, &()).expect("a sweep"));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(5));
    targets = sweeps
}
criterion_main!(benches);
