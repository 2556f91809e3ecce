//! Where an array stands, for messages.

use super::compressor::Compressor;
use crate::IoError;
use crate::error::shortened;

/// Name and place of an array, for messages.
pub(crate) struct Place {
    pub(super) array: String,
    pub(super) byte: usize,
}

impl Place {
    pub(crate) fn truncated(&self, byte: usize, needed: u128, present: usize) -> IoError {
        IoError::ArrayTruncated { array: self.array.clone(), byte, needed, present }
    }

    pub(crate) fn base64(&self, byte: usize) -> IoError {
        IoError::ArrayBase64 { array: self.array.clone(), byte }
    }

    pub(crate) fn size(&self, byte: usize, found: u128, expected: u128, unit: &'static str) -> IoError {
        IoError::ArraySize { array: self.array.clone(), byte, found, expected, unit }
    }

    pub(crate) fn block(&self, byte: usize, block: usize, method: Compressor, expected: usize) -> IoError {
        let method = if method == Compressor::Lz4 { "LZ4" } else { "zlib" };
        IoError::ArrayBlock { array: self.array.clone(), byte, block, method, expected }
    }

    pub(super) fn number(&self, byte: usize, word: &[u8], scalar: &'static str) -> IoError {
        IoError::ArrayNumber { array: self.array.clone(), byte, found: shortened(word), scalar }
    }

    pub(super) fn text(&self, byte: usize) -> IoError {
        IoError::ArrayText { array: self.array.clone(), byte }
    }

    pub(super) fn unsupported(
        &self,
        attribute: &'static str,
        value: &str,
        expected: &'static str,
    ) -> IoError {
        let (array, value) = (self.array.clone(), shortened(value.as_bytes()));
        IoError::ArrayUnsupported { array, byte: self.byte, attribute, value, expected }
    }
}
