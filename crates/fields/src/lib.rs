//! Test tensor fields with known answers, and fields defined by expressions.
//!
//! One pure generator a file under `generators/`; [`generators`] lists them, [`parse_spec`] reads
//! `inverse:size=51,anisotropy=4`, [`generate`] makes the field. [`ExpressionField`] makes one from formulas a user
//! writes, with the parser in [`expression`].
//!
//! [`images`] has the tensor fields of images: gradients of vectors, Hessians and structure tensors of scalars.
//!
//! All tensors live in core's frame, x right and y up, row 0 on top. Nothing here reads files, draws or propagates;
//! every field is the same bits on every platform.

mod arguments;
mod error;
pub mod expression;
mod expression_field;
mod generator;
mod generators;
mod geometry;
pub mod images;
mod known;
mod limits;
mod nearest;
mod noise;
mod parameter;
mod registry;

pub use arguments::{Arguments, FieldSpec, parse_spec};
pub use error::FieldError;
pub use expression::{Expression, ExpressionError, ExpressionErrorKind};
pub use expression_field::{ExpressionField, Form, variables};
pub use generator::{Generator, Settings};
pub use known::{Known, Mirror};
pub use nearest::{did_you_mean, nearest};
pub use noise::with_noise;
pub use parameter::{MAX_SIDE, Parameter, ParameterKind};
pub use registry::{find, generate, generators};
