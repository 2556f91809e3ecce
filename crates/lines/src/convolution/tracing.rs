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
            for _ in 0..self.steps {
                let middle = beside.slopes::<R, SYMMETRIC>(&beside.ahead(&at, &towards, &half), &towards);
                let to = beside.ahead(&at, &middle.along, &step);
                let next = beside.slopes::<R, SYMMETRIC>(&to, &middle.along);
                if beside.is_ended {
                    for l in 0..LANES {
                        is_ended[l] = beside.ends[l].is_some();
                    }
                }
                for l in 0..LANES {
                    lengths[l] += usize::from(!is_ended[l]);
                    // A line that has ended stays where it was.
                    let select = |new: f64, old: f64| if is_ended[l] { old } else { new };
                    (at[0][l], at[1][l]) = (select(to[0][l], at[0][l]), select(to[1][l], at[1][l]));
                    towards[0][l] = select(next.along[0][l], towards[0][l]);
                    towards[1][l] = select(next.along[1][l], towards[1][l]);
                }
                points.push(at);
                if is_ended == [true; LANES] {
                    break;
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
