//! Planes are laid out by the world: the order and the signs of voxel axes show in no picture, whatever the format.

use crate::support::{FORMATS, Format};
use tigereye_core::Tensor2;
use tigereye_io::volume::{Axis, PlaneChoice, Reading, Slice, TensorVolume, lattice_from_image};
use tigereye_io::{DataArray, ImageData, Wanted};

/// Points of three different numbers along the world's axes, and unlike steps; exact in single precision, as NIfTI has
/// them.
const SIZE: [usize; 3] = [2, 3, 4];
const SPACING: [f64; 3] = [0.5, 0.25, 2.0];
const ORIGIN: [f64; 3] = [10.0, -20.0, 30.0];
const UPRIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// A rotation by about 37 degrees about z and 16 about the new x: oblique, but every axis has one that it is nearest
/// to.
const OBLIQUE: [[f64; 3]; 3] = [[0.8, 0.6, 0.0], [-0.576, 0.768, 0.28], [0.168, -0.224, 0.96]];
/// Rounding of NIfTI's affine, which is in single precision, on numbers up to 100.
const SINGLE: f64 = 1e-4;

/// A voxel axis for every world axis, and whether it runs against it.
#[derive(Clone, Copy, Debug)]
struct Order {
    world: [usize; 3],
    reversed: [bool; 3],
}

const PLAIN: Order = Order { world: [0, 1, 2], reversed: [false; 3] };

/// All 48.
fn orders() -> impl Iterator<Item = Order> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let signs = (0..8_usize).map(|bits| [bits & 1 == 1, bits & 2 == 2, bits & 4 == 4]);
    ORDERS.into_iter().flat_map(move |world| signs.clone().map(move |reversed| Order { world, reversed }))
}

impl Order {
    /// The voxel axis along a world axis.
    fn voxel(self, world: usize) -> usize {
        self.world.iter().position(|w| *w == world).unwrap()
    }

    /// An index along a world axis as the file counts it.
    fn index(self, world: usize, index: usize, size: [usize; 3]) -> usize {
        if self.reversed[self.voxel(world)] { size[world] - 1 - index } else { index }
    }
}

/// Numbers at a point of the world's lattice, along the world's axes; nothing about them is symmetric.
fn numbers(at: [usize; 3], components: usize) -> impl Iterator<Item = f64> {
    let place = (at[0] + 2 * at[1] + 7 * at[2]) as f64;
    (0..components).map(move |c| (c * c) as f64 - 3.0 * (c as f64) + place * [1.0, 0.5, -1.0][c % 3])
}

/// The same points and numbers in another order of axes.
fn image(order: Order, size: [usize; 3], axes: [[f64; 3]; 3], components: usize) -> ImageData {
    let mut image = ImageData::empty(order.world.map(|w| size[w]));
    image.spacing = order.world.map(|w| SPACING[w]);
    let sign = |a: usize| if order.reversed[a] { -1.0 } else { 1.0 };
    image.direction = Some(std::array::from_fn(|i| sign(i % 3) * axes[order.world[i % 3]][i / 3]));
    for a in (0..3).filter(|&a| order.reversed[a]) {
        let w = order.world[a];
        let length = (size[w] - 1) as f64 * SPACING[w];
        (0..3).for_each(|i| image.origin[i] += length * axes[w][i]);
    }
    (0..3).for_each(|i| image.origin[i] += ORIGIN[i]);
    let [nx, ny, nz] = image.dimensions;
    let values = (0..nx * ny * nz).flat_map(|point| {
        let at = [point % nx, point / nx % ny, point / (nx * ny)];
        let of_world = [0, 1, 2].map(|w| order.index(w, at[order.voxel(w)], size));
        numbers(of_world, components)
    });
    image.point_arrays = vec![DataArray::new("t", components, values.collect())];
    image
}

fn volume(order: Order, size: [usize; 3], axes: [[f64; 3]; 3]) -> TensorVolume {
    let image = image(order, size, axes, 9);
    lattice_from_image(&image, None, Wanted::Tensors).unwrap().tensors(Reading::default()).unwrap()
}

/// A slice across a world axis, chosen as the file counts.
fn choice(order: Order, world: usize, index: usize, size: [usize; 3]) -> PlaneChoice {
    let axis = [Axis::X, Axis::Y, Axis::Z][order.voxel(world)];
    PlaneChoice { plane: None, slice: Some((axis, order.index(world, index, size))) }
}

/// A slice as a format counts that keeps the order of the axes, or as points do, which have that of the world.
fn choice_in(format: &Format, order: Order, world: usize, index: usize) -> PlaneChoice {
    choice(if format.name == "vtp" { PLAIN } else { order }, world, index, SIZE)
}

/// The numbers of a slice and of its place.
fn all(slice: &Slice<Tensor2>) -> Vec<f64> {
    let lies = slice.cut.geometry;
    assert!(lies.is_placed());
    let place = [lies.corner(), lies.right(), lies.up()].into_iter().flatten().chain(lies.spacing());
    slice.field.values().iter().flat_map(Tensor2::components).chain(place).collect()
}

