//! Between VTK image data and volumes.

use super::convention::Content;
use super::error::VolumeError;
use super::geometry::world_axes;
use super::lattice::Lattice;
use super::matrix3::IDENTITY;
use super::meaning::{Frame, Known, World};
use super::names::{Naming, naming};
use super::tensors::TensorVolume;
use crate::array_error::ArrayError;
use crate::convert::{
    ArrayChoice, Association, GHOSTS, Rows, TENSOR_ARRAY, VALID_POINTS, Wanted, choose_array, left_aside,
};
use crate::points::PointLattice;
use crate::{DataArray, ImageData, IoError, PolyData};

/// Bits of `vtkGhostType`: points that are hidden, and cells that are hidden or replaced by finer ones
/// (vtkDataSetAttributes.h of VTK 9). Duplicates of other pieces are data like any other.
pub(crate) const HIDDEN_POINT: u8 = 2;
const HIDDEN_CELL: u8 = 32 | 8;

/// Takes an array out of poly data whose points form a lattice, which has the world's axes x, y and z in this order
/// whatever the order of the points: points are voxels without an order of their own. Points of a turned lattice go row
/// by row in any direction; its axes have the order and the signs of the world's that they are nearest to.
///
/// # Errors
/// [`VolumeError::NoLattice`], and as [`lattice_from_image`]. Cell arrays belong to polygons and are not looked at.
pub fn lattice_from_points<'a>(
    data: PolyData,
    array: impl Into<ArrayChoice<'a>>,
    wanted: Wanted,
) -> Result<Lattice, IoError> {
    let (lattice, order) = match PointLattice::scattered(&data.points) {
        Ok(found) => found,
        Err(_) => {
            let turned = PointLattice::find(&data.points);
            along_the_world(&turned.map_err(|point| VolumeError::NoLattice { point })?)
        }
    };
    let is_ordered = order.iter().enumerate().all(|(place, &point)| place == point);
    let mut image = ImageData::empty(lattice.size);
    lattice.place(&mut image);
    image.point_arrays = data.point_arrays;
    if !is_ordered {
        image.point_arrays.iter_mut().for_each(|array| array.reorder(&order));
    }
    image.point_active = data.point_active;
    image.skipped = data.skipped;
    let mut found = lattice_from_image(&image, array, wanted)?;
    found.notes[0] = "a point array of VTK poly data whose points form a lattice".to_owned();
    if !is_ordered {
        found.notes.push("points put in the order of their lattice".to_owned());
    }
    let left_out: Vec<String> = data.cell_arrays.into_iter().map(|a| format!("`{}`", a.name)).collect();
    if !left_out.is_empty() {
        found.notes.push(format!("arrays of polygons left out: {}", left_out.join(", ")));
    }
    Ok(found)
}

/// A lattice with its axes in the order of the world's that they are nearest to, running their way, and which of its
/// points is at each place, the first axis fastest.
fn along_the_world(lattice: &PointLattice) -> (PointLattice, Vec<usize>) {
    let assigned = world_axes(&lattice.axes);
    // The axis of the lattice for each of the world's.
    let own = [0, 1, 2].map(|world| (0..3).find(|&a| assigned[a] == world).unwrap_or(world));
    let is_reversed = |axis: usize| lattice.axes[axis][assigned[axis]] < 0.0;
    let mut origin = lattice.origin;
    for axis in (0..3).filter(|&a| is_reversed(a)) {
        let steps = (lattice.size[axis] - 1) as f64;
        (0..3).for_each(|i| origin[i] += steps * lattice.axes[axis][i]);
    }
    let axes = own.map(|a| lattice.axes[a].map(|v| if is_reversed(a) { -v } else { v }));
    let size = own.map(|a| lattice.size[a]);
    let strides = [1, lattice.size[0], lattice.size[0] * lattice.size[1]];
    let point = |place: usize| {
        let at = [place % size[0], place / size[0] % size[1], place / (size[0] * size[1])];
        let along = |(i, &axis): (usize, &usize)| {
            strides[axis] * if is_reversed(axis) { size[i] - 1 - at[i] } else { at[i] }
        };
        own.iter().enumerate().map(along).sum()
    };
    let order = (0..size.iter().product()).map(point).collect();
    (PointLattice { size, axes, origin }, order)
}

