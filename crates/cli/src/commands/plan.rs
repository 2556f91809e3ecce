//! `tigereye ltg --plan`: what a sweep will take, from a short measured sample of it.

use crate::args::light::LtgArgs;
use crate::commands::status::lasting;
use crate::commands::{counted, print_json, print_text};
use crate::error::CliError;
use crate::interrupt;
use serde_json::json;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use tigereye_ltg::{
    LtgError, LtgSettings, Needs, PartialVolume, Phase, Shard, SketchObserver, SketchSums, SketchedGradient,
    SweepObserver, linear_needs, linear_sweep_part, needs, sweep_part,
};
use tigereye_transport::{LinearScattering, Scattering};

/// Cells of a sample: as few as show a row with its rim.
const CELLS: usize = 4;
/// Most samples, which lie evenly over the sweep, and the fewest, whatever they take.
const SAMPLES: usize = 24;
const FEWEST: usize = 6;
/// Further samples are taken for so long.
const TIME: Duration = Duration::from_secs(8);
/// Hours that a shard may take, as in `docs/slurm/sweep.sbatch`.
const HOURS: f64 = 12.0;
/// Most shards that are proposed.
const MOST_SHARDS: usize = 4096;
/// Bytes of a part beside its numbers and marks: header, sizes, checksum.
const HEADER_BYTES: u64 = 4096;

/// What was measured, seconds of one thread.
#[derive(Debug, Default)]
struct Rates {
    /// Once per shard, whatever its size; of all threads.
    start: f64,
    /// Per source, and per cell and set.
    source: f64,
    mark: f64,
}

/// What the whole and its shards consist of.
struct Sweep<'a> {
    rates: Rates,
    marks: usize,
    threads: usize,
    needs: &'a dyn Fn(Shard) -> Result<Needs, LtgError>,
}

impl Sweep<'_> {
    /// Sources and seconds of a shard.
    fn of(&self, shard: Shard) -> Result<(u64, f64), LtgError> {
        let sources = (self.needs)(shard)?.sources;
        let marks = shard.range(self.marks).len();
        let of_threads = self.rates.source * sources as f64 + self.rates.mark * marks as f64;
        Ok((sources, self.rates.start + of_threads / self.threads as f64))
    }

    /// Sources and seconds of one shard of `count`: one in the middle, which has a rim on both sides.
    fn shard(&self, count: usize) -> Result<(u64, f64), LtgError> {
        self.of(Shard::new(count / 2, count)?)
    }

    /// The fewest shards that take at most `seconds` each; nothing where no number does.
    fn shards_within(&self, seconds: f64) -> Result<Option<usize>, LtgError> {
        let most = MOST_SHARDS.min(self.marks.max(1));
        let fits = |count: usize| Ok::<_, LtgError>(self.shard(count)?.1 <= seconds);
        if fits(1)? {
            return Ok(Some(1));
        }
        if !fits(most)? {
            return Ok(None);
        }
        // Too few and enough.
        let (mut few, mut enough) = (1, most);
        while enough - few > 1 {
            let middle = few + (enough - few) / 2;
            if fits(middle)? { enough = middle } else { few = middle }
        }
        Ok(Some(enough))
    }
}

thread_local! {
    static BUSY: Cell<Option<(Phase, Instant)>> = const { Cell::new(None) };
}

/// Adds up what the threads do.
#[derive(Debug, Default)]
struct Meter {
    propagation: AtomicU64,
    difference: AtomicU64,
    /// Until the first source was solved.
    start: AtomicU64,
    sources: AtomicU64,
}

impl SweepObserver for Meter {
    fn busy(&self, with: Option<Phase>) {
        let now = Instant::now();
        let Some((phase, since)) = BUSY.replace(with.map(|phase| (phase, now))) else { return };
        let spent = u64::try_from(now.duration_since(since).as_nanos()).unwrap_or(u64::MAX);
        match phase {
            Phase::Propagation if with.is_none() && self.sources.load(Ordering::Relaxed) == 0 => {
                // Linear scattering: the preparation, before any source.
                self.start.fetch_add(spent, Ordering::Relaxed)
            }
            Phase::Propagation => self.propagation.fetch_add(spent, Ordering::Relaxed),
            Phase::Difference => self.difference.fetch_add(spent, Ordering::Relaxed),
        };
    }

