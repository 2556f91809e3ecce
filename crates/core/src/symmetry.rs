//! Whether the tensors of a field are symmetric, up to what a file can hold.
//!
//! Files keep six digits or single precision, and what was averaged, turned or interpolated has lost more. Whether a
//! field is symmetric is therefore asked of the field as a whole, with one number that the rounding of no cell moves;
//! whether a tensor of it is, with a tolerance in the unit of the field, because rounding of a sum is as large where
//! the sum is nearly zero.

use crate::{Field, Tensor2};

/// How far the tensors of a field are from symmetric ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetry {
    ratio: f64,
    largest: f64,
}

impl Symmetry {
    /// A field is symmetric below this [`Symmetry::ratio`]. Single precision leaves 1e-7 and text of four digits 1e-4;
    /// the rotation of a measured flow, or of a field made of rotations times axes, is some tenths.
    pub const SYMMETRIC_BELOW: f64 = 1e-3;
    /// A tensor is symmetric if `|xy - yx|` is at most this fraction of the largest component of its field: a hundred
    /// times the rounding of single precision.
    pub const ROUNDING: f64 = 1e-5;

    /// Of all tensors that are finite; the others say nothing.
    #[must_use]
    pub fn of(field: &Field<Tensor2>) -> Self {
        let finite = || field.values().iter().filter(|t| t.is_finite());
        let largest = finite().fold(0.0, |m: f64, t| m.max(t.max_abs()));
        // Each divided by the largest: squares neither overflow nor vanish.
        let (mut off, mut all) = (0.0, 0.0);
        for t in finite().filter(|_| largest > 0.0) {
            let [xx, xy, yx, yy] = t.components().map(|c| c / largest);
            off += 0.5 * (xy - yx) * (xy - yx);
            all += xx * xx + xy * xy + yx * yx + yy * yy;
        }
        let ratio = if all > 0.0 { (off / all).sqrt() } else { 0.0 };
        Self { ratio, largest }
    }

    /// Root of the mean square of the antisymmetric parts over that of the tensors (Frobenius norms): 0 for symmetric
    /// tensors, 1 for those that only turn.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Whether the field counts as symmetric.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.ratio < Self::SYMMETRIC_BELOW
    }

    /// Whether one tensor of the field counts as symmetric; one that is not finite does.
    #[must_use]
    pub fn has_symmetric(&self, t: &Tensor2) -> bool {
        t.is_symmetric_within(Self::ROUNDING * self.largest) || !t.is_finite()
    }
}

impl Field<Tensor2> {
    /// The symmetric parts of a field that counts as symmetric ([`Symmetry::of`]), so that rounding has no axes and no
    /// complex eigenvalues of its own; any other field as it is. Exactly symmetric tensors keep their bits.
    #[must_use]
    pub fn without_rounding(&self) -> Self {
        let is_exact = self.values().iter().all(|t| t.asymmetry() == 0.0);
        if is_exact || !Symmetry::of(self).is_symmetric() {
            return self.clone();
        }
        self.map(|t| if t.is_finite() { t.symmetric_part() } else { *t })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cell, Grid};

    fn field(t: impl Fn(Cell) -> Tensor2) -> Field<Tensor2> {
        Field::from_fn(Grid::new(21, 15).expect("a size"), t)
    }

    #[test]
    fn rounding_in_one_cell_does_not_affect_symmetry() {
        for off in [2e-9, 1e-7, 1e-4, 1e-2] {
            let rounded = field(|c| {
                let more = if c == Cell::new(3, 4) { off } else { 0.0 };
                Tensor2::new(2.0, 1.0 + more, 1.0, -5.0)
            });
            let symmetry = Symmetry::of(&rounded);
            assert!(symmetry.is_symmetric(), "{off}: {}", symmetry.ratio());
            assert!(rounded.without_rounding().values().iter().all(|t| t.asymmetry() == 0.0));
        }
    }

    #[test]
    fn the_ratio_is_the_share_of_the_antisymmetric_part() {
        assert_eq!(Symmetry::of(&field(|_| Tensor2::new(0.0, -2.0, 2.0, 0.0))).ratio(), 1.0);
        assert_eq!(Symmetry::of(&field(|_| Tensor2::symmetric(1.0, 3.0, -2.0))).ratio(), 0.0);
        assert_eq!(Symmetry::of(&field(|_| Tensor2::ZERO)).ratio(), 0.0);
        for scale in [1.0, 1e-200, 1e200] {
            // Antisymmetric (0, 1), symmetric (1, 1, -1): squares 2 and 4.
            let t = Tensor2::new(1.0, 2.0, 0.0, -1.0).scaled(scale);
            let ratio = Symmetry::of(&field(|_| t)).ratio();
            assert!((ratio - (2.0_f64 / 6.0).sqrt()).abs() < 1e-15, "{scale}: {ratio}");
            assert_eq!(field(|_| t).without_rounding(), field(|_| t));
        }
    }

    #[test]
    fn symmetry_of_a_tensor_is_relative_to_its_field() {
        // Tiny beside a large tensor: the asymmetry of its shear components is rounding.
        let weak = Tensor2::new(1e-6, 3e-7, -2e-7, 0.0);
        let all = field(|c| if c == Cell::new(0, 0) { weak } else { Tensor2::symmetric(3.0, 1.0, 0.5) });
        let symmetry = Symmetry::of(&all);
        assert!(symmetry.has_symmetric(&weak) && symmetry.is_symmetric());
        assert!(!Symmetry::of(&field(|_| weak)).has_symmetric(&weak));
        assert!(!symmetry.has_symmetric(&Tensor2::new(3.0, 1.001, 1.0, 0.5)));
    }

    #[test]
    fn non_finite_tensors_do_not_affect_symmetry() {
        for bad in [f64::NAN, f64::INFINITY] {
            let broken = Tensor2::new(bad, 0.0, 1.0, 0.0);
            let all = field(|c| if c.x == 0 { broken } else { Tensor2::new(2.0, 1.0 + 1e-9, 1.0, 0.0) });
            assert!(Symmetry::of(&all).is_symmetric() && Symmetry::of(&all).has_symmetric(&broken));
            assert!(all.without_rounding().at(Cell::new(1, 1)).asymmetry() == 0.0);
            assert!(Symmetry::of(&field(|_| broken)).is_symmetric());
        }
    }
}
