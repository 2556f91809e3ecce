//! Files with faults: what is said of them, and where.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

mod experiments;
mod scenes;
