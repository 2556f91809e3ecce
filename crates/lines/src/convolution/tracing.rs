//! The lines along which a texture is smoothed.

use crate::lanes::{Beside, Directions, LANES, Lanes, Pairs};
use crate::slope::{Rule, WithRule};
use crate::{Family, Interpolated, LineEnd};
#[cfg(test)]
use tigereye_core::Field;
use tigereye_core::{Cell, Point, Vector};
use tigereye_simd::{ArrayLoop, Level};

/// Tensors whose axes differ by less than this fraction of the longer one count as isotropic.
const LEAST: f64 = 1e-3;
/// A line ends if its direction changes by more than 60 degrees within a step, so that the cosine falls below this.
const LEAST_COSINE: f64 = 0.5;

/// How lines of a texture are traced: by the midpoint rule, in steps of one length.
pub(super) struct Tracing<'a> {
    pub(super) field: &'a Interpolated<'a>,
    pub(super) family: Family,
    /// The direction to take where the axis is undefined; without it, lines end there.
    pub(super) straight: Option<Vector>,
    pub(super) step: f64,
    /// Samples per cell along x and y.
    pub(super) samples: [f64; 2],
}

/// The points of a line on one side of its start, which is not among them. It has fewer than requested if it ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trace {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
}

impl Tracing<'_> {
    /// The axis at a point, with either sign.
    pub(super) fn direction(&self, at: Point) -> Option<Vector> {
        let found = self.field.direction(at, self.family, LEAST);
        found.or_else(|| self.straight.filter(|_| self.field.at(at).is_some_and(|t| !t.is_zero())))
    }

    /// The axis at a point with the sign that agrees with a direction; `None` if they differ by more than 60 degrees.
    fn along(&self, at: Point, towards: Vector) -> Option<Vector> {
        if let Some(numbers) = self.field.numbers(at)
            && let Some(found) = self.field.axes().slope(numbers, self.family, towards.into())
            && found.contrast > self.field.axes().least_contrast(LEAST) * found.longer
        {
            return found.bends_at_most(LEAST_COSINE * LEAST_COSINE).then(|| found.along.into());
        }
        let d = self.direction(at)?;
        let cosine = d.dot(towards);
        if cosine.abs() < LEAST_COSINE {
            return None;
        }
        Some(if cosine < 0.0 { -d } else { d })
    }

    /// A step: the next point, and the direction there.
    #[cfg(test)]
    pub(super) fn next(&self, at: Point, towards: Vector) -> Option<(Point, Vector)> {
        let half = self.field.cell().ahead(at, towards, 0.5 * self.step);
        let middle = self.along(half, towards)?;
        let to = self.field.cell().ahead(at, middle, self.step);
        Some((to, self.along(to, middle)?))
    }

    /// The point of a sample.
    pub(super) fn point(&self, sample: Cell) -> Point {
        Point::new(sample.x as f64 / self.samples[0], sample.y as f64 / self.samples[1])
    }

    /// The sample nearest to a point.
    #[cfg(test)]
    pub(super) fn sample(&self, texture: &Field<f64>, at: Point) -> f64 {
        let grid = texture.grid();
        let index = |v: f64, samples: f64, n: usize| ((v * samples + 0.5).max(0.0) as usize).min(n - 1);
        let [per_x, per_y] = self.samples;
        *texture.at(Cell::new(index(at.x, per_x, grid.width()), index(at.y, per_y, grid.height())))
    }

    /// The first `steps` points of the lines from points in directions.
    pub(super) fn traces(&self, starts: &[(Point, Vector)], steps: usize, level: Level) -> Vec<Trace> {
        self.field.axes().with_rule(Traces { tracing: self, starts, steps, level })
    }
}

