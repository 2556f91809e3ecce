//! `tigereye bench`: how near the engine comes to what the machine can do.

use crate::args::light::BenchArgs;
use crate::commands::{print_json, print_text};
use crate::error::CliError;
use crate::{interrupt, system};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Instant;
use tigereye_core::{Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
use tigereye_transport::{
    Level, PulseDistribution, PulseSolver, Real, Scattering, Scheme, SharedWeights, Stopping, Traffic,
    arithmetic,
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
    let mut rows = Vec::new();
    for threads in counts {
        let measured = system::on_threads(Some(threads), || {
            Ok([measure::<f64>(args, level, threads)?, measure::<f32>(args, level, threads)?])
        })?;
        rows.extend(measured.into_iter().flatten());
    }
    if args.json {
        let rows: Vec<Value> = rows.iter().map(Row::to_json).collect();
        print_json(&json!({ "processor": system::processor(), "backend": level.name(), "rows": rows }))?;
    } else {
        print_text(&table(level, &rows))?;
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
