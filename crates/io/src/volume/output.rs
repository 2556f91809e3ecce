//! What writers of volumes share.

use super::geometry::PlaneGeometry;
use super::lattice::Lattice;
use super::matrix3::{IDENTITY, product, turned};
use super::meaning::{Frame, Known, Shear, World};
use super::order::TensorOrder;
use super::tensors::TensorVolume;
use crate::{IoError, ScalarType};
use tigereye_core::{Field, Tensor2};

/// Difference of two components that counts as rounding, relative to the largest component of the volume. It decides
/// how tensors are written, not what they are: with six components where nothing is lost, with nine otherwise, and both
/// read back alike.
const ROUNDING: f64 = 1e-12;

impl Lattice {
    /// A field of the plane as a lattice of one layer, row 0 on top as in the field. The lower left point is at 0,
    /// points have distance 1.
    #[must_use]
    pub fn from_field(field: &Field<Tensor2>) -> Self {
        let grid = field.grid();
        let order = TensorOrder::ROWS2;
        Self {
            size: [grid.width(), grid.height(), 1],
            components: order.components(),
            values: field.values().iter().flat_map(Tensor2::components).collect(),
            scalar: ScalarType::Float64,
            axes: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
            origin: [0.0, (grid.height() - 1) as f64, 0.0],
            unit: None,
            world: World::Absent,
            measurement: None,
            mask: None,
            order: Some((order, Known::Convention)),
            frame: (Frame::World, Known::Convention),
            array: "2x2 blocks".to_owned(),
            component_names: Vec::new(),
            notes: vec!["first row on top, in the frame x right, y up".to_owned()],
            remarks: Vec::new(),
            order_remarks: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

impl TensorVolume {
    /// A field of the plane as a volume of one layer, its third row and column zero: row 0 of the field is the row of
    /// the largest y. It lies in the world where right and up are the world's x and y, else in a flat frame of its own.
    #[must_use]
    pub fn from_field(field: &Field<Tensor2>, geometry: &PlaneGeometry) -> Self {
        let rows = field.values().chunks(field.grid().width()).rev();
        let upright = geometry.upright();
        let [dx, dy] = upright.spacing();
        let lattice = Lattice {
            values: rows.flatten().flat_map(Tensor2::components).collect(),
            axes: [[dx, 0.0, 0.0], [0.0, dy, 0.0], [0.0, 0.0, 1.0]],
            origin: upright.corner(),
            unit: None,
            world: World::Viewer,
            ..Lattice::from_field(field)
        };
        let (order, frame) = ((TensorOrder::ROWS2, Known::Stated), lattice.frame);
        Self { lattice, order, frame, shear: (Shear::Tensor, Known::Stated) }
    }

    /// The same tensors in a world of another name.
    #[must_use]
    pub fn with_world(mut self, world: World) -> Self {
        self.lattice.world = world;
        self
    }

    /// The same tensors, to be written in the precision of another type.
    #[must_use]
    pub fn with_scalar(mut self, scalar: ScalarType) -> Self {
        self.lattice.scalar = scalar;
        self
    }

    /// All tensors along the axes of `frame` (world, voxel or FSL's), row by row; those of voxels with mask 0 are zero.
    ///
    /// # Errors
    /// [`crate::volume::VolumeError::SkewedAxes`] where components must be turned and cannot be.
    pub(crate) fn along(&self, frame: Frame) -> Result<Vec<[f64; 9]>, IoError> {
        let turn = match frame {
            Frame::Voxel => self.lattice.to_voxel(self.frame.0)?,
            Frame::Fsl => {
                let signs = self.lattice.fsl_signs();
                let to_voxel = self.lattice.to_voxel(self.frame.0)?;
                Some(to_voxel.map_or(signs, |k| product(&signs, &k))).filter(|k| *k != IDENTITY)
            }
            Frame::World | Frame::Measurement | Frame::Lps => self.to_world()?,
        };
        let tensor = |(voxel, t): (usize, [f64; 9])| {
            if self.is_masked(voxel) { [0.0; 9] } else { turn.as_ref().map_or(t, |k| turned(k, &t)) }
        };
        Ok(self.tensors().enumerate().map(tensor).collect())
    }

    /// All tensors along the world's axes, row by row; those of voxels with mask 0 are zero.
    ///
    /// # Errors
    /// [`crate::volume::VolumeError::SkewedAxes`] where components must be turned and cannot be.
    pub fn in_world(&self) -> Result<Vec<[f64; 9]>, IoError> {
        self.along(Frame::World)
    }

    /// Whether the file says that nothing was measured in a voxel.
    #[must_use]
    pub fn is_masked(&self, voxel: usize) -> bool {
        self.lattice.mask.as_ref().is_some_and(|m| m.get(voxel) == Some(&0.0))
    }

    /// Directions of the axes row by row, where they are not x, y and z.
    pub(crate) fn turned_directions(&self) -> Option<[f64; 9]> {
        let directions = self.lattice.directions();
        (directions != IDENTITY).then_some(directions)
    }
}

/// The type to write numbers of a file in: its own precision, as programs expect it (teem's `tend` takes no double).
pub(crate) const fn written_scalar(read: ScalarType) -> ScalarType {
    match read {
        ScalarType::Float32
        | ScalarType::Int8
        | ScalarType::UInt8
        | ScalarType::Int16
        | ScalarType::UInt16 => ScalarType::Float32,
        _ => ScalarType::Float64,
    }
}

/// Whether all tensors are symmetric up to rounding.
pub(crate) fn symmetric(tensors: &[[f64; 9]]) -> bool {
    let largest = tensors.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let off = |t: &[f64; 9]| (t[1] - t[3]).abs().max((t[2] - t[6]).abs()).max((t[5] - t[7]).abs());
    tensors.iter().all(|t| off(t) <= ROUNDING * largest)
}
