//! The `tigereye` program: light through 2D tensor fields.
//!
//! The only place that opens files, reads clocks, owns threads and talks to people. Numbers come from the crates below.

mod args;
mod checkpoint;
mod commands;
mod error;
mod files;
mod geometry;
mod host;
mod input;
mod interrupt;
mod medium;
mod part_file;
mod pieces;
mod results_folder;
mod system;
mod watch;

use args::fields::FieldCommand;
use args::{Cli, Command};
use clap::Parser;
use error::CliError;
use std::process::ExitCode;

fn main() -> ExitCode {
    // clap prints usage errors itself, to standard error, and exits with 2.
    let cli = Cli::parse();
    if let Err(error) = interrupt::install(files::abandon) {
        return report(&error);
    }
    // An unknown instruction set is reported before anything runs, not ignored.
    match system::level().and_then(|_| dispatch(cli)) {
        Ok(code) => ExitCode::from(code),
        Err(error) => report(&error),
    }
}

/// Runs a command; the exit code where nothing went wrong: 0, or 1 for a failed check or comparison.
fn dispatch(cli: Cli) -> Result<u8, CliError> {
    match cli.command {
        Command::Reproduce(a) => commands::reproduce::reproduce(&a),
        Command::Run(a) => commands::reproduce::run(&a),
        Command::Check(a) => commands::check::check(&a),
        Command::Field(FieldCommand::List(a)) => commands::field::list(&a),
        Command::Field(FieldCommand::New(a)) => commands::field::new(&a),
        Command::Field(FieldCommand::Show(a)) => commands::field::show(&a),
        Command::Field(FieldCommand::Lint(a)) => commands::field::lint(&a),
        Command::Propagate(a) => commands::propagate::propagate(&a),
        Command::Ltg(a) => commands::ltg::ltg(&a),
        Command::Merge(a) => commands::merge::merge(&a),
        Command::Status(a) => commands::status::status(&a),
        Command::Info(a) => commands::info::info(&a),
        Command::Convert(a) => commands::convert::convert(&a),
        Command::Lines(a) => commands::lines::run(&a),
        Command::Topology(a) => commands::topology::run(&a),
        Command::Lic(a) => commands::lic::run(&a),
        Command::Ftle(a) => commands::ftle::run(&a),
        Command::Glyphs(a) => commands::glyphs::run(&a),
        Command::Ridges(a) => commands::ridges::run(&a),
        Command::Compare(a) => commands::compare::compare(&a),
        Command::Review(a) => commands::review::review(&a),
        Command::Bench(a) => commands::bench::bench(&a),
        Command::Completions(a) => commands::shell::completions(&a),
        Command::Man(a) => commands::shell::man(&a),
    }
}

fn report(error: &CliError) -> ExitCode {
    eprintln!("tigereye: {error}");
    ExitCode::from(error.exit_code())
}