fn near(a: &Slice<Tensor2>, b: &Slice<Tensor2>, tolerance: f64) -> bool {
    a.field.grid() == b.field.grid() && all(a).iter().zip(all(b)).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// Volumes, upright to the last bit and oblique to that of the format.
#[test]
fn no_order_of_axes_shows_in_a_slice() {
    for (axes, tolerance) in [(UPRIGHT, 0.0), (OBLIQUE, SINGLE)] {
        for format in FORMATS {
            let through = |order| {
                let lattice = (format.through)(&volume(order, SIZE, axes)).unwrap();
                lattice.tensors(Reading::default()).unwrap()
            };
            let plain = through(PLAIN);
            for order in orders() {
                let turned = through(order);
                for (world, index) in [(0, 0), (0, 1), (1, 2), (2, 1)] {
                    let expected = plain.slice(choice(PLAIN, world, index, SIZE)).unwrap();
                    let found = turned.slice(choice_in(&format, order, world, index)).unwrap();
                    let what = format!("{} {order:?}, across {world} at {index}", format.name);
                    assert!(near(&found, &expected, tolerance), "{what}: {found:?}, expected {expected:?}");
                }
            }
        }
    }
}

/// The plain order itself is right: right and up are the world's axes in their order, positions those of the points.
#[test]
fn right_and_up_are_the_worlds() {
    let plain = volume(PLAIN, SIZE, UPRIGHT);
    for (world, right, up) in [(0, 1, 2), (1, 0, 2), (2, 0, 1)] {
        let slice = plain.slice(choice(PLAIN, world, 1, SIZE)).unwrap();
        let lies = slice.cut.geometry;
        assert_eq!((lies.right(), lies.up()), (UPRIGHT[right], UPRIGHT[up]));
        for (cell, tensor) in slice.field.iter() {
            let row = SIZE[up] - 1 - cell.y;
            let mut at = [1; 3];
            (at[right], at[up]) = (cell.x, row);
            let t: Vec<f64> = numbers(at, 9).collect();
            let expected = [(right, right), (right, up), (up, right), (up, up)].map(|(i, j)| t[3 * i + j]);
            assert_eq!(tensor.components(), expected, "across {world} at {cell:?}");
            let place = lies.place([cell.x as f64, row as f64]);
            assert_eq!(place, [0, 1, 2].map(|i| ORIGIN[i] + at[i] as f64 * SPACING[i]));
        }
    }
}

/// Files of one layer, and of one row, whose plane nobody chooses.
#[test]
fn no_order_of_axes_shows_in_a_single_layer() {
    let sizes = [[1, 3, 4], [2, 1, 4], [2, 3, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]];
    for (size, format) in sizes.into_iter().flat_map(|size| FORMATS.iter().map(move |f| (size, f))) {
        let through = |order| {
            let lattice = (format.through)(&volume(order, size, UPRIGHT)).unwrap();
            lattice.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap()
        };
        let expected = through(PLAIN);
        for order in orders() {
            let mut found = through(order);
            // Points of one row do not tell the distance of rows.
            if size.iter().filter(|n| **n == 1).count() == 2 {
                found.cut.geometry = expected.cut.geometry;
            }
            let what = format!("{} {size:?} {order:?}", format.name);
            assert!(near(&found, &expected, 0.0), "{what}: {found:?}, expected {expected:?}");
        }
    }
}

/// Vectors and numbers, which `--derive` takes.
#[test]
fn no_order_of_axes_shows_in_vectors_and_numbers() {
    let lattice = |order, components, wanted| {
        lattice_from_image(&image(order, SIZE, UPRIGHT, components), None, wanted).unwrap()
    };
    for order in orders() {
        for world in 0..3 {
            let [plain, turned] = [PLAIN, order].map(|o| choice(o, world, 1, SIZE));
            let vectors = |o, c| lattice(o, 3, Wanted::Vectors).vectors(c, None).unwrap().field;
            assert_eq!(vectors(order, turned), vectors(PLAIN, plain), "{order:?} across {world}");
            let scalars = |o, c| lattice(o, 1, Wanted::Scalars).scalars(c).unwrap().field;
            assert_eq!(scalars(order, turned), scalars(PLAIN, plain), "{order:?} across {world}");
        }
    }
}

/// What lies half-way between two axes of the world keeps the order of the file, whichever way its numbers are rounded.
#[test]
fn rounding_turns_no_picture() {
    let pictures = [-1e-12, 0.0, 1e-12].map(|off| {
        let mut image = image(PLAIN, SIZE, UPRIGHT, 9);
        let half = 0.5_f64.sqrt();
        image.direction = Some([half + off, -half, 0.0, half, half + off, 0.0, 0.0, 0.0, 1.0]);
        let lattice = lattice_from_image(&image, None, Wanted::Tensors).unwrap();
        let slice = lattice.tensors(Reading::default()).unwrap().slice(choice(PLAIN, 2, 0, SIZE)).unwrap();
        (slice.cut.geometry.right(), slice.field.grid())
    });
    for (right, grid) in pictures {
        assert_eq!((grid.width(), grid.height()), (2, 3));
        assert!(right[0] > 0.0 && right[1] > 0.0);
    }
}
