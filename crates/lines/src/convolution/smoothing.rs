//! A texture averaged along the lines through its samples.
//!
//! Samples are finer than the cells, and lines from neighbouring samples differ little. So lines are traced from the
//! corners of each patch (the square between four cells) and from its middle, and where the middle one runs where the
//! four corners predict it, at every step, the lines of the samples within are interpolated from the corners. Elsewhere
//! (beside degenerate points, borders, holes and sharp bends) every sample has a line of its own.

use super::tracing::{Trace, Tracing};
use core::f64::consts::PI;
use rayon::prelude::*;
use tigereye_core::{Cell, Field, Point, Vector, math};
use tigereye_simd::{ArrayLoop, Level};

/// How far the line from the middle of a patch may lie from the mean of those from its corners, in samples. The lines
/// in between are off by less, and a point takes the value of the nearest sample.
const TOLERANCE: f64 = 0.1;
/// Patches along each side of a tile; lines of a tile are kept in memory while it is smoothed.
const TILE: usize = 16;
/// Lines longer than this many steps are not kept, but traced sample by sample.
const MOST_KEPT: usize = 1000;
/// Samples with lines of their own that are traced together.
const TOGETHER: usize = 64;

/// A Hann window whose length depends on the sample.
pub(super) struct Window<'a> {
    /// No window is longer, to one side.
    pub(super) longest: f64,
    /// The length at a point, in units of the smaller side of a cell.
    pub(super) at: &'a (dyn Fn(Point) -> f64 + Sync),
}

/// Weights of a Hann window at multiples of a step, from the first step on.
struct Weights {
    values: Vec<f64>,
    /// The sums of the first none, one, two, ... weights.
    sums: Vec<f64>,
    half: f64,
    step: f64,
}

impl Weights {
    fn new(half: f64, step: f64) -> Self {
        let mut weights = Self { values: Vec::new(), sums: Vec::new(), half: f64::NAN, step };
        weights.set(half);
        weights
    }

    /// Rotations by a fixed angle: one cosine instead of one for every step.
    fn set(&mut self, half: f64) {
        if half == self.half {
            return;
        }
        self.half = half;
        let steps = (half / self.step) as usize;
        self.values.clear();
        self.sums.clear();
        self.sums.push(0.0);
        let mut sum = 0.0;
        let angle = PI * self.step / half;
        let turn = [math::cos(angle), math::sin(angle)];
        let [mut c, mut s] = turn;
        for _ in 0..steps {
            let weight = 0.5 * (1.0 + c);
            sum += weight;
            self.values.push(weight);
            self.sums.push(sum);
            [c, s] = [c * turn[0] - s * turn[1], c * turn[1] + s * turn[0]];
        }
    }
}

/// The texture averaged along the lines through its samples, over the window of each sample. NaN where there is no
/// tensor; unchanged where there is no axis.
pub(super) fn smoothed(texture: &Field<f64>, tracing: &Tracing<'_>, window: &Window<'_>) -> Field<f64> {
    let grid = texture.grid();
    let level = Level::detect();
    // Samples of a tile, along x and y.
    let side = tracing.samples.map(|s| TILE * s as usize);
    let tiles = [grid.width().div_ceil(side[0]), grid.height().div_ceil(side[1])];
    let of_tile = |n: usize| {
        let corner = Cell::new(n % tiles[0] * side[0], n / tiles[0] * side[1]);
        let size = [side[0].min(grid.width() - corner.x), side[1].min(grid.height() - corner.y)];
        let mut tile = Tile { texture, tracing, window, level, corner, size, values: Vec::new() };
        tile.smooth();
        (corner, size[0], tile.values)
    };
    let found: Vec<_> = (0..tiles[0] * tiles[1]).into_par_iter().map(of_tile).collect();
    let mut smoothed = Field::from_fn(grid, |_| f64::NAN);
    for (corner, width, values) in found {
        for (y, row) in values.chunks_exact(width).enumerate() {
            let start = grid.index(Cell::new(corner.x, corner.y + y));
            smoothed.values_mut()[start..start + width].copy_from_slice(row);
        }
    }
    smoothed
}

