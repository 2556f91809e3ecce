//! Numbers about tensor fields and volumes: ranges, histograms and shares.

use tigereye_core::{
    Anisotropy, Eigenvalues, Field, Svd, Symmetry, Tensor2, fractional_anisotropy3, is_totally_anisotropic,
    symmetric_eigenvalues3,
};
use tigereye_io::volume::TensorVolume;
use tigereye_lines::is_complex;

/// An eigenvalue below this times the largest component counts as negative: files hold single precision.
const ROUNDING: f64 = Eigenvalues::ROUNDING;
/// Relative difference of two axes or eigenvalues below which a tensor counts as degenerate, for the same reason.
const DEGENERATE_BELOW: f64 = 1e-6;
/// Largest excess over an anisotropy of 1 by rounding; that of indefinite tensors is larger.
const FA_ROUNDING: f64 = 1e-9;
/// Bars of a histogram from 0 to 1.
const BARS: usize = 10;

/// Smallest, largest and mean value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The smallest; infinite if there are no values.
    pub min: f64,
    /// The largest; minus infinity if there are no values.
    pub max: f64,
    sum: f64,
    count: usize,
}

impl Range {
    const EMPTY: Self = Self { min: f64::INFINITY, max: f64::NEG_INFINITY, sum: 0.0, count: 0 };

    /// The range of some values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut range = Self::EMPTY;
        values.into_iter().for_each(|v| range.add(v));
        range
    }

    fn add(&mut self, value: f64) {
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        self.sum += value;
        self.count += 1;
    }

    /// The mean; 0 if there are no values.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// The distribution of fractional anisotropies.
#[derive(Clone, Debug, PartialEq)]
pub struct Anisotropies {
    /// Their range.
    pub range: Range,
    /// Counts in ten bars from 0 to 1; NaN and values outside are omitted.
    pub histogram: [usize; BARS],
    /// Number of values above 1, which belong to indefinite symmetric parts.
    pub above_one: usize,
}

impl Anisotropies {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let mut histogram = [0; BARS];
        for v in values.clone().filter(|v| (-FA_ROUNDING..=1.0 + FA_ROUNDING).contains(v)) {
            histogram[((v * BARS as f64) as usize).min(BARS - 1)] += 1;
        }
        let above_one = values.clone().filter(|v| *v > 1.0 + FA_ROUNDING).count();
        Self { range: Range::of(values), histogram, above_one }
    }
}

