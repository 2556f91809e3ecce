//! The finite-time Lyapunov exponent of tensor lines.

use crate::flow_map::{exponent_of, gradient_at};
use crate::lanes::ends_of_lines;
use crate::walk::Walk;
use crate::{Family, Interpolated, LineEnd, LineOptions, Method};
use rayon::prelude::*;
use thiserror::Error;
use tigereye_core::{Cell, CellShape, Field, Grid, PhysicalPoint, Point, Vector};
use tigereye_simd::Level;

/// How the exponent is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FtleOptions {
    /// Length of the lines to each side, in units of the smaller side of a cell ([`tigereye_core::CellShape`]).
    pub length: f64,
    /// Longest step of the lines, in the same unit.
    pub step: f64,
    /// Largest error of a step, in the same unit ([`Method::RungeKutta43`]).
    pub tolerance: f64,
    /// Samples per cell along each side.
    pub samples: usize,
    /// See [`LineOptions::least_anisotropy`].
    pub least_anisotropy: f64,
}

impl Default for FtleOptions {
    fn default() -> Self {
        Self { length: 10.0, step: 1.0, tolerance: 1e-5, samples: 2, least_anisotropy: 1e-3 }
    }
}

/// Why an exponent or a texture cannot be computed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SamplingError {
    /// More samples than fit.
    #[error("{width} x {height} samples: expected at most {limit} together")]
    TooManySamples {
        /// Samples per row.
        width: usize,
        /// Rows.
        height: usize,
        /// Most samples.
        limit: usize,
    },
    /// Zero samples per cell, or too many.
    #[error("{samples} samples per cell: expected 1 to {limit}")]
    Samples {
        /// The number requested.
        samples: usize,
        /// The largest number.
        limit: usize,
    },
    /// More steps than can be computed in reasonable time.
    #[error("{samples} lines of {steps} steps to each side: expected at most {limit:e} steps together")]
    Work {
        /// Lines.
        samples: usize,
        /// Steps to each side.
        steps: f64,
        /// Largest total number of steps.
        limit: f64,
    },
    /// An invalid length or step.
    #[error(
        "a length of {length} cells in steps of {step}: expected positive numbers, and at most {limit} steps"
    )]
    Length {
        /// The length.
        length: f64,
        /// The step.
        step: f64,
        /// Most steps.
        limit: f64,
    },
}

/// Exponents at samples finer than the cells: sample (i, j) lies at `(i / samples, j / samples)` in cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Ftle {
    /// Samples per cell along each side.
    pub samples: usize,
    /// The shape of a cell, whose smaller side is the unit of length.
    pub cell: CellShape,
    /// The larger exponent of the two directions of the line, per unit of length ([`tigereye_core::CellShape`]); NaN
    /// where there is no line, or where it leaves the field.
    pub larger: Field<f64>,
    /// The smaller one.
    pub smaller: Field<f64>,
    /// Share of the lines that leave the field, or reach a non-finite cell, before they have their full length.
    pub left: f64,
}

/// Most samples in all, and per cell along a side.
const MAX_SAMPLES: usize = 1 << 26;
pub(crate) const MAX_SAMPLES_A_CELL: usize = 64;
/// Most steps of a line.
const MAX_STEPS: f64 = 1e5;
/// Most steps of all lines together: more than an hour of computation.
const MAX_WORK: f64 = 1e11;

/// The grid of samples finer than the cells of a grid: `m (W - 1) + 1` by `n (H - 1) + 1` for m samples per cell along
/// x and n along y.
///
/// # Errors
/// [`SamplingError::Samples`] and [`SamplingError::TooManySamples`].
pub fn fine_grid(grid: Grid, samples: [usize; 2]) -> Result<Grid, SamplingError> {
    if let Some(&samples) = samples.iter().find(|s| !(1..=MAX_SAMPLES_A_CELL).contains(*s)) {
        return Err(SamplingError::Samples { samples, limit: MAX_SAMPLES_A_CELL });
    }
    let [width, height] = [samples[0] * (grid.width() - 1) + 1, samples[1] * (grid.height() - 1) + 1];
    let too_many = SamplingError::TooManySamples { width, height, limit: MAX_SAMPLES };
    if width.saturating_mul(height) > MAX_SAMPLES {
        return Err(too_many);
    }
    Grid::new(width, height).map_err(|_| too_many)
}

pub(crate) fn check_length(length: f64, step: f64) -> Result<(), SamplingError> {
    let limit = MAX_STEPS;
    let possible = length > 0.0 && step > 0.0 && step.is_finite() && length / step <= limit;
    if possible { Ok(()) } else { Err(SamplingError::Length { length, step, limit }) }
}

