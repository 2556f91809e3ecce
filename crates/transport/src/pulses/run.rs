//! One batch of pulses under propagation.

use super::PulseDistribution;
use super::stream::{Medium, Stream};
use crate::Stopping;
use crate::scattering::Scattering;
use crate::window::Window;
use tigereye_core::Grid;
use tigereye_simd::Level;

/// One batch of pulses.
pub(super) struct Run<'r, 'a, T, const N: usize> {
    pub(super) field: &'r Scattering<'a>,
    pub(super) level: Level,
    pub(super) medium: Medium<'r, T, N>,
    pub(super) stream: &'r mut Stream<T, N>,
    pub(super) stopping: Stopping,
    pub(super) results: &'r mut [PulseDistribution<T>],
}

/// The window of the whole grid.
pub(super) const fn whole(grid: Grid) -> Window {
    Window { x0: 0, x1: grid.width() - 1, y0: 0, y1: grid.height() - 1 }
}