/// Takes an array out of an image: the named one, or the active one of the wanted kind, or the only one whose tuples
/// fit; where there is none, the one whose components are arrays of their own (`S_XX`, `S_YY`, `S_XY`). Cell arrays
/// form a lattice of cell centres. Points that VTK marked as invalid or hidden are masked.
///
/// # Errors
/// [`crate::ChoiceError::NoArray`], [`crate::ChoiceError::Ambiguous`], [`VolumeError::Principal`],
/// [`VolumeError::UnequalComponents`], [`ArrayError::Size`].
pub fn lattice_from_image<'a>(
    image: &ImageData,
    array: impl Into<ArrayChoice<'a>>,
    wanted: Wanted,
) -> Result<Lattice, IoError> {
    let choice = array.into();
    let found = choose_array(image, choice, wanted)?;
    let is_usual = matches!(choice, ArrayChoice::Usual);
    let mut remarks: Vec<String> =
        left_aside(image, wanted, &found).filter(|_| is_usual).into_iter().collect();
    let (association, array) = found;
    let size = match association {
        Association::Points => image.dimensions,
        Association::Cells => image.cell_dimensions(),
    };
    check_size(&array, size)?;
    let d = image.direction.unwrap_or(IDENTITY);
    let mut axes = [0, 1, 2].map(|a| [0, 1, 2].map(|i| d[3 * i + a] * image.spacing[a]));
    let mut origin = image.origin;
    if association == Association::Cells {
        for a in 0..3 {
            // An axis with one point has no cells between points.
            if image.dimensions[a] > 1 {
                (0..3).for_each(|i| origin[i] += 0.5 * axes[a][i]);
            }
        }
    }
    let mut world = World::Viewer;
    if Rows::of(image, &array.name) == Rows::Downwards {
        // A result that lies nowhere has its first row on top.
        (0..3).for_each(|i| origin[i] += (size[1] - 1) as f64 * axes[1][i]);
        axes[1] = axes[1].map(|v| -v);
        world = World::Absent;
    }
    let kind = if association == Association::Points { "point" } else { "cell" };
    let notes = vec![format!("an array of the {kind}s")];
    let (mask, said) = mask_of(image, association);
    remarks.extend(said);
    let (content, order) = meaning(image, association, &array);
    let array = array.into_owned();
    Ok(Lattice {
        size,
        components: array.components,
        values: array.values,
        scalar: array.scalar,
        axes,
        origin,
        unit: None,
        world,
        measurement: None,
        mask,
        order,
        frame: content.frame(array.components),
        array: array.name,
        component_names: array.component_names,
        notes,
        remarks,
        order_remarks: Vec::new(),
        warnings: Vec::new(),
    })
}

fn check_size(array: &DataArray, size: [usize; 3]) -> Result<(), IoError> {
    let expected = size.iter().fold(array.components as u128, |n, &s| n.saturating_mul(s as u128));
    let found = array.values.len() as u128;
    if found == expected {
        return Ok(());
    }
    let array = array.name.clone();
    Err(ArrayError::Size { array, byte: 0, found, expected, unit: "numbers" }.into())
}

/// What an array is, and the order of its components: by their names, else by the tables.
fn meaning(
    image: &ImageData,
    association: Association,
    array: &DataArray,
) -> (Content, Option<(super::TensorOrder, Known)>) {
    let active = if association == Association::Points { &image.point_active } else { &image.cell_active };
    let is_active = active.tensors.as_ref() == Some(&array.name);
    let content = if is_active { Content::VtkTensors } else { Content::VtkArray };
    let order = match naming(&array.component_names, array.components) {
        Naming::Tensor(order) => Some((order, Known::Stated)),
        // Only six and nine numbers are VTK's tensors.
        _ => content.order(array.components).or_else(|| Content::VtkArray.order(array.components)),
    };
    (content, order)
}

/// What VTK left out: points that lay outside of what was resampled, hidden points and cells. A point is hidden with
/// all cells around it, a cell with any of its points, as VTK shows them.
fn mask_of(image: &ImageData, association: Association) -> (Option<Vec<f64>>, Option<String>) {
    let flags = |arrays: &[DataArray], size: [usize; 3], name: &str, is_out: &dyn Fn(f64) -> bool| {
        let array = arrays.iter().find(|a| a.name == name && a.components == 1)?;
        let fits = array.values.len() == size.iter().product::<usize>();
        fits.then(|| array.values.iter().map(|&v| is_out(v)).collect::<Vec<bool>>())
    };
    let bits = |mask: u8| move |v: f64| v as u8 & mask != 0;
    let (points, cells) = (image.dimensions, image.cell_dimensions());
    let hidden_points = flags(&image.point_arrays, points, GHOSTS, &bits(HIDDEN_POINT));
    let hidden_cells = flags(&image.cell_arrays, cells, GHOSTS, &bits(HIDDEN_CELL));
    let invalid = flags(&image.point_arrays, points, VALID_POINTS, &|v| v == 0.0);
    let (size, own, others) = match association {
        Association::Points => {
            let around = hidden_cells.map(|h| spread(&h, cells, points, true));
            (points, [invalid, hidden_points.clone()], around)
        }
        Association::Cells => {
            let any = hidden_points.map(|h| spread(&h, points, cells, false));
            (cells, [None, hidden_cells.clone()], any)
        }
    };
    let all: Vec<Vec<bool>> = own.into_iter().flatten().chain(others).collect();
    if all.is_empty() {
        return (None, None);
    }
    let out = |i: usize| all.iter().any(|flags| flags[i]);
    let mask: Vec<f64> = (0..size.iter().product()).map(|i| if out(i) { 0.0 } else { 1.0 }).collect();
    let hidden = mask.iter().filter(|m| **m == 0.0).count();
    let what = if association == Association::Points { "points" } else { "cells" };
    let note =
        (hidden > 0).then(|| format!("{hidden} {what} hidden or invalid in VTK ({GHOSTS}, {VALID_POINTS})"));
    (Some(mask), note)
}

