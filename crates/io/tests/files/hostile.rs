//! Files that lie, end early or were changed at random are refused with a message.

use crate::support::{ARRAY, LZ4, ZLIB, bomb, declaring, nifti_file, npy_file, words};
use proptest::prelude::*;
use std::io::Write as _;
use tigereye_core::{Cell, Field, Grid, Tensor2};
use tigereye_io::volume::{
    Axis, Frame, PlaneChoice, Reading, image_from_volume, lattice_from_image, lattice_from_points,
    points_from_image,
};
use tigereye_io::{
    DataArray, DataError, ImageData, IoError, LimitError, Limits, Wanted, legacy, matrices, nifti, npy, nrrd,
    table, vti, vtp,
};

#[test]
fn a_small_file_with_many_points_is_refused_at_once() {
    for root in ["", ZLIB, LZ4] {
        let file = declaring(1_000_000_000_000, root, ARRAY, &words(&[8]));
        assert!(file.len() < 450);
        let result = vti::read(&file);
        let message = result.unwrap_err().to_string();
        assert!(message.contains("1000000000000 cells are declared, the limit is 268435456"), "{message}");
    }
}

/// Within the limit on cells, the bytes that are there decide.
#[test]
fn sizes_are_compared_with_the_bytes_there() {
    let points = 1 << 27;
    let bytes = 8 * points;
    let limits = Limits { cells: u64::MAX, values: u64::MAX };
    let payloads: [(&str, Vec<u8>); 8] = [
        ("", words(&[bytes])),
        ("", words(&[bytes + 8])),
        ("", words(&[u64::MAX])),
        (ZLIB, words(&[1, bytes, 0, 16, 0, 0])),
        (ZLIB, words(&[u64::MAX, bytes, 0, 16])),
        (ZLIB, words(&[2, u64::MAX, u64::MAX, u64::MAX, u64::MAX])),
        (ZLIB, words(&[bytes / 8, 8, 0, 1, 1, 1, 1, 1, 1])),
        (LZ4, words(&[1, bytes, 0, 16, 0, 0])),
    ];
    for (root, payload) in payloads {
        let file = declaring(points, root, ARRAY, &payload);
        let result = vti::read_with_limits(&file, limits);
        let message = result.unwrap_err().to_string();
        assert!(message.contains("array `a`") && message.starts_with("byte "), "{message}");
    }
    let file = declaring(u64::MAX / 2, "", ARRAY, &words(&[8]));
    let result = vti::read_with_limits(&file, limits);
    assert!(result.is_err());
}

#[test]
fn many_components_do_not_get_around_the_limits() {
    let array = ARRAY.replace("Name", "NumberOfComponents=\"65536\" Name");
    let message = vti::read(&declaring(1 << 20, "", &array, &words(&[8]))).unwrap_err().to_string();
    assert!(
        message.contains("array `a` brings the file to more than the limit of 268435456 values"),
        "{message}"
    );
    let file = declaring(4, "", &ARRAY.repeat(3), &words(&[32, 0, 0, 0, 0]));
    assert!(vti::read_with_limits(&file, Limits { cells: 4, values: 12 }).is_ok());
    let result = vti::read_with_limits(&file, Limits { cells: 4, values: 11 });
    assert!(matches!(result, Err(IoError::Limit(LimitError::Values { limit: 11, .. }))));
    assert!(matches!(
        vti::read_with_limits(&file, Limits { cells: 3, values: 12 }),
        Err(IoError::Limit(LimitError::Cells { cells: 4, limit: 3, .. }))
    ));
}

/// A block that expands to a thousand times its declared size is given up, not unpacked.
#[test]
fn bombs_stop_at_the_declared_size() {
    for (root, method) in [(ZLIB, "zlib"), (LZ4, "LZ4")] {
        let bomb = bomb(root, 5_000_000);
        let payload = [words(&[1, 800, 0, bomb.len() as u64]), bomb].concat();
        let file = declaring(100, root, ARRAY, &payload);
        let result = vti::read(&file);
        let message = result.unwrap_err().to_string();
        assert!(message.contains(&format!("block 0 is not {method} data of 800 bytes")), "{message}");
    }
}

