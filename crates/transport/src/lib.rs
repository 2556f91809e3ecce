//! The light propagation scheme: how light in one cell is passed on to its eight neighbours, step by step.
//!
//! [`SampleSpace`] computes it as the thesis writes it, on whole angular profiles; [`EightLobe`] computes the same
//! numbers from eight fluxes a cell. Both are [`Engine`]s. This crate knows nothing of gradients, files or pictures.

mod aligned;
mod engine;
mod error;
mod kernel;
mod light;
mod limits;
mod linear;
mod oracle;
mod pulses;
mod real;
mod reduced;
mod scattering;
mod scheme;
mod sectors;
mod stopping;
mod tolerances;
mod window;

pub use engine::{Engine, Observer, Outcome, Problem, StepView};
pub use error::TransportError;
pub use light::{Emission, Light, check_lights, emitter};
pub use limits::{Traffic, arithmetic};
pub use linear::{
    Combination, Dissection, Lanes, LinearScattering, Operator, Parallel, Serial, Settled, Watch, Workspace,
    importance, l1_norms, stationary, stationary_light,
};
pub use oracle::SampleSpace;
pub use pulses::{LaneOutcome, PulseDistribution, PulseSolver, l1_difference};
pub use real::Real;
pub use reduced::EightLobe;
pub use scattering::Scattering;
pub use scheme::{
    ScatteringRule, Scheme, SharedWeights, half_angle_beta_rad, half_core_alpha_rad, sector_lobes,
};
pub use stopping::{StopMeasure, Stopping, StoppingRule};
pub use tigereye_simd::{ArrayLoop, Level};

/// Every engine, the oracle first. Laws of propagations are tested for each of them, and experiment files choose them
/// by [`Engine::id`].
pub const ENGINES: &[&(dyn Engine + Sync)] = &[&SampleSpace, &EightLobe];
