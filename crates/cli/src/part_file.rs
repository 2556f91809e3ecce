//! `.part` files: what a shard leaves, and checkpoints.

use crate::error::CliError;
use crate::{files, geometry};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::Path;
use tigereye_core::{Directions, Grid, LtgVolume, SweepWork, TotalAnisotropy};
use tigereye_input::provenance::VERSION;
use tigereye_io::part;
use tigereye_io::volume::PlaneGeometry;
use tigereye_ltg::{Estimate, Finished, LtgError, NUMERICS, PartialVolume, Shard, SketchShape, SketchSums};
use tigereye_views::total_anisotropy::ThinCells;

/// Parameters that do not show in the result. The input and its mask are known by their hash; what they are called may
/// change.
const FREE: [&str; 4] = ["threads", "memory", "input", "mask"];

/// The parameter that says which cells are totally anisotropic; in the header, the cells.
const THIN: &str = "total_anisotropy";

/// What determines the numbers of a part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Identity {
    pub(crate) version: String,
    /// [`tigereye_ltg::NUMERICS`] of that program.
    pub(crate) numerics: u64,
    /// All parameters, resolved, under the names of the options.
    pub(crate) parameters: Value,
    pub(crate) input_blake3: String,
    /// Where the input's cells lie. It shows in the files, though not in the numbers.
    pub(crate) geometry: PlaneGeometry,
    /// The totally anisotropic cells, which pictures outline. They follow from the input and the parameters.
    pub(crate) thin: Option<ThinCells>,
}

/// What a computation cost beside its counters.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Costs {
    /// Seconds in all, and those that threads spent with propagations and differences, divided by their number.
    pub(crate) total: f64,
    pub(crate) propagation: f64,
    pub(crate) difference: f64,
    pub(crate) peak_memory: Option<u64>,
    pub(crate) threads: usize,
    pub(crate) backend: String,
}

/// A part as read.
#[derive(Clone, Debug)]
pub(crate) struct PartFile {
    pub(crate) identity: Identity,
    pub(crate) shard: Shard,
    pub(crate) costs: Costs,
    pub(crate) content: Content,
}

/// What is finished of a gradient.
#[derive(Clone, Debug)]
pub(crate) enum Content {
    /// Differences of the exact gradient.
    Exact(PartialVolume),
    /// Sketches of it.
    Sketched(SketchSums),
}

/// A finished gradient, with the standard error of its values if it is an estimate.
pub(crate) struct Gradient {
    pub(crate) volume: LtgVolume,
    pub(crate) error: Option<LtgVolume>,
}

/// What parts and checkpoints keep.
pub(crate) trait Kept {
    /// How much of a shard is missing: cells and sets of directions, or batches of sketches.
    fn missing(&self, shard: Shard) -> usize;
    /// What its parts are called.
    fn unit(&self) -> &'static str;
    /// Numbers, and for each part whether it is in them.
    fn numbers(&self) -> (Cow<'_, [f64]>, &[bool]);
    /// The summary, as `--json` prints it.
    fn summary(&self, identity: &Identity, costs: &Costs) -> Value;
}

impl Content {
    pub(crate) fn kept(&self) -> &dyn Kept {
        match self {
            Self::Exact(volume) => volume,
            Self::Sketched(sums) => sums,
        }
    }

    pub(crate) fn exact(self) -> Option<PartialVolume> {
        match self {
            Self::Exact(volume) => Some(volume),
            Self::Sketched(_) => None,
        }
    }

    pub(crate) fn sketched(self) -> Option<SketchSums> {
        match self {
            Self::Exact(_) => None,
            Self::Sketched(sums) => Some(sums),
        }
    }

    /// The shards of `count` that lack something, ascending.
    pub(crate) fn missing_shards(&self, count: usize) -> Vec<usize> {
        match self {
            Self::Exact(volume) => volume.missing_shards(count),
            Self::Sketched(sums) => sums.missing_shards(count),
        }
    }

    pub(crate) fn merged(self, other: &Self) -> Result<Self, LtgError> {
        match (self, other) {
            (Self::Exact(one), Self::Exact(other)) => one.merged(other).map(Self::Exact),
            (Self::Sketched(one), Self::Sketched(other)) => one.merged(other).map(Self::Sketched),
            _ => Err(LtgError::Unlike { what: "methods: one is exact, one an estimate" }),
        }
    }

