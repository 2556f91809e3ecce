//! `tigereye convert`: any readable tensor field to another format.

use crate::args::reading::ConvertArgs;
use crate::commands::command_line;
use crate::error::CliError;
use crate::input::{Input, Source, insert_reading};
use crate::{files, interrupt};
use serde_json::json;
use tigereye_core::{fractional_anisotropy3, mode3, symmetric_eigenvalues3};
use tigereye_input::provenance::provenance;
use tigereye_input::{Content, Reading, TensorFile, finite_volume, format_of, not_finite_words};
use tigereye_io::volume::{Frame, Known, PlaneChoice, TensorVolume, image_from_volume, points_from_image};
use tigereye_io::{DataArray, ImageData, IoError, ScalarType, legacy, matrices, nifti, npy, nrrd, vti, vtp};

/// Whether a volume is written as it is: no plane, part or size was asked for, and the file has axes of its own.
fn is_whole(volume: &TensorVolume, reading: &Reading) -> bool {
    let plane =
        reading.choice != PlaneChoice::default() || reading.crop.is_some() || reading.resample.is_some();
    !plane && volume.lattice().frame.1 != Known::Convention
}

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Matrices,
    Numpy,
    ImageData,
    PolyData,
    Legacy,
    Nrrd,
    Nifti,
    NiftiPacked,
}

impl Format {
    fn of(name: &str) -> Option<Self> {
        Some(match format_of(name).as_str() {
            "txt" => Self::Matrices,
            "npy" => Self::Numpy,
            "vti" => Self::ImageData,
            "vtp" => Self::PolyData,
            "vtk" => Self::Legacy,
            "nrrd" => Self::Nrrd,
            "nii" => Self::Nifti,
            "nii.gz" => Self::NiftiPacked,
            _ => return None,
        })
    }

    /// Whether there is room for arrays beside the tensors.
    const fn has_arrays(self) -> bool {
        matches!(self, Self::ImageData | Self::PolyData | Self::Legacy)
    }

    /// Whether only a plane fits.
    const fn is_flat(self) -> bool {
        matches!(self, Self::Matrices | Self::Numpy)
    }
}

pub(crate) fn convert(args: &ConvertArgs) -> Result<u8, CliError> {
    let name = args.output.display().to_string();
    let Some(format) = Format::of(&name) else {
        let problem =
            "the ending tells the format: expected .vti, .vtp, .vtk, .nrrd, .nii, .nii.gz, .npy or .txt";
        return Err(CliError::input(&name, problem));
    };
    files::check_writable(&args.output)?;
    if args.output.exists() && !args.force {
        return Err(CliError::input(&name, "exists already: expected another name, or --force"));
    }
    let reading = args.reading.reading();
    if args.invariants && !format.has_arrays() {
        return Err(CliError::input(&name, "has no place for --invariants: expected .vti, .vtp or .vtk"));
    }
    if args.write_order.is_some() && !matches!(format, Format::Nifti | Format::NiftiPacked) {
        return Err(CliError::input(&name, "has no place for --write-order: expected .nii or .nii.gz"));
    }
    let source = Source::open(&args.input, &args.reading)?;
    source.check_apart(std::slice::from_ref(&args.output))?;
    let remarks = match &source {
        Source::File(file) => file.remarks(),
        Source::Generated(_) => Vec::new(),
    };
    let bytes = match source {
        Source::File(TensorFile { content: Content::Tensors(volume), name, blake3, .. })
            if !format.is_flat() && is_whole(&volume, &reading) =>
        {
            remarks.iter().for_each(|line| eprintln!("{name}: {line}"));
            if reading.zero_not_finite
                && let Some((_, count)) = volume.not_finite()
            {
                eprintln!("{name}: {}", not_finite_words(count));
            }
            let volume = finite_volume(volume, &reading).map_err(|e| CliError::input(&name, e))?;
            let frame = if reading.frame == Some(Frame::Voxel) { Frame::Voxel } else { Frame::World };
            if let Some(words) = unplaced(format, &volume, frame) {
                eprintln!("{name}: {words}");
            }
            if volume.lattice().size[2] > 1 && !volume.order().0.has(2, 2) {
                eprintln!("{name}: the file has no components along the third axis: written as zero");
            }
            // What the file states about its components stands; the option says how they are written.
            encoded(format, &volume.as_stated(), frame, args, &blake3)
        }
        source => {
            let (scalar, world) = match &source {
                Source::File(file) => (file.scalar(), Some(file.lattice().world.clone())),
                Source::Generated(_) => (ScalarType::Float64, None),
            };
            if args.invariants {
                let problem = "are those of a volume of 3 x 3 tensors: expected a file that holds one, whole";
                return Err(CliError::input("--invariants", problem));
            }
            let input = Input::of(source, &args.reading)?;
            input.tell();
            if format.is_flat() && input.geometry.is_placed() && input.geometry.is_oblique() {
                eprintln!(
                    "{}: the plane is oblique, and the format has no place for its axes: components along those of the picture, x \
                     right, y up",
                    input.name
                );
            }
            match format {
                Format::Numpy => Ok(npy::write_tensors(&input.field)),
                Format::Matrices => matrices::write(&input.field),
                _ => {
                    let geometry = &input.geometry;
                    if geometry.is_placed() && !geometry.upright().is_placed() {
                        eprintln!(
                            "{}: the plane does not lie along the world's x and y: written in a frame of its own, x right, y up \
                             (lines, light and gradients lie in the world)",
                            input.name
                        );
                    }
                    let volume = TensorVolume::from_field(&input.field, &input.geometry).with_scalar(scalar);
                    let volume = match world {
                        Some(world) if geometry.upright().is_placed() => volume.with_world(world),
                        _ => volume,
                    };
                    // The plane's own axes, whatever the tensors were read along.
                    encoded(format, &volume, Frame::World, args, &input.blake3)
                }
            }
        }
    };
    let bytes = bytes.map_err(|e| CliError::input(&name, e))?;
    interrupt::check()?;
    files::write(&args.output, &bytes)?;
    Ok(0)
}

