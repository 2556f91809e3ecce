//! The command line of propagations and gradients.

use super::reading::ReadingArgs;
use super::style::{OverlayArgs, StyleArgs};
use super::values::{
    choice, medium_help, parse_bytes, parse_count, parse_directions, parse_hours, parse_normalization,
    parse_percentage, parse_seconds, parse_seed, parse_shard, parse_side, parse_sketches, parse_threads,
    parse_threshold, parse_total_anisotropy,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tigereye_core::{Choice, Directions, Normalization, ProfileRule, TotalAnisotropy};
use tigereye_ltg::{Precision, Shard};
use tigereye_transport::{ScatteringRule, Scheme, SharedWeights, StopMeasure, Stopping};

/// What a computation may use.
#[derive(Clone, Debug, Args)]
pub(crate) struct Resources {
    /// Threads; all processors by default. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Upper bound on memory, bytes (suffixes K, M, G); half of the machine's by default.
    #[arg(long, value_name = "BYTES", value_parser = parse_bytes)]
    pub(crate) memory: Option<u64>,
}

/// How tensors become transmission profiles.
#[derive(Clone, Debug, Args)]
pub(crate) struct ProfileArgs {
    /// Scaling of transmission profiles: local (each by itself, nothing absorbs; the default), global (all by the
    /// largest mean of the field: weaker cells absorb), local-above:F (local from the fraction F of it upwards, weaker
    /// cells absorb all) or local-above-global:F (weaker cells as global).
    #[arg(long, value_name = "RULE", value_parser = parse_normalization)]
    pub(crate) normalization: Option<Normalization>,
    /// Beyond which ratio R of its semi-axes a tensor transmits along one axis only; 20 by default. R:WIDTH blends
    /// gradually from R/WIDTH to R*WIDTH (`smooth`: 20:2); with cap:R such a tensor has the ellipse of the ratio R
    /// (`cap`: cap:20); with `none` only tensors with a vanishing axis transmit along one axis only.
    #[arg(long, value_name = "R", value_parser = parse_total_anisotropy, allow_hyphen_values = true)]
    pub(crate) total_anisotropy: Option<TotalAnisotropy>,
}

impl ProfileArgs {
    /// The rule, asked for or usual.
    pub(crate) fn rule(&self) -> ProfileRule {
        ProfileRule {
            normalization: self.normalization.unwrap_or(Normalization::Local),
            total_anisotropy: self.total_anisotropy.unwrap_or_default(),
        }
    }
}

/// What determines a propagation.
#[derive(Clone, Debug, Args)]
pub(crate) struct SchemeArgs {
    /// Angular samples S, a multiple of 8.
    #[arg(long, value_name = "N", default_value = "32", value_parser = parse_directions)]
    pub(crate) directions: Directions,
    /// How a cell scatters light that arrives from several sides.
    #[arg(long, default_value = ScatteringRule::Joint.word(), value_parser = choice::<ScatteringRule>())]
    pub(crate) scattering: ScatteringRule,
    /// Stop when the stopping rule's measure falls below F, 0.5 by default; 0 never stops early.
    #[arg(long, value_name = "F", value_parser = parse_threshold, allow_hyphen_values = true)]
    pub(crate) threshold: Option<f64>,
    /// Stop after N+1 steps at the latest; 1000 by default.
    #[arg(long, value_name = "N", value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) max_iterations: Option<usize>,
    /// What the threshold is compared with; `stationary` by default with linear scattering, `flux` otherwise.
    #[arg(long, value_parser = choice::<StopMeasure>())]
    pub(crate) stop: Option<StopMeasure>,
    #[command(flatten)]
    pub(crate) profiles: ProfileArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

impl SchemeArgs {
    /// The stopping rule's measure, asked for or usual.
    pub(crate) fn stop(&self) -> StopMeasure {
        self.stop.unwrap_or(match self.scattering {
            ScatteringRule::Joint => StopMeasure::Flux,
            ScatteringRule::Linear => StopMeasure::Stationary,
        })
    }

    /// When a propagation ends.
    pub(crate) fn stopping(&self) -> Stopping {
        let usual = Stopping::REFERENCE;
        let threshold = self.threshold.unwrap_or(usual.rule.threshold());
        self.stop().stopping(threshold, self.max_iterations.unwrap_or(usual.max_iterations))
    }

    /// Weights, lobes and scattering.
    pub(crate) fn scheme(&self) -> Scheme {
        Scheme::new(self.directions, SharedWeights::Thesis).with_scattering(self.scattering)
    }
}

#[derive(Debug, Args)]
pub(crate) struct PropagateArgs {
    #[arg(help = medium_help())]
    pub(crate) input: String,
    /// A light: column, row and, after a further comma, its profile as an expression in `theta` (default 1). A scene
    /// has lights of its own where none is given.
    #[arg(long = "light", value_name = "X,Y[,PROFILE]", allow_hyphen_values = true)]
    pub(crate) lights: Vec<String>,
    /// A file of lights, one per line as for --light; `#` begins a comment. Each makes results of its own, whose names
    /// have its number in the list before the extension: NAME-1.png.
    #[arg(long = "lights", value_name = "FILE", conflicts_with_all = ["lights", "towards"])]
    pub(crate) light_list: Option<PathBuf>,
    /// The lights flash once instead of shining all the time.
    #[arg(long)]
    pub(crate) impulse: bool,
    /// Exactly N steps instead of a stopping rule.
    #[arg(long, value_name = "N", value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) steps: Option<usize>,
    /// Importance instead of light: how much of what each cell emits in each direction arrives at this cell. A
    /// receiver: column, row and, after a further comma, its sensitivity as an expression in `theta` (default 1).
    #[arg(long, value_name = "X,Y[,PROFILE]", allow_hyphen_values = true, conflicts_with_all = ["lights", "impulse", "steps"])]
    pub(crate) towards: Option<String>,
    /// Outputs by their extensions: .vti, .npy, .png, .svg, .pdf; .pvd has a frame for every step, in the folder NAME
    /// beside NAME.pvd; .apng is an animation of the energy, a frame for every step or every n-th.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// What pictures show.
    #[arg(long, value_enum, default_value_t = Picture::Overlay)]
    pub(crate) picture: Picture,
    #[command(flatten)]
    pub(crate) scheme: SchemeArgs,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) overlay: OverlayArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

/// What a picture of a light distribution shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Picture {
    /// Transmission (red) and light (blue) of every cell.
    Overlay,
    /// Energy of every cell, logarithmic.
    Energy,
}

#[derive(Debug, Args)]
pub(crate) struct LtgArgs {
    #[arg(help = medium_help())]
    pub(crate) input: String,
    /// Outputs by their extensions: .vti, .npy; .png, .svg, .pdf show the only slice, or the mean over the slices. With
    /// --shard one .part.
    #[arg(short, long = "output", value_name = "OUT", required_unless_present = "plan", num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) scheme: SchemeArgs,
    /// Half-width of the angular difference, samples; ceil(S/12) by default.
    #[arg(long, value_name = "K", value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) omega_step: Option<usize>,
    /// Only these angular slices (sample indices: 90 degrees are S/4); the output then holds just them, ascending.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', value_parser = parse_count, allow_hyphen_values = true)]
    pub(crate) slices: Option<Vec<usize>>,
    /// The same slices by their directions, degrees.
    #[arg(
        long,
        value_name = "A,B,C",
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with = "slices"
    )]
    pub(crate) slices_deg: Option<Vec<f64>>,
    /// Precision of the computation; f64 by default, f32 for an estimate.
    #[arg(long, value_parser = choice::<Precision>())]
    pub(crate) precision: Option<Precision>,
    /// Estimate the gradient of linear scattering from N random sketches (16 to 1048576), with its standard error in
    /// the array LTG_error.
    #[arg(long, value_name = "N", value_parser = parse_sketches, allow_hyphen_values = true)]
    pub(crate) estimate: Option<u32>,
    /// Estimate it with as many sketches as this relative error takes.
    #[arg(long, value_name = "P%", value_parser = parse_percentage, allow_hyphen_values = true, conflicts_with_all = ["estimate", "shard", "checkpoint"])]
    pub(crate) error: Option<f64>,
    /// Seed of the sketches; 0 by default.
    #[arg(long, value_name = "K", value_parser = parse_seed, allow_hyphen_values = true)]
    pub(crate) seed: Option<u64>,
    /// Write the estimate so far to FILE (.vti, .npy, .png, .svg, .pdf) as soon as there is one, and again each time
    /// the error has halved.
    #[arg(long, value_name = "FILE")]
    pub(crate) preview: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// Write NAME.view.py beside NAME.vti: it opens the volume in ParaView with contours and a slice.
    #[arg(long)]
    pub(crate) view: bool,
    /// Keep what is finished in DIR/checkpoint.part; the same command again continues.
    #[arg(long, value_name = "DIR")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Only piece K, from 0, of N nearly equal ones, for `merge`.
    #[arg(long, value_name = "K/N", value_parser = parse_shard)]
    pub(crate) shard: Option<Shard>,
    /// Compute nothing but a short sample, and say what the sweep takes here: work, memory, disk and time, and how
    /// many shards keep each under --hours (with --shard K/N what N shards take).
    #[arg(long, conflicts_with_all = ["outputs", "checkpoint", "preview", "view", "error"])]
    pub(crate) plan: bool,
    /// Hours that a shard may take, for --plan; 12 by default.
    #[arg(long, value_name = "H", value_parser = parse_hours, requires = "plan", allow_hyphen_values = true)]
    pub(crate) hours: Option<f64>,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) overlay: OverlayArgs,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// What `ltg --shard` wrote, every shard once, in any order; of a folder the files .part.
    #[arg(required = true, value_name = "DIR|PART")]
    pub(crate) parts: Vec<PathBuf>,
    /// Outputs by their extensions, as those of `ltg`: .vti, .npy, .png, .svg, .pdf.
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1..)]
    pub(crate) outputs: Vec<PathBuf>,
    /// What is there already, checkpoints in the folders among it: values that are not finished are NaN. An estimate
    /// has fewer sketches.
    #[arg(long)]
    pub(crate) partial: bool,
    /// Summary as JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StatusArgs {
    /// Parts, checkpoints, or folders with files .part and folders with a checkpoint.part in them.
    #[arg(required = true, value_name = "DIR|PART")]
    pub(crate) paths: Vec<PathBuf>,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// The larger number of threads to measure; all processors by default. One thread is measured too.
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Sides of the square fields.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', default_value = "14,51,101,201", value_parser = parse_side)]
    pub(crate) cells: Vec<usize>,
    /// Seconds to spend on each measurement; each of the three numbers in a row takes at least this long.
    #[arg(long, value_name = "F", default_value = "1", value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// As JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
}
