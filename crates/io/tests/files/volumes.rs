//! Volumes in every encoding and kind, built here; slices and frames.

use crate::support::nifti_file;
use std::io::Write as _;
use tigereye_core::{Cell, Tensor2};
use tigereye_io::nifti::NiftiError;
use tigereye_io::volume::{
    Axis, Crop, Frame, Known, Lattice, Overlay, Plane, PlaneChoice, PlaneError, Reading, TensorOrder,
    TensorVolume, VolumeError, World, image_from_volume, lattice_from_image,
};
use tigereye_io::{IoError, ScalarType, Wanted, legacy, nifti, nrrd, vti};

const VOXELS: usize = 2 * 3 * 4;

/// Tuples whose numbers tell voxel and component.
fn numbers(components: usize) -> Vec<f64> {
    (0..VOXELS * components).map(|i| (i / components * 10 + i % components) as f64).collect()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn big_endian(bytes: &[u8], width: usize) -> Vec<u8> {
    bytes.chunks(width).flat_map(|c| c.iter().rev().copied().collect::<Vec<_>>()).collect()
}

fn nrrd_header(kind: &str, size: usize, rest: &str) -> String {
    format!(
        "NRRD0004\n# made here\ntype: double\ndimension: 4\nsizes: {size} 2 3 4\nkinds: {kind} space space space\nkey:=value\n{rest}\n\n"
    )
}

#[test]
fn nrrd_encodings_give_the_same_numbers() {
    let values = numbers(6);
    let raw = ScalarType::Float64.encode(&values);
    let text: String = values.iter().map(|v| format!("{v} ")).collect();
    let kind = "3D-symmetric-matrix";
    for (rest, data) in [
        ("encoding: raw\nendian: little", raw.clone()),
        ("encoding: raw\nendian: big", big_endian(&raw, 8)),
        ("encoding: gzip\nendian: little", gzip(&raw)),
        ("encoding: gz\nendian: big", gzip(&big_endian(&raw, 8))),
        ("encoding: ascii", text.clone().into_bytes()),
        ("encoding: raw\nendian: little\nbyte skip: 3", [b"abc", &raw[..]].concat()),
        ("encoding: raw\nendian: little\nbyte skip: -1", [b"some words", &raw[..]].concat()),
        ("encoding: raw\nendian: little\nline skip: 2", [b"one\ntwo\n", &raw[..]].concat()),
    ] {
        let header = nrrd_header(kind, 6, rest);
        let lattice = nrrd::read(&[header.as_bytes(), &data].concat(), None).unwrap();
        assert_eq!((lattice.size, lattice.components), ([2, 3, 4], 6));
        assert_eq!(lattice.values, values, "{rest}");
        assert_eq!(lattice.order, Some((TensorOrder::UPPER, Known::Stated)));
        let detached = nrrd_header(kind, 6, &format!("{rest}\ndata file: volume.raw"));
        assert_eq!(
            nrrd::data_file(detached.as_bytes(), tigereye_io::Limits::default()).unwrap().as_deref(),
            Some("volume.raw")
        );
        assert_eq!(nrrd::read(detached.as_bytes(), Some(&data)).unwrap().values, values, "{rest}");
        assert!(nrrd::read(detached.as_bytes(), None).is_err());
    }
}

#[test]
fn nrrd_kinds_have_their_orders_and_masks() {
    for (kind, size, order, masked) in [
        ("2D-symmetric-matrix", 3, "xx,xy,yy", false),
        ("2D-masked-symmetric-matrix", 4, "xx,xy,yy", true),
        ("2D-matrix", 4, "xx,xy,yx,yy", false),
        ("2D-masked-matrix", 5, "xx,xy,yx,yy", true),
        ("3D-symmetric-matrix", 6, "xx,xy,xz,yy,yz,zz", false),
        ("3D-masked-symmetric-matrix", 7, "xx,xy,xz,yy,yz,zz", true),
        ("3D-matrix", 9, "xx,xy,xz,yx,yy,yz,zx,zy,zz", false),
        ("3D-masked-matrix", 10, "xx,xy,xz,yx,yy,yz,zx,zy,zz", true),
    ] {
        let raw = ScalarType::Float64.encode(&numbers(size));
        let header = nrrd_header(kind, size, "encoding: raw\nendian: little");
        let lattice = nrrd::read(&[header.as_bytes(), &raw].concat(), None).unwrap();
        assert_eq!(lattice.order.map(|o| o.0.to_string()).as_deref(), Some(order), "{kind}");
        let skip = usize::from(masked);
        let expected: Vec<f64> = numbers(size).chunks(size).flat_map(|t| t[skip..].to_vec()).collect();
        assert_eq!(lattice.values, expected, "{kind}");
        let mask: Vec<f64> = numbers(size).chunks(size).map(|t| t[0]).collect();
        assert_eq!(lattice.mask, masked.then_some(mask), "{kind}");
        let volume = lattice.tensors(Reading::default()).unwrap();
        assert_eq!(volume.masked_out(), skip);
        let wrong = nrrd_header(kind, size + 1, "encoding: ascii");
        assert!(nrrd::read(wrong.as_bytes(), None).unwrap_err().to_string().contains("kinds"), "{kind}");
    }
}

/// The tensor's axis may be the slowest.
#[test]
fn nrrd_tensor_axes_may_be_anywhere() {
    let header = "NRRD0004\ntype: int\ndimension: 3\nsizes: 2 3 3\nkinds: space space 2D-symmetric-matrix\nencoding: text\n\n";
    let text: String = (0..18).map(|i| format!("{i}\n")).collect();
    let lattice = nrrd::read(&[header, &text].concat().into_bytes(), None).unwrap();
    assert_eq!(lattice.size, [2, 3, 1]);
    assert_eq!(lattice.values[..6], [0.0, 6.0, 12.0, 1.0, 7.0, 13.0]);
}

fn nrrd_one_voxel(rest: &str) -> Lattice {
    let head = "NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 6 1 1 1\n\
                kinds: 3D-symmetric-matrix space space space\nencoding: ascii\n";
    nrrd::read(format!("{head}{rest}\n\n1 2 3 4 5 6\n").as_bytes(), None).unwrap()
}

/// A quarter turn about z as measurement frame: D_world = M D M^T.
#[test]
fn measurement_frames_turn_tensors() {
    let lattice = nrrd_one_voxel(
        "space directions: none (2,0,0) (0,2,0) (0,0,2)\nspace origin: (5,6,7)\n\
         measurement frame: (0,1,0) (-1,0,0) (0,0,1)",
    );
    assert_eq!((lattice.spacing(), lattice.origin), ([2.0; 3], [5.0, 6.0, 7.0]));
    let slice = |frame| {
        let volume = lattice.clone().tensors(Reading { frame, ..Reading::default() }).unwrap();
        *volume.slice(PlaneChoice::default()).unwrap().field.at(Cell::new(0, 0))
    };
    // D = [[1, 2], [2, 4]] with x of the frame pointing to y and y to -x.
    assert_eq!(slice(None), Tensor2::symmetric(4.0, -2.0, 1.0));
    assert_eq!(slice(Some(Frame::World)), Tensor2::symmetric(1.0, 2.0, 4.0));
    assert_eq!(slice(Some(Frame::Voxel)), Tensor2::symmetric(1.0, 2.0, 4.0));
    let turned = nrrd_one_voxel("space directions: none (0,1,0) (-1,0,0) (0,0,1)");
    assert_eq!(turned.frame, (Frame::World, Known::Assumed));
    let slice = |frame| {
        let volume = turned.clone().tensors(Reading { frame, ..Reading::default() }).unwrap();
        *volume.slice(PlaneChoice::default()).unwrap().field.at(Cell::new(0, 0))
    };
    // The picture has x of the world to the right, whichever voxel axis points there.
    assert_eq!(slice(None), Tensor2::symmetric(1.0, 2.0, 4.0));
    // Voxel axis x points up, and y to the left.
    assert_eq!(slice(Some(Frame::Voxel)), Tensor2::symmetric(4.0, -2.0, 1.0));
    let none = nrrd_one_voxel("").tensors(Reading { frame: Some(Frame::Measurement), ..Reading::default() });
    assert_eq!(none.unwrap_err(), VolumeError::NoMeasurementFrame);
    let skewed = nrrd_one_voxel("space directions: none (1,0,0) (0.5,1,0) (0,0,1)");
    let volume = skewed.tensors(Reading::default()).unwrap();
    assert!(matches!(
        volume.slice(PlaneChoice::default()),
        Err(IoError::Volume(VolumeError::SkewedAxes { .. }))
    ));
}

#[test]
fn nifti_types_and_byte_orders_give_the_same_numbers() {
    let types = [
        (2, ScalarType::UInt8),
        (4, ScalarType::Int16),
        (8, ScalarType::Int32),
        (16, ScalarType::Float32),
        (64, ScalarType::Float64),
        (256, ScalarType::Int8),
        (512, ScalarType::UInt16),
        (768, ScalarType::UInt32),
        (1024, ScalarType::Int64),
        (1280, ScalarType::UInt64),
    ];
    for (code, scalar) in types {
        let stored: Vec<f64> = (0..12).map(f64::from).collect();
        let data = scalar.encode(&stored);
        for big in [false, true] {
            let data = if big { big_endian(&data, scalar.bytes()) } else { data.clone() };
            let file = nifti_file(big, &[2, 1, 1, 6], code, 8 * scalar.bytes() as i16, 0, 0.0, &data);
            for bytes in [file.clone(), gzip(&file)] {
                let lattice = nifti::read(&bytes).unwrap();
                assert_eq!((lattice.size, lattice.components, lattice.scalar), ([2, 1, 1], 6, scalar));
                let expected = [0., 2., 4., 6., 8., 10., 1., 3., 5., 7., 9., 11.];
                assert_eq!(lattice.values, expected, "{scalar:?}, big endian {big}");
                assert_eq!(lattice.order, Some((TensorOrder::LOWER, Known::Assumed)));
            }
        }
    }
}

#[test]
fn nifti_intents_state_the_order() {
    let data = vec![0; 4 * 9];
    let order = |shape: &[i16], intent, p1| {
        nifti::read(&nifti_file(false, shape, 16, 32, intent, p1, &data)).map(|l| l.order)
    };
    assert_eq!(order(&[1, 1, 1, 1, 6], 1005, 3.0), Ok(Some((TensorOrder::LOWER, Known::Stated))));
    assert_eq!(order(&[1, 1, 1, 1, 3], 1005, 2.0), Ok(Some((TensorOrder::UPPER2, Known::Stated))));
    assert_eq!(order(&[1, 1, 1, 1, 9], 1004, 3.0), Ok(Some((TensorOrder::ROWS3, Known::Stated))));
    assert_eq!(order(&[1, 1, 1, 1, 6], 0, 0.0), Ok(Some((TensorOrder::LOWER, Known::Assumed))));
    // ITK leaves the size out, and writes images of six-vectors in the order it has them in memory.
    assert_eq!(order(&[1, 1, 1, 1, 6], 1005, 0.0), Ok(Some((TensorOrder::LOWER, Known::Stated))));
    assert_eq!(order(&[1, 1, 1, 1, 9], 1004, 0.0), Ok(Some((TensorOrder::ROWS3, Known::Stated))));
    assert_eq!(order(&[1, 1, 1, 1, 6], 1007, 0.0), Ok(Some((TensorOrder::UPPER, Known::Assumed))));
    for (shape, intent, p1) in [
        (&[1, 1, 1, 1, 6][..], 1005, 2.0),
        (&[1, 1, 1, 1, 6], 1005, 7.0),
        (&[1, 1, 1, 6], 1005, 3.0),
        (&[1, 1, 1, 2, 3], 0, 0.0),
        (&[1, 1, 1, 1, 1, 6], 0, 0.0),
    ] {
        assert!(
            matches!(order(shape, intent, p1), Err(IoError::Nifti(NiftiError::Field { .. }))),
            "{shape:?} {intent}"
        );
    }
}

#[test]
fn nifti_scaling_and_position_are_applied() {
    let mut file =
        nifti_file(false, &[1, 1, 1, 6], 4, 16, 0, 0.0, &ScalarType::Int16.encode(&[1., 2., 3., 4., 5., 6.]));
    file[112..116].copy_from_slice(&0.5_f32.to_le_bytes());
    file[116..120].copy_from_slice(&10_f32.to_le_bytes());
    assert_eq!(nifti::read(&file).unwrap().values, [10.5, 11.0, 11.5, 12.0, 12.5, 13.0]);
    for (i, v) in [2_f32, 3.0, 4.0].iter().enumerate() {
        file[80 + 4 * i..84 + 4 * i].copy_from_slice(&v.to_le_bytes());
    }
    assert_eq!(nifti::read(&file).unwrap().axes, [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]);
    // A qform: half a turn about z, third axis reversed.
    file[252..254].copy_from_slice(&1_i16.to_le_bytes());
    file[76..80].copy_from_slice(&(-1_f32).to_le_bytes());
    file[264..268].copy_from_slice(&1_f32.to_le_bytes());
    assert_eq!(nifti::read(&file).unwrap().axes, [[-2.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, -4.0]]);
    file[254..256].copy_from_slice(&1_i16.to_le_bytes());
    for (i, v) in [0_f32, 0.0, 5.0, 7.0, 6.0, 0.0, 0.0, 8.0, 0.0, 4.0, 0.0, 9.0].iter().enumerate() {
        file[280 + 4 * i..284 + 4 * i].copy_from_slice(&v.to_le_bytes());
    }
    let lattice = nifti::read(&file).unwrap();
    assert_eq!(lattice.axes, [[0.0, 6.0, 0.0], [0.0, 0.0, 4.0], [5.0, 0.0, 0.0]]);
    assert_eq!(lattice.origin, [7.0, 8.0, 9.0]);
}

#[test]
fn nifti_of_other_kinds_is_refused_by_name() {
    let file = nifti_file(false, &[1, 1, 1, 6], 16, 32, 0, 0.0, &[0; 24]);
    let changed = |at: usize, bytes: &[u8]| {
        let mut file = file.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        nifti::read(&file).unwrap_err().to_string()
    };
    assert!(changed(0, &540_i32.to_le_bytes()).contains("NIfTI-2"));
    assert!(changed(344, b"ni1\0").contains("magic"));
    assert!(changed(70, &32_i16.to_le_bytes()).contains("datatype"));
    assert!(changed(72, &64_i16.to_le_bytes()).contains("bitpix"));
    assert!(changed(40, &9_i16.to_le_bytes()).contains("dim[0]"));
    assert!(changed(44, &(-3_i16).to_le_bytes()).contains("dim[2]"));
    for offset in [0_f32, 351.0, 352.5, f32::NAN, f32::INFINITY, -1.0, 1e30] {
        assert!(changed(108, &offset.to_le_bytes()).contains("vox_offset"));
    }
    assert!(changed(108, &400_f32.to_le_bytes()).contains("truncated"));
}

const GRID: &str = "DATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\nORIGIN 1 2 3\nSPACING 4 5 6\nPOINT_DATA 2\n";

fn legacy_text(body: &str) -> Vec<u8> {
    format!("# vtk DataFile Version 3.0\na title\nASCII\n{body}").into_bytes()
}

#[test]
fn legacy_attributes_are_read_by_name() {
    let body = format!(
        "{GRID}SCALARS s%20t float 1\nLOOKUP_TABLE default\n1 2\nLOOKUP_TABLE colours 1\n0 0 0 1\n\
         VECTORS v double\n1 2 3 4 5 6\nMETADATA\nINFORMATION 0\n\nTENSORS6 six float\n1 2 3 4 5 6\n7 8 9 10 11 12\n\
         FIELD FieldData 2\nnine 9 2 double\n0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17\nids 1 2 vtkIdType\n8 9\n"
    );
    let image = legacy::read(&legacy_text(&body)).unwrap();
    assert_eq!((image.origin, image.spacing), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]));
    let names: Vec<_> = image.point_arrays.iter().map(|a| (a.name.as_str(), a.components)).collect();
    assert_eq!(names, [("s t", 1), ("v", 3), ("six", 6), ("nine", 9), ("ids", 1)]);
    let six = lattice_from_image(&image, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap();
    assert_eq!(six.stored(1), [7.0, 10.0, 12.0, 10.0, 8.0, 11.0, 12.0, 11.0, 9.0]);
    let nine = lattice_from_image(&image, Some("nine"), Wanted::Tensors)
        .unwrap()
        .tensors(Reading::default())
        .unwrap();
    assert_eq!(nine.stored(1), [9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0]);
}

