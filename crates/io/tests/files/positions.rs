//! Points that say where they lie: their order in the file says nothing.

use std::fmt::Write as _;
use tigereye_core::{Field, Tensor2};
use tigereye_io::volume::{Axis, Lattice, PlaneChoice, Reading, lattice_from_points};
use tigereye_io::{ArrayChoice, DataArray, PolyData, Wanted, table};

/// Nodes along x, y and z; as many along x and z, so that sizes do not tell them apart.
const SIZE: [usize; 3] = [4, 3, 4];
const NODES: usize = SIZE[0] * SIZE[1] * SIZE[2];

fn node(i: usize) -> [usize; 3] {
    [i % SIZE[0], i / SIZE[0] % SIZE[1], i / (SIZE[0] * SIZE[1])]
}

/// The nodes in all 48 orders that go along axes, and in one that does not.
fn orders() -> Vec<Vec<usize>> {
    let mut all = Vec::new();
    for fastest in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for reversed in 0..8 {
            let size = fastest.map(|axis| SIZE[axis]);
            let order = (0..NODES).map(|i| {
                let at = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
                let mut index = [0; 3];
                for (count, &axis) in at.into_iter().zip(&fastest) {
                    index[axis] = if reversed >> axis & 1 == 1 { SIZE[axis] - 1 - count } else { count };
                }
                (index[2] * SIZE[1] + index[1]) * SIZE[0] + index[0]
            });
            all.push(order.collect());
        }
    }
    // 7 and 48 have no common factor.
    all.push((0..NODES).map(|i| 7 * i % NODES).collect());
    all
}

/// Distances of 0.5, 2 and 1.
fn place(i: usize) -> [f64; 3] {
    let [x, y, z] = node(i).map(|n| n as f64);
    [1.0 + 0.5 * x, -2.0 + 2.0 * y, 3.0 + z]
}

/// xx, yy, zz, xy, yz and xz, no two alike.
fn tensor(i: usize) -> [f64; 6] {
    let [x, y, z] = place(i);
    [10.0 + x, 20.0 + y, 30.0 + z, x - y, y - z, z - 2.0 * x]
}

fn planes(lattice: &Lattice) -> Vec<Field<Tensor2>> {
    assert_eq!(lattice.size, SIZE);
    let volume = lattice.clone().tensors(Reading::default()).unwrap();
    let along = |(axis, count): (Axis, usize)| (0..count).map(move |index| (axis, index));
    let all = [(Axis::X, SIZE[0]), (Axis::Y, SIZE[1]), (Axis::Z, SIZE[2])].into_iter().flat_map(along);
    all.map(|slice| volume.slice(PlaneChoice { plane: None, slice: Some(slice) }).unwrap().field).collect()
}

fn poly_data(order: &[usize], turn: impl Fn([f64; 3]) -> [f64; 3]) -> PolyData {
    let values = order.iter().flat_map(|&i| tensor(i)).collect();
    let array = DataArray::new("t", 6, values).with_component_names(&["XX", "YY", "ZZ", "XY", "YZ", "XZ"]);
    PolyData {
        points: order.iter().map(|&i| turn(place(i))).collect(),
        point_arrays: vec![array],
        ..PolyData::default()
    }
}

fn table(order: &[usize]) -> String {
    let mut text = "x,y,z,sxx,syy,szz,sxy,syz,sxz\n".to_owned();
    for &i in order {
        let row: Vec<String> = place(i).iter().chain(&tensor(i)).map(f64::to_string).collect();
        let _ = writeln!(text, "{}", row.join(","));
    }
    text
}

/// The plane z = 1 is the second from below of the world's z, in tables and in files of points alike.
#[test]
fn any_permutation_of_the_points_gives_the_same_planes() {
    let of_points = |order: &[usize]| lattice_from_points(poly_data(order, |p| p), None, Wanted::Tensors);
    let of_table =
        |order: &[usize]| table::read_columns(table(order).as_bytes(), ArrayChoice::Usual, Wanted::Tensors);
    let forward: Vec<usize> = (0..NODES).collect();
    let expected = planes(&of_points(&forward).unwrap());
    // Row 0 has the largest y; the planes x = 0 to 3 and y = 0 to 2 come first.
    let first = expected[8].values()[8].components();
    let [xx, yy, _, xy, _, _] = tensor(SIZE[0] * SIZE[1]);
    assert_eq!(first, [xx, xy, xy, yy], "the lower left node of z = 1");
    for order in orders() {
        assert_eq!(planes(&of_points(&order).unwrap()), expected, "points {order:?}");
        assert_eq!(planes(&of_table(&order).unwrap()), expected, "table {order:?}");
    }
}

/// Axes of a turned lattice are those of the world that they are nearest to, whatever order its rows have.
#[test]
fn turned_lattices_have_the_axes_they_are_nearest_to() {
    /// Rounding of a rotation of numbers of ten.
    const ROUNDING: f64 = 1e-12;
    let turn = |[x, y, z]: [f64; 3]| [0.8 * x - 0.6 * z, y, 0.6 * x + 0.8 * z];
    let of = |order: &[usize]| lattice_from_points(poly_data(order, turn), None, Wanted::Tensors).unwrap();
    let orders = orders();
    let expected = planes(&of(&orders[0]));
    for order in &orders[..48] {
        let found = planes(&of(order));
        for (plane, expected) in found.iter().zip(&expected) {
            for (t, e) in plane.values().iter().zip(expected.values()) {
                let off = t.components().into_iter().zip(e.components()).map(|(a, b)| (a - b).abs());
                assert!(off.fold(0.0, f64::max) < ROUNDING * 100.0, "{order:?}: {t:?} for {e:?}");
            }
        }
    }
}
