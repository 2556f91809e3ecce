//! Scales of values: position, tick marks and their labels, linear or logarithmic.

use crate::number;
use tigereye_core::math;

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    /// Value.
    pub(crate) value: f64,
    /// Text beside it; empty for a minor mark.
    pub(crate) label: String,
}

/// A range of values, linear or logarithmic. Always finite, never empty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) logarithmic: bool,
}

/// The largest magnitude drawn: beyond it, spans of ranges would overflow.
const HUGE: f64 = 1e300;

impl Axis {
    /// Smaller values are drawn as 0: their spans cannot be divided into ticks.
    pub(crate) const TINY: f64 = 1e-290;

    /// A linear range; an empty one is widened about its value.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        let (low, high) = (low.clamp(-HUGE, HUGE), high.clamp(-HUGE, HUGE));
        // A span below a few rounding errors cannot be divided into ticks.
        let reach = low.abs().max(high.abs());
        let smallest = (1e-12 * reach).max(Self::TINY);
        let (low, high) = if high - low > smallest {
            (low, high)
        } else if reach <= Self::TINY {
            (0.0, 1.0)
        } else {
            (low - 0.5 * low.abs(), high + 0.5 * high.abs())
        };
        Self { low, high, logarithmic: false }
    }

    /// A logarithmic range; ends that are not positive or not in order are replaced.
    pub(crate) fn logarithmic(low: f64, high: f64) -> Self {
        let high = high.clamp(1e-290, HUGE);
        let low = low.clamp(1e-300, high);
        let low = if low < high * (1.0 - 1e-9) { low } else { high / 10.0 };
        Self { low, high, logarithmic: true }
    }

    /// The position of `value`: 0 at the lower end, 1 at the upper end, and outside [0, 1] beyond them.
    pub(crate) fn position(&self, value: f64) -> f64 {
        if self.logarithmic {
            let (low, high) = (math::log10(self.low), math::log10(self.high));
            return (math::log10(value) - low) / (high - low);
        }
        // Halves, because the span of two huge numbers may overflow.
        (0.5 * value - 0.5 * self.low) / (0.5 * self.high - 0.5 * self.low)
    }

    /// A linear range widened to the next labelled ticks.
    pub(crate) fn rounded_outwards(self, count: usize) -> Self {
        let step = nice_step(self.high - self.low, count);
        Self::linear((self.low / step + 1e-9).floor() * step, (self.high / step - 1e-9).ceil() * step)
    }

    /// Labelled marks within the range, about `count` of them, ascending.
    pub(crate) fn ticks(&self, count: usize) -> Vec<Tick> {
        let count = count.max(2);
        if self.logarithmic { self.log_ticks(count) } else { self.linear_ticks(count) }
    }

    /// At least two if a finer step gives them: a single mark shows no scale.
    fn linear_ticks(&self, count: usize) -> Vec<Tick> {
        let span = self.high - self.low;
        let within = |step: f64| {
            let first = (self.low / step - 1e-9).ceil() as i64;
            let last = (self.high / step + 1e-9).floor() as i64;
            first..=last.min(first.saturating_add(100))
        };
        let step = (count..=4 * count)
            .map(|parts| nice_step(span, parts))
            .find(|step| within(*step).nth(1).is_some())
            .unwrap_or_else(|| nice_step(span, count));
        within(step)
            .map(|i| i as f64 * step)
            .map(|value| Tick { value, label: number::label(value, step) })
            .collect()
    }

    fn log_ticks(&self, count: usize) -> Vec<Tick> {
        let decades = math::log10(self.high) - math::log10(self.low);
        if decades < 1.0 {
            return self.linear_ticks(count);
        }
        let multiples: &[f64] = if decades < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (number::decade(self.low), number::decade(self.high));
        let stride = ((f64::from(last - first) / count as f64).ceil() as i32).max(1);
        let plain = decades < 2.5 && self.low >= 1e-3 && self.high <= 1e4;
        let mut ticks = Vec::new();
        for exponent in (first..=last).filter(|e| e % stride == 0) {
            for m in multiples {
                let value = m * number::power_of_ten(exponent);
                let text = match plain {
                    true => number::label(value, number::power_of_ten(exponent)),
                    false if *m == 1.0 => number::power_label(exponent),
                    false => format!("{m}·{}", number::power_label(exponent)),
                };
                ticks.push(Tick { value, label: text });
            }
        }
        ticks.retain(|t| self.contains(t.value));
        ticks
    }

    /// Unlabelled marks between decades of a logarithmic range, if they are far enough apart.
    pub(crate) fn minor_ticks(&self) -> Vec<f64> {
        let (first, last) = (number::decade(self.low), number::decade(self.high));
        if !self.logarithmic || last - first > 8 {
            return Vec::new();
        }
        (first..=last)
            .flat_map(|e| (2..10).map(move |m| f64::from(m) * number::power_of_ten(e)))
            .filter(|v| self.contains(*v))
            .collect()
    }

    fn contains(&self, value: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&self.position(value))
    }
}

/// The step of 1, 2, 2.5 or 5 times a power of ten that divides `span` into about `count` parts.
pub(crate) fn nice_step(span: f64, count: usize) -> f64 {
    let rough = (span / count.max(1) as f64).clamp(1e-300, 1e300);
    let decade = number::power_of_ten(number::decade(rough));
    let factor =
        [1.0, 2.0, 2.5, 5.0].into_iter().find(|f| f * decade >= rough * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * decade
}

/// The integers from 0 to `count - 1` to label, at least `apart_px` apart for cells of `cell_px`.
pub(crate) fn cell_ticks(count: usize, cell_px: f64, apart_px: f64) -> Vec<usize> {
    let least = (apart_px / cell_px).max(1.0);
    let decade = number::power_of_ten(number::decade(least));
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|f| f * decade).find(|s| *s >= least * (1.0 - 1e-9));
    (0..count).step_by(step.unwrap_or(least).round().max(1.0) as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_has_at_least_two_marks() {
        for low in [-350.0, -20.0, 0.0, 35.0, 101.0, 149.9] {
            for span in [1e-3, 0.7, 19.0, 98.0, 205.0, 249.0] {
                for count in 0..8 {
                    let ticks = Axis::linear(low, low + span).ticks(count);
                    assert!(
                        (2..=3 + 2 * count).contains(&ticks.len()),
                        "{low} + {span} / {count}: {ticks:?}"
                    );
                }
            }
        }
    }
}
