//! Lines side by side: the steps of [`Walk`] and of textures for several lines at once.
//!
//! A step waits for one square root and division after another, while the processor could compute several; lines that
//! do not depend on each other fill the gaps. The arithmetic of each lane is that of a single line, so a line ends at
//! the same bits, whichever lines run beside it and whatever the instruction set. Whatever is unusual (a border, a
//! degenerate point, a sharp bend, numbers of extreme size) is left to the single line.

use crate::interpolated::{Place, Within, evaluated, polynomial};
use crate::slope::{self, Rule, Slope, WithRule};
use crate::walk::{GROWS, LEAST_COSINE, LEAST_LEFT, Walk};
use crate::{Interpolated, LineEnd, Method};
use tigereye_core::{Point, Vector};
use tigereye_simd::{ArrayLoop, Level};

/// Lines side by side: enough for the processor to have something to do while roots and quotients are computed.
pub(crate) const LANES: usize = 16;
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
    /// The least contrast as a fraction of the longer semi-axis, and the square of the least cosine of a bend, for
    /// which no question remains.
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
}

/// Why lines end.
pub(crate) type LineEnds = [Option<LineEnd>; LANES];

/// The squares between cells in which the lines are, kept from one step to the next.
pub(crate) struct Beside<'a, D> {
    pub(crate) directions: &'a D,
    within: Within,
    square: [i32; LANES],
    /// Lines that have no direction at a point, since this was last cleared.
    pub(crate) ends: LineEnds,
    pub(crate) is_ended: bool,
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
            square: [-1; LANES],
            ends: [None; LANES],
            is_ended: false,
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
        // Masks as wide as the numbers, which need not be packed.
        let mut is_fine = [0_u64; LANES];
        let mut moved = 0;
        for l in 0..LANES {
            let Place { square, parts: [u, v], is_inside } = self.within.place(at[0][l], at[1][l]);
            (parts[0][l], parts[1][l]) = (u, v);
            squares[l] = square;
            is_fine[l] = u64::from(is_inside);
            moved |= square ^ self.square[l];
        }
        if moved != 0 {
            self.enter(&squares);
        }
        let mut along: Pairs = [[0.0; LANES]; 2];
        let mut contrast = [0.0; LANES];
        let mut are_fine = 1;
        for l in 0..LANES {
            let of = |n: usize| {
                evaluated(core::array::from_fn(|c| self.polynomials[n][c][l]), [parts[0][l], parts[1][l]])
            };
            let numbers = [of(0), of(1), of(2), if SYMMETRIC { 0.0 } else { of(3) }];
            let found: Slope =
                slope::slope::<R, SYMMETRIC>(numbers, self.sign, [towards[0][l], towards[1][l]]);
            (along[0][l], along[1][l]) = (found.along[0], found.along[1]);
            contrast[l] = found.contrast;
            is_fine[l] &= u64::from(
                found.is_usual()
                    & (found.contrast > self.least * found.longer)
                    & found.bends_at_most(self.least_cosine2),
            );
            are_fine &= is_fine[l];
        }
        let mut slopes = Slopes { along, contrast };
        if are_fine == 0 {
            self.decide(&is_fine, at, towards, &mut slopes);
        }
        slopes
    }

    /// Loads the corners of the squares that lines have entered.
    #[inline(never)]
    fn enter(&mut self, squares: &[i32; LANES]) {
        let values = self.directions.field().field().values();
        for l in 0..LANES {
            if squares[l] == self.square[l] {
                continue;
            }
            self.square[l] = squares[l];
            let [a, b, c, d] = self.within.corners(squares[l]);
            let numbers = |i: usize| slope::numbers(&values[i]);
            let (a, b, c, d) = (numbers(a), numbers(b), numbers(c), numbers(d));
            for n in 0..4 {
                let [one, along_u, along_v, along_both] = polynomial([a[n], b[n], c[n], d[n]]);
                let of = &mut self.polynomials[n];
                (of[0][l], of[1][l], of[2][l], of[3][l]) = (one, along_u, along_v, along_both);
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn decide(&mut self, is_fine: &[u64; LANES], at: &Pairs, towards: &Pairs, slopes: &mut Slopes) {
        for l in (0..LANES).filter(|&l| is_fine[l] == 0) {
            let (at, towards) = (Point::new(at[0][l], at[1][l]), Vector::new(towards[0][l], towards[1][l]));
            match self.directions.single(at, towards) {
                Ok((along, contrast)) => {
                    (slopes.along[0][l], slopes.along[1][l]) = (along.x, along.y);
                    slopes.contrast[l] = contrast;
                }
                Err(end) => {
                    (slopes.along[0][l], slopes.along[1][l]) = (towards.x, towards.y);
                    // The first reason counts.
                    self.ends[l] = self.ends[l].or(Some(end));
                    self.is_ended = true;
                }
            }
        }
    }

    /// Forgets which lines have ended.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        if self.is_ended {
            self.is_ended = false;
            self.ends = [None; LANES];
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
pub(crate) fn ends_of_lines(
    walk: &Walk<'_>,
    starts: &[(Point, Vector)],
    level: Level,
) -> Vec<(Point, LineEnd)> {
    let is_possible = matches!(walk.options.method, Method::RungeKutta4 | Method::RungeKutta43 { .. });
    if walk.options.inertia.is_some() || !is_possible {
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
        let mut beside = Beside::new(walk);
        let mut lines = Lines::new(walk);
        let per_tolerance = walk.per_tolerance();
        for l in 0..LANES {
            lines.next(l, &mut waiting, &mut ends);
        }
        while lines.are_any() {
            let step = runge_kutta::<R, SYMMETRIC, _>(
                &mut beside,
                &lines.at,
                &lines.towards,
                &lines.length,
                per_tolerance,
            );
            let mut has_direction = [1; LANES];
            if beside.is_ended {
                for l in 0..LANES {
                    has_direction[l] = u64::from(beside.ends[l].is_none());
                }
            }
            if lines.advance(&step, &has_direction) {
                for l in 0..LANES {
                    if let Some(end) = lines.end(l, beside.ends[l].filter(|_| beside.is_ended)) {
                        ends[lines.index[l]] = (Point::new(lines.at[0][l], lines.at[1][l]), end);
                        lines.next(l, &mut waiting, &mut ends);
                    }
                }
            }
        }
        ends
    }
}

/// The state of lines under integration, lane by lane what [`crate::walk::Progress`] holds of one.
struct Lines<'a> {
    walk: &'a Walk<'a>,
    at: Pairs,
    towards: Pairs,
    contrast: Lanes,
    /// Length so far.
    gone: Lanes,
    /// Length of the step that is tried.
    length: Lanes,
    tries: Lanes,
    /// Whether the step that is tried had to be shortened.
    is_shortened: [u64; LANES],
    /// Whether the last trial was accepted.
    is_accepted: [u64; LANES],
    /// Whether there is a line. A lane without one tries steps of no length where its last line ended.
    is_there: [u64; LANES],
    /// Places of the lines in the list.
    index: [usize; LANES],
}

impl<'a> Lines<'a> {
    fn new(walk: &'a Walk<'a>) -> Self {
        Self {
            walk,
            at: [[0.0; LANES]; 2],
            towards: [[1.0; LANES], [0.0; LANES]],
            contrast: [0.0; LANES],
            gone: [0.0; LANES],
            length: [0.0; LANES],
            tries: [0.0; LANES],
            is_shortened: [0; LANES],
            is_accepted: [1; LANES],
            is_there: [0; LANES],
            index: [0; LANES],
        }
    }

    fn are_any(&self) -> bool {
        self.is_there != [0; LANES]
    }

    /// Begins the next line of a list that can begin at all.
    fn next<'s>(
        &mut self,
        l: usize,
        waiting: &mut impl Iterator<Item = (usize, &'s (Point, Vector))>,
        ends: &mut [(Point, LineEnd)],
    ) {
        (self.is_there[l], self.length[l]) = (0, 0.0);
        for (index, &(from, direction)) in waiting {
            let begun = self.walk.begin(from, direction).and_then(|mut line| {
                let length = self.walk.attempt(&mut line, f64::NAN)?;
                Ok((line.pose(), length))
            });
            match begun {
                Err(end) => ends[index] = (from, end),
                Ok((pose, length)) => {
                    (self.at[0][l], self.at[1][l]) = (pose.at.x, pose.at.y);
                    (self.towards[0][l], self.towards[1][l]) = (pose.towards.x, pose.towards.y);
                    (self.contrast[l], self.gone[l], self.length[l]) = (pose.contrast, 0.0, length);
                    (self.tries[l], self.is_shortened[l], self.is_there[l]) = (1.0, 0, 1);
                    self.index[l] = index;
                    return;
                }
            }
        }
    }

    /// Takes the steps that can be accepted and chooses the lengths of the next trials, as [`Walk::advance`] does.
    /// Whether a line may have ended.
    #[inline(always)]
    fn advance(&mut self, step: &Steps, has_direction: &[u64; LANES]) -> bool {
        let options = self.walk.options;
        let (full, longest, most) = (options.step, options.length, self.walk.most_tries());
        let (shortest, enough) = (self.walk.shortest(), 1e-9 * full);
        let smaller = |a: f64, b: f64| if a < b { a } else { b };
        let length = self.length;
        // Loops over few arrays each, which the compiler turns into vectors.
        for l in 0..LANES {
            let is_left = step.least[l] >= LEAST_LEFT * self.contrast[l];
            let is_accurate = (step.error[l] <= 1.0) | (0.5 * length[l] < shortest);
            self.is_accepted[l] = has_direction[l] & self.is_there[l] & u64::from(is_left & is_accurate);
        }
        let is_accepted = self.is_accepted;
        choose(&is_accepted, &step.at[0], &mut self.at[0]);
        choose(&is_accepted, &step.at[1], &mut self.at[1]);
        choose(&is_accepted, &step.slopes.along[0], &mut self.towards[0]);
        choose(&is_accepted, &step.slopes.along[1], &mut self.towards[1]);
        choose(&is_accepted, &step.slopes.contrast, &mut self.contrast);
        let mut next = [0.0; LANES];
        for l in 0..LANES {
            next[l] = self.gone[l] + length[l];
        }
        choose(&is_accepted, &next, &mut self.gone);
        for l in 0..LANES {
            // As `Walk::next` has it: a step that was shortened is followed by one as long.
            let may_grow = (self.is_shortened[l] == 0) & (step.error[l] < GROWS);
            let grown = if may_grow { smaller(full, 2.0 * length[l]) } else { length[l] };
            next[l] = smaller(grown, longest - self.gone[l]);
            self.length[l] = 0.5 * length[l];
        }
        choose(&is_accepted, &next, &mut self.length);
        let mut may_have_ended = 0;
        for l in 0..LANES {
            self.tries[l] += 1.0;
            self.is_shortened[l] = is_accepted[l] ^ 1;
            let is_over = u64::from(longest - self.gone[l] <= enough);
            let is_stuck = u64::from(self.length[l] < shortest);
            let is_tired = u64::from(self.tries[l] > most);
            may_have_ended |= self.is_there[l]
                & (is_tired | (is_accepted[l] & is_over) | ((is_accepted[l] ^ 1) & is_stuck));
        }
        may_have_ended != 0
    }

    /// Why a line has ended, if it has; `end` tells why it had no direction.
    fn end(&self, l: usize, end: Option<LineEnd>) -> Option<LineEnd> {
        if self.is_there[l] == 0 {
            return None;
        }
        // The trial that was rejected had twice the length of the next one.
        let is_shortest = self.length[l] < self.walk.shortest();
        if self.is_accepted[l] == 0 && is_shortest {
            return Some(end.unwrap_or(LineEnd::Degenerate));
        }
        let left = self.walk.options.length - self.gone[l];
        if self.is_accepted[l] != 0 && left <= 1e-9 * self.walk.options.step {
            return Some(LineEnd::Length);
        }
        (self.tries[l] > self.walk.most_tries()).then_some(LineEnd::Degenerate)
    }
}

/// Takes the new number of each lane that is chosen.
#[inline(always)]
fn choose(is_chosen: &[u64; LANES], new: &Lanes, kept: &mut Lanes) {
    for l in 0..LANES {
        kept[l] = if is_chosen[l] != 0 { new[l] } else { kept[l] };
    }
}

/// A step of each line.
struct Steps {
    at: Pairs,
    slopes: Slopes,
    least: Lanes,
    /// [`crate::walk::Step::error`].
    error: Lanes,
}

/// [`Walk::runge_kutta`] for every lane.
#[inline(always)]
fn runge_kutta<R: Rule, const SYMMETRIC: bool, D: Directions>(
    beside: &mut Beside<'_, D>,
    from: &Pairs,
    a: &Pairs,
    lengths: &Lanes,
    per_tolerance: f64,
) -> Steps {
    beside.begin();
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
        let smaller = |a: f64, b: f64| if a < b { a } else { b };
        least[l] = smaller(smaller(b.contrast[l], c.contrast[l]), slopes.contrast[l]);
    }
    let mut error = [0.0; LANES];
    for l in 0..LANES {
        let off = [0, 1].map(|i| d.along[i][l] - slopes.along[i][l]);
        error[l] = lengths[l] * (off[0] * off[0] + off[1] * off[1]).sqrt() * per_tolerance;
    }
    Steps { at, slopes, least, error }
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
                        let method = match family {
                            Family::Major => Method::RungeKutta4,
                            Family::Minor => Method::RungeKutta43 { tolerance: 1e-4 },
                        };
                        let options =
                            LineOptions { method, step: 0.5, length: 9.0, ..LineOptions::default() };
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
