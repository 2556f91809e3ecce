//! The gradient of the linear scheme, in which every photon goes its own way.
//!
//! Light superposes, so all pulses of a cell are combinations of the responses to its eight lobes: the exact gradient
//! ([`linear_sweep_part`]) needs eight solutions a cell instead of S. And the L1 norms of the gradient can be estimated
//! from the answers of the whole field to random receivers ([`SketchedGradient`]): some hundred solutions in all.

mod estimate;
mod exact;
mod limits;
mod logarithms;
mod pool;
mod pulses;
mod random;
mod sketch;

pub use estimate::{Estimate, SketchShape, SketchSums};
pub use exact::{check_linear_fit, linear_needs, linear_sweep_part};
pub use limits::{FEWEST_SKETCHES, MOST_SKETCHES};
pub use sketch::{SketchObserver, SketchSettings, SketchedGradient};