/// A line through a point, to both sides.
struct Line {
    direction: Vector,
    sides: [Trace; 2],
}

/// Part of a texture.
struct Tile<'a> {
    texture: &'a Field<f64>,
    tracing: &'a Tracing<'a>,
    window: &'a Window<'a>,
    level: Level,
    /// Its first sample.
    corner: Cell,
    /// Samples along x and y.
    size: [usize; 2],
    values: Vec<f64>,
}

impl Tile<'_> {
    fn smooth(&mut self) {
        let steps = (self.window.longest / self.tracing.step) as usize;
        let mut weights = Weights::new(self.window.longest, self.tracing.step);
        let mut alone = Vec::new();
        self.values = vec![f64::NAN; self.size[0] * self.size[1]];
        if steps > MOST_KEPT || self.tracing.samples.iter().all(|&s| s < 2.0) {
            alone.extend((0..self.size[1]).flat_map(|y| (0..self.size[0]).map(move |x| [x, y])));
        } else {
            self.smooth_patches(steps, &mut weights, &mut alone);
        }
        for samples in alone.chunks(TOGETHER) {
            self.smooth_alone(samples, steps, &mut weights);
        }
    }

    /// Smooths the patches whose lines can be interpolated; `alone` gets the samples of the others.
    fn smooth_patches(&mut self, steps: usize, weights: &mut Weights, alone: &mut Vec<[usize; 2]>) {
        let [across, down] = self.tracing.samples.map(|s| s as usize);
        // The last column and row of samples of the whole texture begin patches of their own, without an area.
        let patches = [self.size[0].div_ceil(across), self.size[1].div_ceil(down)];
        let first = [self.corner.x / across, self.corner.y / down];
        let at = |x: f64, y: f64| Point::new(first[0] as f64 + x, first[1] as f64 + y);
        let corners = self.lines(
            (0..=patches[1]).flat_map(|y| (0..=patches[0]).map(move |x| at(x as f64, y as f64))),
            steps,
        );
        let middles = self.lines(
            (0..patches[1]).flat_map(|y| (0..patches[0]).map(move |x| at(x as f64 + 0.5, y as f64 + 0.5))),
            steps,
        );
        let mut interpolated = Interpolation::default();
        let mut indices = Vec::new();
        for y in 0..patches[1] {
            for x in 0..patches[0] {
                let corner = |dx: usize, dy: usize| corners[(y + dy) * (patches[0] + 1) + x + dx].as_ref();
                let around = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
                let is_predicted =
                    interpolated.set(around, middles[y * patches[0] + x].as_ref(), steps, self.tracing);
                let rows = y * down..((y + 1) * down).min(self.size[1]);
                let columns = x * across..((x + 1) * across).min(self.size[0]);
                for sy in rows {
                    if is_predicted {
                        interpolated.enter_row((sy - y * down) as f64 / down as f64);
                    }
                    for sx in columns.clone() {
                        let value = is_predicted.then(|| {
                            let part = (sx - x * across) as f64 / across as f64;
                            let sides =
                                interpolated.edges().map(|[left, right]| Points { left, right, part });
                            self.weighted([sx, sy], sides, weights, &mut indices)
                        });
                        match value.filter(|v| !v.is_nan()) {
                            Some(value) => self.values[sy * self.size[0] + sx] = value,
                            None => alone.push([sx, sy]),
                        }
                    }
                }
            }
        }
    }

    /// The lines through points; `None` where there is no axis.
    fn lines(&self, points: impl Iterator<Item = Point>, steps: usize) -> Vec<Option<Line>> {
        let directions: Vec<_> = points.map(|at| (at, self.tracing.direction(at))).collect();
        let starts: Vec<_> = directions
            .iter()
            .flat_map(|&(at, d)| d.into_iter().flat_map(move |d| [(at, d), (at, -d)]))
            .collect();
        let mut traces = self.tracing.traces(&starts, steps, self.level).into_iter();
        let mut line = |direction| Some(Line { direction, sides: [traces.next()?, traces.next()?] });
        directions.into_iter().map(|(_, d)| d.and_then(&mut line)).collect()
    }

    /// Smooths samples along lines of their own.
    fn smooth_alone(&mut self, samples: &[[usize; 2]], steps: usize, weights: &mut Weights) {
        let of = |[x, y]: [usize; 2]| Cell::new(self.corner.x + x, self.corner.y + y);
        let lines = self.lines(samples.iter().map(|&s| self.tracing.point(of(s))), steps);
        let mut indices = Vec::new();
        for (&[x, y], line) in samples.iter().zip(lines) {
            let at = self.tracing.point(of([x, y]));
            let value = match (self.tracing.field.at(at), line) {
                (Some(t), _) if t.is_zero() => f64::NAN,
                (None, _) => f64::NAN,
                (Some(_), None) => *self.texture.at(of([x, y])),
                (Some(_), Some(mut line)) => {
                    for side in &mut line.sides {
                        self.cut_at_hole(side, &mut indices);
                    }
                    let sides = line.sides.each_ref().map(Points::of);
                    self.weighted([x, y], sides, weights, &mut indices)
                }
            };
            self.values[y * self.size[0] + x] = value;
        }
    }

    /// A window ends at a hole of the texture.
    fn cut_at_hole(&self, side: &mut Trace, indices: &mut Vec<u32>) {
        self.level.compiled(Indices { tile: self, points: Points::of(side), most: side.x.len(), indices });
        if let Some(hole) = indices.iter().position(|&i| self.texture.values()[i as usize].is_nan()) {
            side.x.truncate(hole);
            side.y.truncate(hole);
        }
    }

    /// The mean of the texture along a line through a sample.
    fn weighted(
        &self,
        [x, y]: [usize; 2],
        sides: [Points<'_>; 2],
        weights: &mut Weights,
        indices: &mut Vec<u32>,
    ) -> f64 {
        let sample = Cell::new(self.corner.x + x, self.corner.y + y);
        weights.set((self.window.at)(self.tracing.point(sample)));
        let texture = self.texture.values();
        let (mut sum, mut total) = (texture[self.texture.grid().index(sample)], 1.0);
        for points in sides {
            let most = weights.values.len();
            self.level.compiled(Indices { tile: self, points, most, indices: &mut *indices });
            // Four sums, so that they need not wait for each other; always the same four.
            let mut sums = [0.0; 4];
            let (fours, rest) = indices.as_chunks::<4>();
            let (weights_of_fours, weights_of_rest) = weights.values[..indices.len()].as_chunks::<4>();
            for (four, w) in fours.iter().zip(weights_of_fours) {
                for n in 0..4 {
                    sums[n] += w[n] * texture[four[n] as usize];
                }
            }
            for (n, (i, w)) in rest.iter().zip(weights_of_rest).enumerate() {
                sums[n] += w * texture[*i as usize];
            }
            sum += (sums[0] + sums[1]) + (sums[2] + sums[3]);
            total += weights.sums[indices.len()];
        }
        sum / total
    }
}

