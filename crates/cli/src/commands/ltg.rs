//! `tigereye ltg`: the light transport gradient volume, or a shard of it.

use crate::args::light::LtgArgs;
use crate::args::style::OverlayName;
use crate::checkpoint::Checkpoint;
use crate::commands::drawing;
use crate::commands::overlaid::Overlaid;
use crate::commands::plan::{self, Method};
use crate::commands::propagate::check_outputs;
use crate::commands::volume::Look;
use crate::commands::{advice, command_line, print_json, print_text, volume};
use crate::error::CliError;
use crate::input::insert_reading;
use crate::medium::MediumInput;
use crate::part_file::{self, Content, Costs, Identity};
use crate::watch::Watch;
use crate::{files, interrupt, system};
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;
use tigereye_core::{Choice, ProfileRule};
use tigereye_experiments::lights::sample_of;
use tigereye_ltg::{
    LtgError, LtgSettings, Precision, Shard, SketchSettings, SketchSums, SketchedGradient, check_fit,
    check_linear_fit, linear_sweep_part, omega_step_of_volumes, sweep_part,
};
use tigereye_render::{Colours, Style};
use tigereye_transport::{LinearScattering, Scattering, ScatteringRule, StopMeasure, TransportError};
use tigereye_views::added::Added;

pub(crate) fn ltg(args: &LtgArgs) -> Result<u8, CliError> {
    check_method(args)?;
    if !args.plan {
        check_places(args)?;
    }
    let style = drawing::style(&args.style, Colours::Values)?;
    let start = Instant::now();
    let input = MediumInput::open(&args.input, &args.scheme.reading)?;
    input.check_apart(&args.outputs)?;
    input.check_apart(args.preview.as_slice())?;
    let overlaid = Overlaid::read(&args.overlay)?;
    overlaid.check(&input.placement(), input.tensors().is_some(), true, false)?;
    let look = look(&input, &style, &overlaid);
    let settings = settings_of(args)?;
    let rule = input.rule(&args.scheme.profiles)?;
    let thin = input.thin_cells(rule);
    advice::tell_thin(input.name(), thin.as_ref());
    if args.plan {
        return system::on_threads(args.resources.threads, || planned(args, &settings, rule, &input));
    }
    let parameters = parameters(args, &settings, &input, rule);
    let identity = Identity::new(&parameters, input.blake3(), *input.geometry(), thin);
    let (computed, costs) = system::on_threads(args.resources.threads, || {
        compute(args, &settings, rule, (&input, &look), &identity, start)
    })?;
    interrupt::check()?;
    let summary = computed.kept().summary(&identity, &costs);
    match (args.shard, args.outputs.as_slice()) {
        (Some(shard), [output]) => {
            let part = part_file::encoded(&command_line(), &identity, shard, computed.kept(), &costs);
            files::write(output, &part)?;
        }
        _ => {
            let gradient = computed.into_gradient().map_err(fault)?;
            volume::write(&args.outputs, &gradient, &look, &identity)?;
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

/// Refuses options that belong to another method than the one asked for.
fn check_method(args: &LtgArgs) -> Result<(), CliError> {
    let sketched = args.estimate.is_some() || args.error.is_some();
    if args.scheme.scattering == ScatteringRule::Joint {
        let asked = [(args.estimate.is_some(), "--estimate"), (args.error.is_some(), "--error")];
        if let Some((_, option)) = asked.iter().find(|(asked, _)| *asked) {
            let problem = "only linear scattering can be sketched: expected --scattering linear";
            return Err(CliError::input(option, problem));
        }
    } else if let Some(stop) = args.scheme.stop.filter(|stop| *stop != StopMeasure::Stationary) {
        let problem =
            "gradients of linear scattering are those of the stationary state: expected --stop stationary";
        return Err(CliError::input(&format!("--stop {}", stop.word()), problem));
    } else {
        let asked = [
            (args.scheme.threshold.is_some(), "--threshold"),
            (args.scheme.max_iterations.is_some(), "--max-iterations"),
        ];
        for (_, option) in asked.iter().filter(|(asked, _)| *asked) {
            eprintln!(
                "tigereye: {option} has no effect: gradients of linear scattering are solved for directly, without iterations"
            );
        }
    }
    if sketched && args.overlay.overlays.contains(&OverlayName::Kind(Added::Ridges)) {
        eprintln!(
            "tigereye: --overlay ridges: ridges of an estimate follow its errors, too; compare them with another --seed, or draw \
             those of the exact gradient"
        );
    }
    if !sketched {
        let asked = [(args.seed.is_some(), "--seed"), (args.preview.is_some(), "--preview")];
        if let Some((_, option)) = asked.iter().find(|(asked, _)| *asked) {
            return Err(CliError::input(
                option,
                "belongs to an estimate: expected --estimate N or --error P%",
            ));
        }
    } else if args.precision == Some(Precision::F64) {
        let problem = "sketches are solved in single precision, far below their own error: expected f32";
        return Err(CliError::input("--precision", problem));
    }
    Ok(())
}

/// Refuses outputs before anything is computed.
fn check_places(args: &LtgArgs) -> Result<(), CliError> {
    let is_part = |output: &Path| files::extension(output) == "part";
    if let Some(preview) = &args.preview {
        let all: Vec<_> = args.outputs.iter().filter(|o| !is_part(o)).chain([preview]).cloned().collect();
        check_outputs(&all, &volume::EXTENSIONS)?;
    }
    if args.view && !args.outputs.iter().any(|o| files::extension(o) == "vti") {
        return Err(CliError::input("--view", "opens a volume: expected an output .vti"));
    }
    if args.shard.is_none() {
        if let Some(output) = args.outputs.iter().find(|output| is_part(output)) {
            let problem = "a part needs --shard K/N: expected .vti, .npy, .png, .svg or .pdf";
            return Err(CliError::input(&output.display().to_string(), problem));
        }
        check_outputs(&args.outputs, &volume::EXTENSIONS)?;
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
    rule: ProfileRule,
    (input, look): (&MediumInput, &Look<'_>),
    identity: &Identity,
    start: Instant,
) -> Result<(Content, Costs), CliError> {
    let (directions, shard) = (args.scheme.directions, args.shard.unwrap_or(Shard::WHOLE));
    let sketched = args.estimate.is_some() || args.error.is_some();
    // Before anything large is made.
    let fits = match args.scheme.scattering {
        ScatteringRule::Joint => check_fit(input.grid(), directions, input.reflecting(), settings),
        ScatteringRule::Linear if sketched => Ok(()),
        ScatteringRule::Linear => check_linear_fit(input.grid(), directions, settings),
    };
    fits.map_err(|e| fault(of_program(args, e)))?;
    let (checkpoint, found) = match &args.checkpoint {
        Some(folder) => {
            let (checkpoint, found) = Checkpoint::open(folder, command_line(), identity.clone(), shard)?;
            (Some(checkpoint), found)
        }
        None => (None, None),
    };
    let (before, found) = found.map_or((Costs::default(), None), |f| (f.costs, Some(f.content)));
    let threads = rayon::current_num_threads();
    let preview = |sums: &SketchSums| preview(args, look, identity, sums);
    let watch = Watch::new(&args.input, start, checkpoint, before, threads, settings.level.name());
    let watch = if args.preview.is_some() { watch.with_preview(&preview) } else { watch };
    let computed = match found {
        Some(content) if content.kept().missing(shard) == 0 => Ok(content),
        found => {
            let transmission = input.transmission(directions, rule)?;
            let scheme = args.scheme.scheme();
            let scattering = Scattering::new(&scheme, &transmission);
            match (args.scheme.scattering, found) {
                (ScatteringRule::Joint, found) => {
                    let found = found.and_then(Content::exact);
                    sweep_part(&scattering, settings, shard, found, &watch).map(Content::Exact)
                }
                (ScatteringRule::Linear, found) if sketched => {
                    let linear = LinearScattering::new(&scattering);
                    sketches(args, settings, &linear, found, &watch).map(Content::Sketched)
                }
                (ScatteringRule::Linear, found) => {
                    let found = found.and_then(Content::exact);
                    let linear = LinearScattering::new(&scattering);
                    linear_sweep_part(&linear, settings, shard, found, &watch).map(Content::Exact)
                }
            }
        }
    };
    watch.finish();
    if let Some(fault) = watch.fault() {
        return Err(fault);
    }
    if let Some(fault) = watch.checkpoint().and_then(Checkpoint::fault) {
        return Err(fault);
    }
    match computed {
        Ok(volume) => Ok((volume, watch.costs())),
        Err(LtgError::Interrupted { .. }) => {
            Err(watch.checkpoint().map_or(CliError::Interrupted, Checkpoint::interrupted))
        }
        Err(e) => Err(fault(of_program(args, e))),
    }
}

/// Adds the sketches that an earlier run has not.
fn sketches(
    args: &LtgArgs,
    settings: &LtgSettings,
    field: &LinearScattering<'_>,
    found: Option<Content>,
    watch: &Watch<'_>,
) -> Result<SketchSums, LtgError> {
    let gradient = SketchedGradient::new(field, sketch_settings(args, settings))?;
    match args.error {
        Some(error) => gradient.run_to_error(error, watch),
        None => {
            let found = found.and_then(Content::sketched).unwrap_or_else(|| gradient.sums());
            gradient.run(args.shard.unwrap_or(Shard::WHOLE), found, watch)
        }
    }
}

fn sketch_settings(args: &LtgArgs, settings: &LtgSettings) -> SketchSettings {
    SketchSettings {
        // For an error, a first guess at what it takes.
        sketches: args.estimate.unwrap_or(PILOT_SKETCHES),
        seed: args.seed.unwrap_or(0),
        omega_step: settings.omega_step,
        slices: settings.slices.clone(),
        memory_bytes: settings.memory_bytes,
        level: settings.level,
    }
}

/// Says what the sweep takes.
fn planned(
    args: &LtgArgs,
    settings: &LtgSettings,
    rule: ProfileRule,
    input: &MediumInput,
) -> Result<u8, CliError> {
    let told = |e| fault(of_program(args, e));
    let directions = args.scheme.directions;
    match args.scheme.scattering {
        ScatteringRule::Joint => check_fit(input.grid(), directions, input.reflecting(), settings),
        ScatteringRule::Linear if args.estimate.is_some() => Ok(()),
        ScatteringRule::Linear => check_linear_fit(input.grid(), directions, settings),
    }
    .map_err(told)?;
    let transmission = input.transmission(directions, rule)?;
    let scheme = args.scheme.scheme();
    let scattering = Scattering::new(&scheme, &transmission);
    if args.scheme.scattering == ScatteringRule::Joint {
        return plan::plan(args, settings, &scattering, &Method::Joint, &told);
    }
    if args.estimate.is_none() {
        return plan::plan(args, settings, &scattering, &Method::Linear, &told);
    }
    let linear = LinearScattering::new(&scattering);
    let gradient = SketchedGradient::new(&linear, sketch_settings(args, settings)).map_err(told)?;
    plan::plan(args, settings, &scattering, &Method::Sketched(&gradient), &told)
}

/// Sketches that say how many a given error takes.
const PILOT_SKETCHES: u32 = 128;

/// Writes the estimate so far.
fn preview(args: &LtgArgs, look: &Look<'_>, identity: &Identity, sums: &SketchSums) -> Result<(), CliError> {
    let gradient = Content::Sketched(sums.clone()).into_gradient().map_err(fault)?;
    volume::write(args.preview.as_slice(), &gradient, look, identity)
}

/// What pictures of the gradient show beside it.
fn look<'a>(input: &'a MediumInput, style: &Style, overlaid: &'a Overlaid) -> Look<'a> {
    let (title, walls, masked) = (input.title(), input.surfaces(), input.masked());
    Look {
        title,
        walls,
        masked,
        style: style.clone(),
        unit: input.unit(),
        tensors: input.tensors(),
        overlaid,
    }
}

/// Names the option behind a refusal.
fn fault(error: LtgError) -> CliError {
    match error {
        LtgError::Interrupted { .. } => CliError::Interrupted,
        LtgError::OmegaStep { .. } => CliError::input("--omega-step", error),
        LtgError::Slice { .. } | LtgError::NoSlices => CliError::input("--slices", error),
        LtgError::Memory { .. } => CliError::input("--memory", error),
        LtgError::Stopping(TransportError::Trapped { .. }) => CliError::input("--scattering linear", error),
        LtgError::Stopping(_) => CliError::input("--threshold", error),
        // The number of --estimate is checked where it is read.
        LtgError::Sketches { .. } => CliError::input("--error", error),
        LtgError::NoSketches => CliError::input("--estimate", error),
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

/// The angular slices asked for, as sample indices.
fn slices(args: &LtgArgs) -> Result<Option<Vec<usize>>, CliError> {
    let Some(degrees) = &args.slices_deg else { return Ok(args.slices.clone()) };
    let sample = |deg: &f64| sample_of(*deg, args.scheme.directions);
    let samples = degrees.iter().map(sample).collect::<Result<Vec<_>, _>>();
    samples.map(Some).map_err(|problem| CliError::input("--slices-deg", problem))
}

fn settings_of(args: &LtgArgs) -> Result<LtgSettings, CliError> {
    let mut settings = LtgSettings {
        stopping: args.scheme.stopping(),
        omega_step: args.omega_step.unwrap_or_else(|| omega_step_of_volumes(args.scheme.directions)),
        slices: slices(args)?,
        memory_bytes: memory_bound(args).saturating_sub(PROGRAM_BYTES),
        level: system::level()?,
        precision: args.precision.unwrap_or(if args.estimate.is_some() || args.error.is_some() {
            Precision::F32
        } else {
            Precision::F64
        }),
    };
    settings.slices = Some(settings.checked_slices(args.scheme.directions).map_err(fault)?);
    Ok(settings)
}

/// All parameters, resolved, under the names of the options.
fn parameters(args: &LtgArgs, settings: &LtgSettings, input: &MediumInput, rule: ProfileRule) -> Value {
    let mut parameters = json!({
        "input": args.input,
        "directions": args.scheme.directions.count(),
        "threshold": settings.stopping.rule.threshold(),
        "max_iterations": settings.stopping.max_iterations,
        "stop": args.scheme.stop().word(),
        "scattering": args.scheme.scattering.word(),
        "omega_step": settings.omega_step,
        "slices": settings.slices,
        "precision": settings.precision.name(),
        "threads": args.resources.threads.unwrap_or_else(rayon::current_num_threads),
        "memory": memory_bound(args),
    });
    if args.estimate.is_some() || args.error.is_some() {
        parameters["estimate"] = json!(args.estimate);
        parameters["error"] = json!(args.error);
        parameters["seed"] = json!(args.seed.unwrap_or(0));
    }
    input.insert_rule(&mut parameters, rule);
    insert_reading(&mut parameters, &args.scheme.reading);
    parameters
}
