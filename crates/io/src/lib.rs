//! Bytes to tensor fields, and results to bytes.
//!
//! Every reader takes a byte slice and every writer returns bytes: nothing here opens a path, prints or starts a
//! thread. Each format has one module; [`ImageData`] is what the image formats share. Tensors of all formats become a
//! [`volume::Lattice`], are read in an order and a frame, and cut to a plane; a field goes back as a
//! [`volume::TensorVolume`] of one layer.
//!
//! Files are untrusted. Sizes are multiplied in 128 bits and compared with the bytes that are really there, or with
//! [`Limits`] where compression hides them, before anything is allocated; an array is read or refused by its name,
//! never dropped; and an [`IoError`] says where it found what.
//!
//! Row order: a [`tigereye_core::Field`] has row 0 on top. Text matrices and `.npy` arrays have it there too. Files
//! with a world are laid out by it ([`volume::Cut`]). VTK image data run upwards, and so do results on fields that lie
//! somewhere; those of other fields keep row 0 first, as the published volumes do ([`Rows`]).

mod array_error;
mod convert;
mod error;
mod image;
mod inflate;
pub mod legacy;
mod limits;
pub mod matrices;
pub mod nifti;
pub mod npy;
pub mod nrrd;
pub mod part;
pub mod picture;
mod points;
mod polydata;
pub mod pvd;
mod scalar;
pub mod table;
mod text;
pub mod volume;
pub mod vti;
pub mod vtp;
mod words;
mod write_error;
mod xml;

pub use array_error::ArrayError;
pub(crate) use convert::choose_array;
pub use convert::{
    ArrayChoice, Association, ChoiceError, LTG_ARRAY, LTG_ERROR_ARRAY, LtgImage, PROVENANCE, Rows, SLICES,
    TENSOR_ARRAY, Wanted, add_ltg_error, image_from_light, image_from_ltg, image_of_energy, ltg_from_image,
};
pub use error::IoError;
pub use image::{ActiveArrays, DataArray, FieldEntry, FieldValues, ImageData};
pub use inflate::DataError;
pub use limits::{LimitError, Limits};
pub(crate) use points::taken_upwards;
pub use polydata::{Cells, PolyData};
pub use scalar::{ByteOrder, ScalarType};
pub use text::TextError;
pub use write_error::WriteError;
pub use xml::XmlError;
