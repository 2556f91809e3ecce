//! Results of computations. Drawing and writing depend on these types, not on the algorithms.

use crate::{Cell, Directions, Field, Grid, Vector};

/// Why a propagation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// The stopping rule was met.
    Converged,
    /// The limit on steps came first.
    StepLimit,
}

/// Work done by a propagation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Propagation steps.
    pub steps: usize,
    /// Cells passed through the scheme, summed over the steps.
    pub cell_updates: u64,
}

/// The light of every cell after a propagation.
#[derive(Clone, Debug, PartialEq)]
pub struct LightDistribution {
    grid: Grid,
    directions: Directions,
    samples: Vec<f64>,
    incoming: Field<[f64; 8]>,
}

impl LightDistribution {
    /// Assembles a distribution: `samples[cell * S + t]` is the radiant intensity (W/rad) of a cell, row-major;
    /// `incoming[cell][k]` the radiant flux (W) that its last step brought along direction `k`. Panics if the
    /// sizes do not fit: both come from one engine.
    #[must_use]
    pub fn new(directions: Directions, samples: Vec<f64>, incoming: Field<[f64; 8]>) -> Self {
        let grid = incoming.grid();
        assert_eq!(samples.len(), grid.cells() * directions.count(), "one profile per cell");
        Self { grid, directions, samples, incoming }
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
    /// All samples, cell by cell in row-major order, S per cell.
    #[must_use]
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }
    /// Intensity profile of a cell, W/rad.
    #[must_use]
    pub fn profile(&self, cell: Cell) -> &[f64] {
        let (i, n) = (self.grid.index(cell), self.directions.count());
        &self.samples[i * n..(i + 1) * n]
    }
    /// Radiant flux (W) that arrived in the last step along each of the eight directions.
    #[must_use]
    pub const fn incoming(&self) -> &Field<[f64; 8]> {
        &self.incoming
    }
    /// Energy of each cell: the integral of its profile, W.
    #[must_use]
    pub fn energy(&self) -> Field<f64> {
        let h = self.directions.step_rad();
        Field::from_fn(self.grid, |c| h * self.profile(c).iter().sum::<f64>())
    }
    /// Energy of the whole grid, W: rows first, then their sum.
    #[must_use]
    pub fn total_energy(&self) -> f64 {
        let energy = self.energy();
        energy.values().chunks(self.grid.width()).map(|row| row.iter().sum::<f64>()).sum()
    }
    /// Net radiant flux vector of each cell, W: the sum of the incoming fluxes times their unit vectors.
    #[must_use]
    pub fn net_flux(&self) -> Field<Vector> {
        self.incoming.map(|a| {
            let r = core::f64::consts::FRAC_1_SQRT_2;
            Vector::new(
                a[0] - a[4] + r * (a[1] - a[3] - a[5] + a[7]),
                a[2] - a[6] + r * (a[1] + a[3] - a[5] - a[7]),
            )
        })
    }
}

/// Counters of a sweep over sources.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SweepWork {
    /// Propagations solved.
    pub sources: u64,
    /// Steps of all propagations together.
    pub iterations_total: u64,
    /// Steps of the longest propagation.
    pub iterations_max: u64,
    /// Cells passed through the scheme.
    pub cell_updates: u64,
}

impl SweepWork {
    /// Adds the work of another part of the same sweep.
    pub fn add(&mut self, other: Self) {
        self.sources += other.sources;
        self.iterations_total += other.iterations_total;
        self.iterations_max = self.iterations_max.max(other.iterations_max);
        self.cell_updates += other.cell_updates;
    }
}

/// A light transport gradient: one value per cell and direction (eq. 3.20).
#[derive(Clone, Debug, PartialEq)]
pub struct LtgVolume {
    grid: Grid,
    directions: Directions,
    slices: Vec<usize>,
    values: Vec<f64>,
}

