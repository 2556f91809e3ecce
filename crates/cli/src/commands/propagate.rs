//! `tigereye propagate`: one light distribution.

use crate::args::light::{Picture, PropagateArgs};
use crate::commands::light_options::{cell_and_profile, parameters};
use crate::commands::{PNG_SCALE, advice, command_line, counted, importance, print_json, print_text};
use crate::error::CliError;
use crate::medium::MediumInput;
use crate::{files, interrupt, system};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use serde_json::json;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tigereye_core::{Cell, CellShape, Field, LightDistribution, StopReason, Surface};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{Rows, npy, pvd, vti};
use tigereye_render::{Overlay, PolarOptions, Scene, TransmissionScale, polar_overlay};
use tigereye_transport::{
    EightLobe, Emission, Engine, Light, Outcome, Problem, ScatteringRule, Stopping, StoppingRule,
    stationary_light,
};
use tigereye_views::total_anisotropy::ThinCells;
use tigereye_views::{Reel, light};

pub(crate) fn propagate(args: &PropagateArgs) -> Result<u8, CliError> {
    check_outputs(&args.outputs, &["vti", "npy", "png", "svg", "pvd", "apng"])?;
    args.outputs.iter().filter(|o| is_collection(o)).try_for_each(|o| check_frames(o, args))?;
    let start = Instant::now();
    let input = MediumInput::open(&args.input, &args.scheme.reading)?;
    input.check_apart(&args.outputs)?;
    for folder in args.outputs.iter().filter(|o| is_collection(o)).map(|o| folder_of_frames(o)) {
        let inside = |file: &&String| files::place_of(Path::new(file)).starts_with(files::place_of(&folder));
        if let Some(file) = input.files().iter().find(inside) {
            let problem =
                format!("is in the folder {} of the frames: expected another place", folder.display());
            return Err(CliError::input(file, problem));
        }
    }
    if let Some(receiver) = &args.towards {
        return importance::importance(args, &input, receiver, start);
    }
    let rule = input.rule(&args.scheme.profiles)?;
    let thin = input.thin_cells(rule);
    advice::tell_thin(input.name(), thin.as_ref());
    let lights = lights(args, &input)?;
    let transmission = input.transmission(args.scheme.directions, rule)?;
    let scheme = args.scheme.scheme();
    let stopping = args.steps.map_or_else(|| args.scheme.stopping(), Stopping::steps);
    let problem = Problem { scheme: &scheme, transmission: &transmission, lights: &lights, stopping };
    let parameters = parameters(args, &stopping, &input, rule);
    let rows = Rows::of_results(input.geometry());
    let story = provenance(&command_line(), &with_rows(parameters, rows), input.blake3());
    problem.check().map_err(|e| CliError::input("--light", e))?;
    let collections = args.outputs.iter().filter(|o| is_collection(o));
    let mut collections =
        collections.map(|o| Frames::new(o, input.geometry(), &story)).collect::<Result<Vec<_>, _>>()?;
    let mut reel = args.outputs.iter().any(|o| is_animation(o)).then(|| Reel::new(input.grid().cells(), 1));
    for frames in &mut collections {
        frames.add(&problem.before_first_step())?;
    }
    if let Some(reel) = &mut reel {
        reel.add(|| problem.before_first_step().energy());
    }
    let mut fault = None;
    let line = progress_line(&args.input, &stopping);
    // A stationary state of linear scattering is solved for, unless its steps are to be seen.
    let has_flashes = lights.iter().any(|light| matches!(light.emission, Emission::Impulse(_)));
    let is_solved = scheme.scattering() == ScatteringRule::Linear
        && matches!(stopping.rule, StoppingRule::Converged { .. })
        && !(has_flashes || reel.is_some() || !collections.is_empty());
    let outcome = if is_solved {
        stationary_light(&problem, stopping.rule.threshold(), &mut |sweeps, _| {
            line.set_position(sweeps as u64);
            if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    } else {
        EightLobe.propagate_observed(&problem, &mut |view| {
            line.set_position(view.step() as u64);
            if !collections.is_empty() {
                let light = view.distribution();
                fault = collections.iter_mut().find_map(|frames| frames.add(&light).err());
            }
            if let Some(reel) = &mut reel {
                reel.add(|| view.energies());
            }
            let end = interrupt::asked() || fault.is_some();
            if end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    };
    line.finish_and_clear();
    interrupt::check()?;
    let outcome = outcome.map_err(|e| CliError::input("--light", e))?;
    fault.map_or(Ok(()), Err)?;
    let drawn = Drawn {
        problem: &problem,
        outcome: &outcome,
        geometry: input.geometry(),
        title: input.title(),
        walls: input.surfaces(),
        thin: thin.as_ref(),
        reel: reel.as_ref(),
    };
    for output in args.outputs.iter().filter(|o| !is_collection(o)) {
        files::write(output, &encoded(output, args, &drawn, &story)?)?;
    }
    collections.into_iter().try_for_each(Frames::finish)?;
    let lit = advice::Lit {
        input: &input,
        rule,
        transmission: &transmission,
        thin: thin.as_ref(),
        lights: &lights,
        stopping: &stopping,
        light: &outcome.distribution,
        steps: (!is_solved).then_some(outcome.work.steps),
    };
    lit.tell();
    let unit = if is_solved { "sweep" } else { "step" };
    report(args, &input, lights.len(), (&outcome, unit), start.elapsed().as_secs_f64())?;
    Ok(0)
}

/// The steps taken and their rate; how many are left where their number is known. Hidden by indicatif where standard
/// error is no terminal.
fn progress_line(name: &str, stopping: &Stopping) -> ProgressBar {
    let (line, template) = match stopping.rule {
        StoppingRule::Steps(steps) => {
            (ProgressBar::new(steps as u64), "{msg} [{bar:30}] step {pos} of {len}, {rate}, {eta} left")
        }
        _ => (ProgressBar::no_length(), "{msg} step {pos}, {rate}, {elapsed}"),
    };
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        // A line that cannot be formatted is no loss.
        let _ = write!(out, "{:.0} steps/s", state.per_sec());
    };
    line.set_style(style.with_key("rate", rate).progress_chars("=> "));
    line.set_message(name.to_owned());
    line
}

/// Refuses outputs before anything is computed.
pub(super) fn check_outputs(outputs: &[PathBuf], extensions: &[&str]) -> Result<(), CliError> {
    let mut seen = Vec::new();
    for output in outputs {
        check_output(output, extensions)?;
        let place = files::place_of(output);
        if seen.contains(&place) {
            return Err(CliError::input(&output.display().to_string(), "this output is named twice"));
        }
        seen.push(place);
    }
    Ok(())
}

fn check_output(output: &Path, extensions: &[&str]) -> Result<(), CliError> {
    if extensions.contains(&files::extension(output).as_str()) {
        return files::check_writable(output);
    }
    let mut expected = extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>();
    let last = expected.pop().unwrap_or_default();
    let problem = format!("unknown extension: expected {} or {last}", expected.join(", "));
    Err(CliError::input(&output.display().to_string(), problem))
}

fn is_animation(output: &Path) -> bool {
    files::extension(output) == "apng"
}

fn is_collection(output: &Path) -> bool {
    files::extension(output) == "pvd"
}

/// Most steps that are kept as frames.
const MAX_FRAMES: usize = 10_000;

/// `NAME` beside `NAME.pvd`.
fn folder_of_frames(output: &Path) -> PathBuf {
    output.with_extension("")
}

/// Whether the frames of a collection can be written, before anything is computed.
fn check_frames(output: &Path, args: &PropagateArgs) -> Result<(), CliError> {
    let fault = |problem: String| CliError::input(&output.display().to_string(), problem);
    let folder = folder_of_frames(output);
    if folder.exists() && !folder.is_dir() {
        let problem = format!("its frames go to the folder {}, which is a file", folder.display());
        return Err(fault(problem + ": expected another name"));
    }
    let place = files::place_of(&folder);
    if let Some(other) = args.outputs.iter().find(|o| files::place_of(o).starts_with(&place)) {
        let problem = format!("{} is in the folder of its frames: expected another place", other.display());
        return Err(fault(problem));
    }
    if args.steps.is_some_and(|steps| steps >= MAX_FRAMES) {
        return Err(fault(format!("more than {MAX_FRAMES} frames: expected fewer --steps for a .pvd")));
    }
    Ok(())
}

/// The light after every step, the first before any step: `NAME.pvd` and its frames, images of energy and net flux, in
/// the folder `NAME` beside it.
struct Frames<'a> {
    output: &'a Path,
    geometry: &'a PlaneGeometry,
    /// What made them.
    story: &'a str,
    files: files::Staging,
}

impl<'a> Frames<'a> {
    fn new(output: &'a Path, geometry: &'a PlaneGeometry, story: &'a str) -> Result<Self, CliError> {
        Ok(Self { output, geometry, story, files: files::Staging::new(&folder_of_frames(output))? })
    }

    fn add(&mut self, light: &LightDistribution) -> Result<(), CliError> {
        let step = self.files.len();
        if step >= MAX_FRAMES {
            let problem = format!("more than {MAX_FRAMES} steps: expected fewer for a .pvd (--steps)");
            return Err(CliError::input("-o", problem));
        }
        let mut image = tigereye_io::image_of_energy(light, self.geometry);
        image.push_text(tigereye_io::PROVENANCE, self.story);
        let bytes = vti::write(&image).map_err(|e| CliError::input("a frame", e))?;
        self.files.add(&frame_file(step), &bytes)
    }

    /// Lets everything appear. Until here an older collection is whole; then it goes first and the new one comes last,
    /// so that none names frames of two runs, and older frames behind the last new one go too.
    fn finish(mut self) -> Result<(), CliError> {
        let (folder, steps) = (folder_of_frames(self.output), self.files.len());
        let name = folder.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let list: Vec<(f64, String)> =
            (0..steps).map(|step| (step as f64, format!("{name}/{}", frame_file(step)))).collect();
        let fault = |e| CliError::input(&self.output.display().to_string(), e);
        let bytes = pvd::write(&list).map_err(fault)?;
        self.files.add_at(self.output.to_path_buf(), &bytes)?;
        files::remove(self.output)?;
        self.files.finish()?;
        let older =
            (steps..MAX_FRAMES).map(|step| folder.join(frame_file(step))).take_while(|path| path.is_file());
        older.into_iter().try_for_each(|path| files::remove(&path))
    }
}

fn frame_file(step: usize) -> String {
    format!("{step:04}.vti")
}

/// The lights asked for, or a scene's own.
fn lights(args: &PropagateArgs, input: &MediumInput) -> Result<Vec<Light>, CliError> {
    let asked = args.lights.iter().map(|l| light(l, args)).collect::<Result<Vec<_>, _>>()?;
    if !asked.is_empty() {
        input.check_lights(&asked)?;
        return Ok(asked);
    }
    let mut own = input.own_lights(args.scheme.directions)?;
    if own.is_empty() {
        let problem = "no light given: use --light X,Y or --light X,Y,PROFILE";
        return Err(CliError::input(input.name(), problem));
    }
    if args.impulse {
        for light in &mut own {
            light.emission = Emission::Impulse(light.initial_profile(args.scheme.directions));
        }
    }
    Ok(own)
}

/// A light of an option.
fn light(text: &str, args: &PropagateArgs) -> Result<Light, CliError> {
    let (cell, profile) = cell_and_profile("--light", text, args.scheme.directions)?;
    Ok(if args.impulse { Light::impulse(cell, profile) } else { Light::continuous(cell, profile) })
}

fn encoded(output: &Path, args: &PropagateArgs, drawn: &Drawn<'_>, story: &str) -> Result<Vec<u8>, CliError> {
    let name = output.display().to_string();
    let light = &drawn.outcome.distribution;
    match files::extension(output).as_str() {
        "npy" => Ok(npy::write_light(light)),
        "vti" => {
            let image = tigereye_io::image_from_light(light, drawn.geometry, story);
            vti::write(&image).map_err(|e| CliError::input(&name, e))
        }
        "apng" => {
            let reel = drawn.reel.ok_or_else(|| CliError::input(&name, "no step was kept"))?;
            let made = reel.encoded(&drawn.energy().into_options(), light::DECADES, 1);
            made.map(|(bytes, _)| bytes).map_err(|e| CliError::input(&name, e))
        }
        "png" => drawn.picture(args).to_png(PNG_SCALE).map_err(|e| CliError::input(&name, e)),
        _ => drawn.picture(args).to_svg().map(String::into_bytes).map_err(|e| CliError::input(&name, e)),
    }
}

/// What pictures show.
struct Drawn<'a> {
    problem: &'a Problem<'a>,
    outcome: &'a Outcome,
    geometry: &'a PlaneGeometry,
    title: &'a str,
    walls: Option<&'a Field<Option<Surface>>>,
    thin: Option<&'a ThinCells>,
    /// The steps, where an animation is asked for.
    reel: Option<&'a Reel>,
}

impl Drawn<'_> {
    fn sources(&self) -> Vec<Cell> {
        self.problem.lights.iter().map(|l| l.cell).collect()
    }

    fn overlays(&self) -> Vec<Overlay> {
        self.thin.map(ThinCells::overlay).into_iter().collect()
    }

    fn energy(&self) -> light::Request {
        light::Request {
            title: self.title.to_owned(),
            decades: Some(light::DECADES),
            sources: self.sources(),
            walls: self.walls.cloned(),
            overlays: self.overlays(),
            cell: CellShape::of(self.geometry.spacing()),
            ..light::Request::default()
        }
    }

    fn picture(&self, args: &PropagateArgs) -> Scene {
        match args.picture {
            Picture::Overlay => {
                let options = PolarOptions {
                    title: self.title.to_owned(),
                    sources: self.sources(),
                    walls: self.walls.cloned(),
                    transmission: TransmissionScale::Rate,
                    overlays: self.overlays(),
                    cell: CellShape::of(self.geometry.spacing()),
                    ..PolarOptions::default()
                };
                polar_overlay(Some(self.problem.transmission), Some(&self.outcome.distribution), &options)
            }
            Picture::Energy => light::picture(&self.outcome.distribution.energy(), self.energy()),
        }
    }
}

