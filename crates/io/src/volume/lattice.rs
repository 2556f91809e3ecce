//! Numbers on a lattice as a file has them.

use super::error::VolumeError;
use super::matrix3::{IDENTITY, inverse, product};
use super::meaning::{Frame, Known, World};
use super::names::{Naming, naming};
use super::order::TensorOrder;
use crate::ScalarType;

/// Largest cosine between two axes that are still taken as orthogonal: files hold them in single precision.
const ORTHOGONAL: f64 = 1e-3;

/// Tuples of numbers on a lattice, as a file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Voxels along the three axes, each at least 1. The first runs fastest.
    pub size: [usize; 3],
    /// Numbers per tuple, a mask left out.
    pub components: usize,
    /// All numbers, tuple by tuple.
    pub values: Vec<f64>,
    /// Type in the file.
    pub scalar: ScalarType,
    /// Step along each voxel axis, in the world's axes and unit.
    pub axes: [[f64; 3]; 3],
    /// Position of the first voxel in the world.
    pub origin: [f64; 3],
    /// Unit of the positions, where the file states it.
    pub unit: Option<&'static str>,
    /// What the world is.
    pub world: World,
    /// Columns: axes of the measurement frame in the world, row by row.
    pub measurement: Option<[f64; 9]>,
    /// Confidence of each voxel; 0 where nothing was measured.
    pub mask: Option<Vec<f64>>,
    /// Order of the components and how it is known, where there is a reason for one.
    pub order: Option<(TensorOrder, Known)>,
    /// The frame of the components, stated or usual for the format.
    pub frame: (Frame, Known),
    /// Name of the array, or the words by which the format calls it.
    pub array: String,
    /// Names of the components as the file has them; empty where it has none.
    pub component_names: Vec<String>,
    /// What else was read or assumed, a sentence each.
    pub notes: Vec<String>,
    /// What was assumed or left out that changes the result and that no option says, a sentence each.
    pub remarks: Vec<String>,
    /// The same, but only worth saying where the user does not state the component order.
    pub order_remarks: Vec<String>,
    /// What looks wrong in the file, a sentence each.
    pub warnings: Vec<String>,
}

impl Lattice {
    /// Seven numbers a voxel are a mask before six others, as NRRD has them: the mask apart.
    #[must_use]
    pub fn with_mask_apart(mut self) -> Self {
        if self.components == 7 {
            let tuples = self.values.as_chunks::<7>().0;
            self.mask = Some(tuples.iter().map(|t| t[0]).collect());
            self.values = tuples.iter().flat_map(|t| t[1..].iter().copied()).collect();
            self.components = 6;
            self.order = Some((TensorOrder::UPPER, Known::Assumed));
            self.warnings.push("seven numbers taken as a mask and xx,xy,xz,yy,yz,zz".to_owned());
        }
        self
    }

    /// The same lattice with the numbers of an array that names its components.
    #[must_use]
    pub(crate) fn with_array(self, array: crate::DataArray) -> Self {
        let order = match naming(&array.component_names, array.components) {
            Naming::Tensor(order) => Some((order, Known::Stated)),
            _ => None,
        };
        Self {
            components: array.components,
            values: array.values,
            scalar: array.scalar,
            order,
            array: array.name,
            component_names: array.component_names,
            ..self
        }
    }

    /// Whether FSL's axes have the first voxel axis reversed: the determinant of the affine, in a world that runs to
    /// the right, anterior and superior, is positive.
    #[must_use]
    pub fn reverses_x_for_fsl(&self) -> bool {
        // FSL takes a volume of which nobody says how it lies as one that needs no reversal.
        if self.is_of_scanner() && self.world.signs().is_none() {
            return false;
        }
        let [a, b, c] = self.directions_by_axis();
        let signs = self.world.signs().unwrap_or([1.0; 3]);
        let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        determinant * signs.iter().product::<f64>() > 0.0
    }

    /// Whether the world is a patient's or scanner's.
    #[must_use]
    pub const fn is_of_scanner(&self) -> bool {
        matches!(self.world, World::Scanner(_))
    }

    /// Whether a voxel axis does not run along the world's axis of its own number.
    #[must_use]
    pub fn has_turned_axes(&self) -> bool {
        self.directions() != IDENTITY
    }

    /// Unit vectors along the voxel axes, one after the other.
    fn directions_by_axis(&self) -> [[f64; 3]; 3] {
        let d = self.directions();
        [0, 1, 2].map(|a| [d[a], d[a + 3], d[a + 6]])
    }

