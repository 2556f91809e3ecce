//! NRRD, "nearly raw raster data": `.nrrd`, and `.nhdr` whose data are in a file beside it.
//!
//! Read: raw, gzip and text data of all number types of up to 64 bits, both byte orders; the tensor kinds of the format
//! (2D and 3D, symmetric or not, with or without mask); space directions, origin, measurement frame. Refused with a
//! specific message:
//! hex and bzip2, blocks, data spread over several files.
//!
//! Written: attached gzip data in the precision of the input, along the world's axes.
//!
//! Format: <http://teem.sourceforge.net/nrrd/format.html>.

mod data;
mod error;
mod header;
mod layout;
mod write;

pub use error::NrrdError;
pub use write::write;

use crate::volume::{Content, Frame, Known, Lattice, World};
use crate::{IoError, Limits, Wanted};
use header::Header;

/// The name of the file that holds the data, relative to the header; `None` where they follow the header.
///
/// # Errors
/// As [`read`], for the header alone.
pub fn data_file(bytes: &[u8], limits: Limits) -> Result<Option<String>, IoError> {
    Ok(Header::parse(bytes, limits)?.data_file)
}

/// Reads tensors with the default [`Limits`]; `detached` are the bytes of its data file, where it names one.
///
/// # Errors
/// See [`read_with_limits`].
pub fn read(bytes: &[u8], detached: Option<&[u8]>) -> Result<Lattice, IoError> {
    read_with_limits(bytes, detached, Wanted::Tensors, Limits::default())
}

/// Reads a file. Vectors are on the axis of a vector kind, or on the first axis of two or three numbers; where single
/// numbers are wanted, all axes are the lattice's.
///
/// # Errors
/// Names the line of the header, or the byte of the data (of the data file, where there is one).
pub fn read_with_limits(
    bytes: &[u8],
    detached: Option<&[u8]>,
    wanted: Wanted,
    limits: Limits,
) -> Result<Lattice, IoError> {
    let header = Header::parse(bytes, limits)?;
    let layout = header.layout(wanted)?;
    header.check_directions(&layout)?;
    let values = match (&header.data_file, detached) {
        (None, _) => data::read(&header, &bytes[header.end..], header.end)?,
        (Some(_), Some(data)) => data::read(&header, data, 0)?,
        (Some(name), None) => {
            let expected = "the bytes of that file";
            return Err(header.fault("data file", name, expected).into());
        }
    };
    let (values, mask) = layout.tuples(values);
    let mut notes = Vec::new();
    if layout.kind.is_none() && wanted == Wanted::Tensors {
        notes.push(format!("no kind names a tensor: axis {} of size {} taken", layout.axis, layout.tuple));
    }
    let world = header.space.clone().unwrap_or_else(|| "unnamed".to_owned());
    let components = layout.tuple - usize::from(layout.masked);
    let content = if layout.kind.is_some() { Content::NrrdTensor } else { Content::NrrdNumbers };
    let frame = match header.measurement {
        Some(_) => (Frame::Measurement, Known::Stated),
        None if header.has_directions() => content.frame(components),
        None => (Frame::Voxel, Known::Assumed),
    };
    let component_names =
        if wanted.is_numbers() { Vec::new() } else { header.component_names(layout.axis, components) };
    let (axes, origin) = header.geometry(&layout);
    Ok(Lattice {
        size: layout.size,
        components,
        values,
        scalar: header.scalar,
        axes,
        origin,
        unit: None,
        world: World::Scanner(world),
        measurement: header.measurement,
        mask,
        order: layout.order(&component_names, components),
        frame,
        array: layout.kind.map_or("numbers", |k| k.name).to_owned(),
        component_names,
        notes,
        remarks: header.assumed_centring(&layout).into_iter().collect(),
        order_remarks: Vec::new(),
        warnings: (layout.kind.is_none() && layout.masked)
            .then(|| "seven numbers taken as a mask and xx,xy,xz,yy,yz,zz".to_owned())
            .into_iter()
            .chain(header.unequal_units(&layout))
            .collect(),
    })
}
