//! What all VTK XML formats share: the element tree, the encodings of arrays and their compression, and
//! their writing.

mod arrays;
mod blocks;
mod compressor;
mod encoding;
mod error;
mod place;
mod sections;
mod tree;
mod writer;

pub(crate) use arrays::{ArrayReader, Content};
pub use error::XmlError;
pub(crate) use sections::{data_set, only_piece, read_arrays, read_field_data, skipped_words};
pub(crate) use tree::{Document, Element};
pub(crate) use writer::{Kind, Writer, spaced};
