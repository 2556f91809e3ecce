//! What is wrong with arrays of NumPy.

use thiserror::Error;

/// What is wrong with a `.npy` file or a `.npz` archive.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NpyError {
    /// A header that is not that of a `.npy` file.
    #[error("byte {byte}: expected {expected} in the .npy header")]
    Header {
        /// Where it went wrong.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// An element type that is not read.
    #[error("byte {byte}: element type `{descr}` is not read: expected f4, f8, i1 to i8 or u1 to u8")]
    Type {
        /// Where the type is declared.
        byte: usize,
        /// The type as written.
        descr: String,
    },
    /// A header and data of different sizes.
    #[error(
        "byte {byte}: the header declares {declared} bytes of data, expected the {present} that are there"
    )]
    Size {
        /// First byte of the data.
        byte: usize,
        /// Bytes that the shape needs.
        declared: u128,
        /// Bytes behind the header.
        present: usize,
    },
    /// An array of another shape than wanted.
    #[error("an array of shape {shape:?}: expected {expected}")]
    Shape {
        /// Shape as read.
        shape: Vec<usize>,
        /// What was wanted.
        expected: &'static str,
    },
    /// An array whose first axis, or first two, are the components.
    #[error(
        "an array of shape {shape:?}, which could have its components first: expected them last, as numpy.moveaxis(array, 0, -1) puts them"
    )]
    ComponentsFirst {
        /// Shape as read.
        shape: Vec<usize>,
    },
    /// A `.npz` archive that cannot be read, or without the array asked for.
    #[error("{problem}: expected {expected}")]
    Archive {
        /// What is wrong, with the arrays that are there.
        problem: String,
        /// What should be there.
        expected: &'static str,
    },
    /// Positions in an archive that are no lattice.
    #[error(
        "the positions `{names}` form no lattice with equal steps (position {position}, from 0): expected them in equal steps, or an archive without them"
    )]
    Positions {
        /// Names of the arrays.
        names: String,
        /// The first position that is off.
        position: usize,
    },
}
