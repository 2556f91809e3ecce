//! Cells that send light back: walls of a scene.

use crate::{Cell, CoreError};

/// What a reflecting cell does to the light that arrives: an 8 x 8 matrix of parts from 0 to 1.
///
/// A cell with a tensor passes its light on in a shape of its own and therefore normalises it (eq. 3.12). A wall does the same
/// to whatever arrives: it is linear, its columns add up to its reflectance, and what is missing to 1 is absorbed.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    parts: [[f64; 8]; 8],
}

impl Reflection {
    /// `parts[k][j]` of the flux that arrives in direction `j` leaves in direction `k`.
    ///
    /// # Errors
    /// [`CoreError::ReflectionRange`] for a part that is negative or not a number, or a direction of which more than all is
    /// reflected.
    pub fn new(parts: [[f64; 8]; 8]) -> Result<Self, CoreError> {
        for j in 0..8 {
            let sum: f64 = (0..8).map(|k| parts[k][j]).sum();
            // Parts that add up to 1 may exceed it by the rounding of seven additions.
            let too_much = sum > 1.0 + 8.0 * f64::EPSILON;
            if too_much || (0..8).any(|k| parts[k][j] < 0.0 || parts[k][j].is_nan()) {
                return Err(CoreError::ReflectionRange { direction: j, sum });
            }
        }
        Ok(Self { parts })
    }

    /// The matrix, `[k][j]`.
    #[must_use]
    pub const fn parts(&self) -> &[[f64; 8]; 8] {
        &self.parts
    }

    /// Flux that leaves in each direction (W) where `arriving` comes in.
    #[must_use]
    pub fn reflected(&self, arriving: &[f64; 8]) -> [f64; 8] {
        self.parts.map(|row| row.iter().zip(arriving).map(|(part, a)| part * a).sum())
    }

    /// The part of the light arriving in direction `j` that is not sent back, 0 to 1.
    #[must_use]
    pub fn absorbed(&self, j: usize) -> f64 {
        (1.0 - (0..8).map(|k| self.parts[k][j]).sum::<f64>()).max(0.0)
    }
}

/// What light meets in a cell of a scene that is not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// Passes nothing on.
    Absorbing,
    /// Passes a part of the light on, in all directions alike.
    Filter {
        /// That part, 0 to 1.
        transmittance: f64,
    },
    /// Passes light on as a tensor does.
    Crystal,
    /// Sends light back as a mirror does.
    Mirror {
        /// Direction of its line, degrees from 0 to 180.
        angle_deg: f64,
    },
    /// Sends light back to its side in all directions, as a matt wall does.
    Diffuse {
        /// Direction of its line, degrees from 0 to 180.
        angle_deg: f64,
    },
}

impl Surface {
    /// Whether it is that of a wall: no light passes through, and none can be put in.
    #[must_use]
    pub const fn is_wall(&self) -> bool {
        match self {
            Self::Absorbing | Self::Mirror { .. } | Self::Diffuse { .. } => true,
            Self::Filter { .. } | Self::Crystal => false,
        }
    }
}

/// Reflecting cells of a grid, by their row-major index.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Reflections(Vec<(usize, Reflection)>);

impl Reflections {
    pub(crate) fn push(&mut self, index: usize, reflection: Reflection) {
        debug_assert!(self.0.last().is_none_or(|(last, _)| *last < index), "row-major order");
        self.0.push((index, reflection));
    }
    pub(crate) fn of(&self, index: usize) -> Option<&Reflection> {
        self.0.binary_search_by_key(&index, |(i, _)| *i).ok().map(|at| &self.0[at].1)
    }
    pub(crate) fn iter(&self, width: usize) -> impl Iterator<Item = (Cell, &Reflection)> {
        self.0.iter().map(move |(i, r)| (Cell::new(i % width, i / width), r))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_never_sends_back_more_than_arrives() {
        let mut parts = [[0.0; 8]; 8];
        parts[2][6] = 0.75;
        parts[1][6] = 0.25;
        let r = Reflection::new(parts).expect("a reflection");
        assert_eq!(r.reflected(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0])[..3], [0.0, 0.5, 1.5]);
        assert_eq!((r.absorbed(6), r.absorbed(7)), (0.0, 1.0));
        parts[3][6] = 1e-3;
        assert_eq!(Reflection::new(parts), Err(CoreError::ReflectionRange { direction: 6, sum: 1.001 }));
        parts[3][6] = -1e-3;
        assert!(Reflection::new(parts).is_err());
        parts[3][6] = f64::NAN;
        assert!(Reflection::new(parts).is_err());
    }
}
