//! What an experiment may check.

use super::{AxesChoice, DistanceNumber, Finite, MapSource, NonNegative, RidgeSource};
use serde::Deserialize;

/// A statement about a number of this run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// The statement in words.
    pub name: String,
    /// The number.
    pub quantity: Quantity,
    /// What it must be.
    pub expect: Expectation,
    /// Why it must be so.
    pub basis: String,
}

/// What a number must be.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum Expectation {
    /// The first number, give or take the second (same unit).
    Near(Finite, NonNegative),
    /// The first number, give or take the second times its magnitude.
    NearRelative(Finite, NonNegative),
    /// At most this.
    AtMost(Finite),
    /// At least this.
    AtLeast(Finite),
}

/// A symmetry of the square.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Mirror {
    /// Left and right exchanged.
    LeftRight,
    /// Top and bottom exchanged.
    TopBottom,
    /// Turned by 90 degrees.
    QuarterTurn,
    /// Turned by 180 degrees.
    HalfTurn,
}

/// A constant of the scheme.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum SchemeConstant {
    /// Weight e1 of the face cone in the overlap (eq. 3.1).
    E1,
    /// Weight e2 of the diagonal cone in the overlap (eq. 3.2).
    E2,
    /// Core angle alpha, degrees.
    AlphaDeg,
    /// Largest deviation from 1 of the sum of all weights over all samples, S = 8, 16, ... 360.
    WeightSumError,
}

/// A number of a pulse. What it compares are the fluxes between cells; the injected sample itself does not count. Not a
/// number where the pulse has no stationary state within reach, except for the first two.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum PulseNumber {
    /// 1 where plain steps and the solver both reach the stationary state, 0 elsewhere.
    Settled,
    /// Steps until the run's stopping rule ends the propagation.
    StoppedSteps,
    /// Plain steps until the relative change of the distribution is at most 1e-10.
    PlainSteps,
    /// Evaluations of the scheme that the solver needs for the same.
    Evaluations,
    /// Plain steps over evaluations.
    Saving,
    /// L1 distance of the stopped fluxes from the stationary ones, over the sum of these: over all cells and lobes.
    StoppedDistance,
    /// Share of the stationary energy that the stopped state lacks.
    MissingEnergy,
    /// What the stopped fluxes exceed the stationary ones by, in sum, over the sum of these: half of how much the distance
    /// is larger than the missing energy, 0 where light only grows.
    Overshoot,
    /// L1 distance, as above, of the solver's state from the one that much longer stepping gives.
    SolverError,
    /// The same of the state at which plain steps change by 1e-10.
    PlainError,
}

/// One number for many.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Summary {
    /// The smallest.
    Least,
    /// Their mean.
    Mean,
    /// The largest.
    Most,
    /// The largest difference of two pulses that follow each other in a run: of neighbours where its cells are neighbours
    /// and it has one angle.
    Jump,
}

