//! Integration of lines along an axis, step by step.

use crate::{Family, Interpolated, LineEnd, LineOptions, Method};
use tigereye_core::{Point, Vector, length};

/// The direction may change by at most 30 degrees from one stage of a step to the next, which fourth order follows
/// well: its cosine must not fall below this.
pub(crate) const LEAST_COSINE: f64 = 0.866;
/// Least fraction of the contrast that remains after a step. Contrast grows linearly with the distance from a
/// degenerate point, so a step of up to a cell that keeps half of it does not jump across the point.
pub(crate) const LEAST_LEFT: f64 = 0.5;
/// A step that would leave the field, is not accurate enough or comes too close to a degenerate point is halved, down
/// to this fraction of the longest one.
const SHORTEST: f64 = 1.0 / 65536.0;
/// Most trial steps per full step of a fixed length, and this many more in all.
const TRIES: [f64; 2] = [8.0, 1000.0];

/// A step doubles if its error is below this fraction of the tolerance: it grows with the fourth power of the length.
pub(crate) const GROWS: f64 = 1.0 / 32.0;

/// Integrates the lines of one family.
pub(crate) struct Walk<'a> {
    pub(crate) field: &'a Interpolated<'a>,
    pub(crate) family: Family,
    pub(crate) options: &'a LineOptions,
}

/// A point of a line, its direction there, and the [`crate::Frame::contrast`] of the axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) at: Point,
    pub(crate) towards: Vector,
    pub(crate) contrast: f64,
}

/// The state of a line under integration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    pose: Pose,
    /// Length so far, in units of the smaller side of a cell.
    gone: f64,
    /// Length of the next step, and whether the last one had to be shortened.
    step: f64,
    shortened: bool,
    tries: f64,
}

impl Progress {
    pub(crate) fn pose(&self) -> Pose {
        self.pose
    }
}

/// The result of a step.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    pub(crate) pose: Pose,
    /// Least contrast of its stages.
    pub(crate) least: f64,
    /// Difference of the two orders, relative to the tolerance.
    pub(crate) error: f64,
}

/// A direction, and the contrast of the axes there.
type Slope = (Vector, f64);

/// Coefficients of Dormand and Prince: the weights of the previous slopes in each stage, then those of the error
/// estimate, the difference of both orders.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

