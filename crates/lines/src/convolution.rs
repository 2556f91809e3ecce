//! Line integral convolution: noise smoothed along axes.

#[cfg(test)]
mod plain;
mod smoothing;
mod tracing;

use crate::ftle::{MAX_SAMPLES_A_CELL, check_length, check_work};
use crate::{Family, Interpolated, SamplingError, fine_grid};
use smoothing::{Window, smoothed};
use tigereye_core::{CellShape, Field, Grid, Point, SplitMix64, Vector};
use tracing::Tracing;

/// Options of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvolutionOptions {
    /// Samples per cell along its smaller side, see [`Self::samples_a_cell`].
    pub samples: usize,
    /// Length of the window to each side, in units of the smaller side of a cell ([`tigereye_core::CellShape`]).
    pub half_length: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for ConvolutionOptions {
    fn default() -> Self {
        Self { samples: 4, half_length: 5.0, seed: 1 }
    }
}

impl ConvolutionOptions {
    /// Samples per cell along x and y: as many as requested along the smaller side, and at about the same distance
    /// along the other, at most 64, so that the noise is isotropic.
    #[must_use]
    pub fn samples_a_cell(&self, cell: CellShape) -> [usize; 2] {
        let most = MAX_SAMPLES_A_CELL.max(self.samples);
        cell.sides().map(|side| ((self.samples as f64 * side).round() as usize).min(most))
    }
}

/// Steps per width of a sample.
const STEPS_A_SAMPLE: f64 = 2.0;
/// Standard deviation of the texture's brightness about 1/2.
const CONTRAST: f64 = 0.2;

/// White noise, uniform in [0, 1), convolved along an axis with a Hann window (Cabral and Leedom, Imaging vector fields
/// using line integral convolution, 1993), at samples finer than the cells ([`fine_grid`]). Lines end at the border and
/// where the axis is undefined; the remaining part of the window is normalised. Brightness is rescaled to a mean of 1/2
/// and a standard deviation of 0.2 over the field and clipped to [0, 1]. The noise is unchanged where tensors are
/// isotropic; brightness is NaN where they are zero or not finite.
///
/// # Errors
/// See [`SamplingError`].
pub fn convolved(
    field: &Interpolated<'_>,
    family: Family,
    options: &ConvolutionOptions,
) -> Result<Field<f64>, SamplingError> {
    let (grid, step) = sampled(field, options)?;
    let noise = noise(grid, options.seed);
    let tracing = Tracing { field, family, straight: None, step, samples: per_cell(field, options) };
    let window = Window { longest: options.half_length, at: &|_| options.half_length };
    Ok(rescaled(smoothed(&noise, &tracing, &window)))
}

/// Noise convolved along both axes, in proportion to their lengths: over `half_length` along the longer semi-axis (or
/// eigenvalue of larger magnitude), and proportionally less along the other. Isotropic tensors blur the noise equally
/// in every direction, anisotropic ones draw it out into lines (Zheng and Pang, HyperLIC, 2003: a first pass along the
/// minor axis, a second one over its result along the major axis). The axes of an isotropic tensor are taken to be x
/// and y. Brightness as in [`convolved`].
///
/// # Errors
/// See [`SamplingError`].
pub fn hyper_convolved(
    field: &Interpolated<'_>,
    options: &ConvolutionOptions,
) -> Result<Field<f64>, SamplingError> {
    let (grid, step) = sampled(field, options)?;
    let mut texture = noise(grid, options.seed);
    for (family, straight) in
        [(Family::Minor, Vector::new(0.0, -1.0)), (Family::Major, Vector::new(1.0, 0.0))]
    {
        let tracing =
            Tracing { field, family, straight: Some(straight), step, samples: per_cell(field, options) };
        let length = |at: Point| {
            let Some(frame) = field.frame(at, 0.0) else { return options.half_length };
            let [own, other] = [family as usize, 1 - family as usize].map(|i| frame.values[i].abs());
            let longer = own.max(other);
            if longer > 0.0 { options.half_length * own / longer } else { 0.0 }
        };
        let window = Window { longest: options.half_length, at: &length };
        texture = smoothed(&texture, &tracing, &window);
    }
    Ok(rescaled(texture))
}

