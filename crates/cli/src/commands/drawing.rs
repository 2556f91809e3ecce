//! What the commands of the classical methods share: outputs by their extensions, provenance, and position.

use crate::args::reading::ReadingArgs;
use crate::args::style::StyleArgs;
use crate::commands::command_line;
use crate::error::CliError;
use crate::input::{Input, insert_reading};
use crate::{files, interrupt};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tigereye_core::CellShape;
use tigereye_experiments::style_of_file;
use tigereye_input::provenance::provenance;
use tigereye_io::IoError;
use tigereye_lines::Following;
use tigereye_lines::LineOptions;
use tigereye_render::{Colours, Scene, Style};
use tigereye_views::Placement;

/// Refuses extensions other than `extensions`, and paths that cannot be written, before anything is computed.
pub(super) fn check_outputs(outputs: &[PathBuf], extensions: &[&str]) -> Result<(), CliError> {
    for output in outputs {
        if !extensions.contains(&files::extension(output).as_str()) {
            let problem = format!("unknown extension: expected .{}", extensions.join(", ."));
            return Err(CliError::input(&output.display().to_string(), problem));
        }
        files::check_writable(output)?;
    }
    Ok(())
}

/// The input, unless it is among the outputs. From here on an interrupt ends the program.
pub(super) fn open_input(text: &str, reading: &ReadingArgs, outputs: &[PathBuf]) -> Result<Input, CliError> {
    let input = Input::open(text, reading)?;
    input.check_apart(outputs)?;
    interrupt::end_at_once();
    Ok(input)
}

/// Refuses lines of more steps than can be.
pub(super) fn check_steps(length: f64, step: f64) -> Result<(), CliError> {
    let most = LineOptions::MAX_STEPS;
    if length / step <= most {
        return Ok(());
    }
    let problem = format!("{length} cells in steps of {step}: expected at most {most} steps (option --step)");
    Err(CliError::input("--length", problem))
}

/// The provenance of what is made of an input with these parameters.
pub(super) fn story(input: &Input, mut parameters: Value, reading: &ReadingArgs) -> String {
    if let Some(all) = parameters.as_object_mut() {
        all.insert("input".to_owned(), Value::from(input.name.clone()));
    }
    insert_reading(&mut parameters, reading);
    provenance(&command_line(), &parameters, &input.blake3)
}

/// Where the cells of an input lie.
pub(super) const fn placement(input: &Input) -> Placement {
    Placement::new(input.geometry, input.field.grid())
}

/// What lengths are counted in: cells, or the smaller side of those that are not square.
pub(super) fn unit(following: &Following) -> &'static str {
    if following.cell == CellShape::SQUARE { "cells" } else { "smaller cell sides" }
}

/// One of what lengths are counted in.
pub(super) fn one_unit(following: &Following) -> &'static str {
    if following.cell == CellShape::SQUARE { "cell" } else { "smaller cell side" }
}

/// Writes a picture to every output that is one, and data to the others.
pub(super) fn write(
    outputs: &[PathBuf],
    style: &Style,
    picture: &dyn Fn() -> Result<Scene, CliError>,
    data: &dyn Fn() -> Result<Vec<u8>, IoError>,
) -> Result<(), CliError> {
    let mut scene = None;
    for output in outputs {
        interrupt::check()?;
        let fault = |problem: String| CliError::input(&output.display().to_string(), problem);
        if scene.is_none() && is_picture(output) {
            scene = Some(picture()?);
        }
        let bytes = match &scene {
            Some(scene) if is_picture(output) => encoded(scene, output, style)?,
            _ => data().map_err(|e| fault(e.to_string()))?,
        };
        files::write(output, &bytes)?;
    }
    Ok(())
}

/// Extensions of pictures.
pub(super) const PICTURES: [&str; 3] = ["png", "svg", "pdf"];

/// Whether an output is a picture rather than data.
pub(super) fn is_picture(output: &Path) -> bool {
    PICTURES.contains(&files::extension(output).as_str())
}

/// A picture in the format of the output's extension.
pub(super) fn encoded(scene: &Scene, output: &Path, style: &Style) -> Result<Vec<u8>, CliError> {
    style.check_width(scene).map_err(|e| CliError::input("--width", e))?;
    let bytes = match files::extension(output).as_str() {
        "svg" => scene.to_svg().map(String::into_bytes),
        "pdf" => scene.to_pdf(),
        _ => scene.to_png_at(style.dpi.unwrap_or(Style::DPI)),
    };
    bytes.map_err(|e| CliError::input(&output.display().to_string(), e))
}

/// The style of the options and of the style file. Options that the picture has no use for are refused; a style file
/// is for pictures of all kinds.
pub(super) fn style(args: &StyleArgs, colours: Colours) -> Result<Style, CliError> {
    let given = args.given();
    if let Some((setting, expected)) = given.useless(colours) {
        let option = format!("--{}", setting.replace('_', "-"));
        return Err(CliError::input(&option, format!("has no effect here: expected {expected}")));
    }
    let Some(path) = &args.style else { return Ok(given) };
    let name = path.display().to_string();
    let file = style_of_file(&name, &files::read_text(path)?).map_err(|e| CliError::Input(e.to_string()))?;
    Ok(given.or(file))
}

/// Refuses options for a single map where a page has several.
pub(super) fn check_whole_page(args: &StyleArgs) -> Result<(), CliError> {
    let given = args.given();
    let asked = [
        (given.x_name.is_some(), "--x-label"),
        (given.y_name.is_some(), "--y-label"),
        (given.numbers.is_some(), "--coordinates"),
        (given.unit.is_some(), "--unit"),
        (given.masked.is_some(), "--masked-label"),
    ];
    match asked.iter().find(|(given, _)| *given) {
        Some((_, option)) => {
            let problem =
                "has no effect on a page of several maps: expected --title, --width, --font-size or --dpi";
            Err(CliError::input(option, problem))
        }
        None => Ok(()),
    }
}

/// The style of a picture of an input, whose axes have the file's coordinates and unit.
pub(super) fn placed(style: Style, placement: &Placement, unit: Option<&'static str>) -> Style {
    let (coordinates, unit) = (placement.coordinates(), unit.map(str::to_owned));
    style.or(Style { coordinates, unit, ..Style::default() })
}
