//! Lines side by side: the steps of [`Walk`] and of textures for several lines at once.
//!
//! A step waits for one square root and division after another, while the processor could compute several; lines that
//! do not depend on each other fill the gaps. The arithmetic of each lane is that of a single line, so a line ends at
//! the same bits, whichever lines run beside it and whatever the instruction set. Whatever is unusual (a border, a
//! degenerate point, a sharp bend, numbers of extreme size) is left to the single line.

use crate::interpolated::{Place, Within, evaluated, polynomial};
use crate::slope::{self, Rule, Slope, WithRule};
use crate::walk::{LEAST_COSINE, LEAST_LEFT, Pose, Progress, Step, Walk};
use crate::{Interpolated, LineEnd, Method};
use tigereye_core::{Point, Vector};
use tigereye_simd::{ArrayLoop, Level};

/// Lines side by side: what two registers of AVX2, or one of AVX-512, hold.
pub(crate) const LANES: usize = 8;
/// A number of each line.
pub(crate) type Lanes = [f64; LANES];
/// A point or vector of each line.
pub(crate) type Pairs = [Lanes; 2];

/// How lines that run side by side get their directions.
pub(crate) trait Directions: Sync {
    /// The field whose axes they follow.
    fn field(&self) -> &Interpolated<'_>;
    /// 1 for the major axes, -1 for the minor ones.
    fn sign(&self) -> f64;
    /// The least contrast as a fraction of the longer semi-axis, and the square of the least cosine of a bend, for which
    /// no question remains.
    fn limits(&self) -> [f64; 2];
    /// The direction of a single line, which decides every question.
    fn single(&self, at: Point, towards: Vector) -> Result<(Vector, f64), LineEnd>;
}

impl Directions for Walk<'_> {
    fn field(&self) -> &Interpolated<'_> {
        self.field
    }

    fn sign(&self) -> f64 {
        self.family.sign()
    }

    fn limits(&self) -> [f64; 2] {
        let least = self.field.axes().least_contrast(self.options.least_anisotropy);
        [least, LEAST_COSINE * LEAST_COSINE]
    }

    fn single(&self, at: Point, towards: Vector) -> Result<(Vector, f64), LineEnd> {
        self.slope(at, towards)
    }
}

/// Directions at a point of each line.
#[derive(Clone, Copy)]
pub(crate) struct Slopes {
    /// Unit vectors.
    pub(crate) along: Pairs,
    /// [`crate::Frame::contrast`].
    pub(crate) contrast: Lanes,
    /// Why there is none.
    pub(crate) ends: [Option<LineEnd>; LANES],
    /// Whether there is none for some line.
    pub(crate) is_ended: bool,
}

/// The squares between cells in which the lines are, kept from one step to the next.
pub(crate) struct Beside<'a, D> {
    pub(crate) directions: &'a D,
    within: Within,
    square: [usize; LANES],
    /// The polynomials of `E` and `F` in each square.
    polynomials: [[Lanes; 4]; 4],
    least: f64,
    least_cosine2: f64,
    sign: f64,
}

impl<'a, D: Directions> Beside<'a, D> {
    pub(crate) fn new(directions: &'a D) -> Self {
        let [least, least_cosine2] = directions.limits();
        Self {
            directions,
            within: Within::new(directions.field().field().grid()),
            square: [usize::MAX; LANES],
            polynomials: [[[0.0; LANES]; 4]; 4],
            least,
            least_cosine2,
            sign: directions.sign(),
        }
    }

    /// The directions at points, for the incoming directions `towards`.
    #[inline(always)]
    pub(crate) fn slopes<R: Rule, const SYMMETRIC: bool>(&mut self, at: &Pairs, towards: &Pairs) -> Slopes {
        let mut parts: Pairs = [[0.0; LANES]; 2];
        let mut squares = [0; LANES];
        let mut is_fine = [false; LANES];
        for l in 0..LANES {
            let Place { square, parts: [u, v], is_inside } = self.within.place(at[0][l], at[1][l]);
            (parts[0][l], parts[1][l]) = (u, v);
            squares[l] = square;
            is_fine[l] = is_inside;
        }
        if squares != self.square {
            self.enter(squares);
        }
        let mut along: Pairs = [[0.0; LANES]; 2];
        let mut contrast = [0.0; LANES];
        for l in 0..LANES {
            let of = |n: usize| {
                evaluated(core::array::from_fn(|c| self.polynomials[n][c][l]), [parts[0][l], parts[1][l]])
            };
            let numbers = [of(0), of(1), of(2), if SYMMETRIC { 0.0 } else { of(3) }];
            let found: Slope =
                slope::slope::<R, SYMMETRIC>(numbers, self.sign, [towards[0][l], towards[1][l]]);
            (along[0][l], along[1][l]) = (found.along[0], found.along[1]);
            contrast[l] = found.contrast;
            is_fine[l] &= found.is_usual()
                & (found.contrast > self.least * found.longer)
                & found.bends_at_most(self.least_cosine2);
        }
        let mut slopes = Slopes { along, contrast, ends: [None; LANES], is_ended: false };
        if is_fine != [true; LANES] {
            self.decide(is_fine, at, towards, &mut slopes);
        }
        slopes
    }

