//! Arrays of many shapes as lattices.

use super::{NpyArray, read_array};
use crate::volume::{ComponentArrays, Content, Lattice, World};
use crate::{ArrayChoice, DataArray, ImageData, IoError, Wanted, choose_array};

/// How the axes of an array lie: rows and columns of a picture, or three axes of a volume; and the numbers of a tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Picture { height: usize, width: usize, tuple: usize, content: Content },
    Volume { size: [usize; 3], tuple: usize },
}

impl Layout {
    fn of(shape: &[usize], wanted: Wanted) -> Option<Self> {
        let of = |height, width, tuple, content| Some(Self::Picture { height, width, tuple, content });
        let picture = |height, width, tuple| of(height, width, tuple, Content::NumpyPlane);
        let volume = |x, y, z, tuple| Some(Self::Volume { size: [x, y, z], tuple });
        match wanted {
            Wanted::Tensors => match *shape {
                [h, w, 2, 2] => of(h, w, 4, Content::NumpyMatrices),
                [h, w, 3, 3] => picture(h, w, 9),
                [h, w, n @ (3 | 4 | 6 | 7 | 9)] => picture(h, w, n),
                [x, y, z, 3, 3] => volume(x, y, z, 9),
                [x, y, z, n @ (6 | 7 | 9)] => volume(x, y, z, n),
                _ => None,
            },
            Wanted::Vectors => match *shape {
                [h, w, n @ (2 | 3)] => picture(h, w, n),
                [x, y, z, 3] => volume(x, y, z, 3),
                _ => None,
            },
            Wanted::Scalars => match *shape {
                [h, w] => picture(h, w, 1),
                // Two or three numbers a cell are a vector rather than layers.
                [x, y, z] if z > 3 || x.min(y) <= 3 => volume(x, y, z, 1),
                _ => None,
            },
        }
    }
}

const fn expected(wanted: Wanted) -> &'static str {
    match wanted {
        Wanted::Tensors => {
            "(H, W, 2, 2), (H, W, 4), (H, W, 3), (H, W, 3, 3), (H, W, 6), (X, Y, Z, 3, 3) or (X, Y, Z, 6) (also 7 or 9 instead of 6)"
        }
        Wanted::Vectors => "(H, W, 2), (H, W, 3) or (X, Y, Z, 3)",
        Wanted::Scalars => "(H, W) or (X, Y, Z)",
    }
}

/// Whether the shape would fit with its first axis (or its first two, of a matrix) put last, as arrays with the components first have it.
fn has_components_first(shape: &[usize], wanted: Wanted) -> bool {
    let leading = match *shape {
        [a @ (2 | 3), b, _, ..] if a == b && wanted == Wanted::Tensors => 2,
        [2 | 3 | 4 | 6 | 7 | 9, _, ..] => 1,
        _ => return false,
    };
    let mut moved = shape.to_vec();
    moved.rotate_left(leading);
    Layout::of(&moved, wanted).is_some()
}