/// Points between two lines, at a part of the way from the left one to the right one.
#[derive(Clone, Copy)]
struct Points<'a> {
    left: &'a Trace,
    right: &'a Trace,
    part: f64,
}

impl<'a> Points<'a> {
    /// The points of one line.
    fn of(line: &'a Trace) -> Self {
        Self { left: line, right: line, part: 0.0 }
    }
}

/// The samples nearest to the first points of a line.
struct Indices<'a> {
    tile: &'a Tile<'a>,
    points: Points<'a>,
    most: usize,
    indices: &'a mut Vec<u32>,
}

impl ArrayLoop for Indices<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let grid = self.tile.texture.grid();
        let [per_x, per_y] = self.tile.tracing.samples;
        let (right, bottom, width) =
            ((grid.width() - 1) as i32, (grid.height() - 1) as i32, grid.width() as i32);
        let Points { left: a, right: b, part } = self.points;
        let n = a.x.len().min(b.x.len()).min(self.most);
        let (ax, ay, bx, by) = (&a.x[..n], &a.y[..n], &b.x[..n], &b.y[..n]);
        let nearest = |a: f64, b: f64, samples: f64, last: i32| {
            let v = (1.0 - part) * a + part * b;
            ((v * samples + 0.5).max(0.0) as i32).min(last)
        };
        self.indices.clear();
        self.indices.resize(n, 0);
        for (k, index) in self.indices.iter_mut().enumerate() {
            let column = nearest(ax[k], bx[k], per_x, right);
            let row = nearest(ay[k], by[k], per_y, bottom);
            // Neither is negative, and a grid has fewer samples than 2^31.
            *index = (row * width + column) as u32;
        }
    }
}

