//! Cells that send light back: walls of a scene.

use crate::{Cell, CoreError};

/// The reflection of arriving light by a cell: an 8 x 8 matrix of shares from 0 to 1.
///
/// A cell with a tensor passes its light on in a shape of its own and therefore normalises it (eq. 3.12). A wall does
/// the same to all arriving light: it is linear, its columns add up to its reflectance, and what is missing to 1 is
/// absorbed.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    shares: [[f64; 8]; 8],
}

impl Reflection {
    /// `shares[k][j]` of the flux that arrives in direction `j` leaves in direction `k`.
    ///
    /// # Errors
    /// [`CoreError::ReflectionRange`] for a share that is negative or not a number, or a direction of which more than
    /// all is reflected.
    pub fn new(shares: [[f64; 8]; 8]) -> Result<Self, CoreError> {
        for j in 0..8 {
            let sum: f64 = (0..8).map(|k| shares[k][j]).sum();
            // Shares that add up to 1 may exceed it by the rounding of seven additions.
            let too_much = sum > 1.0 + 8.0 * f64::EPSILON;
            if too_much || (0..8).any(|k| shares[k][j] < 0.0 || shares[k][j].is_nan()) {
                return Err(CoreError::ReflectionRange { direction: j, sum });
            }
        }
        Ok(Self { shares })
    }

    /// The matrix, `[k][j]`.
    #[must_use]
    pub const fn shares(&self) -> &[[f64; 8]; 8] {
        &self.shares
    }

    /// Flux that leaves in each direction (W) where `arriving` comes in.
    #[must_use]
    pub fn reflected(&self, arriving: &[f64; 8]) -> [f64; 8] {
        self.shares.map(|row| row.iter().zip(arriving).map(|(share, a)| share * a).sum())
    }

    /// The share of the light arriving in direction `j` that is not sent back, 0 to 1.
    #[must_use]
    pub fn absorbed(&self, j: usize) -> f64 {
        (1.0 - (0..8).map(|k| self.shares[k][j]).sum::<f64>()).max(0.0)
    }
}

/// The surface of a non-empty cell of a scene.
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
        /// Direction of its line, degrees from 0 to 180; `None` if it faces all arriving light.
        angle_deg: Option<f64>,
    },
    /// Sends light back to its side in all directions, as a diffuse wall does.
    Diffuse {
        /// Direction of its line, degrees from 0 to 180; `None` if it faces all arriving light.
        angle_deg: Option<f64>,
    },
}

impl Surface {
    /// Whether it is a wall: no light passes through, and no source can lie in it.
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
    /// Row-major order is kept; cells that come in it cost no search.
    pub(crate) fn insert(&mut self, index: usize, reflection: Reflection) {
        match self.0.last() {
            Some((last, _)) if *last >= index => match self.0.binary_search_by_key(&index, |(i, _)| *i) {
                Ok(at) => self.0[at].1 = reflection,
                Err(at) => self.0.insert(at, (index, reflection)),
            },
            _ => self.0.push((index, reflection)),
        }
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
    fn a_wall_never_reflects_more_than_arrives() {
        let mut shares = [[0.0; 8]; 8];
        shares[2][6] = 0.75;
        shares[1][6] = 0.25;
        let r = Reflection::new(shares).expect("a reflection");
        assert_eq!(r.reflected(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0])[..3], [0.0, 0.5, 1.5]);
        assert_eq!((r.absorbed(6), r.absorbed(7)), (0.0, 1.0));
        let mut all = Reflections::default();
        for index in [4, 9, 2, 9] {
            all.insert(index, r.clone());
        }
        assert_eq!(all.0.iter().map(|(i, _)| *i).collect::<Vec<_>>(), [2, 4, 9]);
        shares[3][6] = 1e-3;
        assert_eq!(Reflection::new(shares), Err(CoreError::ReflectionRange { direction: 6, sum: 1.001 }));
        shares[3][6] = -1e-3;
        assert!(Reflection::new(shares).is_err());
        shares[3][6] = f64::NAN;
        assert!(Reflection::new(shares).is_err());
    }
}
