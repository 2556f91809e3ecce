//! Experiment files, their evaluation, checks and report.
//!
//! One `.ron` file is one experiment: it names fields, propagations and gradients, the figures to draw of them and the
//! checks they must pass. `spec` (what may stand in a file) is resolved to `settings` (ranges checked, nothing
//! optional left), run, and reported. This crate opens no files and reads no clocks: the program hands it both.

mod outcome;
pub mod report;

pub use outcome::{CheckOutcome, DataFile, Expected, ExperimentOutcome, Figure};
