//! What all VTK XML formats share: the element tree, the encodings of arrays and their compression.

mod arrays;
mod blocks;
mod encoding;
mod tree;

pub(crate) use arrays::{ArrayReader, Content};
pub(crate) use tree::{Document, Element};
