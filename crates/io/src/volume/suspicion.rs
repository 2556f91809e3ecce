//! Whether the component order looks wrong.

use super::order::TensorOrder;
use super::tensors::TensorVolume;
use tigereye_core::symmetric_eigenvalues3;

/// Below this share of negative tensors nothing is suspected.
const SUSPICIOUS_ABOVE: f64 = 0.02;
/// Another order must leave less than this fraction of the negative tensors.
const CLEARLY_FEWER: f64 = 0.25;
/// Eigenvalues below this times the largest count as negative; fits clamp at zero and files hold f32.
const ROUNDING: f64 = 1e-6;

/// A better guess than the order that was used.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspicion {
    /// Share of tensors with a negative eigenvalue as read.
    pub share: f64,
    /// Tools that use the better order.
    pub tools: String,
    /// The better orders, which signs of eigenvalues do not tell apart.
    pub orders: Vec<TensorOrder>,
    /// Share with the better order.
    pub better: f64,
}

/// Share of the tensors that have a negative eigenvalue, zero and non-finite ones among the whole.
#[must_use]
pub fn negative_share<'a>(tuples: impl Iterator<Item = &'a [f64]>, order: TensorOrder) -> f64 {
    let (mut total, mut negative) = (0_usize, 0_usize);
    for tuple in tuples {
        let [largest, _, least] = symmetric_eigenvalues3(&order.tensor(tuple));
        total += 1;
        negative += usize::from(least < -ROUNDING * largest.abs().max(least.abs()));
    }
    negative as f64 / total.max(1) as f64
}

impl TensorVolume {
    /// Compares, over all measured voxels, the order used with the other orders of six components: diffusion tensors
    /// read in a wrong one have negative eigenvalues. `None` where nothing looks wrong. Stresses and Hessians are
    /// negative in any order.
    #[must_use]
    pub fn suspicion(&self) -> Option<Suspicion> {
        if self.lattice.components != 6 {
            return None;
        }
        let tuples = || {
            let voxels = self.lattice.values.chunks_exact(self.lattice.components).enumerate();
            voxels.filter(|(voxel, _)| !self.is_masked(*voxel)).map(|(_, tuple)| tuple)
        };
        let share = negative_share(tuples(), self.order.0);
        if share <= SUSPICIOUS_ABOVE {
            return None;
        }
        let others = TensorOrder::SIX.into_iter().filter(|(_, order)| *order != self.order.0);
        let judged: Vec<_> =
            others.map(|(tools, order)| (negative_share(tuples(), order), tools, order)).collect();
        let better = judged.iter().map(|j| j.0).fold(f64::INFINITY, f64::min);
        let best = || judged.iter().filter(|j| j.0 == better);
        let tools = best().map(|j| j.1).collect::<Vec<_>>().join(" or ");
        let orders = best().map(|j| j.2).collect();
        (better < CLEARLY_FEWER * share).then_some(Suspicion { share, tools, orders, better })
    }
}
