//! What is written comes back: every format of tensors, from fields and from turned volumes.

use crate::support::{FORMATS, Format, world};
use std::io::Read as _;
use tigereye_core::{Field, Grid, Tensor2};
use tigereye_io::volume::{
    Frame, PlaneChoice, PlaneGeometry, Reading, TensorVolume, image_from_volume, lattice_from_image,
    lattice_from_points,
};
use tigereye_io::{
    ArrayError, Cells, DataArray, ImageData, IoError, PolyData, Wanted, WriteError, legacy, nifti, nrrd, vtp,
};

fn field(symmetric: bool) -> Field<Tensor2> {
    Field::from_fn(Grid::new(5, 4).unwrap(), |c| {
        let (x, y) = (c.x as f64, c.y as f64);
        let yx = if symmetric { 0.1 + x - y } else { x * y - 3.0 };
        Tensor2::new(1.0 + x, 0.1 + x - y, yx, 2.5 - y * x)
    })
}

/// A plane in height 7.
fn placed() -> PlaneGeometry {
    PlaneGeometry::new([3.0, -2.0, 7.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.25])
}

fn slice(volume: &TensorVolume) -> Field<Tensor2> {
    volume.slice(PlaneChoice::default()).unwrap().field
}

#[test]
fn fields_come_back_from_every_format() {
    for symmetric in [true, false] {
        let field = field(symmetric);
        let volume = TensorVolume::from_field(&field, &placed());
        assert_eq!(slice(&volume), field);
        for Format { name, through } in FORMATS {
            let lattice = through(&volume).unwrap();
            assert_eq!((lattice.size, lattice.origin), ([5, 4, 1], [3.0, -2.0, 7.0]), "{name}");
            assert_eq!(lattice.spacing()[..2], [0.5, 0.25], "{name}");
            let back = lattice.tensors(Reading::default()).unwrap();
            assert_eq!(slice(&back), field, "{name}, symmetric: {symmetric}");
        }
    }
}

/// A volume whose axes are turned in space by exact numbers, so that turning leaves no rounding.
fn turned_volume() -> TensorVolume {
    let tuples: String = (0..24).map(|v| format!("{} 1 2 {v} 3 {} 5\n", v % 5, v + 20)).collect();
    let header = "NRRD0005\ntype: double\ndimension: 4\nspace: left-posterior-superior\nsizes: 7 2 3 4\n\
                  space directions: none (0,2,0) (-1,0,0) (0,0,4)\nspace origin: (7,8,9)\n\
                  kinds: 3D-masked-symmetric-matrix space space space\nencoding: ascii\n\
                  measurement frame: (0,0,1) (1,0,0) (0,1,0)\n\n";
    let lattice = nrrd::read(format!("{header}{tuples}").as_bytes(), None).unwrap();
    lattice.tensors(Reading::default()).unwrap()
}

/// Tensors along the world's axes, position and mask survive; NIfTI's world is right-anterior-superior, so two axes
/// change sign there.
#[test]
fn turned_volumes_come_back_from_every_format() {
    let volume = turned_volume();
    let expected = world(&volume).unwrap();
    for Format { name, through } in FORMATS {
        let lattice = through(&volume).unwrap();
        let nifti = name.starts_with("nii");
        let sign = |i: usize| if nifti && i < 2 { -1.0 } else { 1.0 };
        // Points have the order of the world's axes: -x of the volume, in its second axis, is x of the lattice.
        let (size, origin, axes) = if name == "vtp" {
            ([3, 2, 4], [5.0, 8.0, 9.0], [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 4.0]])
        } else {
            ([2, 3, 4], [7.0, 8.0, 9.0], [[0.0, 2.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 4.0]])
        };
        assert_eq!(lattice.size, size, "{name}");
        assert_eq!(lattice.origin, [0, 1, 2].map(|i| sign(i) * origin[i]), "{name}");
        for (axis, expected) in lattice.axes.iter().zip(axes) {
            for i in 0..3 {
                assert!((axis[i] - sign(i) * expected[i]).abs() < 1e-12, "{name}: {axis:?}");
            }
        }
        let back = world(&lattice.tensors(Reading::default()).unwrap()).unwrap();
        // The place in the volume of a point of the lattice.
        let place = |point: usize| match name {
            "vtp" => (point / 3 % 2) + 2 * ((2 - point % 3) + 3 * (point / 6)),
            _ => point,
        };
        for (i, found) in back.point_arrays[0].values.iter().enumerate() {
            let (row, column) = (i % 9 / 3, i % 3);
            let expected = expected.point_arrays[0].values[9 * place(i / 9) + i % 9];
            assert_eq!(*found, sign(row) * sign(column) * expected, "{name}, number {i}");
        }
    }
    let mask = nrrd::read(&nrrd::write(&volume, Frame::World, "").unwrap(), None).unwrap().mask;
    assert_eq!(mask, volume.lattice().mask);
}