#[test]
fn legacy_binary_is_big_endian() {
    let values: Vec<f64> = (0..18).map(f64::from).collect();
    let head = format!("# vtk DataFile Version 5.1\n\nBINARY\n{GRID}TENSORS t double\n");
    let data = big_endian(&ScalarType::Float64.encode(&values), 8);
    let file = [head.as_bytes(), &data, b"\nMETADATA\nINFORMATION 0\n\n"].concat();
    assert_eq!(legacy::read(&file).unwrap().point_arrays[0].values, values);
    for end in 0..head.len() + data.len() {
        // A file that ends before its attributes is a data set without any.
        let read = legacy::read(&file[..end]);
        assert!(read.is_err() || read.is_ok_and(|i| i.point_arrays.is_empty()), "cut at {end}");
    }
}

#[test]
fn legacy_grids_must_be_lattices() {
    let tensors = format!("POINT_DATA 4\nTENSORS t float\n{}", "1 0 0 0 1 0 0 0 1\n".repeat(4));
    let grid = |points: &str| {
        let body = format!("DATASET STRUCTURED_GRID\nDIMENSIONS 2 2 1\nPOINTS 4 float\n{points}\n{tensors}");
        legacy::read(&legacy_text(&body))
    };
    let image = grid("0 0 5 2 0 5 0 3 5 2 3 5").unwrap();
    assert_eq!((image.origin, image.spacing), ([0.0, 0.0, 5.0], [2.0, 3.0, 1.0]));
    assert_eq!(image.direction, None);
    let turned = grid("0 0 0 0 2 0 -3 0 0 -3 2 0").unwrap();
    assert_eq!(turned.direction, Some([0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]));
    let fault = grid("0 0 0 2 0 0 0 3 0 2 3.5 0").unwrap_err();
    assert!(matches!(fault, IoError::Volume(VolumeError::NoLattice { .. })), "{fault}");
    assert!(matches!(grid("0 0 0 0 0 0 0 3 0 0 3 0"), Err(IoError::Volume(VolumeError::NoLattice { .. }))));
    let rectilinear = |y: &str| {
        let body = format!(
            "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 1\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 2 float\n{y}\n\
             Z_COORDINATES 1 float\n7\n{tensors}"
        );
        legacy::read(&legacy_text(&body))
    };
    assert_eq!(rectilinear("1 -2").unwrap().spacing, [1.0, -3.0, 1.0]);
    assert!(matches!(rectilinear("1 1"), Err(IoError::Volume(VolumeError::NoLattice { .. }))));
}