/// Statistics of the tensors of a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldFacts {
    /// Components xx, xy, yx, yy.
    pub components: [Range; 4],
    /// Larger and smaller singular values.
    pub singular_values: [Range; 2],
    /// Planar anisotropy.
    pub planar_anisotropy: Range,
    /// Fractional anisotropy, as of a volume of one layer.
    pub fractional_anisotropy: Anisotropies,
    /// Tensors with none, one and two eigenvalues below zero by more than rounding. Those with complex eigenvalues,
    /// which have no sign, are not among them.
    pub negative_eigenvalues: [usize; 3],
    /// Shares of kinds of tensors, by name.
    pub shares: [(&'static str, f64); 7],
}

impl FieldFacts {
    /// The facts of a field.
    #[must_use]
    pub fn of(field: &Field<Tensor2>) -> Self {
        let range = |f: &dyn Fn(&Tensor2) -> f64| Range::of(field.values().iter().map(f));
        let cells = field.grid().cells() as f64;
        let share = |test: &dyn Fn(&Tensor2) -> bool| {
            field.values().iter().filter(|t| test(t)).count() as f64 / cells
        };
        let symmetry = Symmetry::of(field);
        // Tensors that are asymmetric by rounding only have real eigenvalues.
        let plain = field.without_rounding();
        let complex = plain.values().iter().filter(|t| is_complex(t)).count() as f64 / cells;
        let mut negative_eigenvalues = [0; 3];
        let real = field.values().iter().zip(plain.values()).filter(|(_, plain)| !is_complex(plain));
        for (t, _) in real {
            negative_eigenvalues[Eigenvalues::of(t).negative()] += 1;
        }
        let negative = (negative_eigenvalues[1] + negative_eigenvalues[2]) as f64 / cells;
        Self {
            components: [Tensor2::xx, Tensor2::xy, Tensor2::yx, Tensor2::yy].map(|f| range(&f)),
            singular_values: [0, 1].map(|i| range(&|t| Svd::of(t).s[i])),
            planar_anisotropy: range(&|t| Anisotropy::of(t).planar),
            fractional_anisotropy: Anisotropies::of(
                field.values().iter().map(|t| Anisotropy::of(t).fractional),
            ),
            negative_eigenvalues,
            shares: [
                ("zero", share(&Tensor2::is_zero)),
                ("degenerate", share(&is_degenerate)),
                ("asymmetric", share(&|t| !symmetry.has_symmetric(t))),
                ("complex", complex),
                ("indefinite", share(&|t| Eigenvalues::of(t).is_indefinite())),
                ("negative", negative),
                ("total_anisotropy", share(&|t| !t.is_zero() && is_totally_anisotropic(t))),
            ],
        }
    }
}

/// Semi-axes of equal length: the direction of the tensor is undefined. Zero tensors are counted apart.
fn is_degenerate(t: &Tensor2) -> bool {
    !t.is_zero() && 1.0 - Svd::of(t).axis_ratio() <= DEGENERATE_BELOW
}

/// Statistics of the tensors of a volume, without masked ones.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeFacts {
    /// All components.
    pub components: Range,
    /// Mean trace.
    pub mean_trace: f64,
    /// Eigenvalues of the symmetric parts, the largest first.
    pub eigenvalues: [Range; 3],
    /// Fractional anisotropy.
    pub fractional_anisotropy: Anisotropies,
    /// Tensors with none to three eigenvalues below zero by more than rounding.
    pub negative_eigenvalues: [usize; 4],
    /// Number of zero tensors.
    pub zero: usize,
    /// Shares of kinds of tensors, by name.
    pub shares: [(&'static str, f64); 6],
}

impl VolumeFacts {
    /// The facts of a volume.
    #[must_use]
    pub fn of(volume: &TensorVolume) -> Self {
        let measured = || (0..volume.lattice().voxels()).filter_map(|voxel| volume.measured(voxel));
        let is_finite = |t: &[f64; 9]| t.iter().all(|v| v.is_finite());
        let largest_of_all = measured().filter(is_finite).flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
        let (mut components, mut trace) = (Range::EMPTY, Range::EMPTY);
        let mut eigenvalues = [Range::EMPTY; 3];
        let mut anisotropies = Vec::with_capacity(volume.lattice().voxels());
        let mut negative_eigenvalues = [0_usize; 4];
        let [mut zero, mut degenerate, mut asymmetric, mut indefinite, mut negative] = [0_usize; 5];
        for t in measured().filter(is_finite) {
            let largest = t.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            t.iter().for_each(|&v| components.add(v));
            trace.add(t[0] + t[4] + t[8]);
            let l = symmetric_eigenvalues3(&t);
            eigenvalues.iter_mut().zip(l).for_each(|(range, v)| range.add(v));
            anisotropies.push(fractional_anisotropy3(l));
            let off = (t[1] - t[3]).abs().max((t[2] - t[6]).abs()).max((t[5] - t[7]).abs());
            zero += usize::from(largest == 0.0);
            let close = (l[0] - l[1]).min(l[1] - l[2]) <= DEGENERATE_BELOW * largest;
            degenerate += usize::from(largest > 0.0 && close);
            asymmetric += usize::from(off > Symmetry::ROUNDING * largest_of_all);
            let below = l.iter().filter(|v| **v < -ROUNDING * largest).count();
            negative_eigenvalues[below] += 1;
            negative += usize::from(below > 0);
            indefinite += usize::from(l[2] < -ROUNDING * largest && l[0] > ROUNDING * largest);
        }
        let voxels = measured().count();
        let share = |n: usize| n as f64 / voxels.max(1) as f64;
        Self {
            components,
            mean_trace: trace.mean(),
            eigenvalues,
            fractional_anisotropy: Anisotropies::of(anisotropies.iter().copied()),
            negative_eigenvalues,
            zero,
            shares: [
                ("zero", share(zero)),
                ("not_finite", share(voxels - trace.count)),
                ("degenerate", share(degenerate)),
                ("asymmetric", share(asymmetric)),
                ("indefinite", share(indefinite)),
                ("negative", share(negative)),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    #[test]
    fn anisotropies_fall_into_ten_bars_and_above() {
        let found = Anisotropies::of([0.0, 0.05, 0.95, 1.0, 1.2, f64::NAN].into_iter());
        assert_eq!(found.histogram, [2, 0, 0, 0, 0, 0, 0, 0, 0, 2]);
        assert_eq!(found.above_one, 1);
        assert_eq!((found.range.min, found.range.max), (0.0, 1.2));
    }

    #[test]
    fn ranges_of_nothing_have_no_ends() {
        let none = Range::of([]);
        assert_eq!((none.min, none.max, none.mean()), (f64::INFINITY, f64::NEG_INFINITY, 0.0));
        assert_eq!(Range::of([1.0, 4.0, -2.0]).mean(), 1.0);
    }

    #[test]
    fn tensors_are_counted_by_what_they_are() {
        let tensors = [
            Tensor2::ZERO,
            Tensor2::IDENTITY,
            Tensor2::symmetric(1.0, 0.0, -1.0),
            Tensor2::new(0.0, -1.0, 1.0, 0.0),
        ];
        let field = Field::from_fn(Grid::new(4, 1).expect("a grid"), |c| tensors[c.x]);
        let facts = FieldFacts::of(&field);
        assert_eq!(facts.negative_eigenvalues, [2, 1, 0]);
        let share = |name| facts.shares.iter().find(|(n, _)| *n == name).map(|(_, share)| *share);
        let found = ["zero", "asymmetric", "complex", "indefinite", "negative"].map(share);
        assert_eq!(found, [Some(0.25); 5]);
        assert_eq!((facts.components[0].min, facts.components[0].max), (0.0, 1.0));
    }
}