/// NRRD can say along which axes its components are: along the voxels' they come back as they are there.
#[test]
fn nrrd_holds_components_along_the_voxel_axes() {
    let volume = turned_volume();
    let read = nrrd::read(&nrrd::write(&volume, Frame::Voxel, "").unwrap(), None).unwrap();
    let back = read.tensors(Reading::default()).unwrap();
    assert_eq!(back.frame().0, Frame::Measurement);
    let along_voxels = image_from_volume(&volume, Frame::Voxel).unwrap().point_arrays[0].values.clone();
    let stored: Vec<f64> = (0..24).flat_map(|v| back.measured(v).unwrap_or([0.0; 9])).collect();
    assert_eq!(stored, along_voxels);
    assert_eq!(world(&back).unwrap().point_arrays[0].values, world(&volume).unwrap().point_arrays[0].values);
}

/// Only the patient's worlds are turned; other names may hold the word left.
#[test]
fn worlds_that_are_not_the_patients_keep_their_axes() {
    let header = "NRRD0005\ntype: double\ndimension: 4\nspace: 3D-left-handed\nsizes: 6 1 1 1\n\
                  space directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (5,6,7)\n\
                  kinds: 3D-symmetric-matrix space space space\nencoding: ascii\n\n1 0 0 1 0 1\n";
    let volume = nrrd::read(header.as_bytes(), None).unwrap().tensors(Reading::default()).unwrap();
    let back = nifti::read(&nifti::write(&volume, nifti::WrittenAs::Matrices, "").unwrap()).unwrap();
    assert_eq!(back.origin, [5.0, 6.0, 7.0]);
}

/// One column, one row and one point have axes that no step tells.
#[test]
fn thin_fields_come_back_from_every_format() {
    for (width, height) in [(1, 4), (4, 1), (1, 1)] {
        let field = Field::from_fn(Grid::new(width, height).unwrap(), |c| {
            Tensor2::new(1.0 + c.x as f64, 2.0, 3.0, 4.0 + c.y as f64)
        });
        let volume = TensorVolume::from_field(&field, &placed());
        for Format { name, through } in FORMATS {
            let lattice = through(&volume).unwrap();
            assert_eq!(lattice.size, [width, height, 1], "{name}");
            let back = lattice.tensors(Reading::default()).unwrap();
            assert_eq!(slice(&back), field, "{name}, {width} x {height}");
        }
    }
}

#[test]
fn provenance_is_kept_by_formats_that_have_a_place() {
    let volume = TensorVolume::from_field(&field(true), &PlaneGeometry::UNPLACED);
    let story = "{\"command\":\"a \\\"b\\\"\"}";
    let packed = nifti::write_packed(&volume, nifti::WrittenAs::Matrices, story).unwrap();
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes, nifti::write(&volume, nifti::WrittenAs::Matrices, story).unwrap());
    let size = i32::from_le_bytes(bytes[352..356].try_into().unwrap());
    assert_eq!((bytes[348], size % 16, bytes[356]), (1, 0, 6));
    assert!(bytes[360..].starts_with(story.as_bytes()));
    let file = nrrd::write(&volume, Frame::World, story).unwrap();
    let line = format!("\ntigereye:={}\n", story.replace('\\', "\\\\"));
    assert!(String::from_utf8_lossy(&file).contains(&line));
}

#[test]
fn what_formats_cannot_hold_is_refused() {
    let field = Field::from_fn(Grid::new(40000, 3).unwrap(), |_| Tensor2::ZERO);
    let long = TensorVolume::from_field(&field, &PlaneGeometry::UNPLACED);
    let message = nifti::write(&long, nifti::WrittenAs::Matrices, "").unwrap_err().to_string();
    assert!(message.contains("40000 x 3 x 1") && message.contains("32767"), "{message}");
    let mut image = ImageData::empty([2, 1, 1]);
    assert!(matches!(
        legacy::write(&image, &"t".repeat(256)),
        Err(IoError::Write(WriteError::Unwritable { .. }))
    ));
    assert!(matches!(
        legacy::write(&image, "two\nlines"),
        Err(IoError::Write(WriteError::Unwritable { .. }))
    ));
    image.point_arrays.push(DataArray::new("a b", 1, vec![1.0, 2.0]));
    assert!(matches!(legacy::write(&image, ""), Err(IoError::Write(WriteError::Unwritable { .. }))));
    image.point_arrays[0] = DataArray::new("a", 1, vec![1.0]);
    assert!(matches!(legacy::write(&image, ""), Err(IoError::Array(ArrayError::Size { .. }))));
    image.dimensions = [0, 1, 1];
    assert!(matches!(legacy::write(&image, ""), Err(IoError::Write(WriteError::EmptyImage { .. }))));
}

