//! Division of a sweep among several machines.

use crate::LtgError;
use std::fmt;
use std::ops::Range;

/// One of `count` nearly equal pieces of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Piece `index`, from 0, of `count`.
    ///
    /// # Errors
    /// [`LtgError::Shard`] unless `index < count`.
    pub const fn new(index: usize, count: usize) -> Result<Self, LtgError> {
        if index < count { Ok(Self { index, count }) } else { Err(LtgError::Shard { index, count }) }
    }
    /// Index of the piece, from 0.
    #[must_use]
    pub const fn index(self) -> usize {
        self.index
    }
    /// Number of pieces.
    #[must_use]
    pub const fn count(self) -> usize {
        self.count
    }
    /// Its part of `0..total`; the parts of all shards are consecutive and cover everything.
    #[must_use]
    pub fn range(self, total: usize) -> Range<usize> {
        // The quotient is at most `total`; only the product needs more bits.
        let cut = |i: usize| (total as u128 * i as u128 / self.count as u128) as usize;
        cut(self.index)..cut(self.index + 1)
    }

    /// The index of the shard, out of `count` shards of `0..total`, that contains `i`.
    pub(crate) const fn holding(i: usize, total: usize, count: usize) -> usize {
        (((i as u128 + 1) * count as u128 - 1) / total as u128) as usize
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_everything_once_and_nearly_equally() {
        for total in [0, 1, 7, 100, 1 << 40] {
            for count in [1, 2, 3, 7, 64, 1000] {
                let mut end = 0;
                for index in 0..count {
                    let range = Shard::new(index, count).expect("a shard").range(total);
                    assert_eq!(range.start, end);
                    assert!(range.len().abs_diff(total / count) <= 1);
                    if !range.is_empty() {
                        assert_eq!(Shard::holding(range.start, total, count), index);
                        assert_eq!(Shard::holding(range.end - 1, total, count), index);
                    }
                    end = range.end;
                }
                assert_eq!(end, total);
            }
        }
    }

    #[test]
    fn impossible_shards_are_refused() {
        assert_eq!(Shard::new(3, 3), Err(LtgError::Shard { index: 3, count: 3 }));
        assert_eq!(Shard::new(0, 0), Err(LtgError::Shard { index: 0, count: 0 }));
    }
}
