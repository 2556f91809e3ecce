//! `tigereye ltg`: the light transport gradient volume.

use crate::args::{LtgArgs, Precision};
use crate::commands::propagate::{PNG_SCALE, check_outputs, stop_name, stopping_of};
use crate::commands::{command_line, print_json, print_text};
use crate::error::CliError;
use crate::input::Input;
use crate::{files, host, interrupt, system};
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;
use tigereye_core::{Field, LtgVolume, Normalization, TransmissionField};
use tigereye_experiments::normalization_name;
use tigereye_experiments::provenance::provenance;
use tigereye_io::{npy, vti};
use tigereye_ltg::{
    LtgError, LtgOutcome, LtgSettings, Phase, SweepObserver, check_fit, omega_step_of_volumes, sweep,
};
use tigereye_render::{HeatOptions, Scene, heat_map};
use tigereye_transport::{Level, Scattering, Scheme, SharedWeights};

pub(crate) fn ltg(args: &LtgArgs) -> Result<u8, CliError> {
    check_outputs(&args.outputs)?;
    let start = Instant::now();
    let input = Input::open(&args.input, args.scheme.array.as_deref())?;
    let normalization = input.normalization(args.scheme.normalization);
    let settings = settings_of(args);
    let watch = Watch::new(&args.input);
    let outcome = system::on_threads(args.resources.threads, || {
        let directions = args.scheme.directions;
        // Before anything large is made.
        check_fit(input.field.grid(), directions, &settings).map_err(fault)?;
        let transmission = TransmissionField::from_tensors(&input.field, directions, normalization)
            .map_err(|e| CliError::input(&input.name, e))?;
        let scheme = Scheme::new(directions, SharedWeights::Thesis);
        let scattering = Scattering::new(&scheme, &transmission);
        sweep(&scattering, &settings, &watch).map_err(fault)
    })?;
    let seconds = watch.finish();
    interrupt::check()?;
    let story = provenance(
        &command_line(),
        &parameters(args, &settings, normalization, outcome.volume.slices()),
        &input.blake3,
    );
    for output in &args.outputs {
        files::write(output, &encoded(output, args, &outcome.volume, &story)?)?;
    }
    let summary = summary(args, &settings, &outcome, seconds, start.elapsed().as_secs_f64());
    if args.json {
        print_json(&summary)?;
    } else {
        print_text(&sentence(&outcome, &summary))?;
    }
    Ok(0)
}

/// A volume in the format of the output's ending.
fn encoded(output: &Path, args: &LtgArgs, volume: &LtgVolume, story: &str) -> Result<Vec<u8>, CliError> {
    let name = output.display().to_string();
    match files::extension(output).as_str() {
        "npy" => Ok(npy::write_ltg(volume)),
        "vti" => {
            vti::write(&tigereye_io::image_from_ltg(volume, story)).map_err(|e| CliError::input(&name, e))
        }
        "png" => picture(args, volume).to_png(PNG_SCALE).map_err(|e| CliError::input(&name, e)),
        _ => picture(args, volume).to_svg().map(String::into_bytes).map_err(|e| CliError::input(&name, e)),
    }
}

/// The only slice, or the mean over the slices.
fn picture(args: &LtgArgs, volume: &LtgVolume) -> Scene {
    let (field, quantity) = match volume.slices() {
        [t] => (volume.slice(*t), format!("LTG at {} degrees / (W/rad)", volume.directions().angle_deg(*t))),
        _ => (None, "mean LTG over direction / (W/rad)".to_owned()),
    };
    let field = field.unwrap_or_else(|| volume.mean_over_directions());
    let grid = field.grid();
    // The border is 0 by definition and would stretch the scale.
    let inner = Field::from_fn(grid, |c| if grid.is_border(c) { f64::NAN } else { *field.at(c) });
    let missing = Some("border, 0 by definition".to_owned());
    heat_map(&inner, &HeatOptions { title: args.input.clone(), quantity, missing, ..HeatOptions::default() })
}

/// Names the option behind a refusal.
fn fault(error: LtgError) -> CliError {
    match error {
        LtgError::Interrupted { .. } => CliError::Interrupted,
        LtgError::OmegaStep { .. } => CliError::input("--omega-step", error),
        LtgError::Slice { .. } | LtgError::NoSlices => CliError::input("--slices", error),
        LtgError::Memory { .. } => CliError::input("--memory", error),
        LtgError::Stopping(_) => CliError::input("--threshold", error),
    }
}

