//! What a command works on: a file or a generator.

use crate::args::reading::ReadingArgs;
use crate::error::CliError;
use crate::host::FileHost;
use crate::{files, interrupt};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tigereye_core::{Field, Tensor2};
use tigereye_experiments::scene::is_scene_file;
use tigereye_experiments::sources::{defined_plane, is_field_file, load_field, make_plane};
use tigereye_experiments::{SpecError, field_file};
use tigereye_input::provenance::hash_of_field;
use tigereye_input::{Derived, InputError, PlaneField, Reading, TensorFile, is_readable, open};
use tigereye_io::volume::{PlaneGeometry, Shear};

/// What INPUT is, before a plane is chosen.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one at a time")]
pub(crate) enum Source {
    /// A field of a generator or of formulas.
    Generated(Input),
    /// A file: tensors, numbers or vectors on a lattice.
    File(TensorFile),
}

impl Source {
    /// Reads INPUT: a path with a known extension, or a generator.
    pub(crate) fn open(text: &str, reading: &ReadingArgs) -> Result<Self, CliError> {
        if is_scene_file(text) {
            let problem = "a scene has no tensors: expected a tensor field (propagate and ltg take scenes)";
            return Err(CliError::input(text, problem));
        }
        if is_field_file(text) {
            return Input::of_field_file(text, &reading.reading()).map(Self::Generated);
        }
        if !is_readable(text) && !looks_like_a_path(text) {
            return Input::generated(text, &reading.reading()).map(Self::Generated);
        }
        let mut bytes_of = |name: &str| files::read(Path::new(name)).map_err(|e| e.to_string());
        let file = open(text, &reading.reading(), &mut bytes_of).map_err(|e| told(text, e))?;
        // Large inputs take a while.
        interrupt::check()?;
        Ok(Self::File(file))
    }

    /// Refuses outputs that are among the files that were read: the data would be gone.
    pub(crate) fn check_apart(&self, outputs: &[PathBuf]) -> Result<(), CliError> {
        match self {
            Self::Generated(input) => input.check_apart(outputs),
            Self::File(file) => files::check_apart(&file.files, outputs),
        }
    }

    /// Whether the plane is clear without asking.
    pub(crate) fn has_plane(&self, reading: &ReadingArgs) -> bool {
        match self {
            Self::Generated(_) => true,
            Self::File(file) => file.has_plane(&reading.reading()),
        }
    }
}

/// Files that cannot be read name themselves.
fn told(name: &str, error: InputError) -> CliError {
    match error {
        InputError::Unread { words } => CliError::Input(words),
        other => CliError::input(name, other),
    }
}

/// A tensor field with what is known about its origin.
#[derive(Debug)]
pub(crate) struct Input {
    /// As the user wrote it.
    pub(crate) name: String,
    pub(crate) field: Field<Tensor2>,
    /// What was read and what was assumed, a sentence each.
    pub(crate) assumptions: Vec<String>,
    /// What everybody must hear of it: assumptions that the options could replace, and warnings.
    pub(crate) remarks: Vec<String>,
    /// A warning for light, which takes cells as squares, where they are not.
    pub(crate) oblong: Option<String>,
    /// Where its cells lie.
    pub(crate) geometry: PlaneGeometry,
    /// Unit of the coordinates, where the file states it.
    pub(crate) unit: Option<&'static str>,
    /// What a field file calls it.
    pub(crate) title: Option<String>,
    /// Names of the files it was read from.
    pub(crate) files: Vec<String>,
    /// The format or `generator`.
    pub(crate) kind: &'static str,
    /// Hash of the file, or of the generated field.
    pub(crate) blake3: String,
}

const GENERATOR: &str = "generator";
const FIELD_FILE: &str = "field file";

impl Input {
    /// Reads INPUT and takes the plane that the options choose, or the only one. What had to be assumed goes to
    /// standard error.
    pub(crate) fn open(text: &str, reading: &ReadingArgs) -> Result<Self, CliError> {
        let input = Self::of(Source::open(text, reading)?, reading)?;
        input.tell();
        Ok(input)
    }

    /// The field in the plane.
    pub(crate) fn of(source: Source, reading: &ReadingArgs) -> Result<Self, CliError> {
        let file = match source {
            Source::Generated(input) => return Ok(input),
            Source::File(file) => file,
        };
        let plane = file.plane(&reading.reading()).map_err(|e| told(&file.name, e))?;
        let mut remarks = file.remarks();
        remarks.extend(plane.remarks.iter().cloned());
        let input = Self::placed(file.name, plane, remarks, file.kind, file.blake3);
        Ok(Self { files: file.files, ..input })
    }

    fn placed(
        name: String,
        plane: PlaneField,
        remarks: Vec<String>,
        kind: &'static str,
        blake3: String,
    ) -> Self {
        let oblong = plane.oblong();
        let PlaneField { field, story, geometry, unit, .. } = plane;
        Self {
            name,
            field,
            assumptions: story,
            remarks,
            oblong,
            geometry,
            unit,
            title: None,
            files: Vec::new(),
            kind,
            blake3,
        }
    }

