//! `tigereye propagate --towards`: where the light at a receiver comes from.

use crate::args::light::{Picture, PropagateArgs};
use crate::commands::drawing::{self, is_picture};
use crate::commands::light_options::{cell_and_profile, parameters};
use crate::commands::overlaid::Overlaid;
use crate::commands::{advice, command_line, print_json, print_text};
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
use tigereye_render::{HeatOptions, PolarOptions, Scene, Style, TransmissionScale, heat_map, polar_overlay};
use tigereye_transport::{LinearScattering, Scattering, ScatteringRule, StoppingRule, TransportError};
use tigereye_views::added::{Additions, Scalars};
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
    (style, overlaid): (&Style, &Overlaid),
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
        let problem = "importance has no steps to show: expected .vti, .npy, .png, .svg or .pdf";
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
    let parameters = parameters(args, &[], &stopping, input, rule);
    let rows = Rows::of_results(input.geometry());
    let story = provenance(&command_line(), &with_rows(parameters, rows), input.blake3());
    for output in &args.outputs {
        let drawn =
            || picture(args, input, &transmission, &importance, (cell, thin.as_ref()), (style, overlaid));
        let fault = |e: &dyn std::fmt::Display| CliError::input(&output.display().to_string(), e);
        let bytes = match files::extension(Path::new(output)).as_str() {
            _ if is_picture(output) => drawing::encoded(&drawn()?, output, style)?,
            "npy" => npy::write_light(&importance),
            _ => {
                let image = tigereye_io::image_from_light(&importance, input.geometry(), &story);
                vti::write(&image).map_err(|e| fault(&e))?
            }
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
    (style, overlaid): (&Style, &Overlaid),
) -> Result<Scene, CliError> {
    let mean = importance.energy().map(|e| e / tigereye_core::math::TAU);
    let scalars = Scalars { values: &mean, samples: 1 };
    let Additions { mut overlays, glyphs } =
        overlaid.additions(input.tensors(), &input.placement(), Some(scalars))?;
    // Beneath the others.
    overlays.splice(0..0, thin.map(ThinCells::overlay));
    let (title, walls) =
        (format!("importance for ({}, {}): {}", receiver.x, receiver.y, input.title()), input.surfaces());
    let cell = CellShape::of(input.geometry().spacing());
    Ok(match args.picture {
        Picture::Overlay => {
            let options = PolarOptions {
                overlays,
                title,
                sources: vec![receiver],
                source_name: "receiver",
                quantity: "importance",
                walls: walls.cloned(),
                transmission: TransmissionScale::Rate,
                cell,
                masked: input.masked(),
                style: style.clone(),
                ..PolarOptions::default()
            };
            polar_overlay(Some(transmission), Some(importance), &options)
        }
        Picture::Energy => {
            let options = HeatOptions {
                overlays,
                glyphs,
                title,
                sources: vec![receiver],
                walls: walls.cloned(),
                cell,
                masked: input.masked(),
                style: style.clone(),
                ..light::importance_options(Some(DECADES))
            };
            heat_map(&mean, &options)
        }
    })
}
