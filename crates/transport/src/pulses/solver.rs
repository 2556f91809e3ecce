//! Propagates several pulses, one per lane, from the dark field until they stop.

use super::PulseDistribution;
use super::difference::distance;
use super::memory::Memory;
use super::run::{Run, whole};
use super::source::Source;
use super::stationary::Settled;
use super::stream::{MAX_FUSED, Medium, Stream};
use crate::scattering::Scattering;
use crate::stopping::{StepMeasures, Verdict};
use crate::window::Window;
use crate::{Real, Stopping, StoppingRule};
use tigereye_core::{Cell, Grid, StopReason, Work};
use tigereye_simd::Number;
use tigereye_simd::{Level, Proven, Task, Vector};

/// The end of one lane's propagation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneOutcome {
    /// The reason.
    pub stop: StopReason,
    /// Steps, and cells passed through the scheme until this lane stopped.
    pub work: Work,
}

/// Solves pulses in one field, reusing its buffers.
pub struct PulseSolver<'a, T> {
    field: &'a Scattering<'a>,
    level: Level,
    /// Streams of 4, 8 and 16 lanes, created on first use.
    narrow: Option<Stream<T, 4>>,
    middle: Option<Stream<T, 8>>,
    wide: Option<Stream<T, 16>>,
}

impl<'a, T: Real> PulseSolver<'a, T> {
    /// A solver for `field`. `level` must be one this processor has, as [`Level::detect`] gives it.
    #[must_use]
    pub const fn new(field: &'a Scattering<'a>, level: Level) -> Self {
        Self { field, level, narrow: None, middle: None, wide: None }
    }

    /// Bytes of a solver's buffers for a grid and a stopping rule, whatever the number of samples.
    #[must_use]
    pub const fn bytes(grid: Grid, stopping: &Stopping) -> u128 {
        let lanes = T::LANES + T::LANES / 2;
        let state = Stream::<T, 1>::cells(grid) * 8;
        let more = match stopping.rule {
            StoppingRule::Converged { .. } => Memory::<T, 1>::numbers(grid.cells()),
            // This step's light and that of the one before.
            StoppingRule::DistributionChange { .. } => 2 * 8 * grid.cells(),
            StoppingRule::FluxChange { .. } | StoppingRule::Steps(_) => 0,
        };
        ((state + more) * lanes * size_of::<T>()) as u128
    }

    /// Propagates pulses from `cell` in 1 to [`Real::LANES`] samples, each until `stopping` ends it; the light of
    /// `samples[i]` goes to `results[i]`. Panics if there are more samples, a sample or the cell does not exist, or a
    /// result has another size, all of which the sweep excludes.
    pub fn solve(
        &mut self,
        cell: Cell,
        samples: &[usize],
        stopping: &Stopping,
        results: &mut [PulseDistribution<T>],
    ) -> Vec<LaneOutcome> {
        assert!(samples.len() == results.len() && (1..=T::LANES).contains(&samples.len()));
        let grid = self.field.grid();
        for (result, &sample) in results.iter_mut().zip(samples) {
            assert_eq!(result.lobes().len(), grid.cells(), "a result of the field's size");
            (result.source, result.sample) = (cell, sample);
        }
        let (field, level) = (self.field, self.level);
        // Use at least half of the lanes: narrower registers would be slower than idle lanes.
        match samples.len().max(T::LANES / 2) {
            ..=4 => {
                let stream = self.narrow.get_or_insert_with(|| Stream::dark(grid));
                run(field, level, stream, cell, samples, stopping, results)
            }
            5..=8 => {
                let stream = self.middle.get_or_insert_with(|| Stream::dark(grid));
                run(field, level, stream, cell, samples, stopping, results)
            }
            _ => {
                let stream = self.wide.get_or_insert_with(|| Stream::dark(grid));
                run(field, level, stream, cell, samples, stopping, results)
            }
        }
    }
}

fn run<T: Real, const N: usize>(
    field: &Scattering<'_>,
    level: Level,
    stream: &mut Stream<T, N>,
    cell: Cell,
    samples: &[usize],
    stopping: &Stopping,
    results: &mut [PulseDistribution<T>],
) -> Vec<LaneOutcome> {
    let lanes: [usize; N] = std::array::from_fn(|l| samples[l.min(samples.len() - 1)]);
    let shape = field.transmission().shape(cell);
    let source = Source::new(field.scheme(), shape, cell, &lanes);
    let medium = Medium { cells: T::passages(field), walls: T::walls(field), source };
    let run = Run { field, level, medium, stream, stopping: *stopping, results };
    level.dispatch(run)[..samples.len()].to_vec()
}

/// The state of a run.
struct Progress<const N: usize> {
    /// The window of the light.
    window: Window,
    work: Work,
    /// Flux of the last step and of the two before, W.
    totals: [[f64; N]; 3],
    outcomes: [Option<LaneOutcome>; N],
}

