//! Tensors to transmission profiles (thesis, section 3.3).

use crate::reflection::Reflections;
use crate::{
    Below, Cell, CoreError, Directions, Field, Grid, Normalization, PolarProfile, Reflection, Svd, Tensor2,
    TotalAnisotropy, math,
};

/// Shape of one tensor's transmission: `samples` relative to the major semi-axis, and that semi-axis.
struct Shape {
    samples: Vec<f64>,
    s1: f64,
}

/// Samples of the ellipse of `t` (eq. 3.6) or of its pulse, in units of the tensor.
///
/// `r(w) = s1 s2 / sqrt(s1^2 sin^2(w - phi) + s2^2 cos^2(w - phi))`; for total anisotropy (s1 = 0, s2 = 0 or
/// s1/s2 > 20) height s1 at the sample nearest to phi and the one opposite, 0 elsewhere.
#[must_use]
pub fn transmission_ellipse(t: &Tensor2, directions: Directions) -> PolarProfile {
    let shape = Shape::of(t, directions, TotalAnisotropy::PUBLISHED);
    PolarProfile::from_fn(directions, |i| shape.samples[i] * shape.s1)
}

/// What turns the tensors of a field into transmission profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileRule {
    /// How profiles are scaled against each other.
    pub normalization: Normalization,
    /// Which tensors transmit along one axis only.
    pub total_anisotropy: TotalAnisotropy,
}

/// With the published program's ratio of total anisotropy.
impl From<Normalization> for ProfileRule {
    fn from(normalization: Normalization) -> Self {
        Self { normalization, total_anisotropy: TotalAnisotropy::PUBLISHED }
    }
}

impl Shape {
    fn of(t: &Tensor2, directions: Directions, total_anisotropy: TotalAnisotropy) -> Self {
        let svd = Svd::of(t);
        let [s1, s2] = svd.s;
        let weight = total_anisotropy.pulse_weight(s1, s2);
        let mut samples = vec![0.0; directions.count()];
        if weight < 1.0 {
            let q = svd.axis_ratio().max(total_anisotropy.least_axis_ratio());
            add_ellipse(&mut samples, svd.major().to_array(), q, directions, 1.0 - weight);
        }
        if weight > 0.0 {
            let (n, peak) = (samples.len(), directions.nearest(math::degrees(svd.phi_rad())));
            samples[peak] += weight;
            samples[(peak + n / 2) % n] += weight;
        }
        Self { samples, s1 }
    }

    fn mean(&self) -> f64 {
        self.samples.iter().sum::<f64>() / self.samples.len() as f64
    }
}

/// Adds `weight` times the ellipse along (ux, uy) with the ratio q of its axes, in units of the major one.
fn add_ellipse(samples: &mut [f64], [ux, uy]: [f64; 2], q: f64, directions: Directions, weight: f64) {
    let n = samples.len();
    for i in 0..n / 2 {
        let [wx, wy] = directions.unit(i);
        // Cosine and sine of the angle to the major semi-axis.
        let along = wx * ux + wy * uy;
        let across = wy * ux - wx * uy;
        let r = weight * (q / (across * across + q * q * along * along).sqrt());
        samples[i] += r;
        samples[i + n / 2] += r;
    }
}

/// The transmission of every cell: a profile of mean 1 and a rate in [0, 1].
///
/// The method's `T` is `rate * profile` and its mean `Tbar` is the rate. Splitting them makes `Tbar <= 1`, on which
/// energy conservation rests, a property of the type; and since the scheme normalises every cell's output
/// (eq. 3.12), only the shape of the profile and the rate have any effect.
#[derive(Clone, Debug, PartialEq)]
pub struct TransmissionField {
    grid: Grid,
    directions: Directions,
    shapes: Vec<f64>,
    rates: Vec<f64>,
    reflections: Reflections,
}

/// What [`TransmissionField::assembled`] puts into a cell.
#[derive(Clone, Copy, Debug)]
pub enum CellTransmission<'a> {
    /// The same in every direction, a rate from 0 to 1.
    Isotropic(f64),
    /// That of a tensor, with the rate that a field gives it.
    Tensor(&'a Tensor2, &'a RateScale),
}

