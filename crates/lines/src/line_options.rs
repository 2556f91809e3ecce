//! How lines are followed, and why they end.

/// The integration method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The classical Runge-Kutta method of fourth order, every step of the same length.
    RungeKutta4,
    /// The same with steps as long as the error allows, halved and doubled. Its estimate is the difference to a result
    /// of third order that needs no further slope, because the last one of a step is the first of the next.
    RungeKutta43 {
        /// Largest estimate within a step, in units of the smaller side of a cell.
        tolerance: f64,
    },
    /// The embedded pair of orders five and four of Dormand and Prince (A family of embedded Runge-Kutta formulae,
    /// 1980), with steps as long as the error allows.
    DormandPrince {
        /// Largest difference of the two orders within a step, in units of the smaller side of a cell.
        tolerance: f64,
    },
}

/// How lines are integrated. Lengths count in the smaller side of a cell ([`tigereye_core::CellShape`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOptions {
    /// The integration method.
    pub method: Method,
    /// Length of a step; the longest one of [`Method::DormandPrince`]. Steps are shorter near degenerate points,
    /// borders and sharp bends; steps of more than a cell may jump across a degenerate point.
    pub step: f64,
    /// Greatest length of a line in each direction.
    pub length: f64,
    /// Lines end where the axes differ by less than this, see [`crate::Axes::of`].
    pub least_anisotropy: f64,
    /// Inertia of tensorlines (Weinstein, Kindlmann and Lundberg, Tensorlines, 1999), which keeps them straight where
    /// the tensor is nearly isotropic. `None` follows the axes alone.
    pub inertia: Option<Inertia>,
}

/// Inertia of a line where the tensor is nearly isotropic. With the anisotropy `c = 1 - |v2| / |v1|` of the semi-axes,
/// the line continues along `c e + (1 - c) ((1 - w) i + w D i)`, where e is the axis, i the incoming direction, and D i
/// that direction deflected towards the axis by the tensor. As in the paper, this is applied once per step, so a line
/// converges to the axis over a shorter distance if steps are shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// The weight w of the deflection (the paper's puncture weight), 0 to 1; 0 is pure inertia.
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
    /// It reaches the centres of the outermost cells, or non-finite cells.
    Border,
    /// It reaches a degenerate point, or needs too many steps to pass one.
    Degenerate,
    /// It has reached its greatest length.
    Length,
    /// It returns to its seed.
    Closed,
    /// The caller stopped it.
    Stopped,
}

impl LineOptions {
    /// Largest number of steps of a line to each side.
    pub const MAX_STEPS: f64 = 1e7;

    /// Whether steps are positive and finite, and not too many.
    pub(crate) fn are_possible(&self) -> bool {
        let tolerance = match self.method {
            Method::RungeKutta4 => true,
            Method::RungeKutta43 { tolerance } | Method::DormandPrince { tolerance } => tolerance > 0.0,
        };
        tolerance && self.step > 0.0 && self.step.is_finite() && self.length / self.step <= Self::MAX_STEPS
    }
}
