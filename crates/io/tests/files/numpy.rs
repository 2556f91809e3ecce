//! What arrays and archives of NumPy hold, which nothing in them says.

use crate::conventions::{EXPECTED, plane};
use tigereye_core::{Cell, Tensor2};
use tigereye_io::npy::NpyError;
use tigereye_io::volume::{Axis, ComponentArrays, Frame, Plane, PlaneChoice, Reading};
use tigereye_io::{ArrayChoice, IoError, Wanted, npy};

#[test]
fn archives_give_the_tensor_or_its_components() {
    let member = |name: &str, shape: &[usize], values: Vec<f64>| {
        (name.to_owned(), npy::write_array(shape, &values).unwrap())
    };
    let members = [
        member("x", &[2, 3], vec![0.0; 6]),
        member("sxx", &[2, 3], vec![5.0; 6]),
        member("syy", &[2, 3], vec![-1.0; 6]),
        member("sxy", &[2, 3], vec![2.0; 6]),
    ];
    let found = npy::lattice_of_members(&members, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    assert_eq!(plane(found, Reading::default()), Ok(EXPECTED));
    let tensor = member("stress", &[2, 3, 2, 2], [5.0, 2.0, 2.0, -1.0].repeat(6));
    let members: Vec<_> = members.into_iter().chain([tensor]).collect();
    let found = npy::lattice_of_members(&members, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    assert_eq!(found.array, "stress");
    assert_eq!(plane(found, Reading::default()), Ok(EXPECTED));
}

/// Positions beside the data place it, whichever way they run; a picture whose y runs downwards in the file is turned.
#[test]
fn positions_of_archives_place_their_cells() {
    let member = |name: &str, shape: &[usize], values: Vec<f64>| {
        (name.to_owned(), npy::write_array(shape, &values).unwrap())
    };
    let (xs, ys) = ([10.0, 10.5, 11.0], [5.0, 7.0]);
    // The tensor at (x, y) has xx = x, yy = y, so that each says where it belongs.
    let stress =
        |places: &[(f64, f64)]| places.iter().flat_map(|(x, y)| [*x, 0.25, *y]).collect::<Vec<f64>>();
    let rows: Vec<(f64, f64)> = ys.iter().flat_map(|&y| xs.map(|x| (x, y))).collect();
    let columns: Vec<(f64, f64)> = xs.iter().flat_map(|&x| ys.map(|y| (x, y))).collect();
    let falling: Vec<(f64, f64)> = ys.iter().rev().flat_map(|&y| xs.map(|x| (x, y))).collect();
    let (of_x, of_y) = (
        |p: &[(f64, f64)]| p.iter().map(|p| p.0).collect(),
        |p: &[(f64, f64)]| p.iter().map(|p| p.1).collect(),
    );
    let archives = [
        [
            member("x", &[3], xs.to_vec()),
            member("y", &[2], ys.to_vec()),
            member("s", &[2, 3, 3], stress(&rows)),
        ],
        [
            member("X", &[2, 3], of_x(&rows)),
            member("Y", &[2, 3], of_y(&rows)),
            member("s", &[2, 3, 3], stress(&rows)),
        ],
        [
            member("lon", &[2, 3], of_x(&falling)),
            member("lat", &[2, 3], of_y(&falling)),
            member("s", &[2, 3, 3], stress(&falling)),
        ],
        [
            member("x", &[3], xs.to_vec()),
            member("y", &[2], ys.to_vec()),
            member("s", &[3, 2, 3], stress(&columns)),
        ],
        [
            member("x", &[3, 2], of_x(&columns)),
            member("y", &[3, 2], of_y(&columns)),
            member("s", &[3, 2, 3], stress(&columns)),
        ],
    ];
    for (which, members) in archives.iter().enumerate() {
        let lattice = npy::lattice_of_members(members, ArrayChoice::Usual, Wanted::Tensors).unwrap();
        let slice = lattice.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap();
        let tensors: Vec<[f64; 4]> = slice.field.values().iter().map(Tensor2::components).collect();
        let expected: Vec<[f64; 4]> = falling.iter().map(|&(x, y)| [x, 0.25, 0.25, y]).collect();
        assert_eq!(tensors, expected, "archive {which}: row 0 is the one of the largest y");
        let geometry = slice.cut.geometry;
        assert_eq!(
            (geometry.corner(), geometry.spacing()),
            ([10.0, 5.0, 0.0], [0.5, 2.0]),
            "archive {which}"
        );
    }
    let mut uneven = archives[0].clone();
    uneven[0] = member("x", &[3], vec![10.0, 10.5, 12.0]);
    let fault = npy::lattice_of_members(&uneven, ArrayChoice::Usual, Wanted::Tensors);
    assert!(matches!(fault, Err(IoError::Npy(NpyError::Positions { .. }))), "{fault:?}");
    // Positions of another size place nothing, and that is said.
    let mut other = archives[0].clone();
    other[0] = member("x", &[4], vec![0.0; 4]);
    let lattice = npy::lattice_of_members(&other, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    assert!(lattice.warnings.iter().any(|w| w.contains("positions x, y ignored")), "{:?}", lattice.warnings);
}

/// Volumes with one array a component are told from volumes of tuples by the names, whatever the length of their last
/// axis, and their components are along the axes of their positions.
#[test]
fn volumes_of_archives_have_one_array_a_component() {
    let member = |name: &str, shape: &[usize], values: Vec<f64>| {
        (name.to_owned(), npy::write_array(shape, &values).unwrap())
    };
    for layers in [2, 3, 4, 6, 7, 9] {
        let shape = [3, 2, layers];
        let of = |f: fn(f64, f64, f64) -> f64| -> Vec<f64> {
            let at = |i: usize| (i / layers / 2, i / layers % 2, i % layers);
            (0..6 * layers).map(at).map(|(x, y, z)| f(x as f64, 5.0 - y as f64, z as f64)).collect()
        };
        let members = [
            member("x", &[3], vec![0.0, 1.0, 2.0]),
            // Downwards: the voxel axis is not the axis of the components.
            member("y", &[2], vec![5.0, 4.0]),
            member("z", &[layers], (0..layers).map(|z| z as f64).collect()),
            member("sxx", &shape, of(|x, _, z| x + 10.0 * z)),
            member("syy", &shape, of(|_, y, _| y)),
            member("szz", &shape, of(|_, _, z| z)),
            member("sxy", &shape, of(|x, y, _| 0.1 * x * y)),
            member("sxz", &shape, vec![0.0; 6 * layers]),
            member("syz", &shape, vec![0.0; 6 * layers]),
        ];
        let arrays = ComponentArrays::parse("XX=sxx,YY=syy,ZZ=szz,XY=sxy,XZ=sxz,YZ=syz").unwrap();
        for choice in [ArrayChoice::Usual, ArrayChoice::Components(&arrays)] {
            let lattice = npy::lattice_of_members(&members, choice, Wanted::Tensors).unwrap();
            assert_eq!((lattice.size, lattice.frame.0), (shape, Frame::World), "{layers} layers");
            let choice = PlaneChoice { plane: Some(Plane::Xy), slice: Some((Axis::Z, 1)) };
            let slice = lattice.tensors(Reading::default()).unwrap().slice(choice).unwrap();
            // On top right: x = 2, y = 5.
            let t = slice.field.at(Cell::new(2, 0));
            assert_eq!(t.components(), [12.0, 1.0, 1.0, 5.0], "{layers} layers");
        }
    }
}

/// Arrays whose first axis could be the components are said, and refused where the last is a mask and six numbers.
#[test]
fn arrays_that_could_have_their_components_first_are_said() {
    let read = |shape: &[usize]| {
        let array = npy::write_array(shape, &vec![1.0; shape.iter().product()]).unwrap();
        npy::read_lattice(&array, Wanted::Tensors).map(|l| l.warnings.len())
    };
    assert_eq!(read(&[3, 40, 4]), Ok(1));
    assert_eq!(read(&[20, 40, 4]), Ok(0));
    assert!(matches!(read(&[3, 6, 7]), Err(IoError::Npy(NpyError::ComponentsFirst { .. }))));
    assert_eq!(read(&[20, 6, 7]), Ok(0));
    // Matrices with both axes first.
    assert_eq!((read(&[2, 2, 8, 6]), read(&[3, 3, 6]), read(&[2, 4, 8, 6])), (Ok(1), Ok(1), Ok(0)));
    // One number behind the others does stand last.
    assert!(matches!(read(&[3, 9, 1]), Err(IoError::Npy(NpyError::Shape { .. }))));
}

/// Nothing names the axes of an array of numbers with three of them; positions beside it do.
#[test]
fn the_order_of_the_axes_of_volumes_is_said() {
    let array = npy::write_array(&[5, 4, 6], &[1.0; 120]).unwrap();
    let said = |remarks: &[String]| remarks.iter().any(|r| r.contains("x, y and z in this order"));
    assert!(said(&npy::read_lattice(&array, Wanted::Scalars).unwrap().remarks));
    assert!(!said(&npy::read_lattice(&array, Wanted::Mask).unwrap().remarks));
    let mut members = vec![("s".to_owned(), array)];
    for (axis, n) in [("x", 5), ("y", 4), ("z", 6)] {
        let steps: Vec<f64> = (0..n).map(f64::from).collect();
        members.push((axis.to_owned(), npy::write_array(&[n as usize], &steps).unwrap()));
    }
    let placed = npy::lattice_of_members(&members, tigereye_io::ArrayChoice::Usual, Wanted::Scalars).unwrap();
    assert!(!said(&placed.remarks), "{:?}", placed.remarks);
    assert!(placed.remarks.is_empty(), "{:?}", placed.remarks);
    // Axes that run along others than their names say so: slices are those of the array.
    members.truncate(1);
    for (name, step) in [("x", 1), ("y", 6), ("z", 24)] {
        let length = [6, 4, 5][[1, 6, 24].iter().position(|s| *s == step).unwrap()];
        let positions: Vec<f64> = (0..120).map(|i| f64::from(i / step % length)).collect();
        members.push((name.to_owned(), npy::write_array(&[5, 4, 6], &positions).unwrap()));
    }
    let placed = npy::lattice_of_members(&members, tigereye_io::ArrayChoice::Usual, Wanted::Scalars).unwrap();
    assert!(placed.remarks.iter().any(|r| r.contains("along the world's z, y, x")), "{:?}", placed.remarks);
}
