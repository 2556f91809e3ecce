//! `tigereye ltg`: the light transport gradient volume, or a shard of it.

use crate::args::light::LtgArgs;
use crate::checkpoint::Checkpoint;
use crate::commands::propagate::{check_outputs, stopping_of};
use crate::commands::{command_line, print_json, print_text, volume};
use crate::error::CliError;
use crate::input::insert_reading;
use crate::medium::MediumInput;
use crate::part_file::{self, Costs, Identity};
use crate::watch::Watch;
use crate::{files, interrupt, system};
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;
use tigereye_core::{Choice, Normalization};
use tigereye_ltg::{
    LtgError, LtgSettings, PartialVolume, Shard, check_fit, omega_step_of_volumes, sweep_part,
};
use tigereye_transport::{Scattering, Scheme, SharedWeights};

pub(crate) fn ltg(args: &LtgArgs) -> Result<u8, CliError> {
    check_places(args)?;
    let start = Instant::now();
    let input = MediumInput::open(&args.input, &args.scheme.reading)?;
    input.check_apart(&args.outputs)?;
    let settings = settings_of(args)?;
    let normalization = input.normalization(args.scheme.normalization)?;
    let parameters = parameters(args, &settings, &input.normalization_name(normalization));
    let identity = Identity::new(&parameters, input.blake3(), *input.geometry());
    let (computed, costs) = system::on_threads(args.resources.threads, || {
        compute(args, &settings, normalization, &input, &identity, start)
    })?;
    interrupt::check()?;
    let summary = part_file::summary(&computed, &identity, &costs);
    match (args.shard, args.outputs.as_slice()) {
        (Some(shard), [output]) => {
            files::write(output, &part_file::encoded(&command_line(), &identity, shard, &computed, &costs))?;
        }
        _ => {
            let outcome = computed.into_outcome().map_err(fault)?;
            volume::write(&args.outputs, &outcome.volume, input.surfaces(), input.title(), &identity)?;
            if args.view {
                volume::write_scripts(&args.outputs, input.geometry())?;
            }
        }
    }
    if args.json {
        print_json(&summary)?
    } else {
        print_text(&volume::sentence(&summary, &parameters["stop"]))?
    }
    Ok(0)
}

/// Refuses outputs before anything is computed.
fn check_places(args: &LtgArgs) -> Result<(), CliError> {
    let is_part = |output: &Path| files::extension(output) == "part";
    if args.view && !args.outputs.iter().any(|o| files::extension(o) == "vti") {
        return Err(CliError::input("--view", "opens a volume: expected an output .vti"));
    }
    if args.shard.is_none() {
        if let Some(output) = args.outputs.iter().find(|output| is_part(output)) {
            let problem = "a part needs --shard K/N: expected .vti, .npy, .png or .svg";
            return Err(CliError::input(&output.display().to_string(), problem));
        }
        check_outputs(&args.outputs, &volume::ENDINGS)?;
        return if args.view { volume::check_scripts(&args.outputs) } else { Ok(()) };
    }
    match args.outputs.as_slice() {
        [output] if is_part(output) => files::check_writable(output),
        outputs => {
            let problem = "with --shard the only output is a part: expected one NAME.part";
            let name = outputs.iter().find(|output| !is_part(output)).or(outputs.last());
            let name = name.map(|n| n.display().to_string()).unwrap_or_default();
            Err(CliError::input(&name, problem))
        }
    }
}

