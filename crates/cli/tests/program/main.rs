//! The program as people and scripts call it: outputs, exit codes, messages, interruptions.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

mod assumptions;
mod classical;
mod cluster;
mod derived;
mod experiments;
mod faults;
mod first_light;
mod geometry;
#[cfg(unix)]
mod interruption;
mod linear;
mod machine;
mod masks;
mod merging;
mod odd_fields;
mod own_fields;
#[cfg(unix)]
mod parts;
mod pictures;
mod reading;
mod reports;
mod results;
mod review;
mod scenes;
mod shell;
mod streams;
mod support;
mod volumes;
