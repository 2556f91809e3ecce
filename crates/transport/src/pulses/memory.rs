//! The history of Anderson mixing.

use tigereye_simd::Number;

/// Number of remembered changes.
pub(super) const DEPTH: usize = 3;
/// A change larger than this multiple of the smallest one so far clears the history.
const GROWTH: f64 = 4.0;
/// A remembered change is not used if its part independent of newer ones is below this fraction of its squared norm.
const DEPENDENT: f64 = 1e-12;

/// One number for each lane.
pub(super) type Lanes<T, const N: usize> = [T; N];

/// The states of earlier mixings.
#[derive(Debug)]
pub(crate) struct Memory<T, const N: usize> {
    /// Unmixed halves of the state, newest first, with one spare for the next.
    pub(super) halves: [Vec<[Lanes<T, N>; 4]>; DEPTH + 1],
    /// Differences of consecutive changes of the samples, newest first.
    pub(super) differences: [Vec<Lanes<T, N>>; DEPTH],
    /// Samples before the sweeps, their change by these sweeps, and by the previous ones.
    pub(super) before: Vec<Lanes<T, N>>,
    pub(super) change: Vec<Lanes<T, N>>,
    pub(super) last_change: Vec<Lanes<T, N>>,
    /// Number of consecutive changes usable by each lane.
    pub(super) remembered: [usize; N],
    /// The smallest change of the samples so far.
    pub(super) smallest: [f64; N],
}

/// The weight of each remembered difference, newest first.
pub(super) type Weights<T, const N: usize> = [Lanes<T, N>; DEPTH];

impl<T: Number, const N: usize> Memory<T, N> {
    /// Its size in numbers.
    pub(crate) const fn numbers(cells: usize) -> usize {
        cells * N * (4 * (DEPTH + 1) + DEPTH + 3)
    }

    pub(crate) fn new(cells: usize) -> Self {
        let lanes = || vec![[T::default(); N]; cells];
        Self {
            halves: std::array::from_fn(|_| vec![[[T::default(); N]; 4]; cells]),
            differences: std::array::from_fn(|_| lanes()),
            before: lanes(),
            change: lanes(),
            last_change: lanes(),
            remembered: [0; N],
            smallest: [f64::INFINITY; N],
        }
    }

    /// Clears the history. Weights of 0 would not suffice, since 0 times NaN is NaN.
    pub(crate) fn clear(&mut self) {
        self.halves.iter_mut().for_each(|half| half.fill([[T::default(); N]; 4]));
        self.remembered = [0; N];
        self.smallest = [f64::INFINITY; N];
    }

    /// Replaces the samples after the sweeps by their change; returns the sums of the samples and of the absolute
    /// changes.
    #[inline(always)]
    pub(super) fn compare(&mut self) -> ([f64; N], [f64; N]) {
        let (mut lit, mut changed) = ([0.0; N], [0.0; N]);
        for (change, before) in self.change.iter_mut().zip(&self.before) {
            for l in 0..N {
                lit[l] += change[l].widened();
                change[l] = change[l] - before[l];
                changed[l] += change[l].abs().widened();
            }
        }
        (lit, changed)
    }

    /// The weights of the remembered differences that minimise the newest change, which is added to the history.
    #[inline(always)]
    pub(super) fn weigh(&mut self, changed: &[f64; N]) -> Weights<T, N> {
        self.differences.rotate_right(1);
        for (difference, (now, before)) in
            self.differences[0].iter_mut().zip(self.change.iter().zip(&self.last_change))
        {
            for l in 0..N {
                difference[l] = now[l] - before[l];
            }
        }
        // Sums of products of the differences with each other and with the change, separately for each lane.
        let mut products = [[[0.0; N]; DEPTH + 1]; DEPTH];
        for (i, change) in self.change.iter().enumerate() {
            for c in 0..DEPTH {
                let d = &self.differences[c][i];
                for r in c..DEPTH {
                    let e = &self.differences[r][i];
                    for l in 0..N {
                        products[c][r][l] += d[l].widened() * e[l].widened();
                    }
                }
                for l in 0..N {
                    products[c][DEPTH][l] += d[l].widened() * change[l].widened();
                }
            }
        }
        core::mem::swap(&mut self.change, &mut self.last_change);
        let mut weights = [[T::default(); N]; DEPTH];
        for l in 0..N {
            if changed[l] > GROWTH * self.smallest[l] {
                (self.remembered[l], self.smallest[l]) = (0, f64::INFINITY);
            }
            self.smallest[l] = self.smallest[l].min(changed[l]);
            let of_lane = products.map(|row| row.map(|p| p[l]));
            let found = least_squares(of_lane, self.remembered[l].min(DEPTH));
            self.remembered[l] += 1;
            for (weight, found) in weights.iter_mut().zip(found) {
                weight[l] = T::narrowed(found);
            }
        }
        weights
    }
}

/// Solves the normal equations of the first `n` unknowns, given their upper triangle and right-hand side. Unknowns that
/// depend on previous ones are 0; all are 0 if they are not finite.
fn least_squares(mut m: [[f64; DEPTH + 1]; DEPTH], n: usize) -> [f64; DEPTH] {
    let norms: [f64; DEPTH] = std::array::from_fn(|c| m[c][c]);
    for r in 0..DEPTH {
        for c in 0..r {
            m[r][c] = m[c][r];
        }
    }
    let mut used = [false; DEPTH];
    for c in 0..n {
        used[c] = norms[c] > 0.0 && m[c][c] > DEPENDENT * norms[c];
        if used[c] {
            for r in c + 1..n {
                let q = m[r][c] / m[c][c];
                for j in c + 1..=DEPTH {
                    m[r][j] -= q * m[c][j];
                }
            }
        }
    }
    let mut weights = [0.0; DEPTH];
    for c in (0..n).rev().filter(|&c| used[c]) {
        let known: f64 = (c + 1..n).map(|j| m[c][j] * weights[j]).sum();
        weights[c] = (m[c][DEPTH] - known) / m[c][c];
    }
    if weights.iter().all(|w| w.is_finite()) { weights } else { [0.0; DEPTH] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_solve_and_leave_out_what_depends() {
        // Differences (1, 0, 1), (0, 2, 0) and their sum; change 3 (1, 0, 1) - (0, 2, 0).
        let m = [[2.0, 0.0, 2.0, 6.0], [0.0, 4.0, 4.0, -4.0], [0.0, 0.0, 6.0, 2.0]];
        assert_eq!(least_squares(m, 3), [3.0, -1.0, 0.0]);
        assert_eq!(least_squares(m, 1), [3.0, 0.0, 0.0]);
        assert_eq!(least_squares(m, 0), [0.0; 3]);
        assert_eq!(least_squares([[0.0; 4]; 3], 3), [0.0; 3]);
        assert_eq!(least_squares([[f64::NAN; 4]; 3], 3), [0.0; 3]);
    }
}