/// With six digits behind the point, or six digits in all where it is long.
fn watts(value: f64) -> String {
    if value < 1e9 { format!("{value:.6}") } else { format!("{value:.6e}") }
}

fn report(
    args: &PropagateArgs,
    input: &MediumInput,
    lights: usize,
    (outcome, unit): (&Outcome, &str),
    seconds: f64,
) -> Result<(), CliError> {
    let grid = input.grid();
    let energy = outcome.distribution.energy();
    let largest = energy.values().iter().fold(0.0, |m: f64, &e| m.max(e));
    let (stop, stop_words) = match outcome.stop {
        StopReason::Converged => ("converged", "until the stopping rule was met"),
        StopReason::StepLimit => ("step_limit", "until the limit on steps"),
    };
    if args.json {
        print_json(&json!({
            "width": grid.width(),
            "height": grid.height(),
            "directions": args.scheme.directions.count(),
            "sources": lights,
            "iterations_total": outcome.work.steps,
            "iterations_max": outcome.work.steps,
            "cell_updates": outcome.work.cell_updates,
            "seconds": { "total": seconds },
            "peak_memory_bytes": system::peak_memory(),
            "stop": stop,
            "energy": outcome.distribution.total_energy(),
            "max": largest,
            "mean": outcome.distribution.total_energy() / grid.cells() as f64,
        }))
    } else {
        let energy = outcome.distribution.total_energy();
        let steps = counted(outcome.work.steps, unit);
        print_text(&format!(
            "{steps} {stop_words}; energy in the grid {} W, brightest cell {} W\n",
            watts(energy),
            watts(largest)
        ))
    }
}