/// Poly data with all kinds of cells, and arrays on points and cells.
fn poly_data() -> PolyData {
    let mut data = PolyData {
        points: (0..6).map(|i| [f64::from(i), 0.5, -1.0 / 3.0]).collect(),
        point_arrays: vec![DataArray::new("p", 2, (0..12).map(f64::from).collect())],
        cell_arrays: vec![DataArray::new("c", 1, vec![1.0, 2.0, 3.0, 4.0, 5.0])],
        ..PolyData::default()
    };
    data.verts.push([5]);
    data.lines.push([0, 1, 2, 3]);
    data.lines.push([4, 3]);
    data.strips.push([0, 1, 2, 3, 4]);
    data.polys.push([0, 1, 2]);
    data.cell_active.scalars = Some("c".to_owned());
    data
}

#[test]
fn poly_data_comes_back() {
    let data = poly_data();
    let back = vtp::read(&vtp::write(&data).unwrap()).unwrap();
    assert_eq!(back, data);
    assert_eq!(back.lines.iter().collect::<Vec<_>>(), [&[0, 1, 2, 3][..], &[4, 3]]);
    assert_eq!(vtp::read(&vtp::write(&PolyData::default()).unwrap()).unwrap(), PolyData::default());
}

#[test]
fn poly_data_that_lies_is_refused() {
    let ascii = |counts: &str, points: &str, ends: &str, connectivity: &str| {
        let array = |name: &str, kind: &str, components: usize, text: &str| {
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">{text}</DataArray>"
            )
        };
        let file = format!(
            "<VTKFile type=\"PolyData\"><PolyData><Piece {counts}><Points>{}</Points><Lines>{}{}</Lines></Piece></PolyData></VTKFile>",
            array("Points", "Float32", 3, points),
            array("connectivity", "Int64", 1, connectivity),
            array("offsets", "Int64", 1, ends)
        );
        vtp::read(file.as_bytes())
    };
    let good = "NumberOfPoints=\"2\" NumberOfLines=\"1\"";
    let (points, cells) = ("0 0 0 1 0 0", "0 1");
    let mut expected = Cells::default();
    expected.push([0, 1]);
    assert_eq!(ascii(good, points, "2", cells).unwrap().lines, expected);
    for (counts, points, ends, connectivity) in [
        (good, "0 0 0 1 0", "2", cells),
        (good, points, "3", cells),
        (good, points, "-1", cells),
        (good, points, "2", "0 2"),
        (good, points, "2", "0 -1"),
        ("NumberOfPoints=\"3\" NumberOfLines=\"1\"", points, "2", cells),
        ("NumberOfPoints=\"2\" NumberOfLines=\"2\"", points, "2 1", cells),
        ("NumberOfPoints=\"-2\" NumberOfLines=\"1\"", points, "2", cells),
        ("NumberOfPoints=\"2\" NumberOfLines=\"99999999999999999999\"", points, "2", cells),
        ("NumberOfPoints=\"1000000000000\" NumberOfLines=\"1\"", points, "2", cells),
    ] {
        assert!(ascii(counts, points, ends, connectivity).is_err(), "{counts}: {ends}: {connectivity}");
    }
    let mut scattered = poly_data();
    scattered.points[3][1] = 0.7;
    scattered.point_arrays = vec![DataArray::new("t", 4, vec![1.0; 24])];
    let message = lattice_from_points(scattered, None, Wanted::Tensors).unwrap_err().to_string();
    assert!(message.contains("point 3"), "{message}");
}

/// Points that a resampling filter marked as outside become zero tensors.
#[test]
fn invalid_points_are_masked() {
    let mut image = ImageData::empty([2, 1, 1]);
    image.point_arrays =
        vec![DataArray::new("t", 3, vec![1.0; 6]), DataArray::new("vtkValidPointMask", 1, vec![1.0, 0.0])];
    let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
    let field = slice(&lattice.tensors(Reading::default()).unwrap());
    assert_eq!(field.values(), [Tensor2::symmetric(1.0, 1.0, 1.0), Tensor2::ZERO]);
}