/// Computes what an earlier run has not.
fn compute(
    args: &LtgArgs,
    settings: &LtgSettings,
    normalization: Normalization,
    input: &MediumInput,
    identity: &Identity,
    start: Instant,
) -> Result<(PartialVolume, Costs), CliError> {
    let (directions, shard) = (args.scheme.directions, args.shard.unwrap_or(Shard::WHOLE));
    // Before anything large is made.
    check_fit(input.grid(), directions, input.reflecting(), settings)
        .map_err(|e| fault(of_program(args, e)))?;
    let (checkpoint, found) = match &args.checkpoint {
        Some(folder) => {
            let (checkpoint, found) = Checkpoint::open(folder, command_line(), identity.clone(), shard)?;
            (Some(checkpoint), found)
        }
        None => (None, None),
    };
    let (before, found) = found.map_or((Costs::default(), None), |f| (f.costs, Some(f.volume)));
    let threads = rayon::current_num_threads();
    let watch = Watch::new(&args.input, start, checkpoint, before, threads, settings.level.name());
    let computed = match found {
        Some(volume) if volume.missing(shard) == 0 => Ok(volume),
        found => {
            let transmission = input.transmission(directions, normalization)?;
            let scheme = Scheme::new(directions, SharedWeights::Thesis);
            let scattering = Scattering::new(&scheme, &transmission);
            sweep_part(&scattering, settings, shard, found, &watch)
        }
    };
    watch.finish();
    if let Some(fault) = watch.checkpoint().and_then(Checkpoint::fault) {
        return Err(fault);
    }
    match computed {
        Ok(volume) => Ok((volume, watch.costs())),
        Err(LtgError::Interrupted { .. }) => {
            Err(watch.checkpoint().map_or(CliError::Interrupted, Checkpoint::interrupted))
        }
        Err(e) => Err(fault(e)),
    }
}

/// Names the option behind a refusal.
fn fault(error: LtgError) -> CliError {
    match error {
        LtgError::Interrupted { .. } => CliError::Interrupted,
        LtgError::OmegaStep { .. } => CliError::input("--omega-step", error),
        LtgError::Slice { .. } | LtgError::NoSlices => CliError::input("--slices", error),
        LtgError::Memory { .. } => CliError::input("--memory", error),
        LtgError::Stopping(_) => CliError::input("--threshold", error),
        LtgError::Sketches { .. } | LtgError::NoSketches => CliError::input("--estimate", error),
        LtgError::Shard { .. } => CliError::input("--shard", error),
        LtgError::Unlike { .. }
        | LtgError::Length { .. }
        | LtgError::Value { .. }
        | LtgError::DoneTwice { .. }
        | LtgError::Sum { .. }
        | LtgError::SketchedTwice { .. }
        | LtgError::Missing { .. } => CliError::input("--checkpoint", error),
    }
}

/// What the program takes beside the sweep: code, stacks of the threads, the input, what the allocator keeps.
const PROGRAM_BYTES: u64 = 8 << 20;

/// Upper bound on all memory, bytes.
fn memory_bound(args: &LtgArgs) -> u64 {
    args.resources.memory.unwrap_or_else(system::half_of_memory)
}

/// A sweep that does not fit, told by the memory of the whole program.
fn of_program(args: &LtgArgs, error: LtgError) -> LtgError {
    match error {
        LtgError::Memory { needed, .. } => {
            LtgError::Memory { needed: needed + u128::from(PROGRAM_BYTES), bound: memory_bound(args) }
        }
        other => other,
    }
}

fn settings_of(args: &LtgArgs) -> Result<LtgSettings, CliError> {
    let mut settings = LtgSettings {
        stopping: stopping_of(&args.scheme),
        omega_step: args.omega_step.unwrap_or_else(|| omega_step_of_volumes(args.scheme.directions)),
        slices: args.slices.clone(),
        memory_bytes: memory_bound(args).saturating_sub(PROGRAM_BYTES),
        level: system::level()?,
        precision: args.precision,
    };
    settings.slices = Some(settings.checked_slices(args.scheme.directions).map_err(fault)?);
    Ok(settings)
}

/// All parameters, resolved, under the names of the options.
fn parameters(args: &LtgArgs, settings: &LtgSettings, normalization: &str) -> Value {
    let mut parameters = json!({
        "input": args.input,
        "directions": args.scheme.directions.count(),
        "threshold": settings.stopping.rule.threshold(),
        "max_iterations": settings.stopping.max_iterations,
        "stop": args.scheme.stop.word(),
        "omega_step": settings.omega_step,
        "normalization": normalization,
        "slices": settings.slices,
        "precision": settings.precision.name(),
        "threads": args.resources.threads.unwrap_or_else(rayon::current_num_threads),
        "memory": memory_bound(args),
    });
    insert_reading(&mut parameters, &args.scheme.reading);
    parameters
}
