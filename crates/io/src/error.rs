//! What can be wrong with a file, and where: the errors of all formats.
//!
//! Lines and columns count from 1, bytes from 0 at the start of the file.

use crate::array_error::ArrayError;
use crate::convert::ChoiceError;
use crate::inflate::DataError;
use crate::legacy::LegacyError;
use crate::limits::LimitError;
use crate::matrices::MatricesError;
use crate::nifti::NiftiError;
use crate::npy::NpyError;
use crate::nrrd::NrrdError;
use crate::part::PartError;
use crate::picture::PictureError;
use crate::table::TableError;
use crate::text::TextError;
use crate::volume::{PlaneError, VolumeError};
use crate::write_error::WriteError;
use crate::xml::XmlError;
use thiserror::Error;
use tigereye_core::CoreError;

/// A file that cannot be read, or data that cannot be written.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IoError {
    /// What is wrong with text data, whatever the format.
    #[error(transparent)]
    Text(#[from] TextError),
    /// What keeps a text from being rows of 2x2 blocks.
    #[error(transparent)]
    Matrices(#[from] MatricesError),
    /// What keeps a text from being a table, one point a line.
    #[error(transparent)]
    Table(#[from] TableError),
    /// More than [`crate::Limits`] allow.
    #[error(transparent)]
    Limit(#[from] LimitError),
    /// What is wrong with a `.npy` file or a `.npz` archive.
    #[error(transparent)]
    Npy(#[from] NpyError),
    /// What is wrong with a `.part` file.
    #[error(transparent)]
    Part(#[from] PartError),
    /// What is wrong with the XML of a VTK file.
    #[error(transparent)]
    Xml(#[from] XmlError),
    /// What is wrong with an array of a VTK file.
    #[error(transparent)]
    Array(#[from] ArrayError),
    /// What keeps a file from being a picture.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// What is wrong with the header of an NRRD file.
    #[error(transparent)]
    Nrrd(#[from] NrrdError),
    /// What is wrong with a NIfTI file, or keeps a volume from being one.
    #[error(transparent)]
    Nifti(#[from] NiftiError),
    /// What is wrong with a legacy VTK file.
    #[error(transparent)]
    Legacy(#[from] LegacyError),
    /// What is wrong with the bytes behind a header.
    #[error(transparent)]
    Data(#[from] DataError),
    /// What keeps numbers on points from being a volume of tensors.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// What is wrong with the choice of a plane.
    #[error(transparent)]
    Plane(#[from] PlaneError),
    /// What is wrong with the choice of an array, or with what is in it.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// Data that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Sizes that core refuses.
    #[error(transparent)]
    Core {
        /// Core's own words.
        #[from]
        source: CoreError,
    },
}
