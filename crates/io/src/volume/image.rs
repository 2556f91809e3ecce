//! Between VTK image data and volumes.

use super::{Frame, IDENTITY, Known, Lattice, TensorOrder, TensorVolume, World, turned};
use crate::convert::{Association, TENSOR_ARRAY, choose_tensors};
use crate::{ImageData, IoError};

/// Takes the tensor array out of an image: the named one, or the active tensors, or the only array that may be tensors.
/// Cell arrays form a lattice of cell centres.
///
/// # Errors
/// [`IoError::NoArray`], [`IoError::AmbiguousArray`], [`IoError::ArraySize`].
pub fn lattice_from_image(image: &ImageData, array: Option<&str>) -> Result<Lattice, IoError> {
    let (association, array) = choose_tensors(image, array)?;
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
    let axes = [0, 1, 2].map(|a| [0, 1, 2].map(|i| d[3 * i + a] * image.spacing[a]));
    let mut origin = image.origin;
    if association == Association::Cells {
        for a in 0..3 {
            // An axis with one point has no cells between points.
            if image.dimensions[a] > 1 {
                (0..3).for_each(|i| origin[i] += 0.5 * axes[a][i]);
            }
        }
    }
    let kind = if association == Association::Points { "point" } else { "cell" };
    let names: Vec<String> = array.component_names.iter().map(|n| n.to_ascii_lowercase()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let named = TensorOrder::by_names(&names, array.components).ok();
    Ok(Lattice {
        size,
        components: array.components,
        values: array.values.clone(),
        scalar: array.scalar,
        axes,
        origin,
        world: World::Viewer,
        measurement: None,
        mask: None,
        order: named.or_else(|| TensorOrder::usual(array.components)).or_else(|| usual6(array.components)),
        frame: (Frame::World, Known::Stated),
        array: array.name.clone(),
        notes: vec![format!("a {kind} array of VTK image data")],
    })
}

/// VTK's own order of symmetric tensors is part of its format.
fn usual6(components: usize) -> Option<TensorOrder> {
    (components == 6).then_some(TensorOrder::VTK)
}

/// An image of the whole volume: nine named components, the active tensors. In the frame world the voxel axes keep
/// their directions and tensors are along the world's axes; in the frame voxel the image has the axes x, y, z and tensors
/// are along the voxel axes.
///
/// # Errors
/// [`IoError::SkewedAxes`] where components must be turned and cannot be.
pub fn image_from_volume(volume: &TensorVolume, frame: Frame) -> Result<ImageData, IoError> {
    let lattice = volume.lattice();
    let turn = if frame == Frame::Voxel { volume.to_voxel()? } else { volume.to_world()? };
    let mut values = Vec::with_capacity(9 * lattice.voxels());
    for (voxel, t) in volume.tensors().enumerate() {
        if lattice.mask.as_ref().is_some_and(|m| m.get(voxel) == Some(&0.0)) {
            values.extend([0.0; 9]);
        } else {
            values.extend(turn.as_ref().map_or(t, |k| turned(k, &t)));
        }
    }
    let mut image = ImageData::empty(lattice.size);
    image.spacing = lattice.spacing();
    if frame != Frame::Voxel {
        image.origin = lattice.origin;
        let directions = lattice.directions();
        image.direction = (directions != IDENTITY).then_some(directions);
    }
    let array = crate::DataArray::new(TENSOR_ARRAY, 9, values)
        .with_component_names(&["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"]);
    image.point_active.tensors = Some(TENSOR_ARRAY.to_owned());
    image.point_arrays.push(array);
    Ok(image)
}
