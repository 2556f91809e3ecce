//! The linear scheme: every photon for itself (thesis, eq. 3.15). Light superposes, the stationary state is the
//! solution of a linear system, and every question has an adjoint: "where does the light here come from?".

mod blocks;
mod cells;
mod combinations;
mod dense;
mod dissection;
mod light;
mod parallel;
mod stationary;
#[cfg(test)]
mod tests;

pub use cells::LinearScattering;
pub(crate) use cells::{Band, banded, bands, emitted};
pub use combinations::{Combination, l1_norms};
pub use dense::Lanes;
pub use dissection::{Dissection, Operator, Workspace};
pub use light::{importance, stationary_light};
pub use parallel::{Parallel, Serial};
pub use stationary::{Settled, Watch, stationary};