/// Reads an array of a shape that the module lists. Pictures have row 0 on top and components in the frame x right, y up;
/// volumes have components along their own axes.
///
/// # Errors
/// As [`read_array`], and [`IoError::NpyShape`] or [`IoError::NpyComponentsFirst`] for another shape.
pub fn read_lattice(bytes: &[u8], wanted: Wanted) -> Result<Lattice, IoError> {
    let NpyArray { shape, values, scalar } = read_array(bytes)?;
    let layout = Layout::of(&shape, wanted).filter(|_| !shape.contains(&0));
    let Some(layout) = layout else {
        return Err(if has_components_first(&shape, wanted) {
            IoError::NpyComponentsFirst { shape }
        } else {
            IoError::NpyShape { shape, expected: expected(wanted) }
        });
    };
    let (size, tuple, down, values, content, note) = match layout {
        Layout::Picture { height, width, tuple, content } => {
            let note = "indexed [row][column], row 0 on top, in the frame x right, y up";
            ([width, height, 1], tuple, -1.0, values, content, note)
        }
        Layout::Volume { size, tuple } => {
            let note = "indexed [x][y][z] as nibabel and dipy have it";
            (size, tuple, 1.0, x_fastest(&values, size, tuple), Content::NumpyVolume, note)
        }
    };
    Ok(Lattice {
        size,
        components: tuple,
        values,
        scalar,
        axes: [[1.0, 0.0, 0.0], [0.0, down, 0.0], [0.0, 0.0, 1.0]],
        // The lower left cell is at 0.
        origin: [0.0, if down < 0.0 { (size[1] - 1) as f64 } else { 0.0 }, 0.0],
        world: World::Absent,
        measurement: None,
        mask: None,
        order: content.order(tuple),
        frame: content.frame(tuple),
        array: format!("array of shape {shape:?}"),
        component_names: Vec::new(),
        notes: vec![note.to_owned()],
        warnings: Vec::new(),
    })
}

/// Names of arrays that say where cells lie, which archives of NumPy have no rule for.
const POSITIONS: [&str; 12] =
    ["x", "y", "z", "xs", "ys", "lon", "lat", "points", "coords", "extent", "spacing", "origin"];

/// Takes an array out of the arrays of an archive, by name and bytes: the named one, the only one that fits, or the one whose components
/// are arrays of their own.
///
/// # Errors
/// As [`read_lattice`] for the named or only array, and as [`crate::volume::lattice_from_image`] for one out of several.
pub fn lattice_of_members(
    members: &[(String, Vec<u8>)],
    components: Option<&ComponentArrays>,
    wanted: Wanted,
) -> Result<Lattice, IoError> {
    if let ([(name, bytes)], None) = (members, components) {
        return read_lattice(bytes, wanted).map(|lattice| Lattice { array: name.clone(), ..lattice });
    }
    let any = |bytes: &[u8]| {
        [wanted, Wanted::Scalars, Wanted::Vectors].into_iter().find_map(|w| read_lattice(bytes, w).ok())
    };
    let read: Vec<(&String, Lattice)> =
        members.iter().filter_map(|(name, bytes)| Some((name, any(bytes)?))).collect();
    let mut image = ImageData::empty([1; 3]);
    for (name, lattice) in &read {
        let array = DataArray::new(name, lattice.components, lattice.values.clone());
        image.point_arrays.push(DataArray { scalar: lattice.scalar, ..array });
    }
    let choice = components.map_or(ArrayChoice::Usual, ArrayChoice::Components);
    let (_, array) = choose_array(&image, choice, wanted)?;
    let is_position = |name: &str| POSITIONS.iter().any(|p| name.eq_ignore_ascii_case(p));
    let aside: Vec<&str> = members.iter().map(|(name, _)| name.as_str()).filter(|n| is_position(n)).collect();
    let warnings = if aside.is_empty() {
        Vec::new()
    } else {
        vec![format!("positions {} left aside: cells of size 1, row 0 on top", aside.join(", "))]
    };
    if let Some((name, lattice)) = read.iter().find(|(name, _)| **name == array.name) {
        return Ok(Lattice { array: (*name).clone(), warnings, ..lattice.clone() });
    }
    let first = array.name.split(", ").next().unwrap_or_default();
    let place = read.iter().find(|(name, _)| *name == first).map(|(_, lattice)| lattice.clone());
    let missing = || IoError::NoArray { wanted: "array".to_owned(), available: Vec::new() };
    Ok(Lattice { warnings, ..place.ok_or_else(missing)?.with_array(array.into_owned()) })
}

/// From `[x][y][z][component]` to tuples with x fastest.
fn x_fastest(values: &[f64], [nx, ny, nz]: [usize; 3], tuple: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(values.len());
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let from = ((x * ny + y) * nz + z) * tuple;
                out.extend_from_slice(&values[from..from + tuple]);
            }
        }
    }
    out
}