#[test]
fn legacy_faults_name_the_byte() {
    for (body, words) in [
        ("DATASET POLYDATA\n", "byte 49: found `POLYDATA`, expected DATASET STRUCTURED_POINTS"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 2 0 1\n", "three positive integers"),
        ("DATASET STRUCTURED_POINTS\nORIGIN 0 0 0\nPOINT_DATA 1\n", "expected DIMENSIONS"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nPOINT_DATA 2\n", "number of points"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nPOINT_DATA 1\nTENSORS t float\n1 2 x\n", "`x`"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nPOINT_DATA 1\nTENSORS t bits\n1\n", "number type"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nPOINT_DATA 1\nTENSORS t float\n1 2\n", "found ``"),
        ("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nTENSORS t float\n1 2\n", "POINT_DATA"),
    ] {
        let message = legacy::read(&legacy_text(body)).unwrap_err().to_string();
        assert!(message.starts_with("byte ") && message.contains(words), "{message}");
    }
    let version = legacy::read(b"# vtk DataFile Version 9.0\n\nASCII\n").unwrap_err().to_string();
    assert!(version.contains("5.1"), "{version}");
}

/// A volume of nine components in the voxel frame; xx counts voxels, the others 100 and up.
fn volume() -> TensorVolume {
    let values = (0..VOXELS).flat_map(|v| {
        let mut t = [0.0, 101., 102., 103., 104., 105., 106., 107., 108.];
        t[0] = v as f64;
        t
    });
    let lattice = Lattice {
        size: [2, 3, 4],
        components: 9,
        values: values.collect(),
        scalar: ScalarType::Float64,
        axes: [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]],
        origin: [10.0, 20.0, 30.0],
        unit: None,
        world: World::Viewer,
        measurement: None,
        mask: None,
        order: Some((TensorOrder::ROWS3, Known::Stated)),
        frame: (Frame::World, Known::Stated),
        array: "t".to_owned(),
        component_names: Vec::new(),
        notes: Vec::new(),
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    };
    lattice.tensors(Reading::default()).unwrap()
}

