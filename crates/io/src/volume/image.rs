//! Between VTK image data and volumes.

use super::{Frame, IDENTITY, Known, Lattice, TensorOrder, TensorVolume, World};
use crate::convert::{Association, Rows, TENSOR_ARRAY, Wanted, choose_array};
use crate::points::PointLattice;
use crate::{ImageData, IoError, PolyData};

/// The array by which VTK's resampling filters mark points that lay outside their input, with 0.
const VALID_POINTS: &str = "vtkValidPointMask";

/// Takes an array out of poly data whose points form a lattice, x fastest.
///
/// # Errors
/// [`IoError::NoLattice`], and as [`lattice_from_image`]. Cell arrays belong to polygons and are not looked at.
pub fn lattice_from_points(data: PolyData, array: Option<&str>, wanted: Wanted) -> Result<Lattice, IoError> {
    let lattice = PointLattice::find(&data.points).map_err(|point| IoError::NoLattice { point })?;
    let mut image = ImageData::empty(lattice.size);
    lattice.place(&mut image);
    image.point_arrays = data.point_arrays;
    image.point_active = data.point_active;
    let mut found = lattice_from_image(&image, array, wanted)?;
    found.notes = vec!["a point array of VTK poly data whose points form a lattice".to_owned()];
    let left_out: Vec<String> = data.cell_arrays.into_iter().map(|a| format!("`{}`", a.name)).collect();
    if !left_out.is_empty() {
        found.notes.push(format!("arrays of polygons left out: {}", left_out.join(", ")));
    }
    Ok(found)
}

/// Takes an array out of an image: the named one, or the active one of the wanted kind, or the only one whose tuples fit.
/// Cell arrays form a lattice of cell centres. Points that VTK marked as invalid are masked.
///
/// # Errors
/// [`IoError::NoArray`], [`IoError::AmbiguousArray`], [`IoError::ArraySize`].
pub fn lattice_from_image(
    image: &ImageData,
    array: Option<&str>,
    wanted: Wanted,
) -> Result<Lattice, IoError> {
    let (association, array) = choose_array(image, array, wanted)?;
    let size = match association {
        Association::Points => image.dimensions,
        Association::Cells => image.cell_dimensions(),
    };
    let expected = size.iter().fold(array.components as u128, |n, &s| n.saturating_mul(s as u128));
    let found = array.values.len() as u128;
    if found != expected {
        return Err(IoError::ArraySize {
            array: array.name.clone(),
            byte: 0,
            found,
            expected,
            unit: "numbers",
        });
    }
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
    let names: Vec<String> = array.component_names.iter().map(|n| n.to_ascii_lowercase()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let valid = image
        .point_array(VALID_POINTS)
        .filter(|m| m.components == 1 && m.values.len() == size.iter().product::<usize>());
    let active = if association == Association::Points { &image.point_active } else { &image.cell_active };
    let named = TensorOrder::by_names(&names, array.components).ok();
    Ok(Lattice {
        size,
        components: array.components,
        values: array.values.clone(),
        scalar: array.scalar,
        axes,
        origin,
        world,
        measurement: None,
        mask: valid.filter(|_| association == Association::Points).map(|m| m.values.clone()),
        order: named
            .map(|order| (order, Known::Stated))
            .or_else(|| usual(array.components, active.tensors.as_ref() == Some(&array.name))),
        frame: (Frame::World, Known::Stated),
        array: array.name.clone(),
        notes: vec![format!("a {kind} array of VTK image data")],
    })
}

/// VTK's own orders of tensors: what the attribute `Tensors` means. Without it, six numbers may have another order, and
/// three may as well be a vector.
fn usual(components: usize, is_active: bool) -> Option<(TensorOrder, Known)> {
    match components {
        3 => None,
        6 => Some((TensorOrder::VTK, if is_active { Known::Stated } else { Known::Assumed })),
        _ => {
            let known = if is_active { Known::Stated } else { Known::Convention };
            TensorOrder::usual(components).map(|order| (order, known))
        }
    }
}

/// An image of the whole volume: nine named components, the active tensors. In the frame world the voxel axes keep
/// their directions and tensors are along the world's axes; in the frame voxel the image has the axes x, y, z and tensors
/// are along the voxel axes.
///
/// # Errors
/// [`IoError::SkewedAxes`] where components must be turned and cannot be.
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
