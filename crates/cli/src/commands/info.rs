//! `tigereye info`: what a tensor field holds and how it was read.

use crate::args::reading::InfoArgs;
use crate::commands::{in_digits, in_lengths, lattice, print_json, print_text};
use crate::error::CliError;
use crate::input::{Input, Source};
use crate::{files, geometry, interrupt};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;
use tigereye_input::{Content, FieldFacts, Range, Reading, TensorFile, suggested_local_above};
use tigereye_io::volume::lattice_from_image;
use tigereye_io::{ChoiceError, DataArray, IoError, PROVENANCE, Rows, Wanted, vti};

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
    let Range { min, max, .. } = Range::of(array.values.iter().copied());
    json!({ "name": array.name, "components": array.components, "min": min, "max": max })
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
    let grid = input.field.grid();
    let facts = FieldFacts::of(&input.field);
    let [xx, xy, yx, yy] = facts.components.each_ref().map(lattice::range);
    let [s1, s2] = facts.singular_values.each_ref().map(lattice::range);
    let [right, up, _] = input.geometry.flat().corner();
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
        "components": { "xx": xx, "xy": xy, "yx": yx, "yy": yy },
        "singular_values": { "s1": s1, "s2": s2 },
        "planar_anisotropy": lattice::range(&facts.planar_anisotropy),
        "fractional_anisotropy": lattice::range(&facts.fractional_anisotropy.range),
        "fractional_anisotropy_above_1": facts.fractional_anisotropy.above_one,
        "fractional_anisotropy_histogram": facts.fractional_anisotropy.histogram,
        "negative_eigenvalues_histogram": facts.negative_eigenvalues,
        "suggested_local_above": suggested_local_above(&input.field),
        "shares": lattice::shares(&facts.shares),
    })
}

fn as_text(facts: &Value) -> String {
    let mut text = String::new();
    let number = |v: &Value| v.as_f64().map_or_else(String::new, in_digits);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{} ({}): {} x {} cells, spacing {}",
        facts["input"].as_str().unwrap_or_default(),
        facts["kind"].as_str().unwrap_or_default(),
        facts["width"],
        facts["height"],
        in_lengths(&facts["spacing"])
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
    text += "  2D: anisotropy of the semi-axes, |s1 - s2| / sqrt(s1^2 + s2^2); FA: that of a 3D tensor with a third row and column of zeros\n";
    text += &lattice::shares_as_text(facts);
    if let Some(fraction) = facts["suggested_local_above"].as_f64() {
        let _ = writeln!(
            text,
            "  two groups of cells, weak and strong: --normalization local-above:{fraction:.3} (Otsu) lets only the strong \
             ones transmit"
        );
    }
    for remark in facts["remarks"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", remark.as_str().unwrap_or_default());
    }
    text
}
