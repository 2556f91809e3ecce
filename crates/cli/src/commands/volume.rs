//! Finished gradient volumes: files, pictures, and what is said about them.

use crate::commands::command_line;
use crate::commands::drawing::{self, is_picture};
use crate::commands::overlaid::Overlaid;
use crate::error::CliError;
use crate::files;
use crate::part_file::{Gradient, Identity};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tigereye_core::{Cell, Choice, Field, LtgVolume, Surface, Tensor2};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{Rows, npy, vti};
use tigereye_render::{HeatOptions, Scene, Style};
use tigereye_transport::{StopMeasure, Stopping};
use tigereye_views::added::{Additions, Scalars};
use tigereye_views::total_anisotropy::ThinCells;
use tigereye_views::{Placement, gradient};

/// Extensions of files that hold volumes, or pictures of them.
pub(super) const EXTENSIONS: [&str; 5] = ["vti", "npy", "png", "svg", "pdf"];

/// The script beside an image file.
fn script_of(output: &Path) -> PathBuf {
    output.with_extension("view.py")
}

fn images(outputs: &[PathBuf]) -> impl Iterator<Item = &PathBuf> {
    outputs.iter().filter(|o| files::extension(o) == "vti")
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

/// What pictures of a volume show beside it.
#[derive(Debug)]
pub(super) struct Look<'a> {
    /// Heading.
    pub(super) title: &'a str,
    /// The walls of a scene.
    pub(super) walls: Option<&'a Field<Option<Surface>>>,
    /// Cells without a tensor.
    pub(super) masked: Vec<Cell>,
    /// What is chosen otherwise.
    pub(super) style: Style,
    /// Unit of the coordinates, where the file states it.
    pub(super) unit: Option<&'static str>,
    /// The tensors, unless it is a scene.
    pub(super) tensors: Option<&'a Field<Tensor2>>,
    /// What is drawn over them.
    pub(super) overlaid: &'a Overlaid,
}

/// Writes a volume to every output. The identity says what made it and where it lies.
pub(super) fn write(
    outputs: &[PathBuf],
    gradient: &Gradient,
    look: &Look<'_>,
    identity: &Identity,
) -> Result<(), CliError> {
    outputs.iter().try_for_each(|output| {
        let bytes = match is_picture(output) {
            true => drawing::encoded(&picture(&gradient.volume, look, identity)?, output, &look.style)?,
            false => encoded(output, gradient, identity)?,
        };
        files::write(output, &bytes)
    })
}

/// A volume in the format of the output's extension.
fn encoded(output: &Path, gradient: &Gradient, identity: &Identity) -> Result<Vec<u8>, CliError> {
    let name = output.display().to_string();
    match files::extension(output).as_str() {
        "npy" => Ok(npy::write_ltg(&gradient.volume)),
        _ => {
            let geometry = &identity.geometry;
            let parameters = with_rows(identity.parameters.clone(), Rows::of_results(geometry));
            let story = provenance(&command_line(), &parameters, &identity.input_blake3);
            let mut image = tigereye_io::image_from_ltg(&gradient.volume, geometry, &story);
            if let Some(error) = &gradient.error {
                tigereye_io::add_ltg_error(&mut image, error, geometry);
            }
            vti::write(&image).map_err(|e| CliError::input(&name, e))
        }
    }
}

/// The only slice, or the mean over the slices.
fn picture(volume: &LtgVolume, look: &Look<'_>, identity: &Identity) -> Result<Scene, CliError> {
    let (slice, scalar) = match volume.slices() {
        [t] => (volume.slice(*t), gradient::Scalar::SliceAt(volume.directions().angle_deg(*t))),
        _ => (None, gradient::Scalar::Mean),
    };
    let field = slice.unwrap_or_else(|| volume.mean_over_directions());
    let placement = Placement::new(identity.geometry, field.grid());
    let mut shown = gradient::where_result(&field, look.walls);
    look.masked.iter().for_each(|cell| shown.values_mut()[field.grid().index(*cell)] = f64::NAN);
    let scalars = Scalars { values: &shown, samples: 1 };
    let Additions { mut overlays, glyphs } =
        look.overlaid.additions(look.tensors, &placement, Some(scalars))?;
    // Beneath the others.
    overlays.splice(0..0, identity.thin.iter().map(ThinCells::overlay));
    let options = HeatOptions {
        overlays,
        glyphs,
        title: look.title.to_owned(),
        walls: look.walls.cloned(),
        cell: placement.cell(),
        masked: look.masked.clone(),
        style: drawing::placed(look.style.clone(), &placement, look.unit),
        ..HeatOptions::default()
    };
    Ok(gradient::picture(&field, scalar, options))
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
            format!("; {n} sources did not converge within {CAUGHT} steps, and keep the light they had then")
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
