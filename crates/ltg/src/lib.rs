//! The light transport gradient: how much the light of a pulse changes when the pulse moves or turns.
//!
//! For a pulse at (x, y) in sample t let `b(x, y, t)` be the light it leaves everywhere. The gradient is
//! `sqrt(g_x^2 + g_y^2 + g_w^2)` with `g_x = 1/2 sum |b(x+1, y, t) - b(x-1, y, t)|` over all cells and samples, and likewise in
//! y and in the direction (eqs. 3.17 to 3.20). It is an L1 distance of light distributions, not an exponent as the FTLE is;
//! divide by the source spacing to compare resolutions.
//!
//! Every pulse is solved once and compared with all its partners while it is in memory. This crate neither draws nor
//! parses nor reads clocks.

mod error;
mod plan;
mod settings;
mod sweep;

pub use error::LtgError;
pub use settings::{LtgSettings, omega_step_of_slices, omega_step_of_volumes};
pub use sweep::{LtgOutcome, Phase, SweepObserver, check_fit, sweep};
