//! How lines are followed, and why they end.

/// How a line is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The classical Runge-Kutta method of fourth order, every step of the same length.
    RungeKutta4,
    /// The pair of orders five and four of Dormand and Prince (A family of embedded Runge-Kutta formulae, 1980), with
    /// steps as long as the error allows.
    DormandPrince {
        /// Largest difference of the two orders within a step, in the unit of [`tigereye_core::CellShape`].
        tolerance: f64,
    },
}

/// How lines are followed. Lengths are in the unit of [`tigereye_core::CellShape`]: cells, where these are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOptions {
    /// How steps are made.
    pub method: Method,
    /// Length of a step; the longest one of [`Method::DormandPrince`]. Steps are shorter before degenerate points,
    /// borders and sharp turns; those of more than a cell may lead across a degenerate point.
    pub step: f64,
    /// Longest line in each direction.
    pub length: f64,
    /// Lines end where the axes differ by less, see [`crate::Axes::of`].
    pub least_anisotropy: f64,
    /// Inertia of tensorlines (Weinstein, Kindlmann and Lundberg, Tensorlines, 1999), which keeps them straight where
    /// the tensor is round. `None` follows the axes alone.
    pub inertia: Option<Inertia>,
}

/// What a line does where the tensor says little: with the anisotropy `c = 1 - |v2| / |v1|` of the half-lengths it goes
/// on along `c e + (1 - c) ((1 - w) i + w D i)`, where e is the axis, i the direction it comes from, and D i that
/// direction turned towards the axis by the tensor. As in the paper this happens once a step, so that shorter steps
/// turn a line to the axis on a shorter way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// The weight w of the tensor's turning (the paper's puncture weight), 0 to 1; 0 is pure inertia.
    pub puncture: f64,
}

impl Default for LineOptions {
    fn default() -> Self {
        let method = Method::RungeKutta4;
        Self { method, step: 0.1, length: 1000.0, least_anisotropy: 1e-3, inertia: None }
    }
}

/// Why a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// It reaches the centres of the outermost cells, or cells without numbers.
    Border,
    /// It comes to a point where the tensor has no axis, or turns around one in more steps than can be made.
    Degenerate,
    /// It is as long as it may be.
    Length,
    /// It comes back to where it began.
    Closed,
    /// It was told to end.
    Stopped,
}

impl LineOptions {
    /// Most steps of a line to each side.
    pub const MAX_STEPS: f64 = 1e7;

    /// Neither steps that lead nowhere, nor so many that they do not end.
    pub(crate) fn are_possible(&self) -> bool {
        let tolerance = match self.method {
            Method::RungeKutta4 => true,
            Method::DormandPrince { tolerance } => tolerance > 0.0,
        };
        tolerance && self.step > 0.0 && self.step.is_finite() && self.length / self.step <= Self::MAX_STEPS
    }
}