/// The lines within a patch, interpolated from those at its corners: first along the left and the right edge, then in
/// between.
#[derive(Default)]
struct Interpolation {
    /// Upper left, upper right, lower left, lower right; to both sides.
    corners: [[Trace; 2]; 4],
    left: [Trace; 2],
    right: [Trace; 2],
}

impl Interpolation {
    /// Sets the lines at the corners, unless some are missing or end early, or do not predict that of the middle.
    fn set(
        &mut self,
        corners: [Option<&Line>; 4],
        middle: Option<&Line>,
        steps: usize,
        tracing: &Tracing<'_>,
    ) -> bool {
        let (Some(middle), [Some(a), Some(b), Some(c), Some(d)]) = (middle, corners) else { return false };
        let is_complete = |line: &Line| line.sides.iter().all(|s| s.x.len() == steps);
        if ![middle, a, b, c, d].into_iter().all(is_complete) {
            return false;
        }
        let limits = tracing.samples.map(|s| TOLERANCE / s);
        // The side of a line that runs in the direction of the middle one comes first.
        let sides =
            [a, b, c, d].map(|l| if l.direction.dot(middle.direction) < 0.0 { [1, 0] } else { [0, 1] });
        let lines = [a, b, c, d];
        for side in 0..2 {
            let around: [&Trace; 4] = core::array::from_fn(|n| &lines[n].sides[sides[n][side]]);
            let off = |of: fn(&Trace) -> &[f64], limit: f64| {
                let [a, b, c, d] = around.map(of);
                let mean = (0..steps).map(|k| 0.25 * ((a[k] + b[k]) + (c[k] + d[k])));
                mean.zip(of(&middle.sides[side])).all(|(mean, m)| (mean - m).abs() <= limit)
            };
            if !(off(|t| &t.x, limits[0]) && off(|t| &t.y, limits[1])) {
                return false;
            }
        }
        for n in 0..4 {
            for side in 0..2 {
                self.corners[n][side].clone_from(&lines[n].sides[sides[n][side]]);
            }
        }
        true
    }

    /// Moves to a row, at a part of the way from the upper to the lower edge.
    fn enter_row(&mut self, part: f64) {
        let Self { corners: [a, b, c, d], left, right, .. } = self;
        for side in 0..2 {
            between(&a[side], &c[side], part, &mut left[side]);
            between(&b[side], &d[side], part, &mut right[side]);
        }
    }

    /// The lines at the left and the right edge of the row, to both sides.
    fn edges(&self) -> [[&Trace; 2]; 2] {
        [0, 1].map(|side| [&self.left[side], &self.right[side]])
    }
}

fn between(a: &Trace, b: &Trace, part: f64, to: &mut Trace) {
    let lerp = |(a, b): (&f64, &f64)| (1.0 - part) * a + part * b;
    to.x.clear();
    to.x.extend(a.x.iter().zip(&b.x).map(lerp));
    to.y.clear();
    to.y.extend(a.y.iter().zip(&b.y).map(lerp));
}
