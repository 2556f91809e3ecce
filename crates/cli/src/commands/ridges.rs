//! `tigereye ridges`: height ridges and contours of scalar images.

use crate::args::classical::RidgesArgs;
use crate::commands::{command_line, counted, drawing, print_json, print_text};
use crate::error::CliError;
use crate::files;
use serde_json::json;
use std::path::Path;
use tigereye_input::provenance::{hash_of_bytes, provenance};
use tigereye_io::{vti, vtp};
use tigereye_lines::{RidgeOptions, Threshold};
use tigereye_render::{Colours, HeatOptions, Scene};
use tigereye_views::ridges::{Feature, Found, ScalarImage, find};

pub(crate) fn run(args: &RidgesArgs) -> Result<u8, CliError> {
    drawing::check_outputs(&args.outputs, &["vtp", "png", "svg", "pdf"])?;
    files::check_apart(std::slice::from_ref(&args.input), &args.outputs)?;
    let fault = |problem: String| CliError::input(&args.input, problem);
    let path = Path::new(&args.input);
    if files::extension(path) != "vti" {
        return Err(fault("unknown extension: expected .vti".to_owned()));
    }
    let bytes = files::read(path)?;
    let image = vti::read(&bytes).map_err(|e| fault(e.to_string()))?;
    let image = ScalarImage::of(&image, args.array.as_deref()).map_err(|e| fault(e.to_string()))?;
    let image = if args.mean { image.mean() } else { image };
    let style = drawing::style(&args.style, Colours::Values)?;
    let style = image.placement().map_or(style.clone(), |place| drawing::placed(style, &place, None));
    if let Some(output) = args.outputs.iter().find(|o| drawing::is_picture(o))
        && image.layers() > 1
        && args.layer.is_none()
    {
        let problem = "shows one layer: expected --layer, --mean, or .vtp for the surface of all of them";
        return Err(CliError::input(&output.display().to_string(), problem));
    }
    let is_flat = image.layers() == 1 || args.layer.is_some();
    let samples = args.samples.unwrap_or(if is_flat { 2 } else { 1 });
    let options = RidgeOptions {
        samples_per_cell: samples,
        cell: image.cell(args.direction_length),
        least_value: Threshold::Part(args.least_value),
        least_strength: Threshold::Part(args.least_strength),
        least_extent: args.least_length,
        ..RidgeOptions::default()
    };
    let feature = args.contour.map_or(Feature::Ridges(options), Feature::Contour);
    let found = find(&image, args.layer, &feature).map_err(|e| fault(e.to_string()))?;
    let parameters = json!({
        "input": args.input,
        "array": image.array,
        "layer": args.layer,
        "mean": args.mean,
        "contour": args.contour,
        "least_value": args.least_value,
        "least_strength": args.least_strength,
        "least_length": args.least_length,
        "cell": options.cell,
        "direction_length": options.cell[2],
        "samples": samples,
    });
    let story = provenance(&command_line(), &parameters, &hash_of_bytes(&bytes));
    let label = if args.contour.is_some() { "contour" } else { "height ridges" };
    let title = args.input.clone();
    let options = HeatOptions { title, style: style.clone(), ..HeatOptions::default() };
    let picture = found.picture(&image, label, options).map_err(|e| fault(e.to_string()))?;
    drawing::write(
        &args.outputs,
        &style,
        &|| Ok(picture.clone().unwrap_or_else(|| Scene::sized(1.0, 1.0))),
        &|| vtp::write(&found.poly_data(&image, &story)),
    )?;
    let (kind, points) = match &found {
        Found::Lines { lines, .. } => ("line", lines.points.len()),
        Found::Surface { surface, .. } => ("triangle", surface.points.len()),
    };
    if args.json {
        print_json(&json!({
            "array": image.array,
            "kind": kind,
            "parts": found.parts(),
            "points": points,
            "periodic": image.is_periodic(),
        }))?;
    } else {
        print_text(&format!("{} over {}\n", counted(found.parts(), kind), counted(points, "point")))?;
    }
    Ok(0)
}