    /// Loads the corners of the squares that lines have entered.
    #[inline(never)]
    fn enter(&mut self, squares: [usize; LANES]) {
        let values = self.directions.field().field().values();
        for l in 0..LANES {
            if squares[l] == self.square[l] {
                continue;
            }
            self.square[l] = squares[l];
            let corners = self.within.corners(squares[l]).map(|i| slope::numbers(&values[i]));
            for n in 0..4 {
                for (c, number) in polynomial(corners.map(|of| of[n])).into_iter().enumerate() {
                    self.polynomials[n][c][l] = number;
                }
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn decide(&self, is_fine: [bool; LANES], at: &Pairs, towards: &Pairs, slopes: &mut Slopes) {
        for l in (0..LANES).filter(|&l| !is_fine[l]) {
            let (at, towards) = (Point::new(at[0][l], at[1][l]), Vector::new(towards[0][l], towards[1][l]));
            match self.directions.single(at, towards) {
                Ok((along, contrast)) => {
                    (slopes.along[0][l], slopes.along[1][l]) = (along.x, along.y);
                    slopes.contrast[l] = contrast;
                }
                Err(end) => {
                    (slopes.along[0][l], slopes.along[1][l]) = (towards.x, towards.y);
                    slopes.ends[l] = Some(end);
                    slopes.is_ended = true;
                }
            }
        }
    }

    /// The points at `lengths` times directions from others, as [`tigereye_core::CellShape::ahead`] has them.
    #[inline(always)]
    pub(crate) fn ahead(&self, from: &Pairs, directions: &Pairs, lengths: &Lanes) -> Pairs {
        let [across, down] = self.directions.field().cell().per_unit();
        let mut to: Pairs = [[0.0; LANES]; 2];
        for l in 0..LANES {
            to[0][l] = from[0][l] + lengths[l] * directions[0][l] * across;
            to[1][l] = from[1][l] - lengths[l] * directions[1][l] * down;
        }
        to
    }
}

/// Where lines from points in directions end, and why: [`crate::half_line_end`] for many lines.
pub(crate) fn ends_of_lines(walk: &Walk<'_>, starts: &[(Point, Vector)], level: Level) -> Vec<(Point, LineEnd)> {
    if walk.options.inertia.is_some() || walk.options.method != Method::RungeKutta4 {
        return starts.iter().map(|&(at, towards)| walk.end_of(at, towards)).collect();
    }
    walk.field.axes().with_rule(Ends { walk, starts, level })
}

struct Ends<'a> {
    walk: &'a Walk<'a>,
    starts: &'a [(Point, Vector)],
    level: Level,
}

impl WithRule for Ends<'_> {
    type Output = Vec<(Point, LineEnd)>;

    fn with<R: Rule>(self) -> Self::Output {
        let (level, walk, starts) = (self.level, self.walk, self.starts);
        let rule = core::marker::PhantomData;
        if walk.field.is_symmetric() {
            level.compiled(March::<R, true> { walk, starts, rule })
        } else {
            level.compiled(March::<R, false> { walk, starts, rule })
        }
    }
}

/// All lines of a list, [`LANES`] at a time.
struct March<'a, R, const SYMMETRIC: bool> {
    walk: &'a Walk<'a>,
    starts: &'a [(Point, Vector)],
    rule: core::marker::PhantomData<R>,
}

