//! What a volume holds, for `info`.

use crate::commands::{in_digits, in_lengths};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use tigereye_input::{Range, TensorFile, VolumeFacts};
use tigereye_io::volume::{Lattice, TensorVolume};

/// A range of numbers as JSON.
pub(super) fn range(range: &Range) -> Value {
    json!({ "min": range.min, "max": range.max, "mean": range.mean() })
}

/// Shares by their names as JSON.
pub(super) fn shares(shares: &[(&str, f64)]) -> Value {
    shares.iter().map(|(name, share)| ((*name).to_owned(), json!(share))).collect::<Map<_, _>>().into()
}

/// Everything about a volume of tensors.
pub(super) fn facts(file: &TensorFile, volume: &TensorVolume) -> Value {
    let (order, frame) = (volume.order(), volume.frame());
    let found = VolumeFacts::of(volume);
    let mut facts = about(&file.name, file.kind, &file.blake3, volume.lattice());
    let more = json!({
        "component_order": order.0.to_string(),
        "component_order_is": order.1.words(),
        "frame": frame.0.name(),
        "frame_is": frame.1.words(),
        "assumptions": volume.story(),
        "range": range(&found.components),
        "mean_trace": found.mean_trace,
        "zero_tensors": found.zero,
        "masked": volume.masked_out(),
        "eigenvalues": found.eigenvalues.each_ref().map(range),
        "fractional_anisotropy": range(&found.fractional_anisotropy.range),
        "negative_eigenvalues_histogram": found.negative_eigenvalues,
        "fractional_anisotropy_above_1": found.fractional_anisotropy.above_one,
        "fractional_anisotropy_histogram": found.fractional_anisotropy.histogram,
        "shares": shares(&found.shares),
        "warning": file.warning(),
        "remarks": file.remarks(),
    });
    merge(&mut facts, more);
    facts
}

/// Everything about an image of numbers or vectors.
pub(super) fn number_facts(file: &TensorFile, lattice: &Lattice) -> Value {
    let values = Range::of(lattice.values.iter().copied());
    let mut facts = about(&file.name, file.kind, &file.blake3, lattice);
    let mut story = lattice.story();
    story.extend(file.words_of_vectors());
    story.extend(lattice.warnings.iter().map(|w| format!("WARNING: {w}")));
    story.push("no tensors; commands that take tensors need --derive".to_owned());
    let more = json!({ "assumptions": story, "range": range(&values) });
    merge(&mut facts, more);
    facts
}

fn about(name: &str, kind: &str, blake3: &str, lattice: &Lattice) -> Value {
    json!({
        "input": name,
        "kind": kind,
        "dimensions": lattice.size,
        "cells": lattice.voxels(),
        "components": lattice.components,
        "origin": lattice.origin,
        "spacing": lattice.spacing(),
        "directions": lattice.directions(),
        "input_blake3": blake3,
    })
}

fn merge(facts: &mut Value, more: Value) {
    if let (Some(all), Value::Object(more)) = (facts.as_object_mut(), more) {
        all.extend(more);
    }
}

/// The facts for people.
pub(super) fn as_text(facts: &Value) -> String {
    let size = |i: usize| facts["dimensions"][i].as_u64().unwrap_or(0);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{} ({}): {} x {} x {} voxels, spacing {}",
        facts["input"].as_str().unwrap_or_default(),
        facts["kind"].as_str().unwrap_or_default(),
        size(0),
        size(1),
        size(2),
        in_lengths(&facts["spacing"])
    );
    for line in facts["assumptions"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", line.as_str().unwrap_or_default());
    }
    let number = |v: &Value| v.as_f64().map_or_else(|| "-".to_owned(), in_digits);
    let rows = [
        ("components", &facts["range"]),
        ("l1", &facts["eigenvalues"][0]),
        ("l2", &facts["eigenvalues"][1]),
        ("l3", &facts["eigenvalues"][2]),
        ("FA", &facts["fractional_anisotropy"]),
    ];
    for (name, r) in rows.into_iter().filter(|(_, r)| r.is_object()) {
        let (min, max, mean) = (number(&r["min"]), number(&r["max"]), number(&r["mean"]));
        let _ = writeln!(text, "  {name:<10}  min {min:>14}  max {max:>14}  mean {mean:>14}");
    }
    text += &shares_as_text(facts);
    for remark in facts["remarks"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", remark.as_str().unwrap_or_default());
    }
    text
}

/// The histogram and the shares, a line each.
pub(super) fn shares_as_text(facts: &Value) -> String {
    let mut text = String::new();
    if let Some(bars) = facts["fractional_anisotropy_histogram"].as_array() {
        let counts: Vec<String> = bars.iter().map(Value::to_string).collect();
        let above = facts["fractional_anisotropy_above_1"].as_u64().filter(|n| *n > 0);
        let above =
            above.map_or_else(String::new, |n| format!(", and {n} above 1 (indefinite symmetric parts)"));
        let _ = writeln!(text, "  FA from 0 to 1 in steps of 0.1: {}{above}", counts.join(" "));
    }
    if let Some(bars) = facts["negative_eigenvalues_histogram"].as_array() {
        let counts: Vec<String> = bars.iter().map(Value::to_string).collect();
        let numbers: Vec<String> = (0..bars.len()).map(|n| n.to_string()).collect();
        let _ = writeln!(
            text,
            "  tensors with {} negative eigenvalues: {}{}",
            numbers.join(", "),
            counts.join(", "),
            match facts["shares"]["complex"].as_f64() {
                Some(share) if share > 0.0 => " (complex ones have no sign)",
                _ => "",
            }
        );
    }
    for (name, share) in facts["shares"].as_object().into_iter().flatten() {
        let percent = share.as_f64().unwrap_or(0.0) * 100.0;
        let _ = writeln!(text, "  {:<18} {percent:.2} %", name.replace('_', " "));
    }
    text
}
