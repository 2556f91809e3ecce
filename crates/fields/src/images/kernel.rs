//! Gaussians, their derivatives, and correlation along rows and columns.

use tigereye_core::math::exp;
use tigereye_core::{Cell, Field};

/// Gaussians are truncated at this many standard deviations, where they are below 4e-4 of their maximum.
pub(super) const CUT: f64 = 4.0;

/// Which derivative along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Order 0: the smoothed value.
    Value,
    /// The first.
    First,
    /// The second.
    Second,
}

/// Weights of the samples -r to r.
pub(super) struct Kernel {
    weights: Vec<f64>,
    parity: Parity,
}

/// How samples at both sides of the middle are put together, so that constants give exactly nothing.
#[derive(Clone, Copy)]
enum Parity {
    /// A mean.
    Mean,
    /// `f(i) - f(-i)`.
    Odd,
    /// `(f(i) - f(0)) + (f(-i) - f(0))`.
    Even,
}

/// Gaussians this narrow have neighbours only, whose weights then do not depend on them.
pub(super) const NARROW: f64 = 1.0 / CUT;

impl Kernel {
    fn of(sigma: f64, parity: Parity, weight: impl Fn(f64) -> f64) -> Self {
        let radius = (CUT * sigma).ceil() as i32;
        Self { weights: (-radius..=radius).map(|i| weight(f64::from(i))).collect(), parity }
    }

    /// A moment of the weights.
    fn sum(&self, power: i32) -> f64 {
        let radius = (self.weights.len() / 2) as f64;
        let raised = |x: f64| (0..power).fold(1.0, |p, _| p * x);
        self.weights.iter().enumerate().map(|(i, w)| w * raised(i as f64 - radius)).sum()
    }

    fn scaled(mut self, factor: f64) -> Self {
        self.weights.iter_mut().for_each(|w| *w *= factor);
        self
    }

    /// The kernel of an order of derivative.
    pub(super) fn of_order(order: Order, sigma: f64) -> Self {
        match order {
            Order::Value => Self::gauss(sigma),
            Order::First => Self::first(sigma),
            Order::Second => Self::second(sigma),
        }
    }

    /// Cells at each side of the middle that it reaches.
    pub(super) const fn radius(&self) -> usize {
        self.weights.len() / 2
    }

    /// Weights of sum 1.
    pub(super) fn gauss(sigma: f64) -> Self {
        if sigma == 0.0 {
            return Self { weights: vec![1.0], parity: Parity::Mean };
        }
        let kernel = Self::of(sigma, Parity::Mean, |x| exp(-0.5 * (x / sigma) * (x / sigma)));
        let sum = kernel.sum(0);
        kernel.scaled(1.0 / sum)
    }

    /// First derivative, exact for polynomials of degree 2.
    pub(super) fn first(sigma: f64) -> Self {
        if sigma <= NARROW {
            return Self { weights: vec![-0.5, 0.0, 0.5], parity: Parity::Odd };
        }
        let kernel = Self::of(sigma, Parity::Odd, |x| x * exp(-0.5 * (x / sigma) * (x / sigma)));
        let slope = kernel.sum(1);
        kernel.scaled(1.0 / slope)
    }

    /// Second derivative, exact for polynomials of degree 3.
    pub(super) fn second(sigma: f64) -> Self {
        if sigma <= NARROW {
            return Self { weights: vec![1.0, -2.0, 1.0], parity: Parity::Even };
        }
        let spread = Self::gauss(sigma).sum(2);
        let kernel =
            Self::of(sigma, Parity::Even, |x| (x * x - spread) * exp(-0.5 * (x / sigma) * (x / sigma)));
        let bend = kernel.sum(2);
        kernel.scaled(2.0 / bend)
    }
}

/// The sample at any index of a non-empty row; beyond the ends the row continues as its mirror image, `f(i - 1)`
/// at -i.
fn mirrored(row: &[f64], index: i64) -> f64 {
    let last = row.len() as i64 - 1;
    if index < 0 {
        mirrored(row, -index - 1)
    } else if index > last {
        mirrored(row, 2 * last + 1 - index)
    } else {
        row[index as usize]
    }
}