impl Directions for Tracing<'_> {
    fn field(&self) -> &Interpolated<'_> {
        self.field
    }

    fn sign(&self) -> f64 {
        self.family.sign()
    }

    fn limits(&self) -> [f64; 2] {
        [self.field.axes().least_contrast(LEAST), LEAST_COSINE * LEAST_COSINE]
    }

    fn single(&self, at: Point, towards: Vector) -> Result<(Vector, f64), LineEnd> {
        self.along(at, towards).map(|d| (d, 0.0)).ok_or(LineEnd::Border)
    }
}

/// Most steps that are made at once where a line is nearly straight.
const STRIDE: usize = 4;
/// Directions within such a stride differ by at most 18 degrees: the square of the cosine.
const STRAIGHT: f64 = 0.905;

/// The same lines where they are nearly straight and far from everything unusual: there is no other decision.
struct Straight<'a>(&'a Tracing<'a>);

impl Directions for Straight<'_> {
    fn field(&self) -> &Interpolated<'_> {
        self.0.field
    }

    fn sign(&self) -> f64 {
        self.0.sign()
    }

    fn limits(&self) -> [f64; 2] {
        [self.0.limits()[0], STRAIGHT]
    }

    fn single(&self, _: Point, _: Vector) -> Result<(Vector, f64), LineEnd> {
        Err(LineEnd::Stopped)
    }
}

/// Several steps at once, by the midpoint rule, and the points between by the cubic through both ends with their
/// directions: the points and directions at the end, and which lines are straight enough for it.
#[inline(always)]
fn stride<R: Rule, const SYMMETRIC: bool>(
    ahead: &mut Beside<'_, Straight<'_>>,
    (at, towards): &(Pairs, Pairs),
    step: f64,
    steps: usize,
    points: &mut Vec<Pairs>,
) -> ((Pairs, Pairs), [bool; LANES]) {
    let length = step * steps as f64;
    ahead.begin();
    let middle = ahead.slopes::<R, SYMMETRIC>(&ahead.ahead(at, towards, &[0.5 * length; LANES]), towards);
    let to = ahead.ahead(at, &middle.along, &[length; LANES]);
    let next = ahead.slopes::<R, SYMMETRIC>(&to, &middle.along);
    // Directions in cells, y downwards.
    let origin: Pairs = [[0.0; LANES]; 2];
    let (start, end) = (
        ahead.ahead(&origin, towards, &[length; LANES]),
        ahead.ahead(&origin, &next.along, &[length; LANES]),
    );
    for k in 1..steps {
        let t = k as f64 / steps as f64;
        let u = 1.0 - t;
        let (a, b) = ((1.0 + 2.0 * t) * u * u, (1.0 + 2.0 * u) * t * t);
        let (c, d) = (t * u * u, -(u * t * t));
        let mut between: Pairs = [[0.0; LANES]; 2];
        for i in 0..2 {
            for l in 0..LANES {
                between[i][l] = (a * at[i][l] + b * to[i][l]) + (c * start[i][l] + d * end[i][l]);
            }
        }
        points.push(between);
    }
    points.push(to);
    let mut is_straight = [true; LANES];
    if ahead.is_ended {
        for l in 0..LANES {
            is_straight[l] = ahead.ends[l].is_none();
        }
    }
    ((to, next.along), is_straight)
}

struct Traces<'a> {
    tracing: &'a Tracing<'a>,
    starts: &'a [(Point, Vector)],
    steps: usize,
    level: Level,
}

impl WithRule for Traces<'_> {
    type Output = Vec<Trace>;

    fn with<R: Rule>(self) -> Vec<Trace> {
        let Self { tracing, starts, steps, level } = self;
        let rule = core::marker::PhantomData;
        if tracing.field.is_symmetric() {
            level.compiled(March::<R, true> { tracing, starts, steps, rule })
        } else {
            level.compiled(March::<R, false> { tracing, starts, steps, rule })
        }
    }
}

