//! What writers of volumes share.

use super::{Frame, IDENTITY, Known, Lattice, TensorOrder, TensorVolume, World, turned};
use crate::{IoError, ScalarType};
use tigereye_core::{Field, Tensor2};

/// Difference of two components that counts as rounding, relative to the largest component of the volume.
const ROUNDING: f64 = 1e-12;

impl TensorVolume {
    /// A field of the plane as a volume of one layer: row 0 of the field is the row of the largest y, the third row and
    /// column are zero. `origin` is the position of the lower left point.
    #[must_use]
    pub fn from_field(field: &Field<Tensor2>, origin: [f64; 2], spacing: [f64; 2]) -> Self {
        let grid = field.grid();
        let rows = field.values().chunks(grid.width()).rev();
        let values = rows.flatten().flat_map(|t| {
            let [xx, xy, yx, yy] = t.components();
            [xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 0.0]
        });
        let order = TensorOrder::ROWS3;
        let lattice = Lattice {
            size: [grid.width(), grid.height(), 1],
            components: order.components(),
            values: values.collect(),
            scalar: ScalarType::Float64,
            axes: [[spacing[0], 0.0, 0.0], [0.0, spacing[1], 0.0], [0.0, 0.0, 1.0]],
            origin: [origin[0], origin[1], 0.0],
            world: World::Viewer,
            measurement: None,
            mask: None,
            order: Some(order),
            frame: (Frame::World, Known::Stated),
            array: "field".to_owned(),
            notes: Vec::new(),
        };
        Self { lattice, order: (order, Known::Stated), frame: (Frame::World, Known::Stated) }
    }

    /// All tensors along the axes of `frame` (world or voxel), row by row; those of voxels with mask 0 are zero.
    ///
    /// # Errors
    /// [`IoError::SkewedAxes`] where components must be turned and cannot be.
    pub(crate) fn along(&self, frame: Frame) -> Result<Vec<[f64; 9]>, IoError> {
        let turn = if frame == Frame::Voxel { self.to_voxel()? } else { self.to_world()? };
        let tensor = |(voxel, t): (usize, [f64; 9])| {
            if self.is_masked(voxel) { [0.0; 9] } else { turn.as_ref().map_or(t, |k| turned(k, &t)) }
        };
        Ok(self.tensors().enumerate().map(tensor).collect())
    }

    /// Whether the file says that nothing was measured in a voxel.
    pub(crate) fn is_masked(&self, voxel: usize) -> bool {
        self.lattice.mask.as_ref().is_some_and(|m| m.get(voxel) == Some(&0.0))
    }

    /// Directions of the axes row by row, where they are not x, y and z.
    pub(crate) fn turned_directions(&self) -> Option<[f64; 9]> {
        let directions = self.lattice.directions();
        (directions != IDENTITY).then_some(directions)
    }
}

/// Whether all tensors are symmetric up to rounding.
pub(crate) fn symmetric(tensors: &[[f64; 9]]) -> bool {
    let largest = tensors.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let off = |t: &[f64; 9]| (t[1] - t[3]).abs().max((t[2] - t[6]).abs()).max((t[5] - t[7]).abs());
    tensors.iter().all(|t| off(t) <= ROUNDING * largest)
}
