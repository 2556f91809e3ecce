//! Experiment files, their evaluation, checks and report.
//!
//! One `.ron` file is one experiment: it names fields, propagations and gradients, the figures to draw of them and the
//! checks they must pass. [`spec`] (what may stand in a file) is resolved to [`settings`] (ranges checked, names looked
//! up, nothing optional left), run, and reported. This crate opens no files and reads no clocks: the program hands it
//! both through [`Host`].

mod comparison;
mod digest;
mod draw;
mod evaluate;
pub mod field_file;
mod host;
pub mod library;
mod measure;
mod medium;
mod places;
mod pulses;
mod reel;
mod runs;
pub mod scene;
pub mod settings;
pub mod sheet;
pub mod spec;
mod tables;
mod uses;
mod ways;

pub use digest::Digest;
pub use evaluate::{Evaluation, ExperimentError, evaluate, normalization_name};
pub use host::Host;
pub use medium::Medium;
pub use reel::Reel;
pub use runs::RunError;
