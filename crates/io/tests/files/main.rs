//! Files of every format: what they mean, what is refused, what is written.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

mod arrays;
mod conventions;
mod encodings;
mod hostile;
mod nifti_headers;
mod nrrd_headers;
mod numpy;
mod parts;
mod planes;
mod positions;
mod reference_files;
mod round_trips;
mod support;
mod volumes;
mod writers;
