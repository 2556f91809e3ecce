//! Whether the component order looks wrong.

use super::{TensorOrder, TensorVolume};
use tigereye_core::symmetric_eigenvalues3;

/// Below this share of negative tensors nothing is suspected.
const SUSPICIOUS_ABOVE: f64 = 0.02;
/// Another order must leave less than this part of the negative tensors.
const CLEARLY_FEWER: f64 = 0.25;
/// Eigenvalues below this times the largest count as negative; fits clamp at zero and files hold f32.
const ROUNDING: f64 = 1e-6;

/// A better guess than the order that was used.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspicion {
    /// Share of tensors with a negative eigenvalue as read.
    pub share: f64,
    /// Tools that use the better order.
    pub tools: &'static str,
    /// The better order.
    pub order: TensorOrder,
    /// Share with the better order.
    pub better: f64,
}

/// Share of the tensors that have a negative eigenvalue, zero and non-finite ones among the whole. `values` are tuples.
#[must_use]
pub fn negative_share(values: &[f64], order: TensorOrder) -> f64 {
    let tuples = values.chunks_exact(order.components().max(1));
    let total = tuples.len().max(1);
    let negative = tuples.filter(|tuple| {
        let [largest, _, least] = symmetric_eigenvalues3(&order.tensor(tuple));
        least < -ROUNDING * largest.abs().max(least.abs())
    });
    negative.count() as f64 / total as f64
}

impl TensorVolume {
    /// Compares the order used with the other orders of six components: diffusion tensors read in a wrong one have
    /// negative eigenvalues. `None` where nothing looks wrong. Stresses and Hessians are negative in any order.
    #[must_use]
    pub fn suspicion(&self) -> Option<Suspicion> {
        if self.lattice.components != 6 {
            return None;
        }
        let values = &self.lattice.values;
        let share = negative_share(values, self.order.0);
        if share <= SUSPICIOUS_ABOVE {
            return None;
        }
        let others = TensorOrder::SIX.into_iter().filter(|(_, order)| *order != self.order.0);
        let judged = others.map(|(tools, order)| (negative_share(values, order), tools, order));
        let (better, tools, order) = judged.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (better < CLEARLY_FEWER * share).then_some(Suspicion { share, tools, order, better })
    }
}
