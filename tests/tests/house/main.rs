//! The layering and the house rules, checked.

mod architecture;
mod experiment_files;
mod forms;
mod modules;
mod pages;

use std::path::{Path, PathBuf};

/// The project's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").to_path_buf()
}
