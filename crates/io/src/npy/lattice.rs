//! Arrays of many shapes as lattices.

use super::error::NpyError;
use super::positions::{self, AXES_OF_VOLUMES, Positions};
use super::{NpyArray, read_array};
use crate::convert::ChoiceError;
use crate::volume::{Content, Lattice, VECTOR_AXES, World, groups, outside_tensors, row_groups};
use crate::{ArrayChoice, DataArray, ImageData, IoError, Wanted, choose_array};

/// How the axes of an array lie: rows and columns of a picture, or three axes of a volume; and the numbers of a tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Picture { height: usize, width: usize, tuple: usize, content: Content },
    Volume { size: [usize; 3], tuple: usize },
}

impl Layout {
    /// Axes of cells.
    const fn cells(self) -> usize {
        match self {
            Self::Picture { .. } => 2,
            Self::Volume { .. } => 3,
        }
    }

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
            // A mask of few layers is no image of vectors.
            Wanted::Mask => match *shape {
                [h, w] => picture(h, w, 1),
                [x, y, z] => volume(x, y, z, 1),
                _ => None,
            },
            Wanted::Scalars => match *shape {
                [h, w] => picture(h, w, 1),
                [h, w, 1] if h.min(w) > 3 => picture(h, w, 1),
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
        Wanted::Scalars | Wanted::Mask => "(H, W) or (X, Y, Z)",
    }
}

/// Whether the shape would fit with its first axis (or its first two, of a matrix) put last, as arrays with the
/// components first have it.
fn has_components_first(shape: &[usize], wanted: Wanted) -> bool {
    // One number behind the others is no axis of cells that components could stand before.
    if wanted == Wanted::Mask || shape.last() == Some(&1) {
        return false;
    }
    let leading = match *shape {
        [a @ (2 | 3), b, _, ..] if a == b && wanted == Wanted::Tensors => 2,
        // Two numbers last are a vector.
        [2 | 3 | 4 | 6 | 7 | 9, _, .., last] if last != 2 || wanted == Wanted::Vectors => 1,
        _ => return false,
    };
    let mut moved = shape.to_vec();
    moved.rotate_left(leading);
    Layout::of(&moved, wanted).is_some()
}

/// Whether an array that is read with its components last would as well be one with a tuple's numbers first: as few
/// rows as a tuple has numbers.
fn could_have_components_first(shape: &[usize], wanted: Wanted) -> bool {
    let is_tuple = match (wanted, shape) {
        (Wanted::Tensors, [a @ (2 | 3), b, _, _]) if a == b => true,
        (Wanted::Tensors, [3, 3, _, _, _]) => true,
        (Wanted::Tensors, [first, _, _]) => matches!(first, 3 | 4 | 6 | 9),
        (Wanted::Tensors, [first, _, _, _]) => matches!(first, 6 | 9),
        (Wanted::Vectors, [first, _, _]) => matches!(first, 2 | 3),
        (Wanted::Vectors, [first, _, _, _]) => *first == 3,
        _ => false,
    };
    is_tuple && has_components_first(shape, wanted)
}