/// Refuses work that would take days.
pub(crate) fn check_work(samples: Grid, length: f64, step: f64) -> Result<(), SamplingError> {
    let steps = 2.0 * samples.cells() as f64 * length / step;
    if steps <= MAX_WORK {
        return Ok(());
    }
    Err(SamplingError::Work { samples: samples.cells(), steps: (length / step).ceil(), limit: MAX_WORK })
}

/// The exponent of the map that moves a point along its line by a length, after Hlawatsch, Vollrath, Sadlo and Weiskopf
/// (Coherent structures of characteristic curves in symmetric second order tensor fields, 2011), for both directions of
/// the line. A line has no sign, so the directions of neighbouring samples are aligned with that of the sample; both
/// resulting exponents are kept. A line that ends at a degenerate point stays there while its neighbours pass on either
/// side, so they separate. A line that leaves the field, or reaches a non-finite cell, has no end point: differences
/// beside it are one-sided, and its own sample has no exponent. (The exponent of the other direction alone would be
/// smaller than those of the neighbouring samples, an edge that looks like a ridge.)
///
/// # Errors
/// See [`SamplingError`].
pub fn ftle(field: &Interpolated<'_>, family: Family, options: &FtleOptions) -> Result<Ftle, SamplingError> {
    check_length(options.length, options.step)?;
    let grid = fine_grid(field.field().grid(), [options.samples; 2])?;
    check_work(grid, options.length, options.step)?;
    let samples = options.samples as f64;
    let follow = LineOptions {
        method: Method::RungeKutta43 { tolerance: options.tolerance },
        step: options.step,
        length: options.length,
        least_anisotropy: options.least_anisotropy,
        ..LineOptions::default()
    };
    let walk = Walk { field, family, options: &follow };
    let level = Level::detect();
    let row = |y: usize| {
        let at = |x: usize| Point::new(x as f64 / samples, y as f64 / samples);
        let directions: Vec<Option<Vector>> =
            (0..grid.width()).map(|x| field.direction(at(x), family, options.least_anisotropy)).collect();
        let lines: Vec<(Point, Vector)> = directions
            .iter()
            .enumerate()
            .flat_map(|(x, d)| d.iter().flat_map(move |&d| [d, -d].map(|d| (at(x), d))))
            .collect();
        let ends = ends_of_lines(&walk, &lines, level);
        let mut ends = ends.chunks_exact(2).map(|both| {
            [both[0], both[1]].map(|(end, why)| (why != LineEnd::Border).then(|| field.cell().physical(end)))
        });
        let mut start = |direction| Some(Start { direction, ends: ends.next()? });
        directions.into_iter().map(|d| d.and_then(&mut start)).collect::<Vec<_>>()
    };
    let starts: Vec<Option<Start>> = (0..grid.height()).into_par_iter().flat_map_iter(row).collect();
    let both: Vec<[f64; 2]> = (0..grid.cells())
        .into_par_iter()
        .map(|i| both_exponents(grid.cell(i), grid, &starts, (field.cell(), options)))
        .collect();
    let lines = 2 * starts.iter().flatten().count();
    let early = starts.iter().flatten().flat_map(|s| s.ends).filter(Option::is_none).count();
    let of = |pick: fn(&[f64; 2]) -> f64| Field::from_fn(grid, |c| pick(&both[grid.index(c)]));
    Ok(Ftle {
        samples: options.samples,
        cell: field.cell(),
        larger: of(|[a, b]| if (a + b).is_nan() { f64::NAN } else { a.max(*b) }),
        smaller: of(|[a, b]| if (a + b).is_nan() { f64::NAN } else { a.min(*b) }),
        left: early as f64 / lines.max(1) as f64,
    })
}

/// The line of a sample: its direction and both end points.
struct Start {
    direction: Vector,
    /// Along that direction, and against it; `None` where the line leaves the field.
    ends: [Option<PhysicalPoint>; 2],
}

fn both_exponents(
    cell: Cell,
    grid: Grid,
    starts: &[Option<Start>],
    (shape, options): (CellShape, &FtleOptions),
) -> [f64; 2] {
    let Some(own) = &starts[grid.index(cell)] else { return [f64::NAN; 2] };
    let spacing = shape.sides().map(|side| side * (1.0 / options.samples as f64));
    [0, 1].map(|side| {
        let end = |c: Cell| {
            let s = starts[grid.index(c)].as_ref()?;
            let along = s.direction.dot(own.direction);
            s.ends[if along < 0.0 { 1 - side } else { side }]
        };
        let gradient = gradient_at(cell, grid, spacing, &end);
        gradient.map_or(f64::NAN, |f| exponent_of(&f, options.length))
    })
}
