//! What a user says about the plane of a volume.

use super::error::PlaneError;
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
    pub(super) const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

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

/// A plane of two voxel axes. Which of them runs to the right is for the world to say, see [`crate::volume::Cut`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// The first and the second axis.
    Xy,
    /// The first and the third.
    Xz,
    /// The second and the third.
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

    /// The plane of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Xy, Self::Xz, Self::Yz].into_iter().find(|p| p.name() == name)
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

    /// Its axes.
    pub(super) const fn axes(self) -> (usize, usize) {
        match self {
            Self::Xy => (0, 1),
            Self::Xz => (0, 2),
            Self::Yz => (1, 2),
        }
    }
}

/// A slice as people write it: `z=10`.
///
/// # Errors
/// What was expected.
pub fn parse_slice(text: &str) -> Result<(Axis, usize), String> {
    let parts = text.split_once('=');
    let slice = parts.and_then(|(axis, i)| Some((Axis::from_name(axis.trim())?, i.trim().parse().ok()?)));
    slice.ok_or_else(|| "expected x=INDEX, y=INDEX or z=INDEX, for example z=10".to_owned())
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
    /// A part as people write it: `10:60,0:40`.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let range = |t: &str| {
            let (a, b) = t.split_once(':')?;
            let (a, b) = (a.trim().parse().ok()?, b.trim().parse().ok()?);
            (a < b).then_some([a, b])
        };
        let crop = text.split_once(',').and_then(|(x, y)| Some(Self { x: range(x)?, y: range(y)? }));
        crop.ok_or_else(|| "expected X0:X1,Y0:Y1 with X0 < X1 and Y0 < Y1, for example 10:60,0:40".to_owned())
    }

    /// The part of a field.
    ///
    /// # Errors
    /// [`PlaneError::CropRange`] for an empty part, or one that sticks out.
    pub fn of(self, field: &Field<Tensor2>) -> Result<Field<Tensor2>, IoError> {
        let (width, height) = (field.grid().width(), field.grid().height());
        let fits = |[a, b]: [usize; 2], n| a < b && b <= n;
        if !fits(self.x, width) || !fits(self.y, height) {
            return Err(PlaneError::CropRange { x: self.x, y: self.y, width, height }.into());
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
    /// [`PlaneError::Needed`], [`PlaneError::SliceNeeded`], [`PlaneError::Conflict`], [`PlaneError::SliceRange`].
    pub fn resolve(self, size: [usize; 3]) -> Result<(Plane, usize), PlaneError> {
        let flat = || [Plane::Xy, Plane::Xz, Plane::Yz].into_iter().find(|p| size[p.normal() as usize] == 1);
        let plane = match (self.plane, self.slice) {
            (Some(plane), Some((axis, _))) if plane.normal() != axis => {
                let (plane, normal, axis) = (plane.name(), plane.normal().name(), axis.name());
                return Err(PlaneError::Conflict { plane, axis, normal });
            }
            (Some(plane), _) => plane,
            (None, Some((axis, _))) => Plane::of_normal(axis),
            (None, None) => flat().ok_or(PlaneError::Needed { size })?,
        };
        let (axis, last) = (plane.normal().name(), size[plane.normal() as usize].saturating_sub(1));
        match self.slice {
            Some((_, index)) if index > last => Err(PlaneError::SliceRange { axis, index, last }),
            Some((_, index)) => Ok((plane, index)),
            None if last == 0 => Ok((plane, 0)),
            None => Err(PlaneError::SliceNeeded { plane: plane.name(), axis, last }),
        }
    }
}
