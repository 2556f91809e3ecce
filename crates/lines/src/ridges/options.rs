//! Options of ridge extraction.

use crate::ExtractionError;

/// A bound, absolute or relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// In the unit of the bounded quantity.
    Absolute(f64),
    /// A fraction from 0 to 1 of a reference that the option defines.
    Part(f64),
}

/// Options of [`crate::ridge_lines`] and [`crate::ridge_surface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RidgeOptions {
    /// Steps of the mesh per sample. Ridges closer to each other than a step are missed.
    pub samples_per_cell: usize,
    /// Length of a cell along x and y and of a unit of the third coordinate. Curvatures, and with them the direction
    /// across a crest, depend on it unless all axes are lengths in the same unit: with a larger third number directions
    /// are further apart, and crests between them weaker. Lines ignore the third number.
    pub cell: [f64; 3],
    /// Least value. A fraction refers to the range of finite values: 0 is the smallest, 1 the largest.
    pub least_value: Threshold,
    /// Least strength: minus the smallest eigenvalue of the Hessian, in values over squared (scaled) cells. A fraction
    /// refers to the largest strength of a sample.
    pub least_strength: Threshold,
    /// Least length of a line or area of a piece of a surface, in (scaled) cells or squared cells.
    pub least_extent: f64,
    /// Least sharpness of a crest, relative to its strength, in two respects. Along the eigenvectors to both sides,
    /// over three quarters of a sample, values must fall by at least this fraction of the fall that the strength alone
    /// predicts: it is nearly 1 on a crest, but 0 where the eigenvectors run along rings of equal values, as outside a
    /// round crest or around a peak; there the slope is zero everywhere, and lines would be mere interpolation errors.
    /// And the next eigenvalue must be at least this fraction of the strength away: if two are equal, eigenvectors have
    /// no direction. 0 accepts every point at which the slope changes sign.
    pub least_sharpness: f64,
    /// Number of samples at open borders within which ridges are ignored, as derivatives are one-sided there. Axes of
    /// fewer than six samples have no margin.
    pub margin: usize,
    /// Relative precision of the values: curvatures below this fraction of the largest magnitude (per squared sample)
    /// are rounding errors.
    pub rounding: f64,
    /// Largest number of nodes of the mesh.
    pub most_nodes: usize,
}

impl RidgeOptions {
    /// The defaults.
    pub const USUAL: Self = Self {
        samples_per_cell: 2,
        cell: [1.0; 3],
        least_value: Threshold::Part(0.0),
        least_strength: Threshold::Part(0.05),
        least_extent: 1.0,
        least_sharpness: 0.2,
        margin: 1,
        rounding: 1e-10,
        most_nodes: 1 << 25,
    };
}

impl Default for RidgeOptions {
    fn default() -> Self {
        Self::USUAL
    }
}

/// Indices of vertices have 32 bits, and seven edges start at each node.
const MAX_NODES: usize = 1 << 28;

impl RidgeOptions {
    pub(crate) fn check(&self) -> Result<(), ExtractionError> {
        let refuse = |option, value, expected| Err(ExtractionError::Option { option, value, expected });
        if self.samples_per_cell == 0 {
            return refuse("samples_per_cell", 0.0, "at least 1");
        }
        if let Some(&bad) = self.cell.iter().find(|c| !(1e-6..=1e6).contains(*c)) {
            return refuse("cell", bad, "1e-6 to 1e6");
        }
        for (option, threshold) in
            [("least_value", self.least_value), ("least_strength", self.least_strength)]
        {
            match threshold {
                Threshold::Absolute(v) if v.is_nan() => return refuse(option, v, "a number"),
                Threshold::Part(v) if !(0.0..=1.0).contains(&v) => {
                    return refuse(option, v, "a part from 0 to 1");
                }
                _ => {}
            }
        }
        let from_zero = [
            ("least_extent", self.least_extent),
            ("least_sharpness", self.least_sharpness),
            ("rounding", self.rounding),
        ];
        if let Some((option, bad)) = from_zero.into_iter().find(|(_, v)| !(0.0..f64::INFINITY).contains(v)) {
            return refuse(option, bad, "a number from 0");
        }
        if self.most_nodes > MAX_NODES {
            return refuse("most_nodes", self.most_nodes as f64, "at most 2^28");
        }
        Ok(())
    }

    /// Number of nodes of a mesh along each axis, if it is not too large.
    pub(crate) fn nodes(&self, axes: &[crate::spline::Axis; 3]) -> Result<[usize; 3], ExtractionError> {
        let n = self.samples_per_cell as u128;
        // A periodic axis has as many cells as samples; its last node is its first.
        let wide = axes.map(|a| match (a.samples, a.periodic) {
            (1, _) => 1,
            (s, true) => n * s as u128 + 1,
            (s, false) => n * (s as u128 - 1) + 1,
        });
        let nodes = wide.iter().try_fold(1_u128, |m, &w| m.checked_mul(w)).unwrap_or(u128::MAX);
        if nodes > self.most_nodes as u128 {
            let (samples_per_cell, most) = (self.samples_per_cell, self.most_nodes);
            return Err(ExtractionError::MeshSize { samples_per_cell, nodes, most });
        }
        Ok(wide.map(|w| w as usize))
    }
}

/// The bounds that applied, in the units of values and strengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RidgeBounds {
    /// Least value.
    pub value: f64,
    /// Least strength.
    pub strength: f64,
    /// Largest strength of a sample, on a ridge or not; 0 if none is positive.
    pub strongest: f64,
}

impl RidgeBounds {
    /// From the range of values and the largest strength of a sample.
    pub(crate) fn new(options: &RidgeOptions, [low, high]: [f64; 2], strongest: f64) -> Self {
        let value = match options.least_value {
            Threshold::Absolute(v) => v,
            // A fraction of 0 is no bound: splines may fall a little below the smallest sample.
            Threshold::Part(0.0) => f64::NEG_INFINITY,
            // Halves do not overflow.
            Threshold::Part(p) => low + 2.0 * p * (0.5 * high - 0.5 * low),
        };
        let strength = match options.least_strength {
            Threshold::Absolute(v) => v,
            Threshold::Part(p) => p * strongest,
        };
        Self { value, strength, strongest }
    }
}
