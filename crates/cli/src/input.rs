//! What a command works on: a file or a generator.

use crate::error::CliError;
use crate::files;
use crate::interrupt;
use std::path::Path;
use tigereye_core::{Field, Normalization, Tensor2};
use tigereye_experiments::provenance::{hash_of_bytes, hash_of_field};
use tigereye_io::{npy, vti};

/// A tensor field with what is known about its origin.
#[derive(Debug)]
pub(crate) struct Input {
    /// As the user wrote it.
    pub(crate) name: String,
    pub(crate) field: Field<Tensor2>,
    /// What was read and what was assumed, a sentence each.
    pub(crate) assumptions: Vec<String>,
    /// Position of the first point and distance between points, x and y.
    pub(crate) origin: [f64; 2],
    pub(crate) spacing: [f64; 2],
    /// The format or `generator`.
    pub(crate) kind: &'static str,
    /// Hash of the file, or of the generated field.
    pub(crate) blake3: String,
}

impl Input {
    /// Reads INPUT: a path with a known ending, or a generator.
    pub(crate) fn open(text: &str, array: Option<&str>) -> Result<Self, CliError> {
        let path = Path::new(text);
        let input = match files::extension(path).as_str() {
            "txt" => Self::matrices(text, path),
            "npy" => Self::numpy(text, path),
            "vti" => Self::image(text, path, array),
            _ if looks_like_a_path(text) => Err(CliError::input(
                text,
                "its ending is not readable: expected .txt, .npy, .vti or a generator NAME:key=value,key=value",
            )),
            _ => Self::generated(text),
        };
        // Large inputs take a while.
        interrupt::check()?;
        input
    }

    fn generated(text: &str) -> Result<Self, CliError> {
        let spec = tigereye_fields::parse_spec(text).map_err(|e| CliError::Input(e.to_string()))?;
        let field = tigereye_fields::generate(&spec.name, &spec.arguments)
            .map_err(|e| CliError::Input(e.to_string()))?;
        Ok(Self {
            name: text.to_owned(),
            blake3: hash_of_field(&field),
            assumptions: vec!["made by a generator, row 0 on top, x right, y up".to_owned()],
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
        Self::from_file(text, &bytes, field, "text matrices", vec![assumption.to_owned()])
    }

    fn numpy(text: &str, path: &Path) -> Result<Self, CliError> {
        let bytes = files::read(path)?;
        let field = npy::read_tensors(&bytes).map_err(|e| CliError::input(text, e))?;
        let assumption =
            "indexed [row][column], first row on top, components xx xy / yx yy in the frame x right, y up";
        Self::from_file(text, &bytes, field, "NumPy array", vec![assumption.to_owned()])
    }

    fn image(text: &str, path: &Path, array: Option<&str>) -> Result<Self, CliError> {
        let bytes = files::read(path)?;
        let image = vti::read(&bytes).map_err(|e| CliError::input(text, e))?;
        let tensors = tigereye_io::tensors_from_image(&image, array).map_err(|e| CliError::input(text, e))?;
        let mut input = Self::from_file(
            text,
            &bytes,
            tensors.field.clone(),
            "VTK image data",
            vec![tensors.to_string()],
        )?;
        input.origin = [tensors.origin[0], tensors.origin[1]];
        input.spacing = [tensors.spacing[0].abs(), tensors.spacing[1].abs()];
        Ok(input)
    }

    fn from_file(
        text: &str,
        bytes: &[u8],
        field: Field<Tensor2>,
        kind: &'static str,
        assumptions: Vec<String>,
    ) -> Result<Self, CliError> {
        if let Some(cell) = field.first_non_finite() {
            let problem =
                format!("the tensor of cell ({}, {}) is not finite: expected numbers", cell.x, cell.y);
            return Err(CliError::input(text, problem));
        }
        Ok(Self {
            name: text.to_owned(),
            field,
            assumptions,
            origin: [0.0; 2],
            spacing: [1.0; 2],
            kind,
            blake3: hash_of_bytes(bytes),
        })
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