/// What is said where a volume is written along its own axes, without its place in the world.
fn unplaced(format: Format, volume: &TensorVolume, frame: Frame) -> Option<&'static str> {
    let lattice = volume.lattice();
    let is_placed = lattice.origin != [0.0; 3] || lattice.has_turned_axes();
    (format.has_arrays() && frame == Frame::Voxel && is_placed).then_some(
        "components along the voxel axes, which are x, y and z of what is written: origin and directions are left out (--frame \
         world keeps them)",
    )
}

/// A volume in one of the formats that hold volumes.
fn encoded(
    format: Format,
    volume: &TensorVolume,
    frame: Frame,
    args: &ConvertArgs,
    blake3: &str,
) -> Result<Vec<u8>, IoError> {
    let mut parameters = json!({ "input": args.input });
    insert_reading(&mut parameters, &args.reading);
    let story = provenance(&command_line(), &parameters, blake3);
    let image = || -> Result<ImageData, IoError> {
        let mut image = image_from_volume(volume, frame)?;
        if args.invariants {
            image.point_arrays.extend(invariants(volume));
        }
        image.push_text(tigereye_io::PROVENANCE, &story);
        Ok(image)
    };
    match format {
        Format::PolyData => vtp::write(&points_from_image(image()?)),
        Format::Legacy => {
            let title = format!("tigereye {}, input blake3 {blake3}", env!("CARGO_PKG_VERSION"));
            legacy::write(&image()?, &title)
        }
        Format::Nrrd => nrrd::write(volume, frame, &story),
        Format::Nifti => nifti::write(volume, args.write_order.map(Into::into).unwrap_or_default(), &story),
        Format::NiftiPacked => {
            nifti::write_packed(volume, args.write_order.map(Into::into).unwrap_or_default(), &story)
        }
        Format::ImageData | Format::Matrices | Format::Numpy => vti::write(&image()?),
    }
}

/// FA, MD and mode of every voxel, 0 where the mask is. They depend on no frame, and turning by axes in single precision
/// would cost digits, so they are taken of the tensors as stored.
fn invariants(volume: &TensorVolume) -> [DataArray; 3] {
    let eigenvalues = |(voxel, t): (usize, [f64; 9])| {
        if volume.is_masked(voxel) { [0.0; 3] } else { symmetric_eigenvalues3(&t) }
    };
    let eigenvalues: Vec<[f64; 3]> = volume.tensors().enumerate().map(eigenvalues).collect();
    let array = |name: &str, f: fn([f64; 3]) -> f64| {
        DataArray::new(name, 1, eigenvalues.iter().map(|&l| f(l)).collect())
    };
    [array("FA", fractional_anisotropy3), array("MD", |l| (l[0] + l[1] + l[2]) / 3.0), array("mode", mode3)]
}