/// The byte in the message is the byte in the file.
#[test]
fn messages_name_the_byte() {
    let file = declaring(2, "", ARRAY, &words(&[16, 0, 0])[..20]);
    let data = file.iter().position(|&b| b == b'_').unwrap();
    // `byte_order` and `header_type` hold underscores too.
    let data = data + file[data..].windows(2).position(|w| w == b">_").unwrap() + 2;
    let expected = format!("byte {data}: array `a` is truncated: expected 24 more bytes, found 20");
    assert_eq!(vti::read(&file).unwrap_err().to_string(), expected);
}

fn small_image() -> ImageData {
    let grid = Grid::new(3, 2).unwrap();
    let field = Field::from_fn(grid, |c| Tensor2::symmetric(c.x as f64, 0.5, c.y as f64));
    let mut image = crate::support::image_of(&field, [0.0; 2], [1.0; 2]);
    image.push_text("tigereye", "{}");
    image.cell_arrays.push(DataArray::new("cells", 1, vec![1.0, 2.0]));
    image
}

fn small_text_image() -> Vec<u8> {
    b"<VTKFile type=\"ImageData\" byte_order=\"BigEndian\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\
      <ImageData WholeExtent=\"0 1 0 0 0 0\"><FieldData><Array type=\"String\" Name=\"s\" format=\"ascii\">97 0</Array>\
      </FieldData><Piece Extent=\"0 1 0 0 0 0\"><PointData><DataArray type=\"Int16\" Name=\"a\" format=\"ascii\">1 2\
      </DataArray><DataArray type=\"Int8\" Name=\"b\" format=\"binary\">AAAAAQAAAAIAAAAAAAAACg==eJxjZAIAAAYABA==\
      </DataArray></PointData></Piece></ImageData></VTKFile>"
        .to_vec()
}

fn small_npy() -> Vec<u8> {
    npy::write_array(&[1, 2, 2, 2], &[1.0; 8]).unwrap()
}

