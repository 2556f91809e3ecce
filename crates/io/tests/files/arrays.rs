//! NumPy arrays of every shape, archives of them, and pictures.

use std::io::Write as _;
use tigereye_core::Tensor2;
use tigereye_io::picture::PictureError;
use tigereye_io::volume::{Axis, Frame, Known, Lattice, PlaneChoice, Reading, TensorOrder, VolumeError};
use tigereye_io::{IoError, Wanted, npy, picture};
use zip::write::SimpleFileOptions;

/// An array whose numbers count up.
fn array(shape: &[usize]) -> Vec<u8> {
    let values: Vec<f64> = (0..shape.iter().product()).map(|v: usize| v as f64).collect();
    npy::write_array(shape, &values).unwrap()
}

fn lattice(shape: &[usize], wanted: Wanted) -> Result<Lattice, IoError> {
    npy::read_lattice(&array(shape), wanted)
}

fn slice(lattice: Lattice, order: Option<&str>, slice: Option<(Axis, usize)>) -> Vec<Tensor2> {
    let volume = lattice.tensors(Reading { order, ..Reading::default() }).unwrap();
    volume.slice(PlaneChoice { plane: None, slice }).unwrap().field.values().to_vec()
}

#[test]
fn pictures_of_tensors_have_row_0_on_top_and_are_not_mirrored() {
    for shape in [&[2, 3, 2, 2][..], &[2, 3, 4], &[2, 3, 3]] {
        let field = npy::read_tensors(&array(shape)).unwrap();
        assert_eq!(slice(lattice(shape, Wanted::Tensors).unwrap(), None, None), field.values(), "{shape:?}");
    }
    // Row by row: 0 1 2 / 3 4 5 / 6 7 8 for the first cell, 9 more for the next.
    let full = slice(lattice(&[2, 1, 3, 3], Wanted::Tensors).unwrap(), None, None);
    assert_eq!(full, [Tensor2::new(0.0, 1.0, 3.0, 4.0), Tensor2::new(9.0, 10.0, 12.0, 13.0)]);
    assert_eq!(slice(lattice(&[2, 1, 9], Wanted::Tensors).unwrap(), None, None), full);
    // The upper triangle is 0 1 2 / 3 4 / 5.
    let six = slice(lattice(&[1, 1, 6], Wanted::Tensors).unwrap(), Some("fsl"), None);
    assert_eq!(six, [Tensor2::symmetric(0.0, 1.0, 3.0)]);
    let swapped = slice(lattice(&[1, 1, 4], Wanted::Tensors).unwrap(), Some("xx,yx,xy,yy"), None);
    assert_eq!(swapped, [Tensor2::new(0.0, 2.0, 1.0, 3.0)]);
}

#[test]
fn volumes_are_indexed_as_nibabel_has_them() {
    let volume = lattice(&[4, 3, 2, 6], Wanted::Tensors).unwrap();
    assert_eq!((volume.size, volume.components), ([4, 3, 2], 6));
    let assumed = (Some((TensorOrder::LOWER, Known::Assumed)), (Frame::Voxel, Known::Assumed));
    assert_eq!((volume.order, volume.frame), assumed);
    // Voxel (3, 0, 1) is tuple (3 * 3 + 0) * 2 + 1 of the array; it lies at the lower right of slice z = 1.
    let first = ((3 * 3) * 2 + 1) as f64 * 6.0;
    let plane = slice(volume, Some("dipy"), Some((Axis::Z, 1)));
    assert_eq!(plane[2 * 4 + 3], Tensor2::symmetric(first, first + 1.0, first + 2.0));
    let rows = lattice(&[4, 3, 2, 3, 3], Wanted::Tensors).unwrap();
    assert_eq!((rows.size, rows.components), ([4, 3, 2], 9));
}

#[test]
fn seven_numbers_are_a_mask_and_six_others() {
    let volume = lattice(&[1, 2, 7], Wanted::Tensors).unwrap();
    // The first mask is 0, the second 7.
    assert_eq!(slice(volume, None, None), [Tensor2::ZERO, Tensor2::symmetric(8.0, 9.0, 11.0)]);
}