impl<R: Rule, const SYMMETRIC: bool> ArrayLoop for March<'_, R, SYMMETRIC> {
    type Output = Vec<(Point, LineEnd)>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let walk = self.walk;
        let mut ends: Vec<(Point, LineEnd)> =
            self.starts.iter().map(|&(at, _)| (at, LineEnd::Border)).collect();
        let mut waiting = self.starts.iter().enumerate();
        // A line, its index, and the length of the step it tries.
        let mut lines: [Option<(Progress, usize, f64)>; LANES] = [None; LANES];
        let mut beside = Beside::new(walk);
        let mut at: Pairs = [[0.0; LANES]; 2];
        let mut towards: Pairs = [[1.0; LANES], [0.0; LANES]];
        let mut lengths: Lanes = [0.0; LANES];
        loop {
            for l in 0..LANES {
                // A lane without a line tries steps of no length where its last line ended.
                lengths[l] = 0.0;
                loop {
                    if lines[l].is_none() {
                        let Some((index, &(from, direction))) = waiting.next() else { break };
                        match walk.begin(from, direction) {
                            Ok(line) => lines[l] = Some((line, index, f64::NAN)),
                            Err(end) => {
                                ends[index] = (from, end);
                                continue;
                            }
                        }
                    }
                    let Some((line, index, length)) = &mut lines[l] else { break };
                    match walk.attempt(line, *length) {
                        Ok(next) => {
                            *length = next;
                            lengths[l] = next;
                            let pose = line.pose();
                            (at[0][l], at[1][l]) = (pose.at.x, pose.at.y);
                            (towards[0][l], towards[1][l]) = (pose.towards.x, pose.towards.y);
                            break;
                        }
                        Err(end) => {
                            ends[*index] = (line.pose().at, end);
                            lines[l] = None;
                        }
                    }
                }
            }
            if lines.iter().all(Option::is_none) {
                return ends;
            }
            if let Some(full) = full_steps(walk, &lines) {
                stride::<R, SYMMETRIC>(walk, &mut beside, &mut lines, full);
                for l in 0..LANES {
                    let Some((line, ..)) = &lines[l] else { continue };
                    let pose = line.pose();
                    (at[0][l], at[1][l]) = (pose.at.x, pose.at.y);
                    (towards[0][l], towards[1][l]) = (pose.towards.x, pose.towards.y);
                }
            }
            let step = runge_kutta::<R, SYMMETRIC, _>(&mut beside, &at, &towards, &lengths);
            for l in 0..LANES {
                let Some((line, index, length)) = &mut lines[l] else { continue };
                let made = step.lane(l).filter(|s| s.least >= LEAST_LEFT * line.pose().contrast);
                match made {
                    Some(made) => {
                        walk.arrive(line, made, *length);
                        *length = f64::NAN;
                    }
                    None if walk.is_shortest(*length) => {
                        ends[*index] = (line.pose().at, step.ends[l].unwrap_or(LineEnd::Degenerate));
                        lines[l] = None;
                    }
                    None => *length = walk.shortened(line, *length),
                }
            }
        }
    }
}

/// How many steps of full length all lines can surely make, apart from the one that they try: `None` if some lane has no
/// line, or has to try a shorter step.
#[inline(always)]
fn full_steps(walk: &Walk<'_>, lines: &[Option<(Progress, usize, f64)>; LANES]) -> Option<usize> {
    let step = walk.options.step;
    let mut least = f64::INFINITY;
    for line in lines {
        let (line, _, length) = line.as_ref()?;
        if *length != step || !line.is_even(step) {
            return None;
        }
        // One less, for the rounding of sums, and one for the trial.
        least = least.min((walk.options.length - line.gone()) / step - 2.0);
    }
    (least >= 1.0).then_some(least as usize)
}

/// Makes steps of full length, at most so many, until one would be rejected: what [`March`] does for lines that need no
/// attention.
#[inline(always)]
fn stride<R: Rule, const SYMMETRIC: bool>(
    walk: &Walk<'_>,
    beside: &mut Beside<'_, Walk<'_>>,
    lines: &mut [Option<(Progress, usize, f64)>; LANES],
    most: usize,
) {
    let mut at: Pairs = [[0.0; LANES]; 2];
    let mut towards: Pairs = [[0.0; LANES]; 2];
    let mut contrast = [0.0; LANES];
    for l in 0..LANES {
        let Some((line, ..)) = &lines[l] else { return };
        let pose = line.pose();
        (at[0][l], at[1][l]) = (pose.at.x, pose.at.y);
        (towards[0][l], towards[1][l]) = (pose.towards.x, pose.towards.y);
        contrast[l] = pose.contrast;
    }
    let lengths = [walk.options.step; LANES];
    let mut made = 0;
    while made < most {
        let step = runge_kutta::<R, SYMMETRIC, _>(beside, &at, &towards, &lengths);
        let mut is_left = true;
        for l in 0..LANES {
            is_left &= step.least[l] >= LEAST_LEFT * contrast[l];
        }
        if !is_left || step.is_ended {
            break;
        }
        (at, towards, contrast) = (step.at, step.slopes.along, step.slopes.contrast);
        made += 1;
    }
    for l in 0..LANES {
        let Some((line, ..)) = &mut lines[l] else { return };
        let pose = Pose {
            at: Point::new(at[0][l], at[1][l]),
            towards: Vector::new(towards[0][l], towards[1][l]),
            contrast: contrast[l],
        };
        line.stride(pose, walk.options.step, made);
    }
}

/// A step of each line.
struct Steps {
    at: Pairs,
    slopes: Slopes,
    least: Lanes,
    ends: [Option<LineEnd>; LANES],
    is_ended: bool,
}

