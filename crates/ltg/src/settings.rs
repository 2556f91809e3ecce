//! What determines a sweep.

use crate::LtgError;
use tigereye_core::Directions;
use tigereye_transport::{Level, Stopping};

/// Settings of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct LtgSettings {
    /// When each propagation ends.
    pub stopping: Stopping,
    /// Half-width K of the angular central difference, in samples.
    pub omega_step: usize,
    /// Slices to compute, any order; `None`: all.
    pub slices: Option<Vec<usize>>,
    /// Upper bound on the memory of the sweep, bytes.
    pub memory_bytes: u64,
    /// Instruction set of the hot loops; results do not depend on it.
    pub level: Level,
}

impl LtgSettings {
    /// The settings of most published volumes: threshold 0.5, K = ceil(S/12), all slices, 4 GiB.
    #[must_use]
    pub fn reference(directions: Directions) -> Self {
        Self {
            stopping: Stopping::REFERENCE,
            omega_step: omega_step_of_volumes(directions),
            slices: None,
            memory_bytes: 4 << 30,
            level: Level::detect(),
        }
    }

    /// The slices in ascending order, after checking everything.
    pub(crate) fn checked_slices(&self, directions: Directions) -> Result<Vec<usize>, LtgError> {
        let s = directions.count();
        self.stopping.check()?;
        if !(1..=s / 2).contains(&self.omega_step) {
            return Err(LtgError::OmegaStep { omega_step: self.omega_step, directions: s });
        }
        let mut slices = self.slices.clone().unwrap_or_else(|| (0..s).collect());
        slices.sort_unstable();
        slices.dedup();
        match slices.last() {
            None => Err(LtgError::NoSlices),
            Some(&slice) if slice >= s => Err(LtgError::Slice { slice, directions: s }),
            Some(_) => Ok(slices),
        }
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
