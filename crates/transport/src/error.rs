//! What can be wrong with a propagation's arguments.

use thiserror::Error;

/// Brightest sample of a light, W/rad: products with it stay numbers.
pub(crate) const BRIGHTEST: f64 = 1e100;

/// An argument that a propagation cannot work with.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TransportError {
    /// Nothing shines.
    #[error("no light: expected at least one")]
    NoLight,
    /// A light outside the grid.
    #[error("the light at ({x}, {y}) lies outside the field of {width} x {height} cells")]
    LightOutside {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
        /// Grid width in cells.
        width: usize,
        /// Grid height in cells.
        height: usize,
    },
    /// Two lights in one cell.
    #[error("two lights at ({x}, {y}): expected one light per cell, add their profiles instead")]
    LightTwice {
        /// Column of the lights.
        x: usize,
        /// Row of the lights.
        y: usize,
    },
    /// A light that is zero in every direction.
    #[error("the light at ({x}, {y}) is 0 in every direction (negative values are clipped)")]
    DarkLight {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
    },
    /// A light whose sums would no longer be numbers.
    #[error("the light at ({x}, {y}) is {largest:e} W/rad at most: expected no more than {:e}", BRIGHTEST)]
    TooBright {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
        /// Its largest sample, W/rad.
        largest: f64,
    },
    /// A light in a cell that sends light back.
    #[error("the light at ({x}, {y}) is inside a wall: expected a cell that passes light on")]
    LightInWall {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
    },
    /// A light with another sampling than the scheme's.
    #[error("the light at ({x}, {y}) has {samples} directions where the scheme has {expected}")]
    LightDirections {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
        /// Samples of the light.
        samples: usize,
        /// Samples of the scheme.
        expected: usize,
    },
    /// A pulse in a sample that does not exist.
    #[error("the pulse at ({x}, {y}) is in sample {sample}: expected 0 to {}", samples - 1)]
    PulseSample {
        /// Column of the light.
        x: usize,
        /// Row of the light.
        y: usize,
        /// Sample asked for.
        sample: usize,
        /// Number of samples.
        samples: usize,
    },
    /// Light gets where it cannot leave: there is no stationary state.
    #[error(
        "light is trapped around ({x}, {y}): expected a field whose light can leave or is absorbed, for otherwise no \
         stationary state exists"
    )]
    Trapped {
        /// Column of the first cell of a block that holds the trap.
        x: usize,
        /// Its row.
        y: usize,
    },
    /// A receiver outside the grid.
    #[error("the receiver at ({x}, {y}) lies outside the field of {width} x {height} cells")]
    ReceiverOutside {
        /// Column of the receiver.
        x: usize,
        /// Row of the receiver.
        y: usize,
        /// Grid width in cells.
        width: usize,
        /// Grid height in cells.
        height: usize,
    },
    /// A receiver in a cell that sends light back.
    #[error("the receiver at ({x}, {y}) is inside a wall: expected a cell that passes light on")]
    ReceiverInWall {
        /// Column of the receiver.
        x: usize,
        /// Row of the receiver.
        y: usize,
    },
    /// A receiver that is sensitive to no direction.
    #[error(
        "the receiver at ({x}, {y}) has a sensitivity of 0 in every direction (negative values are clipped)"
    )]
    BlindReceiver {
        /// Column of the receiver.
        x: usize,
        /// Row of the receiver.
        y: usize,
    },
    /// A receiver whose sums would no longer be numbers.
    #[error(
        "the receiver at ({x}, {y}) has a sensitivity of {largest:e} at most: expected no more than {:e}",
        BRIGHTEST
    )]
    TooSensitive {
        /// Column of the receiver.
        x: usize,
        /// Row of the receiver.
        y: usize,
        /// Its largest sensitivity.
        largest: f64,
    },
    /// No stationary light was found.
    #[error(
        "the light did not become stationary within {sweeps} sweeps (the last step would change {residual:e} of it): \
         expected a field whose light can leave or is absorbed"
    )]
    Unsettled {
        /// Sweeps and steps over the whole field.
        sweeps: usize,
        /// What a step would still change, as a part of all light.
        residual: f64,
    },
    /// A transmission field with another sampling than the scheme's.
    #[error("the transmission has {samples} directions where the scheme has {expected}")]
    TransmissionDirections {
        /// Samples of the transmission profiles.
        samples: usize,
        /// Samples of the scheme.
        expected: usize,
    },
    /// A stopping threshold that is negative or not a number.
    #[error("the stopping threshold is {threshold}: expected a number from 0")]
    Threshold {
        /// Threshold given.
        threshold: f64,
    },
}
