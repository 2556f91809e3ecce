//! Hartigan's dip: how far a sample is from having one mode.

/// The dip of a sample (J. A. Hartigan and P. M. Hartigan, The dip test of unimodality, Annals of Statistics 13, 1985;
/// algorithm AS 217, Applied Statistics 34, 1985): the largest difference between its distribution function and the
/// nearest one with a single mode, from `1/(2n)` to 1/4. `sorted` is ascending. 0 for fewer than two different values.
///
/// The nearest such function is convex up to the mode and concave from there on, so the algorithm narrows an interval
/// down between the greatest convex minorant of the distribution function and its least concave majorant.
pub(crate) fn dip(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    if n < 2 || sorted[0] == sorted[n - 1] {
        return 0.0;
    }
    let (minorant, majorant) = (convex_minorant(sorted), concave_majorant(sorted));
    let (mut low, mut high) = (0, n - 1);
    // In units of 1/(2n).
    let mut dip = 1.0_f64;
    while low < high {
        // Both from one end to the other, the first downwards.
        let below = chain(high, low, &minorant);
        let above = chain(low, high, &majorant);
        let widest = widest_gap(sorted, &below, &above);
        if widest.gap < dip {
            break;
        }
        let left = (widest.below..below.len() - 1)
            .map(|j| largest_excess(sorted, below[j + 1], below[j], 1.0))
            .fold(0.0, f64::max);
        let right = (widest.above..above.len() - 1)
            .map(|j| largest_excess(sorted, above[j], above[j + 1], -1.0))
            .fold(0.0, f64::max);
        dip = dip.max(left).max(right);
        if low == below[widest.below] && high == above[widest.above] {
            break;
        }
        (low, high) = (below[widest.below], above[widest.above]);
    }
    dip / (2.0 * n as f64)
}

/// For each value the one before it on the greatest convex minorant of the function up to there.
fn convex_minorant(x: &[f64]) -> Vec<usize> {
    let mut before = vec![0; x.len()];
    for j in 1..x.len() {
        before[j] = j - 1;
        loop {
            let a = before[j];
            let b = before[a];
            if a == 0 || (x[j] - x[a]) * ((a - b) as f64) < (x[a] - x[b]) * ((j - a) as f64) {
                break;
            }
            before[j] = b;
        }
    }
    before
}

/// For each value the one after it on the least concave majorant of the function from there on.
fn concave_majorant(x: &[f64]) -> Vec<usize> {
    let last = x.len() - 1;
    let mut after = vec![last; x.len()];
    for k in (0..last).rev() {
        after[k] = k + 1;
        loop {
            let a = after[k];
            let b = after[a];
            if a == last || (x[a] - x[k]) * ((b - a) as f64) < (x[b] - x[a]) * ((a - k) as f64) {
                break;
            }
            after[k] = b;
        }
    }
    after
}

fn chain(from: usize, to: usize, next: &[usize]) -> Vec<usize> {
    let mut points = vec![from];
    let mut at = from;
    while at != to {
        at = next[at];
        points.push(at);
    }
    points
}

/// The largest distance of minorant and majorant, and the points of both between which it lies.
struct Widest {
    gap: f64,
    below: usize,
    above: usize,
}

fn widest_gap(x: &[f64], below: &[usize], above: &[usize]) -> Widest {
    let mut widest = Widest { gap: 0.0, below: below.len() - 1, above: above.len() - 1 };
    if below.len() == 2 && above.len() == 2 {
        return Widest { gap: 1.0, ..widest };
    }
    // From the lower end upwards, at the points of both in turn.
    let (mut ib, mut ia) = (below.len() - 2, 1);
    loop {
        let (b, a) = (below[ib], above[ia]);
        if b > a {
            let start = below[ib + 1];
            let slope = (b - start) as f64 / (x[b] - x[start]);
            let gap = (a as f64 - start as f64 + 1.0) - (x[a] - x[start]) * slope;
            ia += 1;
            if gap >= widest.gap {
                widest = Widest { gap, below: ib + 1, above: ia - 1 };
            }
        } else {
            let start = above[ia - 1];
            let slope = (a - start) as f64 / (x[a] - x[start]);
            let gap = (x[b] - x[start]) * slope - (b as f64 - start as f64 - 1.0);
            if gap >= widest.gap {
                widest = Widest { gap, below: ib, above: ia };
            }
            ib = ib.saturating_sub(1);
        }
        ia = ia.min(above.len() - 1);
        if below[ib] == above[ia] {
            return widest;
        }
    }
}

/// The largest distance of the function from the line between two of its points, above (sign 1) or below it (-1); at
/// least the step of one value.
fn largest_excess(x: &[f64], from: usize, to: usize, sign: f64) -> f64 {
    if to - from <= 1 || x[to] == x[from] {
        return 1.0;
    }
    let slope = (to - from) as f64 / (x[to] - x[from]);
    (from..=to).map(|i| sign * ((i - from) as f64 - (x[i] - x[from]) * slope) + 1.0).fold(1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look random, from 0 to 1.
    fn numbers(count: usize) -> Vec<f64> {
        let next = |s: &u64| Some((s * 1_103_515_245 + 12_345) % (1 << 31));
        std::iter::successors(next(&1), next).take(count).map(|s| s as f64 / f64::from(1_u32 << 31)).collect()
    }

    fn dip_of(values: impl IntoIterator<Item = f64>) -> f64 {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        dip(&values)
    }

    /// The numbers of the Python package `diptest` 0.12, which wraps the authors' corrected Fortran.
    #[test]
    fn dips_are_those_of_the_published_algorithm() {
        let u = numbers(200);
        let two = u.iter().enumerate().map(|(i, v)| if i % 2 == 1 { 0.3 * v } else { 0.7 + 0.3 * v });
        let third = u.iter().enumerate().map(|(i, v)| if i % 3 > 0 { 0.3 * v } else { 0.6 + 0.4 * v });
        let sums = (0..200).map(|i| u[i] + u[(i * 7 + 3) % 200] + u[(i * 11 + 5) % 200]);
        let found = [
            (dip_of(u.iter().copied()), 0.017_960_737_942_597_84),
            (dip_of(two), 0.147_294_900_178_797_2),
            (dip_of(third), 0.075_777_161_924_928_89),
            (dip_of(u.iter().map(|v| v * v)), 0.015_699_931_933_009_604),
            (dip_of(u.iter().map(|v| (8.0 * v).floor() / 8.0)), 0.075),
            (dip_of(sums), 0.020_200_141_544_587_106),
            (dip_of([0.0, 0.0, 0.0, 1.0, 1.0]), 0.2),
            (dip_of([0.0, 1.0, 5.0]), 1.0 / 6.0),
        ];
        for (i, (dip, expected)) in found.into_iter().enumerate() {
            assert!((dip - expected).abs() < 1e-12, "{i}: {dip} for {expected}");
        }
    }

    #[test]
    fn single_values_have_no_dip_and_two_equal_heaps_have_the_largest() {
        assert_eq!([dip(&[]), dip(&[1.0]), dip(&[2.0; 9])], [0.0; 3]);
        assert_eq!(dip_of((0..100).map(|i| f64::from(i % 2))), 0.25);
    }
}