#[test]
fn slices_show_the_last_voxel_on_top() {
    let volume = volume();
    let slice = |plane, index| {
        volume.slice(PlaneChoice { plane: None, slice: Some((Plane::normal(plane), index)) }).unwrap()
    };
    let xy = slice(Plane::Xy, 1);
    assert_eq!((xy.field.grid().width(), xy.field.grid().height()), (2, 3));
    assert_eq!(*xy.field.at(Cell::new(1, 0)), Tensor2::new(11.0, 101.0, 103.0, 104.0));
    let lies = xy.cut.geometry;
    assert_eq!((lies.corner(), lies.spacing()), ([10.0, 20.0, 33.0], [1.0, 2.0]));
    let xz = slice(Plane::Xz, 2);
    assert_eq!(*xz.field.at(Cell::new(0, 3)), Tensor2::new(4.0, 102.0, 106.0, 108.0));
    let yz = slice(Plane::Yz, 1);
    assert_eq!(*yz.field.at(Cell::new(2, 0)), Tensor2::new(104.0, 105.0, 107.0, 108.0));
    assert_eq!(yz.cut.geometry.corner(), [11.0, 20.0, 30.0]);
    assert_eq!((yz.cut.geometry.right(), yz.cut.geometry.up()), ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
}

#[test]
fn planes_that_do_not_fit_are_refused() {
    let volume = volume();
    let choose = |plane, slice| volume.slice(PlaneChoice { plane, slice }).map(|s| s.cut.plane);
    assert_eq!(choose(None, None), Err(IoError::Plane(PlaneError::Needed { size: [2, 3, 4] })));
    assert!(matches!(
        choose(Some(Plane::Xy), None),
        Err(IoError::Plane(PlaneError::SliceNeeded { last: 3, .. }))
    ));
    assert!(matches!(
        choose(Some(Plane::Xy), Some((Axis::X, 0))),
        Err(IoError::Plane(PlaneError::Conflict { .. }))
    ));
    assert!(matches!(
        choose(None, Some((Axis::X, 2))),
        Err(IoError::Plane(PlaneError::SliceRange { last: 1, .. }))
    ));
    assert_eq!(choose(Some(Plane::Xz), Some((Axis::Y, 2))), Ok(Plane::Xz));
    let flat = [([5, 1, 4], Plane::Xz), ([1, 5, 4], Plane::Yz), ([5, 1, 1], Plane::Xy)];
    for (size, plane) in flat {
        assert_eq!(PlaneChoice::default().resolve(size), Ok((plane, 0)));
    }
}

#[test]
fn crops_count_from_the_top_left() {
    let field = volume().slice(PlaneChoice { plane: None, slice: Some((Axis::Z, 0)) }).unwrap().field;
    let part = Crop { x: [1, 2], y: [0, 2] }.of(&field).unwrap();
    assert_eq!((part.grid().width(), part.grid().height()), (1, 2));
    assert_eq!(part.at(Cell::new(0, 0)), field.at(Cell::new(1, 0)));
    for (x, y) in [([0, 3], [0, 1]), ([1, 1], [0, 1]), ([2, 1], [0, 1]), ([0, 1], [0, 4])] {
        assert!(matches!(Crop { x, y }.of(&field), Err(IoError::Plane(PlaneError::CropRange { .. }))));
    }
}

#[test]
fn written_volumes_come_back() {
    let volume = volume();
    for frame in [Frame::World, Frame::Voxel] {
        let image = image_from_volume(&volume, frame).unwrap();
        let read = vti::read(&vti::write(&image).unwrap()).unwrap();
        let back =
            lattice_from_image(&read, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap();
        assert_eq!(back.tensors().collect::<Vec<_>>(), volume.tensors().collect::<Vec<_>>());
    }
    let turned = nrrd_one_voxel("space directions: none (0,1,0) (-1,0,0) (0,0,1)")
        .tensors(Reading::default())
        .unwrap();
    let image = image_from_volume(&turned, Frame::World).unwrap();
    let back =
        lattice_from_image(&image, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap();
    let slice = |v: &TensorVolume| v.slice(PlaneChoice::default()).unwrap().field;
    assert_eq!(slice(&back), slice(&turned));
}

fn scalars(size: [usize; 3], axes: [[f64; 3]; 3], origin: [f64; 3], world: &str) -> Lattice {
    let voxels: usize = size.iter().product();
    Lattice {
        size,
        components: 1,
        values: (0..voxels).map(|v| v as f64).collect(),
        scalar: ScalarType::Float64,
        axes,
        origin,
        unit: None,
        world: if world.is_empty() { World::Viewer } else { World::Scanner(world.to_owned()) },
        measurement: None,
        mask: None,
        order: None,
        frame: (Frame::World, Known::Stated),
        array: "m".to_owned(),
        component_names: Vec::new(),
        notes: Vec::new(),
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    }
}

const STEPS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];

/// What a mask says belongs to a place, not to an index.
#[test]
fn masks_follow_their_axes() {
    let size = [2, 3, 1];
    let down = [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 3.0]];
    let masked = |own: Lattice, mask: Lattice| {
        let mut own = own;
        let overlay = own.mask_by(&mask).unwrap();
        (own.mask.unwrap(), overlay != Overlay::Coincident)
    };
    let plain = vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let turned = vec![4.0, 5.0, 2.0, 3.0, 0.0, 1.0];
    let viewer = |axes| scalars(size, axes, [0.0; 3], "");
    assert_eq!(masked(viewer(STEPS), viewer(STEPS)), (plain.clone(), false));
    // From its first voxel at the top, 2 (3 - 1) up, the same place.
    let from_above = || scalars(size, down, [0.0, 4.0, 0.0], "");
    assert_eq!(masked(viewer(STEPS), from_above()), (turned.clone(), false));
    assert_eq!(masked(from_above(), viewer(STEPS)), (turned.clone(), false));
    // Turned round, and still elsewhere; and a world that cannot be compared.
    assert_eq!(masked(viewer(STEPS), viewer(down)), (turned.clone(), true));
    assert!(masked(viewer(STEPS), scalars(size, STEPS, [0.0; 3], "RAS")).1);
    // The same place in the patient, in worlds of opposite axes; the same numbers in them are another place.
    let ras = || scalars(size, STEPS, [10.0, 20.0, 30.0], "RAS");
    let backwards = [[-1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 3.0]];
    let lps = scalars(size, backwards, [-10.0, -20.0, 30.0], "left-posterior-superior");
    assert_eq!(masked(ras(), lps), (plain.clone(), false));
    let mirrored = scalars(size, STEPS, [10.0, 20.0, 30.0], "LPS");
    assert!(masked(ras(), mirrored).1);
    // One axis counted from its other end.
    let from_top = scalars(size, down, [10.0, 24.0, 30.0], "RAS");
    assert_eq!(masked(ras(), from_top), (turned, false));
    assert!(masked(ras(), scalars(size, down, [10.0, 20.0, 30.0], "RAS")).1);
    // Nothing is known of how worlds of other names lie to each other.
    assert_eq!(masked(ras(), scalars(size, down, [0.0; 3], "3D-left-handed")), (plain.clone(), true));
    // The smaller confidence counts.
    let mut own = ras();
    own.mask = Some(vec![9.0, 0.5, 0.0, f64::NAN, 9.0, 9.0]);
    assert_eq!(masked(own, ras()).0, [0.0, 0.5, 0.0, 3.0, 4.0, 5.0]);
}

/// A picture has no place, but a top: its mask fits the picture that the other one makes. Whole volumes have none.
#[test]
fn masks_without_a_place_lie_over_the_picture() {
    let absent = |size, axes| Lattice { world: World::Absent, ..scalars(size, axes, [0.0; 3], "") };
    let masked = |mut own: Lattice, mask: &Lattice| own.mask_by(mask).map(|o| (o, own.mask.unwrap()));
    let down = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let picture = absent([2, 3, 1], down);
    let flipped = vec![4.0, 5.0, 2.0, 3.0, 0.0, 1.0];
    let laid = Some((Overlay::Pictures, flipped));
    // Over a sagittal, coronal or axial layer, whatever its world, and the other way round.
    for size in [[2, 3, 1], [2, 1, 3], [1, 2, 3]] {
        for world in ["", "RAS", "not stated"] {
            let layer = scalars(size, STEPS, [5.0; 3], world);
            assert_eq!(masked(layer.clone(), &picture), laid, "{size:?} {world}");
            assert_eq!(masked(picture.clone(), &layer), laid, "{size:?} {world}");
        }
    }
    let plain: Vec<f64> = (0..6).map(f64::from).collect();
    assert_eq!(masked(picture.clone(), &picture), Some((Overlay::Coincident, plain)));
    assert_eq!(masked(scalars([3, 2, 1], STEPS, [0.0; 3], "RAS"), &picture), None);
    let volume = scalars([2, 3, 2], STEPS, [5.0; 3], "RAS");
    let (overlay, mask) = masked(volume.clone(), &absent([2, 3, 2], STEPS)).unwrap();
    assert_eq!((overlay, mask), (Overlay::Voxels, volume.values.clone()));
    assert_eq!(masked(volume, &picture), None);
}

/// How thick the only layer is moves no point.
#[test]
fn masks_of_another_thickness_coincide() {
    let thick = [STEPS[0], STEPS[1], [0.0, 0.0, 50.0]];
    for size in [[2, 3, 1], [1, 1, 1]] {
        let mut own = scalars(size, STEPS, [5.0; 3], "RAS");
        assert_eq!(own.mask_by(&scalars(size, thick, [5.0; 3], "RAS")), Some(Overlay::Coincident));
        assert_eq!(own.mask_by(&scalars(size, thick, [5.0, 5.0, 6.0], "RAS")), Some(Overlay::Elsewhere));
    }
    let mut own = scalars([2, 3, 2], STEPS, [5.0; 3], "RAS");
    assert_eq!(own.mask_by(&scalars([2, 3, 2], thick, [5.0; 3], "RAS")), Some(Overlay::Elsewhere));
}

/// An axis that runs against the world's is reversed, so that a position and positive distances tell where a plane
/// lies.
#[test]
fn positions_are_those_of_the_lower_left_cell_of_the_picture() {
    let cut = |axes: [[f64; 3]; 3], world: &str| {
        let mut lattice = scalars([2, 3, 1], axes, [10.0, 20.0, 30.0], world);
        lattice.components = 3;
        lattice.values = vec![1.0; 18];
        let reading = Reading { order: Some("nrrd"), ..Reading::default() };
        lattice.tensors(reading).unwrap().slice(PlaneChoice::default()).unwrap().cut
    };
    let left = [[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let down = [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 3.0]];
    for world in ["", "RAS", "LPS", "3D-left-handed"] {
        let corner = |axes| cut(axes, world).geometry.corner();
        assert_eq!(corner(STEPS), [10.0, 20.0, 30.0], "{world}");
        assert_eq!(corner(left), [9.0, 20.0, 30.0], "{world}");
        assert_eq!(corner(down), [10.0, 16.0, 30.0], "{world}");
    }
    let story = cut(left, "LPS").story("");
    assert!(story.contains("voxel axis -x to the right (the world's +x, the patient's left)"), "{story}");
    assert!(story.contains("y up (the world's +y, the patient's posterior)"), "{story}");
    let oblique = [[0.8, 0.6, 0.0], [-1.2, 1.6, 0.0], [0.0, 0.0, 3.0]];
    let story = cut(oblique, "").story("");
    assert!(
        story.contains("x to the right (mainly the world's +x), y up (mainly the world's +y)"),
        "{story}"
    );
}

/// Seven numbers are one thing, whatever the file.
#[test]
fn seven_numbers_are_a_mask_and_the_upper_triangle() {
    let tuple = [1.0, 2.0, 0.1, 0.2, 3.0, 0.3, 4.0];
    let header =
        "NRRD0004\ntype: float\ndimension: 4\nsizes: 7 1 1 1\nencoding: ascii\n\n1 2 0.1 0.2 3 0.3 4\n";
    let of_nrrd = nrrd::read(header.as_bytes(), None).unwrap();
    let of_npy = tigereye_io::npy::write_array(&[1, 1, 1, 7], &tuple).unwrap();
    let of_npy = tigereye_io::npy::read_lattice(&of_npy, Wanted::Tensors).unwrap();
    for lattice in [of_nrrd, of_npy] {
        let volume = lattice.tensors(Reading::default()).unwrap();
        assert_eq!(volume.order(), (TensorOrder::UPPER, Known::Assumed));
        let stored = volume.stored(0);
        let expected = [2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0];
        assert!(stored.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{stored:?}");
    }
}

#[test]
fn nrrd_axes_of_a_picture_are_no_tuples() {
    let header = |kinds: &str| {
        format!(
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 6 2 1\n{kinds}encoding: ascii\n\n{}",
            "1 ".repeat(12)
        )
    };
    assert!(nrrd::read(header("").as_bytes(), None).is_ok());
    assert!(nrrd::read(header("kinds: ??? domain domain\n").as_bytes(), None).is_ok());
    let message =
        nrrd::read(header("kinds: domain domain domain\n").as_bytes(), None).unwrap_err().to_string();
    assert!(message.contains("kinds") && message.contains("3D-symmetric-matrix"), "{message}");
}

/// VTK's order is stated by names or by the attribute `Tensors`; otherwise six numbers are a guess.
#[test]
fn vtk_orders_are_stated_by_names_and_attributes() {
    let mut image = image_from_volume(&volume(), Frame::World).unwrap();
    let known = |image: &tigereye_io::ImageData| {
        lattice_from_image(image, None, Wanted::Tensors).unwrap().order.unwrap().1
    };
    assert_eq!(known(&image), Known::Stated);
    image.point_arrays[0].component_names.clear();
    assert_eq!(known(&image), Known::Stated);
    image.point_active.tensors = None;
    assert_eq!(known(&image), Known::Convention);
    image.point_arrays[0] = tigereye_io::DataArray::new("six", 6, vec![1.0; 6 * VOXELS]);
    assert_eq!(known(&image), Known::Assumed);
}

#[test]
fn tensors_that_are_not_finite_are_found_and_zeroed_where_they_are_measured() {
    let mut lattice = volume().lattice().clone();
    lattice.values[9 * 7 + 3] = f64::NAN;
    lattice.values[9 * 20] = f64::INFINITY;
    let strange = lattice.clone().tensors(Reading::default()).unwrap();
    assert_eq!(strange.not_finite(), Some(([1, 0, 1], 2)));
    let zeroed = strange.with_zeros_for_not_finite();
    assert_eq!((zeroed.not_finite(), zeroed.stored(7), zeroed.stored(20)), (None, [0.0; 9], [0.0; 9]));
    assert_eq!(zeroed.stored(8), volume().stored(8));
    let mut mask = vec![1.0; VOXELS];
    (mask[7], mask[20]) = (0.0, 0.0);
    lattice.mask = Some(mask);
    assert_eq!(lattice.tensors(Reading::default()).unwrap().not_finite(), None);
}

#[test]
fn masked_voxels_are_zero_tensors() {
    let header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 2 1\nkinds: 2D-masked-symmetric-matrix domain domain\n\
                  encoding: ascii\n\n0 1 2 3\n1 4 5 6\n";
    let volume = nrrd::read(header.as_bytes(), None).unwrap().tensors(Reading::default()).unwrap();
    let slice = volume.slice(PlaneChoice::default()).unwrap();
    assert_eq!(slice.field.values(), [Tensor2::ZERO, Tensor2::symmetric(4.0, 5.0, 6.0)]);
    assert!(volume.story().iter().any(|s| s.contains("1 voxels masked out")));
}
