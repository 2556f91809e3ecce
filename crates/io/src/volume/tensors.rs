//! Tensors on a lattice: the numbers of a file with what they mean.

use super::convention::Alias;
use super::error::VolumeError;
use super::lattice::Lattice;
use super::matrix3::{IDENTITY, product};
use super::meaning::{Frame, Known, Shear};
use super::names::{Naming, names_principal_values, names_strain, naming};
use super::order::TensorOrder;

/// What the user says about components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading<'a> {
    /// An alias or component names, see [`TensorOrder::parse`].
    pub order: Option<&'a str>,
    /// The frame of the components.
    pub frame: Option<Frame>,
    /// What shear components are; those of the tensor where nobody says so.
    pub shear: Option<Shear>,
}

/// Tensors on a lattice, with what was read and what was assumed.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorVolume {
    pub(super) lattice: Lattice,
    pub(super) order: (TensorOrder, Known),
    pub(super) frame: (Frame, Known),
    pub(super) shear: (Shear, Known),
}

impl Lattice {
    /// The tensors, with the user's words before the file's, and the file's before what is usual for the format
    /// ([`crate::volume::CONVENTIONS`]). An alias of the order may bring the frame of its program, where the file does
    /// not state one.
    ///
    /// # Errors
    /// [`VolumeError::NoTensor`], [`VolumeError::Principal`], [`VolumeError::Order`],
    /// [`VolumeError::NoMeasurementFrame`], and [`VolumeError::NoSharedShear`] for engineering shears where xy and yx
    /// are two numbers.
    pub fn tensors(self, reading: Reading) -> Result<TensorVolume, VolumeError> {
        let this = self.with_mask_apart();
        this.tensors_of_tuples(reading)
    }

    fn tensors_of_tuples(mut self, reading: Reading) -> Result<TensorVolume, VolumeError> {
        let order = match (reading.order, self.order) {
            (Some(text), _) => (TensorOrder::parse(text, self.components)?, Known::Given),
            (None, _) if self.holds_principal_values() => {
                return Err(VolumeError::Principal {
                    array: self.array,
                    names: self.component_names.join(", "),
                });
            }
            (None, Some(order)) => order,
            (None, None) => {
                return Err(VolumeError::NoTensor { array: self.array, components: self.components });
            }
        };
        let of_program = reading.order.and_then(Alias::named).and_then(|alias| alias.frame);
        let frame = match (reading.frame, of_program) {
            (Some(frame), _) => (frame, Known::Given),
            (None, Some(frame)) if self.frame.1 == Known::Assumed => (frame, Known::Convention),
            _ => self.frame,
        };
        if frame.0 == Frame::Measurement && self.measurement.is_none() {
            return Err(VolumeError::NoMeasurementFrame);
        }
        if reading.order.is_none() {
            self.remarks.append(&mut self.order_remarks);
        }
        if reading.shear == Some(Shear::Engineering) {
            self.halve_shears(order.0)?;
        }
        let shear = reading.shear.map_or((Shear::Tensor, Known::Assumed), |shear| (shear, Known::Given));
        Ok(TensorVolume { lattice: self, order, frame, shear })
    }

    /// Whether the names say that the numbers have no directions.
    fn holds_principal_values(&self) -> bool {
        match naming(&self.component_names, self.components) {
            Naming::Principal => true,
            Naming::Unnamed => self.components == 3 && names_principal_values(&self.array),
            Naming::Tensor(_) | Naming::Other => false,
        }
    }

    /// Engineering shears to components of the tensor.
    fn halve_shears(&mut self, order: TensorOrder) -> Result<(), VolumeError> {
        if !order.has_shared_shears() {
            return Err(VolumeError::NoSharedShear { order: order.to_string() });
        }
        for tuple in self.values.chunks_exact_mut(self.components) {
            order.shears().for_each(|at| tuple[at] *= 0.5);
        }
        self.notes.push("engineering shears halved".to_owned());
        Ok(())
    }
}

impl TensorVolume {
    /// What the file holds.
    #[must_use]
    pub const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Order of the components, and how it is known.
    #[must_use]
    pub const fn order(&self) -> (TensorOrder, Known) {
        self.order
    }

    /// Frame of the components, and how it is known.
    #[must_use]
    pub const fn frame(&self) -> (Frame, Known) {
        self.frame
    }