fn settings_of(args: &LtgArgs) -> LtgSettings {
    LtgSettings {
        stopping: stopping_of(&args.scheme),
        omega_step: args.omega_step.unwrap_or_else(|| omega_step_of_volumes(args.scheme.directions)),
        slices: args.slices.clone(),
        memory_bytes: args.resources.memory.unwrap_or_else(system::half_of_memory),
        level: Level::detect(),
    }
}

/// All parameters, resolved, under the names of the options.
fn parameters(
    args: &LtgArgs,
    settings: &LtgSettings,
    normalization: Normalization,
    slices: &[usize],
) -> Value {
    json!({
        "input": args.input,
        "directions": args.scheme.directions.count(),
        "threshold": settings.stopping.rule.threshold(),
        "max_iterations": settings.stopping.max_iterations,
        "stop": stop_name(args.scheme.stop),
        "omega_step": settings.omega_step,
        "normalization": normalization_name(normalization),
        "slices": slices,
        "precision": precision_name(args.precision),
        "threads": threads_of(args),
        "memory": settings.memory_bytes,
    })
}

fn threads_of(args: &LtgArgs) -> usize {
    args.resources.threads.unwrap_or_else(rayon::current_num_threads)
}

const fn precision_name(precision: Precision) -> &'static str {
    match precision {
        Precision::F64 => "f64",
    }
}

fn summary(
    args: &LtgArgs,
    settings: &LtgSettings,
    outcome: &LtgOutcome,
    seconds: Seconds,
    total: f64,
) -> Value {
    let (volume, work) = (&outcome.volume, &outcome.work);
    let values = volume.values();
    json!({
        "width": volume.grid().width(),
        "height": volume.grid().height(),
        "directions": volume.directions().count(),
        "sources": work.sources,
        "iterations_total": work.iterations_total,
        "iterations_max": work.iterations_max,
        "cell_updates": work.cell_updates,
        "seconds": { "total": total, "propagation": seconds.propagation, "difference": seconds.difference },
        "peak_memory_bytes": system::peak_memory(),
        "threads": threads_of(args),
        "precision": precision_name(args.precision),
        "backend": settings.level.name(),
        "max": values.iter().fold(0.0, |m: f64, &v| m.max(v)),
        "mean": values.iter().sum::<f64>() / values.len() as f64,
    })
}

fn sentence(outcome: &LtgOutcome, summary: &Value) -> String {
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    if outcome.work.sources == 0 {
        return "the field has no inner cells: every value is 0\n".to_owned();
    }
    let limited = match outcome.limited {
        0 => String::new(),
        n => format!("; {n} sources met --max-iterations before the threshold"),
    };
    format!(
        "{} sources, {} steps at most, {:.2} s; LTG at most {:.6}, {:.6} on average{limited}\n",
        outcome.work.sources,
        outcome.work.iterations_max,
        number(&summary["seconds"]["total"]),
        number(&summary["max"]),
        number(&summary["mean"]),
    )
}

/// Time spent in each phase.
#[derive(Clone, Copy, Debug, Default)]
struct Seconds {
    propagation: f64,
    difference: f64,
}

/// The clock and the progress line of a sweep.
struct Watch {
    bar: ProgressBar,
    clock: Mutex<(Option<(Phase, Instant)>, Seconds)>,
}

impl Watch {
    fn new(name: &str) -> Self {
        // Hidden by indicatif where standard error is no terminal.
        let bar = ProgressBar::new(0);
        bar.set_style(host::sweep_style());
        bar.set_message(name.to_owned());
        Self { bar, clock: Mutex::new((None, Seconds::default())) }
    }

    fn turn(&self, next: Option<Phase>) -> Seconds {
        let Ok(mut clock) = self.clock.lock() else { return Seconds::default() };
        let now = Instant::now();
        if let Some((phase, since)) = clock.0.take() {
            let spent = now.duration_since(since).as_secs_f64();
            match phase {
                Phase::Propagation => clock.1.propagation += spent,
                Phase::Difference => clock.1.difference += spent,
            }
        }
        clock.0 = next.map(|phase| (phase, now));
        clock.1
    }

    fn finish(&self) -> Seconds {
        self.bar.finish_and_clear();
        self.turn(None)
    }
}

impl SweepObserver for Watch {
    fn phase(&self, phase: Phase) {
        self.turn(Some(phase));
    }

    fn progress(&self, done: u64, total: u64) -> ControlFlow<()> {
        self.bar.set_length(total);
        self.bar.set_position(done);
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
