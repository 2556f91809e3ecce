//! Arrays of many shapes as lattices.

use super::{NpyArray, read_array};
use crate::volume::{Frame, Known, Lattice, TensorOrder, World};
use crate::{IoError, Wanted};

/// How the axes of an array lie: rows and columns of a picture, or three axes of a volume; and the numbers of a tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Picture { height: usize, width: usize, tuple: usize },
    Volume { size: [usize; 3], tuple: usize },
}

impl Layout {
    fn of(shape: &[usize], wanted: Wanted) -> Option<Self> {
        let picture = |height, width, tuple| Some(Self::Picture { height, width, tuple });
        let volume = |x, y, z, tuple| Some(Self::Volume { size: [x, y, z], tuple });
        match wanted {
            Wanted::Tensors => match *shape {
                [h, w, 2, 2] => picture(h, w, 4),
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
                [x, y, z] => volume(x, y, z, 1),
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

/// Reads an array of a shape that the module lists. Pictures have row 0 on top and components in the frame x right, y up;
/// volumes have components along their own axes.
///
/// # Errors
/// As [`read_array`], and [`IoError::NpyShape`] for another shape.
pub fn read_lattice(bytes: &[u8], wanted: Wanted) -> Result<Lattice, IoError> {
    let NpyArray { shape, values, scalar } = read_array(bytes)?;
    let layout = Layout::of(&shape, wanted).filter(|_| !shape.contains(&0));
    let Some(layout) = layout else { return Err(IoError::NpyShape { shape, expected: expected(wanted) }) };
    let (size, tuple, down, values, frame, note) = match layout {
        Layout::Picture { height, width, tuple } => {
            let note = "indexed [row][column], row 0 on top, in the frame x right, y up";
            ([width, height, 1], tuple, -1.0, values, (Frame::World, Known::Convention), note)
        }
        Layout::Volume { size, tuple } => {
            let note = "indexed [x][y][z] as nibabel and dipy have it";
            (size, tuple, 1.0, x_fastest(&values, size, tuple), (Frame::Voxel, Known::Assumed), note)
        }
    };
    let plane = matches!(layout, Layout::Picture { .. }) && tuple == 4;
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
        order: plane.then_some((TensorOrder::ROWS2, Known::Convention)),
        frame,
        array: format!("array of shape {shape:?}"),
        notes: vec![note.to_owned()],
    })
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