impl<const N: usize> Progress<N> {
    const fn new(cell: Cell, outcomes: [Option<LaneOutcome>; N]) -> Self {
        Self {
            window: Window::of(cell),
            work: Work { steps: 0, cell_updates: 0 },
            totals: [[0.0; N]; 3],
            outcomes,
        }
    }

    /// The number n of steps to fuse next. A lane may stop at step n of them, but not before, because the light of the
    /// earlier steps is overwritten. The estimate affects only the time: if a lane stops earlier, the run is repeated.
    fn fusible(&self, stopping: &Stopping) -> usize {
        let limit = stopping.max_iterations.saturating_add(1).saturating_sub(self.work.steps);
        match stopping.rule {
            StoppingRule::Steps(n) => n - self.work.steps,
            StoppingRule::FluxChange { threshold } if self.work.steps > 2 => {
                let running = (0..N).filter(|&l| self.outcomes[l].is_none());
                running.map(|l| self.steps_above(threshold, l)).min().unwrap_or(1).min(limit)
            }
            _ => 1,
        }
    }

    /// The step at which the change of lane `l`'s flux will fall to the threshold, counted from 1, if it keeps
    /// shrinking at its last rate.
    fn steps_above(&self, threshold: f64, l: usize) -> usize {
        /// Safety factor: a change within this factor of the threshold may fall below it unexpectedly.
        const MARGIN: f64 = 1.2;
        let [now, before, earlier] = self.totals.map(|t| t[l]);
        let (mut change, previous) = ((now - before).abs(), (before - earlier).abs());
        let ratio = (change / previous).min(1.0);
        let mut steps = 1;
        while steps < MAX_FUSED {
            change *= ratio;
            // Also ends for NaN.
            if change > MARGIN * threshold {
                steps += 1;
            } else {
                break;
            }
        }
        steps
    }
}

impl<T: Real, const N: usize> Task for Run<'_, '_, T, N> {
    type Number = T;
    type Output = [LaneOutcome; N];
    const LANES: usize = N;

    #[inline(always)]
    fn work<P: Proven<T>>(self, proof: P) -> [LaneOutcome; N] {
        self.solve::<P::Vector>(proof.vector())
    }
}

impl<T: Real, const N: usize> Run<'_, '_, T, N> {
    /// Runs until every lane has stopped. The stream is dark before and after.
    #[inline(always)]
    fn solve<V: Vector<Number = T>>(mut self, proof: V::Proof) -> [LaneOutcome; N] {
        let StoppingRule::Converged { tolerance } = self.stopping.rule else {
            return self.march::<V>(proof, [None; N]);
        };
        let limit = self.stopping.max_iterations.saturating_add(1);
        let settled = self.settle::<V>(proof, tolerance, limit);
        self.stream.clear(whole(self.field.grid()));
        let outcomes = settled.map(|settled| match settled {
            Settled::Stationary(work) => Some(LaneOutcome { stop: StopReason::Converged, work }),
            Settled::Never => None,
        });
        // Light trapped away from the pulse grows without bound: the result is that after the limit of plain steps, and
        // the search does not count as work.
        self.stopping = Stopping::steps(limit.min(Stopping::REFERENCE.max_iterations + 1));
        if outcomes.contains(&None) { self.march::<V>(proof, outcomes) } else { self.finished(outcomes) }
    }

    fn finished(&self, outcomes: [Option<LaneOutcome>; N]) -> [LaneOutcome; N] {
        let never = LaneOutcome { stop: StopReason::StepLimit, work: Work { steps: 0, cell_updates: 0 } };
        outcomes.map(|o| o.unwrap_or(never))
    }

    /// Steps until every lane without an outcome has stopped. The stream is dark before and after.
    #[inline(always)]
    fn march<V: Vector<Number = T>>(
        &mut self,
        proof: V::Proof,
        outcomes: [Option<LaneOutcome>; N],
    ) -> [LaneOutcome; N] {
        let grid = self.field.grid();
        let mut changes = self.stopping.needs_distribution_change().then(|| Changes::new(self));
        // The last step up to which runs may be fused; reduced after a wrong estimate.
        let mut fusible_until = usize::MAX;
        let mut progress = Progress::new(self.medium.source.cell(), outcomes);
        loop {
            let steps = match fusible_until.saturating_sub(progress.work.steps) {
                0 => 1,
                left => progress.fusible(&self.stopping).clamp(1, left.min(MAX_FUSED)),
            };
            let (totals, windows) = self.stream.advance::<V>(proof, &self.medium, progress.window, steps);
            let passed = windows[steps - 1];
            let mut foreseen = true;
            for s in 0..steps {
                progress.work.steps += 1;
                progress.work.cell_updates += windows[s].cells();
                progress.totals = [totals[s], progress.totals[0], progress.totals[1]];
                progress.window = windows[s].grown(grid);
                let stopped = self.stop_lanes(&mut progress, changes.as_mut());
                if stopped.is_empty() {
                    continue;
                }
                foreseen = s + 1 == steps;
                if !foreseen {
                    break;
                }
                self.take(progress.window, &stopped);
            }
            if !foreseen {
                // The light of that step is overwritten: start again, with single steps from there on.
                fusible_until = progress.work.steps - 1;
                progress = Progress::new(self.medium.source.cell(), outcomes);
                self.stream.clear(passed);
            } else if progress.outcomes.iter().all(Option::is_some) {
                self.stream.clear(passed);
                let work = progress.work;
                return progress
                    .outcomes
                    .map(|o| o.unwrap_or(LaneOutcome { stop: StopReason::StepLimit, work }));
            }
        }
    }

