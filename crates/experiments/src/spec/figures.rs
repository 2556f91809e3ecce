//! Pictures an experiment may draw.

use super::{
    AxesChoice, FamilyChoice, Finite, MajorChoice, MapSource, NonNegative, Positive, PulseNumber, RidgeSource,
};
use serde::Deserialize;
use std::num::NonZeroUsize;

/// A picture with its caption.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// File name without ending.
    pub name: String,
    /// What is seen, in one or two sentences.
    pub caption: String,
    /// Panels side by side; a panel that needs a run of another scope is left out.
    pub panels: Vec<Panel>,
    /// Panels per row.
    #[serde(default = "three")]
    pub columns: usize,
    /// The steps of a light run, to be watched beside the picture.
    #[serde(default)]
    pub animation: Option<Animation>,
}

/// Energies after the steps of a light run, one scale for all, as an animated PNG of the figure's name.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Animation {
    /// Name of the light run.
    pub run: String,
    /// Every how many steps there is a frame; more where there would be too many.
    #[serde(default = "one")]
    pub every: NonZeroUsize,
    /// Decades below the brightest cell that is no light.
    #[serde(default)]
    pub decades: Option<Positive>,
}

const fn one() -> NonZeroUsize {
    NonZeroUsize::MIN
}

fn three() -> usize {
    3
}

/// One panel.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Panel {
    /// The tensors as ellipses.
    Glyphs {
        /// Name of the field.
        field: String,
        /// What the colours mean.
        #[serde(default)]
        colour: GlyphColour,
        /// Heading of the panel.
        title: String,
    },
    /// The direction of the longer semi-axis in colours.
    Orientation {
        /// Name of the field.
        field: String,
        /// Heading of the panel.
        title: String,
    },
    /// Lines along an axis, evenly spaced, with the degenerate points.
    Lines {
        /// Name of the field.
        field: String,
        /// The axes that lines follow.
        #[serde(default)]
        axes: AxesChoice,
        /// By what the major one is larger.
        #[serde(default)]
        major: Option<MajorChoice>,
        /// Which of the two; both when left out.
        #[serde(default)]
        family: Option<FamilyChoice>,
        /// Heading of the panel.
        title: String,
    },
    /// Noise smeared along an axis (line integral convolution).
    Texture {
        /// Name of the field.
        field: String,
        /// The axes that lines follow.
        #[serde(default)]
        axes: AxesChoice,
        /// By what the major one is larger.
        #[serde(default)]
        major: Option<MajorChoice>,
        /// Which of the two.
        #[serde(default)]
        family: FamilyChoice,
        /// Smeared along both axes, as far as each is long (HyperLIC).
        #[serde(default)]
        hyper: bool,
        /// Heading of the panel.
        title: String,
    },
    /// A scalar over the cells.
    Map {
        /// The scalar.
        map: MapSource,
        /// Whether its height ridges are drawn.
        #[serde(default)]
        ridges: bool,
        /// Heading of the panel.
        title: String,
    },
    /// Height ridges of several scalars over each other.
    Ridges {
        /// The field, for its size.
        field: String,
        /// Names in the legend, and ridges; at most four.
        sources: Vec<(String, RidgeSource)>,
        /// Heading of the panel.
        title: String,
    },
    /// Transmission (red) and light (blue) of every cell.
    Overlay {
        /// Name of the light run.
        run: String,
        /// Step to show; the last when left out.
        #[serde(default)]
        step: Option<usize>,
        /// How brightness is drawn.
        #[serde(default)]
        scale: Scale,
        /// Whether the transmission is drawn.
        #[serde(default = "yes")]
        transmission: bool,
        /// Heading of the panel.
        title: String,
    },
    /// The energy of every cell in colours.
    Energy {
        /// Name of the light run.
        run: String,
        /// Step to show; the last when left out.
        #[serde(default)]
        step: Option<usize>,
        /// Decades below the brightest cell; linear when left out.
        #[serde(default)]
        decades: Option<Positive>,
        /// Draws, in a scene, the shortest way from the first light to this column and row, and the brightest one.
        #[serde(default)]
        way_to: Option<(usize, usize)>,
        /// Heading of the panel.
        title: String,
    },
    /// One direction of a gradient.
    Slice {
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
        /// Whether the maximum of every row is marked.
        #[serde(default)]
        ridge: bool,
        /// Heading of the panel.
        title: String,
    },
    /// A gradient without its direction.
    Flat {
        /// Name of the gradient run.
        run: String,
        /// How directions are summed up.
        view: FlatView,
        /// Heading of the panel.
        title: String,
    },
    /// Curves over the direction.
    Polar {
        /// The curves.
        curves: Vec<Curve>,
        /// Name and unit of the radius.
        quantity: String,
        /// Heading of the panel.
        title: String,
    },
    /// Curves over a number.
    Chart {
        /// Horizontal axis.
        x: Axis,
        /// Vertical axis.
        y: Axis,
        /// The curves.
        series: Vec<SeriesSource>,
        /// Heading of the panel.
        title: String,
    },
}

