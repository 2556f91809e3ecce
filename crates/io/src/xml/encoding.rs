//! Where the bytes of an array come from: raw, or base64 in runs that each end on their own padding.

use super::compressor::Compressor;
use super::place::Place;
use crate::ByteOrder;
use crate::array_error::ArrayError;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;

/// What the root element says about all binary arrays of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binary {
    pub(crate) order: ByteOrder,
    /// Bytes of one header number: 4 or 8.
    pub(crate) word: usize,
    pub(crate) compressor: Compressor,
}

impl Binary {
    /// The header numbers in `bytes`.
    pub(crate) fn words(&self, bytes: &[u8]) -> Vec<u64> {
        let number = |b: &[u8]| {
            let fold = |n: u64, b: &u8| n << 8 | u64::from(*b);
            match self.order {
                ByteOrder::Little => b.iter().rev().fold(0, fold),
                ByteOrder::Big => b.iter().fold(0, fold),
            }
        };
        bytes.chunks_exact(self.word).map(number).collect()
    }
}

/// The bytes of an array, taken from the front.
pub(crate) struct Stream<'a> {
    /// What is left, encoded.
    rest: &'a [u8],
    /// Offset in the file of the first byte left.
    byte: usize,
    base64: bool,
}

impl<'a> Stream<'a> {
    pub(crate) fn new(rest: &'a [u8], byte: usize, base64: bool) -> Self {
        Self { rest, byte, base64 }
    }

    /// Offset in the file.
    pub(crate) fn byte(&self) -> usize {
        self.byte
    }

    /// Encoded bytes left.
    pub(crate) fn encoded_left(&self) -> usize {
        self.rest.len()
    }

    /// The next `count` bytes. In base64 they form one run, padded at its end; a run may be continued by another
    /// call if `count` is a multiple of 3.
    pub(crate) fn take(&mut self, count: u128, place: &Place) -> Result<Cow<'a, [u8]>, ArrayError> {
        let encoded = if self.base64 { count.div_ceil(3).saturating_mul(4) } else { count };
        let length = match usize::try_from(encoded) {
            Ok(length) if length <= self.rest.len() => length,
            _ => return Err(place.truncated(self.byte, encoded, self.rest.len())),
        };
        let (head, rest) = self.rest.split_at(length);
        let byte = self.byte;
        (self.rest, self.byte) = (rest, byte + length);
        if !self.base64 {
            return Ok(Cow::Borrowed(head));
        }
        let decoded = STANDARD.decode(head).map_err(|e| place.base64(byte + invalid_offset(&e)))?;
        // Between count and count+2 bytes: padding decides.
        if decoded.len() as u128 == count {
            Ok(Cow::Owned(decoded))
        } else {
            Err(place.base64(byte + length.saturating_sub(1)))
        }
    }

    /// The first header number, without moving on.
    pub(crate) fn peek_word(&self, binary: &Binary, place: &Place) -> Result<u64, ArrayError> {
        let word = binary.word;
        let length = if self.base64 { 4 * word.div_ceil(3) } else { word };
        let Some(head) = self.rest.get(..length) else {
            return Err(place.truncated(self.byte, length as u128, self.rest.len()));
        };
        let decoded;
        let bytes = if self.base64 {
            // Further bytes of the run may share the last group.
            decoded = STANDARD.decode(head).map_err(|e| place.base64(self.byte + invalid_offset(&e)))?;
            decoded.get(..word).ok_or_else(|| place.base64(self.byte))?
        } else {
            head
        };
        Ok(binary.words(bytes).first().copied().unwrap_or_default())
    }
}

fn invalid_offset(error: &base64::DecodeError) -> usize {
    match error {
        base64::DecodeError::InvalidByte(at, _) => *at,
        base64::DecodeError::InvalidLastSymbol { offset, .. } => *offset,
        _ => 0,
    }
}
