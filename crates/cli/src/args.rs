//! The command line.

pub(crate) mod classical;
pub(crate) mod experiments;
pub(crate) mod fields;
pub(crate) mod light;
pub(crate) mod reading;
pub(crate) mod shell;
pub(crate) mod style;
pub(crate) mod values;

use clap::{Parser, Subcommand};
use classical::{FtleArgs, GlyphsArgs, LicArgs, LinesArgs, RidgesArgs, TopologyArgs};
use experiments::{CheckArgs, ReproduceArgs, ReviewArgs, RunArgs};
use fields::FieldCommand;
use light::{BenchArgs, LtgArgs, MergeArgs, PropagateArgs, StatusArgs};
use reading::{CompareArgs, ConvertArgs, InfoArgs};
use shell::{CompletionsArgs, ManArgs};

/// Shows 2D tensor fields by letting light run through them.
#[derive(Debug, Parser)]
#[command(name = "tigereye", version, arg_required_else_help = true, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Recompute every evaluation of the thesis and write a report.
    Reproduce(ReproduceArgs),
    /// Run experiment files and write a report of them.
    Run(RunArgs),
    /// Parse and validate experiment files without running them.
    Check(CheckArgs),
    /// The test fields.
    #[command(subcommand)]
    Field(FieldCommand),
    /// One light distribution.
    Propagate(PropagateArgs),
    /// The light transport gradient volume.
    Ltg(LtgArgs),
    /// The light transport gradient volume of shards computed apart.
    Merge(MergeArgs),
    /// How far the shards of a gradient are, and what is missing or broken.
    Status(StatusArgs),
    /// The contents of a tensor field, and how it was read.
    Info(InfoArgs),
    /// Any readable tensor field to another format.
    Convert(ConvertArgs),
    /// Tensor lines and hyperstreamlines.
    Lines(LinesArgs),
    /// Degenerate points and separatrices.
    Topology(TopologyArgs),
    /// Noise smeared along the axes (line integral convolution).
    Lic(LicArgs),
    /// Finite-time Lyapunov exponent of the tensor lines.
    Ftle(FtleArgs),
    /// A glyph for every tensor.
    Glyphs(GlyphsArgs),
    /// Height ridges or contours of a gradient, of exponents, or of any other image of numbers.
    Ridges(RidgesArgs),
    /// Difference of two results.
    Compare(CompareArgs),
    /// What a change moved: numbers and figures of two results, or pending snapshots, on one page.
    Review(ReviewArgs),
    /// The engine's speed beside the limits of this machine.
    Bench(BenchArgs),
    /// The completion script of a shell, on standard output.
    Completions(CompletionsArgs),
    /// The manual pages of all commands, as files for `man`.
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
