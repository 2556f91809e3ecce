//! How values become colours.

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum HeatScale {
    /// From the smallest to the largest value.
    #[default]
    Linear,
    /// Powers of ten: `decades` below the maximum, and everything lower in [`crate::Rgba::NO_LIGHT`].
    Logarithmic {
        /// Decades shown, positive.
        decades: f64,
    },
    /// Symmetric about 0.
    Diverging,
}

impl HeatScale {
    /// Decades of a logarithmic scale for which nobody asks otherwise.
    pub const USUAL_DECADES: f64 = 4.0;
    /// Logarithmic, with as many decades as usual.
    pub const USUAL_LOGARITHMIC: Self = Self::Logarithmic { decades: Self::USUAL_DECADES };
}