fn sampled(field: &Interpolated<'_>, options: &ConvolutionOptions) -> Result<(Grid, f64), SamplingError> {
    let grid = fine_grid(field.field().grid(), options.samples_a_cell(field.cell()))?;
    let step = 1.0 / (STEPS_A_SAMPLE * options.samples as f64);
    check_length(options.half_length, step)?;
    check_work(grid, options.half_length, step)?;
    Ok((grid, step))
}

fn per_cell(field: &Interpolated<'_>, options: &ConvolutionOptions) -> [f64; 2] {
    options.samples_a_cell(field.cell()).map(|n| n as f64)
}

/// White noise that depends only on the seed: the number of a sample is a hash of its column and row.
fn noise(grid: Grid, seed: u64) -> Field<f64> {
    // Odd, so that different seeds give different states.
    const SEED_STEP: u64 = 0xd134_2543_de82_ef95;
    Field::from_fn(grid, |c| {
        let sample = ((c.y as u64) << 32 | c.x as u64).wrapping_mul(SplitMix64::STEP);
        SplitMix64::unit_at(sample.wrapping_add(seed.wrapping_mul(SEED_STEP)))
    })
}

/// Brightness rescaled to the usual mean and deviation.
fn rescaled(texture: Field<f64>) -> Field<f64> {
    let finite = || texture.values().iter().copied().filter(|v| v.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    let deviation = (finite().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count).sqrt();
    let factor = if deviation > 1e-9 { CONTRAST / deviation } else { 0.0 };
    texture.map(|v| if v.is_finite() { (0.5 + factor * (v - mean)).clamp(0.0, 1.0) } else { f64::NAN })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use tigereye_core::{Cell, Tensor2, math};

    fn field(size: [usize; 2], t: impl Fn(f64, f64) -> Tensor2) -> Field<Tensor2> {
        Field::from_fn(Grid::new(size[0], size[1]).expect("a size"), |c| t(c.x as f64, c.y as f64))
    }

    fn options(half_length: f64, samples: usize) -> ConvolutionOptions {
        ConvolutionOptions { samples, half_length, seed: 3 }
    }

    #[test]
    fn noise_is_uniform_and_independent() {
        let grid = Grid::new(200, 200).expect("a size");
        let noise = noise(grid, 1);
        let n = grid.cells() as f64;
        let mean = noise.values().iter().sum::<f64>() / n;
        let variance = noise.values().iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
        // Three standard errors of 40 000 numbers.
        assert!((mean - 0.5).abs() < 3.0 * (1.0 / 12.0 / n).sqrt());
        assert!((variance - 1.0 / 12.0).abs() < 3.0 * (1.0 / 180.0 / n).sqrt());
        let with = |dx: usize, dy: usize| {
            let pairs = noise.iter().filter(|(c, _)| c.x + dx < 200 && c.y + dy < 200);
            pairs.map(|(c, v)| (v - mean) * (noise.at(Cell::new(c.x + dx, c.y + dy)) - mean)).sum::<f64>() / n
        };
        for (dx, dy) in [(1, 0), (0, 1), (1, 1), (2, 0)] {
            assert!(with(dx, dy).abs() < 4.0 / 12.0 / n.sqrt(), "{dx} {dy}");
        }
        assert_ne!(super::noise(grid, 2), noise);
    }

    /// Along x the texture is the noise of its row under Hann's window.
    #[test]
    fn straight_lines_give_the_convolution_of_their_row() {
        let tensors = field([20, 6], |_, _| Tensor2::from_axes(0.0, 2.0, 1.0));
        let between = Interpolated::new(&tensors);
        let (half, samples) = (3.0, 2);
        let tracing =
            Tracing { field: &between, family: Family::Major, straight: None, step: 0.25, samples: [2.0; 2] };
        let noise = noise(fine_grid(tensors.grid(), [samples; 2]).expect("samples"), 3);
        let found = smoothed(&noise, &tracing, &Window { longest: half, at: &|_| half });
        let grid = noise.grid();
        for cell in grid.iter() {
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in -11_i32..=11 {
                let x = cell.x as f64 + 0.5 * f64::from(k);
                // Half-way between samples the farther one from zero is taken.
                let nearest = x.round();
                if (0.0..grid.width() as f64).contains(&nearest) && x >= 0.0 && x <= grid.width() as f64 - 1.0
                {
                    let weight = 0.5 * (1.0 + math::cos(PI * f64::from(k) * 0.25 / half));
                    sum += weight * noise.at(Cell::new(nearest as usize, cell.y));
                    weights += weight;
                }
            }
            assert!((found.at(cell) - sum / weights).abs() < 1e-12, "{cell:?}");
        }
    }

    /// Correlation of two textures, and the ratio of their deviations, over the samples that both have.
    fn likeness(a: &Field<f64>, b: &Field<f64>) -> [f64; 2] {
        let pairs = || a.values().iter().zip(b.values()).filter(|(a, b)| a.is_finite() && b.is_finite());
        let n = pairs().count() as f64;
        let mean_of = |of: &dyn Fn(f64, f64) -> f64| pairs().map(|(a, b)| of(*a, *b)).sum::<f64>() / n;
        let (ma, mb) = (mean_of(&|a, _| a), mean_of(&|_, b| b));
        let [aa, bb] = [mean_of(&|a, _| (a - ma) * (a - ma)), mean_of(&|_, b| (b - mb) * (b - mb))];
        let ab = mean_of(&|a, b| (a - ma) * (b - mb));
        [ab / (aa * bb).sqrt(), (aa / bb).sqrt()]
    }

    /// Interpolated lines give the texture of lines of one's own: the same samples and holes, nearly the same values;
    /// on fields with degenerate points, with holes, with zero tensors, and on oblong cells.
    #[test]
    fn textures_equal_those_of_a_line_for_every_sample() {
        use tigereye_test_support::field as generated;
        let mut holes = generated("inverse:size=31");
        for (i, t) in [(200, Tensor2::isotropic(f64::NAN)), (700, Tensor2::ZERO)] {
            holes.values_mut()[i] = t;
        }
        let fields = [generated("inverse:size=41"), generated("double_gyre"), generated("kirsch"), holes];
        for (n, tensors) in fields.iter().enumerate() {
            for axes in [crate::Axes::HalfAxes, crate::Axes::Eigenvectors] {
                let cell = CellShape::of([1.0, if n == 0 { 1.5 } else { 1.0 }]);
                let between = Interpolated::new(tensors).with_axes(axes).with_cell(cell);
                for straight in [None, Some(Vector::new(1.0, 0.0))] {
                    let options = options(5.0, 4);
                    let samples = per_cell(&between, &options);
                    let family = if n == 1 { Family::Minor } else { Family::Major };
                    let tracing = Tracing { field: &between, family, straight, step: 0.125, samples };
                    let noise =
                        noise(fine_grid(tensors.grid(), samples.map(|s| s as usize)).expect("samples"), 3);
                    let at = |p: Point| if straight.is_some() { 2.0 + 0.05 * p.x } else { 5.0 };
                    let longest = if straight.is_some() { 6.0 } else { 5.0 };
                    let window = Window { longest, at: &at };
                    let (found, plain) =
                        (smoothed(&noise, &tracing, &window), plain::smoothed(&noise, &tracing, &window));
                    let is_there = |f: &Field<f64>| f.values().iter().map(|v| v.is_nan()).collect::<Vec<_>>();
                    assert_eq!(is_there(&found), is_there(&plain), "{n}");
                    let [correlation, spread] = likeness(&found, &plain);
                    assert!(correlation > 0.99 && (spread - 1.0).abs() < 0.01, "{n}: {correlation} {spread}");
                }
            }
        }
    }

    /// Neighbours along the axis are alike, across it they are not.
    #[test]
    fn textures_run_along_the_axis() {
        for quarter in [0.0, 1.0] {
            let phi = quarter * 0.5 * PI;
            let tensors = field([40, 40], |_, _| Tensor2::from_axes(phi, 3.0, 1.0));
            let between = Interpolated::new(&tensors);
            for texture in [
                convolved(&between, Family::Major, &options(4.0, 2)).expect("samples"),
                hyper_convolved(&between, &options(4.0, 2)).expect("samples"),
            ] {
                let difference = |dx: usize, dy: usize| {
                    let inside = texture.iter().filter(|(c, _)| c.x < 70 && c.y < 70);
                    inside.map(|(c, v)| (v - texture.at(Cell::new(c.x + dx, c.y + dy))).abs()).sum::<f64>()
                };
                let (x, y) = (difference(2, 0), difference(0, 2));
                let (along, across) = if quarter == 0.0 { (x, y) } else { (y, x) };
                assert!(2.0 * along < across, "{along} {across}");
            }
        }
    }

    #[test]
    fn brightness_has_its_mean_and_deviation() {
        let tensors = field([60, 50], |x, y| Tensor2::from_axes(0.02 * x + 0.01 * y, 3.0, 1.0));
        let texture =
            convolved(&Interpolated::new(&tensors), Family::Minor, &options(4.0, 2)).expect("samples");
        let n = texture.values().len() as f64;
        let mean = texture.values().iter().sum::<f64>() / n;
        let deviation = (texture.values().iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt();
        // Clipping reduces both a little.
        assert!((mean - 0.5).abs() < 0.01 && (deviation - CONTRAST).abs() < 0.01, "{mean} {deviation}");
    }

    #[test]
    fn isotropic_tensors_keep_their_noise_and_missing_ones_are_nan() {
        let round = field([100, 100], |_, _| Tensor2::IDENTITY);
        let between = Interpolated::new(&round);
        let plain = convolved(&between, Family::Major, &options(3.0, 2)).expect("samples");
        assert_eq!(plain, rescaled(noise(plain.grid(), 3)));
        // Blurred equally in both directions.
        let blurred = hyper_convolved(&between, &options(3.0, 2)).expect("samples");
        let difference = |dx: usize, dy: usize| {
            let inside = blurred.iter().filter(|(c, _)| c.x < 190 && c.y < 190);
            inside.map(|(c, v)| (v - blurred.at(Cell::new(c.x + dx, c.y + dy))).abs()).sum::<f64>()
        };
        let ratio = difference(1, 0) / difference(0, 1);
        // Some thousand patches of blurred noise.
        assert!((0.9..1.1).contains(&ratio), "{ratio}");
        for t in [Tensor2::ZERO, Tensor2::isotropic(f64::NAN)] {
            let missing = field([5, 1], |_, _| t);
            let between = Interpolated::new(&missing);
            for texture in [
                convolved(&between, Family::Major, &options(3.0, 2)).expect("samples"),
                hyper_convolved(&between, &options(3.0, 2)).expect("samples"),
            ] {
                assert!(texture.values().iter().all(|v| v.is_nan()));
            }
        }
    }

    #[test]
    fn impossible_textures_are_refused() {
        let tensors = field([5, 5], |_, _| Tensor2::from_axes(0.0, 2.0, 1.0));
        let between = Interpolated::new(&tensors);
        for bad in
            [options(0.0, 2), options(f64::NAN, 2), options(1e9, 2), options(1.0, 0), options(1.0, 1000)]
        {
            assert!(convolved(&between, Family::Major, &bad).is_err(), "{bad:?}");
            assert!(hyper_convolved(&between, &bad).is_err(), "{bad:?}");
        }
    }
}