fn correlated(row: &[f64], kernel: &Kernel) -> Vec<f64> {
    let middle = kernel.weights.len() / 2;
    let sides = kernel.weights[middle + 1..].iter().zip(1..);
    let at = |x: usize| -> f64 {
        let sample = |i: i64| mirrored(row, x as i64 + i);
        let here = row[x];
        match kernel.parity {
            Parity::Mean => {
                let both = |(w, i): (&f64, i64)| w * (sample(i) + sample(-i));
                sides.clone().map(both).fold(kernel.weights[middle] * here, |sum, v| sum + v)
            }
            Parity::Odd => sides.clone().map(|(w, i)| w * (sample(i) - sample(-i))).sum(),
            Parity::Even => sides.clone().map(|(w, i)| w * ((sample(i) - here) + (sample(-i) - here))).sum(),
        }
    };
    (0..row.len()).map(at).collect()
}

/// Correlation of every row, mirrored at its ends.
pub(super) fn along_rows(field: &Field<f64>, kernel: &Kernel) -> Field<f64> {
    let mut out = field.clone();
    let width = field.grid().width();
    for (row, to) in field.values().chunks(width).zip(out.values_mut().chunks_mut(width)) {
        to.copy_from_slice(&correlated(row, kernel));
    }
    out
}

/// Correlation of every column, downwards, mirrored at its ends.
pub(super) fn columns_of(field: &Field<f64>, kernel: &Kernel) -> Field<f64> {
    turned(&along_rows(&turned(field), kernel))
}

/// Rows and columns exchanged.
pub(super) fn turned<T: Copy>(field: &Field<T>) -> Field<T> {
    Field::from_fn(field.grid().transposed(), |c| *field.at(Cell::new(c.y, c.x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments decide what is exact: a Gaussian keeps constants, the first derivative turns x into 1, the second x^2
    /// into 2, and each leaves the other powers below alone.
    #[test]
    fn kernels_are_exact_for_low_polynomials() {
        for sigma in [0.0, 1e-3, 0.02, 0.25, 0.26, 0.4, 1.0, 2.5] {
            let near = |k: &Kernel, power, expected: f64| {
                assert!((k.sum(power) - expected).abs() < 1e-12, "{sigma}: moment {power}");
            };
            let (gauss, first, second) = (Kernel::gauss(sigma), Kernel::first(sigma), Kernel::second(sigma));
            near(&gauss, 0, 1.0);
            near(&gauss, 1, 0.0);
            near(&first, 0, 0.0);
            near(&first, 1, 1.0);
            near(&first, 2, 0.0);
            near(&second, 0, 0.0);
            near(&second, 1, 0.0);
            near(&second, 2, 2.0);
            near(&second, 3, 0.0);
        }
        assert!((Kernel::gauss(2.5).sum(2) - 6.25).abs() < 0.02, "cut at four standard deviations");
    }

    /// Not even rounding is left of them.
    #[test]
    fn constants_have_no_derivatives() {
        let grid = tigereye_core::Grid::new(9, 7).expect("a size");
        let flat = Field::from_fn(grid, |_| 0.1 + 0.7);
        for sigma in [0.0, 0.01, 0.2, 0.3, 1.0, 2.7] {
            for kernel in [Kernel::first(sigma), Kernel::second(sigma)] {
                let smooth = along_rows(&flat, &Kernel::gauss(sigma));
                let down = columns_of(&smooth, &kernel);
                let across = along_rows(&flat, &kernel);
                assert!(down.values().iter().chain(across.values()).all(|v| *v == 0.0), "sigma {sigma}");
            }
        }
    }

    #[test]
    fn rows_continue_as_their_mirror_image() {
        let row = [1.0, 3.0, 7.0];
        assert_eq!([-3, -2, -1, 3, 4, 5].map(|i| mirrored(&row, i)), [7.0, 3.0, 1.0, 7.0, 3.0, 1.0]);
        assert_eq!(mirrored(&[4.0], -3), 4.0);
    }
}
