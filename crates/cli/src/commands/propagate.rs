//! `tigereye propagate`: one light distribution.

use crate::args::light::{Picture, PropagateArgs};
use crate::commands::drawing::{self, is_picture};
use crate::commands::light_options::{cell_and_profile, parameters};
use crate::commands::overlaid::Overlaid;
use crate::commands::{advice, command_line, counted, importance, print_json, print_text};
use crate::error::CliError;
use crate::medium::MediumInput;
use crate::{files, interrupt, system};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use serde_json::{Value, json};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tigereye_core::{Cell, LightDistribution, ProfileRule, StopReason};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{Rows, npy, pvd, vti};
use tigereye_render::{
    Colours, HeatOptions, PolarOptions, Scene, Style, TransmissionScale, heat_map, polar_overlay,
};
use tigereye_transport::{
    EightLobe, Emission, Engine, Light, Outcome, Problem, ScatteringRule, Stopping, StoppingRule,
    stationary_light,
};
use tigereye_views::added::{Additions, Scalars};
use tigereye_views::total_anisotropy::ThinCells;
use tigereye_views::{Reel, light as light_view};

pub(crate) fn propagate(args: &PropagateArgs) -> Result<u8, CliError> {
    let jobs = Job::of(args)?;
    for job in &jobs {
        check_outputs(&job.outputs, &["vti", "npy", "png", "svg", "pdf", "pvd", "apng"])?;
        job.outputs
            .iter()
            .filter(|o| is_collection(o))
            .try_for_each(|o| check_frames(o, &job.outputs, args))?;
    }
    let colours = if args.picture == Picture::Energy { Colours::Values } else { Colours::Kinds };
    let style = drawing::style(&args.style, colours)?;
    let overlaid = Overlaid::read(&args.overlay)?;
    let start = Instant::now();
    let input = MediumInput::open(&args.input, &args.scheme.reading)?;
    let is_diagrams = args.picture == Picture::Overlay;
    overlaid.check(&input.placement(), input.tensors().is_some(), true, is_diagrams)?;
    for job in &jobs {
        input.check_apart(&job.outputs)?;
        job.check_folders(&input)?;
    }
    let style = drawing::placed(style, &input.placement(), input.unit());
    if let Some(receiver) = &args.towards {
        return importance::importance(args, &input, receiver, (&style, &overlaid), start);
    }
    let rule = input.rule(&args.scheme.profiles)?;
    let thin = input.thin_cells(rule);
    advice::tell_thin(input.name(), thin.as_ref());
    let transmission = input.transmission(args.scheme.directions, rule)?;
    let scheme = args.scheme.scheme();
    let stopping = args.steps.map_or_else(|| args.scheme.stopping(), Stopping::steps);
    let lights = jobs.iter().map(|job| job.lights(args, &input)).collect::<Result<Vec<_>, _>>()?;
    let problems: Vec<Problem<'_>> = lights
        .iter()
        .map(|lights| Problem { scheme: &scheme, transmission: &transmission, lights, stopping })
        .collect();
    for (problem, job) in problems.iter().zip(&jobs) {
        problem.check().map_err(|e| CliError::input(&job.subject(), e))?;
    }
    let mut summaries = Vec::new();
    for (problem, job) in problems.iter().zip(&jobs) {
        summaries.push(job.run(args, (&input, rule, thin.as_ref()), problem, (&style, &overlaid))?);
    }
    match (args.json, args.light_list.is_some(), summaries.pop()) {
        (true, false, Some(only)) => print_json(&only)?,
        (true, _, last) => print_json(&summaries.into_iter().chain(last).collect())?,
        (false, ..) => {}
    }
    Ok(0)
}

/// One light distribution of a command, and where it goes.
struct Job {
    /// The lights as they were written; none for those of a scene.
    lights: Vec<String>,
    /// Where the only light stands in a list.
    place: Option<String>,
    outputs: Vec<PathBuf>,
}