/// All lines of a list, [`LANES`] at a time.
struct March<'a, R, const SYMMETRIC: bool> {
    tracing: &'a Tracing<'a>,
    starts: &'a [(Point, Vector)],
    steps: usize,
    rule: core::marker::PhantomData<R>,
}

impl<R: Rule, const SYMMETRIC: bool> ArrayLoop for March<'_, R, SYMMETRIC> {
    type Output = Vec<Trace>;

    #[inline(always)]
    fn run(self) -> Vec<Trace> {
        let mut traces = Vec::with_capacity(self.starts.len());
        let step: Lanes = [self.tracing.step; LANES];
        let half = step.map(|h| 0.5 * h);
        let mut beside = Beside::new(self.tracing);
        let straight = Straight(self.tracing);
        let mut ahead = Beside::new(&straight);
        let mut points: Vec<Pairs> = Vec::with_capacity(self.steps);
        for starts in self.starts.chunks(LANES) {
            // Lanes without a line repeat the first one.
            let start = |l: usize| starts[if l < starts.len() { l } else { 0 }];
            let mut at: Pairs = [[0.0; LANES]; 2];
            let mut towards: Pairs = [[0.0; LANES]; 2];
            for l in 0..LANES {
                let (from, direction) = start(l);
                (at[0][l], at[1][l]) = (from.x, from.y);
                (towards[0][l], towards[1][l]) = (direction.x, direction.y);
            }
            points.clear();
            beside.begin();
            let mut lengths = [0; LANES];
            let mut is_ended = [false; LANES];
            while points.len() < self.steps && is_ended != [true; LANES] {
                let most = (self.steps - points.len()).min(STRIDE);
                let from = (at, towards);
                let mut strode =
                    stride::<R, SYMMETRIC>(&mut ahead, &from, self.tracing.step, most, &mut points);
                (at, towards) = strode.0;
                for l in 0..LANES {
                    strode.1[l] |= is_ended[l];
                }
                if strode.1 == [true; LANES] {
                    for l in 0..LANES {
                        lengths[l] += if is_ended[l] { 0 } else { most };
                    }
                    continue;
                }
                // Some lines have to go step by step; those that strode keep what they have.
                let first = points.len() - most;
                let (mut fine_at, mut fine_towards) = from;
                for k in 0..most {
                    let middle = beside
                        .slopes::<R, SYMMETRIC>(&beside.ahead(&fine_at, &fine_towards, &half), &fine_towards);
                    let to = beside.ahead(&fine_at, &middle.along, &step);
                    let next = beside.slopes::<R, SYMMETRIC>(&to, &middle.along);
                    for l in 0..LANES {
                        if !strode.1[l] {
                            is_ended[l] |= beside.is_ended && beside.ends[l].is_some();
                        }
                        // A line that has ended stays where it was.
                        if !is_ended[l] {
                            (fine_at[0][l], fine_at[1][l]) = (to[0][l], to[1][l]);
                            (fine_towards[0][l], fine_towards[1][l]) = (next.along[0][l], next.along[1][l]);
                            lengths[l] += 1;
                        }
                        if !strode.1[l] {
                            (points[first + k][0][l], points[first + k][1][l]) =
                                (fine_at[0][l], fine_at[1][l]);
                        }
                    }
                }
                for l in 0..LANES {
                    if !strode.1[l] {
                        (at[0][l], at[1][l]) = (fine_at[0][l], fine_at[1][l]);
                        (towards[0][l], towards[1][l]) = (fine_towards[0][l], fine_towards[1][l]);
                    }
                }
                if beside.is_ended {
                    // What a line that strode met step by step does not count.
                    for l in 0..LANES {
                        if strode.1[l] {
                            beside.ends[l] = None;
                        }
                    }
                }
            }
            traces.extend((0..starts.len()).map(|l| {
                let of = |axis: usize| points[..lengths[l]].iter().map(|at| at[axis][l]).collect();
                Trace { x: of(0), y: of(1) }
            }));
        }
        traces
    }
}
