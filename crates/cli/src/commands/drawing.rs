//! What the commands of the classical methods share: outputs by their extensions, provenance, and position.

use crate::args::reading::ReadingArgs;
use crate::commands::PNG_SCALE;
use crate::commands::command_line;
use crate::error::CliError;
use crate::input::{Input, insert_reading};
use crate::{files, interrupt};
use serde_json::Value;
use std::path::PathBuf;
use tigereye_core::CellShape;
use tigereye_input::provenance::provenance;
use tigereye_io::IoError;
use tigereye_lines::Following;
use tigereye_lines::LineOptions;
use tigereye_render::{RenderError, Scene};
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
    picture: &dyn Fn() -> Result<Scene, RenderError>,
    data: &dyn Fn() -> Result<Vec<u8>, IoError>,
) -> Result<(), CliError> {
    let mut scene = None;
    for output in outputs {
        interrupt::check()?;
        let fault = |problem: String| CliError::input(&output.display().to_string(), problem);
        let ending = files::extension(output);
        if scene.is_none() && matches!(ending.as_str(), "png" | "svg") {
            scene = Some(picture().map_err(|e| fault(e.to_string()))?);
        }
        let bytes = match (ending.as_str(), &scene) {
            ("png", Some(scene)) => scene.to_png(PNG_SCALE).map_err(|e| fault(e.to_string()))?,
            ("svg", Some(scene)) => scene.to_svg().map_err(|e| fault(e.to_string()))?.into_bytes(),
            _ => data().map_err(|e| fault(e.to_string()))?,
        };
        files::write(output, &bytes)?;
    }
    Ok(())
}
