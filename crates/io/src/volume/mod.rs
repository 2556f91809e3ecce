//! Tensors on a 3D lattice as files have them, and what was read or assumed to know what they mean.
//!
//! A reader gives a [`Lattice`]: tuples of numbers with what the file states about them. [`Lattice::tensors`] adds what
//! the user says ([`Reading`]) and assumes the rest, visibly; the [`TensorVolume`] it gives is cut to a plane by
//! [`TensorVolume::slice`].
//!
//! Frames. Every voxel axis has a direction in the world of the file (`axes`). Components are along the voxel axes,
//! along the world's axes, or along those of NRRD's measurement frame.

mod choice;
mod components;
mod convention;
mod error;
mod geometry;
mod image;
mod lattice;
mod mask;
mod matrix3;
mod meaning;
mod names;
mod order;
mod output;
mod plane;
mod spelling;
mod suspicion;
mod tensors;

pub use choice::{Axis, Crop, Plane, PlaneChoice, parse_slice};
pub use components::ComponentArrays;
pub(crate) use components::{joined, joined_rows};
pub use convention::{ALIASES, Alias, CONVENTIONS, Content, Convention, documentation};
pub use error::{PlaneError, VolumeError};
pub use geometry::PlaneGeometry;
pub(crate) use geometry::world_axes;
pub(crate) use image::{HIDDEN_POINT, points_of_image};
pub use image::{image_from_volume, lattice_from_image, lattice_from_points, points_from_image};
pub use lattice::Lattice;
pub use mask::Overlay;
pub(crate) use matrix3::IDENTITY;
pub use meaning::{Frame, Known, Shear, World};
pub(crate) use names::{
    Group, Naming, VECTOR_AXES, groups, names_eigenvectors, names_principal_values, naming, order_of,
    outside_tensors, row_groups,
};
pub use order::TensorOrder;
pub(crate) use output::{symmetric, written_scalar};
pub use plane::{Cut, Slice};
pub use suspicion::{Suspicion, negative_share};
pub use tensors::{Reading, TensorVolume};
