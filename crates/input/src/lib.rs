//! Data files of every readable format as tensor fields in the plane, with what was read and what was assumed.
//!
//! ```text
//! bytes --io--> Lattice --tensors--> TensorVolume --slice--> Field<Tensor2>
//!                  |                                             ^
//!                  '--slice--> scalars, vectors --derivatives----'     then crop and resample
//! ```
//!
//! The program's commands and the fields of experiment files go the same way. Whoever calls reads the bytes.

mod dip;
mod error;
mod facts;
mod file;
mod foreign;
pub mod formats;
pub mod lint;
mod plane;
pub mod provenance;
mod reading;
mod threshold;

pub use error::InputError;
pub use facts::{Anisotropies, FieldFacts, Range, VolumeFacts};
pub use file::{Content, TensorFile, finite_volume, open};
pub use formats::{format_of, is_readable};
pub use plane::{PlaneField, not_finite_words};
pub use reading::{Derivation, Derived, Reading};
pub use threshold::suggested_local_above;
