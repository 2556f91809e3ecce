//! How blocks of arrays are compressed.

/// How compressed blocks were made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Compressor {
    None,
    Zlib,
    Lz4,
}