#[test]
fn numbers_and_vectors_are_read_where_they_are_wanted() {
    let scalars = lattice(&[2, 3], Wanted::Scalars).unwrap().scalars(PlaneChoice::default()).unwrap();
    assert_eq!(scalars.field.values(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let vectors =
        lattice(&[1, 2, 2], Wanted::Vectors).unwrap().vectors(PlaneChoice::default(), None).unwrap();
    assert_eq!(vectors.field.values(), [[0.0, 1.0], [2.0, 3.0]], "x right, y up, as stored");
    let three = lattice(&[2, 2, 2, 3], Wanted::Vectors).unwrap();
    let choice = PlaneChoice { plane: None, slice: Some((Axis::Y, 1)) };
    // Voxel (0, 1, 0) holds 6 7 8; in the plane xz its x and z components are left, in the lower left cell.
    assert_eq!(three.vectors(choice, None).unwrap().field.values()[2], [6.0, 8.0]);
    for (shape, wanted) in [
        (&[2, 3][..], Wanted::Tensors),
        (&[5, 8, 5], Wanted::Tensors),
        (&[2, 3, 4, 4], Wanted::Vectors),
        (&[6], Wanted::Scalars),
        (&[0, 3, 4], Wanted::Tensors),
    ] {
        let message = lattice(shape, wanted).unwrap_err().to_string();
        assert!(message.contains("an array of shape") && message.contains("expected ("), "{message}");
    }
    // Components first is said, never read as positions.
    for (shape, wanted) in [
        (&[2, 2, 20, 30][..], Wanted::Tensors),
        (&[6, 20, 30, 10], Wanted::Tensors),
        (&[3, 20, 30], Wanted::Tensors),
        (&[2, 20, 30], Wanted::Vectors),
    ] {
        let message = lattice(shape, wanted).unwrap_err().to_string();
        assert!(message.contains("components first") && message.contains("moveaxis"), "{message}");
    }
    let no_scalar = lattice(&[2, 2, 2], Wanted::Vectors).unwrap();
    assert!(matches!(
        no_scalar.scalars(PlaneChoice::default()),
        Err(IoError::Volume(VolumeError::TupleSize { .. }))
    ));
}

fn archive(files: &[(&str, Vec<u8>)], stored: bool) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = zip::ZipWriter::new(&mut bytes);
    let method = if stored { zip::CompressionMethod::Stored } else { zip::CompressionMethod::Deflated };
    for (name, data) in files {
        writer.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        writer.write_all(data).unwrap();
    }
    writer.finish().unwrap();
    bytes.into_inner()
}

#[test]
fn archives_give_one_array_by_name() {
    let (a, b) = (array(&[2, 3, 2, 2]), array(&[4]));
    for stored in [true, false] {
        let both = archive(&[("a.npy", a.clone()), ("b.npy", b.clone()), ("readme", vec![1])], stored);
        assert_eq!(npy::array_of_archive(&both, Some("a")).unwrap(), ("a".to_owned(), a.clone()));
        assert_eq!(npy::array_of_archive(&both, Some("b.npy")).unwrap().1, b);
        let message = npy::array_of_archive(&both, None).unwrap_err().to_string();
        assert!(message.contains("`a`") && message.contains("`b`"), "{message}");
        let message = npy::array_of_archive(&both, Some("c")).unwrap_err().to_string();
        assert!(message.contains("no array `c`"), "{message}");
        let only = archive(&[("a.npy", a.clone())], stored);
        assert_eq!(npy::array_of_archive(&only, None).unwrap().0, "a");
        // Cut anywhere, the directory at the end is gone.
        for end in 0..only.len() {
            assert!(npy::array_of_archive(&only[..end], None).is_err(), "cut at {end}");
        }
    }
    assert!(npy::array_of_archive(&archive(&[], false), None).is_err());
}

/// A small archive that unpacks to much more than a file may hold does so only up to what it declares.
#[test]
fn archives_that_declare_too_much_are_refused() {
    let mut bytes = archive(&[("a.npy", vec![0; 1000])], false);
    // The uncompressed size stands at byte 24 of the entry in the central directory.
    let entry = bytes.windows(4).position(|w| w == b"PK\x01\x02").unwrap();
    bytes[entry + 24..entry + 28].copy_from_slice(&0x7fff_ffff_u32.to_le_bytes());
    let message = npy::array_of_archive(&bytes, None).unwrap_err().to_string();
    assert!(message.contains("2147483647 bytes"), "{message}");
}

fn png(colour: png::ColorType, depth: png::BitDepth, width: u32, height: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

#[test]
fn pictures_become_brightness() {
    use png::{BitDepth, ColorType};
    let brightness = |bytes: &[u8]| {
        let lattice = picture::read_png(bytes).unwrap();
        lattice.scalars(PlaneChoice::default()).unwrap().field.values().to_vec()
    };
    let grey = png(ColorType::Grayscale, BitDepth::Eight, 2, 2, &[0, 51, 102, 255]);
    assert_eq!(brightness(&grey), [0.0, 0.2, 0.4, 1.0]);
    let deep = png(ColorType::Grayscale, BitDepth::Sixteen, 1, 2, &[0xff, 0xff, 0, 0]);
    assert_eq!(brightness(&deep), [1.0, 0.0]);
    let bits = png(ColorType::Grayscale, BitDepth::One, 3, 1, &[0b1010_0000]);
    assert_eq!(brightness(&bits), [1.0, 0.0, 1.0]);
    let colours = png(ColorType::Rgb, BitDepth::Eight, 2, 1, &[255, 0, 0, 255, 255, 255]);
    let found = brightness(&colours);
    assert!((found[0] - 0.2126).abs() < 1e-12 && (found[1] - 1.0).abs() < 1e-12, "{found:?}");
    // What is transparent shows white.
    let clear = png(ColorType::Rgba, BitDepth::Eight, 3, 1, &[255, 0, 0, 51, 0, 0, 0, 0, 0, 0, 0, 255]);
    let found = brightness(&clear);
    assert!((found[0] - (0.2 * 0.2126 + 0.8)).abs() < 1e-12 && found[1..] == [1.0, 0.0], "{found:?}");
    let clear = png(ColorType::GrayscaleAlpha, BitDepth::Eight, 3, 1, &[0, 0, 0, 255, 0, 51]);
    assert_eq!(brightness(&clear), [1.0, 0.0, 0.8]);
    assert_eq!(picture::size_of_png(&clear).unwrap(), [3, 1]);
    assert!(picture::size_of_png(&clear[..20]).is_err());
    for end in 0..grey.len() - 12 {
        assert!(
            matches!(picture::read_png(&grey[..end]), Err(IoError::Picture(PictureError::Png { .. }))),
            "cut at {end}"
        );
    }
    // A header that declares more than there is.
    let mut lie = grey.clone();
    lie[16..20].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
    assert!(picture::read_png(&lie).is_err());
}

#[test]
fn transparent_pixels_hold_no_data() {
    use png::{BitDepth, ColorType};
    let read = |colour, data: &[u8]| {
        let lattice = picture::read_png(&png(colour, BitDepth::Eight, 3, 1, data)).unwrap();
        (lattice.mask, lattice.remarks)
    };
    assert_eq!(read(ColorType::Rgba, &[9, 9, 9, 255].repeat(3)), (None, Vec::new()));
    let said = |share: &str, words: &str| format!("{share} of 3 pixels are {words}");
    let clear = said("1", "transparent, taken as samples without data");
    let partly = said("1", "partly transparent, taken as seen in front of white");
    for (colour, data) in [
        (ColorType::Rgba, &[9, 9, 9, 0, 9, 9, 9, 51, 9, 9, 9, 255][..]),
        (ColorType::GrayscaleAlpha, &[9, 0, 9, 51, 9, 255]),
    ] {
        assert_eq!(read(colour, data), (Some(vec![0.0, 0.2, 1.0]), vec![clear.clone(), partly.clone()]));
    }
    // A colour that stands for nothing.
    let mut info = png::Info::with_size(3, 1);
    info.trns = Some(vec![0, 9].into());
    let mut bytes = Vec::new();
    png::Encoder::with_info(&mut bytes, info)
        .unwrap()
        .write_header()
        .unwrap()
        .write_image_data(&[9, 8, 9])
        .unwrap();
    let lattice = picture::read_png(&bytes).unwrap();
    assert_eq!(lattice.mask, Some(vec![0.0, 1.0, 0.0]));
}

/// Pixels are taken as stored, so that masks of the same pixels fit; EXIF data that would turn them are said.
#[test]
fn orientations_of_pictures_are_said() {
    let warnings = |orientation: u8| {
        let mut info = png::Info::with_size(2, 1);
        let exif = [
            b"MM\x00\x2a\x00\x00\x00\x08\x00\x01\x01\x12\x00\x03\x00\x00\x00\x01\x00",
            &[orientation, 0, 0][..],
        ];
        info.exif_metadata = Some(exif.concat().into());
        let mut bytes = Vec::new();
        let encoder = png::Encoder::with_info(&mut bytes, info).unwrap();
        encoder.write_header().unwrap().write_image_data(&[0, 255]).unwrap();
        let lattice = picture::read_png(&bytes).unwrap();
        assert_eq!(lattice.values, [0.0, 1.0]);
        lattice.warnings
    };
    assert!(warnings(1).is_empty() && warnings(0).is_empty());
    assert!(warnings(6)[0].contains("orientation 6"), "{:?}", warnings(6));
}
