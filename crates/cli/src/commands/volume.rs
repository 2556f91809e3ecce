//! Finished gradient volumes: files, pictures, and what is said about them.

use crate::commands::PNG_SCALE;
use crate::commands::command_line;
use crate::error::CliError;
use crate::files;
use crate::part_file::{Gradient, Identity};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tigereye_core::{CellShape, Choice, Field, LtgVolume, Surface};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{Rows, npy, vti};
use tigereye_render::{Overlay, Scene};
use tigereye_transport::{StopMeasure, Stopping};
use tigereye_views::gradient;
use tigereye_views::total_anisotropy::ThinCells;

/// Endings of files that hold volumes, or pictures of them.
pub(super) const ENDINGS: [&str; 4] = ["vti", "npy", "png", "svg"];

/// The script beside an image file.
fn script_of(output: &Path) -> PathBuf {
    output.with_extension("view.py")
}

fn images(outputs: &[PathBuf]) -> impl Iterator<Item = &PathBuf> {
    outputs.iter().filter(|o| files::extension(o) == "vti")
}

/// Whether an output is a picture rather than the volume itself.
pub(super) fn is_picture(output: &Path) -> bool {
    matches!(files::extension(output).as_str(), "png" | "svg")
}

/// Whether the scripts can be written, before anything is computed.
pub(super) fn check_scripts(outputs: &[PathBuf]) -> Result<(), CliError> {
    images(outputs).try_for_each(|output| files::check_writable(&script_of(output)))
}

/// Beside every image file, a script that opens it in ParaView. `geometry` is that of the field.
pub(super) fn write_scripts(outputs: &[PathBuf], geometry: &PlaneGeometry) -> Result<(), CliError> {
    let vector = |v: [f64; 3]| format!("{v:?}");
    // Without a place the rows run downwards, and up is against them.
    let (right, up, normal) = (geometry.right(), geometry.up(), geometry.normal());
    let mirrored = if geometry.is_placed() { "False" } else { "True" };
    for output in images(outputs) {
        let name = output.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        // Inside a Python string.
        let name = name.replace('\\', "\\\\").replace('"', "\\\"");
        let script = include_str!("view.py")
            .replace("@VOLUME@", &name)
            .replace("@RIGHT@", &vector(right))
            .replace("@UP@", &vector(up))
            .replace("@NORMAL@", &vector(normal))
            .replace("@MIRRORED@", mirrored);
        files::write(&script_of(output), script.as_bytes())?;
    }
    Ok(())
}

/// Writes a volume to every output. `title` heads pictures; the identity says what made it and where it lies.
pub(super) fn write(
    outputs: &[PathBuf],
    gradient: &Gradient,
    walls: Option<&Field<Option<Surface>>>,
    title: &str,
    identity: &Identity,
) -> Result<(), CliError> {
    let cell = CellShape::of(identity.geometry.spacing());
    let overlays = || identity.thin.iter().map(ThinCells::overlay).collect();
    let drawn = || picture(title, &gradient.volume, walls, cell, overlays());
    outputs.iter().try_for_each(|output| files::write(output, &encoded(output, gradient, &drawn, identity)?))
}

/// A volume in the format of the output's ending.
fn encoded(
    output: &Path,
    gradient: &Gradient,
    drawn: &dyn Fn() -> Scene,
    identity: &Identity,
) -> Result<Vec<u8>, CliError> {
    let name = output.display().to_string();
    match files::extension(output).as_str() {
        "npy" => Ok(npy::write_ltg(&gradient.volume)),
        "vti" => {
            let geometry = &identity.geometry;
            let parameters = with_rows(identity.parameters.clone(), Rows::of_results(geometry));
            let story = provenance(&command_line(), &parameters, &identity.input_blake3);
            let mut image = tigereye_io::image_from_ltg(&gradient.volume, geometry, &story);
            if let Some(error) = &gradient.error {
                tigereye_io::add_ltg_error(&mut image, error, geometry);
            }
            vti::write(&image).map_err(|e| CliError::input(&name, e))
        }
        "png" => drawn().to_png(PNG_SCALE).map_err(|e| CliError::input(&name, e)),
        _ => drawn().to_svg().map(String::into_bytes).map_err(|e| CliError::input(&name, e)),
    }
}

/// The only slice, or the mean over the slices.
fn picture(
    title: &str,
    volume: &LtgVolume,
    walls: Option<&Field<Option<Surface>>>,
    cell: CellShape,
    overlays: Vec<Overlay>,
) -> Scene {
    let (slice, scalar) = match volume.slices() {
        [t] => (volume.slice(*t), gradient::Scalar::SliceAt(volume.directions().angle_deg(*t))),
        _ => (None, gradient::Scalar::Mean),
    };
    let field = slice.unwrap_or_else(|| volume.mean_over_directions());
    let (title, walls) = (title.to_owned(), walls.cloned());
    gradient::picture(
        &field,
        gradient::Request { title, scalar, walls, cell, overlays, ..gradient::Request::default() },
    )
}

/// Plain steps of a pulse that has no stationary state.
const CAUGHT: usize = Stopping::REFERENCE.max_iterations + 1;

/// A summary in one sentence; `stop` is the stopping rule as the option spells it.
pub(super) fn sentence(summary: &Value, stop: &Value) -> String {
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    if summary["estimate"] == 0 {
        return "the shard has none of the sketches: every value is 0\n".to_owned();
    }
    if !summary["estimate"].is_null() {
        return format!(
            "{} sketches (seed {}), {:.2} s; LTG at most {:.6}, {:.6} on average, with a relative standard error of {:.1} %\n",
            summary["estimate"],
            summary["seed"],
            number(&summary["seconds"]["total"]),
            number(&summary["max"]),
            number(&summary["mean"]),
            100.0 * number(&summary["relative_error"]),
        );
    }
    if summary["sources"] == 0 {
        return "the field has no inner cells, or the shard none of them: every value is 0\n".to_owned();
    }
    // With linear scattering nothing takes steps: the light that leaves a cell towards each neighbour is solved for.
    let made = match summary["iterations_max"].as_u64() {
        Some(0) => format!("{} solutions", summary["sources"]),
        _ => format!("{} sources, {} steps at most", summary["sources"], summary["iterations_max"]),
    };
    let limited = match summary["limited"].as_u64() {
        None | Some(0) => String::new(),
        Some(n) if stop == StopMeasure::Stationary.word() => {
            format!("; {n} sources did not converge within {CAUGHT} steps, and have the light after these")
        }
        Some(n) => format!("; {n} sources met --max-iterations before the threshold"),
    };
    format!(
        "{made}, {:.2} s; LTG at most {:.6}, {:.6} on average{limited}\n",
        number(&summary["seconds"]["total"]),
        number(&summary["max"]),
        number(&summary["mean"]),
    )
}
