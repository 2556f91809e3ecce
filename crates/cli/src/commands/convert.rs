//! `tigereye convert`: any readable tensor field to another format.

use crate::args::reading::ConvertArgs;
use crate::commands::{command_line, print_text};
use crate::error::CliError;
use crate::input::{Input, Source, insert_reading};
use crate::{files, interrupt};
use serde_json::json;
use tigereye_core::{fractional_anisotropy3, mode3, symmetric_eigenvalues3};
use tigereye_input::formats::{Format, TensorWriter, VolumeWriter, writable_extensions};
use tigereye_input::provenance::provenance;
use tigereye_input::{Content, Reading, TensorFile, finite_volume, not_finite_words};
use tigereye_io::volume::{Frame, Known, PlaneChoice, TensorVolume, World, image_from_volume};
use tigereye_io::{DataArray, ImageData, IoError, ScalarType};

/// Whether a volume is written as it is: no plane, part or size was asked for, and the file has axes of its own.
fn is_whole(volume: &TensorVolume, reading: &Reading) -> bool {
    let plane =
        reading.choice != PlaneChoice::default() || reading.crop.is_some() || reading.resample.is_some();
    !plane && volume.lattice().frame.1 != Known::Convention
}

pub(crate) fn convert(args: &ConvertArgs) -> Result<u8, CliError> {
    let name = args.output.display().to_string();
    let Some(writer) = Format::of(&name).and_then(|format| format.tensors) else {
        let expected = writable_extensions(|_| true);
        return Err(CliError::input(&name, format!("unknown extension: expected {expected}")));
    };
    files::check_writable(&args.output)?;
    if args.output.exists() && !args.force {
        return Err(CliError::input(&name, "exists already: expected another name, or --force"));
    }
    let reading = args.reading.reading();
    let no_place = |option: &str, has: fn(&TensorWriter) -> bool| {
        CliError::input(&name, format!("has no place for {option}: expected {}", writable_extensions(has)))
    };
    if args.invariants && !writer.has_arrays() {
        return Err(no_place("--invariants", TensorWriter::has_arrays));
    }
    if args.write_order.is_some() && !writer.has_layouts() {
        return Err(no_place("--write-order", TensorWriter::has_layouts));
    }
    let source = Source::open(&args.input, &args.reading)?;
    source.check_apart(std::slice::from_ref(&args.output))?;
    let remarks = match &source {
        Source::File(file) => file.remarks(),
        Source::Generated(_) => Vec::new(),
    };
    let (bytes, size) = match (source, writer) {
        (
            Source::File(TensorFile { content: Content::Tensors(volume), name, blake3, .. }),
            TensorWriter::Volume(writer),
        ) if is_whole(&volume, &reading) => {
            remarks.iter().for_each(|line| eprintln!("{name}: {line}"));
            if reading.zero_not_finite
                && let Some((_, count)) = volume.not_finite()
            {
                eprintln!("{name}: {}", not_finite_words(count));
            }
            let volume = finite_volume(volume, &reading).map_err(|e| CliError::input(&name, e))?;
            // Where the file states the frame, the option says how to write; where it does not, how to read. Formats
            // that state a frame keep the one of the input then, the others have no place for it.
            let is_stated = volume.lattice().frame.1 == Known::Stated;
            let has_frames = !matches!(writer, VolumeWriter::Image(_));
            let by_voxels = (is_stated || has_frames) && reading.frame == Some(Frame::Voxel);
            let frame = if by_voxels { Frame::Voxel } else { Frame::World };
            if let Some(words) = unplaced(writer, &volume, frame) {
                eprintln!("{name}: {words}");
            } else if let Some(words) = unnamed_space(writer, &volume.lattice().world) {
                eprintln!("{name}: {words}");
            }
            if volume.lattice().size[2] > 1 && !volume.order().0.has(2, 2) {
                eprintln!("{name}: the file has no components along the third axis: written as zero");
            }
            // What the file states about its components stands; the option says how they are written.
            let size = volume.lattice().size;
            (encoded(writer, &volume.as_stated(), frame, args, &blake3), size)
        }
        (source, writer) => {
            let (scalar, world) = match &source {
                Source::File(file) => (file.scalar(), Some(file.lattice().world.clone())),
                Source::Generated(_) => (ScalarType::Float64, None),
            };
            if args.invariants {
                let problem = "need a whole volume of 3 x 3 tensors: expected such a file, without a slice";
                return Err(CliError::input("--invariants", problem));
            }
            let input = Input::of(source, &args.reading)?;
            input.tell();
            let is_flat = matches!(writer, TensorWriter::Plane(_));
            if is_flat && input.geometry.is_placed() && input.geometry.is_oblique() {
                eprintln!(
                    "{}: the plane is oblique, and the format has no place for its axes: components along those of the picture, x \
                     right, y up",
                    input.name
                );
            }
            let grid = input.field.grid();
            let bytes = match writer {
                TensorWriter::Plane(write) => write(&input.field),
                TensorWriter::Volume(writer) => {
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
                        Some(world) if geometry.upright().is_placed() => {
                            if let Some(words) = unnamed_space(writer, &world) {
                                eprintln!("{}: {words}", input.name);
                            }
                            volume.with_world(world)
                        }
                        _ => volume,
                    };
                    // The plane's own axes, whatever the tensors were read along.
                    encoded(writer, &volume, Frame::World, args, &input.blake3)
                }
            };
            (bytes, [grid.width(), grid.height(), 1])
        }
    };
    let bytes = bytes.map_err(|e| CliError::input(&name, e))?;
    interrupt::check()?;
    files::write(&args.output, &bytes)?;
    let [width, height, depth] = size;
    let depth = if depth > 1 { format!(" x {depth}") } else { String::new() };
    print_text(&format!(
        "{width} x {height}{depth} tensors of {} written to {}\n",
        args.input,
        args.output.display()
    ))?;
    Ok(0)
}

/// The message for a volume that is written along its own axes, without its position in the world.
fn unplaced(writer: VolumeWriter, volume: &TensorVolume, frame: Frame) -> Option<&'static str> {
    let lattice = volume.lattice();
    let is_placed = lattice.origin != [0.0; 3] || lattice.has_turned_axes();
    (matches!(writer, VolumeWriter::Image(_)) && frame == Frame::Voxel && is_placed).then_some(
        "components along the voxel axes, which are x, y and z of what is written: origin and directions are left out (--frame \
         world keeps them)",
    )
}

/// The message for a patient's world whose axes the format cannot name.
fn unnamed_space(writer: VolumeWriter, world: &World) -> Option<String> {
    let World::Scanner(space) = world else { return None };
    let is_named = world.is_of_patient();
    (matches!(writer, VolumeWriter::Image(_)) && is_named).then(|| {
        format!(
            "positions and components are along the input's axes ({space}); the format has no name for such axes, and programs that \
             expect others need them turned"
        )
    })
}

/// A volume in one of the formats that hold volumes.
fn encoded(
    writer: VolumeWriter,
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
    let title = format!("tigereye {}, input blake3 {blake3}", env!("CARGO_PKG_VERSION"));
    match writer {
        VolumeWriter::Image(write) => write(image()?, &title),
        VolumeWriter::Framed(write) => write(volume, frame, &story),
        VolumeWriter::Layouts(write) => {
            write(volume, args.write_order.map(Into::into).unwrap_or_default(), &story)
        }
    }
}

/// FA, MD and mode of every voxel, 0 where the mask is. They depend on no frame, and turning by axes in single
/// precision would cost digits, so they are taken of the tensors as stored.
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
