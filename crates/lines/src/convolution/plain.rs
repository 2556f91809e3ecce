//! The readable form of smoothing: every sample has a line of its own, step by step. [`super::smoothing`] is checked
//! against it.

use super::smoothing::Window;
use super::tracing::Tracing;
use core::f64::consts::PI;
use tigereye_core::{Field, math};

/// The texture averaged along the lines through its samples, as [`super::smoothed`] has it.
pub(super) fn smoothed(texture: &Field<f64>, tracing: &Tracing<'_>, window: &Window<'_>) -> Field<f64> {
    Field::from_fn(texture.grid(), |cell| {
        let own = *texture.at(cell);
        let at = tracing.point(cell);
        if tracing.field.at(at).is_none_or(|t| t.is_zero()) {
            return f64::NAN;
        }
        let Some(start) = tracing.direction(at) else { return own };
        let half = (window.at)(at);
        let steps = (half / tracing.step) as usize;
        let (mut sum, mut weights) = (own, 1.0);
        for start in [start, -start] {
            let (mut p, mut d) = (at, start);
            for k in 1..=steps {
                let Some((to, direction)) = tracing.next(p, d) else { break };
                (p, d) = (to, direction);
                let sample = tracing.sample(texture, p);
                if sample.is_nan() {
                    break;
                }
                let weight = 0.5 * (1.0 + math::cos(PI * k as f64 * tracing.step / half));
                sum += weight * sample;
                weights += weight;
            }
        }
        sum / weights
    })
}
