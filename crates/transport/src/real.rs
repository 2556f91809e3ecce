//! The number types pulses can be computed in.

use crate::scattering::Stored;
use crate::tolerances::Tolerances;
use tigereye_simd::Vectors;

/// A floating-point number: `f64` or `f32`.
///
/// Sums over the grid that decide when a propagation ends are taken in double precision in either case.
#[expect(private_bounds, reason = "only the types with vectors at every level qualify")]
pub trait Real: Vectors + Stored + Tolerances {
    /// Pulses that are propagated side by side: those a register of AVX-512 holds.
    const LANES: usize;
    /// Name on the command line and in reports.
    const NAME: &'static str;

    /// The nearest number of this type.
    #[must_use]
    fn from_f64(value: f64) -> Self {
        Self::narrowed(value)
    }
    /// The same number.
    #[must_use]
    fn to_f64(self) -> f64 {
        self.widened()
    }
}

impl Real for f64 {
    const LANES: usize = 8;
    const NAME: &'static str = "f64";
}

impl Real for f32 {
    const LANES: usize = 16;
    const NAME: &'static str = "f32";
}
