//! `tigereye bench`: how near the engine comes to what the machine can do.

use crate::args::light::BenchArgs;
use crate::commands::{print_json, print_text};
use crate::error::CliError;
use crate::{interrupt, system};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write;
use std::sync::OnceLock;
use std::time::Instant;
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
use tigereye_ltg::{Phase, Shard, SketchObserver, SketchSettings, SketchedGradient, omega_step_of_volumes};
use tigereye_transport::{
    Dissection, Lanes, Level, LinearScattering, Operator, PulseDistribution, PulseSolver, Real, Scattering,
    Scheme, Serial, SharedWeights, Stopping, Traffic, arithmetic,
};

/// Directions of the fields.
const DIRECTIONS: usize = 32;
/// Measurements of each number; the median counts.
const REPETITIONS: usize = 5;

pub(crate) fn bench(args: &BenchArgs) -> Result<u8, CliError> {
    let level = system::level()?;
    let all = system::on_threads(args.threads, || Ok(rayon::current_num_threads()))?;
    let mut counts = vec![1, all];
    counts.dedup();
    let (mut rows, mut linear_rows) = (Vec::new(), Vec::new());
    for threads in counts {
        let measured = system::on_threads(Some(threads), || {
            Ok([measure::<f64>(args, level, threads)?, measure::<f32>(args, level, threads)?])
        })?;
        rows.extend(measured.into_iter().flatten());
        let measured = system::on_threads(Some(threads), || {
            args.cells.iter().map(|&side| measure_linear(level, threads, side)).collect::<Result<Vec<_>, _>>()
        })?;
        linear_rows.extend(measured);
    }
    if args.json {
        let rows: Vec<Value> = rows.iter().map(Row::to_json).collect();
        let linear: Vec<Value> = linear_rows.iter().map(LinearRow::to_json).collect();
        let processor = system::processor();
        print_json(
            &json!({ "processor": processor, "backend": level.name(), "rows": rows, "linear": linear }),
        )?;
    } else {
        print_text(&(table(level, &rows) + &linear_table(&linear_rows)))?;
    }
    Ok(0)
}

/// Rates in updates of a cell in one lane per second, of all threads together.
struct Row {
    precision: &'static str,
    threads: usize,
    side: usize,
    engine: f64,
    arithmetic: f64,
    streaming: f64,
}

impl Row {
    fn of_arithmetic(&self) -> f64 {
        100.0 * self.engine / self.arithmetic
    }
    fn of_streaming(&self) -> f64 {
        100.0 * self.engine / self.streaming
    }
    fn to_json(&self) -> Value {
        json!({
            "precision": self.precision,
            "threads": self.threads,
            "width": self.side,
            "height": self.side,
            "updates_per_second": self.engine,
            "arithmetic_limit": self.arithmetic,
            "streaming_limit": self.streaming,
            "percent_of_arithmetic": self.of_arithmetic(),
            "percent_of_streaming": self.of_streaming(),
        })
    }
}

fn measure<T: Real>(args: &BenchArgs, level: Level, threads: usize) -> Result<Vec<Row>, CliError> {
    args.cells.iter().map(|&side| measure_side::<T>(level, threads, args.seconds, side)).collect()
}

