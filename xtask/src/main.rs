//! `cargo xtask`: development tasks that need git or cargo.

mod error;
mod interrupt;
mod review;
mod revision;

use clap::{Parser, Subcommand};
use review::ReviewArgs;
use std::process::ExitCode;

/// Development tasks of the project.
#[derive(Debug, Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    arg_required_else_help = true,
    max_term_width = 100
)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Compares the results of two git revisions, each built and run in a temporary folder.
    Review(ReviewArgs),
}

fn main() -> ExitCode {
    let Task::Review(args) = Cli::parse().task;
    let outcome = interrupt::install(revision::abandon).and_then(|()| review::review(&args));
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(fault) => {
            eprintln!("xtask: {fault}");
            ExitCode::from(fault.exit_code())
        }
    }
}