impl Steps {
    #[inline(always)]
    fn lane(&self, l: usize) -> Option<Step> {
        if self.ends[l].is_some() {
            return None;
        }
        let at = Point::new(self.at[0][l], self.at[1][l]);
        let towards = Vector::new(self.slopes.along[0][l], self.slopes.along[1][l]);
        let contrast = self.slopes.contrast[l];
        let pose = Pose { at, towards, contrast };
        Some(Step { pose, least: self.least[l], error: 0.0 })
    }
}

/// [`Walk::runge_kutta`] for every lane.
#[inline(always)]
fn runge_kutta<R: Rule, const SYMMETRIC: bool, D: Directions>(
    beside: &mut Beside<'_, D>,
    from: &Pairs,
    a: &Pairs,
    lengths: &Lanes,
) -> Steps {
    let half = lengths.map(|h| 0.5 * h);
    let b = beside.slopes::<R, SYMMETRIC>(&beside.ahead(from, a, &half), a);
    let c = beside.slopes::<R, SYMMETRIC>(&beside.ahead(from, &b.along, &half), &b.along);
    let d = beside.slopes::<R, SYMMETRIC>(&beside.ahead(from, &c.along, lengths), &c.along);
    let mut mean: Pairs = [[0.0; LANES]; 2];
    for i in 0..2 {
        for l in 0..LANES {
            mean[i][l] = (a[i][l] + b.along[i][l] * 2.0 + c.along[i][l] * 2.0 + d.along[i][l]) / 6.0;
        }
    }
    let at = beside.ahead(from, &mean, lengths);
    let slopes = beside.slopes::<R, SYMMETRIC>(&at, &d.along);
    let mut least = [0.0; LANES];
    for l in 0..LANES {
        least[l] = b.contrast[l].min(c.contrast[l]).min(slopes.contrast[l]);
    }
    let is_ended = b.is_ended | c.is_ended | d.is_ended | slopes.is_ended;
    let ends = if is_ended {
        core::array::from_fn(|l| b.ends[l].or(c.ends[l]).or(d.ends[l]).or(slopes.ends[l]))
    } else {
        [None; LANES]
    };
    Steps { at, slopes, least, ends, is_ended }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axes, Family, LineOptions, Major};
    use tigereye_core::{CellShape, Field, Grid, SplitMix64, Tensor2};

    /// Random tensors: degenerate points, holes, sharp bends, lines that leave the field, sizes that have to be scaled.
    fn field(seed: u64, symmetric: bool) -> Field<Tensor2> {
        let mut numbers = SplitMix64::new(seed);
        Field::from_fn(Grid::new(23, 17).expect("a size"), |c| {
            let mut random = || 2.0 * numbers.unit() - 1.0;
            let [a, b, d] = [random(), random(), random()];
            let [x, y] = [c.x as f64 / 6.0, c.y as f64 / 5.0];
            let wave = [a + 3.0 * (x - 1.5), b + y - x, d + 2.0 * y];
            let t = Tensor2::new(wave[0], wave[1], if symmetric { wave[1] } else { 0.3 * wave[2] }, wave[2]);
            match (c.x, c.y) {
                (3, 4) => Tensor2::isotropic(f64::NAN),
                (11, 9) => Tensor2::ZERO,
                (20, 3) => t.scaled(1e80),
                _ => t,
            }
        })
    }

    /// A lane computes the bits of a single line at every instruction set, for every choice of axes.
    #[test]
    fn lanes_end_where_single_lines_end() {
        let mut seen = std::collections::BTreeSet::new();
        for symmetric in [true, false] {
            let tensors = field(5, symmetric);
            for axes in [Axes::HalfAxes, Axes::Eigenvectors, Axes::DualEigenvectors] {
                for major in [Major::Value, Major::Magnitude] {
                    for (family, sides) in [(Family::Major, [1.0, 1.0]), (Family::Minor, [1.0, 1.7])] {
                        let between = Interpolated::new(&tensors)
                            .with_axes(axes.by(major))
                            .with_cell(CellShape::of(sides));
                        let options = LineOptions { step: 0.25, length: 9.0, ..LineOptions::default() };
                        let walk = Walk { field: &between, family, options: &options };
                        let starts: Vec<(Point, Vector)> = (0..333)
                            .map(|i| {
                                let at = Point::new(0.071 * f64::from(i) - 0.3, 0.15 * f64::from(i % 107));
                                (at, Vector::new(1.0, if i % 2 == 0 { 0.3 } else { -0.8 }).normalize())
                            })
                            .collect();
                        let single: Vec<_> = starts.iter().map(|&(at, d)| walk.end_of(at, d)).collect();
                        for level in Level::available() {
                            assert_eq!(ends_of_lines(&walk, &starts, level), single, "{axes:?} {level:?}");
                        }
                        seen.extend(single.iter().map(|(_, why)| format!("{why:?}")));
                    }
                }
            }
        }
        assert_eq!(seen.into_iter().collect::<Vec<_>>(), ["Border", "Degenerate", "Length"]);
    }
}
