//! Files that tests read: those that lie beside the project, and hostile ones built on the spot.
#![allow(dead_code, reason = "each test program uses a part")]
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::io::Write as _;
use tigereye_core::{Field, Tensor2};
use tigereye_io::volume::{
    Frame, Lattice, PlaneChoice, PlaneGeometry, Reading, Slice, TensorVolume, image_from_volume,
    lattice_from_image, lattice_from_points, points_from_image,
};
use tigereye_io::{ImageData, IoError, Wanted, legacy, nifti, nrrd, vti, vtp};

pub(crate) fn bytes(folder: &std::path::Path, file: &str) -> Vec<u8> {
    std::fs::read(folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

pub(crate) fn json(folder: &std::path::Path, file: &str) -> serde_json::Value {
    serde_json::from_slice(&bytes(folder, file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// Reads and writes one format.
pub(crate) struct Format {
    pub(crate) name: &'static str,
    pub(crate) through: fn(&TensorVolume) -> Result<Lattice, IoError>,
}

/// Every format that holds volumes.
pub(crate) const FORMATS: [Format; 6] = [
    Format {
        name: "vti",
        through: |v| lattice_from_image(&vti::read(&vti::write(&world(v)?)?)?, None, Wanted::Tensors),
    },
    Format {
        name: "vtp",
        through: |v| {
            lattice_from_points(
                vtp::read(&vtp::write(&points_from_image(world(v)?))?)?,
                None,
                Wanted::Tensors,
            )
        },
    },
    Format {
        name: "vtk",
        through: |v| {
            lattice_from_image(&legacy::read(&legacy::write(&world(v)?, "title")?)?, None, Wanted::Tensors)
        },
    },
    Format { name: "nrrd", through: |v| nrrd::read(&nrrd::write(v, Frame::World, "{\"a\\b\":\n1}")?, None) },
    Format { name: "nii", through: |v| nifti::read(&nifti::write(v, nifti::WrittenAs::Matrices, "words")?) },
    Format {
        name: "nii.gz",
        through: |v| nifti::read(&nifti::write_packed(v, nifti::WrittenAs::Matrices, "")?),
    },
];

/// The volume along the axes of the world.
pub(crate) fn world(volume: &TensorVolume) -> Result<ImageData, IoError> {
    image_from_volume(volume, Frame::World)
}

/// The image that a field is written as.
pub(crate) fn image_of(field: &Field<Tensor2>, origin: [f64; 2], spacing: [f64; 2]) -> ImageData {
    image_from_volume(&TensorVolume::from_field(field, &flat(origin, spacing)), Frame::World).unwrap()
}

/// A plane of the world's x and y, in height 0.
pub(crate) fn flat([x, y]: [f64; 2], spacing: [f64; 2]) -> PlaneGeometry {
    PlaneGeometry::new([x, y, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], spacing)
}

/// The field in the only plane of an image.
pub(crate) fn field_of(image: &ImageData, array: Option<&str>) -> Result<Slice<Tensor2>, IoError> {
    lattice_from_image(image, array, Wanted::Tensors)?
        .tensors(Reading::default())?
        .slice(PlaneChoice::default())
}

/// A file of one array over `points` points along x.
pub(crate) fn declaring(points: u64, root: &str, array: &str, appended: &[u8]) -> Vec<u8> {
    let extent = format!("0 {} 0 0 0 0", points - 1);
    let head = format!(
        "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{root}>\
         <ImageData WholeExtent=\"{extent}\"><Piece Extent=\"{extent}\"><PointData>{array}</PointData></Piece></ImageData>\
         <AppendedData encoding=\"raw\">_"
    );
    [head.as_bytes(), appended, b"</AppendedData></VTKFile>"].concat()
}

pub(crate) const ARRAY: &str = "<DataArray type=\"Float64\" Name=\"a\" format=\"appended\" offset=\"0\"/>";
pub(crate) const ZLIB: &str = " compressor=\"vtkZLibDataCompressor\"";
pub(crate) const LZ4: &str = " compressor=\"vtkLZ4DataCompressor\"";

pub(crate) fn words(words: &[u64]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

pub(crate) fn npy_file(version: u8, dictionary: &str, data: usize) -> Vec<u8> {
    let size = u32::try_from(dictionary.len()).unwrap().to_le_bytes();
    let size = if version == 1 { &size[..2] } else { &size[..] };
    [b"\x93NUMPY", &[version, 0][..], size, dictionary.as_bytes(), &vec![1; data]].concat()
}

/// A compressed block that expands to about `size` zeros.
pub(crate) fn bomb(root: &str, size: usize) -> Vec<u8> {
    if root == LZ4 {
        // One literal, then a match at offset 1 whose length grows by 255 a byte, then the five last literals.
        return [&[0x1f, 0, 1, 0][..], &vec![255; size / 255], &[0, 0x50, 0, 0, 0, 0, 0]].concat();
    }
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    for _ in 0..size.div_ceil(1 << 16) {
        encoder.write_all(&[0; 1 << 16]).expect("a Vec takes everything");
    }
    encoder.finish().expect("a Vec takes everything")
}

/// A NIfTI-1 file: lengths of the axes, datatype and bits, intent and its first parameters, data in the byte order
/// given.
pub(crate) fn nifti_file(
    big: bool,
    shape: &[i16],
    datatype: i16,
    bits: i16,
    intent: i16,
    p1: f32,
    data: &[u8],
) -> Vec<u8> {
    let mut head = vec![0; 352];
    let mut put = |at: usize, bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if big {
            bytes.reverse();
        }
        head[at..at + bytes.len()].copy_from_slice(&bytes);
    };
    put(0, &348_i32.to_le_bytes());
    put(40, &i16::try_from(shape.len()).unwrap().to_le_bytes());
    for (i, n) in shape.iter().enumerate() {
        put(42 + 2 * i, &n.to_le_bytes());
    }
    put(56, &p1.to_le_bytes());
    // A general matrix states both of its sides.
    put(60, &p1.to_le_bytes());
    put(68, &intent.to_le_bytes());
    put(70, &datatype.to_le_bytes());
    put(72, &bits.to_le_bytes());
    put(108, &352_f32.to_le_bytes());
    head[344..348].copy_from_slice(b"n+1\0");
    [&head[..], data].concat()
}
