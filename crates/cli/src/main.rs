//! Placeholder.
//!
fn main() {}
