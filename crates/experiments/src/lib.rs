//! Experiment files, their evaluation and their checks.
//!
//! One `.ron` file is one experiment: it names fields, propagations and gradients, the figures to draw of them and the
//! checks they must pass.
//!
//! ```text
//! text --load--> Experiment --plan--> Plan --evaluate--> ExperimentOutcome (for the report)
//!               (what stands         (ids, parsed       and Digest (for snapshots)
//!                in the file)         expressions)
//! ```
//!
//! [`runs`], [`panels`], [`quantities`] and [`tables`]
//! have a file for each kind. This crate opens no files and reads no clocks: the program hands it both through
//! [`Host`].

mod digest;
mod error;
mod evaluate;
pub mod experiment;
mod fault;
pub mod field_file;
mod figures;
pub mod form;
mod host;
mod ids;
pub mod library;
pub mod lights;
mod load;
mod media;
mod medium;
mod names;
pub mod numerics;
pub mod panels;
mod parse;
mod plan;
pub mod quantities;
mod results;
pub mod runs;
pub mod scalars;
pub mod scene;
pub mod sheet;
pub mod sources;
mod style;
pub mod tables;
mod unavailable;

pub use digest::Digest;
pub use error::ExperimentError;
pub use evaluate::{Evaluation, evaluate};
pub use experiment::Experiment;
pub use fault::{SourceFault, SpecError};
pub use form::Scope;
pub use host::Host;
pub use load::load;
pub use medium::Medium;
pub use plan::{Plan, plan, slug_of};
pub use runs::RunError;
pub use style::style_of_file;
pub use unavailable::Unavailable;
