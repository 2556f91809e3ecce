//! What is wrong with the numbers of one array.

use thiserror::Error;

/// What is wrong with an array of a VTK file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ArrayError {
    /// An array in an encoding or of a type that is not read.
    #[error("byte {byte}: array `{array}` is not read: {attribute}=\"{value}\", expected {expected}")]
    Unsupported {
        /// Name of the array.
        array: String,
        /// Where the array is declared.
        byte: usize,
        /// Attribute that says so.
        attribute: &'static str,
        /// Its value, shortened.
        value: String,
        /// Values that are read.
        expected: &'static str,
    },
    /// An array with another amount of data than its declaration.
    #[error("byte {byte}: array `{array}` holds {found} {unit}, expected {expected}")]
    Size {
        /// Name of the array.
        array: String,
        /// Where its data start.
        byte: usize,
        /// Amount in the file.
        found: u128,
        /// Amount declared.
        expected: u128,
        /// What is counted.
        unit: &'static str,
    },
    /// An array whose data end too early.
    #[error("byte {byte}: array `{array}` is truncated: expected {needed} more bytes, found {present}")]
    Truncated {
        /// Name of the array.
        array: String,
        /// From where the bytes are missing.
        byte: usize,
        /// Bytes needed from there.
        needed: u128,
        /// Bytes there.
        present: usize,
    },
    /// An array in text that holds something else than numbers of its type.
    #[error("byte {byte}: array `{array}`: expected a {scalar} number, found `{found}`")]
    Number {
        /// Name of the array.
        array: String,
        /// Where the word starts.
        byte: usize,
        /// The word, shortened.
        found: String,
        /// Type of the array.
        scalar: &'static str,
    },
    /// Base64 text with an invalid character or length.
    #[error("byte {byte}: array `{array}`: expected valid base64")]
    Base64 {
        /// Name of the array.
        array: String,
        /// Where.
        byte: usize,
    },
    /// A compressed block that does not decompress to its declared size.
    #[error("byte {byte}: array `{array}`: block {block} is not {method} data of {expected} bytes")]
    Block {
        /// Name of the array.
        array: String,
        /// Where the block (in base64: the array's blocks) starts.
        byte: usize,
        /// Index of the block.
        block: usize,
        /// Compression method.
        method: &'static str,
        /// Bytes it should decompress to.
        expected: usize,
    },
    /// Text that is not valid UTF-8 or does not end.
    #[error("byte {byte}: array `{array}`: expected strings in UTF-8, each ended by a zero byte")]
    Text {
        /// Name of the array.
        array: String,
        /// Where its data start.
        byte: usize,
    },
    /// An array without components.
    #[error("array `{array}` has {components} components: expected at least one")]
    Components {
        /// Name of the array.
        array: String,
        /// Its components.
        components: usize,
    },
}
