//! The contents of the project's files: the values that make up experiments, fields and scenes.
//!
//! Strict: unknown keys, missing keys, wrong types and numbers out of range are errors with line and column. Keys carry
//! their units. The contents of an experiment as a whole are in [`crate::experiment`]; its runs, panels, tables and
//! quantities have a file each.

mod choices;
mod chosen;
mod engine;
mod field_source;
mod light_source;
mod named;
mod numbers;
mod placed;
mod scene_file;
mod style;
mod words;

pub use choices::{NormalizationRule, OmegaStep, Scope, Stop, TotalAnisotropyRule};
pub use chosen::{AxesChoice, Chosen};
pub use engine::EngineChoice;
pub use field_source::{DeriveRule, FieldFile, FieldSource, Parameter};
pub use light_source::{EmissionKind, LightSource, ProfileShape};
pub use named::Named;
pub use numbers::{DirectionCount, Finite, Fraction, NonNegative, Positive, Ratio, Sigma};
pub(crate) use placed::nested;
pub use placed::{Place, Placed};
pub use scene_file::{MaterialSource, Point, SceneFile, ScenePart, ShapeSource};
pub use style::{ColourRange, ColourScale, StyleFile, StyleSource};
pub(crate) use words::{key_and_value, options, words_of_fault};

/// The format this version reads.
pub const FORMAT: u32 = 1;
