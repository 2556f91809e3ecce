//! The classical methods: lines side by side against one after another, textures, topology, ridges.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use tigereye_core::{CellShape, Point};
use tigereye_lines::{
    ConvolutionOptions, Family, Followed, Following, FtleOptions, LineOptions, Topology, convolved,
    evenly_spaced, ftle, half_line_end, hyper_convolved, usual_axes,
};
use tigereye_test_support::field;

/// The field of circles, prepared.
fn followed(size: usize) -> Followed {
    let tensors = field(&format!("inverse:size={size}"));
    let following = Following { axes: usual_axes(&tensors).into(), cell: CellShape::SQUARE };
    Followed::new(&tensors, following)
}

fn methods(c: &mut Criterion) {
    let mut group = c.benchmark_group("classical");
    group.sample_size(10);
    for size in [64, 128] {
        let followed = followed(size);
        let field = followed.interpolated();
        group.bench_function(BenchmarkId::new("lic", size), |b| {
            b.iter(|| convolved(black_box(&field), Family::Major, &ConvolutionOptions::default()));
        });
        group.bench_function(BenchmarkId::new("hyperlic", size), |b| {
            b.iter(|| hyper_convolved(black_box(&field), &ConvolutionOptions::default()));
        });
        let options = FtleOptions { length: 20.0, ..FtleOptions::default() };
        group.bench_function(BenchmarkId::new("ftle", size), |b| {
            b.iter(|| ftle(black_box(&field), Family::Major, &options));
        });
        // The ends that the exponents of one sample per cell and one direction need, line by line.
        let alone = LineOptions { step: 0.25, length: 20.0, ..LineOptions::default() };
        group.bench_function(BenchmarkId::new("single lines", size), |b| {
            b.iter(|| {
                for y in 0..size {
                    for x in 0..size {
                        let at = Point::new(x as f64, y as f64);
                        if let Some(d) = field.direction(at, Family::Major, 1e-3) {
                            black_box(half_line_end(&field, at, d, Family::Major, &alone));
                        }
                    }
                }
            });
        });
        group.bench_function(BenchmarkId::new("evenly spaced", size), |b| {
            b.iter(|| evenly_spaced(black_box(&field), Family::Major, 1.0, &LineOptions::default()));
        });
        group.bench_function(BenchmarkId::new("topology", size), |b| {
            b.iter(|| {
                Topology::of(black_box(&field), &[Family::Major, Family::Minor], &LineOptions::default())
            });
        });
    }
    group.finish();
}

criterion_group!(benches, methods);
criterion_main!(benches);