#[test]
fn files_cut_anywhere_are_refused() {
    let image = vti::write(&small_image()).unwrap();
    let text = small_text_image();
    assert!(vti::read(&image).is_ok() && vti::read(&text).is_ok(), "{:?}", vti::read(&text));
    for file in [image, text] {
        for end in 0..file.trim_ascii_end().len() {
            assert!(vti::read(&file[..end]).is_err(), "cut at {end}");
        }
    }
    let array = small_npy();
    for end in 0..array.len() {
        assert!(npy::read_tensors(&array[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn lying_npy_headers_are_refused_at_once() {
    let shapes = [
        "(1000000, 1000000, 2, 2)",
        "(18446744073709551615, 18446744073709551615)",
        "(18446744073709551616,)",
        "(-1, 2)",
        "(2, 2)",
        "(0, 18446744073709551615, 18446744073709551615)",
        "((((((((((((((((1,),),),),),),),),),),),),),),)",
        "5",
    ];
    for shape in shapes {
        let dictionary = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        let result = npy::read_array(&npy_file(1, &dictionary, 16));
        let message = result.unwrap_err().to_string();
        assert!(message.starts_with("byte "), "{message}");
    }
    let message =
        npy::read_array(&npy_file(1, "{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}", 16));
    let expected = "byte 65: the header declares 24 bytes of data, expected the 16 that are there";
    assert_eq!(message.unwrap_err().to_string(), expected);
    let nested = format!("{{'descr': {}", "[".repeat(9_000));
    assert!(
        npy::read_array(&npy_file(2, &nested, 0))
            .unwrap_err()
            .to_string()
            .contains("byte 22: expected a string")
    );
    let long = " ".repeat(20_000);
    assert!(npy::read_array(&npy_file(2, &long, 0)).unwrap_err().to_string().contains("at most 10000 bytes"));
    let mut huge = npy_file(2, "{}", 0);
    huge[8..12].fill(0xff);
    assert!(npy::read_array(&huge).is_err());
}

/// A small number to the bytes of some type.
type Encoder = fn(u8) -> Vec<u8>;

#[test]
fn numpy_arrays_of_every_kind_are_read() {
    let read = |version, descr: &str, fortran: &str, data: &[u8]| {
        let text = format!("{{'shape': (2, 3), 'fortran_order': {fortran}, \"descr\": '{descr}'}}  \n");
        npy::read_array(&[npy_file(version, &text, 0), data.to_vec()].concat())
    };
    let cases: [(&str, Encoder); 9] = [
        ("|u1", |v| vec![v]),
        // Truth values are read as the bytes they are.
        ("|b1", |v| vec![v]),
        ("<i2", |v| u16::from(v).to_le_bytes().to_vec()),
        (">i4", |v| u32::from(v).to_be_bytes().to_vec()),
        (">u8", |v| u64::from(v).to_be_bytes().to_vec()),
        ("<f4", |v| f32::from(v).to_le_bytes().to_vec()),
        (">f4", |v| f32::from(v).to_be_bytes().to_vec()),
        ("<f8", |v| f64::from(v).to_le_bytes().to_vec()),
        (">f8", |v| f64::from(v).to_be_bytes().to_vec()),
    ];
    for (descr, bytes) in cases {
        for version in 1..=3 {
            let c: Vec<u8> = [0, 1, 2, 3, 4, 5].into_iter().flat_map(bytes).collect();
            let f: Vec<u8> = [0, 3, 1, 4, 2, 5].into_iter().flat_map(bytes).collect();
            for (order, data) in [("False", c), ("True", f)] {
                let array = read(version, descr, order, &data).unwrap_or_else(|e| panic!("{descr}: {e}"));
                assert_eq!((array.shape, array.values), (vec![2, 3], vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
            }
        }
    }
    for descr in ["<c16", "|O", "<f2", "<U4", "f8", "|f8", ""] {
        let message = read(1, descr, "False", &[0; 48]).unwrap_err().to_string();
        assert!(message.contains(&format!("element type `{descr}` is not read")), "{message}");
    }
    assert!(read(4, "<f8", "False", &[]).unwrap_err().to_string().starts_with("byte 6: expected version"));
}

#[test]
fn tensor_arrays_have_one_of_three_shapes() {
    let read = |shape: &[usize]| {
        let values: Vec<f64> = (0..shape.iter().product()).map(|i: usize| i as f64).collect();
        npy::read_tensors(&npy::write_array(shape, &values).unwrap())
    };
    let at = |shape: &[usize]| *read(shape).unwrap().at(Cell::new(1, 0));
    assert_eq!(at(&[1, 2, 2, 2]), Tensor2::new(4.0, 5.0, 6.0, 7.0));
    assert_eq!(at(&[1, 2, 4]), Tensor2::new(4.0, 5.0, 6.0, 7.0));
    assert_eq!(at(&[1, 2, 3]), Tensor2::symmetric(3.0, 4.0, 5.0));
    let message = read(&[2, 2, 3, 3]).unwrap_err().to_string();
    assert_eq!(message, "an array of shape [2, 2, 3, 3]: expected (H, W, 2, 2), (H, W, 4) or (H, W, 3)");
    assert!(matches!(read(&[0, 2, 2, 2]), Err(IoError::Core { .. })));
}

fn small_vtp() -> Vec<u8> {
    vtp::write(&points_from_image(small_image())).unwrap()
}

fn small_table() -> Vec<u8> {
    b"# x\ty\tu\tv\tflags\tmask\n0\t1\t.1\t2\t0\t0\n1\t1\t3\t4\t1\t0\n0\t0\tnan\tnan\t0\t1\n1\t0\t7\t8\t0\t0\n".to_vec()
}

/// Two far positions make no lattice of all the nodes between them.
#[test]
fn tables_of_vectors_take_no_more_than_their_lines() {
    let far: String = (0..1000).map(|i| format!("{i} {i} 1 2\n")).collect();
    let message = table::read_vectors(far.as_bytes()).unwrap_err().to_string();
    assert!(message.contains("1000 vectors on a lattice of 1000 x 1000 positions"), "{message}");
    assert_ne!(table::kind(far.as_bytes()), table::Kind::Positions);
    for text in ["0 0 1 2\n1e308 -1e308 1 2\n-1e308 1e308 1 2\n", "x y u v\n1 2\n"] {
        let _ = table::kind(text.as_bytes());
        assert!(table::read_vectors(text.as_bytes()).is_err(), "{text}");
    }
}

fn small_volumes() -> [Vec<u8>; 3] {
    let tensors = "1 2 3 4 5 6 ".repeat(4);
    let nrrd = format!(
        "NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 6 2 2 1\n\
         space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: 3D-symmetric-matrix space space space\n\
         encoding: ascii\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n\n{tensors}"
    );
    let vtk = format!(
        "# vtk DataFile Version 4.2\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\nORIGIN 0 0 0\n\
         SPACING 1 1 1\nPOINT_DATA 4\nTENSORS6 t float\n{tensors}\nFIELD f 1\na 1 4 int\n1 2 3 4\n"
    );
    [nrrd.into_bytes(), nifti_file(false, &[2, 2, 1, 1, 6], 16, 32, 1005, 3.0, &[1; 96]), vtk.into_bytes()]
}

/// Whatever an NRRD or NIfTI file loses at its end, it is refused.
#[test]
fn cut_volumes_are_refused() {
    let [nrrd_file, nifti_file, _] = small_volumes();
    let words = nrrd_file.trim_ascii_end().len();
    for end in 0..words {
        assert!(nrrd::read(&nrrd_file[..end], None).is_err(), "cut at {end}");
    }
    for end in 0..nifti_file.len() {
        assert!(nifti::read(&nifti_file[..end]).is_err(), "cut at {end}");
    }
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(&nifti_file).unwrap();
    let packed = encoder.finish().unwrap();
    for end in 0..packed.len() - 8 {
        let cut = nifti::read(&packed[..end]);
        // The last bytes of a gzip stream are its checksum; the numbers may be complete before.
        assert!(cut.is_err() || end + 16 > packed.len(), "cut at {end}");
    }
}

/// Four hundred bytes that declare more than there can be. What would be allocated for them, `memory.rs` measures.
#[test]
fn small_volumes_with_many_voxels_are_refused() {
    let limits = Limits { cells: u64::MAX, values: u64::MAX };
    for size in [
        "10000 10000 10000",
        "99999999999 99999999999 99999999999",
        "18446744073709551615 1 1",
        "1000 1000 1000",
    ] {
        for rest in
            ["raw\nendian: little", "gzip\nendian: big", "ascii", "raw\nendian: little\nbyte skip: -1"]
        {
            let file = format!(
                "NRRD0004\ntype: double\ndimension: 4\nsizes: 9 {size}\nkinds: 3D-matrix space space space\nencoding: {rest}\n\n1"
            );
            assert!(nrrd::read(file.as_bytes(), None).is_err(), "{size} {rest}");
            assert!(
                nrrd::read_with_limits(file.as_bytes(), None, Wanted::Tensors, limits).is_err(),
                "{size} {rest}"
            );
        }
        for encoding in ["ASCII", "BINARY"] {
            let points = if size.len() < 20 { "1000000000000" } else { "1" };
            let file = format!(
                "# vtk DataFile Version 3.0\n\n{encoding}\nDATASET STRUCTURED_POINTS\nDIMENSIONS {size}\n\
                 POINT_DATA {points}\nTENSORS t double\n1 2 3"
            );
            assert!(legacy::read(file.as_bytes()).is_err(), "{size}");
            assert!(legacy::read_with_limits(file.as_bytes(), limits).is_err(), "{size}");
        }
    }
    let nifti_large = nifti_file(false, &[32767, 32767, 32767, 6], 64, 64, 0, 0.0, &[0; 40]);
    let message = nifti::read(&nifti_large).unwrap_err().to_string();
    assert!(message.contains("cells are declared, the limit is"), "{message}");
    assert!(matches!(
        nifti::read_with_limits(&nifti_large, limits),
        Err(IoError::Data(DataError::Truncated { .. }))
    ));
}

/// Headers that ask for files elsewhere, or for what is not read.
#[test]
fn nrrd_fields_that_are_not_read_are_named() {
    let header = |rest: &str| {
        let file = format!(
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 1 1\nkinds: 2D-symmetric-matrix domain domain\n{rest}\n\n1 2 3\n"
        );
        nrrd::read(file.as_bytes(), None).map(drop).map_err(|e| e.to_string())
    };
    assert_eq!(header("encoding: ascii"), Ok(()));
    for (rest, words) in [
        ("", "line 6: NRRD field `encoding`: found ``"),
        ("encoding: bzip2", "line 6: NRRD field `encoding`: found `bzip2`, expected raw, gzip or ascii"),
        ("encoding: raw", "`endian`"),
        ("encoding: ascii\ndata file: /etc/passwd", "in the folder"),
        ("encoding: ascii\ndata file: ../x.raw", "in the folder"),
        ("encoding: ascii\ndata file: LIST", "one file"),
        ("encoding: ascii\ndata file: x%03d.raw 1 3 1", "one file"),
        ("encoding: ascii\nspace directions: (1,0", "vectors"),
        ("encoding: ascii\nspace directions: none (1,0,0)", "every axis"),
        ("encoding: ascii\nspace directions: none (1,inf,0) none", "vectors"),
        ("encoding: ascii\nmeasurement frame: (1,0,0)", "every axis of the space"),
        ("encoding: ascii\nbyte skip: -1", "byte skip"),
        ("encoding: ascii\nline skip: 1000000000000", "line skip"),
        ("encoding: ascii\nno colon", "line 7"),
    ] {
        let message = header(rest).unwrap_err();
        assert!(message.contains(words), "{rest}: {message}");
    }
}

/// Reads bytes as everything; only panics matter.
fn read_as_everything(bytes: &[u8]) {
    let limits = Limits { cells: 1 << 16, values: 1 << 20 };
    let volumes = [
        nrrd::read_with_limits(bytes, Some(bytes), Wanted::Tensors, limits),
        nifti::read_with_limits(bytes, limits),
        legacy::read_with_limits(bytes, limits)
            .and_then(|image| lattice_from_image(&image, None, Wanted::Tensors)),
        vti::read(bytes).and_then(|image| lattice_from_image(&image, None, Wanted::Tensors)),
        vtp::read_with_limits(bytes, limits)
            .and_then(|data| lattice_from_points(data, None, Wanted::Tensors)),
    ];
    let _ = table::kind(bytes);
    if let Ok(lattice) = table::read_vectors(bytes) {
        assert_eq!(lattice.values.len(), 2 * lattice.voxels());
        let _ = (lattice.vectors(PlaneChoice::default(), None), lattice.story());
    }
    let _ = (matrices::read_lattice(bytes), table::read_numbers(bytes));
    let columns = table::read_columns(bytes, None.into(), Wanted::Tensors);
    let volumes = volumes.into_iter().chain([columns]);
    for lattice in volumes.into_iter().flatten() {
        if let Ok(volume) = lattice.tensors(Reading::default()) {
            let choice = PlaneChoice { plane: None, slice: Some((Axis::Z, 0)) };
            let _ = (volume.slice(choice), volume.story(), volume.suspicion());
            if let Ok(image) = image_from_volume(&volume, Frame::World) {
                let _ = (legacy::write(&image, ""), vtp::write(&points_from_image(image)));
            }
            let _ = (
                nrrd::write(&volume, Frame::World, ""),
                nifti::write(&volume, nifti::WrittenAs::Matrices, ""),
            );
        }
    }
    if let Ok(image) = &vti::read(bytes) {
        let _ = (crate::support::field_of(image, None), tigereye_io::ltg_from_image(image));
        let _ = vti::write(image);
    }
    let _ = (npy::read_tensors(bytes), npy::read_array(bytes), matrices::read(bytes));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn changed_files_never_panic(which in 0..8_usize,
                                 changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..6)) {
        let [nrrd, nifti, vtk] = small_volumes();
        let images = [vti::write(&small_image()).unwrap(), small_text_image(), small_npy(), nrrd, nifti, vtk, small_vtp(), small_table()];
        let mut file = images[which].clone();
        for (at, byte, kind) in changes {
            let at = at.index(file.len());
            match kind {
                0 => file[at] = byte,
                1 => file[at] ^= 1 << (byte % 8),
                2 => { file.remove(at); }
                _ => file.insert(at, b"0123456789-\"<>&_="[usize::from(byte) % 17]),
            }
        }
        read_as_everything(&file);
    }

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        read_as_everything(&bytes);
    }

    #[test]
    fn random_text_never_panics(text in "[0-9 .eE+\n\r-]{0,80}") {
        read_as_everything(text.as_bytes());
    }

    #[test]
    fn random_tables_never_panic(text in "(# |VARIABLES=)?[xyuv\", ;\t]{0,12}\n([0-3nae.;,\t -]{0,12}\n){0,9}") {
        read_as_everything(text.as_bytes());
    }
}