impl Job {
    /// One for the lights of the options, or one for every light of a list.
    fn of(args: &PropagateArgs) -> Result<Vec<Self>, CliError> {
        let Some(list) = &args.light_list else {
            return Ok(vec![Self {
                lights: args.lights.clone(),
                place: None,
                outputs: args.outputs.clone(),
            }]);
        };
        let name = list.display().to_string();
        let text = files::read_text(list)?;
        let lights: Vec<(usize, &str)> = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
            .filter(|(_, light)| !light.is_empty())
            .collect();
        if lights.is_empty() {
            return Err(CliError::input(&name, "holds no light: expected a line X,Y or X,Y,PROFILE"));
        }
        files::check_apart(std::slice::from_ref(&name), &args.outputs)?;
        // Numbers of the same length sort as they count.
        let digits = lights.len().to_string().len();
        let numbered = |path: &PathBuf, number: usize| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let extension = path.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
            path.with_file_name(format!("{stem}-{number:0digits$}{extension}"))
        };
        let job = |(i, (line, light)): (usize, &(usize, &str))| Self {
            lights: vec![(*light).to_owned()],
            place: Some(format!("{name}:{line}:")),
            outputs: args.outputs.iter().map(|path| numbered(path, i + 1)).collect(),
        };
        Ok(lights.iter().enumerate().map(job).collect())
    }

    /// What a fault of the lights is about.
    fn subject(&self) -> String {
        self.place
            .clone()
            .map_or_else(|| "--light".to_owned(), |place| place.trim_end_matches(':').to_owned())
    }

    /// Refuses folders of frames with files in them that are read.
    fn check_folders(&self, input: &MediumInput) -> Result<(), CliError> {
        for folder in self.outputs.iter().filter(|o| is_collection(o)).map(|o| folder_of_frames(o)) {
            let inside =
                |file: &&String| files::place_of(Path::new(file)).starts_with(files::place_of(&folder));
            if let Some(file) = input.files().iter().find(inside) {
                let problem =
                    format!("is in the folder {} of the frames: expected another place", folder.display());
                return Err(CliError::input(file, problem));
            }
        }
        Ok(())
    }

    /// The lights asked for, or a scene's own.
    fn lights(&self, args: &PropagateArgs, input: &MediumInput) -> Result<Vec<Light>, CliError> {
        let option = self.place.as_deref().unwrap_or("--light");
        let asked = self.lights.iter().map(|l| light(option, l, args)).collect::<Result<Vec<_>, _>>()?;
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

    /// Propagates the light and writes it. The summary.
    fn run(
        &self,
        args: &PropagateArgs,
        (input, rule, thin): (&MediumInput, ProfileRule, Option<&ThinCells>),
        problem: &Problem<'_>,
        (style, overlaid): (&Style, &Overlaid),
    ) -> Result<Value, CliError> {
        let start = Instant::now();
        let parameters = parameters(args, &self.lights, &problem.stopping, input, rule);
        let rows = Rows::of_results(input.geometry());
        let story = provenance(&command_line(), &with_rows(parameters, rows), input.blake3());
        let collections = self.outputs.iter().filter(|o| is_collection(o));
        let mut collections =
            collections.map(|o| Frames::new(o, input.geometry(), &story)).collect::<Result<Vec<_>, _>>()?;
        let mut reel =
            self.outputs.iter().any(|o| is_animation(o)).then(|| Reel::new(input.grid().cells(), 1));
        for frames in &mut collections {
            frames.add(&problem.before_first_step())?;
        }
        if let Some(reel) = &mut reel {
            reel.add(|| problem.before_first_step().energy());
        }
        let mut fault = None;
        let line = progress_line(&args.input, &problem.stopping);
        // A stationary state of linear scattering is solved for, unless its steps are to be seen.
        let has_flashes = problem.lights.iter().any(|light| matches!(light.emission, Emission::Impulse(_)));
        let is_solved = problem.scheme.scattering() == ScatteringRule::Linear
            && matches!(problem.stopping.rule, StoppingRule::Converged { .. })
            && !(has_flashes || reel.is_some() || !collections.is_empty());
        let outcome = if is_solved {
            stationary_light(problem, problem.stopping.rule.threshold(), &mut |sweeps, _| {
                line.set_position(sweeps as u64);
                if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
        } else {
            EightLobe.propagate_observed(problem, &mut |view| {
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
        let outcome = outcome.map_err(|e| CliError::input(&self.subject(), e))?;
        fault.map_or(Ok(()), Err)?;
        let title = match (&self.place, problem.lights) {
            (Some(_), [light]) => {
                format!("{}, light at ({}, {})", input.title(), light.cell.x, light.cell.y)
            }
            _ => input.title().to_owned(),
        };
        let drawn =
            Drawn { problem, outcome: &outcome, input, title, style, overlaid, thin, reel: reel.as_ref() };
        for output in self.outputs.iter().filter(|o| !is_collection(o)) {
            files::write(output, &encoded(output, args, &drawn, &story)?)?;
        }
        collections.into_iter().try_for_each(Frames::finish)?;
        let lit = advice::Lit {
            input,
            rule,
            transmission: problem.transmission,
            thin,
            lights: problem.lights,
            stopping: &problem.stopping,
            light: &outcome.distribution,
            steps: (!is_solved).then_some(outcome.work.steps),
        };
        lit.tell();
        let unit = if is_solved { "sweep" } else { "step" };
        report(args, problem, self, (&outcome, unit), start.elapsed().as_secs_f64())
    }
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
fn check_frames(output: &Path, outputs: &[PathBuf], args: &PropagateArgs) -> Result<(), CliError> {
    let fault = |problem: String| CliError::input(&output.display().to_string(), problem);
    let folder = folder_of_frames(output);
    if folder.exists() && !folder.is_dir() {
        let problem = format!("its frames go to the folder {}, which is a file", folder.display());
        return Err(fault(problem + ": expected another name"));
    }
    let place = files::place_of(&folder);
    if let Some(other) = outputs.iter().find(|o| files::place_of(o).starts_with(&place)) {
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

/// A light of an option, or of a line of a list.
fn light(option: &str, text: &str, args: &PropagateArgs) -> Result<Light, CliError> {
    let (cell, profile) = cell_and_profile(option, text, args.scheme.directions)?;
    Ok(if args.impulse { Light::impulse(cell, profile) } else { Light::continuous(cell, profile) })
}

fn encoded(output: &Path, args: &PropagateArgs, drawn: &Drawn<'_>, story: &str) -> Result<Vec<u8>, CliError> {
    let name = output.display().to_string();
    let light = &drawn.outcome.distribution;
    match files::extension(output).as_str() {
        _ if is_picture(output) => drawing::encoded(&drawn.picture(args)?, output, drawn.style),
        "npy" => Ok(npy::write_light(light)),
        "vti" => {
            let image = tigereye_io::image_from_light(light, drawn.input.geometry(), story);
            vti::write(&image).map_err(|e| CliError::input(&name, e))
        }
        _ => {
            let reel = drawn.reel.ok_or_else(|| CliError::input(&name, "no step was kept"))?;
            let made = reel.encoded(&drawn.energy(drawn.additions()?), light_view::DECADES, 1);
            made.map(|(bytes, _)| bytes).map_err(|e| CliError::input(&name, e))
        }
    }
}

/// What pictures show.
struct Drawn<'a> {
    problem: &'a Problem<'a>,
    outcome: &'a Outcome,
    input: &'a MediumInput,
    title: String,
    style: &'a Style,
    overlaid: &'a Overlaid,
    thin: Option<&'a ThinCells>,
    /// The steps, where an animation is asked for.
    reel: Option<&'a Reel>,
}

impl Drawn<'_> {
    fn sources(&self) -> Vec<Cell> {
        self.problem.lights.iter().map(|l| l.cell).collect()
    }

    /// What is drawn over the picture.
    fn additions(&self) -> Result<Additions, CliError> {
        let energy = self.outcome.distribution.energy();
        let scalars = Scalars { values: &energy, samples: 1 };
        let mut added =
            self.overlaid.additions(self.input.tensors(), &self.input.placement(), Some(scalars))?;
        // Beneath the others.
        added.overlays.splice(0..0, self.thin.map(ThinCells::overlay));
        Ok(added)
    }

    fn energy(&self, Additions { overlays, glyphs }: Additions) -> HeatOptions {
        HeatOptions {
            title: self.title.clone(),
            sources: self.sources(),
            walls: self.input.surfaces().cloned(),
            overlays,
            glyphs,
            cell: self.input.placement().cell(),
            masked: self.input.masked(),
            style: self.style.clone(),
            ..light_view::options(Some(light_view::DECADES))
        }
    }

    fn picture(&self, args: &PropagateArgs) -> Result<Scene, CliError> {
        let additions = self.additions()?;
        Ok(match args.picture {
            Picture::Overlay => {
                let options = PolarOptions {
                    title: self.title.clone(),
                    sources: self.sources(),
                    walls: self.input.surfaces().cloned(),
                    overlays: additions.overlays,
                    transmission: TransmissionScale::Rate,
                    cell: self.input.placement().cell(),
                    masked: self.input.masked(),
                    style: self.style.clone(),
                    ..PolarOptions::default()
                };
                polar_overlay(Some(self.problem.transmission), Some(&self.outcome.distribution), &options)
            }
            Picture::Energy => heat_map(&self.outcome.distribution.energy(), &self.energy(additions)),
        })
    }
}

/// With six digits behind the point, or six digits in all where it is long.
fn watts(value: f64) -> String {
    if value < 1e9 { format!("{value:.6}") } else { format!("{value:.6e}") }
}

/// Prints a summary of the propagation, unless JSON was requested; returns the summary as JSON.
fn report(
    args: &PropagateArgs,
    problem: &Problem<'_>,
    job: &Job,
    (outcome, unit): (&Outcome, &str),
    seconds: f64,
) -> Result<Value, CliError> {
    let energy = outcome.distribution.energy();
    let grid = energy.grid();
    let largest = energy.values().iter().fold(0.0, |m: f64, &e| m.max(e));
    let (stop, stop_words) = match outcome.stop {
        StopReason::Converged => ("converged", "until the stopping rule was met"),
        StopReason::StepLimit => ("step_limit", "until the limit on steps"),
    };
    let total = outcome.distribution.total_energy();
    if !args.json {
        let steps = counted(outcome.work.steps, unit);
        let of = job.place.as_ref().map_or_else(String::new, |_| format!("{}: ", job.lights.join(" ")));
        print_text(&format!(
            "{of}{steps} {stop_words}; energy in the grid {} W, brightest cell {} W\n",
            watts(total),
            watts(largest)
        ))?;
    }
    let mut summary = json!({
        "width": grid.width(),
        "height": grid.height(),
        "directions": args.scheme.directions.count(),
        "sources": problem.lights.len(),
        "iterations_total": outcome.work.steps,
        "iterations_max": outcome.work.steps,
        "cell_updates": outcome.work.cell_updates,
        "seconds": { "total": seconds },
        "peak_memory_bytes": system::peak_memory(),
        "stop": stop,
        "energy": total,
        "max": largest,
        "mean": total / grid.cells() as f64,
    });
    if job.place.is_some() {
        summary["light"] = json!(job.lights);
        summary["outputs"] = json!(job.outputs.iter().map(|o| o.display().to_string()).collect::<Vec<_>>());
    }
    Ok(summary)
}
