//! Where the cells of an archive lie: arrays of positions beside the data.

use super::error::NpyError;
use super::{NpyArray, read_array};
use crate::points::PointLattice;
use crate::volume::{Frame, Known, Lattice, World, world_axes};
use crate::{ImageData, taken_upwards};

/// What the axes of positions are called, in any case; the third is that of volumes.
const AXES: [[&str; 3]; 5] = [
    ["x", "y", "z"],
    ["xs", "ys", "zs"],
    ["lon", "lat", "depth"],
    ["longitude", "latitude", "depth"],
    ["x_coords", "y_coords", "z_coords"],
];
/// Arrays that say where cells lie by other rules.
const OTHERS: [&str; 8] = ["points", "coords", "extent", "extents", "bounds", "spacing", "origin", "affine"];

/// The message about arrays with three axes of cells, none of which is named.
pub(super) const AXES_OF_VOLUMES: &str = "took the axes of the array as x, y and z in this order; stacks of images are mostly [z][y][x], which \
     numpy.transpose turns round";

/// Whether an array of this name says where cells lie.
pub(super) fn is_position(name: &str) -> bool {
    AXES.iter().flatten().chain(&OTHERS).any(|p| name.eq_ignore_ascii_case(p))
}

/// How positions of one axis each run along the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Indexing {
    /// One number a cell.
    Cells,
    /// x along the columns, y along the rows: `numpy.meshgrid` with `indexing="xy"`.
    Columns,
    /// x along the first axis, y along the second: `indexing="ij"`, and volumes.
    FirstAxis,
}

/// The positions of all cells, in the order of the lattice's voxels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Positions {
    /// Names of the arrays.
    pub(super) names: Vec<String>,
    points: Vec<[f64; 3]>,
    /// Words of warning where x could run along either axis.
    ambiguous: bool,
    is_volume: bool,
}

impl Positions {
    /// The positions that fit a lattice, out of arrays that do not make up its data. `None` where there are none, or of
    /// other sizes.
    pub(super) fn among(members: &[(String, Vec<u8>)], used: &[String], lattice: &Lattice) -> Option<Self> {
        // Pictures have row 0 on top.
        let is_volume = lattice.axes[1][1] > 0.0;
        let find = |name: &str| {
            let (name, bytes) =
                members.iter().find(|(n, _)| n.eq_ignore_ascii_case(name) && !used.contains(n))?;
            Some((name.clone(), read_array(bytes).ok()?))
        };
        let needed = if is_volume { 3 } else { 2 };
        AXES.iter().find_map(|axes| {
            let found: Option<Vec<(String, NpyArray)>> = axes[..needed].iter().map(|n| find(n)).collect();
            let (mut names, mut arrays): (Vec<String>, Vec<NpyArray>) = found?.into_iter().unzip();
            // The height of a plane.
            let height = find(axes[2])
                .filter(|(_, z)| !is_volume && (z.values.len() == 1 || z.shape == arrays[0].shape));
            if let Some((name, z)) = height {
                names.push(name);
                arrays.push(z);
            }
            Self::of(names, &arrays, lattice.size, is_volume)
        })
    }

    fn of(names: Vec<String>, arrays: &[NpyArray], size: [usize; 3], is_volume: bool) -> Option<Self> {
        let [nx, ny, nz] = size;
        // The shape of one number a cell, and that of one number a row, column or layer.
        let shape = if is_volume { vec![nx, ny, nz] } else { vec![ny, nx] };
        let axes = &arrays[..if is_volume { 3 } else { 2 }];
        let lengths: Vec<usize> = axes.iter().map(|a| a.values.len()).collect();
        let is_flat = axes.iter().all(|a| a.shape.len() == 1);
        let indexing = if axes.iter().all(|a| a.shape == shape) {
            Indexing::Cells
        } else if is_flat && !is_volume && lengths == [nx, ny] {
            Indexing::Columns
        } else if is_flat && (lengths == [ny, nx] || (is_volume && lengths == [nx, ny, nz])) {
            Indexing::FirstAxis
        } else {
            return None;
        };
        let points = (0..nx * ny * nz).map(|voxel| {
            let [i, j, k] = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
            let at = match (indexing, is_volume) {
                (Indexing::Cells, true) => [(i * ny + j) * nz + k; 3],
                (Indexing::Cells, false) => [voxel; 3],
                (Indexing::Columns, _) | (Indexing::FirstAxis, true) => [i, j, k],
                (Indexing::FirstAxis, false) => [j, i, k],
            };
            let value = |axis: usize, a: &NpyArray| a.values.get(at[axis]).or(a.values.first()).copied();
            [0, 1, 2].map(|axis| arrays.get(axis).and_then(|a| value(axis, a)).unwrap_or(0.0))
        });
        let ambiguous = indexing == Indexing::Columns && nx == ny;
        Some(Self { names, points: points.collect(), ambiguous, is_volume })
    }

    /// The lattice where the positions put it.
    ///
    /// # Errors
    /// [`NpyError::Positions`] for positions without equal steps.
    pub(super) fn place(&self, mut lattice: Lattice) -> Result<Lattice, NpyError> {
        let names = self.names.join(", ");
        let fault = |position| NpyError::Positions { names: names.clone(), position };
        let found = PointLattice::of(&self.points, lattice.size).map_err(fault)?;
        let mut image = ImageData::empty(lattice.size);
        found.place(&mut image);
        let d = image.direction.unwrap_or(crate::volume::IDENTITY);
        lattice.axes = [0, 1, 2].map(|a| [0, 1, 2].map(|i| d[3 * i + a] * image.spacing[a]));
        lattice.origin = image.origin;
        lattice.world = World::Viewer;
        lattice.notes.retain(|note| !note.starts_with("indexed"));
        lattice.remarks.retain(|remark| remark != AXES_OF_VOLUMES);
        lattice.notes.push(format!("cells at the positions {names}"));
        if let Some(axis) = lattice.vertical_axis().filter(|_| !self.is_volume) {
            lattice.remarks.push(taken_upwards(axis));
        }
        if self.is_volume {
            // Whoever has positions has components along the same axes, rather than along those of the array.
            lattice.frame = (Frame::World, Known::Assumed);
            let names = world_axes(&lattice.axes).map(|axis| ["x", "y", "z"][axis]);
            if names != ["x", "y", "z"] {
                lattice.remarks.push(format!(
                    "the axes of the array run along the world's {}: --slice and --plane name and count those of the array",
                    names.join(", ")
                ));
            }
        }
        if self.ambiguous {
            let warning = format!(
                "{names} taken along columns and rows, as numpy.meshgrid has them (not indexing=\"ij\")"
            );
            lattice.warnings.push(warning);
        }
        Ok(lattice)
    }
}
