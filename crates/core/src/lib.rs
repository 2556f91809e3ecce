//! Tensors, decompositions, grids, polar profiles and result types of tigereye.
//!
//! The lowest layer: value types and closed formulas. It knows no algorithms that iterate, no files, no threads and no
//! colours, and only constructors that take sizes or user data can fail.
//!
//! Conventions, used everywhere: cells (x, y) with x to the right and row y = 0 on top; angles in radians,
//! counter-clockwise from +x with the y axis pointing **up**, so that direction 90 degrees leads to row y-1; tensor
//! components in that same frame.

mod anisotropy;
mod bilinear;
mod cell_shape;
mod choice;
mod conformal;
mod decomposition;
mod difference;
mod directions;
mod error;
mod factors;
mod field;
mod geometry;
mod grid;
mod limits;
pub mod math;
mod normalization;
mod profile;
mod reflection;
mod results;
mod runge_kutta;
mod splitmix;
mod statistics;
mod symmetric3;
mod symmetry;
mod tensor;
mod total_anisotropy;
mod transmission;

pub use anisotropy::Anisotropy;
pub use bilinear::bilinear;
pub use cell_shape::CellShape;
pub use choice::Choice;
pub use conformal::Conformal;
pub use decomposition::{AxisSign, Eigenvalues, Svd};
pub use difference::Difference;
pub use directions::Directions;
pub use error::CoreError;
pub use factors::{OrthogonalFactor, PrincipalAxes};
pub use field::Field;
pub use geometry::{Cells, Physical, PhysicalPoint, Point, Vector, length, quarter_turned};
pub use grid::{Cell, Grid, NEIGHBOUR_OFFSETS};
pub use nalgebra::Complex;
pub use normalization::{Below, Normalization};
pub use profile::PolarProfile;
pub use reflection::{Reflection, Surface};
pub use results::{LightDistribution, LtgVolume, StopReason, SweepWork, Work};
pub use runge_kutta::runge_kutta_step;
pub use splitmix::SplitMix64;
pub use statistics::pearson;
pub use symmetric3::{fractional_anisotropy3, mode3, symmetric_eigenvalues3};
pub use symmetry::Symmetry;
pub use tensor::Tensor2;
pub use total_anisotropy::{TOTAL_ANISOTROPY_RATIO, TotalAnisotropy, is_totally_anisotropic};
pub use transmission::{CellTransmission, ProfileRule, RateScale, TransmissionField, transmission_ellipse};
