//! What is written is read back exactly, and the same data give the same bytes.

use crate::support::{field_of, image_of};
use proptest::prelude::*;
use tigereye_core::{Cell, Directions, Field, Grid, LightDistribution, LtgVolume, Tensor2};
use tigereye_io::npy::NpyError;
use tigereye_io::volume::{PlaneGeometry, VolumeError};
use tigereye_io::{
    ActiveArrays, ArrayError, ChoiceError, DataArray, FieldEntry, FieldValues, ImageData, IoError, Rows,
    ScalarType, WriteError, image_from_light, image_from_ltg, ltg_from_image, matrices, npy, vti,
};

fn sample_field(width: usize, height: usize) -> Field<Tensor2> {
    let grid = Grid::new(width, height).unwrap();
    Field::from_fn(grid, |c| {
        let v = (c.y * width + c.x) as f64;
        Tensor2::new(v + 0.1, -v / 3.0, 1e-200 * v, -0.0)
    })
}

fn sample_image() -> ImageData {
    let scalars = [ScalarType::Int8, ScalarType::UInt16, ScalarType::Int64, ScalarType::Float32];
    let mut image = ImageData::empty([3, 2, 2]);
    image.origin = [-1.5, 0.1, 1e300];
    image.spacing = [0.1, 2.0, 3.0];
    image.direction = Some([0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    for scalar in scalars {
        let values = (0..24).map(f64::from).collect();
        image.point_arrays.push(DataArray { scalar, ..DataArray::new(scalar.name(), 2, values) });
    }
    let nan = DataArray::new("<&\">'\u{e9}", 1, vec![f64::INFINITY; 12]);
    image.point_arrays.push(nan.with_component_names(&["a < b"]));
    image.cell_arrays.push(DataArray::new("", 1, vec![1.5, -2.5]));
    image.point_active = ActiveArrays { scalars: Some("Int8".into()), ..ActiveArrays::default() };
    image.cell_active = ActiveArrays { vectors: Some("v".into()), ..ActiveArrays::default() };
    image.push_text("tigereye", "{\"command\": \"a & b <\\u00e9>\", \"\u{e9}\": 1}\n");
    let texts = FieldValues::Text(vec![String::new(), "two".into(), String::new()]);
    image.field_data.push(FieldEntry { name: "texts".into(), values: texts });
    let values = FieldValues::Numbers { components: 3, values: vec![1.0; 6], scalar: ScalarType::UInt8 };
    image.field_data.push(FieldEntry { name: "numbers".into(), values });
    let values = FieldValues::Numbers { components: 1, values: vec![], scalar: ScalarType::Float64 };
    image.field_data.push(FieldEntry { name: "empty".into(), values });
    image
}

#[test]
fn an_image_comes_back_whole() {
    let image = sample_image();
    let bytes = vti::write(&image).unwrap();
    assert_eq!(vti::read(&bytes).unwrap(), image);
    assert_eq!(vti::write(&image).unwrap(), bytes);
}

/// More than one block, and a last block that is full.
#[test]
fn blocks_of_every_length_come_back() {
    for count in [16_383, 16_384, 16_385, 32_768, 40_000] {
        let mut image = ImageData::empty([count, 1, 1]);
        let values = (0..count).map(|i| (i as f64).sqrt()).collect();
        image.point_arrays.push(DataArray::new("a", 1, values));
        assert_eq!(vti::read(&vti::write(&image).unwrap()).unwrap().point_arrays, image.point_arrays);
    }
}

#[test]
fn tensors_survive_an_image() {
    let field = sample_field(4, 3);
    let image = image_of(&field, [1.0, 2.0], [0.5, 0.25]);
    // VTK's first row is the bottom row.
    assert_eq!(image.point_arrays[0].values[0], field.at(Cell::new(0, 2)).xx());
    let read = vti::read(&vti::write(&image).unwrap()).unwrap();
    let tensors = field_of(&read, None).unwrap();
    assert_eq!(tensors.field, field);
    let lies = tensors.cut.geometry;
    assert_eq!((lies.corner(), lies.spacing()), ([1.0, 2.0, 0.0], [0.5, 0.25]));
    assert_eq!(tensors.cut.reversed(), [false, false]);
}

#[test]
fn component_orders_are_those_of_their_tools() {
    let cases: [(usize, &[&str], [f64; 4]); 6] = [
        (9, &[], [0.0, 1.0, 3.0, 4.0]),
        (6, &[], [0.0, 3.0, 3.0, 1.0]),
        (4, &[], [0.0, 1.0, 2.0, 3.0]),
        (3, &[], [0.0, 1.0, 1.0, 2.0]),
        (3, &["XX", "YY", "XY"], [0.0, 2.0, 2.0, 1.0]),
        (3, &["a", "b", "c"], [0.0, 1.0, 1.0, 2.0]),
    ];
    for (components, names, [xx, xy, yx, yy]) in cases {
        let mut image = ImageData::empty([1, 1, 1]);
        let values = (0..components).map(|i| i as f64).collect();
        image.point_arrays.push(DataArray::new("t", components, values).with_component_names(names));
        let read = field_of(&image, Some("t")).unwrap();
        assert_eq!(*read.field.at(Cell::new(0, 0)), Tensor2::new(xx, xy, yx, yy));
    }
}

#[test]
fn reversed_axes_are_put_right() {
    let field = sample_field(3, 2);
    let mut image = image_of(&field, [0.0; 2], [1.0; 2]);
    image.direction = Some([-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0]);
    let read = field_of(&image, None).unwrap();
    assert_eq!(read.cut.reversed(), [true, true]);
    let turned = Field::from_fn(field.grid(), |c| *field.at(Cell::new(2 - c.x, 1 - c.y)));
    assert_eq!(read.field, turned);
    // Reversed by spacing, by direction, or by both, which is not at all.
    for (direction, spacing, reversed) in
        [([1.0, -1.0], 1.0, true), ([1.0, 1.0], -1.0, true), ([1.0, -1.0], -1.0, false)]
    {
        let mut image = image_of(&field, [0.0; 2], [1.0; 2]);
        image.direction = Some([direction[0], 0.0, 0.0, 0.0, direction[1], 0.0, 0.0, 0.0, 1.0]);
        image.spacing[1] = spacing;
        let read = field_of(&image, None).unwrap();
        assert_eq!(read.cut.reversed(), [false, reversed], "{direction:?} {spacing}");
        let upside_down = Field::from_fn(field.grid(), |c| *field.at(Cell::new(c.x, 1 - c.y)));
        assert_eq!(read.field, if reversed { upside_down } else { field.clone() }, "{direction:?} {spacing}");
    }
}

#[test]
fn the_tensor_array_is_never_guessed() {
    let mut image = image_of(&sample_field(2, 2), [0.0; 2], [1.0; 2]);
    image.point_active.tensors = None;
    assert!(field_of(&image, None).is_ok());
    image.point_arrays.push(DataArray::new("other", 4, vec![0.0; 16]));
    let message = field_of(&image, None).unwrap_err().to_string();
    assert_eq!(
        message,
        "several arrays fit: `Tensors` (9 components), `other` (4 components): expected the name of one"
    );
    let message = field_of(&image, Some("absent")).unwrap_err().to_string();
    assert_eq!(message, "no array `absent`: the arrays are `Tensors` (9 components), `other` (4 components)");
    // Three numbers are a vector where something else may be the tensor, or where the file says so.
    image.point_arrays[0] = DataArray::new("v", 3, vec![1.0; 12]);
    assert!(field_of(&image, None).is_ok_and(|read| read.field.values()[0].is_zero()), "the other one");
    image.point_active.vectors = Some("v".into());
    image.point_arrays.pop();
    assert!(matches!(field_of(&image, None), Err(IoError::Choice(ChoiceError::NoArray { .. }))));
    image.point_arrays = vec![DataArray::new("five", 5, vec![0.0; 20])];
    let components = field_of(&image, Some("five")).map(drop);
    assert_eq!(
        components,
        Err(IoError::Volume(VolumeError::NoTensor { array: "five".into(), components: 5 }))
    );
}

fn sample_volume(slices: Vec<usize>) -> LtgVolume {
    let grid = Grid::new(3, 2).unwrap();
    let values = (0..6 * slices.len()).map(|i| i as f64 / 7.0).collect();
    LtgVolume::new(grid, Directions::new(8).unwrap(), slices, values)
}

#[test]
fn gradient_volumes_keep_slices_rows_and_provenance() {
    let json = "{\"version\": \"0.1.0\", \"command\": \"ltg\"}";
    for (slices, named) in [((0..8).collect(), false), (vec![1, 4, 6], true)] {
        let volume = sample_volume(slices);
        let image = image_from_ltg(&volume, &PlaneGeometry::UNPLACED, json);
        assert_eq!(image.numbers("slices").is_some(), named);
        assert_eq!(image.point_arrays[0].values, volume.values());
        let read = ltg_from_image(&vti::read(&vti::write(&image).unwrap()).unwrap()).unwrap();
        assert_eq!(read.provenance.as_deref(), Some(json));
        assert_eq!(read.into_volume(volume.directions()).unwrap(), volume);
    }
}

/// A plane of the world's x and z: right x up is -y.
fn upright() -> PlaneGeometry {
    PlaneGeometry::new([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.25])
}

const DOWN: &str = "{\"parameters\": {\"rows\": \"downwards\"}}";
const UP: &str = "{\"parameters\": {\"rows\": \"upwards\"}}";

/// The same numbers come out of a file with and without a place; the file with one has rows upwards and lies there.
#[test]
fn gradient_volumes_lie_on_their_field() {
    let volume = sample_volume(vec![1, 4, 6]);
    let placed = image_from_ltg(&volume, &upright(), UP);
    let plain = image_from_ltg(&volume, &PlaneGeometry::UNPLACED, DOWN);
    let through = |image: &ImageData| vti::read(&vti::write(image).unwrap()).unwrap();
    for image in [&placed, &plain] {
        let read = ltg_from_image(&through(image)).unwrap();
        assert_eq!(read.into_volume(volume.directions()).unwrap(), volume);
    }
    let (grid, lies) = (volume.grid(), through(&placed));
    let last = grid.cells() - grid.width();
    assert_eq!(lies.point_arrays[0].values[0], volume.values()[last]);
    // The first layer lies on the plane.
    assert_eq!((lies.origin, lies.spacing), (upright().corner(), [0.5, 0.25, 1.0]));
    assert_eq!(lies.direction, Some([1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0]));
    assert_eq!((plain.origin, plain.spacing, plain.direction), ([0.0; 3], [1.0; 3], None));
    assert_eq!(plain.point_arrays[0].values, volume.values());
}

/// What says nothing: the published volumes and older results run downwards, foreign files upwards.
#[test]
fn rows_run_as_files_say_or_as_their_makers_have_them() {
    let mut image = ImageData::empty([2, 2, 1]);
    let rows = |image: &ImageData, name: &str| Rows::of(image, name);
    assert_eq!(rows(&image, "Energy"), Rows::Downwards);
    assert_eq!(rows(&image, "LTG"), Rows::Upwards);
    image.origin[0] = 1.0;
    assert_eq!(rows(&image, "Energy"), Rows::Upwards, "lies somewhere, as no published volume does");
    image.push_text("tigereye", "{\"parameters\": {}}");
    for (name, expected) in [
        ("LTG", Rows::Downwards),
        ("energy", Rows::Downwards),
        ("intensity", Rows::Downwards),
        ("flux", Rows::Downwards),
        ("FTLE", Rows::Upwards),
        ("LIC", Rows::Upwards),
    ] {
        assert_eq!(rows(&image, name), expected, "{name}");
    }
    for (story, expected) in [(UP, Rows::Upwards), (DOWN, Rows::Downwards)] {
        image.field_data.clear();
        image.push_text("tigereye", story);
        assert_eq!((rows(&image, "LTG"), rows(&image, "FTLE")), (expected, expected));
    }
}

#[test]
fn impossible_slices_are_refused() {
    let mut image = image_from_ltg(&sample_volume(vec![1, 4]), &PlaneGeometry::UNPLACED, "{}");
    let set = |image: &mut ImageData, values: Vec<f64>| {
        let values = FieldValues::Numbers { components: 1, values, scalar: ScalarType::Float64 };
        image.field_data[1].values = values;
    };
    for wrong in
        [vec![4.0, 1.0], vec![1.0], vec![1.0, 1.5], vec![-1.0, 2.0], vec![f64::NAN, 2.0], vec![0.0, 1e30]]
    {
        set(&mut image, wrong);
        assert!(matches!(ltg_from_image(&image), Err(IoError::Choice(ChoiceError::Slices { .. }))));
    }
    set(&mut image, vec![1.0, 8.0]);
    let volume = ltg_from_image(&image).unwrap().into_volume(Directions::new(8).unwrap());
    assert!(matches!(volume, Err(IoError::Choice(ChoiceError::Slices { limit: 8, .. }))));
}

fn sample_light() -> LightDistribution {
    let grid = Grid::new(3, 2).unwrap();
    let samples = (0..48).map(f64::from).collect();
    let incoming = Field::from_fn(grid, |c| [c.x as f64, 0.0, c.y as f64, 0.0, 0.0, 0.0, 0.0, 0.0]);
    LightDistribution::new(Directions::new(8).unwrap(), samples, incoming)
}

/// Light lies on its field: rows upwards, the flux along the axes of the world.
#[test]
fn light_lies_on_its_field() {
    let light = sample_light();
    let image = image_from_light(&light, &upright(), UP);
    assert_eq!((image.origin, image.spacing), ([1.0, 2.0, 3.0], [0.5, 0.25, 1.0]));
    let array = |name: &str| &image.point_array(name).unwrap().values[..];
    // The first row of the file is the last of the field: cell (2, 1) is the third point.
    let energy = light.energy();
    assert_eq!(array("energy")[..3], energy.values()[3..]);
    assert_eq!(array("energy")[3..], energy.values()[..3]);
    assert_eq!(array("intensity")[..24], light.samples()[24..]);
    // 2 W to the right, 1 W up: along x and z.
    assert_eq!(array("flux")[6..9], [2.0, 0.0, 1.0]);
}

#[test]
fn light_images_hold_energy_intensity_and_flux() {
    let light = sample_light();
    let image =
        vti::read(&vti::write(&image_from_light(&light, &PlaneGeometry::UNPLACED, "{}")).unwrap()).unwrap();
    assert_eq!(image.dimensions, [3, 2, 1]);
    assert_eq!(image.point_array("energy").unwrap().values, light.energy().values());
    let intensity = image.point_array("intensity").unwrap();
    assert_eq!((intensity.components, &intensity.values[..]), (8, light.samples()));
    // Cell (2, 1): 2 W to the right, 1 W upwards.
    assert_eq!(image.point_array("flux").unwrap().values[15..], [2.0, 1.0, 0.0]);
    assert_eq!(image.text("tigereye"), Some("{}"));
}

#[test]
fn results_become_arrays_of_the_stated_shapes() {
    let light = npy::read_array(&npy::write_light(&sample_light())).unwrap();
    assert_eq!((light.shape, light.values), (vec![2, 3, 8], sample_light().samples().to_vec()));
    let volume = sample_volume(vec![0, 3]);
    let ltg = npy::read_array(&npy::write_ltg(&volume)).unwrap();
    assert_eq!((ltg.shape, ltg.values), (vec![2, 2, 3], volume.values().to_vec()));
    let field = sample_field(3, 2);
    assert_eq!(npy::read_array(&npy::write_tensors(&field)).unwrap().shape, [2, 3, 2, 2]);
    assert_eq!(npy::read_tensors(&npy::write_tensors(&field)).unwrap(), field);
}

#[test]
fn inconsistent_images_are_not_written() {
    let mut image = ImageData::empty([2, 2, 1]);
    image.point_arrays.push(DataArray::new("short", 1, vec![0.0; 3]));
    assert!(matches!(
        vti::write(&image),
        Err(IoError::Array(ArrayError::Size { found: 3, expected: 4, .. }))
    ));
    image.point_arrays = vec![DataArray::new("none", 0, vec![])];
    assert!(matches!(vti::write(&image), Err(IoError::Array(ArrayError::Components { .. }))));
    image.point_arrays = vec![DataArray::new("line\nfeed", 1, vec![0.0; 4])];
    assert!(matches!(vti::write(&image), Err(IoError::Write(WriteError::Unwritable { .. }))));
    assert!(matches!(
        vti::write(&ImageData::empty([2, 0, 1])),
        Err(IoError::Write(WriteError::EmptyImage { .. }))
    ));
    assert!(matches!(npy::write_array(&[2, 2], &[0.0; 3]), Err(IoError::Npy(NpyError::Shape { .. }))));
}

proptest! {
    #[test]
    fn any_field_survives_every_format(width in 1_usize..5, height in 1_usize..5,
                                       numbers in proptest::collection::vec(proptest::num::f64::NORMAL
                                           | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO, 64)) {
        let grid = Grid::new(width, height).unwrap();
        let field = Field::from_fn(grid, |c| {
            let i = 4 * grid.index(c);
            Tensor2::new(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3])
        });
        prop_assert_eq!(&matrices::read(&matrices::write(&field).unwrap()).unwrap(), &field);
        prop_assert_eq!(&npy::read_tensors(&npy::write_tensors(&field)).unwrap(), &field);
        let image = image_of(&field, [0.0; 2], [1.0; 2]);
        let read = vti::read(&vti::write(&image).unwrap()).unwrap();
        prop_assert_eq!(field_of(&read, None).unwrap().field, field);
    }
}