impl LtgVolume {
    /// Assembles a volume; `values[(i * height + y) * width + x]` belongs to direction `slices[i]`. Panics if the
    /// sizes do not fit or `slices` is not ascending.
    #[must_use]
    pub fn new(grid: Grid, directions: Directions, slices: Vec<usize>, values: Vec<f64>) -> Self {
        assert_eq!(values.len(), grid.cells() * slices.len(), "one value per cell and slice");
        assert!(slices.windows(2).all(|w| w[0] < w[1]), "slices in ascending order");
        Self { grid, directions, slices, values }
    }
    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }
    /// The angular sampling the slices refer to.
    #[must_use]
    pub const fn directions(&self) -> Directions {
        self.directions
    }
    /// Sample index of each slice, ascending.
    #[must_use]
    pub fn slices(&self) -> &[usize] {
        &self.slices
    }
    /// All values, slice by slice, each row-major.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }
    /// The slice of sample `t`, if the volume holds it.
    #[must_use]
    pub fn slice(&self, t: usize) -> Option<Field<f64>> {
        let i = self.slices.binary_search(&t).ok()?;
        let n = self.grid.cells();
        Field::from_values(self.grid, self.values[i * n..(i + 1) * n].to_vec()).ok()
    }
    /// The value at a cell and sample, if the volume holds it.
    #[must_use]
    pub fn value(&self, cell: Cell, t: usize) -> Option<f64> {
        let i = self.slices.binary_search(&t).ok()?;
        self.grid.contains(cell).then(|| self.values[i * self.grid.cells() + self.grid.index(cell)])
    }
    /// Mean over the directions held, per cell.
    #[must_use]
    pub fn mean_over_directions(&self) -> Field<f64> {
        self.flattened(|v| v.iter().sum::<f64>() / v.len() as f64)
    }
    /// Maximum over the directions held, per cell.
    #[must_use]
    pub fn max_over_directions(&self) -> Field<f64> {
        self.flattened(|v| v.iter().fold(f64::NEG_INFINITY, |m, &x| m.max(x)))
    }
    /// Standard deviation (divided by the count) over the directions held, per cell.
    #[must_use]
    pub fn deviation_over_directions(&self) -> Field<f64> {
        self.flattened(|v| {
            let mean = v.iter().sum::<f64>() / v.len() as f64;
            (v.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / v.len() as f64).sqrt()
        })
    }

    fn flattened(&self, f: impl Fn(&[f64]) -> f64) -> Field<f64> {
        let n = self.grid.cells();
        let mut column = vec![0.0; self.slices.len()];
        Field::from_fn(self.grid, |c| {
            for (i, v) in column.iter_mut().enumerate() {
                *v = self.values[i * n + self.grid.index(c)];
            }
            f(&column)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flattening_knows_its_directions() {
        let g = Grid::new(2, 1).expect("a grid");
        let d = Directions::new(8).expect("directions");
        let v = LtgVolume::new(g, d, vec![1, 4], vec![1.0, 2.0, 3.0, 6.0]);
        assert_eq!(v.mean_over_directions().values(), [2.0, 4.0]);
        assert_eq!(v.max_over_directions().values(), [3.0, 6.0]);
        assert_eq!(v.deviation_over_directions().values(), [1.0, 2.0]);
        assert_eq!(v.value(Cell::new(1, 0), 4), Some(6.0));
        assert_eq!((v.value(Cell::new(1, 0), 0), v.slice(2)), (None, None));
    }

    #[test]
    fn net_flux_points_up_for_light_going_up() {
        let g = Grid::new(1, 1).expect("a grid");
        let d = Directions::new(8).expect("directions");
        let mut a = [0.0; 8];
        a[2] = 2.0;
        let field = Field::from_values(g, vec![a]).expect("a field");
        let light = LightDistribution::new(d, vec![0.5; 8], field);
        assert_eq!(light.net_flux().values(), [Vector::new(0.0, 2.0)]);
        assert!((light.total_energy() - std::f64::consts::PI).abs() < 1e-15);
    }
}
