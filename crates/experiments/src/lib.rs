//! Experiment files, their evaluation, checks and report.
//!
//! One `.ron` file is one experiment: it names fields, propagations and gradients, the figures to draw of them and the
//! checks they must pass. [`spec`] (what may stand in a file) is resolved to [`settings`] (ranges checked, names looked
//! up, nothing optional left), run, and reported. This crate opens no files and reads no clocks: the program hands it
//! both through [`Host`].

pub mod classical;
mod comparison;
mod digest;
mod draw;
mod evaluate;
pub mod field_file;
mod host;
pub mod input;
pub mod library;
pub mod lint;
mod measure;
mod medium;
mod outcome;
mod places;
pub mod provenance;
mod pulses;
mod reel;
pub mod report;
pub mod review;
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
pub use outcome::{CheckOutcome, Column, DataFile, Expected, ExperimentOutcome, Figure, Table};
pub use reel::Reel;
pub use runs::RunError;

/// A message with its middle left out where somebody's input makes it longer than people read.
#[must_use]
pub fn shortened(message: &str) -> String {
    const HEAD: usize = 500;
    const TAIL: usize = 300;
    let count = message.chars().count();
    if count <= HEAD + TAIL {
        return message.to_owned();
    }
    let head: String = message.chars().take(HEAD).collect();
    let tail: String = message.chars().skip(count - TAIL).collect();
    format!("{head} [... {} characters ...] {tail}", count - HEAD - TAIL)
}
