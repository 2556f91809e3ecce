//! Masks of other files.

use super::choice::PlaneChoice;
use super::lattice::Lattice;
use super::meaning::World;

/// How a mask of another file lies over a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Both at the same points, or both in the same order without a place.
    Coincident,
    /// One of the two has no place: the picture of the one over that of the other.
    Pictures,
    /// The same of whole volumes: voxel over voxel.
    Voxels,
    /// Voxel over voxel, although they lie at other points.
    Elsewhere,
    /// Voxel over voxel, in worlds that cannot be compared.
    Incomparable,
}

/// Distance of points that are the same, relative to the smallest step.
const SAME_POINT: f64 = 1e-2;

impl Lattice {
    /// Takes a mask of another file: a voxel keeps the smaller of both confidences, and what the mask's own file leaves
    /// out is left out. A mask of one layer without a place, or over a layer without one, is laid out as the picture
    /// is: top row over top row. Where an axis of one lattice runs against that of the other, as far as both say where
    /// they lie, the mask is turned round along it. `None`, and nothing is masked, where the sizes do not fit.
    ///
    /// # Panics
    /// Where the mask holds tuples.
    pub fn mask_by(&mut self, mask: &Self) -> Option<Overlay> {
        assert!(mask.components == 1, "a mask has single numbers");
        let (overlay, partners) = self.over(mask)?;
        let confidence = |voxel: usize| {
            let own = self.mask.as_ref().and_then(|m| m.get(voxel).copied());
            let of_mask = mask.values[partners[voxel]];
            let is_left_out = mask.mask.as_ref().is_some_and(|m| m.get(partners[voxel]) == Some(&0.0));
            // What is not a number is no confidence.
            let both = own.map_or(of_mask, |own| if own < of_mask { own } else { of_mask });
            if both.is_nan() || is_left_out { both.min(0.0) } else { both }
        };
        self.mask = Some((0..self.voxels()).map(confidence).collect());
        Some(overlay)
    }

    /// How a mask lies over the lattice, and the mask's voxel over each voxel.
    fn over(&mut self, mask: &Self) -> Option<(Overlay, Vec<usize>)> {
        let absent = [self, mask].map(|l| l.world == World::Absent);
        let is_same_order =
            absent == [true; 2] && self.size == mask.size && self.directions() == mask.directions();
        if absent.contains(&true)
            && !is_same_order
            && let (Ok(own), Ok(other)) = (self.cut(PlaneChoice::default()), mask.cut(PlaneChoice::default()))
        {
            let (own, other) = (own.field(|voxel| voxel), other.field(|voxel| voxel));
            if own.grid() != other.grid() {
                return None;
            }
            let mut partners = vec![0; self.voxels()];
            own.values().iter().zip(other.values()).for_each(|(voxel, over)| partners[*voxel] = *over);
            return Some((Overlay::Pictures, partners));
        }
        if self.size != mask.size {
            return None;
        }
        if absent.contains(&true) {
            let overlay = if absent == [true; 2] { Overlay::Coincident } else { Overlay::Voxels };
            return Some((overlay, (0..self.voxels()).collect()));
        }
        let Some(signs) = self.signs_beside(mask) else {
            return Some((Overlay::Incomparable, (0..self.voxels()).collect()));
        };
        let reversed = self.reversed_by(mask, signs);
        let names: Vec<&str> = (0..3).filter(|&a| reversed[a]).map(|a| ["x", "y", "z"][a]).collect();
        if !names.is_empty() {
            let names = names.join(" and ");
            self.notes.push(format!("the mask turned round along {names}, where its axes run the other way"));
        }
        let [nx, ny, _] = self.size;
        let partner = |voxel: usize| {
            let at = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
            let [x, y, z] = [0, 1, 2].map(|a| if reversed[a] { self.size[a] - 1 - at[a] } else { at[a] });
            (z * ny + y) * nx + x
        };
        let overlay =
            if self.coincides(mask, signs, reversed) { Overlay::Coincident } else { Overlay::Elsewhere };
        Some((overlay, (0..self.voxels()).map(partner).collect()))
    }

    /// Signs that turn the axes of both worlds into those of one; `None` where nobody knows how these lie to each
    /// other.
    fn signs_beside(&self, mask: &Self) -> Option<[[f64; 3]; 2]> {
        match (self.world.signs(), mask.world.signs()) {
            (Some(own), Some(other)) => Some([own, other]),
            _ if self.world == mask.world => Some([[1.0; 3]; 2]),
            _ => None,
        }
    }

    /// The axes of several voxels along which a mask of the same size runs the other way.
    fn reversed_by(&self, mask: &Self, signs: [[f64; 3]; 2]) -> [bool; 3] {
        [0, 1, 2].map(|axis| {
            let (own, other) = (signed(self.axes[axis], signs[0]), signed(mask.axes[axis], signs[1]));
            self.size[axis] > 1 && (0..3).map(|i| own[i] * other[i]).sum::<f64>() < 0.0
        })
    }

    /// Whether a mask of the same size, turned round along some axes, is at the same points. The thickness of a single
    /// layer moves none.
    fn coincides(&self, mask: &Self, signs: [[f64; 3]; 2], reversed: [bool; 3]) -> bool {
        let long = || (0..3).filter(|&axis| self.size[axis] > 1);
        let spacing = self.spacing();
        let step = long().map(|axis| spacing[axis]).fold(f64::INFINITY, f64::min);
        let step = if step.is_finite() { step } else { spacing.into_iter().fold(f64::INFINITY, f64::min) };
        let near = |own: [f64; 3], other: [f64; 3]| {
            let (own, other) = (signed(own, signs[0]), signed(other, signs[1]));
            (0..3).all(|i| (own[i] - other[i]).abs() <= SAME_POINT * step)
        };
        let mut first = mask.origin;
        for axis in long().filter(|&axis| reversed[axis]) {
            let last = (self.size[axis] - 1) as f64;
            (0..3).for_each(|i| first[i] += last * mask.axes[axis][i]);
        }
        let turned = |axis: usize| mask.axes[axis].map(|v| if reversed[axis] { -v } else { v });
        near(self.origin, first) && long().all(|axis| near(self.axes[axis], turned(axis)))
    }
}

fn signed(v: [f64; 3], signs: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| signs[i] * v[i])
}