impl Walk<'_> {
    /// Begins a line along the axis at a point, with the sign closer to `towards`.
    pub(crate) fn begin(&self, at: Point, towards: Vector) -> Result<Progress, LineEnd> {
        let (towards, contrast) = self.slope(at, towards)?;
        let pose = Pose { at, towards, contrast };
        Ok(Progress { pose, gone: 0.0, step: self.options.step, shortened: false, tries: 0.0 })
    }

    /// Advances a line by one step.
    pub(crate) fn advance(&self, line: &mut Progress) -> Result<(), LineEnd> {
        let mut length = f64::NAN;
        loop {
            length = self.attempt(line, length)?;
            match self.step(line.pose, length) {
                // If even the shortest step misses the tolerance, the cause is rounding or a kink between cells.
                Ok(made) if made.error <= 1.0 || self.is_shortest(length) => {
                    self.arrive(line, made, length);
                    return Ok(());
                }
                Err(end) if self.is_shortest(length) => return Err(end),
                _ => length = self.shortened(line, length),
            }
        }
    }

    /// The length of the next trial step: `length`, or that of a new step if it is NaN.
    #[inline(always)]
    pub(crate) fn attempt(&self, line: &mut Progress, mut length: f64) -> Result<f64, LineEnd> {
        if length.is_nan() {
            let left = self.options.length - line.gone;
            // A remainder from rounding of the sum is not worth a step; nor is a NaN.
            if left.is_nan() || left <= 1e-9 * self.options.step {
                return Err(LineEnd::Length);
            }
            length = line.step.min(left);
        }
        line.tries += 1.0;
        if line.tries > self.most_tries() { Err(LineEnd::Degenerate) } else { Ok(length) }
    }

    /// Whether half a step would be too short.
    #[inline(always)]
    pub(crate) fn is_shortest(&self, length: f64) -> bool {
        0.5 * length < self.shortest()
    }

    /// Takes a step of a length.
    #[inline(always)]
    pub(crate) fn arrive(&self, line: &mut Progress, made: Step, length: f64) {
        line.pose = made.pose;
        line.gone += length;
        line.step = self.next(length, made.error, line.shortened);
        line.shortened = false;
    }

    /// The next length to try after one that was rejected.
    #[inline(always)]
    pub(crate) fn shortened(&self, line: &mut Progress, length: f64) -> f64 {
        line.shortened = true;
        0.5 * length
    }

    /// Where the line from a point ends, and why.
    pub(crate) fn end_of(&self, at: Point, towards: Vector) -> (Point, LineEnd) {
        let mut line = match self.begin(at, towards) {
            Ok(line) => line,
            Err(end) => return (at, end),
        };
        loop {
            if let Err(end) = self.advance(&mut line) {
                return (line.pose().at, end);
            }
        }
    }

    /// A bound for lines whose steps near a degenerate point become ever shorter.
    pub(crate) fn most_tries(&self) -> f64 {
        let LineOptions { method, length, step, .. } = *self.options;
        match method {
            Method::RungeKutta4 => TRIES[0] * length / step + TRIES[1],
            Method::RungeKutta43 { .. } | Method::DormandPrince { .. } => LineOptions::MAX_STEPS,
        }
    }

    pub(crate) fn shortest(&self) -> f64 {
        self.options.step * SHORTEST
    }

    /// What makes of a difference of slopes the error of a step relative to the tolerance; 0 for steps of one length.
    pub(crate) fn per_tolerance(&self) -> f64 {
        match self.options.method {
            Method::RungeKutta4 | Method::DormandPrince { .. } => 0.0,
            Method::RungeKutta43 { tolerance } => 1.0 / (6.0 * tolerance),
        }
    }

    /// The length of the next step. With an error estimate, it follows from the error of the last step relative to the
    /// tolerance. A fixed step that was shortened grows again, but not immediately: near the end of a line every second
    /// step would be rejected otherwise.
    fn next(&self, length: f64, error: f64, shortened: bool) -> f64 {
        match self.options.method {
            Method::RungeKutta4 | Method::RungeKutta43 { .. } => {
                let may_grow = !shortened && error < GROWS;
                if may_grow { self.options.step.min(2.0 * length) } else { length }
            }
            Method::DormandPrince { .. } => {
                let factor = 0.9 * tigereye_core::math::pow(error.max(1e-10), -0.2);
                (length * factor.clamp(0.2, 5.0)).clamp(self.shortest(), self.options.step)
            }
        }
    }

    /// The direction of a line at a point, for the incoming direction `towards`.
    pub(crate) fn slope(&self, at: Point, towards: Vector) -> Result<Slope, LineEnd> {
        if self.options.inertia.is_none() {
            let Some(numbers) = self.field.numbers(at) else { return Err(LineEnd::Border) };
            if let Some(found) = self.field.axes().slope(numbers, self.family, towards.into()) {
                let least = self.field.axes().least_contrast(self.options.least_anisotropy);
                let is_distinct = found.contrast > least * found.longer;
                let is_sharp = !found.bends_at_most(LEAST_COSINE * LEAST_COSINE);
                return if is_distinct && !is_sharp {
                    Ok((found.along.into(), found.contrast))
                } else {
                    Err(LineEnd::Degenerate)
                };
            }
        }
        self.slope_of_any(at, towards)
    }

    /// The same for tensors of any size, and for lines with inertia.
    fn slope_of_any(&self, at: Point, towards: Vector) -> Result<Slope, LineEnd> {
        let least = if self.options.inertia.is_some() { 0.0 } else { self.options.least_anisotropy };
        let Some(frame) = self.field.frame(at, least) else {
            return match (self.field.at(at), self.options.inertia) {
                // A line with inertia passes a degenerate tensor, unless it is zero.
                (Some(t), Some(_)) if !t.is_zero() => Ok((towards, 0.0)),
                (Some(_), _) => Err(LineEnd::Degenerate),
                (None, _) => Err(LineEnd::Border),
            };
        };
        // Of the two signs of the axis, take the one closer to the incoming direction.
        let along = frame.axes[self.family as usize];
        let cosine = along.dot(towards);
        let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
        let along = along * sign;
        let Some(inertia) = self.options.inertia else {
            let is_sharp = cosine.abs() < LEAST_COSINE;
            return if is_sharp { Err(LineEnd::Degenerate) } else { Ok((along, frame.contrast)) };
        };
        // Inertia: mix the axis with the incoming direction, the more so the more isotropic the tensor is.
        let across = frame.axes[1 - self.family as usize];
        let [longer, shorter] = {
            let [a, b] = frame.values.map(f64::abs);
            [a.max(b), a.min(b)]
        };
        let ratio = if longer > 0.0 { shorter / longer } else { 1.0 };
        let other = across.dot(towards);
        // The deflection D i: the component along the line's own axis stays, the other one shrinks by the ratio.
        let turned = unit(along * cosine.abs() + across * (ratio * other));
        let w = inertia.puncture;
        let mixed = along * (1.0 - ratio) + (towards * (1.0 - w) + turned * w) * ratio;
        Ok((unit(mixed), 0.0))
    }

    fn step(&self, from: Pose, h: f64) -> Result<Step, LineEnd> {
        let step = match self.options.method {
            Method::RungeKutta4 | Method::RungeKutta43 { .. } => self.runge_kutta(from, h),
            Method::DormandPrince { tolerance } => self.dormand_prince(from, h, tolerance),
        }?;
        // Lines with inertia may cross degenerate points: their contrast is always 0.
        let is_left = step.least >= LEAST_LEFT * from.contrast;
        if is_left { Ok(step) } else { Err(LineEnd::Degenerate) }
    }

    fn runge_kutta(&self, from: Pose, h: f64) -> Result<Step, LineEnd> {
        let ahead = |k: Vector, h: f64| self.field.cell().ahead(from.at, k, h);
        // The first slope is the last one of the previous step.
        let a = from.towards;
        // Each stage takes the sign of its axis from the stage before.
        let (b, first) = self.slope(ahead(a, 0.5 * h), a)?;
        let (c, second) = self.slope(ahead(b, 0.5 * h), b)?;
        let (d, _) = self.slope(ahead(c, h), c)?;
        let mean = (a + b * 2.0 + c * 2.0 + d) / 6.0;
        let at = ahead(mean, h);
        let (towards, contrast) = self.slope(at, d)?;
        // With the slope at the end in place of the last one, the weights give a result of third order.
        let off = d - towards;
        let error = h * (off.x * off.x + off.y * off.y).sqrt() * self.per_tolerance();
        Ok(Step { pose: Pose { at, towards, contrast }, least: first.min(second).min(contrast), error })
    }

    fn dormand_prince(&self, from: Pose, h: f64, tolerance: f64) -> Result<Step, LineEnd> {
        // The point of the last stage is the result of the step, so its slope begins the next one.
        let mut slopes = [Vector::zero(); 7];
        slopes[0] = from.towards;
        let (mut at, mut contrast, mut least) = (from.at, 0.0, f64::INFINITY);
        for (i, weights) in STAGES.iter().enumerate() {
            at = self.field.cell().ahead(from.at, weighted(weights, &slopes), h);
            (slopes[i + 1], contrast) = self.slope(at, slopes[i])?;
            least = least.min(contrast);
        }
        let off = weighted(&ERROR, &slopes) * h;
        let pose = Pose { at, towards: slopes[6], contrast };
        Ok(Step { pose, least, error: length(off) / tolerance })
    }
}

fn weighted(weights: &[f64], slopes: &[Vector]) -> Vector {
    let of = |component: fn(&Vector) -> f64| {
        weights.iter().zip(slopes).map(|(w, s)| w * component(s)).sum::<f64>()
    };
    Vector::new(of(|s| s.x), of(|s| s.y))
}

fn unit(v: Vector) -> Vector {
    let size = length(v);
    if size > 0.0 { v / size } else { v }
}
