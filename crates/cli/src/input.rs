//! What a command works on: a file or a generator.

use crate::args::{FrameName, ReadingArgs};
use crate::error::CliError;
use crate::files;
use crate::interrupt;
use crate::source::{Source, VolumeFile, choice};
use serde_json::{Value, json};
use std::path::Path;
use tigereye_core::{Field, Normalization, Tensor2};
use tigereye_experiments::provenance::{hash_of_bytes, hash_of_field};
use tigereye_io::volume::{Frame, Plane};
use tigereye_io::{IoError, npy};

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
    /// Position of the first point and distance between points, x and y.
    pub(crate) origin: [f64; 2],
    pub(crate) spacing: [f64; 2],
    /// The format or `generator`.
    pub(crate) kind: &'static str,
    /// Hash of the file, or of the generated field.
    pub(crate) blake3: String,
}

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
        let input = match source {
            Source::Field(input) => input.checked_against(reading)?,
            Source::Volume(file) => Self::slice(&file, reading)?,
            Source::Scalars(file) => {
                let problem = "holds one number a voxel: expected tensors";
                return Err(CliError::input(&file.name, problem));
            }
        };
        let input = input.cropped(reading)?;
        if let Some(cell) = input.field.first_non_finite() {
            let problem =
                format!("the tensor of cell ({}, {}) is not finite: expected numbers", cell.x, cell.y);
            return Err(CliError::input(&input.name, problem));
        }
        Ok(input)
    }

    /// Reads what lies in a plane by itself.
    pub(crate) fn of_plane(text: &str, path: &Path) -> Result<Self, CliError> {
        let input = match files::extension(path).as_str() {
            "txt" => Self::matrices(text, path),
            "npy" => Self::numpy(text, path),
            _ if looks_like_a_path(text) => Err(CliError::input(
                text,
                "its ending is not readable: expected .txt, .npy, .vti, .vtp, .vtk, .nrrd, .nhdr, .nii, .nii.gz or a \
                 generator NAME:key=value,key=value",
            )),
            _ => Self::generated(text),
        };
        // Large inputs take a while.
        interrupt::check()?;
        input
    }

    /// What had to be assumed, and what looks wrong, to standard error.
    pub(crate) fn tell(&self) {
        for line in &self.remarks {
            eprintln!("{}: {line}", self.name);
        }
    }

    fn slice(file: &VolumeFile, reading: &ReadingArgs) -> Result<Self, CliError> {
        let slice = file.volume.slice(choice(reading)).map_err(|e| {
            let options = match e {
                IoError::PlaneNeeded { .. } => " (option --slice AXIS=INDEX)",
                IoError::SliceNeeded { .. } => " (option --slice)",
                _ => "",
            };
            CliError::input(&file.name, format!("{e}{options}"))
        })?;
        let mut assumptions = file.volume.story();
        assumptions.push(slice.story());
        let warning = file.warning().map(|w| format!("WARNING: {w}"));
        Ok(Self {
            name: file.name.clone(),
            field: slice.field,
            assumptions,
            remarks: file.assumption().into_iter().chain(warning).collect(),
            origin: slice.origin,
            spacing: slice.spacing,
            kind: file.kind,
            blake3: file.blake3.clone(),
        })
    }

    /// Options that choose a plane, or say what components mean, must fit what is read in one way only.
    fn checked_against(self, reading: &ReadingArgs) -> Result<Self, CliError> {
        let plane = choice(reading).resolve([self.field.grid().width(), self.field.grid().height(), 1]);
        let problem = match plane {
            Ok((Plane::Xy, _)) => None,
            Ok(_) => Some("lies in the plane xy: expected no other".to_owned()),
            Err(e) => Some(e.to_string()),
        };
        let problem = problem
            .or_else(|| {
                reading.order.as_ref().map(|_| "has a fixed component order: expected no --order".to_owned())
            })
            .or_else(|| {
                let measured = reading.frame == Some(FrameName::Measurement);
                measured.then(|| IoError::NoMeasurementFrame.to_string())
            });
        match problem {
            None => Ok(self),
            Some(problem) => Err(CliError::input(&self.name, problem)),
        }
    }

    fn cropped(mut self, reading: &ReadingArgs) -> Result<Self, CliError> {
        let Some(crop) = reading.crop else { return Ok(self) };
        let height = self.field.grid().height();
        self.field = crop.of(&self.field).map_err(|e| CliError::input(&self.name, e))?;
        self.origin[0] += crop.x[0] as f64 * self.spacing[0];
        self.origin[1] += (height - crop.y[1]) as f64 * self.spacing[1];
        self.assumptions.push(format!(
            "cropped to columns {} to {} and rows {} to {} of the plane, row 0 on top",
            crop.x[0],
            crop.x[1] - 1,
            crop.y[0],
            crop.y[1] - 1
        ));
        Ok(self)
    }

    fn generated(text: &str) -> Result<Self, CliError> {
        let spec = tigereye_fields::parse_spec(text).map_err(|e| CliError::Input(e.to_string()))?;
        let field = tigereye_fields::generate(&spec.name, &spec.arguments)
            .map_err(|e| CliError::Input(e.to_string()))?;
        Ok(Self {
            name: text.to_owned(),
            blake3: hash_of_field(&field),
            assumptions: vec!["made by a generator, row 0 on top, x right, y up".to_owned()],
            remarks: Vec::new(),
            origin: [0.0; 2],
            spacing: [1.0; 2],
            kind: "generator",
            field,
        })
    }

    fn matrices(text: &str, path: &Path) -> Result<Self, CliError> {
        let bytes = files::read(path)?;
        let field = tigereye_io::matrices::read(&bytes).map_err(|e| CliError::input(text, e))?;
        let assumption =
            "2x2 blocks of text, first row on top, components xx xy / yx yy in the frame x right, y up";
        Ok(Self::from_file(text, &bytes, field, "text matrices", vec![assumption.to_owned()]))
    }

    fn numpy(text: &str, path: &Path) -> Result<Self, CliError> {
        let bytes = files::read(path)?;
        let field = npy::read_tensors(&bytes).map_err(|e| CliError::input(text, e))?;
        let assumption =
            "indexed [row][column], first row on top, components xx xy / yx yy in the frame x right, y up";
        Ok(Self::from_file(text, &bytes, field, "NumPy array", vec![assumption.to_owned()]))
    }

    fn from_file(
        text: &str,
        bytes: &[u8],
        field: Field<Tensor2>,
        kind: &'static str,
        assumptions: Vec<String>,
    ) -> Self {
        Self {
            name: text.to_owned(),
            field,
            assumptions,
            remarks: Vec::new(),
            origin: [0.0; 2],
            spacing: [1.0; 2],
            kind,
            blake3: hash_of_bytes(bytes),
        }
    }

    /// The normalisation asked for, or the kind's own: local for generators and text matrices, global otherwise.
    pub(crate) fn normalization(&self, asked: Option<Normalization>) -> Normalization {
        asked.unwrap_or(match self.kind {
            "generator" | "text matrices" => Normalization::Local,
            _ => Normalization::Global,
        })
    }
}

/// Generators have no dots or slashes before their parameters.
fn looks_like_a_path(text: &str) -> bool {
    let name = text.split(':').next().unwrap_or(text);
    name.contains(['/', '\\', '.']) || Path::new(text).is_file()
}

/// Adds the options that were given to the parameters of a run.
pub(crate) fn insert_reading(parameters: &mut Value, reading: &ReadingArgs) {
    let given = [
        ("array", reading.array.as_ref().map(|v| json!(v))),
        ("order", reading.order.as_ref().map(|v| json!(v))),
        ("frame", reading.frame.map(|v| json!(Frame::from(v).name()))),
        ("slice", reading.slice.map(|(axis, index)| json!(format!("{}={index}", axis.name())))),
        ("plane", reading.plane.map(|v| json!(Plane::from(v).name()))),
        ("crop", reading.crop.map(|c| json!(format!("{}:{},{}:{}", c.x[0], c.x[1], c.y[0], c.y[1])))),
    ];
    if let Some(all) = parameters.as_object_mut() {
        all.extend(given.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))));
    }
}