/// A number of this run.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Quantity {
    /// A constant of the scheme.
    Scheme(SchemeConstant),
    /// Flux of an emitter of this exponent, W (360 samples).
    EmitterFlux(NonNegative),
    /// Largest `|determinant - 1|` of a field.
    DeterminantError {
        /// Name of the field.
        field: String,
    },
    /// Direction of a cell's major half-axis, degrees in [0, 180).
    MajorAxisDeg {
        /// Name of the field.
        field: String,
        /// Column and row.
        cell: (usize, usize),
    },
    /// Largest angle (degrees) between the major axis and the expression `phi_deg` in the variables of a field, over
    /// the cells whose half-axes differ by more than 1 %.
    MajorAxisError {
        /// Name of the field.
        field: String,
        /// Direction expected, degrees.
        phi_deg: String,
        /// Which axes.
        #[serde(default = "half_axes")]
        axes: AxesChoice,
    },
    /// Share of cells whose half-axes differ by at most 1 %, zero tensors included.
    IsotropicShare {
        /// Name of the field.
        field: String,
    },
    /// Share of cells whose tensor is 0.
    ZeroShare {
        /// Name of the field.
        field: String,
    },
    /// Share of cells whose tensor has complex eigenvalues.
    ComplexShare {
        /// Name of the field.
        field: String,
    },
    /// Share of cells that are totally anisotropic, zero tensors not counted.
    TotalAnisotropyShare {
        /// Name of the field.
        field: String,
    },
    /// Largest singular value of a field.
    LargestAxis {
        /// Name of the field.
        field: String,
    },
    /// Steps of a light run.
    Steps {
        /// Name of the light run.
        run: String,
    },
    /// 1 where a light run met its stopping rule, 0 where it met the limit.
    Stopped {
        /// Name of the light run.
        run: String,
    },
    /// Energy in the grid at the end, W.
    TotalEnergy {
        /// Name of the light run.
        run: String,
    },
    /// Largest `|energy(n) / energy(0) - 1|` over the steps.
    EnergyDrift {
        /// Name of the light run.
        run: String,
    },
    /// Net outward flux right of the light at a distance, relative to distance 1.
    NetFluxRatio {
        /// Name of the light run.
        run: String,
        /// Distance, cells.
        distance: usize,
    },
    /// Outward lobe right of the light at a distance, relative to distance 1.
    LobeRatio {
        /// Name of the light run.
        run: String,
        /// Distance, cells.
        distance: usize,
    },
    /// Energy of a cell over that of another.
    EnergyRatio {
        /// Name of the light run.
        run: String,
        /// Column and row.
        cell: (usize, usize),
        /// Column and row.
        over: (usize, usize),
    },
    /// Energy of a cell over that in another run.
    EnergyOver {
        /// Name of the light run.
        run: String,
        /// Name of the light run it is divided by.
        over: String,
        /// Column and row.
        cell: (usize, usize),
    },
    /// Cells of the shortest way through a scene from its first light to a cell, both ends included.
    WayLength {
        /// Name of the light run.
        run: String,
        /// Column and row of its end.
        to: (usize, usize),
    },
    /// By how many cells the brightest way is longer than the shortest: the one that leads from a cell always to its brightest
    /// neighbour, up to the light.
    WayExcess {
        /// Name of the light run.
        run: String,
        /// Column and row of their end.
        to: (usize, usize),
    },
    /// Cells that lie on one only of the shortest and the brightest way.
    WayDifference {
        /// Name of the light run.
        run: String,
        /// Column and row of their end.
        to: (usize, usize),
    },
    /// Of the cells of a scene with a way to its first light, the part from which the brightest way is a shortest one.
    ShortestWays {
        /// Name of the light run.
        run: String,
    },
    /// Share of the energy at distances from the centre in a range, cells; lights excluded.
    RingShare {
        /// Name of the light run.
        run: String,
        /// From and to, cells.
        range: (NonNegative, NonNegative),
    },
    /// Share of the energy within columns and rows (both ends included); lights excluded.
    BoxShare {
        /// Name of the light run.
        run: String,
        /// First and last column.
        columns: (usize, usize),
        /// First and last row.
        rows: (usize, usize),
    },
    /// Largest difference of energies under a symmetry, over the largest energy.
    LightSymmetry {
        /// Name of the light run.
        run: String,
        /// Symmetry.
        under: Mirror,
    },
    /// Mean distance of the energy from the centre after a step, cells.
    RadiusMean {
        /// Name of the light run.
        run: String,
        /// Step.
        step: usize,
    },
    /// Standard deviation of that distance after a step, cells.
    RadiusSpread {
        /// Name of the light run.
        run: String,
        /// Step.
        step: usize,
    },
    /// Mean distance of the energy in the sectors about the axes over that about the diagonals, after a kept step.
    FrontRoundness {
        /// Name of the light run.
        run: String,
        /// Step.
        step: usize,
    },
    /// L2 difference of two light runs over the L2 norm of the first.
    LightDifference {
        /// Name of a light run.
        run: String,
        /// Name of another.
        from: String,
    },
    /// Value of a gradient.
    GradientAt {
        /// Name of the gradient run.
        run: String,
        /// Column and row.
        cell: (usize, usize),
        /// Sample index.
        sample: usize,
    },
    /// Value of a gradient over that at another cell.
    GradientRatio {
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
        /// Column and row.
        cell: (usize, usize),
        /// Column and row of the cell it is divided by.
        over: (usize, usize),
    },
    /// Largest value of a gradient.
    GradientMax {
        /// Name of the gradient run.
        run: String,
    },
    /// Mean of a gradient, the zero border included.
    GradientMean {
        /// Name of the gradient run.
        run: String,
    },
    /// Share of sources that met the step limit.
    GradientLimited {
        /// Name of the gradient run.
        run: String,
    },
    /// Largest distance (columns) of a row's maximum from a column, over rows (both ends included).
    RidgeColumnError {
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
        /// Column expected.
        column: Finite,
        /// First and last row.
        rows: (usize, usize),
    },
    /// Value on a column over the mean of its slice's inner cells, averaged over rows (both ends included).
    RidgeContrast {
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
        /// Column.
        column: usize,
        /// First and last row.
        rows: (usize, usize),
    },
    /// Largest difference of a gradient under a symmetry of cells and directions, over its largest value.
    GradientSymmetry {
        /// Name of the gradient run.
        run: String,
        /// Symmetry.
        under: Mirror,
    },
    /// L2 difference of two gradients over the L2 norm of the first. Both need the same cells and slices.
    GradientDifference {
        /// Name of a gradient run.
        run: String,
        /// Name of another.
        from: String,
    },
    /// A number of all pulses of some runs, summed up.
    OfPulses {
        /// Names of pulses runs.
        runs: Vec<String>,
        /// The number.
        number: PulseNumber,
        /// How pulses are summed up.
        over: Summary,
    },
    /// Correlation of two scalars over the inner cells where both are numbers.
    MapCorrelation {
        /// The one.
        map: MapSource,
        /// The other.
        with: MapSource,
    },
    /// A number of the distances of one set of ridges from another.
    RidgeDistance {
        /// The ridges whose points are asked for their distance.
        of: RidgeSource,
        /// The ridges that are to be near.
        from: RidgeSource,
        /// The number.
        number: DistanceNumber,
    },
    /// Correlation of the mean over directions of two gradients, the coarser one sampled at the finer one's cells.
    GradientCorrelation {
        /// Name of a gradient run.
        run: String,
        /// Name of another.
        with: String,
    },
}

/// What light sees.
const fn half_axes() -> AxesChoice {
    AxesChoice::Half
}