    /// As far as it is finished: other values are NaN. An estimate has a value everywhere, of fewer sketches.
    pub(crate) fn into_partial_gradient(self) -> Result<Gradient, LtgError> {
        match self {
            Self::Exact(volume) => Ok(Gradient { volume: volume.into_partial_volume(), error: None }),
            sketched => sketched.into_gradient(),
        }
    }

    pub(crate) fn into_gradient(self) -> Result<Gradient, LtgError> {
        match self {
            Self::Exact(volume) => Ok(Gradient { volume: volume.into_outcome()?.volume, error: None }),
            Self::Sketched(sums) => {
                let Estimate { volume, error, .. } = sums.estimate()?;
                Ok(Gradient { volume, error: Some(error) })
            }
        }
    }
}

impl Identity {
    /// The identity of this program's work.
    pub(crate) fn new(
        parameters: &Value,
        input_blake3: &str,
        geometry: PlaneGeometry,
        thin: Option<ThinCells>,
    ) -> Self {
        // Numbers as a reader gets them, so that equal ones compare equal.
        let parameters = serde_json::from_str(&parameters.to_string()).unwrap_or_default();
        Self {
            version: VERSION.to_owned(),
            numerics: NUMERICS.into(),
            parameters,
            input_blake3: input_blake3.to_owned(),
            // What lies nowhere has no other geometry in files.
            geometry: if geometry.is_placed() { geometry } else { PlaneGeometry::UNPLACED },
            thin,
        }
    }

    /// What is wrong with the version, if it is not this program's: the layout of a part follows from the program.
    pub(crate) fn foreign_version(&self) -> Option<String> {
        let own = Self::program(VERSION, NUMERICS.into());
        let found = Self::program(&self.version, self.numerics);
        (found != own).then(|| format!("was made by {found}; expected a part of {own}"))
    }

    fn program(version: &str, numerics: u64) -> String {
        format!("tigereye {version} (numerics {numerics})")
    }

    /// The first difference that shows in the result, as its name and its values here and there.
    pub(crate) fn difference(&self, other: &Self) -> Option<(String, String, String)> {
        let programs = [self, other].map(|i| Self::program(&i.version, i.numerics));
        if programs[0] != programs[1] {
            let [here, there] = programs;
            return Some(("the version of tigereye".to_owned(), here, there));
        }
        if self.input_blake3 != other.input_blake3 {
            return Some(("the input".to_owned(), self.input(), other.input()));
        }
        if self.geometry != other.geometry {
            let [here, there] = [self, other].map(|i| geometry::to_json(&i.geometry).to_string());
            return Some(("the place of the input".to_owned(), here, there));
        }
        let names =
            |p: &Value| p.as_object().map(|o| o.keys().cloned().collect::<Vec<_>>()).unwrap_or_default();
        let mut all = [names(&self.parameters), names(&other.parameters)].concat();
        // What others follow from is named first.
        let follows = |n: &String| !matches!(n.as_str(), "scattering" | "estimate" | "stop");
        all.sort_by_key(|n| (follows(n), n.clone()));
        all.dedup();
        // What is null was not asked for, as what is absent.
        let given = |p: &Value, name: &str| p.get(name).filter(|v| !v.is_null()).cloned();
        // Parts from before the option have its usual value.
        let usual = |name: &str| (name == THIN).then(|| json!(TotalAnisotropy::PUBLISHED.to_string()));
        let get = |p: &Value, name: &str| given(p, name).or_else(|| usual(name));
        let differs =
            |n: &String| !FREE.contains(&n.as_str()) && get(&self.parameters, n) != get(&other.parameters, n);
        let name = all.into_iter().find(differs)?;
        let value = |p: &Value| get(p, &name).map_or_else(|| "none".to_owned(), |v| plain(&v));
        let option = format!("--{}", name.replace('_', "-"));
        Some((option, value(&self.parameters), value(&other.parameters)))
    }

    fn input(&self) -> String {
        format!("{} (BLAKE3 {})", plain(&self.parameters["input"]), self.input_blake3)
    }
}

/// A value as on the command line, nearly.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(list) => list.iter().map(plain).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

impl Kept for PartialVolume {
    fn missing(&self, shard: Shard) -> usize {
        Self::missing(self, shard)
    }
    fn unit(&self) -> &'static str {
        "cells and sets"
    }
    fn numbers(&self) -> (Cow<'_, [f64]>, &[bool]) {
        (Cow::Borrowed(&self.finished().squares), &self.finished().done)
    }