    fn progress(&self, done: u64, _total: u64) -> ControlFlow<()> {
        self.sources.fetch_max(done, Ordering::Relaxed);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// When batches of sketches were finished.
struct Sketching;

impl SketchObserver for Sketching {
    fn pulse(&self) -> ControlFlow<()> {
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn finished(&self, _sums: &SketchSums) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Measures samples of a sweep, evenly over it: `run` computes a shard.
fn measured(
    marks: usize,
    once: bool,
    run: &dyn Fn(Shard, &Meter) -> Result<PartialVolume, LtgError>,
) -> Result<Rates, LtgError> {
    let count = (marks / CELLS).max(1);
    let samples = SAMPLES.min(count);
    let start = Instant::now();
    let [mut starts, mut propagation, mut difference] = [0.0; 3];
    let (mut taken, mut sources, mut cells) = (0, 0, 0);
    for i in 0..if once { 1 } else { samples } {
        // In steps of the golden section, so that the first few lie evenly, too.
        let place = (0.5 + i as f64 * 0.618_033_988_749_894_9).fract();
        let shard = Shard::new(((place * count as f64) as usize).min(count - 1), count)?;
        let meter = Meter::default();
        run(shard, &meter)?;
        let seconds = |spent: &AtomicU64| spent.load(Ordering::Relaxed) as f64 * 1e-9;
        starts += seconds(&meter.start);
        propagation += seconds(&meter.propagation);
        difference += seconds(&meter.difference);
        sources += meter.sources.load(Ordering::Relaxed);
        cells += shard.range(marks).len();
        taken += 1;
        if taken >= FEWEST && start.elapsed() > TIME {
            break;
        }
    }
    let taken = taken.max(1) as f64;
    // Only preparations that are of the whole shard count; a first batch of pulses is none.
    let start = if once { starts / taken } else { 0.0 };
    let propagation = if once { propagation } else { propagation + starts };
    Ok(Rates { start, source: propagation / sources.max(1) as f64, mark: difference / cells.max(1) as f64 })
}

/// What is to be planned.
pub(super) enum Method<'a> {
    Joint,
    Linear,
    Sketched(&'a SketchedGradient<'a>),
}

/// What a shard needs, by the method of the sweep.
type NeedsOf<'a> = Box<dyn Fn(Shard) -> Result<Needs, LtgError> + 'a>;

pub(super) fn plan(
    args: &LtgArgs,
    settings: &LtgSettings,
    scattering: &Scattering<'_>,
    method: &Method<'_>,
    fault: &dyn Fn(LtgError) -> CliError,
) -> Result<u8, CliError> {
    let (grid, directions) = (scattering.grid(), scattering.scheme().directions());
    let slices = settings.checked_slices(directions).map_err(fault)?;
    let threads = rayon::current_num_threads();
    let values = (grid.cells() * slices.len()) as u64;
    let hours = args.hours.unwrap_or(HOURS);
    let linear = LinearScattering::new(scattering);
    let (needs, unit): (NeedsOf<'_>, &str) = match method {
        Method::Joint => (Box::new(|shard| needs(scattering, settings, shard)), "sources"),
        Method::Linear => (Box::new(|shard| linear_needs(grid, directions, settings, shard)), "solutions"),
        Method::Sketched(gradient) => {
            let sums = gradient.sums();
            let batches = sums.done().len();
            let needs = move |shard: Shard| {
                let sources = shard.range(batches).len() as u64;
                Ok(Needs { sources, bytes: u128::from(16 * values) + 16 * sums.values().len() as u128 })
            };
            (Box::new(needs), "batches of sketches")
        }
    };
    let (marks, numbers, rates) = match method {
        Method::Sketched(gradient) => {
            let sums = gradient.sums();
            let batches = sums.done().len();
            let numbers = sums.values().len() as u64;
            // One batch, then three: the difference is without what every shard prepares.
            let time = |shards: usize| {
                let shard = Shard::new(0, shards.max(1)).map_err(fault)?;
                let start = Instant::now();
                gradient.run(shard, gradient.sums(), &Sketching).map_err(fault)?;
                Ok::<_, CliError>((shard.range(batches).len(), start.elapsed().as_secs_f64()))
            };
            let ((few, short), (many, long)) = (time(batches)?, time(batches / 3)?);
            let batch = if many > few {
                ((long - short) / (many - few) as f64).max(0.0)
            } else {
                long / many.max(1) as f64
            };
            let start = (short - batch * few as f64).max(0.0);
            let rates = Rates { start, source: batch * threads as f64, mark: 0.0 };
            (batches, numbers, rates)
        }
        _ => {
            let marks = PartialVolume::empty(grid, directions, slices, settings.omega_step).map_err(fault)?;
            let marks = marks.finished().done.len();
            let rates = match method {
                Method::Linear => measured(marks, true, &|shard, meter| {
                    linear_sweep_part(&linear, settings, shard, None, meter)
                }),
                _ => measured(marks, false, &|shard, meter| {
                    sweep_part(scattering, settings, shard, None, meter)
                }),
            };
            (marks, values, rates.map_err(fault)?)
        }
    };
    interrupt::check()?;
    let sweep = Sweep { rates, marks, threads, needs: &*needs };
    let whole = (sweep.needs)(Shard::WHOLE).map_err(fault)?;
    let (_, seconds) = sweep.of(Shard::WHOLE).map_err(fault)?;
    let part = HEADER_BYTES + 8 * numbers + marks.div_ceil(8) as u64;
    let count = match args.shard {
        Some(shard) => Some(shard.count()),
        None => sweep.shards_within(hours * 3600.0).map_err(fault)?,
    };
    let of_shard = count.map(|count| sweep.shard(count)).transpose().map_err(fault)?;
    if args.json {
        let shards = count.zip(of_shard).map(|(count, (sources, seconds))| {
            json!({
                "count": count,
                "seconds": seconds,
                "sources": sources,
                // A part and a checkpoint.
                "disk_bytes": 2 * part,
                "disk_bytes_in_all": 2 * part * count as u64,
                "overhead": sources as f64 * count as f64 / whole.sources.max(1) as f64 - 1.0,
            })
        });
        print_json(&json!({
            "unit": unit,
            "sources": whole.sources,
            "memory_bytes": u64::try_from(whole.bytes).unwrap_or(u64::MAX),
            "disk_bytes": part,
            "seconds": seconds,
            "threads": threads,
            "hours": hours,
            "shards": shards,
        }))?;
        return Ok(0);
    }
    let mut text = format!(
        "the whole: {} {unit}, about {} with {} of this machine, {} of memory, {} of disk\n",
        whole.sources,
        lasting(seconds),
        counted(threads, "thread"),
        in_bytes(whole.bytes),
        in_bytes(part.into()),
    );
    match count.zip(of_shard) {
        Some((count, (sources, seconds))) => text.push_str(&format!(
            "in {}: {sources} {unit} each, about {}, {} of disk each and {} in all with checkpoints; {:.0} % more work than the whole\n",
            counted(count, "shard"),
            lasting(seconds),
            in_bytes(u128::from(2 * part)),
            in_bytes(u128::from(2 * part) * count as u128),
            100.0 * (sources as f64 * count as f64 / whole.sources.max(1) as f64 - 1.0),
        )),
        None => text.push_str(&format!("no division into up to {MOST_SHARDS} shards keeps each under {hours} h\n")),
    }
    print_text(&text)?;
    Ok(0)
}

/// Bytes as people say them.
fn in_bytes(bytes: u128) -> String {
    let bytes = bytes as f64;
    match bytes {
        b if b < 1e6 => format!("{:.0} kB", (b / 1e3).max(1.0)),
        b if b < 1e9 => format!("{:.0} MB", b / 1e6),
        b => format!("{:.1} GB", b / 1e9),
    }
}