    /// The tensor of a voxel as stored, row by row, in [`Self::frame`]; index `(k * ny + j) * nx + i`.
    #[must_use]
    pub fn stored(&self, voxel: usize) -> [f64; 9] {
        let n = self.lattice.components;
        self.order.0.tensor(self.lattice.values.get(voxel * n..(voxel + 1) * n).unwrap_or_default())
    }

    /// All tensors as stored, the first axis fastest.
    pub fn tensors(&self) -> impl ExactSizeIterator<Item = [f64; 9]> + '_ {
        (0..self.lattice.voxels()).map(|voxel| self.stored(voxel))
    }

    /// The tensor of a voxel as stored; `None` where nothing was measured.
    #[must_use]
    pub fn measured(&self, voxel: usize) -> Option<[f64; 9]> {
        (!self.is_masked(voxel)).then(|| self.stored(voxel))
    }

    /// The first voxel that is measured but has a number that is infinite or none, and how many there are.
    #[must_use]
    pub fn not_finite(&self) -> Option<([usize; 3], usize)> {
        let [nx, ny, _] = self.lattice.size;
        let mut strange = (0..self.lattice.voxels())
            .filter(|&voxel| self.measured(voxel).is_some_and(|t| !t.iter().all(|v| v.is_finite())));
        let first = strange.next()?;
        Some(([first % nx, first / nx % ny, first / (nx * ny)], 1 + strange.count()))
    }

    /// With zero tensors in place of those that are not finite.
    #[must_use]
    pub fn with_zeros_for_not_finite(mut self) -> Self {
        for tuple in self.lattice.values.chunks_exact_mut(self.lattice.components.max(1)) {
            if !tuple.iter().all(|v| v.is_finite()) {
                tuple.fill(0.0);
            }
        }
        self
    }

    /// With the components along the axes that the file states, where it does, whatever the user said.
    #[must_use]
    pub fn as_stated(mut self) -> Self {
        if self.lattice.frame.1 == Known::Stated {
            self.frame = self.lattice.frame;
        }
        self
    }

    /// The order that the file states, where the user says another one.
    #[must_use]
    pub fn contradicted_order(&self) -> Option<TensorOrder> {
        let stated = self.lattice.order.filter(|(_, known)| *known == Known::Stated)?.0;
        (self.order.1 == Known::Given && stated != self.order.0).then_some(stated)
    }

    /// The frame that the file states, where the user says another one.
    #[must_use]
    pub fn contradicted_frame(&self) -> Option<Frame> {
        let (stated, known) = self.lattice.frame;
        (known == Known::Stated && self.frame.1 == Known::Given && stated != self.frame.0).then_some(stated)
    }

    /// Whether a name suggests strains, whose shears may be engineering ones, while a shear is one number and nobody
    /// says what it is.
    #[must_use]
    pub fn suggests_engineering_shears(&self) -> bool {
        let names = self.lattice.component_names.iter().chain([&self.lattice.array]);
        let is_open = self.shear.1 != Known::Given && self.order.0.has_shared_shears();
        is_open && names.into_iter().any(|n| names_strain(n))
    }

    /// Voxels whose mask is zero.
    #[must_use]
    pub fn masked_out(&self) -> usize {
        self.lattice.mask.as_ref().map_or(0, |mask| mask.iter().filter(|&&m| m == 0.0).count())
    }

    /// What was read and what was assumed, a sentence each.
    #[must_use]
    pub fn story(&self) -> Vec<String> {
        let mut story = self.lattice.story();
        let (order, frame) = (self.order, self.frame);
        let words = [
            format!("component order {} ({})", order.0, order.1.words()),
            format!("components along {} ({})", frame.0.words(), frame.1.words()),
        ];
        story.splice(1..1, words);
        story
    }

    /// What turns stored components into components along the world's axes.
    pub(crate) fn to_world(&self) -> Result<Option<[f64; 9]>, VolumeError> {
        let turn = match (self.frame.0, self.lattice.measurement) {
            (Frame::World, _) => return Ok(None),
            (Frame::Measurement, Some(m)) => m,
            (Frame::Lps, _) => self.lattice.lps(),
            (Frame::Fsl, _) => product(&self.lattice.orthogonal_directions()?, &self.lattice.fsl_signs()),
            // A measurement frame that the file does not state was refused before.
            (Frame::Voxel, _) | (Frame::Measurement, None) => self.lattice.orthogonal_directions()?,
        };
        Ok((turn != IDENTITY).then_some(turn))
    }
}
