//! From [`TensorVolume`] to bytes.

use crate::volume::{Frame, IDENTITY, TensorVolume, World, symmetric, written_scalar};
use crate::{IoError, ScalarType};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

/// Writes a file with attached gzip data, in single precision where the input has no more. Tensors are along the axes
/// of `frame`: the world's (the measurement frame is the unit matrix), or the voxels' (it has the directions of their
/// axes). Symmetric ones become `3D-masked-symmetric-matrix`, as teem and Slicer have them, others `3D-masked-matrix`;
/// the mask is the volume's, or 1. `provenance` becomes the value of the key `tigereye`.
///
/// # Errors
/// [`crate::volume::VolumeError::SkewedAxes`] where components must be turned and cannot be.
pub fn write(volume: &TensorVolume, frame: Frame, provenance: &str) -> Result<Vec<u8>, IoError> {
    let lattice = volume.lattice();
    let tensors = volume.along(frame)?;
    let (kind, entries): (_, &[usize]) = if symmetric(&tensors) {
        ("3D-masked-symmetric-matrix", &[0, 1, 2, 4, 5, 8])
    } else {
        ("3D-masked-matrix", &[0, 1, 2, 3, 4, 5, 6, 7, 8])
    };
    let mut numbers = Vec::with_capacity(tensors.len() * (entries.len() + 1));
    for (voxel, t) in tensors.iter().enumerate() {
        numbers.push(lattice.mask.as_ref().and_then(|m| m.get(voxel).copied()).unwrap_or(1.0));
        numbers.extend(entries.iter().map(|&e| t[e]));
    }
    let space = match &lattice.world {
        World::Scanner(name) if lattice.world.signs().is_some() => format!("space: {name}"),
        _ => "space dimension: 3".to_owned(),
    };
    let vector = |v: [f64; 3]| format!("({:?},{:?},{:?})", v[0], v[1], v[2]);
    let [nx, ny, nz] = lattice.size;
    let (size, [a, b, c]) = (entries.len() + 1, lattice.axes.map(vector));
    let d = if frame == Frame::Voxel { lattice.directions() } else { IDENTITY };
    let frame = [0, 1, 2].map(|a| vector([d[a], d[a + 3], d[a + 6]])).join(" ");
    let scalar = written_scalar(lattice.scalar);
    let kind_of_number = if scalar == ScalarType::Float32 { "float" } else { "double" };
    let mut header = String::new();
    // Writing to a String does not fail.
    let _ = write!(
        header,
        "NRRD0005\ntype: {kind_of_number}\ndimension: 4\n{space}\nsizes: {size} {nx} {ny} {nz}\n\
         space directions: none {a} {b} {c}\nkinds: {kind} space space space\nendian: little\nencoding: gzip\n\
         space origin: {}\nmeasurement frame: {frame}\ntigereye:={}\n\n",
        vector(lattice.origin),
        provenance.replace('\\', "\\\\").replace('\n', "\\n")
    );
    let mut encoder = GzEncoder::new(header.into_bytes(), Compression::default());
    // Writing to a Vec does not fail.
    let _ = encoder.write_all(&scalar.encode(&numbers));
    Ok(encoder.finish().unwrap_or_default())
}
