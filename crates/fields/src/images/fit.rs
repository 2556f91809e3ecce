//! Derivatives beside borders and holes: a polynomial fitted to the samples that are there.
//!
//! Around a cell the field is taken as `c0 + c1 x + c2 y + c3 x^2 + c4 xy + c5 y^2`, by least squares over the samples
//! in reach, each weighted by the Gaussian of its distance. Where no sample is missing, its derivatives are those of
//! the Gaussian kernels (the weights make the polynomials orthogonal), so borders, holes and inner cells share one
//! definition. Missing samples have weight 0, which makes it a normalised convolution, and quadrics are met exactly
//! everywhere.
//!
//! Source: Knutsson and Westin, Normalized and differential convolution, CVPR 1993; Farnebäck, Polynomial expansion for
//! orientation and motion estimation, Linköping 2002.

use super::kernel::{CUT, Order};
use tigereye_core::math::exp;
use tigereye_core::{Cell, Field};

/// Coefficients of a fit.
const TERMS: usize = 6;
/// Powers of x and y of each.
const POWERS: [[usize; 2]; TERMS] = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];
/// Powers of the moments of the weights and of the samples that fits need.
const MOMENTS: usize = 5;
const SAMPLE_MOMENTS: usize = 3;
/// Least part of a term's square that the terms before it must leave: below, the samples do not tell it from them.
/// Samples in three columns leave more than 1e-5, rounding less than 1e-14.
const LEAST_PART: f64 = 1e-8;
/// Narrowest Gaussian of a fit, cells: below it, the third sample of a row would have negligible weight.
const NARROWEST: f64 = 0.6;
/// Columns that are done together, which bounds the memory.
const STRIP: usize = 32;

/// A polynomial around a cell, by its coefficients with distances in `scale` cells; `None` for those that the samples
/// do not determine.
pub(super) struct Fit {
    coefficients: [Option<f64>; TERMS],
    scale: f64,
}

impl Fit {
    /// A derivative at the cell, per cell.
    pub(super) fn derivative(&self, orders: [Order; 2]) -> Option<f64> {
        let powers = orders.map(|order| order as usize);
        let term = POWERS.iter().position(|p| *p == powers)?;
        let factor = if powers.contains(&2) { 2.0 } else { 1.0 };
        let lengths = powers.iter().sum::<usize>();
        Some((0..lengths).fold(factor * self.coefficients[term]?, |v, _| v / self.scale))
    }
}

/// Sums over a part of a row, weighted and times powers of the distance.
#[derive(Clone, Copy)]
struct Sums {
    /// Of ones.
    there: [f64; MOMENTS],
    /// Of samples.
    samples: [f64; SAMPLE_MOMENTS],
    /// Smallest and largest sample.
    range: [f64; 2],
}

const NOTHING: Sums =
    Sums { there: [0.0; MOMENTS], samples: [0.0; SAMPLE_MOMENTS], range: [f64::INFINITY, f64::NEG_INFINITY] };

/// Weights times powers of the distance.
struct Window {
    scale: f64,
    radius: usize,
    weights: Vec<[f64; MOMENTS]>,
}

impl Window {
    fn of(sigma: f64) -> Self {
        let scale = sigma.max(NARROWEST);
        let radius = (CUT * scale).ceil() as usize;
        let weight = |i: usize| {
            let t = (i as f64 - radius as f64) / scale;
            let mut weight = exp(-0.5 * t * t);
            std::array::from_fn(|power| {
                if power > 0 {
                    weight *= t;
                }
                weight
            })
        };
        Self { scale, radius, weights: (0..=2 * radius).map(weight).collect() }
    }

    /// Indices of `0..length` in reach of `at`, with their weights.
    fn around(&self, at: usize, length: usize) -> impl Iterator<Item = (usize, &[f64; MOMENTS])> {
        let first = at.saturating_sub(self.radius);
        let last = (at + self.radius).min(length - 1);
        (first..=last).zip(&self.weights[first + self.radius - at..])
    }

    fn of_row(&self, row: &[Option<f64>], x: usize) -> Sums {
        let mut sums = NOTHING;
        for (i, weights) in self.around(x, row.len()) {
            let Some(sample) = row[i] else { continue };
            sums.there.iter_mut().zip(weights).for_each(|(sum, w)| *sum += w);
            sums.samples.iter_mut().zip(weights).for_each(|(sum, w)| *sum += w * sample);
            sums.range = [sums.range[0].min(sample), sums.range[1].max(sample)];
        }
        sums
    }

