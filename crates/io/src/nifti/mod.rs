//! NIfTI-1 in one file, `.nii` and `.nii.gz`.
//!
//! Read: both byte orders, all integer and floating-point types of up to 64 bits, scaling, sform and qform; symmetric
//! and general matrices as the standard has them (5-D, intents 1005 and 1004), and 4-D or 5-D images of several
//! components, whose order the file does not state; ITK's, whose intent has no size. Refused with a specific message:
//! NIfTI-2, ANALYZE
//! and `.hdr`/`.img` pairs, complex and colour numbers, time series, and intents of something else than tensors and
//! vectors (FSL's warps and their coefficients, points, colours).
//!
//! Written, in the precision of the input: symmetric or general matrices (5-D, intents 1005 and 1004) along the voxel
//! axes, or six components along the fourth axis as FSL or MRtrix3 have them; an sform, and what made the file as an
//! extension of comments.
//!
//! Standard: nifti1.h of the NIfTI Data Format Working Group, 2003.

mod error;
mod header;
mod write;

pub use error::NiftiError;
pub use write::{WrittenAs, write, write_packed};

use crate::inflate::{DataError, gunzip, is_gzip};
use crate::volume::{Lattice, World};
use crate::{ByteOrder, IoError, Limits, ScalarType};
use header::{Header, LENGTH};

/// Reads a file with the default [`Limits`].
///
/// # Errors
/// See [`read_with_limits`].
pub fn read(bytes: &[u8]) -> Result<Lattice, IoError> {
    read_with_limits(bytes, Limits::default())
}

/// Reads a file, compressed or not.
///
/// # Errors
/// Names the byte, in the unpacked file, and the header's field.
pub fn read_with_limits(bytes: &[u8], limits: Limits) -> Result<Lattice, IoError> {
    let packed = is_gzip(bytes);
    let unpacked;
    let head = if packed {
        unpacked = gunzip(bytes, 0, LENGTH as u64)?;
        &unpacked
    } else {
        bytes
    };
    let header = Header::parse(head, limits)?;
    let needed = header.offset + header.values() * header.scalar.bytes() as u64;
    let whole;
    let all = if packed {
        whole = gunzip(bytes, 0, needed)?;
        &whole
    } else {
        bytes
    };
    if (all.len() as u64) < needed {
        let (byte, present) = (header.offset as usize, (all.len() as u64).saturating_sub(header.offset));
        return Err(DataError::Truncated { byte, needed: u128::from(needed - header.offset), present }.into());
    }
    let data = &all[header.offset as usize..needed as usize];
    let mut values = by_voxel(data, header.components, header.scalar, header.order);
    let mut notes = vec![format!("position by {}", header.position.1)];
    if let Some((slope, intercept)) = header.scaling {
        values.iter_mut().for_each(|v| *v = *v * slope + intercept);
        notes.push(format!("numbers scaled by {slope} and shifted by {intercept}"));
    }
    let (axes, origin) = header.position.0;
    Ok(Lattice {
        size: header.size,
        components: header.components,
        values,
        scalar: header.scalar,
        axes,
        origin,
        unit: header.unit,
        world: World::Scanner(header.world().to_owned()),
        measurement: None,
        mask: None,
        order: header.content.order(header.components),
        frame: header.content.frame(header.components),
        array: header.kind.to_owned(),
        component_names: Vec::new(),
        notes,
        remarks: Vec::new(),
        order_remarks: header.time_step.map(|step| series(header.components, &step)).into_iter().collect(),
        warnings: header.disagreement.map(apart).into_iter().collect(),
    })
}

/// Words for components along an axis of time.
fn series(components: usize, step: &str) -> String {
    format!(
        "the header says that the fourth axis is time, in steps of {step}: its {components} volumes are taken as components, as \
         in tensors fitted to such a series"
    )
}

/// Words for a qform that lies elsewhere than the sform.
fn apart(distance: f64) -> String {
    format!("its qform and sform disagree by up to {distance:.3} of its unit: the sform is used")
}

/// Numbers stored component by component, voxel by voxel. A component at a time is decoded, so that little more than
/// the result is in memory.
fn by_voxel(data: &[u8], components: usize, scalar: ScalarType, order: ByteOrder) -> Vec<f64> {
    let voxels = data.len() / (components * scalar.bytes()).max(1);
    let mut values = vec![0.0; voxels * components];
    for (c, stored) in data.chunks_exact((voxels * scalar.bytes()).max(1)).enumerate().take(components) {
        for (voxel, v) in scalar.decode(order, stored).into_iter().enumerate() {
            values[voxel * components + c] = v;
        }
    }
    values
}
