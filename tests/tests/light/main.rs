//! Laws of light and of its gradient, across the crates.

mod common;
mod gradient_laws;
mod linear_laws;
mod propagation_laws;
mod published_volumes;
mod scene_laws;
mod stationary_laws;
