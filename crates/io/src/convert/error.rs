//! What is wrong with the choice of an array.

use thiserror::Error;

/// What is wrong with the choice of an array, or with what is in it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ChoiceError {
    /// No array of the wanted name or kind.
    #[error("no {wanted}: the arrays are {}", listed(available))]
    NoArray {
        /// What was looked for.
        wanted: String,
        /// Names and components of the arrays there are.
        available: Vec<String>,
    },
    /// Several arrays fit and none is marked as active.
    #[error("several arrays fit: {}: expected the name of one", listed(candidates))]
    Ambiguous {
        /// Names and components of the arrays that fit.
        candidates: Vec<String>,
    },
    /// Slice indices that do not fit a volume.
    #[error(
        "field data `slices` holds {found:?}: expected {expected} ascending sample indices below {limit}"
    )]
    Slices {
        /// The numbers found (at most eight).
        found: Vec<f64>,
        /// Number of layers of the volume.
        expected: usize,
        /// Indices must be smaller.
        limit: usize,
    },
}

fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