    fn summary(&self, identity: &Identity, costs: &Costs) -> Value {
        let finished = self.finished();
        let work = &finished.work;
        let mut summary = common_summary(
            self.grid(),
            self.directions(),
            || finished.squares.iter().map(|square| square.sqrt()),
            identity,
            costs,
        );
        summary["sources"] = json!(work.sources);
        summary["iterations_total"] = json!(work.iterations_total);
        summary["iterations_max"] = json!(work.iterations_max);
        summary["cell_updates"] = json!(work.cell_updates);
        summary["limited"] = json!(finished.limited);
        summary
    }
}

impl Kept for SketchSums {
    fn missing(&self, shard: Shard) -> usize {
        Self::missing(self, shard)
    }
    fn unit(&self) -> &'static str {
        "batches of sketches"
    }
    fn numbers(&self) -> (Cow<'_, [f64]>, &[bool]) {
        (Cow::Owned(self.values()), self.done())
    }

    fn summary(&self, identity: &Identity, costs: &Costs) -> Value {
        let shape = self.shape();
        let estimate = self.estimate().ok();
        let values = || estimate.iter().flat_map(|e| e.volume.values().iter().copied());
        let mut summary = common_summary(shape.grid, shape.directions, values, identity, costs);
        summary["estimate"] = json!(self.sketches());
        summary["seed"] = json!(shape.seed);
        summary["relative_error"] = json!(estimate.as_ref().map(|e| e.relative_error));
        // Solved directly: one solution per sketch, and no sweep.
        summary["solutions"] = json!(self.sketches());
        summary["sweeps"] = json!(0);
        summary["every_sample"] = json!(shape.every_sample);
        summary
    }
}

/// What summaries of all gradients say.
fn common_summary<I: Iterator<Item = f64>>(
    grid: Grid,
    directions: Directions,
    values: impl Fn() -> I,
    identity: &Identity,
    costs: &Costs,
) -> Value {
    let mut summary = json!({
        "width": grid.width(),
        "height": grid.height(),
        "directions": directions.count(),
        "seconds": {
            "total": costs.total,
            "propagation": costs.propagation,
            "difference": costs.difference,
        },
        "peak_memory_bytes": costs.peak_memory,
        "threads": costs.threads,
        "precision": identity.parameters["precision"],
        "backend": costs.backend,
        "max": values().fold(0.0, f64::max),
        "mean": values().sum::<f64>() / values().count().max(1) as f64,
    });
    if let Some(thin) = &identity.thin {
        summary["total_anisotropy_share"] = json!(thin.share());
    }
    summary
}

/// The bytes of a part.
pub(crate) fn encoded(
    command: &str,
    identity: &Identity,
    shard: Shard,
    kept: &dyn Kept,
    costs: &Costs,
) -> Vec<u8> {
    let mut header = json!({
        "version": identity.version,
        "numerics": identity.numerics,
        "command": command,
        "parameters": identity.parameters,
        "input_blake3": identity.input_blake3,
        "geometry": geometry::to_json(&identity.geometry),
        "shard": shard.to_string(),
        "summary": kept.summary(identity, costs),
    });
    if let Some(thin) = &identity.thin {
        header[THIN] = json!(thin.runs());
    }
    let (values, done) = kept.numbers();
    part::write(&header.to_string(), &values, done)
}

/// Reads a part.
pub(crate) fn read(path: &Path) -> Result<PartFile, CliError> {
    let name = path.display().to_string();
    let bytes = files::read(path)?;
    let part = part::read(&bytes).map_err(|e| CliError::input(&name, e))?;
    drop(bytes);
    decoded(part).map_err(|(byte, problem)| CliError::input(&name, format!("byte {byte}: {problem}")))
}