/// Flags of cells at points, or of points at cells: whether all (or any) of those that touch are set.
fn spread(flags: &[bool], from: [usize; 3], to: [usize; 3], all: bool) -> Vec<bool> {
    let range = |axis: usize, at: usize| -> std::ops::Range<usize> {
        match to[axis].cmp(&from[axis]) {
            std::cmp::Ordering::Equal => at..at + 1,
            // A point between cells.
            std::cmp::Ordering::Greater => at.saturating_sub(1)..(at + 1).min(from[axis]),
            // A cell between points.
            std::cmp::Ordering::Less => at..at + 2,
        }
    };
    let flag = |[x, y, z]: [usize; 3]| flags[(z * from[1] + y) * from[0] + x];
    let at = |i: usize| [i % to[0], i / to[0] % to[1], i / (to[0] * to[1])];
    let touching = |i: usize| {
        let [x, y, z] = at(i);
        let (rx, ry, rz) = (range(0, x), range(1, y), range(2, z));
        let mut neighbours = rz.flat_map(|z| {
            let rx = rx.clone();
            ry.clone().flat_map(move |y| rx.clone().map(move |x| [x, y, z]))
        });
        if all { neighbours.all(flag) } else { neighbours.any(flag) }
    };
    (0..to.iter().product()).map(touching).collect()
}

/// An image of the whole volume: nine named components, the active tensors. In the frame world the voxel axes keep
/// their directions and tensors are along the world's axes; in the frame voxel the image has the axes x, y, z and
/// tensors are along the voxel axes.
///
/// # Errors
/// [`VolumeError::SkewedAxes`] where components must be turned and cannot be.
pub fn image_from_volume(volume: &TensorVolume, frame: Frame) -> Result<ImageData, IoError> {
    let lattice = volume.lattice();
    let values = volume.along(frame)?.into_iter().flatten().collect();
    let mut image = ImageData::empty(lattice.size);
    image.spacing = lattice.spacing();
    if frame != Frame::Voxel {
        image.origin = lattice.origin;
        image.direction = volume.turned_directions();
    }
    let array = crate::DataArray::new(TENSOR_ARRAY, 9, values)
        .with_component_names(&["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"]);
    image.point_active.tensors = Some(TENSOR_ARRAY.to_owned());
    image.point_arrays.push(array);
    Ok(image)
}

/// Positions of the points of an image.
pub(crate) fn points_of_image(image: &ImageData) -> impl Iterator<Item = [f64; 3]> {
    let d = image.direction.unwrap_or(IDENTITY);
    let ([nx, ny, nz], origin, spacing) = (image.dimensions, image.origin, image.spacing);
    (0..nx * ny * nz).map(move |i| {
        let at = [i % nx, i / nx % ny, i / (nx * ny)];
        let step = [0, 1, 2].map(|a| at[a] as f64 * spacing[a]);
        [0, 1, 2].map(|k| origin[k] + d[3 * k] * step[0] + d[3 * k + 1] * step[1] + d[3 * k + 2] * step[2])
    })
}

/// The points of an image as poly data, with squares between them where it has one layer, else each alone.
#[must_use]
pub fn points_from_image(image: ImageData) -> PolyData {
    let [nx, ny, nz] = image.dimensions;
    let mut data = PolyData { points: points_of_image(&image).collect(), ..PolyData::default() };
    if nz == 1 && nx > 1 && ny > 1 {
        for y in 0..ny - 1 {
            for i in y * nx..y * nx + nx - 1 {
                data.polys.push([i, i + 1, i + nx + 1, i + nx]);
            }
        }
    } else {
        (0..data.points.len()).for_each(|i| data.verts.push([i]));
    }
    data.point_arrays = image.point_arrays;
    data.point_active = image.point_active;
    data.field_data = image.field_data;
    data
}
