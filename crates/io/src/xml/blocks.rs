//! The payload of a binary array: a size and bytes, or a table of compressed blocks and the blocks.
//!
//! ```text
//! uncompressed   [bytes] data                                     one base64 run
//! compressed     [blocks][block size][last size][size]...  data   two base64 runs
//! ```
//!
//! `last size` is 0 where the last block is full.

use super::compressor::Compressor;
use super::encoding::{Binary, Stream};
use super::place::Place;
use crate::array_error::ArrayError;
use flate2::read::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read as _;

/// Largest expansion that zlib can reach (258 bytes in two bits), rounded up.
const ZLIB_RATIO: u128 = 1040;
/// Largest expansion that an LZ4 block can reach.
const LZ4_RATIO: u128 = 256;

/// How many bytes an array may decode to.
#[derive(Clone, Copy)]
pub(crate) enum Expected {
    Exactly(u128),
    AtMost(u128),
}

impl Expected {
    fn check(self, found: u128, byte: usize, place: &Place) -> Result<(), ArrayError> {
        match self {
            Self::Exactly(expected) if found != expected => Err(place.size(byte, found, expected, "bytes")),
            Self::AtMost(limit) if found > limit => Err(place.size(byte, found, limit, "bytes")),
            _ => Ok(()),
        }
    }
}

/// The decoded bytes of an array, in the file's byte order.
pub(crate) fn payload<'a>(
    mut stream: Stream<'a>,
    binary: &Binary,
    expected: Expected,
    place: &Place,
) -> Result<Cow<'a, [u8]>, ArrayError> {
    let start = stream.byte();
    let first = stream.peek_word(binary, place)?;
    if binary.compressor == Compressor::None {
        expected.check(u128::from(first), start, place)?;
        let whole = stream.take(u128::from(first) + binary.word as u128, place)?;
        return Ok(match whole {
            Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[binary.word..]),
            Cow::Owned(mut bytes) => {
                bytes.drain(..binary.word);
                Cow::Owned(bytes)
            }
        });
    }
    if first == 0 {
        expected.check(0, start, place)?;
        return Ok(Cow::Borrowed(&[]));
    }
    let header = stream.take((u128::from(first) + 3) * binary.word as u128, place)?;
    let table = Table::new(&binary.words(&header), binary.compressor);
    expected.check(table.total, start, place)?;
    table.check(&stream, place)?;
    table.decompress(stream, binary.compressor, place).map(Cow::Owned)
}

/// Sizes of the blocks of one array.
struct Table {
    block: u64,
    last: u64,
    compressed: Vec<u64>,
    total: u128,
    ratio: u128,
}

impl Table {
    fn new(words: &[u64], compressor: Compressor) -> Self {
        let (block, partial) = (words[1], words[2]);
        let last = if partial == 0 { block } else { partial };
        let compressed = words[3..].to_vec();
        let total = (compressed.len() as u128 - 1) * u128::from(block) + u128::from(last);
        let ratio = if compressor == Compressor::Lz4 { LZ4_RATIO } else { ZLIB_RATIO };
        Self { block, last, compressed, total, ratio }
    }

    fn size(&self, index: usize) -> u64 {
        if index + 1 == self.compressed.len() { self.last } else { self.block }
    }

    /// Compares the declared sizes with what is there and with what compression can reach.
    fn check(&self, stream: &Stream, place: &Place) -> Result<(), ArrayError> {
        let needed: u128 = self.compressed.iter().map(|&c| u128::from(c)).sum();
        if needed > stream.encoded_left() as u128 {
            return Err(place.truncated(stream.byte(), needed, stream.encoded_left()));
        }
        for (i, &c) in self.compressed.iter().enumerate() {
            let most = (u128::from(c) + 1) * self.ratio;
            let size = u128::from(self.size(i));
            if size > most {
                return Err(place.size(stream.byte(), size, most, "bytes in one block, at most"));
            }
        }
        Ok(())
    }

    fn decompress(
        &self,
        mut stream: Stream,
        method: Compressor,
        place: &Place,
    ) -> Result<Vec<u8>, ArrayError> {
        let start = stream.byte();
        let needed: u128 = self.compressed.iter().map(|&c| u128::from(c)).sum();
        let raw = stream.take(needed, place)?;
        let in_place = matches!(raw, Cow::Borrowed(_));
        let (mut rest, mut bytes) = (&raw[..], Vec::new());
        for (i, &compressed) in self.compressed.iter().enumerate() {
            // Sums and sizes were compared with the bytes there.
            let (block, behind) = rest.split_at(compressed as usize);
            let offset = if in_place { raw.len() - rest.len() } else { 0 };
            let size = self.size(i) as usize;
            let done = match method {
                Compressor::Lz4 => lz4_block(block, size, &mut bytes),
                _ => zlib_block(block, size, &mut bytes),
            };
            if !done {
                return Err(place.block(start + offset, i, method, size));
            }
            rest = behind;
        }
        Ok(bytes)
    }
}

/// Appends a block of `size` bytes; the output grows with what the stream yields.
fn zlib_block(block: &[u8], size: usize, bytes: &mut Vec<u8>) -> bool {
    let before = bytes.len();
    let mut limited = ZlibDecoder::new(block).take(size as u64 + 1);
    limited.read_to_end(bytes).is_ok() && bytes.len() - before == size
}

fn lz4_block(block: &[u8], size: usize, bytes: &mut Vec<u8>) -> bool {
    let before = bytes.len();
    bytes.resize(before + size, 0);
    lz4_flex::block::decompress_into(block, &mut bytes[before..]).is_ok_and(|n| n == size)
}