    /// The fit from the sums of the rows around it.
    fn of_rows<'a>(&self, rows: impl Iterator<Item = (&'a Sums, &'a [f64; MOMENTS])>) -> Fit {
        let mut there = [[0.0; MOMENTS]; MOMENTS];
        let mut samples = [[0.0; SAMPLE_MOMENTS]; SAMPLE_MOMENTS];
        let mut range = NOTHING.range;
        for (sums, weights) in rows {
            for p in 0..MOMENTS {
                (0..MOMENTS - p).for_each(|q| there[p][q] += weights[q] * sums.there[p]);
            }
            for p in 0..SAMPLE_MOMENTS {
                (0..SAMPLE_MOMENTS - p).for_each(|q| samples[p][q] += weights[q] * sums.samples[p]);
            }
            range = [range[0].min(sums.range[0]), range[1].max(sums.range[1])];
        }
        let matrix = POWERS.map(|[p, q]| POWERS.map(|[r, s]| there[p + r][q + s]));
        // Of constants not even rounding is left.
        let flat = range[0] >= range[1];
        let right = POWERS.map(|[p, q]| if flat { 0.0 } else { samples[p][q] });
        Fit { coefficients: solved(matrix, right), scale: self.scale }
    }
}

/// Solves the normal equations term by term, omitting terms that depend on previous ones.
fn solved(mut matrix: [[f64; TERMS]; TERMS], mut right: [f64; TERMS]) -> [Option<f64>; TERMS] {
    let whole: [f64; TERMS] = std::array::from_fn(|k| matrix[k][k]);
    let mut kept = [false; TERMS];
    for k in 0..TERMS {
        kept[k] = matrix[k][k] > LEAST_PART * whole[k];
        if !kept[k] {
            continue;
        }
        let row = matrix[k];
        for i in k + 1..TERMS {
            let factor = matrix[i][k] / row[k];
            (k + 1..TERMS).for_each(|j| matrix[i][j] -= factor * row[j]);
            right[i] -= factor * right[k];
        }
    }
    let mut solution = [None; TERMS];
    for k in (0..TERMS).rev().filter(|&k| kept[k]) {
        let known = (k + 1..TERMS).filter_map(|j| Some(matrix[k][j] * solution[j]?));
        solution[k] = Some(known.fold(right[k], |rest, v: f64| rest - v) / matrix[k][k]);
    }
    solution
}

/// Fits around all cells that are `wanted`, strip by strip of columns.
pub(super) fn each_fit(
    field: &Field<Option<f64>>,
    wanted: &Field<bool>,
    sigma: f64,
    mut found: impl FnMut(Cell, Fit),
) {
    let window = Window::of(sigma);
    let (width, height) = (field.grid().width(), field.grid().height());
    for left in (0..width).step_by(STRIP) {
        let columns = left..(left + STRIP).min(width);
        let is_wanted: Vec<bool> =
            (0..height).map(|y| columns.clone().any(|x| *wanted.at(Cell::new(x, y)))).collect();
        let mut rows: Vec<Vec<Sums>> = Vec::with_capacity(height);
        for (y, row) in field.values().chunks(width).enumerate() {
            let needed = window.around(y, height).any(|(other, _)| is_wanted[other]);
            let sums = || columns.clone().map(|x| window.of_row(row, x)).collect();
            rows.push(if needed { sums() } else { Vec::new() });
        }
        for y in (0..height).filter(|&y| is_wanted[y]) {
            for x in columns.clone().filter(|&x| *wanted.at(Cell::new(x, y))) {
                let around = window.around(y, height).map(|(row, weights)| (&rows[row][x - left], weights));
                found(Cell::new(x, y), window.of_rows(around));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn fits(field: &Field<Option<f64>>, sigma: f64) -> Vec<(Cell, Fit)> {
        let mut all = Vec::new();
        each_fit(field, &field.map(Option::is_some), sigma, |cell, fit| all.push((cell, fit)));
        all
    }

    /// Samples in two columns do not determine x^2, those in one column do not determine x.
    #[test]
    fn terms_that_samples_do_not_determine_are_left_out() {
        for (width, known) in [(1, [false, false]), (2, [true, false]), (3, [true, true])] {
            let grid = Grid::new(width, 9).expect("a size");
            let field = Field::from_fn(grid, |c| Some(c.x as f64 + (c.y * c.y) as f64));
            for (cell, fit) in fits(&field, 1.0) {
                let of = |orders| fit.derivative(orders);
                let found = [Order::First, Order::Second].map(|o| of([o, Order::Value]).is_some());
                assert_eq!(found, known, "{width} columns, {cell:?}");
                let down = of([Order::Value, Order::First]).expect("nine rows");
                assert!((down - 2.0 * cell.y as f64).abs() < 1e-9, "{cell:?}: {down}");
            }
        }
    }

    #[test]
    fn constants_have_no_derivatives() {
        let field = Field::from_fn(Grid::new(9, 7).expect("a size"), |c| (c.x != 3).then_some(0.1 + 0.7));
        for (cell, fit) in fits(&field, 1.3) {
            for orders in
                POWERS[1..].iter().map(|p| p.map(|n| [Order::Value, Order::First, Order::Second][n]))
            {
                assert_eq!(fit.derivative(orders), Some(0.0), "{cell:?}");
            }
        }
    }
}
