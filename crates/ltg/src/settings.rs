//! Settings of a sweep.

use crate::LtgError;
use tigereye_core::{Choice, Directions, choice};
use tigereye_transport::{Level, Stopping};

/// The precision of pulses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Double precision: agrees with the published volumes to rounding.
    #[default]
    F64,
    /// Single precision: twice as many pulses per vector, half the memory.
    F32,
}

choice!(Precision {
    F64 = "f64": "Double precision.",
    F32 = "f32": "Single precision: faster, and less than 1e-4 off in the fields that the tests compare.",
});

impl Precision {
    /// Its name as a choice.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.word()
    }
}

/// Settings of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct LtgSettings {
    /// The stopping rule of each propagation.
    pub stopping: Stopping,
    /// Half-width K of the angular central difference, in samples.
    pub omega_step: usize,
    /// Slices to compute, any order; `None`: all.
    pub slices: Option<Vec<usize>>,
    /// Upper bound on the memory of the sweep, bytes.
    pub memory_bytes: u64,
    /// Instruction set of the hot loops; results do not depend on it.
    pub level: Level,
    /// Precision of the computation.
    pub precision: Precision,
}

impl LtgSettings {
    /// The settings of most published volumes: threshold 0.5, K = ceil(S/12), all slices, 4 GiB, double precision.
    #[must_use]
    pub fn reference(directions: Directions) -> Self {
        Self {
            stopping: Stopping::REFERENCE,
            omega_step: omega_step_of_volumes(directions),
            slices: None,
            memory_bytes: 4 << 30,
            level: Level::detect(),
            precision: Precision::F64,
        }
    }

    /// The unique slices in ascending order, after all checks that do not depend on the grid.
    ///
    /// # Errors
    /// [`LtgError::Stopping`], [`LtgError::OmegaStep`], [`LtgError::NoSlices`], [`LtgError::Slice`].
    pub fn checked_slices(&self, directions: Directions) -> Result<Vec<usize>, LtgError> {
        self.stopping.check()?;
        let mut slices = self.slices.clone().unwrap_or_else(|| (0..directions.count()).collect());
        slices.sort_unstable();
        slices.dedup();
        check_slices(directions, &slices, self.omega_step)?;
        Ok(slices)
    }
}

/// Whether these slices (ascending) and this angular step exist.
pub(crate) fn check_slices(
    directions: Directions,
    slices: &[usize],
    omega_step: usize,
) -> Result<(), LtgError> {
    let s = directions.count();
    if !(1..=s / 2).contains(&omega_step) {
        return Err(LtgError::OmegaStep { omega_step, directions: s });
    }
    match slices.last() {
        None => Err(LtgError::NoSlices),
        Some(&slice) if slice >= s => Err(LtgError::Slice { slice, directions: s }),
        Some(_) => Ok(()),
    }
}

/// K = ceil(S/12), the rule of most published volumes.
#[must_use]
pub const fn omega_step_of_volumes(directions: Directions) -> usize {
    directions.count().div_ceil(12)
}

/// K = S/16, the rule of the published slices; 1 for S = 8.
#[must_use]
pub const fn omega_step_of_slices(directions: Directions) -> usize {
    let k = directions.count() / 16;
    if k == 0 { 1 } else { k }
}
