//! Steps along an axis.

use crate::{Family, Interpolated, LineEnd, LineOptions, Method};
use tigereye_core::{Point, Vector, length};

/// Cosine of the largest turn from one stage of a step to the next, 30 degrees, which fourth order follows well.
const LARGEST_TURN: f64 = 0.866;
/// Least part of the contrast that is left after a step. It grows in proportion to the distance from a degenerate
/// point, so that a step of a cell or less which leaves half of it does not lead across.
const LEAST_LEFT: f64 = 0.5;
/// A step that would leave the field, is not exact enough or too near to a degenerate point, is halved down to this
/// part of the longest one.
const SHORTEST: f64 = 1.0 / 65536.0;
/// Most trial steps per full step of a fixed length, and this many more in all.
const TRIES: [f64; 2] = [8.0, 1000.0];

/// How lines of one family go on.
pub(crate) struct Walk<'a> {
    pub(crate) field: &'a Interpolated<'a>,
    pub(crate) family: Family,
    pub(crate) options: &'a LineOptions,
}

/// A point of a line: where it is (in cells), where it goes (a physical direction), and what tells the axes apart there
/// ([`crate::Frame::contrast`]).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) at: Point,
    pub(crate) towards: Vector,
    pub(crate) contrast: f64,
}

/// What is to come of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    pose: Pose,
    /// Length so far, in the unit of [`tigereye_core::CellShape`].
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

/// Where a step leads.
struct Step {
    pose: Pose,
    /// Least contrast on the way.
    least: f64,
    /// By how much two orders differ, in parts of what they may.
    error: f64,
}

/// An axis, and what tells it from the other one.
type Slope = (Vector, f64);

/// Coefficients of Dormand and Prince: of the slopes before each stage, and the difference of both orders.
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
    /// The beginning of a line along the axis at a point, with the sign that is nearer to `towards`.
    pub(crate) fn begin(&self, at: Point, towards: Vector) -> Result<Progress, LineEnd> {
        let (towards, contrast) = self.slope(at, towards)?;
        let pose = Pose { at, towards, contrast };
        Ok(Progress { pose, gone: 0.0, step: self.options.step, shortened: false, tries: 0.0 })
    }

    /// The next point of a line.
    pub(crate) fn advance(&self, line: &mut Progress) -> Result<(), LineEnd> {
        let left = self.options.length - line.gone;
        // Rounding of the sum is no step of its own. Not a number is no length either.
        if left.is_nan() || left <= 1e-9 * self.options.step {
            return Err(LineEnd::Length);
        }
        let mut length = line.step.min(left);
        loop {
            line.tries += 1.0;
            if line.tries > self.most_tries() {
                return Err(LineEnd::Degenerate);
            }
            let is_shortest = 0.5 * length < self.shortest();
            match self.step(line.pose, length) {
                // What the tolerance asks beyond the shortest step is rounding, or a kink between cells.
                Ok(made) if made.error <= 1.0 || is_shortest => {
                    line.pose = made.pose;
                    line.gone += length;
                    line.step = self.next(length, made.error, line.shortened);
                    line.shortened = false;
                    return Ok(());
                }
                Err(end) if is_shortest => return Err(end),
                _ => (length, line.shortened) = (0.5 * length, true),
            }
        }
    }

    /// Steps near to a degenerate point are short without end.
    fn most_tries(&self) -> f64 {
        let LineOptions { method, length, step, .. } = *self.options;
        match method {
            Method::RungeKutta4 => TRIES[0] * length / step + TRIES[1],
            Method::DormandPrince { .. } => LineOptions::MAX_STEPS,
        }
    }

    fn shortest(&self) -> f64 {
        self.options.step * SHORTEST
    }

    /// The step to try next: by the error of the last one, relative to the tolerance. One of a fixed length becomes
    /// longer again, but not right after it had to be shortened: before an end every second one would be.
    fn next(&self, length: f64, error: f64, shortened: bool) -> f64 {
        match self.options.method {
            Method::RungeKutta4 if shortened => length,
            Method::RungeKutta4 => self.options.step.min(2.0 * length),
            Method::DormandPrince { .. } => {
                let factor = 0.9 * tigereye_core::math::pow(error.max(1e-10), -0.2);
                (length * factor.clamp(0.2, 5.0)).clamp(self.shortest(), self.options.step)
            }
        }
    }

    /// The direction at a point, coming from `towards`.
    fn slope(&self, at: Point, towards: Vector) -> Result<Slope, LineEnd> {
        let least = if self.options.inertia.is_some() { 0.0 } else { self.options.least_anisotropy };
        let Some(frame) = self.field.frame(at, least) else {
            return match (self.field.at(at), self.options.inertia) {
                // A tensor without axes lets a line with inertia pass, unless it is zero.
                (Some(t), Some(_)) if !t.is_zero() => Ok((towards, 0.0)),
                (Some(_), _) => Err(LineEnd::Degenerate),
                (None, _) => Err(LineEnd::Border),
            };
        };
        let along = frame.axes[self.family as usize];
        let cosine = along.dot(towards);
        let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
        let along = along * sign;
        let Some(inertia) = self.options.inertia else {
            let turns = cosine.abs() < LARGEST_TURN;
            return if turns { Err(LineEnd::Degenerate) } else { Ok((along, frame.contrast)) };
        };
        let across = frame.axes[1 - self.family as usize];
        let [longer, shorter] = {
            let [a, b] = frame.values.map(f64::abs);
            [a.max(b), a.min(b)]
        };
        let ratio = if longer > 0.0 { shorter / longer } else { 1.0 };
        let other = across.dot(towards);
        // The component along the line's own axis stays, the other one shrinks.
        let turned = unit(along * cosine.abs() + across * (ratio * other));
        let w = inertia.puncture;
        let mixed = along * (1.0 - ratio) + (towards * (1.0 - w) + turned * w) * ratio;
        Ok((unit(mixed), 0.0))
    }

    fn step(&self, from: Pose, h: f64) -> Result<Step, LineEnd> {
        let step = match self.options.method {
            Method::RungeKutta4 => self.runge_kutta(from, h),
            Method::DormandPrince { tolerance } => self.dormand_prince(from, h, tolerance),
        }?;
        // Lines with inertia cross what others end at; their contrast counts as none.
        let is_left = step.least >= LEAST_LEFT * from.contrast;
        if is_left { Ok(step) } else { Err(LineEnd::Degenerate) }
    }

    fn runge_kutta(&self, from: Pose, h: f64) -> Result<Step, LineEnd> {
        let ahead = |k: Vector, h: f64| self.field.cell().ahead(from.at, k, h);
        // The step before ended with the slope that this one begins with.
        let a = from.towards;
        let (b, first) = self.slope(ahead(a, 0.5 * h), a)?;
        let (c, second) = self.slope(ahead(b, 0.5 * h), b)?;
        let (d, _) = self.slope(ahead(c, h), c)?;
        let mean = (a + b * 2.0 + c * 2.0 + d) / 6.0;
        let at = ahead(mean, h);
        let (towards, contrast) = self.slope(at, d)?;
        Ok(Step { pose: Pose { at, towards, contrast }, least: first.min(second).min(contrast), error: 0.0 })
    }

    fn dormand_prince(&self, from: Pose, h: f64, tolerance: f64) -> Result<Step, LineEnd> {
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
