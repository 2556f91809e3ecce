//! From a volume to a field in a plane.

use super::{TensorVolume, World, turned};
use crate::IoError;
use tigereye_core::{Field, Grid, Tensor2};

/// A voxel axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first axis, i.
    X,
    /// The second axis, j.
    Y,
    /// The third axis, k.
    Z,
}

impl Axis {
    const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// `x`, `y` or `z`.
    #[must_use]
    pub const fn name(self) -> char {
        match self {
            Self::X => 'x',
            Self::Y => 'y',
            Self::Z => 'z',
        }
    }

    /// The axis of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|a| name.len() == 1 && name.eq_ignore_ascii_case(&a.name().to_string()))
    }
}

/// A plane of voxel axes: the first to the right, the second up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// x right, y up.
    Xy,
    /// x right, z up.
    Xz,
    /// y right, z up.
    Yz,
}

impl Plane {
    /// `xy`, `xz` or `yz`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xy => "xy",
            Self::Xz => "xz",
            Self::Yz => "yz",
        }
    }

    /// The axis that a slice is counted along.
    #[must_use]
    pub const fn normal(self) -> Axis {
        match self {
            Self::Xy => Axis::Z,
            Self::Xz => Axis::Y,
            Self::Yz => Axis::X,
        }
    }

    /// The plane of a normal.
    #[must_use]
    pub const fn of_normal(axis: Axis) -> Self {
        match axis {
            Axis::X => Self::Yz,
            Axis::Y => Self::Xz,
            Axis::Z => Self::Xy,
        }
    }

    /// The axes to the right and up.
    const fn axes(self) -> (usize, usize) {
        match self {
            Self::Xy => (0, 1),
            Self::Xz => (0, 2),
            Self::Yz => (1, 2),
        }
    }
}

/// A part of a plane: columns and rows as the field has them, row 0 on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column, and the one behind the last.
    pub x: [usize; 2],
    /// First row, and the one behind the last.
    pub y: [usize; 2],
}

impl Crop {
    /// The part of a field.
    ///
    /// # Errors
    /// [`IoError::CropRange`] for an empty part, or one that sticks out.
    pub fn of(self, field: &Field<Tensor2>) -> Result<Field<Tensor2>, IoError> {
        let (width, height) = (field.grid().width(), field.grid().height());
        let fits = |[a, b]: [usize; 2], n| a < b && b <= n;
        if !fits(self.x, width) || !fits(self.y, height) {
            return Err(IoError::CropRange { x: self.x, y: self.y, width, height });
        }
        let grid = Grid::new(self.x[1] - self.x[0], self.y[1] - self.y[0])?;
        let (x, y) = (self.x[0], self.y[0]);
        Ok(Field::from_fn(grid, |c| *field.at(tigereye_core::Cell::new(c.x + x, c.y + y))))
    }
}

/// What the user says about the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneChoice {
    /// The plane.
    pub plane: Option<Plane>,
    /// Axis and index of the slice, from 0 as the file counts.
    pub slice: Option<(Axis, usize)>,
}

impl PlaneChoice {
    /// Plane and index of the slice: as chosen, or the only plane of a flat volume.
    ///
    /// # Errors
    /// [`IoError::PlaneNeeded`], [`IoError::SliceNeeded`], [`IoError::PlaneConflict`], [`IoError::SliceRange`].
    pub fn resolve(self, size: [usize; 3]) -> Result<(Plane, usize), IoError> {
        let flat = || [Plane::Xy, Plane::Xz, Plane::Yz].into_iter().find(|p| size[p.normal() as usize] == 1);
        let plane = match (self.plane, self.slice) {
            (Some(plane), Some((axis, _))) if plane.normal() != axis => {
                let (plane, normal, axis) = (plane.name(), plane.normal().name(), axis.name());
                return Err(IoError::PlaneConflict { plane, axis, normal });
            }
            (Some(plane), _) => plane,
            (None, Some((axis, _))) => Plane::of_normal(axis),
            (None, None) => flat().ok_or(IoError::PlaneNeeded { size })?,
        };
        let (axis, last) = (plane.normal().name(), size[plane.normal() as usize].saturating_sub(1));
        match self.slice {
            Some((_, index)) if index > last => Err(IoError::SliceRange { axis, index, last }),
            Some((_, index)) => Ok((plane, index)),
            None if last == 0 => Ok((plane, 0)),
            None => Err(IoError::SliceNeeded { plane: plane.name(), axis, last }),
        }
    }
}