/// The engine and its limits on one field, one after the other, so that what else the machine does meets all of them.
fn measure_side<T: Real>(level: Level, threads: usize, seconds: f64, side: usize) -> Result<Row, CliError> {
    interrupt::check()?;
    let fault = |e: tigereye_core::CoreError| CliError::input("bench", e);
    let grid = Grid::new(side, side).map_err(fault)?;
    let directions = Directions::new(DIRECTIONS).map_err(fault)?;
    // Axes that turn along both sides: no cell is like its neighbour.
    let tensors =
        Field::from_fn(grid, |c| Tensor2::from_axes(0.13 * c.x as f64 + 0.21 * c.y as f64, 4.0, 1.0));
    let transmission =
        TransmissionField::from_tensors(&tensors, directions, Normalization::Local).map_err(fault)?;
    let scheme = Scheme::new(directions, SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    // Long enough that most steps work on the whole grid.
    let stopping = Stopping::steps(4 * side);
    let samples: Vec<usize> = (0..T::LANES).map(|l| l * DIRECTIONS / T::LANES).collect();
    let solver = || {
        let results = vec![PulseDistribution::<T>::dark(grid.cells()); T::LANES];
        (PulseSolver::<T>::new(&field, level), results)
    };
    let engine = rate(seconds, solver, |(solver, results)| {
        let outcomes = solver.solve(grid.centre(), &samples, &stopping, results);
        outcomes.iter().map(|o| o.work.cell_updates).sum()
    });
    let streaming = rate(seconds, || Traffic::<T>::new(grid), |traffic| traffic.pass(level));
    let arithmetic = rate(seconds, || (), |()| arithmetic::<T>(level, 1 << 18));
    Ok(Row { precision: T::NAME, threads, side, engine, arithmetic, streaming })
}

/// What a sketched gradient of linear scattering takes, in single precision.
struct LinearRow {
    threads: usize,
    side: usize,
    /// Seconds to prepare the field.
    prepare: f64,
    /// Solutions per second, of all threads together.
    solutions: f64,
    /// Sketches per second, with random numbers, look-ups and logarithms.
    sketches: f64,
}

impl LinearRow {
    fn to_json(&self) -> Value {
        json!({
            "precision": "f32",
            "threads": self.threads,
            "width": self.side,
            "height": self.side,
            "prepare_seconds": self.prepare,
            "solutions_per_second": self.solutions,
            "sketches_per_second": self.sketches,
        })
    }
}

/// Lanes of a solution.
const LANES: usize = 64;

fn measure_linear(level: Level, threads: usize, side: usize) -> Result<LinearRow, CliError> {
    interrupt::check()?;
    let fault = |e: &dyn std::fmt::Display| CliError::input("bench", e);
    let grid = Grid::new(side, side).map_err(|e| fault(&e))?;
    let directions = Directions::new(DIRECTIONS).map_err(|e| fault(&e))?;
    let tensors =
        Field::from_fn(grid, |c| Tensor2::from_axes(0.13 * c.x as f64 + 0.21 * c.y as f64, 4.0, 1.0));
    let transmission =
        TransmissionField::from_tensors(&tensors, directions, Normalization::Local).map_err(|e| fault(&e))?;
    let scheme = Scheme::new(directions, SharedWeights::Thesis);
    let scattering = Scattering::new(&scheme, &transmission);
    let field = LinearScattering::new(&scattering);
    let start = Instant::now();
    let dissection =
        Dissection::<f32, LANES>::new(&field, Operator::Adjoint, level, &Serial).map_err(|e| fault(&e))?;
    let prepare = start.elapsed().as_secs_f64();
    let lanes = || (vec![Lanes::<f32, LANES>::zero(); 8 * grid.cells()], dissection.workspace());
    let mut states: Vec<_> = (0..threads).map(|_| lanes()).collect();
    let start = Instant::now();
    states.par_iter_mut().for_each(|(edges, workspace)| dissection.solve(edges, workspace));
    let solutions = (threads * LANES) as f64 / start.elapsed().as_secs_f64();
    drop((states, dissection));
    let settings = SketchSettings {
        sketches: (threads * LANES) as u32,
        seed: 0,
        omega_step: omega_step_of_volumes(directions),
        slices: None,
        memory_bytes: system::half_of_memory(),
        level,
    };
    let gradient = SketchedGradient::new(&field, settings).map_err(|e| fault(&e))?;
    let prepared = Prepared(OnceLock::new());
    gradient.run(Shard::WHOLE, gradient.sums(), &prepared).map_err(|e| fault(&e))?;
    let seconds = prepared.0.get().map_or(f64::NAN, |since| since.elapsed().as_secs_f64());
    Ok(LinearRow { threads, side, prepare, solutions, sketches: (threads * LANES) as f64 / seconds })
}

/// When a field was prepared: the first time that a thread has nothing to do.
struct Prepared(OnceLock<Instant>);

impl SketchObserver for Prepared {
    fn busy(&self, with: Option<Phase>) {
        if with.is_none() {
            self.0.get_or_init(Instant::now);
        }
    }
}

fn linear_table(rows: &[LinearRow]) -> String {
    let mut text = "\nLinear scattering in single precision: seconds to prepare a field on one thread; adjoint solutions \
                    and whole sketches\n(random numbers, solution, look-ups) per second, all threads together, measured \
                    once.\n\n\
                    threads  cells    prepare  solutions/s  sketches/s\n"
        .to_owned();
    for r in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:>7}  {:<7}  {:>7.3}  {:>11.0}  {:>10.0}",
            r.threads,
            format!("{0}x{0}", r.side),
            r.prepare,
            r.solutions,
            r.sketches,
        );
    }
    text
}

/// Median rate of `work`, which says how much it did, on all threads at once, each with a state of its own.
fn rate<S: Send>(seconds: f64, state: impl Fn() -> S + Sync, work: impl Fn(&mut S) -> u64 + Sync) -> f64 {
    let threads = rayon::current_num_threads();
    let mut states: Vec<S> = (0..threads).map(|_| state()).collect();
    // Memory and clock settle first.
    states.par_iter_mut().for_each(|state| {
        work(state);
    });
    let once = |state: &mut S| {
        let (start, mut done) = (Instant::now(), 0);
        while done == 0 || start.elapsed().as_secs_f64() < seconds / REPETITIONS as f64 {
            done += work(state);
        }
        done as f64 / start.elapsed().as_secs_f64()
    };
    let mut rates: Vec<f64> = (0..REPETITIONS)
        .map(|_| {
            let of_threads: Vec<f64> = states.par_iter_mut().map(once).collect();
            of_threads.iter().sum()
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    rates[REPETITIONS / 2]
}

fn table(level: Level, rows: &[Row]) -> String {
    let mut text = format!(
        "{}, {}\n\n\
         Million updates of a cell in one lane per second, all threads together, medians of {REPETITIONS}.\n\
         arithmetic: the operations of as many updates in registers, without memory.\n\
         streaming: reading and writing the state once a step, without arithmetic; fused steps move it less often.\n\n\
         precision  threads  cells      engine  arithmetic     %   streaming     %\n",
        system::processor(),
        level.name(),
    );
    for r in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<9}  {:>7}  {:<7}  {:>8.0}  {:>10.0}  {:>3.0} %  {:>10.0}  {:>3.0} %",
            r.precision,
            r.threads,
            format!("{0}x{0}", r.side),
            r.engine / 1e6,
            r.arithmetic / 1e6,
            r.of_arithmetic(),
            r.streaming / 1e6,
            r.of_streaming(),
        );
    }
    text
}
