//! What tests of several crates share: published data if it is available, fields by specification, temporary folders
//! and results of programs.
//!
//! Only `dev-dependencies` may name this crate. Its functions panic on failure, which fails the test.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

mod data;
mod folder;
mod run;
mod wait;

pub use data::{data_folder, full_run, reference_file, reference_folder, skipped};
pub use folder::Folder;
pub use run::Run;
pub use wait::eventually;

use tigereye_core::{Field, Tensor2};
use tigereye_fields::{generate, parse_spec};

/// The field of a specification such as `inverse:size=51`, which must be valid.
#[must_use]
#[track_caller]
pub fn field(spec: &str) -> Field<Tensor2> {
    let parsed = parse_spec(spec).unwrap_or_else(|e| panic!("{spec}: {e}"));
    generate(&parsed.name, &parsed.arguments).unwrap_or_else(|e| panic!("{spec}: {e}"))
}
