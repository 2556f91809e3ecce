//! Arrays and tensor fields from `.npy` bytes.

use super::error::NpyError;
use super::header::Header;
use crate::scalar::with_type;
use crate::{IoError, ScalarType};
use npyz::NpyFile;
use tigereye_core::{Field, Grid, Tensor2};

/// An array of numbers in C order: the last index runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct NpyArray {
    /// Length of each axis; empty for a single number.
    pub shape: Vec<usize>,
    /// All numbers. 64-bit integers beyond 2^53 lose their last bits.
    pub values: Vec<f64>,
    /// Type in the file.
    pub scalar: ScalarType,
}

/// Reads an array of f4, f8, integers or truth values (0 and 1) in either byte order, C or Fortran order.
///
/// # Errors
/// Names the byte of the header that does not fit, or the sizes that differ.
#[allow(clippy::unnecessary_cast, reason = "T is f64 in one of ten arms")]
pub fn read_array(bytes: &[u8]) -> Result<NpyArray, IoError> {
    let header = Header::parse(bytes)?;
    let as_bytes;
    let bytes = if let Some(at) = header.truth {
        // npyz reads them as booleans only.
        let mut copy = bytes.to_vec();
        copy[at] = b'u';
        as_bytes = copy;
        &as_bytes
    } else {
        bytes
    };
    let values = with_type!(header.scalar, T => stored::<T>(bytes)?.into_iter().map(|v| v as f64).collect());
    let values = if header.fortran { c_order(&header.shape, values) } else { values };
    Ok(NpyArray { shape: header.shape, values, scalar: header.scalar })
}

/// Reads a tensor field of shape (H, W, 2, 2), (H, W, 4) or (H, W, 3); see the module for the order of the components.
/// Row 0 of the array is the top row; nothing is flipped. Components may be infinite or not a number.
///
/// # Errors
/// As [`read_array`], and [`NpyError::Shape`] for another shape.
pub fn read_tensors(bytes: &[u8]) -> Result<Field<Tensor2>, IoError> {
    let NpyArray { shape, values, .. } = read_array(bytes)?;
    let (height, width, tensors): (usize, usize, Vec<Tensor2>) = match shape[..] {
        [h, w, 2, 2] | [h, w, 4] => {
            let full = values.as_chunks::<4>().0.iter();
            (h, w, full.map(|&[xx, xy, yx, yy]| Tensor2::new(xx, xy, yx, yy)).collect())
        }
        [h, w, 3] => {
            let symmetric = values.as_chunks::<3>().0.iter();
            (h, w, symmetric.map(|&[xx, xy, yy]| Tensor2::symmetric(xx, xy, yy)).collect())
        }
        _ => {
            let expected = "(H, W, 2, 2), (H, W, 4) or (H, W, 3)";
            return Err(NpyError::Shape { shape, expected }.into());
        }
    };
    Ok(Field::from_values(Grid::new(width, height)?, tensors)?)
}

/// The numbers as they are stored. The header was checked, so npyz meets no size it cannot trust.
fn stored<T: npyz::Deserialize>(bytes: &[u8]) -> Result<Vec<T>, NpyError> {
    let unread = |_| NpyError::Header { byte: 0, expected: "a header that npyz reads" };
    NpyFile::new(bytes).and_then(NpyFile::into_vec).map_err(unread)
}

/// From first index fastest to last index fastest.
fn c_order(shape: &[usize], stored: Vec<f64>) -> Vec<f64> {
    let mut index = vec![0_usize; shape.len()];
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for &n in shape {
        strides.push(stride);
        stride *= n.max(1);
    }
    let mut at = 0;
    let mut values = Vec::with_capacity(stored.len());
    for _ in 0..stored.len() {
        values.push(stored[at]);
        for axis in (0..shape.len()).rev() {
            index[axis] += 1;
            at += strides[axis];
            if index[axis] < shape[axis] {
                break;
            }
            at -= index[axis] * strides[axis];
            index[axis] = 0;
        }
    }
    values
}
