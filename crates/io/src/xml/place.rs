//! Where an array stands, for messages.

use super::compressor::Compressor;
use crate::array_error::ArrayError;
use crate::text::shortened;

/// Name and place of an array, for messages.
pub(crate) struct Place {
    pub(super) array: String,
    pub(super) byte: usize,
}

impl Place {
    pub(crate) fn truncated(&self, byte: usize, needed: u128, present: usize) -> ArrayError {
        ArrayError::Truncated { array: self.array.clone(), byte, needed, present }
    }

    pub(crate) fn base64(&self, byte: usize) -> ArrayError {
        ArrayError::Base64 { array: self.array.clone(), byte }
    }

    pub(crate) fn size(&self, byte: usize, found: u128, expected: u128, unit: &'static str) -> ArrayError {
        ArrayError::Size { array: self.array.clone(), byte, found, expected, unit }
    }

    pub(crate) fn block(&self, byte: usize, block: usize, method: Compressor, expected: usize) -> ArrayError {
        let method = if method == Compressor::Lz4 { "LZ4" } else { "zlib" };
        ArrayError::Block { array: self.array.clone(), byte, block, method, expected }
    }

    pub(super) fn number(&self, byte: usize, word: &[u8], scalar: &'static str) -> ArrayError {
        ArrayError::Number { array: self.array.clone(), byte, found: shortened(word), scalar }
    }

    pub(super) fn text(&self, byte: usize) -> ArrayError {
        ArrayError::Text { array: self.array.clone(), byte }
    }

    pub(super) fn unsupported(
        &self,
        attribute: &'static str,
        value: &str,
        expected: &'static str,
    ) -> ArrayError {
        let (array, value) = (self.array.clone(), shortened(value.as_bytes()));
        ArrayError::Unsupported { array, byte: self.byte, attribute, value, expected }
    }
}