/// A field in a plane of a volume, and how it lies there.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorSlice {
    /// The tensors projected into the plane, row 0 on top, in the frame x right, y up of the picture.
    pub field: Field<Tensor2>,
    /// The plane.
    pub plane: Plane,
    /// Index of the slice.
    pub index: usize,
    /// Whether columns run against the voxel axis, because that points to the left in the viewer's world.
    pub columns_flipped: bool,
    /// Whether row 0 is the last voxel of the upward axis: true unless that axis points down in the viewer's world.
    pub rows_flipped: bool,
    /// Position of the lower left cell.
    pub origin: [f64; 2],
    /// Distance of the cells.
    pub spacing: [f64; 2],
}

impl TensorSlice {
    /// How the picture was made, in a sentence.
    #[must_use]
    pub fn story(&self) -> String {
        let (right, up) = self.plane.axes();
        let name = |axis: usize, backwards: bool| {
            format!("{}{}", if backwards { "-" } else { "" }, Axis::ALL[axis].name())
        };
        format!(
            "plane {}, slice {}={}: voxel axis {} to the right, {} up, the third row and column dropped; rows {}",
            self.plane.name(),
            self.plane.normal().name(),
            self.index,
            name(right, self.columns_flipped),
            name(up, !self.rows_flipped),
            if self.rows_flipped { "flipped, the file runs upwards" } else { "as in the file" }
        )
    }
}

impl TensorVolume {
    /// The field in a plane. Tensors are turned into the voxel axes and lose the third row and column, so that direction
    /// 90 degrees is up in the picture. Where the world is a viewer's, axes that run left or down are reversed, as the
    /// viewer shows them. Voxels with mask 0 become zero tensors.
    ///
    /// # Errors
    /// As [`PlaneChoice::resolve`], and [`IoError::SkewedAxes`].
    pub fn slice(&self, choice: PlaneChoice) -> Result<TensorSlice, IoError> {
        let lattice = &self.lattice;
        let (plane, index) = choice.resolve(lattice.size)?;
        let (right, up) = plane.axes();
        let turn = self.to_voxel()?;
        let directions = lattice.directions();
        let backwards = |axis: usize| {
            // Axes that are not mainly their own stay as they are: no picture shows them upright.
            let own = directions[4 * axis];
            let main = (0..3).all(|i| directions[3 * i + axis].abs() <= own.abs());
            lattice.world == World::Viewer && main && own < 0.0
        };
        let (columns_flipped, rows_flipped) = (backwards(right), !backwards(up));
        let mirrored = columns_flipped == rows_flipped;
        let (width, height) = (lattice.size[right], lattice.size[up]);
        let grid = Grid::new(width, height)?;
        let field = Field::from_fn(grid, |c| {
            let mut at = [index; 3];
            at[right] = if columns_flipped { width - 1 - c.x } else { c.x };
            at[up] = if rows_flipped { height - 1 - c.y } else { c.y };
            let voxel = (at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
            if self.is_masked(voxel) {
                return Tensor2::ZERO;
            }
            let t = self.stored(voxel);
            let t = turn.as_ref().map_or(t, |k| turned(k, &t));
            let (xx, xy) = (t[3 * right + right], t[3 * right + up]);
            let (yx, yy) = (t[3 * up + right], t[3 * up + up]);
            let plain = Tensor2::new(xx, xy, yx, yy);
            // One reversed axis changes the sign of the off-diagonal components.
            if mirrored { plain.mirrored_y() } else { plain }
        });
        let spacing = lattice.spacing();
        Ok(TensorSlice {
            field,
            plane,
            index,
            columns_flipped,
            rows_flipped,
            origin: self.corner(right, up, columns_flipped, rows_flipped),
            spacing: [spacing[right], spacing[up]],
        })
    }

    /// Position of the lower left cell: in the world where the voxel axes are the world's, else 0.
    fn corner(&self, right: usize, up: usize, columns_flipped: bool, rows_flipped: bool) -> [f64; 2] {
        let lattice = &self.lattice;
        let aligned = lattice.axes.iter().enumerate().all(|(a, v)| (0..3).all(|i| i == a || v[i] == 0.0));
        if !aligned {
            return [0.0; 2];
        }
        let far = |axis: usize, reversed: bool| {
            let steps = if reversed { lattice.size[axis] - 1 } else { 0 };
            lattice.origin[axis] + steps as f64 * lattice.axes[axis][axis]
        };
        [far(right, columns_flipped), far(up, !rows_flipped)]
    }
}
