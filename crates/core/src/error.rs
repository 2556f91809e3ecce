//! Errors in the arguments of core's constructors.

use thiserror::Error;

/// An argument outside its range.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CoreError {
    /// A grid needs at least one cell and at most [`crate::Grid::MAX_CELLS`].
    #[error("a grid of {width} x {height} cells is not possible: expected 1 to {max} cells", max = crate::limits::MAX_CELLS)]
    GridSize {
        /// Requested width in cells.
        width: usize,
        /// Requested height in cells.
        height: usize,
    },
    /// The number of values is not the number of cells.
    #[error("{values} values for a grid of {width} x {height} cells: expected {}", width * height)]
    ValueCount {
        /// Values given.
        values: usize,
        /// Grid width in cells.
        width: usize,
        /// Grid height in cells.
        height: usize,
    },
    /// The number of angular samples is not a multiple of 8, or too large.
    #[error("{samples} directions are not possible: expected a multiple of 8 from 8 to {max}", max = crate::limits::MAX_DIRECTIONS)]
    Directions {
        /// Requested number of samples.
        samples: usize,
    },
    /// More samples than a field's transmission may have.
    #[error("{cells} cells in {directions} directions are too many samples: expected at most {max}, of fewer directions or fewer cells", max = crate::limits::MAX_SAMPLES)]
    TooManySamples {
        /// Cells of the grid.
        cells: usize,
        /// Directions of each.
        directions: usize,
    },
    /// A profile with another number of samples than its grid's.
    #[error("a profile of {samples} samples where {expected} are expected")]
    ProfileLength {
        /// Samples given.
        samples: usize,
        /// Samples expected.
        expected: usize,
    },
    /// A profile holds a sample that is not a number or infinite.
    #[error("sample {sample} of the profile is {value}: expected a finite number")]
    ProfileValue {
        /// Index of the sample.
        sample: usize,
        /// Its value.
        value: f64,
    },
    /// A tensor holds a component that is not a number or infinite.
    #[error(
        "the tensor of cell ({x}, {y}) has a component that is not finite: mask it or set it to zero first"
    )]
    NonFiniteTensor {
        /// Column of the cell.
        x: usize,
        /// Row of the cell.
        y: usize,
    },
    /// A wall's share is negative, or a wall sends back more than all.
    #[error(
        "of the light in direction {direction} a wall sends back {sum}: expected shares of 0 or more with a sum of at most 1"
    )]
    ReflectionRange {
        /// Direction of the arriving light, 0 to 7.
        direction: usize,
        /// Sum of the shares.
        sum: f64,
    },
    /// A rate outside [0, 1].
    #[error("the rate {rate} of cell ({x}, {y}) is out of range: expected 0 to 1")]
    Rate {
        /// Column of the cell.
        x: usize,
        /// Row of the cell.
        y: usize,
        /// Its rate.
        rate: f64,
    },
    /// A text that names no normalisation.
    #[error(
        "`{text}` is not a normalisation: expected global, local, local-above:F or local-above-global:F with F from 0 to 1"
    )]
    NormalizationWord {
        /// What was given.
        text: String,
    },
    /// The fraction of `local-above` outside [0, 1].
    #[error("the fraction {fraction} of local-above is out of range: expected 0 to 1")]
    Fraction {
        /// Fraction given.
        fraction: f64,
    },
    /// A word that names no rule of total anisotropy.
    #[error(
        "`{text}` is not a rule of total anisotropy: expected a ratio R of the semi-axes, R:WIDTH, `smooth` (20:2), cap:R, `cap` (cap:20) or `none`"
    )]
    TotalAnisotropyWord {
        /// What was given.
        text: String,
    },
    /// A rule of total anisotropy whose ratios are out of range.
    #[error(
        "total anisotropy at a ratio of {ratio} with a width of {width} is out of range: expected a width from 1, R/WIDTH from 1 and R*WIDTH up to 1e12"
    )]
    TotalAnisotropy {
        /// Ratio of the semi-axes given.
        ratio: f64,
        /// Width given.
        width: f64,
    },
    /// A transmission profile that would create light.
    #[error(
        "the transmission profile of cell ({x}, {y}) has mean {mean} or a negative sample: expected samples from 0 and a mean of at most 1"
    )]
    TransmissionRange {
        /// Column of the cell.
        x: usize,
        /// Row of the cell.
        y: usize,
        /// Mean of the profile.
        mean: f64,
    },
    /// A transmission profile that is not the same in opposite directions.
    #[error(
        "the transmission profile of cell ({x}, {y}) differs between sample {sample} and the opposite one: expected equal"
    )]
    TransmissionAsymmetric {
        /// Column of the cell.
        x: usize,
        /// Row of the cell.
        y: usize,
        /// First sample that differs.
        sample: usize,
    },
}
