//! Computations of an experiment, one file per kind: its form in the experiment file, its plan, and its outcome with
//! digest, counters and data.
//!
//! A kind is added by its file, its line in `runs!`, an id in `ids` and, where snapshots are to remember it,
//! a field of the [`Digest`](crate::Digest).

mod digest;
mod error;
pub mod ftle;
pub mod gradient;
pub mod importance;
pub mod light;
pub mod pulses;
mod setup;

pub(crate) use digest::{FtleDigest, GradientDigest, ImportanceDigest, LightDigest, PulsesDigest, rounded};
pub use error::RunError;
pub(crate) use setup::RunResolver;

use crate::form::Scope;
use crate::host::Host;
use crate::ids::MediumId;
use crate::media::Media;
use serde::Deserialize;
use tigereye_io::IoError;
use tigereye_report::DataFile;

macro_rules! runs {
    ($($(#[doc = $doc:literal])* $module:ident::$kind:ident),* $(,)?) => {
        /// A computation.
        #[derive(Clone, Debug, Deserialize, PartialEq)]
        pub enum Run {
            $($(#[doc = $doc])* $kind($module::$kind),)*
        }

        impl Run {
            pub(crate) const fn scope(&self) -> Scope {
                match self {
                    $(Self::$kind(form) => form.scope,)*
                }
            }

            /// The run with its field looked up and its numbers in range; reports what is wrong otherwise.
            pub(crate) fn resolve(&self, resolver: &mut RunResolver<'_, '_>) -> Option<RunPlan> {
                match self {
                    $(Self::$kind(form) => form.resolve(resolver).map(RunPlan::$kind),)*
                }
            }
        }

        /// A run, ready to start.
        #[derive(Clone, Debug)]
        pub(crate) enum RunPlan {
            $($kind($module::Plan),)*
        }

        impl RunPlan {
            pub(crate) const fn medium(&self) -> MediumId {
                match self {
                    $(Self::$kind(plan) => plan.medium(),)*
                }
            }

            /// `Light`, `Gradient` and so on, as the file spells it.
            pub(crate) const fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => stringify!($kind),)*
                }
            }

            pub(crate) fn run(
                &self,
                name: &str,
                media: &Media,
                memory_bytes: u64,
                host: &dyn Host,
            ) -> Result<RunOutcome, RunError> {
                match self {
                    $(Self::$kind(plan) => plan.run(name, media, memory_bytes, host).map(RunOutcome::$kind),)*
                }
            }
        }

        /// What a run leaves.
        #[derive(Debug)]
        #[expect(clippy::large_enum_variant, reason = "an experiment has a handful")]
        pub(crate) enum RunOutcome {
            $($kind($module::Outcome),)*
        }

        impl RunOutcome {
            /// Counters of the work done.
            pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
                match self {
                    $(Self::$kind(outcome) => outcome.work(),)*
                }
            }

            /// The result as a file, with how it came about; `name` is that of the file without its extension.
            pub(crate) fn data(
                &self,
                plan: &RunPlan,
                name: &str,
                command: &str,
                media: &Media,
            ) -> Option<Result<DataFile, IoError>> {
                match (self, plan) {
                    $((Self::$kind(outcome), RunPlan::$kind(plan)) => {
                        Some(outcome.data(plan, name, command, media))
                    })*
                    // The outcome of another plan.
                    $((Self::$kind(_), _) => None,)*
                }
            }
        }
    };
}

runs! {
    /// Propagation of light from one or more cells.
    light::Light,
    /// The light transport gradient of a field.
    gradient::Gradient,
    /// Where the light at a receiver comes from.
    importance::Importance,
    /// How pulses come to rest.
    pulses::Pulses,
    /// The finite-time Lyapunov exponent of the field's lines.
    ftle::Ftle,
}