    /// The axes left, posterior and superior in the world, one a column.
    pub(super) fn lps(&self) -> [f64; 9] {
        let [x, y, z] = self.world.signs().unwrap_or([1.0; 3]);
        [-x, 0.0, 0.0, 0.0, -y, 0.0, 0.0, 0.0, z]
    }

    /// Whether components have names that say nothing of a tensor.
    #[must_use]
    pub fn has_unknown_names(&self) -> bool {
        naming(&self.component_names, self.components) == Naming::Other
    }

    /// The signs that turn the voxel axes into FSL's.
    pub(super) fn fsl_signs(&self) -> [f64; 9] {
        let x = if self.reverses_x_for_fsl() { -1.0 } else { 1.0 };
        [x, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    }

    /// What was read, a sentence each.
    #[must_use]
    pub fn story(&self) -> Vec<String> {
        let mut story =
            vec![format!("`{}`: {} components, {}", self.array, self.components, self.scalar.name())];
        if let World::Scanner(name) = &self.world {
            story.push(format!("world: {name}"));
        }
        if let Some(mask) = &self.mask {
            let masked = mask.iter().filter(|&&m| m == 0.0).count();
            story.push(format!("{masked} voxels masked out, taken as zero tensors"));
        }
        story.extend(self.notes.iter().chain(&self.remarks).cloned());
        story
    }

    /// The axes that vectors are along, as `given` or as the file has them, in words; single numbers are along none.
    #[must_use]
    pub fn words_of_vectors(&self, given: Option<Frame>) -> Option<String> {
        let (frame, known) = given.map_or(self.frame, |frame| (frame, Known::Given));
        (self.components > 1).then(|| format!("vectors along {} ({})", frame.words(), known.words()))
    }

    /// Voxels in all.
    #[must_use]
    pub fn voxels(&self) -> usize {
        self.size.iter().product()
    }

    /// Distance of the voxels along each axis, in the world's unit; 1 for an axis without length.
    #[must_use]
    pub fn spacing(&self) -> [f64; 3] {
        self.axes.map(|a| {
            let length = tigereye_core::math::hypot(tigereye_core::math::hypot(a[0], a[1]), a[2]);
            if length > 0.0 && length.is_finite() { length } else { 1.0 }
        })
    }

    /// Directions of the voxel axes in the world, one a column, row by row.
    #[must_use]
    pub fn directions(&self) -> [f64; 9] {
        let spacing = self.spacing();
        let mut columns = [0, 1, 2].map(|a| self.axes[a].map(|v| v / spacing[a]));
        for (a, column) in columns.iter_mut().enumerate() {
            if *column == [0.0; 3] {
                column[a] = 1.0;
            }
        }
        let at = |i: usize| columns[i % 3][i / 3];
        [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)]
    }

    /// What turns components in `frame` into components along the voxel axes, `K v` or `K D K^T`; `None` where nothing
    /// does.
    pub(crate) fn to_voxel(&self, frame: Frame) -> Result<Option<[f64; 9]>, VolumeError> {
        let measured = match (frame, self.measurement) {
            (Frame::Voxel, _) => return Ok(None),
            (Frame::Fsl, _) => return Ok(self.reverses_x_for_fsl().then(|| self.fsl_signs())),
            (Frame::Measurement, Some(m)) => m,
            (Frame::Lps, _) => self.lps(),
            // A measurement frame that the file does not state was refused before.
            (Frame::World, _) | (Frame::Measurement, None) => IDENTITY,
        };
        let directions = self.orthogonal_directions()?;
        if directions == measured {
            return Ok(None);
        }
        inverse(&directions).map(|r| Some(product(&r, &measured))).ok_or(VolumeError::SkewedAxes { off: 1.0 })
    }

    pub(super) fn orthogonal_directions(&self) -> Result<[f64; 9], VolumeError> {
        self.skew().map_or_else(|| Ok(self.directions()), |off| Err(VolumeError::SkewedAxes { off }))
    }

    /// The largest cosine between two voxel axes, where they are not at right angles.
    #[must_use]
    pub fn skew(&self) -> Option<f64> {
        let d = self.directions();
        let cosine = |a: usize, b: usize| (d[a] * d[b] + d[a + 3] * d[b + 3] + d[a + 6] * d[b + 6]).abs();
        let off = cosine(0, 1).max(cosine(0, 2)).max(cosine(1, 2));
        // What is no number is no right angle.
        (off.is_nan() || off > ORTHOGONAL).then_some(off)
    }
}