    /// What had to be assumed, and what looks wrong, to standard error.
    pub(crate) fn tell(&self) {
        for line in &self.remarks {
            eprintln!("{}: {line}", self.name);
        }
    }

    /// Refuses outputs that are among the files that were read: the data would be gone.
    pub(crate) fn check_apart(&self, outputs: &[PathBuf]) -> Result<(), CliError> {
        files::check_apart(&self.files, outputs)
    }

    /// As [`Self::open`], for light, which takes cells as squares: with a warning where they are not.
    pub(crate) fn open_for_squares(text: &str, reading: &ReadingArgs) -> Result<Self, CliError> {
        let input = Self::open(text, reading)?;
        if let Some(words) = &input.oblong {
            eprintln!("{}: {words}", input.name);
        }
        Ok(input)
    }

    /// A generator's field.
    fn generated(text: &str, reading: &Reading) -> Result<Self, CliError> {
        let spec = tigereye_fields::parse_spec(text).map_err(|e| CliError::Input(e.to_string()))?;
        let field = tigereye_fields::generate(&spec.name, &spec.arguments)
            .map_err(|e| CliError::Input(e.to_string()))?;
        let story = vec!["made by a generator, row 0 on top, x right, y up".to_owned()];
        Self::defined(text, PlaneField::new(field, story), reading, GENERATOR)
    }

    /// The field of a `.field.ron`. One that names a data file keeps what that file says of itself.
    fn of_field_file(name: &str, reading: &Reading) -> Result<Self, CliError> {
        let path = Path::new(name);
        let text = files::read_text(path)?;
        let file = load_field(name, &text).map_err(|e| CliError::Input(other_kind(name, &text, &e)))?;
        let host = FileHost::new(Some(files::folder_of(path).to_path_buf()), name.to_owned());
        let made = make_plane(&file.field, &host);
        host.finish();
        let (plane, kind) = made.map_err(|e| CliError::Input(e.in_file(name, &text)))?;
        let mut input = Self::defined(name, plane, reading, kind.unwrap_or(FIELD_FILE))?;
        input.files = host.opened();
        input.files.push(name.to_owned());
        input.title = Some(file.title);
        Ok(input)
    }

    fn defined(
        name: &str,
        plane: PlaneField,
        reading: &Reading,
        kind: &'static str,
    ) -> Result<Self, CliError> {
        let blake3 = hash_of_field(&plane.field);
        let plane = defined_plane(plane, reading).map_err(|e| CliError::input(name, e))?;
        Ok(Self::placed(name.to_owned(), plane, Vec::new(), kind, blake3))
    }
}

/// What is wrong with a field file; an experiment in its place is named as such.
fn other_kind(name: &str, text: &str, fault: &SpecError) -> String {
    let is_experiment = ["look_for", "claim"].iter().all(|key| text.contains(&format!("{key}:")));
    match is_experiment && !name.ends_with(field_file::EXTENSION) {
        true => format!("{name}: is an experiment file, not a field: use `tigereye run {name}`"),
        false => fault.to_string(),
    }
}

/// Generators have no dots or slashes before their parameters.
fn looks_like_a_path(text: &str) -> bool {
    let name = text.split(':').next().unwrap_or(text);
    name.contains(['/', '\\', '.']) || Path::new(text).is_file()
}

/// Adds the options that were given to the parameters of a run.
pub(crate) fn insert_reading(parameters: &mut Value, args: &ReadingArgs) {
    let reading = args.reading();
    let given = [
        ("array", reading.array.map(|v| json!(v))),
        ("components", reading.components.map(|v| json!(v.text()))),
        ("order", reading.order.map(|v| json!(v))),
        (
            "shear",
            reading.shear.map(|v| json!(if v == Shear::Engineering { "engineering" } else { "tensor" })),
        ),
        ("frame", reading.frame.map(|v| json!(v.name()))),
        ("slice", reading.choice.slice.map(|(axis, index)| json!(format!("{}={index}", axis.name())))),
        ("plane", reading.choice.plane.map(|v| json!(v.name()))),
        ("crop", reading.crop.map(|c| json!(format!("{}:{},{}:{}", c.x[0], c.x[1], c.y[0], c.y[1])))),
        ("resample", reading.resample.map(|[w, h]| json!(format!("{w}x{h}")))),
        ("derive", reading.derive.map(|d| json!(d.kind.name()))),
        ("sigma", reading.derive.map(|d| json!(d.sigma))),
        (
            "window",
            reading
                .derive
                .filter(|d| d.kind.has_window())
                .map(|d| json!(d.window.unwrap_or(Derived::USUAL_WINDOW))),
        ),
        ("mask", reading.mask.map(|v| json!(v))),
        ("mask_array", reading.mask_array.map(|v| json!(v))),
        ("mask_above", (reading.mask_above != 0.0).then(|| json!(reading.mask_above))),
        ("not_finite", reading.zero_not_finite.then(|| json!("zero"))),
    ];
    if let Some(all) = parameters.as_object_mut() {
        all.extend(given.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))));
    }
}