/// Reads an array of a shape that the module lists. Pictures have row 0 on top and components in the frame x right, y
/// up; volumes have components along their own axes.
///
/// # Errors
/// As [`read_array`], and [`NpyError::Shape`] or [`NpyError::ComponentsFirst`] for another shape.
pub fn read_lattice(bytes: &[u8], wanted: Wanted) -> Result<Lattice, IoError> {
    let NpyArray { shape, values, scalar } = read_array(bytes)?;
    let layout = Layout::of(&shape, wanted).filter(|_| !shape.contains(&0));
    let Some(layout) = layout else {
        return Err(if has_components_first(&shape, wanted) {
            NpyError::ComponentsFirst { shape }.into()
        } else {
            NpyError::Shape { shape, expected: expected(wanted) }.into()
        });
    };
    // A mask before six numbers is rarer than an array of seven columns.
    let components_first = has_components_first(&shape, wanted);
    if components_first && shape.last() == Some(&7) {
        return Err(NpyError::ComponentsFirst { shape }.into());
    }
    let warnings = could_have_components_first(&shape, wanted).then(|| {
        let axes = |of: &[usize]| of.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ");
        let is_matrix = matches!(shape[..], [a @ (2 | 3), b, _, _, ..] if a == b);
        let count = if is_matrix { 2 } else { 1 };
        let taken = if shape.len() == layout.cells() + 2 { 2 } else { 1 };
        let (first, last) = (axes(&shape[..count]), axes(&shape[shape.len() - taken..]));
        let (axes, verb) = if count == 1 { ("axis", "size") } else { ("axes", "sizes") };
        format!(
            "the first {axes} ({verb} {first}) could be the components as well as the last ({last}), which was taken"
        )
    });
    let array = NpyArray { shape, values, scalar };
    let mut lattice = laid_out(array, layout, warnings.into_iter().collect());
    if matches!(layout, Layout::Volume { .. }) && wanted != Wanted::Mask {
        lattice.remarks.push(AXES_OF_VOLUMES.to_owned());
    }
    Ok(lattice)
}

fn laid_out(array: NpyArray, layout: Layout, warnings: Vec<String>) -> Lattice {
    let NpyArray { shape, values, scalar } = array;
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
    Lattice {
        size,
        components: tuple,
        values,
        scalar,
        axes: [[1.0, 0.0, 0.0], [0.0, down, 0.0], [0.0, 0.0, 1.0]],
        // The lower left cell is at 0.
        origin: [0.0, if down < 0.0 { (size[1] - 1) as f64 } else { 0.0 }, 0.0],
        unit: None,
        world: World::Absent,
        measurement: None,
        mask: None,
        order: content.order(tuple),
        frame: content.frame(tuple),
        array: format!("array of shape {shape:?}"),
        component_names: Vec::new(),
        notes: vec![note.to_owned()],
        remarks: Vec::new(),
        order_remarks: Vec::new(),
        warnings,
    }
}

/// Takes an array out of the arrays of an archive, by name and bytes: the named one, the only one that fits, or the one
/// whose components are arrays of their own. Arrays of positions (`positions.rs`) place it; a message lists the others
/// as ignored.
///
/// # Errors
/// As [`read_lattice`] for the named or only array, as [`crate::volume::lattice_from_image`] for one out of several,
/// and [`NpyError::Positions`].
pub fn lattice_of_members(
    members: &[(String, Vec<u8>)],
    choice: ArrayChoice,
    wanted: Wanted,
) -> Result<Lattice, IoError> {
    let named = |name: &str| members.iter().find(|(n, _)| n == name);
    let (used, lattice) = match (members, choice) {
        (_, ArrayChoice::Named(name)) => {
            let missing = || ChoiceError::NoArray {
                wanted: format!("array `{name}`"),
                available: members.iter().map(|(n, _)| format!("`{n}`")).collect(),
            };
            let (name, bytes) = named(name).ok_or_else(missing)?;
            (vec![name.clone()], Lattice { array: name.clone(), ..read_lattice(bytes, wanted)? })
        }
        ([(name, bytes)], ArrayChoice::Usual) => {
            (vec![name.clone()], Lattice { array: name.clone(), ..read_lattice(bytes, wanted)? })
        }
        (_, ArrayChoice::Usual | ArrayChoice::Components(_)) => out_of_several(members, choice, wanted)?,
    };
    let positions = Positions::among(members, &used, &lattice);
    let mut lattice = match &positions {
        Some(positions) => positions.place(lattice)?,
        None => lattice,
    };
    let placing = positions.map(|p| p.names).unwrap_or_default();
    let aside: Vec<&str> = members
        .iter()
        .map(|(name, _)| name.as_str())
        .filter(|n| !used.iter().chain(&placing).any(|u| u == n))
        .collect();
    if !aside.is_empty() {
        lattice.remarks.push(format!(
            "took `{}`; ignored other arrays: {}",
            used.join(", "),
            aside.join(", ")
        ));
    }
    let unplaced: Vec<&str> = aside.into_iter().filter(|n| positions::is_position(n)).collect();
    if !unplaced.is_empty() {
        let names = unplaced.join(", ");
        let placed = if placing.is_empty() { ": cells of size 1" } else { "" };
        lattice.warnings.push(format!("positions {names} ignored{placed}"));
    }
    Ok(lattice)
}

