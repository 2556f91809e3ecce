//! What is wrong with the XML of a VTK file.

use thiserror::Error;

/// What is wrong with the XML of a VTK file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum XmlError {
    /// Text that is not well-formed XML.
    #[error("byte {byte}: not well-formed XML: {problem}")]
    Syntax {
        /// Where.
        byte: usize,
        /// What the XML parser says.
        problem: String,
    },
    /// XML that is not what VTK files hold, or beyond the limits on nesting and lengths.
    #[error("byte {byte}: expected {expected}")]
    Structure {
        /// Where.
        byte: usize,
        /// What should have been there.
        expected: &'static str,
    },
    /// An element where another is expected.
    #[error("byte {byte}: found element <{element}>, expected {expected}")]
    Element {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// What is expected in its place.
        expected: &'static str,
    },
    /// An element that is missing.
    #[error("byte {byte}: element <{parent}> holds no <{element}>")]
    MissingElement {
        /// Where the parent starts.
        byte: usize,
        /// Name of the parent.
        parent: String,
        /// Name of the missing child.
        element: &'static str,
    },
    /// An attribute that is missing.
    #[error("byte {byte}: element <{element}> has no attribute {attribute}: expected {expected}")]
    MissingAttribute {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// Name of the attribute.
        attribute: &'static str,
        /// What its value should be.
        expected: &'static str,
    },
    /// An attribute with a value that makes no sense.
    #[error("byte {byte}: {attribute}=\"{value}\" of element <{element}>: expected {expected}")]
    Attribute {
        /// Where the element starts.
        byte: usize,
        /// Its name.
        element: String,
        /// Name of the attribute.
        attribute: String,
        /// Its value, shortened.
        value: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A data set in several pieces.
    #[error("byte {byte}: {pieces} <Piece> elements: expected one (merge the pieces first)")]
    Pieces {
        /// Where the second piece, or the data set without any, starts.
        byte: usize,
        /// Number of pieces.
        pieces: usize,
    },
}
