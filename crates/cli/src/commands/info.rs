//! `tigereye info`: what a tensor field holds and how it was read.

use crate::args::reading::InfoArgs;
use crate::commands::{lattice, print_json, print_text};
use crate::error::CliError;
use crate::input::{Input, Source};
use crate::{files, geometry, interrupt};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;
use tigereye_core::{Anisotropy, Eigenvalues, Field, Svd, Symmetry, Tensor2, is_totally_anisotropic};
use tigereye_input::{Content, Reading, TensorFile, suggested_local_above};
use tigereye_io::volume::lattice_from_image;
use tigereye_io::{ChoiceError, DataArray, IoError, PROVENANCE, Rows, Wanted, vti};
use tigereye_lines::is_complex;

/// Relative difference of the semi-axes below which a tensor counts as degenerate: files hold single precision.
const DEGENERATE_BELOW: f64 = 1e-6;

pub(crate) fn info(args: &InfoArgs) -> Result<u8, CliError> {
    if let Some(facts) = facts_of_result(args)? {
        if args.json {
            print_json(&facts)?;
        } else {
            print_text(&result_as_text(&facts))?;
        }
        return Ok(0);
    }
    let source = Source::open(&args.input, &args.reading)?;
    let volume = match &source {
        Source::Generated(_) => None,
        Source::File(file) => Some(match &file.content {
            Content::Tensors(volume) => lattice::facts(file, volume),
            Content::Numbers(numbers) => lattice::number_facts(file, numbers),
        }),
    };
    interrupt::check()?;
    // A volume without a chosen plane is described as a whole, and so are numbers that make no tensors.
    let numbers = matches!(&source, Source::File(TensorFile { content: Content::Numbers(_), .. }));
    let is_plane = source.has_plane(&args.reading) && (!numbers || args.reading.reading().derive.is_some());
    let plane = is_plane.then(|| Input::of(source, &args.reading)).transpose()?;
    if !args.json {
        let text = match (&volume, &plane) {
            (_, Some(plane)) => as_text(&facts(plane)),
            (Some(volume), None) => lattice::as_text(volume),
            (None, None) => String::new(),
        };
        print_text(&text)?;
        return Ok(0);
    }
    match (volume, plane) {
        (volume, Some(p)) => {
            let mut all = facts(&p);
            if let (Some(volume), Some(all)) = (volume, all.as_object_mut()) {
                all.insert("volume".to_owned(), volume);
            }
            print_json(&all)?;
        }
        (Some(volume), None) => print_json(&volume)?,
        (None, None) => {}
    }
    Ok(0)
}

