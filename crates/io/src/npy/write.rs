//! Arrays and results to `.npy` bytes: version 1.0, float64, little-endian, C order.

use super::error::NpyError;
use crate::IoError;
use tigereye_core::{Field, LightDistribution, LtgVolume, Tensor2};

/// Writes an array whose last index runs fastest.
///
/// # Errors
/// [`NpyError::Shape`] unless there are as many values as the shape says, on at most 32 axes.
pub fn write_array(shape: &[usize], values: &[f64]) -> Result<Vec<u8>, IoError> {
    let count = shape.iter().try_fold(1_usize, |n, &axis| n.checked_mul(axis));
    if count != Some(values.len()) || shape.len() > 32 {
        let expected = "the number of values given, on at most 32 axes";
        return Err(NpyError::Shape { shape: shape.to_vec(), expected }.into());
    }
    Ok(encoded(shape, values.iter().copied()))
}

/// Writes a tensor field as (H, W, 2, 2), row 0 on top.
#[must_use]
pub fn write_tensors(field: &Field<Tensor2>) -> Vec<u8> {
    let grid = field.grid();
    encoded(&[grid.height(), grid.width(), 2, 2], field.values().iter().flat_map(Tensor2::components))
}

/// Writes a light distribution as (H, W, S), W/rad, row 0 on top.
#[must_use]
pub fn write_light(light: &LightDistribution) -> Vec<u8> {
    let grid = light.grid();
    let shape = [grid.height(), grid.width(), light.directions().count()];
    encoded(&shape, light.samples().iter().copied())
}

/// Writes a light transport gradient as (S, H, W), row 0 on top; S is the number of slices held.
#[must_use]
pub fn write_ltg(volume: &LtgVolume) -> Vec<u8> {
    let grid = volume.grid();
    encoded(&[volume.slices().len(), grid.height(), grid.width()], volume.values().iter().copied())
}

fn encoded(shape: &[usize], values: impl Iterator<Item = f64>) -> Vec<u8> {
    let axes: Vec<String> = shape.iter().map(usize::to_string).collect();
    // Python's tuple of one needs a comma.
    let comma = if axes.len() == 1 { "," } else { "" };
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}{comma}), }}", axes.join(", "));
    // Blanks and a line feed up to a multiple of 64 bytes, as NumPy does.
    let size = (text.len() + 11).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    // 32 axes of 20 digits stay far below 65536.
    bytes.extend_from_slice(&u16::try_from(size).unwrap_or(u16::MAX).to_le_bytes());
    bytes.extend_from_slice(format!("{text:<width$}\n", width = size - 1).as_bytes());
    bytes.extend(values.flat_map(f64::to_le_bytes));
    bytes
}
