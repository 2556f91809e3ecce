//! Instructions one update of a cell takes, counted by callgrind: numbers that neither load nor clock changes. Ends
//! with 1 where they are not the recorded ones.
//!
//! Valgrind hides AVX-512, so the count is that of the AVX2 path. Without Valgrind, or where the processor has no AVX2,
//! it says that it was skipped.

use std::process::{Command, ExitCode};
use tigereye_core::{Cell, Directions, Field, Grid, Normalization, Tensor2, TransmissionField};
use tigereye_transport::{
    Level, PulseDistribution, PulseSolver, Real, Scattering, Scheme, SharedWeights, Stopping, l1_difference,
};

/// Side of the field, cells.
const SIDE: usize = 29;
/// What may differ (1): start-up does not cancel exactly.
const TOLERANCE: f64 = 0.02;

/// What is counted.
struct Count {
    name: &'static str,
    /// Does the work so many times; returns how many updates (cells in lanes) that was.
    work: fn(usize) -> u64,
    /// Instructions per update with the pinned compiler.
    recorded: f64,
}

const COUNTS: [Count; 4] = [
    Count { name: "step, f64", work: steps::<f64>, recorded: 32.7 },
    Count { name: "step, f32", work: steps::<f32>, recorded: 17.1 },
    Count { name: "difference, f64", work: differences::<f64>, recorded: 65.4 },
    Count { name: "difference, f32", work: differences::<f32>, recorded: 43.6 },
];

fn solve<T: Real>(steps: usize, then: impl Fn(&Scattering<'_>, &[PulseDistribution<T>])) -> u64 {
    let grid = Grid::new(SIDE, SIDE).expect("a grid");
    let tensors =
        Field::from_fn(grid, |c| Tensor2::from_axes(0.13 * c.x as f64 + 0.21 * c.y as f64, 4.0, 1.0));
    let directions = Directions::new(32).expect("directions");
    let transmission =
        TransmissionField::from_tensors(&tensors, directions, Normalization::Local).expect("a field");
    let scheme = Scheme::new(directions, SharedWeights::Thesis);
    let field = Scattering::new(&scheme, &transmission);
    let mut solver = PulseSolver::<T>::new(&field, Level::detect());
    let samples: Vec<usize> = (0..T::LANES).collect();
    let mut results = vec![PulseDistribution::dark(grid.cells()); T::LANES];
    let outcomes = solver.solve(grid.centre(), &samples, &Stopping::steps(steps), &mut results);
    assert_eq!(results[0].source(), Cell::new(SIDE / 2, SIDE / 2));
    then(&field, &results);
    outcomes.iter().map(|o| o.work.cell_updates).sum()
}

fn steps<T: Real>(times: usize) -> u64 {
    solve::<T>(SIDE * times, |_, _| ())
}

fn differences<T: Real>(times: usize) -> u64 {
    solve::<T>(SIDE, |field, pulses| {
        for _ in 0..100 * times {
            std::hint::black_box(l1_difference(field, Level::detect(), &pulses[0], &pulses[1]));
        }
    });
    (100 * times * SIDE * SIDE) as u64
}

/// Instructions of this program's copy that does the work so many times; `None` without Valgrind.
fn counted(index: usize, times: usize) -> Option<f64> {
    let program = std::env::current_exe().expect("this program");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["--count", &index.to_string(), &times.to_string()])
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    text.lines().find_map(|l| l.split_once("Collected :"))?.1.trim().parse().ok()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, flag, index, times] = arguments.as_slice()
        && flag == "--count"
    {
        let number = |text: &str| -> usize { text.parse().expect("a number") };
        (COUNTS[number(index)].work)(number(times));
        return ExitCode::SUCCESS;
    }
    if !Level::available().iter().any(|l| l.name() == "avx2") {
        println!("skipped: this processor has no AVX2");
        return ExitCode::SUCCESS;
    }
    let mut code = ExitCode::SUCCESS;
    for (index, count) in COUNTS.iter().enumerate() {
        let (Some(few), Some(many)) = (counted(index, 1), counted(index, 4)) else {
            println!("skipped: Valgrind is not installed");
            return ExitCode::SUCCESS;
        };
        let per_update = (many - few) / ((count.work)(4) - (count.work)(1)) as f64;
        println!("{}: {per_update:.2} instructions per update, recorded {}", count.name, count.recorded);
        let met = (per_update / count.recorded - 1.0).abs() < TOLERANCE;
        if !met {
            code = ExitCode::FAILURE;
        }
    }
    code
}
