//! Directions, schemes and transmissions with fewer words, and gradients by brute force.

use tigereye_core::{
    Cell, Directions, Field, Grid, LtgVolume, Normalization, ProfileRule, Tensor2, TransmissionField, math,
};
use tigereye_transport::{Engine, Light, Problem, SampleSpace, Scheme, SharedWeights, Stopping};

/// `samples` directions.
pub(crate) fn directions(samples: usize) -> Directions {
    Directions::new(samples).expect("a multiple of 8")
}

/// The published scheme.
pub(crate) fn scheme(samples: usize) -> Scheme {
    Scheme::new(directions(samples), SharedWeights::Thesis)
}

/// The transmission of a tensor field.
pub(crate) fn transmission(
    tensors: &Field<Tensor2>,
    samples: usize,
    normalization: Normalization,
) -> TransmissionField {
    TransmissionField::from_tensors(tensors, directions(samples), normalization).expect("finite tensors")
}

/// Semi-axes of the cells of [`thin_field`]: direction in degrees, lengths. They turn by 3 degrees from cell to cell,
/// never half-way between two samples, with ratios from 2 to 200.
pub(crate) fn thin_axes([width, height]: [usize; 2], cell: Cell) -> (f64, f64, f64) {
    let i = (cell.y * width + cell.x) as f64;
    let ratio = 2.0 * math::pow(100.0, i / (width * height - 1) as f64);
    (3.0 * i + 1.0, 0.5 + 0.01 * i, (0.5 + 0.01 * i) / ratio)
}

/// Rules of total anisotropy, as options spell them.
pub(crate) const THIN_RULES: [&str; 6] = ["20", "5", "none", "20:2", "8:4", "cap:20"];

/// The transmission of round, thin and very thin tensors under a rule of total anisotropy.
pub(crate) fn thin_field(
    size: [usize; 2],
    rule: &str,
    samples: usize,
    normalization: Normalization,
) -> TransmissionField {
    let tensors = Field::from_fn(Grid::new(size[0], size[1]).expect("a grid"), |c| {
        let (angle_deg, s1, s2) = thin_axes(size, c);
        Tensor2::from_eigen(math::radians(angle_deg), s1, s2)
    });
    let rule = ProfileRule { normalization, total_anisotropy: rule.parse().expect("a rule") };
    TransmissionField::from_tensors(&tensors, directions(samples), rule).expect("finite tensors")
}

/// `b(x, y, t)` of every pulse as the definition has it, and the steps each one took.
pub(crate) struct AllPulses {
    grid: Grid,
    samples: usize,
    distributions: Vec<Vec<f64>>,
    steps: Vec<u64>,
}

impl AllPulses {
    pub(crate) fn solve(scheme: &Scheme, transmission: &TransmissionField, stopping: Stopping) -> Self {
        let (grid, samples) = (transmission.grid(), scheme.directions().count());
        let (mut distributions, mut steps) = (Vec::new(), Vec::new());
        for t in 0..samples {
            for cell in grid.iter() {
                if transmission.reflection(cell).is_some() {
                    // Nothing shines in a wall.
                    distributions.push(vec![0.0; grid.cells() * samples]);
                    steps.push(0);
                    continue;
                }
                let lights = [Light::pulse(cell, t)];
                let problem = Problem { scheme, transmission, lights: &lights, stopping };
                let outcome = SampleSpace.propagate(&problem).expect("a pulse");
                let mut b = outcome.distribution.samples().to_vec();
                // What the pulse itself puts there; with linear scattering, light that comes back adds to it.
                b[grid.index(cell) * samples + t] -= samples as f64;
                distributions.push(b);
                steps.push(outcome.work.steps as u64);
            }
        }
        Self { grid, samples, distributions, steps }
    }

    fn index(&self, x: usize, y: usize, t: usize) -> usize {
        t % self.samples * self.grid.cells() + self.grid.index(Cell::new(x, y))
    }

    fn half_difference(&self, a: usize, b: usize) -> f64 {
        let pairs = self.distributions[a].iter().zip(&self.distributions[b]);
        0.5 * pairs.map(|(a, b)| (a - b).abs()).sum::<f64>()
    }

    /// Eqs. 3.17 to 3.20, slice by slice.
    pub(crate) fn gradient(&self, omega_step: usize) -> Vec<f64> {
        let mut values = Vec::new();
        for t in 0..self.samples {
            for Cell { x, y } in self.grid.iter() {
                if self.grid.is_border(Cell::new(x, y)) {
                    values.push(0.0);
                    continue;
                }
                let along_x = self.half_difference(self.index(x + 1, y, t), self.index(x - 1, y, t));
                let along_y = self.half_difference(self.index(x, y + 1, t), self.index(x, y - 1, t));
                let (after, before) = (t + omega_step, t + self.samples - omega_step);
                let turned = self.half_difference(self.index(x, y, after), self.index(x, y, before));
                values.push((along_x * along_x + along_y * along_y + turned * turned).sqrt());
            }
        }
        values
    }

    /// Steps of the pulses whose distributions are compared: all but those in the corners.
    pub(crate) fn steps_of_compared(&self) -> impl Iterator<Item = u64> + '_ {
        let (w, h) = (self.grid.width(), self.grid.height());
        self.steps.iter().enumerate().filter_map(move |(i, &steps)| {
            let Cell { x, y } = self.grid.cell(i % self.grid.cells());
            let corner = (x == 0 || x + 1 == w) && (y == 0 || y + 1 == h);
            (!corner).then_some(steps)
        })
    }
}

/// Largest difference of two values relative to the second; zeros must be zeros.
pub(crate) fn largest_relative_difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let relative = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { (a - b).abs() / b.abs() };
    found.iter().zip(expected).map(relative).fold(0.0, f64::max)
}

/// The bits of all values.
pub(crate) fn bits(volume: &LtgVolume) -> Vec<u64> {
    volume.values().iter().map(|v| v.to_bits()).collect()
}

/// Runs `work` on a pool of so many threads.
pub(crate) fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool").install(work)
}
