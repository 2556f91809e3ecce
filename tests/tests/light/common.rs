//! Directions, schemes and transmissions with fewer words.

use tigereye_core::{Directions, Field, Normalization, Tensor2, TransmissionField};
use tigereye_transport::{Scheme, SharedWeights};

/// `samples` directions.
pub(crate) fn directions(samples: usize) -> Directions {
    Directions::new(samples).expect("a multiple of 8")
}

/// The published scheme.
pub(crate) fn scheme(samples: usize) -> Scheme {
    Scheme::new(directions(samples), SharedWeights::Thesis)
}

/// The transmission of a tensor field.
pub(crate) fn transmission(
    tensors: &Field<Tensor2>,
    samples: usize,
    normalization: Normalization,
) -> TransmissionField {
    TransmissionField::from_tensors(tensors, directions(samples), normalization).expect("finite tensors")
}
