//! The clock, the progress line and the checkpoint of a sweep.

use crate::checkpoint::Checkpoint;
use crate::error::CliError;
use crate::part_file::Costs;
use crate::{interrupt, system};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::cell::Cell;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tigereye_ltg::{PartialVolume, Phase, SketchObserver, SketchSums, SweepObserver};

thread_local! {
    /// What the thread is busy with, and since when.
    static BUSY: Cell<Option<(Phase, Instant)>> = const { Cell::new(None) };
}

/// Writes what there is of an estimate.
pub(crate) type Preview<'a> = dyn Fn(&SketchSums) -> Result<(), CliError> + Sync + 'a;

/// Watches a sweep.
pub(crate) struct Watch<'a> {
    bar: ProgressBar,
    start: Instant,
    checkpoint: Option<Checkpoint>,
    /// Costs of the runs before this one.
    before: Costs,
    threads: usize,
    backend: &'static str,
    /// Nanoseconds of all threads together.
    propagation: AtomicU64,
    difference: AtomicU64,
    preview: Option<&'a Preview<'a>>,
    previewed: Mutex<Previewed>,
}

/// What was previewed last.
#[derive(Default)]
struct Previewed {
    sketches: u32,
    fault: Option<CliError>,
}

impl<'a> Watch<'a> {
    /// `start` is when the run began; `threads` the number of threads of the pool.
    pub(crate) fn new(
        name: &str,
        start: Instant,
        checkpoint: Option<Checkpoint>,
        before: Costs,
        threads: usize,
        backend: &'static str,
    ) -> Self {
        // Hidden by indicatif where standard error is no terminal.
        let bar = ProgressBar::new(0);
        bar.set_style(style("sources"));
        bar.set_message(name.to_owned());
        let (propagation, difference) = (AtomicU64::new(0), AtomicU64::new(0));
        let previewed = Mutex::new(Previewed::default());
        let preview = None;
        Self { bar, start, checkpoint, before, threads, backend, propagation, difference, preview, previewed }
    }

    /// Writes previews of an estimate with `preview`.
    pub(crate) fn with_preview(self, preview: &'a Preview<'a>) -> Self {
        Self { preview: Some(preview), ..self }
    }

    /// What went wrong with writing a checkpoint or a preview.
    pub(crate) fn fault(&self) -> Option<CliError> {
        let preview = self.previewed.lock().unwrap_or_else(PoisonError::into_inner).fault.take();
        preview.or_else(|| self.checkpoint.as_ref().and_then(Checkpoint::fault))
    }

    /// Costs until now, those of earlier runs among them.
    pub(crate) fn costs(&self) -> Costs {
        let seconds = |spent: &AtomicU64| spent.load(Ordering::Relaxed) as f64 * 1e-9 / self.threads as f64;
        Costs {
            total: self.before.total + self.start.elapsed().as_secs_f64(),
            propagation: self.before.propagation + seconds(&self.propagation),
            difference: self.before.difference + seconds(&self.difference),
            peak_memory: system::peak_memory().max(self.before.peak_memory),
            threads: self.threads,
            backend: self.backend.to_owned(),
        }
    }

    pub(crate) const fn checkpoint(&self) -> Option<&Checkpoint> {
        self.checkpoint.as_ref()
    }

    /// Removes the progress line.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// A line with rate and time left.
fn style(unit: &'static str) -> ProgressStyle {
    let rate = move |state: &ProgressState, out: &mut dyn Write| {
        // A line that cannot be formatted is no loss.
        let _ = write!(out, "{:.0} {unit}/s", state.per_sec());
    };
    ProgressStyle::with_template("{msg} [{bar:30}] {percent:>3} % {rate}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", rate)
        .progress_chars("=> ")
}

impl SweepObserver for Watch<'_> {
    fn busy(&self, with: Option<Phase>) {
        let now = Instant::now();
        if let Some((phase, since)) = BUSY.replace(with.map(|phase| (phase, now))) {
            let spent = match phase {
                Phase::Propagation => &self.propagation,
                Phase::Difference => &self.difference,
            };
            let nanoseconds = u64::try_from(now.duration_since(since).as_nanos()).unwrap_or(u64::MAX);
            spent.fetch_add(nanoseconds, Ordering::Relaxed);
        }
    }

    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        if self.bar.length() != Some(total) {
            // Nothing is known yet of the rate: an earlier run may have done much of it.
            self.bar.set_length(total);
            self.bar.set_position(done);
            self.bar.reset_eta();
        }
        self.bar.set_position(done);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn finished(&self, volume: &PartialVolume) -> ControlFlow<()> {
        let Some(checkpoint) = &self.checkpoint else { return ControlFlow::Continue(()) };
        checkpoint.offer(volume, || self.costs())
    }
}

impl SketchObserver for Watch<'_> {
    fn busy(&self, with: Option<Phase>) {
        SweepObserver::busy(self, with);
    }

    fn pulse(&self) -> ControlFlow<()> {
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn finished(&self, sums: &SketchSums) -> ControlFlow<()> {
        let (done, total) = (sums.sketches(), sums.shape().sketches);
        if self.bar.length() != Some(total.into()) {
            self.bar.set_style(style("sketches"));
            self.bar.set_length(total.into());
            self.bar.reset_eta();
        }
        self.bar.set_position(done.into());
        if let Some(preview) = self.preview {
            let mut previewed = self.previewed.lock().unwrap_or_else(PoisonError::into_inner);
            // Four times as many sketches halve the error.
            if done >= 4 * previewed.sketches {
                previewed.sketches = done;
                previewed.fault = preview(sums).err();
                if previewed.fault.is_some() {
                    return ControlFlow::Break(());
                }
            }
        }
        match &self.checkpoint {
            Some(checkpoint) => checkpoint.offer(sums, || self.costs()),
            None => ControlFlow::Continue(()),
        }
    }
}
