//! Memory that begins where a cache line does, so that whole vectors never straddle two lines.

use tigereye_simd::Number;

const LINE_BYTES: usize = 64;

/// Numbers, 0 at first.
#[derive(Debug)]
pub(crate) struct Aligned<T> {
    values: Vec<T>,
    start: usize,
    length: usize,
}

impl<T: Number> Aligned<T> {
    pub(crate) fn zeros(length: usize) -> Self {
        let spare = LINE_BYTES / size_of::<T>();
        let values = vec![T::default(); length + spare];
        // Where alignment is unknown the numbers are the same, only slower to reach.
        let start = values.as_ptr().align_offset(LINE_BYTES).min(spare);
        Self { values, start, length }
    }
    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[T] {
        &self.values[self.start..self.start + self.length]
    }
    #[inline(always)]
    pub(crate) fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values[self.start..self.start + self.length]
    }
}

impl<T: Number> Clone for Aligned<T> {
    fn clone(&self) -> Self {
        let mut copy = Self::zeros(self.length);
        copy.as_mut_slice().copy_from_slice(self.as_slice());
        copy
    }
}
