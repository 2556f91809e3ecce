//! The light transport gradient: how much the light of a pulse changes when the pulse moves or turns.
//!
//! For a pulse at (x, y) in sample t let `b(x, y, t)` be the light it leaves everywhere. The gradient is `sqrt(g_x^2 +
//! g_y^2 + g_w^2)` with `g_x = 1/2 sum |b(x+1, y, t) - b(x-1, y, t)|` over all cells and samples, and likewise in y and
//! in the direction (eqs. 3.17 to 3.20). It is an L1 distance of light distributions, not an exponent as the FTLE is;
//! divide by the source spacing to compare resolutions.
//!
//! Every pulse is compared with all its partners while it is in memory. What is finished is a [`PartialVolume`]: a
//! sweep can stop anywhere and resume there, and its shards can be computed separately and merged. This crate neither
//! draws nor parses nor reads clocks.

/// Version of the bits of a gradient: increased with every change that moves them. A sweep must not resume work of
/// another version.
pub const NUMERICS: u32 = 2;

mod error;
mod linear;
mod observer;
mod partial;
mod pass;
mod plan;
mod ring;
mod row;
mod sets;
mod settings;
mod shard;
mod sweep;

pub use error::LtgError;
pub use linear::{
    Estimate, FEWEST_SKETCHES, MOST_SKETCHES, SketchObserver, SketchSettings, SketchShape, SketchSums,
    SketchedGradient, check_linear_fit, linear_needs, linear_sweep_part,
};
pub use observer::{Phase, SweepObserver};
pub use partial::{Finished, LtgOutcome, PartialVolume};
pub use settings::{LtgSettings, Precision, omega_step_of_slices, omega_step_of_volumes};
pub use shard::Shard;
pub use sweep::{Needs, check_fit, needs, sweep, sweep_part};