/// The profiles of the tensors of a field, and the rates that a normalisation gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateScale {
    rule: ProfileRule,
    /// Binary exponent of the largest semi-axis: means are taken relative to it, so that no product overflows or
    /// vanishes.
    exponent: i32,
    /// Largest mean of the field's profiles, relative; 0 where the normalisation has no need of it.
    greatest_mean: f64,
}

impl RateScale {
    /// Of all `tensors`, their profiles sampled in `directions`.
    ///
    /// # Errors
    /// [`CoreError::NonFiniteTensor`] for the first tensor that is not finite, [`CoreError::Fraction`].
    pub fn of(
        tensors: &Field<Tensor2>,
        directions: Directions,
        rule: impl Into<ProfileRule>,
    ) -> Result<Self, CoreError> {
        let rule = rule.into();
        if let Some(cell) = tensors.first_non_finite() {
            return Err(CoreError::NonFiniteTensor { x: cell.x, y: cell.y });
        }
        if let Normalization::LocalAbove { fraction, .. } = rule.normalization
            && !(0.0..=1.0).contains(&fraction)
        {
            return Err(CoreError::Fraction { fraction });
        }
        let largest = tensors.values().iter().fold(0.0, |m: f64, t| m.max(Svd::of(t).s[0]));
        let mut scale = Self { rule, exponent: math::binary_exponent(largest), greatest_mean: 0.0 };
        if rule.normalization != Normalization::Local {
            let means = tensors.values().iter().map(|t| scale.mean(&scale.shape(t, directions)));
            scale.greatest_mean = means.fold(0.0, f64::max);
        }
        Ok(scale)
    }

    fn shape(&self, t: &Tensor2, directions: Directions) -> Shape {
        Shape::of(t, directions, self.rule.total_anisotropy)
    }

    /// Mean of a profile, relative.
    fn mean(&self, shape: &Shape) -> f64 {
        shape.mean() * math::scale_by_power_of_two(shape.s1, -self.exponent)
    }

    fn rate(&self, shape: &Shape) -> f64 {
        let mean = self.mean(shape);
        let global = || if self.greatest_mean > 0.0 { mean / self.greatest_mean } else { 0.0 };
        match self.rule.normalization {
            _ if shape.s1 == 0.0 => 0.0,
            Normalization::Global => global(),
            Normalization::Local => 1.0,
            Normalization::LocalAbove { fraction, .. } if mean >= fraction * self.greatest_mean => 1.0,
            Normalization::LocalAbove { below: Below::Absorb, .. } => 0.0,
            Normalization::LocalAbove { below: Below::Global, .. } => global(),
        }
    }
}

impl TransmissionField {
    /// Most samples, cells times directions: 4096 x 4096 cells in 32 directions, 4 GiB here and as much in the light.
    pub const MAX_SAMPLES: usize = crate::limits::MAX_SAMPLES;

    /// Transmission of a tensor field.
    ///
    /// # Errors
    /// As [`RateScale::of`]; [`CoreError::TooManySamples`].
    pub fn from_tensors(
        tensors: &Field<Tensor2>,
        directions: Directions,
        rule: impl Into<ProfileRule>,
    ) -> Result<Self, CoreError> {
        let scale = RateScale::of(tensors, directions, rule)?;
        Self::assembled(tensors.grid(), directions, |cell| CellTransmission::Tensor(tensors.at(cell), &scale))
    }

    /// Transmission given as profiles, `T` itself, row-major.
    ///
    /// # Errors
    /// [`CoreError::ValueCount`], [`CoreError::ProfileLength`], [`CoreError::TransmissionRange`] for a profile with a
    /// negative sample or a mean above 1 (it would create light), [`CoreError::TransmissionAsymmetric`] for one that
    /// differs between opposite directions: a fibre transmits both ways, and the reduced engine relies on it.
    pub fn from_profiles(
        grid: Grid,
        directions: Directions,
        profiles: &[PolarProfile],
    ) -> Result<Self, CoreError> {
        if profiles.len() != grid.cells() {
            let (width, height) = (grid.width(), grid.height());
            return Err(CoreError::ValueCount { values: profiles.len(), width, height });
        }
        let mut field = Self::empty(grid, directions)?;
        for (cell, p) in grid.iter().zip(profiles) {
            let expected = directions.count();
            if p.directions() != directions {
                return Err(CoreError::ProfileLength { samples: p.samples().len(), expected });
            }
            // A mean of 1 computed from S samples may exceed it by rounding.
            let mean = p.mean();
            let opposite = |t: usize| p.samples()[(t + expected / 2) % expected];
            if let Some(sample) =
                (0..expected).find(|&t| (p.samples()[t] - opposite(t)).abs() > f64::EPSILON * mean)
            {
                return Err(CoreError::TransmissionAsymmetric { x: cell.x, y: cell.y, sample });
            }
            if p.samples().iter().any(|&v| v < 0.0) || mean > 1.0 + f64::EPSILON * expected as f64 {
                return Err(CoreError::TransmissionRange { x: cell.x, y: cell.y, mean });
            }
            field.push(p.samples(), mean, mean.min(1.0));
        }
        Ok(field)
    }

