//! `tigereye propagate --towards`: where the light at a receiver comes from.

use crate::args::light::{Picture, PropagateArgs};
use crate::commands::light_options::{cell_and_profile, parameters};
use crate::commands::{PNG_SCALE, advice, command_line, print_json, print_text};
use crate::error::CliError;
use crate::medium::MediumInput;
use crate::{files, interrupt, system};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use tigereye_core::{Cell, CellShape, LightDistribution, TransmissionField};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::{Rows, npy, vti};
use tigereye_render::{PolarOptions, Scene, TransmissionScale, polar_overlay};
use tigereye_transport::{LinearScattering, Scattering, ScatteringRule, StoppingRule, TransportError};
use tigereye_views::light;
use tigereye_views::total_anisotropy::ThinCells;

/// Relative change of the importance per step at which it counts as stationary.
const TOLERANCE: f64 = 1e-10;

/// Range of maps, decades below the most important cell: light of nearly all cells gets nearly everywhere.
const DECADES: f64 = 2.0;

pub(super) fn importance(
    args: &PropagateArgs,
    input: &MediumInput,
    receiver: &str,
    start: Instant,
) -> Result<u8, CliError> {
    if args.scheme.scattering == ScatteringRule::Joint {
        let problem = "only light that superposes can be followed back: expected --scattering linear";
        return Err(CliError::input("--towards", problem));
    }
    let stopping = args.scheme.stopping();
    if !matches!(stopping.rule, StoppingRule::Converged { .. }) {
        return Err(CliError::input(
            "--stop",
            "importance is that of the stationary state: expected stationary",
        ));
    }
    if let Some(output) = args.outputs.iter().find(|o| matches!(&*files::extension(o), "pvd" | "apng")) {
        let problem = "importance has no steps to show: expected .vti, .npy, .png or .svg";
        return Err(CliError::input(&output.display().to_string(), problem));
    }
    let directions = args.scheme.directions;
    let (cell, sensitivity) = cell_and_profile("--towards", receiver, directions)?;
    let sensitivity = sensitivity.clipped();
    let rule = input.rule(&args.scheme.profiles)?;
    let thin = input.thin_cells(rule);
    advice::tell_thin(input.name(), thin.as_ref());
    let transmission = input.transmission(directions, rule)?;
    let scheme = args.scheme.scheme();
    let scattering = Scattering::new(&scheme, &transmission);
    let field = LinearScattering::new(&scattering);
    let watch = &mut |_, _| {
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let found = tigereye_transport::importance(&field, cell, sensitivity.samples(), TOLERANCE, watch);
    interrupt::check()?;
    let (importance, work) = found.map_err(|e| match e {
        TransportError::Unsettled { .. } => CliError::input(input.name(), e),
        e => CliError::input("--towards", e),
    })?;
    let parameters = parameters(args, &stopping, input, rule);
    let rows = Rows::of_results(input.geometry());
    let story = provenance(&command_line(), &with_rows(parameters, rows), input.blake3());
    for output in &args.outputs {
        let drawn = || picture(args, input, &transmission, &importance, (cell, thin.as_ref()));
        let fault = |e: &dyn std::fmt::Display| CliError::input(&output.display().to_string(), e);
        let bytes = match files::extension(Path::new(output)).as_str() {
            "npy" => npy::write_light(&importance),
            "vti" => {
                let image = tigereye_io::image_from_light(&importance, input.geometry(), &story);
                vti::write(&image).map_err(|e| fault(&e))?
            }
            "png" => drawn().to_png(PNG_SCALE).map_err(|e| fault(&e))?,
            _ => drawn().to_svg().map_err(|e| fault(&e))?.into_bytes(),
        };
        files::write(output, &bytes)?;
    }
    let largest = importance.samples().iter().fold(0.0_f64, |m, v| m.max(*v));
    let mean = importance.samples().iter().sum::<f64>() / importance.samples().len() as f64;
    if args.json {
        let grid = input.grid();
        print_json(&json!({
            "width": grid.width(),
            "height": grid.height(),
            "directions": directions.count(),
            "receiver": [cell.x, cell.y],
            "sweeps": work.steps,
            "cell_updates": work.cell_updates,
            "seconds": { "total": start.elapsed().as_secs_f64() },
            "peak_memory_bytes": system::peak_memory(),
            "max": largest,
            "mean": mean,
        }))?;
    } else {
        print_text(&format!(
            "{} sweeps; of the light that a cell emits in one direction at most {largest:.6} arrives at ({}, {}), \
             {mean:.6} on average\n",
            work.steps, cell.x, cell.y
        ))?;
    }
    Ok(0)
}

fn picture(
    args: &PropagateArgs,
    input: &MediumInput,
    transmission: &TransmissionField,
    importance: &LightDistribution,
    (receiver, thin): (Cell, Option<&ThinCells>),
) -> Scene {
    let overlays = thin.map(ThinCells::overlay).into_iter().collect();
    let (title, walls) =
        (format!("importance for ({}, {}): {}", receiver.x, receiver.y, input.title()), input.surfaces());
    let cell = CellShape::of(input.geometry().spacing());
    match args.picture {
        Picture::Overlay => {
            let options = PolarOptions {
                title,
                sources: vec![receiver],
                source_name: "receiver",
                quantity: "importance",
                walls: walls.cloned(),
                transmission: TransmissionScale::Rate,
                overlays,
                cell,
                ..PolarOptions::default()
            };
            polar_overlay(Some(transmission), Some(importance), &options)
        }
        Picture::Energy => {
            let request = light::Request {
                title,
                quantity: Some("mean importance over direction".to_owned()),
                decades: Some(DECADES),
                sources: vec![receiver],
                source_name: Some("receiver"),
                dark_name: Some("unimportant"),
                walls: walls.cloned(),
                overlays,
                cell,
                ..light::Request::default()
            };
            light::picture(&importance.energy().map(|e| e / tigereye_core::math::TAU), request)
        }
    }
}