/// The array that suits, or that its components make up, and the names of what it was made of.
fn out_of_several(
    members: &[(String, Vec<u8>)],
    choice: ArrayChoice,
    wanted: Wanted,
) -> Result<(Vec<String>, Lattice), IoError> {
    let components = components_among(members, choice, wanted);
    let any = |name: &String, bytes: &[u8]| {
        if components.contains(name) {
            // Single numbers, whatever the length of the last axis.
            return read_lattice(bytes, Wanted::Mask).ok();
        }
        [wanted, Wanted::Scalars, Wanted::Vectors].into_iter().find_map(|w| read_lattice(bytes, w).ok())
    };
    let (mut read, mut image) = (Vec::new(), ImageData::empty([1; 3]));
    for (name, bytes) in members {
        match any(name, bytes) {
            Some(lattice) => read.push((name, lattice)),
            None => image
                .skipped
                .extend(read_array(bytes).ok().map(|a| format!("`{name}` (shape {:?})", a.shape))),
        }
    }
    for (name, lattice) in &read {
        // Positions are not the data; their components would be taken for vectors.
        if positions::is_position(name) && matches!(choice, ArrayChoice::Usual) {
            continue;
        }
        let array = DataArray::new(name, lattice.components, lattice.values.clone());
        image.point_arrays.push(DataArray { scalar: lattice.scalar, ..array });
    }
    let (_, array) = choose_array(&image, choice, wanted)?;
    if let Some((name, lattice)) = read.iter().find(|(name, _)| **name == array.name) {
        return Ok((vec![array.name.clone()], Lattice { array: (*name).clone(), ..lattice.clone() }));
    }
    let used: Vec<String> = array.name.split(", ").map(str::to_owned).collect();
    let first = read.iter().find(|(name, _)| used.first() == Some(name));
    let missing = || ChoiceError::NoArray { wanted: "array".to_owned(), available: Vec::new() };
    let (_, first) = first.ok_or_else(missing)?;
    Ok((used, first.clone().with_array(array.into_owned())))
}

/// Names of the arrays that are one component each, of two or three axes of cells: those that a user names, and those
/// whose names make up a tensor or, where vectors are wanted, a vector.
fn components_among(members: &[(String, Vec<u8>)], choice: ArrayChoice, wanted: Wanted) -> Vec<String> {
    if let ArrayChoice::Components(components) = choice {
        return if components.are_numbers(wanted) {
            components.arrays().map(str::to_owned).collect()
        } else {
            Vec::new()
        };
    }
    let shape =
        |i: usize| read_array(&members[i].1).ok().map(|a| a.shape).filter(|s| matches!(s.len(), 2 | 3));
    let alike =
        |group: &[usize]| shape(group[0]).is_some() && group.iter().all(|&i| shape(i) == shape(group[0]));
    let names: Vec<&str> = members.iter().map(|(name, _)| name.as_str()).collect();
    let found = match wanted {
        Wanted::Tensors => groups(&names).into_iter().map(|group| group.members).collect(),
        Wanted::Vectors => {
            let others = outside_tensors(&names);
            let of: Vec<&str> = others.iter().map(|&i| names[i]).collect();
            let found = VECTOR_AXES.iter().flat_map(|axes| row_groups(&of, axes));
            found.map(|group| group.into_iter().map(|i| others[i]).collect()).collect()
        }
        Wanted::Scalars | Wanted::Mask => Vec::new(),
    };
    let all = found.into_iter().filter(|group| alike(group)).flatten();
    all.map(|i| names[i].to_owned()).collect()
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
