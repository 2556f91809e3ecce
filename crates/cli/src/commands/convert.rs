//! `tigereye convert`: any readable tensor field to another format.

use crate::args::ConvertArgs;
use crate::commands::command_line;
use crate::error::CliError;
use crate::input::{Input, insert_reading};
use crate::source::{Source, VolumeFile};
use crate::{files, interrupt};
use serde_json::json;
use tigereye_experiments::provenance::provenance;
use tigereye_io::volume::{Frame, image_from_volume};
use tigereye_io::{ImageData, image_from_tensors, matrices, npy, vti};

pub(crate) fn convert(args: &ConvertArgs) -> Result<u8, CliError> {
    let name = args.output.display().to_string();
    let format = files::extension(&args.output);
    if !matches!(format.as_str(), "vti" | "npy" | "txt") {
        return Err(CliError::input(&name, "the ending tells the format: expected .vti, .npy or .txt"));
    }
    files::check_writable(&args.output)?;
    if args.output.exists() && !args.force {
        return Err(CliError::input(&name, "exists already: expected another name, or --force"));
    }
    let source = Source::open(&args.input, &args.reading)?;
    let bytes = match source {
        Source::Volume(file) if format == "vti" && !file.has_plane(&args.reading) => {
            if args.reading.crop.is_some() {
                return Err(CliError::input("--crop", "a part of a plane: expected --slice too"));
            }
            file.tell();
            let frame = args.reading.frame.map_or(Frame::World, Frame::from);
            let image =
                image_from_volume(&file.volume, frame).map_err(|e| CliError::input(&args.input, e))?;
            encoded(image, args, &file)?
        }
        source => {
            let input = Input::of(source, &args.reading)?;
            input.tell();
            match format.as_str() {
                "npy" => npy::write_tensors(&input.field),
                "txt" => matrices::write(&input.field).map_err(|e| CliError::input(&name, e))?,
                _ => encoded(image_from_tensors(&input.field, input.origin, input.spacing), args, &input)?,
            }
        }
    };
    interrupt::check()?;
    files::write(&args.output, &bytes)?;
    Ok(0)
}

/// What an output's provenance names.
trait Hashed {
    fn blake3(&self) -> &str;
}

impl Hashed for Input {
    fn blake3(&self) -> &str {
        &self.blake3
    }
}

impl Hashed for VolumeFile {
    fn blake3(&self) -> &str {
        &self.blake3
    }
}

fn encoded(mut image: ImageData, args: &ConvertArgs, input: &impl Hashed) -> Result<Vec<u8>, CliError> {
    let mut parameters = json!({ "input": args.input });
    insert_reading(&mut parameters, &args.reading);
    let story = provenance(&command_line(), &parameters, input.blake3());
    image.push_text(tigereye_io::PROVENANCE, &story);
    vti::write(&image).map_err(|e| CliError::input(&args.output.display().to_string(), e))
}
