//! What a volume holds, for `info`.

use serde_json::{Value, json};
use std::fmt::Write as _;
use tigereye_core::{Eigenvalues, Symmetry, fractional_anisotropy3, symmetric_eigenvalues3};
use tigereye_input::TensorFile;
use tigereye_io::volume::{Lattice, TensorVolume};

/// An eigenvalue below this times the largest component counts as negative: files hold single precision.
const ROUNDING: f64 = Eigenvalues::ROUNDING;
/// Relative difference of two eigenvalues below which a tensor counts as degenerate.
const DEGENERATE_BELOW: f64 = 1e-6;
/// What rounding may add to an anisotropy of 1; indefinite tensors have more.
const FA_ROUNDING: f64 = 1e-9;
/// Bars of a histogram over 0 to 1.
const BARS: usize = 10;

/// Smallest, largest and mean value.
struct Range {
    min: f64,
    max: f64,
    sum: f64,
    count: usize,
}

impl Range {
    const EMPTY: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY, sum: 0.0, count: 0 };

    fn add(&mut self, value: f64) {
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        self.sum += value;
        self.count += 1;
    }

    fn json(&self) -> Value {
        json!({ "min": self.min, "max": self.max, "mean": self.sum / self.count.max(1) as f64 })
    }
}

/// Counts of values from 0 to 1 in ten bars; what is no number or outside is left out.
pub(super) fn histogram(values: impl Iterator<Item = f64>) -> Vec<usize> {
    let mut bars = vec![0; BARS];
    for v in values.filter(|v| (-FA_ROUNDING..=1.0 + FA_ROUNDING).contains(v)) {
        bars[((v * BARS as f64) as usize).min(BARS - 1)] += 1;
    }
    bars
}

/// How many values lie above 1.
pub(super) fn above_one(values: impl Iterator<Item = f64>) -> usize {
    values.filter(|v| *v > 1.0 + FA_ROUNDING).count()
}

/// Everything about a volume of tensors.
pub(super) fn facts(file: &TensorFile, volume: &TensorVolume) -> Value {
    let lattice = volume.lattice();
    let (order, frame) = (volume.order(), volume.frame());
    let (mut numbers, mut trace) = (Range::EMPTY, Range::EMPTY);
    let mut eigenvalues = [Range::EMPTY, Range::EMPTY, Range::EMPTY];
    let mut anisotropy = Vec::with_capacity(lattice.voxels());
    // Tensors by their number of negative eigenvalues.
    let mut signs = [0_usize; 4];
    let [mut zero, mut strange, mut degenerate, mut asymmetric, mut indefinite, mut negative] = [0_usize; 6];
    let measured = || (0..lattice.voxels()).filter_map(|voxel| volume.measured(voxel));
    let finite = |t: &[f64; 9]| t.iter().all(|v| v.is_finite());
    let largest_of_all = measured().filter(finite).flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    for t in measured() {
        if !t.iter().all(|v| v.is_finite()) {
            strange += 1;
            continue;
        }
        let largest = t.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        t.iter().for_each(|&v| numbers.add(v));
        trace.add(t[0] + t[4] + t[8]);
        let l = symmetric_eigenvalues3(&t);
        eigenvalues.iter_mut().zip(l).for_each(|(range, v)| range.add(v));
        anisotropy.push(fractional_anisotropy3(l));
        let off = (t[1] - t[3]).abs().max((t[2] - t[6]).abs()).max((t[5] - t[7]).abs());
        zero += usize::from(largest == 0.0);
        let close = (l[0] - l[1]).min(l[1] - l[2]) <= DEGENERATE_BELOW * largest;
        degenerate += usize::from(largest > 0.0 && close);
        asymmetric += usize::from(off > Symmetry::ROUNDING * largest_of_all);
        let below = l.iter().filter(|v| **v < -ROUNDING * largest).count();
        signs[below] += 1;
        negative += usize::from(below > 0);
        indefinite += usize::from(l[2] < -ROUNDING * largest && l[0] > ROUNDING * largest);
    }
    let voxels = measured().count().max(1);
    let share = |n: usize| n as f64 / voxels as f64;
    let mut fa = Range::EMPTY;
    anisotropy.iter().for_each(|&v| fa.add(v));
    let mut facts = about(&file.name, file.kind, &file.blake3, lattice);
    let more = json!({
        "component_order": order.0.to_string(),
        "component_order_is": order.1.words(),
        "frame": frame.0.name(),
        "frame_is": frame.1.words(),
        "assumptions": volume.story(),
        "range": numbers.json(),
        "mean_trace": trace.sum / trace.count.max(1) as f64,
        "zero_tensors": zero,
        "masked": volume.masked_out(),
        "eigenvalues": eigenvalues.each_ref().map(Range::json),
        "fractional_anisotropy": fa.json(),
        "negative_eigenvalues_histogram": signs,
        "fractional_anisotropy_above_1": above_one(anisotropy.iter().copied()),
        "fractional_anisotropy_histogram": histogram(anisotropy.into_iter()),
        "shares": {
            "zero": share(zero),
            "not_finite": share(strange),
            "degenerate": share(degenerate),
            "asymmetric": share(asymmetric),
            "indefinite": share(indefinite),
            "negative": share(negative),
        },
        "warning": file.warning(),
        "remarks": file.remarks(),
    });
    merge(&mut facts, more);
    facts
}

/// Everything about an image of numbers or vectors.
pub(super) fn number_facts(file: &TensorFile, lattice: &Lattice) -> Value {
    let mut range = Range::EMPTY;
    lattice.values.iter().for_each(|&v| range.add(v));
    let mut facts = about(&file.name, file.kind, &file.blake3, lattice);
    let mut story = lattice.story();
    if lattice.components > 1 {
        let (frame, known) = lattice.frame;
        story.push(format!("vectors along {} ({})", frame.words(), known.words()));
    }
    story.extend(lattice.warnings.iter().map(|w| format!("WARNING: {w}")));
    story.push("no tensors; commands that take tensors need --derive".to_owned());
    let more = json!({ "assumptions": story, "range": range.json() });
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
        facts["spacing"]
    );
    for line in facts["assumptions"].as_array().into_iter().flatten() {
        let _ = writeln!(text, "  {}", line.as_str().unwrap_or_default());
    }
    let number = |v: &Value| v.as_f64().map_or_else(|| "-".to_owned(), |x| format!("{x:.6e}"));
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
            "  tensors with {} negative eigenvalues: {}",
            numbers.join(", "),
            counts.join(" ")
        );
    }
    for (name, share) in facts["shares"].as_object().into_iter().flatten() {
        let percent = share.as_f64().unwrap_or(0.0) * 100.0;
        let _ = writeln!(text, "  {:<18} {percent:.2} %", name.replace('_', " "));
    }
    text
}
