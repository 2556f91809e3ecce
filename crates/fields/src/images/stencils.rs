//! Differences of neighbours in rows and columns with holes.
//!
//! ```text
//! first derivative                       second derivative
//! (f1 - f-1) / 2            degree 2     f1 - 2 f0 + f-1                degree 3
//! (-3 f0 + 4 f1 - f2) / 2   degree 2     2 f0 - 5 f1 + 4 f2 - f3       degree 3
//! f1 - f0                   degree 1     f0 - 2 f1 + f2                degree 2
//! ```
//!
//! The first line applies if both neighbours exist, the others if the row ends or has a hole at one side: the
//! longest that the samples in a row allow. Each is exact for polynomials of the degree beside it. No stencil reaches
//! across a hole.

use super::kernel::{Order, turned};
use tigereye_core::Field;

/// A derivative along both axes; `None` at cells without a sample, or with too few consecutive ones.
pub(super) fn derivative(field: &Field<Option<f64>>, [x, y]: [Order; 2]) -> Field<Option<f64>> {
    turned(&along_rows(&turned(&along_rows(field, x)), y))
}

fn along_rows(field: &Field<Option<f64>>, order: Order) -> Field<Option<f64>> {
    let stencil = match order {
        Order::Value => return field.clone(),
        Order::First => slope,
        Order::Second => bend,
    };
    let mut out = field.clone();
    let width = field.grid().width();
    for (row, to) in field.values().chunks(width).zip(out.values_mut().chunks_mut(width)) {
        to.iter_mut().enumerate().for_each(|(x, v)| *v = stencil(row, x));
    }
    out
}

/// The sample `offset` cells from `x`.
fn sample(row: &[Option<f64>], x: usize, offset: isize) -> Option<f64> {
    *row.get(x.checked_add_signed(offset)?)?
}

fn slope(row: &[Option<f64>], x: usize) -> Option<f64> {
    let here = sample(row, x, 0)?;
    let side = match (sample(row, x, -1), sample(row, x, 1)) {
        (Some(a), Some(b)) => return Some(0.5 * (b - a)),
        (None, None) => return None,
        (None, _) => 1,
        (_, None) => -1,
    };
    let next = sample(row, x, side)? - here;
    let inwards = sample(row, x, 2 * side).map_or(next, |far| 2.0 * next - 0.5 * (far - here));
    Some(inwards * side as f64)
}

fn bend(row: &[Option<f64>], x: usize) -> Option<f64> {
    let here = sample(row, x, 0)?;
    if let (Some(a), Some(b)) = (sample(row, x, -1), sample(row, x, 1)) {
        return Some((b - here) + (a - here));
    }
    let side = if sample(row, x, 1).is_some() { 1 } else { -1 };
    let [one, two] = [sample(row, x, side)? - here, sample(row, x, 2 * side)? - here];
    Some(sample(row, x, 3 * side).map_or(two - 2.0 * one, |far| 4.0 * two - 5.0 * one - (far - here)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(f: impl Fn(f64) -> f64, holes: &[usize]) -> Vec<Option<f64>> {
        (0..9).map(|x| (!holes.contains(&x)).then(|| f(x as f64))).collect()
    }

    /// Values are small whole numbers, so nothing is rounded.
    #[test]
    fn stencils_are_exact_at_ends_and_holes() {
        for holes in [&[][..], &[4], &[5, 6]] {
            let (square, cube) =
                (row(|x| 3.0 + 2.0 * x * x - x, holes), row(|x| x * x * x - 2.0 * x * x, holes));
            for x in (0..9).filter(|x| !holes.contains(x)) {
                let at = x as f64;
                let three = holes != [5, 6] || x < 5;
                // Of two samples, f(7) = 94 and f(8) = 123, one gets their difference.
                let expected = if three { 4.0 * at - 1.0 } else { 29.0 };
                assert_eq!(slope(&square, x), Some(expected), "{holes:?}: {x}");
                if three {
                    assert_eq!(bend(&cube, x), Some(6.0 * at - 4.0), "{holes:?}: {x}");
                }
            }
        }
    }

    #[test]
    fn samples_without_neighbours_have_no_slope() {
        let gaps = [None, Some(1.0), None, Some(2.0), Some(4.0), None];
        let found: Vec<_> = (0..6).map(|x| (slope(&gaps, x), bend(&gaps, x))).collect();
        let pair = (Some(2.0), None);
        assert_eq!(found, [(None, None), (None, None), (None, None), pair, pair, (None, None)]);
    }
}