    /// Transmission put together cell by cell: a scene.
    ///
    /// # Errors
    /// [`CoreError::Rate`], [`CoreError::TooManySamples`].
    pub fn assembled<'a>(
        grid: Grid,
        directions: Directions,
        mut of: impl FnMut(Cell) -> CellTransmission<'a>,
    ) -> Result<Self, CoreError> {
        let mut field = Self::empty(grid, directions)?;
        let even = vec![1.0; directions.count()];
        for cell in grid.iter() {
            match of(cell) {
                CellTransmission::Isotropic(rate) if (0.0..=1.0).contains(&rate) => {
                    field.push(&even, 1.0, rate)
                }
                CellTransmission::Isotropic(rate) => {
                    return Err(CoreError::Rate { x: cell.x, y: cell.y, rate });
                }
                CellTransmission::Tensor(tensor, scale) => {
                    let shape = scale.shape(tensor, directions);
                    field.push(&shape.samples, shape.mean(), scale.rate(&shape));
                }
            }
        }
        Ok(field)
    }

    /// The same with cells that send light back, and transmit nothing.
    ///
    /// # Panics
    /// Where a cell lies outside of the grid.
    #[must_use]
    pub fn with_reflections(mut self, reflections: impl IntoIterator<Item = (Cell, Reflection)>) -> Self {
        let n = self.directions.count();
        for (cell, reflection) in reflections {
            let i = self.grid.index(cell);
            self.shapes[i * n..(i + 1) * n].fill(0.0);
            self.rates[i] = 0.0;
            self.reflections.insert(i, reflection);
        }
        self
    }

    fn empty(grid: Grid, directions: Directions) -> Result<Self, CoreError> {
        let (cells, count) = (grid.cells(), directions.count());
        if cells.saturating_mul(count) > Self::MAX_SAMPLES {
            return Err(CoreError::TooManySamples { cells, directions: count });
        }
        let shapes = Vec::with_capacity(cells * count);
        Ok(Self {
            grid,
            directions,
            shapes,
            rates: Vec::with_capacity(cells),
            reflections: Reflections::default(),
        })
    }

    fn push(&mut self, samples: &[f64], mean: f64, rate: f64) {
        let rate = if mean > 0.0 { rate } else { 0.0 };
        self.rates.push(rate);
        // An absorbing cell keeps no shape: nothing may pass it.
        self.shapes.extend(samples.iter().map(|&v| if rate > 0.0 { v / mean } else { 0.0 }));
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// The angular sampling.
    #[must_use]
    pub const fn directions(&self) -> Directions {
        self.directions
    }
    /// Profile of a cell, scaled to mean 1; all 0 where the rate is 0.
    #[must_use]
    pub fn shape(&self, cell: Cell) -> &[f64] {
        let (i, n) = (self.grid.index(cell), self.directions.count());
        &self.shapes[i * n..(i + 1) * n]
    }
    /// `Tbar` of a cell: the fraction of arriving light that is passed on, 0 to 1.
    #[must_use]
    pub fn rate(&self, cell: Cell) -> f64 {
        self.rates[self.grid.index(cell)]
    }
    /// The rates in row-major order.
    #[must_use]
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }
    /// What a reflecting cell does. Its rate and its shape are 0: it transmits nothing, and nor does a light inside it.
    #[must_use]
    pub fn reflection(&self, cell: Cell) -> Option<&Reflection> {
        self.reflections.of(self.grid.index(cell))
    }
    /// All reflecting cells, row-major.
    pub fn reflections(&self) -> impl Iterator<Item = (Cell, &Reflection)> {
        self.reflections.iter(self.grid.width())
    }
    /// `T` of a cell: `rate * shape`.
    #[must_use]
    pub fn profile(&self, cell: Cell) -> PolarProfile {
        let (shape, rate) = (self.shape(cell), self.rate(cell));
        PolarProfile::from_fn(self.directions, |t| shape[t] * rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::is_totally_anisotropic;

    fn directions(s: usize) -> Directions {
        Directions::new(s).expect("directions")
    }

    fn row(tensors: Vec<Tensor2>) -> Field<Tensor2> {
        Field::from_values(Grid::new(tensors.len(), 1).expect("a grid"), tensors).expect("a field")
    }

    #[test]
    fn ellipse_reaches_its_semi_axes() {
        let p = transmission_ellipse(&Tensor2::from_axes(math::FRAC_PI_4, 4.0, 0.5), directions(32));
        assert!((p.samples()[4] - 4.0).abs() < 1e-14 && (p.samples()[12] - 0.5).abs() < 1e-14);
        assert_eq!(p.samples()[4], p.samples()[20]);
    }

    #[test]
    fn thin_tensors_become_pulses() {
        let p = transmission_ellipse(&Tensor2::symmetric(0.0, 0.0, 3.0), directions(16));
        let lit: Vec<usize> = (0..16).filter(|&t| p.samples()[t] != 0.0).collect();
        assert_eq!(lit, [4, 12]);
        assert_eq!(p.samples()[4], 3.0);
        assert!(is_totally_anisotropic(&Tensor2::symmetric(20.1, 0.0, 1.0)));
        assert!(!is_totally_anisotropic(&Tensor2::symmetric(20.0, 0.0, 1.0)));
        assert!(is_totally_anisotropic(&Tensor2::ZERO));
    }

    /// Between ellipse and pulse, sample by sample; outside of its interval a blend is one of the two.
    #[test]
    fn blended_profiles_lie_between_ellipse_and_pulse() {
        let d = directions(32);
        let samples = |ratio: f64, rule| Shape::of(&Tensor2::from_axes(0.3, ratio, 1.0), d, rule).samples;
        let [smooth, none] = [TotalAnisotropy::SMOOTH, TotalAnisotropy::NONE];
        let pulse = TotalAnisotropy::new(1.0, 1.0).expect("a rule");
        assert_eq!(samples(9.0, smooth), samples(9.0, none));
        assert_eq!(samples(41.0, smooth), samples(41.0, pulse));
        let capped = samples(41.0, TotalAnisotropy::CAPPED).into_iter().zip(samples(20.0, none));
        assert!(capped.into_iter().all(|(a, b)| (a - b).abs() < 1e-13));
        let weight = smooth.pulse_weight(15.0, 1.0);
        let both = samples(15.0, none).into_iter().zip(samples(15.0, pulse));
        for (found, (ellipse, pulse)) in samples(15.0, smooth).into_iter().zip(both) {
            assert!((found - (1.0 - weight) * ellipse - weight * pulse).abs() < 1e-15);
        }
    }

    #[test]
    fn normalisations_set_the_rates() {
        let f = row(vec![
            Tensor2::isotropic(2.0),
            Tensor2::isotropic(1.0),
            Tensor2::isotropic(0.25),
            Tensor2::ZERO,
        ]);
        let rates =
            |n| TransmissionField::from_tensors(&f, directions(16), n).expect("a field").rates().to_vec();
        assert_eq!(rates(Normalization::Global), [1.0, 0.5, 0.125, 0.0]);
        assert_eq!(rates(Normalization::Local), [1.0, 1.0, 1.0, 0.0]);
        let above = |below| Normalization::LocalAbove { fraction: 0.25, below };
        assert_eq!(rates(above(Below::Absorb)), [1.0, 1.0, 0.0, 0.0]);
        assert_eq!(rates(above(Below::Global)), [1.0, 1.0, 0.125, 0.0]);
    }

    #[test]
    fn shapes_have_mean_one_at_any_scale() {
        for scale in [1e-300, 1.0, 1e200, 1e307] {
            let f = row(vec![Tensor2::from_axes(0.4, 1.0, 0.1).scaled(scale), Tensor2::isotropic(scale)]);
            let t =
                TransmissionField::from_tensors(&f, directions(64), Normalization::Global).expect("a field");
            for cell in f.grid().iter() {
                let mean = t.shape(cell).iter().sum::<f64>() / 64.0;
                assert!((mean - 1.0).abs() < 1e-14, "scale {scale:e}: mean {mean}");
                assert!(t.rate(cell) <= 1.0 && t.rate(cell) > 0.0);
            }
        }
    }

    #[test]
    fn assembled_cells_keep_what_they_are_made_of() {
        let d = directions(16);
        let tensors = row(vec![Tensor2::from_axes(0.4, 1.0, 0.2), Tensor2::from_axes(0.4, 0.5, 0.1)]);
        let crystal = TransmissionField::from_tensors(&tensors, d, Normalization::Global).expect("a field");
        let mut shares = [[0.0; 8]; 8];
        shares[4][0] = 1.0;
        let wall = Reflection::new(shares).expect("a reflection");
        let grid = Grid::new(2, 2).expect("a grid");
        let scale = RateScale::of(&tensors, d, Normalization::Global).expect("a scale");
        let made = TransmissionField::assembled(grid, d, |c| match (c.x, c.y) {
            (x, 0) => CellTransmission::Tensor(tensors.at(Cell::new(x, 0)), &scale),
            _ => CellTransmission::Isotropic(0.25),
        });
        let made = made.expect("a field").with_reflections([(Cell::new(1, 1), wall.clone())]);
        assert_eq!(made.shape(Cell::new(1, 0)), crystal.shape(Cell::new(1, 0)));
        assert_eq!(made.rates(), [1.0, crystal.rates()[1], 0.25, 0.0]);
        assert_eq!(made.reflection(Cell::new(1, 1)), Some(&wall));
        assert_eq!(made.reflections().map(|(c, _)| c).collect::<Vec<_>>(), [Cell::new(1, 1)]);
        assert_eq!(made.reflection(Cell::new(0, 1)), None);
        assert_eq!(made.shape(Cell::new(1, 1)), [0.0; 16]);
        let bright = TransmissionField::assembled(grid, d, |_| CellTransmission::Isotropic(1.5));
        assert_eq!(bright, Err(CoreError::Rate { x: 0, y: 0, rate: 1.5 }));
    }

    #[test]
    fn more_samples_than_fit_are_refused_before_they_are_made() {
        let grid = Grid::new(4096, 4096).expect("a grid");
        let made = TransmissionField::assembled(grid, directions(40), |_| CellTransmission::Isotropic(1.0));
        assert_eq!(made, Err(CoreError::TooManySamples { cells: 1 << 24, directions: 40 }));
    }

    #[test]
    fn bad_fields_are_refused() {
        let f = row(vec![Tensor2::IDENTITY, Tensor2::new(0.0, f64::NAN, 0.0, 0.0)]);
        let e = TransmissionField::from_tensors(&f, directions(8), Normalization::Local);
        assert_eq!(e, Err(CoreError::NonFiniteTensor { x: 1, y: 0 }));
        let n = Normalization::LocalAbove { fraction: 1.5, below: Below::Absorb };
        let e = TransmissionField::from_tensors(&row(vec![Tensor2::IDENTITY]), directions(8), n);
        assert_eq!(e, Err(CoreError::Fraction { fraction: 1.5 }));
    }

    #[test]
    fn profiles_that_create_light_are_refused() {
        let (g, d) = (Grid::new(1, 1).expect("a grid"), directions(8));
        let bright = PolarProfile::constant(d, 1.32);
        assert!(matches!(
            TransmissionField::from_profiles(g, d, &[bright]),
            Err(CoreError::TransmissionRange { x: 0, y: 0, .. })
        ));
        let half =
            TransmissionField::from_profiles(g, d, &[PolarProfile::constant(d, 0.5)]).expect("a field");
        assert_eq!((half.rate(Cell::new(0, 0)), half.shape(Cell::new(0, 0))[3]), (0.5, 1.0));
    }
}