/// Image data without tensors, such as a gradient volume or a light distribution: its arrays and, where there is one,
/// its provenance.
fn facts_of_result(args: &InfoArgs) -> Result<Option<Value>, CliError> {
    let path = Path::new(&args.input);
    if files::extension(path) != "vti" || args.reading.reading() != Reading::default() {
        return Ok(None);
    }
    let image = vti::read(&files::read(path)?).map_err(|e| CliError::input(&args.input, e))?;
    if !matches!(
        lattice_from_image(&image, None, Wanted::Tensors),
        Err(IoError::Choice(ChoiceError::NoArray { .. }))
    ) {
        return Ok(None);
    }
    let arrays: Vec<Value> = image.point_arrays.iter().map(array_facts).collect();
    Ok(Some(json!({
        "input": args.input,
        "kind": if image.text(PROVENANCE).is_some() { "result of tigereye" } else { "VTK image data" },
        "dimensions": image.dimensions,
        "origin": image.origin,
        "spacing": image.spacing,
        "directions": image.direction.unwrap_or([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        "rows": image.point_arrays.first().map(|a| Rows::of(&image, &a.name).name()),
        "arrays": arrays,
        "provenance": image.text(PROVENANCE).and_then(|t| serde_json::from_str::<Value>(t).ok()),
    })))
}

fn array_facts(array: &DataArray) -> Value {
    let low = array.values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = array.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    json!({ "name": array.name, "components": array.components, "min": low, "max": high })
}

fn result_as_text(facts: &Value) -> String {
    let mut text = format!(
        "{} ({}): no tensor field; {} points, rows {}, origin {}, spacing {}\n",
        facts["input"].as_str().unwrap_or_default(),
        facts["kind"].as_str().unwrap_or_default(),
        facts["dimensions"],
        facts["rows"].as_str().unwrap_or("upwards"),
        facts["origin"],
        facts["spacing"]
    );
    // Writing to a string cannot fail.
    for array in facts["arrays"].as_array().into_iter().flatten() {
        let _ = writeln!(
            text,
            "  {} ({} components): {} to {}",
            array["name"].as_str().unwrap_or_default(),
            array["components"],
            array["min"],
            array["max"]
        );
    }
    if let Some(command) = facts["provenance"]["command"].as_str() {
        let _ = writeln!(text, "  made by: {command}");
    }
    text
}

fn facts(input: &Input) -> Value {
    let field = &input.field;
    let grid = field.grid();
    let symmetry = Symmetry::of(field);
    // What rounding made asymmetric has real eigenvalues.
    let plain = field.without_rounding();
    let complex = plain.values().iter().filter(|t| is_complex(t)).count() as f64 / grid.cells() as f64;
    let [right, up, _] = input.geometry.flat().corner();
    let share = |test: &dyn Fn(&Tensor2) -> bool| {
        field.values().iter().filter(|t| test(t)).count() as f64 / grid.cells() as f64
    };
    json!({
        "input": input.name,
        "kind": input.kind,
        "width": grid.width(),
        "height": grid.height(),
        "dimensions": [grid.width(), grid.height()],
        "cells": grid.cells(),
        "origin": [right, up],
        "spacing": input.geometry.spacing(),
        "geometry": geometry::to_json(&input.geometry),
        "component_order": "xx,xy,yx,yy",
        "frame": "x right, y up, row 0 on top",
        "assumptions": input.assumptions,
        "remarks": input.remarks.iter().chain(&input.oblong).collect::<Vec<_>>(),
        "input_blake3": input.blake3,
        "components": {
            "xx": range(field, Tensor2::xx), "xy": range(field, Tensor2::xy),
            "yx": range(field, Tensor2::yx), "yy": range(field, Tensor2::yy),
        },
        "singular_values": { "s1": range(field, |t| Svd::of(t).s[0]), "s2": range(field, |t| Svd::of(t).s[1]) },
        "planar_anisotropy": range(field, |t| Anisotropy::of(t).planar),
        "fractional_anisotropy": range(field, fractional),
        "fractional_anisotropy_above_1": lattice::above_one(field.values().iter().map(fractional)),
        "fractional_anisotropy_histogram": lattice::histogram(field.values().iter().map(fractional)),
        "negative_eigenvalues_histogram": negative_eigenvalues(field),
        "suggested_local_above": suggested_local_above(field),
        "shares": {
            "zero": share(&Tensor2::is_zero),
            "degenerate": share(&is_degenerate),
            "asymmetric": share(&|t| !symmetry.has_symmetric(t)),
            "complex": complex,
            "indefinite": share(&|t| Eigenvalues::of(t).is_indefinite()),
            "negative": share(&|t| Eigenvalues::of(t).negative() > 0),
            "total_anisotropy": share(&|t| !t.is_zero() && is_totally_anisotropic(t)),
        },
    })
}

/// As of a volume of one layer.
fn fractional(t: &Tensor2) -> f64 {
    Anisotropy::of(t).fractional
}

/// Tensors with none, one and two eigenvalues (real parts) below zero by more than rounding.
fn negative_eigenvalues(field: &Field<Tensor2>) -> [usize; 3] {
    let mut counts = [0; 3];
    for t in field.values() {
        counts[Eigenvalues::of(t).negative()] += 1;
    }
    counts
}

/// Semi-axes of equal length: the direction of the tensor is undefined. Zero tensors are counted apart.
fn is_degenerate(t: &Tensor2) -> bool {
    !t.is_zero() && 1.0 - Svd::of(t).axis_ratio() <= DEGENERATE_BELOW
}

fn range(field: &Field<Tensor2>, f: impl Fn(&Tensor2) -> f64) -> Value {
    let (mut low, mut high, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for v in field.values().iter().map(f) {
        low = low.min(v);
        high = high.max(v);
        sum += v;
    }
    json!({ "min": low, "max": high, "mean": sum / field.grid().cells() as f64 })
}

fn as_text(facts: &Value) -> String {
    let mut text = String::new();
    let number = |v: &Value| v.as_f64().map_or_else(String::new, |x| format!("{x:.6e}"));
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{} ({}): {} x {} cells, spacing {}",
        facts["input"].as_str().unwrap_or_default(),
        facts["kind"].as_str().unwrap_or_default(),
        facts["width"],
        facts["height"],
        facts["spacing"]
    );
    for line in facts["assumptions"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", line.as_str().unwrap_or_default());
    }
    let rows = [
        ("xx", &facts["components"]["xx"]),
        ("xy", &facts["components"]["xy"]),
        ("yx", &facts["components"]["yx"]),
        ("yy", &facts["components"]["yy"]),
        ("s1", &facts["singular_values"]["s1"]),
        ("s2", &facts["singular_values"]["s2"]),
        ("2D", &facts["planar_anisotropy"]),
        ("FA", &facts["fractional_anisotropy"]),
    ];
    for (name, r) in rows {
        let _ = writeln!(
            text,
            "  {name}  min {:>14}  max {:>14}  mean {:>14}",
            number(&r["min"]),
            number(&r["max"]),
            number(&r["mean"])
        );
    }
    text += "  2D: anisotropy of the semi-axes, |s1 - s2| / sqrt(s1^2 + s2^2); FA: as of a volume with a third row and column \
             of zeros\n";
    text += &lattice::shares_as_text(facts);
    if let Some(fraction) = facts["suggested_local_above"].as_f64() {
        let _ = writeln!(
            text,
            "  threshold between weak and strong cells: {fraction:.3} of the largest transmission: --normalization local-above:{fraction:.3}"
        );
    }
    for remark in facts["remarks"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", remark.as_str().unwrap_or_default());
    }
    text
}
