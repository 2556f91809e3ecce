//! From [`TensorVolume`] to bytes.

use super::error::NiftiError;
use super::header::{LENGTH, MATRIX, SYMMETRIC};
use crate::volume::{Frame, TensorVolume, VolumeError, World, symmetric, written_scalar};
use crate::{IoError, ScalarType};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write as _;

/// Code of an extension that holds comments.
const COMMENT: i32 = 6;

/// How the components are laid out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WrittenAs {
    /// The standard's matrices: 5-D, along the voxel axes.
    #[default]
    Matrices,
    /// FSL's: 4-D, xx,xy,xz,yy,yz,zz along the axes of its gradient tables.
    Fsl,
    /// MRtrix3's: 4-D, xx,yy,zz,xy,xz,yz along the scanner's axes.
    Mrtrix,
}

impl WrittenAs {
    /// Entries in the order written, row by row, and the code of the intent.
    fn entries(self, symmetric: bool) -> Result<(i16, &'static [usize]), IoError> {
        match (self, symmetric) {
            (Self::Matrices, true) => Ok((SYMMETRIC, &[0, 3, 4, 6, 7, 8])),
            (Self::Matrices, false) => Ok((MATRIX, &[0, 1, 2, 3, 4, 5, 6, 7, 8])),
            (Self::Fsl, true) => Ok((0, &[0, 1, 2, 4, 5, 8])),
            (Self::Mrtrix, true) => Ok((0, &[0, 4, 8, 1, 2, 5])),
            (Self::Fsl | Self::Mrtrix, false) => Err(VolumeError::NotSymmetric.into()),
        }
    }

    /// Tensors along the axes of the layout.
    fn tensors(self, volume: &TensorVolume) -> Result<Vec<[f64; 9]>, IoError> {
        match self {
            Self::Matrices => volume.along(Frame::Voxel),
            Self::Fsl => volume.along(Frame::Fsl),
            Self::Mrtrix => {
                let [x, y, z] = volume.lattice().world.signs().unwrap_or([1.0; 3]);
                let signs = [1.0, x * y, x * z, x * y, 1.0, y * z, x * z, y * z, 1.0];
                let mut tensors = volume.along(Frame::World)?;
                tensors.iter_mut().for_each(|t| t.iter_mut().zip(signs).for_each(|(v, s)| *v *= s));
                Ok(tensors)
            }
        }
    }
}

/// Writes a file, little-endian, in single precision where the input has no more, else in double: as [`WrittenAs`]
/// says. The sform has the world right-anterior-superior; worlds that say left or posterior are turned. `provenance`
/// becomes an extension of comments.
///
/// # Errors
/// [`NiftiError::Size`], [`VolumeError::NotSymmetric`] where six components cannot hold the tensors, and
/// [`VolumeError::SkewedAxes`] where components must be turned and cannot be.
pub fn write(volume: &TensorVolume, as_what: WrittenAs, provenance: &str) -> Result<Vec<u8>, IoError> {
    let lattice = volume.lattice();
    let size = lattice.size;
    let lengths = size.map(|n| i16::try_from(n).ok());
    let [Some(nx), Some(ny), Some(nz)] = lengths else { return Err(NiftiError::Size { size }.into()) };
    let tensors = as_what.tensors(volume)?;
    let (intent, entries) = as_what.entries(symmetric(&tensors))?;
    let scalar = written_scalar(lattice.scalar);
    let (code, bits) = if scalar == ScalarType::Float32 { (16, 32) } else { (64, 64) };
    let mut head = Header([0; LENGTH]);
    head.put(0, &(LENGTH as i32).to_le_bytes());
    let components = entries.len() as i16;
    match as_what {
        WrittenAs::Matrices => {
            head.shorts(40, &[5, nx, ny, nz, 1, components, 1, 1]);
            head.floats(56, &[3.0, if intent == MATRIX { 3.0 } else { 0.0 }]);
        }
        WrittenAs::Fsl | WrittenAs::Mrtrix => head.shorts(40, &[4, nx, ny, nz, components, 1, 1, 1]),
    }
    head.shorts(68, &[intent, code, bits]);
    let [dx, dy, dz] = lattice.spacing();
    head.floats(76, &[1.0, dx, dy, dz, 1.0, 1.0, 1.0, 1.0]);
    let extension = extension(provenance);
    head.floats(108, &[(LENGTH + extension.len()) as f64, 1.0]);
    // Millimetres, where the world is a scanner's.
    let scanner = matches!(lattice.world, World::Scanner(_));
    head.0[123] = if scanner { 2 } else { 0 };
    head.put(148, concat!("tigereye ", env!("CARGO_PKG_VERSION")).as_bytes());
    head.shorts(254, &[if scanner { 1 } else { 2 }]);
    let signs = lattice.world.signs().unwrap_or([1.0; 3]);
    for (row, sign) in signs.into_iter().enumerate() {
        let [a, b, c] = lattice.axes.map(|axis| sign * axis[row]);
        head.floats(280 + 16 * row, &[a, b, c, sign * lattice.origin[row]]);
    }
    head.put(344, b"n+1\0");
    let mut bytes = head.0.to_vec();
    bytes.extend(extension);
    for &e in entries {
        let component: Vec<f64> = tensors.iter().map(|t| t[e]).collect();
        bytes.extend(scalar.encode(&component));
    }
    Ok(bytes)
}

/// [`write()`], packed with gzip as `.nii.gz` has it; the same volume always gives the same bytes.
///
/// # Errors
/// As [`write()`].
pub fn write_packed(volume: &TensorVolume, as_what: WrittenAs, provenance: &str) -> Result<Vec<u8>, IoError> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    // Writing to a Vec does not fail.
    let _ = encoder.write_all(&write(volume, as_what, provenance)?);
    Ok(encoder.finish().unwrap_or_default())
}

struct Header([u8; LENGTH]);

impl Header {
    fn put(&mut self, at: usize, bytes: &[u8]) {
        self.0[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn shorts(&mut self, at: usize, values: &[i16]) {
        values.iter().enumerate().for_each(|(i, v)| self.put(at + 2 * i, &v.to_le_bytes()));
    }

    fn floats(&mut self, at: usize, values: &[f64]) {
        values.iter().enumerate().for_each(|(i, v)| self.put(at + 4 * i, &(*v as f32).to_le_bytes()));
    }
}

/// What follows the header: the mark of an extension, its size and code, and the text up to a multiple of 16 bytes.
fn extension(text: &str) -> Vec<u8> {
    let size = (8 + text.len()).next_multiple_of(16);
    let mut bytes = vec![1, 0, 0, 0];
    bytes.extend((size as i32).to_le_bytes());
    bytes.extend(COMMENT.to_le_bytes());
    bytes.extend_from_slice(text.as_bytes());
    bytes.resize(4 + size, 0);
    bytes
}
