//! What experiments leave, as a page and a summary, and what changed between two of them.
//!
//! An [`ExperimentOutcome`] holds pictures, tables and judged checks; [`page`] makes one HTML page of all of them,
//! [`summary_json`] the same for programs, and [`review`] compares two summaries or snapshots. Nothing here knows
//! tensors.

mod links;
mod numbers;
mod outcome;
pub mod page;
pub mod review;
mod summary;

pub use numbers::shortened;
pub use outcome::{CheckOutcome, Column, DataFile, Expected, ExperimentOutcome, Figure, Table};
pub use page::{About, html};
pub use summary::summary_json;