fn yes() -> bool {
    true
}

/// What the colours of glyphs mean.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub enum GlyphColour {
    /// Linear anisotropy `(s1 - s2) / (s1 + s2)`.
    #[default]
    Anisotropy,
    /// Tension and compression: for stresses. (The sign of a generator's rotated diagonal tensor means nothing.)
    Sign,
}

/// How the brightness of an overlay is drawn.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
pub enum Scale {
    /// Against the brightest cell, the lights included.
    Linear,
    /// Against the brightest cell that is not a light.
    LinearWithoutSources,
    /// Each cell against itself: shape only.
    PerCell,
    /// By the logarithm of the cell's mean over four decades.
    #[default]
    Logarithmic,
    /// The same over so many decades.
    Decades(Positive),
}

/// How the directions of a gradient are summed up.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum FlatView {
    /// Mean.
    Mean,
    /// Maximum.
    Maximum,
    /// Standard deviation.
    Deviation,
}

/// A curve over the direction.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// What it shows.
    pub source: ProfileSource,
}

/// What a curve over the direction shows.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum ProfileSource {
    /// The emitter `max(0, cos(theta - theta0))^power` at 360 samples.
    Emitter {
        /// Brightest direction, degrees.
        theta_deg: Finite,
        /// Exponent.
        power: NonNegative,
    },
    /// The cone weight of a neighbour (0 to 7) at so many samples.
    ConeWeight {
        /// Neighbour direction.
        neighbour: usize,
        /// Samples.
        directions: super::DirectionCount,
    },
    /// The ellipse (eq. 3.6) of a field's cell, in the tensor's unit.
    Ellipse {
        /// Name of the field.
        field: String,
        /// Column and row.
        cell: (usize, usize),
    },
    /// The light of a cell after a run.
    Light {
        /// Name of the light run.
        run: String,
        /// Column and row.
        cell: (usize, usize),
        /// Step; the last when left out.
        #[serde(default)]
        step: Option<usize>,
    },
    /// The light of a cell times its transmission, as the cones weigh it (eq. 3.12 without `n_f`).
    Windowed {
        /// Name of the light run.
        run: String,
        /// Column and row.
        cell: (usize, usize),
    },
}

/// An axis of a chart.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Name and unit.
    pub label: String,
    /// Whether it is logarithmic.
    #[serde(default)]
    pub logarithmic: bool,
}

/// A curve of a chart.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum SeriesSource {
    /// Given points.
    Points {
        /// Name in the legend.
        label: String,
        /// x and y.
        points: Vec<(Finite, Finite)>,
    },
    /// An expression in `x`.
    Formula {
        /// Name in the legend.
        label: String,
        /// The expression.
        expression: String,
        /// From and to.
        range: (Finite, Finite),
    },
    /// Net outward flux through the cells right of the light over the distance, relative to distance 1.
    NetFlux {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: String,
        /// Largest distance.
        to: usize,
    },
    /// The outward lobe in the cells right of the light over the distance, relative to distance 1.
    OutwardLobe {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: String,
        /// Largest distance.
        to: usize,
    },
    /// The difference to `expression` (in `x`) of another series, point by point.
    Deviation {
        /// Name in the legend.
        label: String,
        /// The series, one of the others.
        of: Box<SeriesSource>,
        /// The expression.
        from: String,
    },
    /// `|energy(n) - energy(0)|` over the step, W.
    EnergyError {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: String,
    },
    /// Mean distance of the energy from the centre over the step, cells.
    RadiusMean {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: String,
    },
    /// Standard deviation of that distance over the step, cells.
    RadiusSpread {
        /// Name in the legend.
        label: String,
        /// Name of the light run.
        run: String,
    },
    /// A row of a gradient's slice over the column.
    SliceRow {
        /// Name in the legend.
        label: String,
        /// Name of the gradient run.
        run: String,
        /// Direction, degrees.
        deg: Finite,
        /// Row.
        row: usize,
    },
    /// Seconds that runs took, over their number in this list (from 1); runs of another scope are left out.
    Seconds {
        /// Name in the legend.
        label: String,
        /// Names of gradient runs.
        runs: Vec<String>,
    },
    /// A number of the pulses in one direction, over the column of their cell.
    PulsesOverColumn {
        /// Name in the legend.
        label: String,
        /// Name of the pulses run.
        run: String,
        /// The number.
        number: PulseNumber,
        /// Direction, degrees.
        deg: Finite,
    },
    /// Mean of a gradient over all inner cells, over the direction in degrees.
    MeanOverCells {
        /// Name in the legend.
        label: String,
        /// Name of the gradient run.
        run: String,
    },
}
