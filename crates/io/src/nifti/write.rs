//! From [`TensorVolume`] to bytes.

use super::header::{LENGTH, MATRIX, SYMMETRIC};
use crate::volume::{Frame, TensorVolume, World, symmetric};
use crate::{IoError, ScalarType};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write as _;

/// Code of an extension that holds comments.
const COMMENT: i32 = 6;

/// Writes a file, little-endian, in double precision: the lower triangle of symmetric matrices (intent 1005), or all nine
/// entries (intent 1004), along the voxel axes as dipy and FSL have them. The sform has the world right-anterior-superior;
/// worlds that say left or posterior are turned. `provenance` becomes an extension of comments.
///
/// # Errors
/// [`IoError::NiftiSize`], and [`IoError::SkewedAxes`] where components must be turned and cannot be.
pub fn write(volume: &TensorVolume, provenance: &str) -> Result<Vec<u8>, IoError> {
    let lattice = volume.lattice();
    let size = lattice.size;
    let lengths = size.map(|n| i16::try_from(n).ok());
    let [Some(nx), Some(ny), Some(nz)] = lengths else { return Err(IoError::NiftiSize { size }) };
    let tensors = volume.along(Frame::Voxel)?;
    let (intent, entries): (_, &[usize]) = if symmetric(&tensors) {
        (SYMMETRIC, &[0, 3, 4, 6, 7, 8])
    } else {
        (MATRIX, &[0, 1, 2, 3, 4, 5, 6, 7, 8])
    };
    let mut head = Header([0; LENGTH]);
    head.put(0, &(LENGTH as i32).to_le_bytes());
    head.shorts(40, &[5, nx, ny, nz, 1, entries.len() as i16, 1, 1]);
    head.floats(56, &[3.0, if intent == MATRIX { 3.0 } else { 0.0 }]);
    // Intent, double precision, 64 bits.
    head.shorts(68, &[intent, 64, 64]);
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
        bytes.extend(ScalarType::Float64.encode(&component));
    }
    Ok(bytes)
}

/// [`write()`], packed with gzip as `.nii.gz` has it; the same volume always gives the same bytes.
///
/// # Errors
/// As [`write()`].
pub fn write_packed(volume: &TensorVolume, provenance: &str) -> Result<Vec<u8>, IoError> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    // Writing to a Vec does not fail.
    let _ = encoder.write_all(&write(volume, provenance)?);
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