    /// Ends the lanes that stop at this step.
    fn stop_lanes(&self, progress: &mut Progress<N>, changes: Option<&mut Changes<T>>) -> Vec<usize> {
        let measured = changes.map(|c| c.measure(self, progress.window));
        let mut stopped = Vec::new();
        for l in 0..N {
            let (distribution_change, energy) = measured.as_ref().map_or((0.0, 0.0), |m| m[self.distinct(l)]);
            let measures = StepMeasures {
                step: progress.work.steps,
                total_flux: progress.totals[0][l],
                previous_total_flux: progress.totals[1][l],
                distribution_change,
                energy,
            };
            let stop = match self.stopping.verdict(&measures) {
                _ if progress.outcomes[l].is_some() => continue,
                Verdict::Continue => continue,
                Verdict::Converged => StopReason::Converged,
                Verdict::StepLimit => StopReason::StepLimit,
            };
            progress.outcomes[l] = Some(LaneOutcome { stop, work: progress.work });
            stopped.push(l);
        }
        stopped
    }

    /// Unused lanes repeat the last requested one.
    fn distinct(&self, lane: usize) -> usize {
        lane.min(self.results.len() - 1)
    }

    /// Writes the light of `lanes` to their results.
    pub(super) fn take(&mut self, window: Window, lanes: &[usize]) {
        let width = self.field.grid().width();
        let asked: Vec<usize> = lanes.iter().copied().filter(|&l| l < self.results.len()).collect();
        let mut to: Vec<&mut [[T; 8]]> = (self.results.iter_mut().enumerate())
            .filter(|(l, _)| asked.contains(l))
            .map(|(_, result)| {
                result.keep(width, window);
                result.lobes_mut()
            })
            .collect();
        self.stream.copy_lanes(window, &asked, &mut to);
    }
}

/// The distributions of this step and of the one before, for rules that compare them.
struct Changes<T> {
    now: Vec<PulseDistribution<T>>,
    before: Vec<PulseDistribution<T>>,
}

impl<T: Real> Changes<T> {
    fn new<const N: usize>(run: &Run<'_, '_, T, N>) -> Self {
        let dark = || vec![PulseDistribution::dark(run.field.grid().cells()); run.results.len()];
        Self { now: dark(), before: dark() }
    }

    /// L1 change (W) and energy (W) of every requested lane.
    fn measure<const N: usize>(&mut self, run: &Run<'_, '_, T, N>, window: Window) -> Vec<(f64, f64)> {
        core::mem::swap(&mut self.now, &mut self.before);
        let lanes: Vec<usize> = (0..self.now.len()).collect();
        let mut to: Vec<&mut [[T; 8]]> = self.now.iter_mut().map(PulseDistribution::lobes_mut).collect();
        run.stream.copy_lanes(window, &lanes, &mut to);
        lanes.iter().map(|&l| self.measure_lane(run, l)).collect()
    }

    fn measure_lane<const N: usize>(&self, run: &Run<'_, '_, T, N>, l: usize) -> (f64, f64) {
        let (scheme, grid, cell, sample) =
            (run.field.scheme(), run.field.grid(), run.medium.source.cell(), run.results[l].sample);
        let (now, before) = (self.now[l].lobes(), self.before[l].lobes());
        let l1 = distance(run.field, run.level, whole(grid), [now, before]);
        let at_sample =
            |lobes: &[[T; 8]]| scheme.intensity(&lobes[grid.index(cell)].map(Number::widened), sample);
        // The pulse's own sample is S before and after.
        let change = l1 - (at_sample(now) - at_sample(before)).abs();
        let row_energy = |row: &[[T; 8]]| row.iter().flatten().map(|v| v.widened()).sum::<f64>();
        let lobes: f64 = now.chunks(grid.width()).map(row_energy).sum();
        let missing = scheme.directions().count() as f64 - at_sample(now);
        let h = scheme.directions().step_rad();
        (h * change, lobes + h * missing)
    }
}