/// A part's meaning, or the byte of the header or values that has none, and why.
fn decoded(part: part::Part) -> Result<PartFile, (usize, String)> {
    let start = part::HEADER_START;
    let header: Value = serde_json::from_str(&part.header).map_err(|e| {
        // The header is one line.
        (start + e.column().saturating_sub(1), format!("expected a JSON object as header: {e}"))
    })?;
    let lacks = |what: &str| (start, format!("expected {what} in the header"));
    let text = |pointer: &str| {
        let text = header.pointer(pointer).and_then(Value::as_str);
        text.map(str::to_owned).ok_or_else(|| lacks(&format!("a text at {pointer}")))
    };
    let integer = |pointer: &str| {
        let number = header.pointer(pointer).and_then(Value::as_u64);
        number.ok_or_else(|| lacks(&format!("a whole number at {pointer}")))
    };
    let size = |pointer: &str| {
        usize::try_from(integer(pointer)?).map_err(|_| lacks(&format!("a smaller number at {pointer}")))
    };
    let number = |pointer: &str| {
        let number = header.pointer(pointer).and_then(Value::as_f64);
        number.ok_or_else(|| lacks(&format!("a number at {pointer}")))
    };
    let meaning = |e: &dyn std::fmt::Display| (start, format!("the header cannot be interpreted: {e}"));
    let slices = header.pointer("/parameters/slices").and_then(Value::as_array);
    let slices: Option<Vec<usize>> =
        slices.and_then(|s| s.iter().map(|t| t.as_u64().and_then(|t| usize::try_from(t).ok())).collect());
    let slices = slices.ok_or_else(|| lacks("whole numbers at /parameters/slices"))?;
    let grid = Grid::new(size("/summary/width")?, size("/summary/height")?).map_err(|e| meaning(&e))?;
    let directions = Directions::new(size("/parameters/directions")?).map_err(|e| meaning(&e))?;
    let omega_step = size("/parameters/omega_step")?;
    let sketches = header.pointer("/parameters/estimate").filter(|n| !n.is_null());
    let content = if sketches.is_some() {
        let sketches = integer("/parameters/estimate")?;
        let shape = SketchShape {
            grid,
            directions,
            slices,
            omega_step,
            every_sample: header.pointer("/summary/every_sample").and_then(Value::as_bool) == Some(true),
            sketches: u32::try_from(sketches)
                .map_err(|_| lacks("a smaller number at /parameters/estimate"))?,
            seed: integer("/parameters/seed")?,
        };
        SketchSums::restored(shape, &part.values, part.marks).map(Content::Sketched)
    } else {
        let work = SweepWork {
            sources: integer("/summary/sources")?,
            iterations_total: integer("/summary/iterations_total")?,
            iterations_max: integer("/summary/iterations_max")?,
            cell_updates: integer("/summary/cell_updates")?,
        };
        let limited = integer("/summary/limited")?;
        let finished = Finished { squares: part.values, done: part.marks, work, limited };
        PartialVolume::restored(grid, directions, slices, omega_step, finished).map(Content::Exact)
    };
    let content = content.map_err(|e| match e {
        // Where the numbers are counted.
        LtgError::Length { what, .. } => (if what == "marks" { 32 } else { 24 }, e.to_string()),
        e => meaning(&e),
    })?;
    let shard = text("/shard")?;
    let shard =
        crate::args::values::parse_shard(&shard).map_err(|e| lacks(&format!("a shard at /shard: {e}")))?;
    let thin = header.get(THIN).map(|runs| {
        let rule = header["parameters"][THIN].as_str().and_then(|rule| rule.parse().ok());
        let runs: Option<Vec<usize>> = serde_json::from_value(runs.clone()).ok();
        ThinCells::from_runs(grid, &runs?, rule?)
    });
    let lengths = || lacks(&format!("the lengths of runs of {} cells at /{THIN}", grid.cells()));
    let thin = thin.map(|thin| thin.ok_or_else(lengths)).transpose()?;
    Ok(PartFile {
        identity: Identity {
            version: text("/version")?,
            // Parts from before the count have none.
            numerics: header["numerics"].as_u64().unwrap_or(0),
            parameters: header["parameters"].clone(),
            input_blake3: text("/input_blake3")?,
            geometry: geometry::from_json(header.get("geometry"))
                .ok_or_else(|| lacks("numbers of a place at /geometry"))?,
            thin,
        },
        shard,
        costs: Costs {
            total: number("/summary/seconds/total")?,
            propagation: number("/summary/seconds/propagation")?,
            difference: number("/summary/seconds/difference")?,
            peak_memory: header.pointer("/summary/peak_memory_bytes").and_then(Value::as_u64),
            threads: size("/summary/threads")?,
            backend: text("/summary/backend")?,
        },
        content,
    })
}
