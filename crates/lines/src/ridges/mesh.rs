//! Crests at the nodes of a refined mesh, and where its edges cross ridges.

use super::RidgeBounds;
use super::crest::Crest;
use crate::ExtractionError;
use crate::RidgeOptions;
use crate::Volume;
use crate::shapes::dot;
use crate::spline::{Axis, Known, Taps};
use crate::tetrahedra::{Crossing, Edges};
use rayon::prelude::*;
use tigereye_core::math;

/// The mesh of a volume.
pub(crate) struct RidgeMesh {
    known: Known,
    /// Nodes along each axis.
    nodes: [usize; 3],
    /// Steps per sample.
    steps: f64,
    /// Length of a sample along each axis.
    unit: [f64; 3],
    bounds: RidgeBounds,
    /// Weaker crests are rejected: the larger of the bound and the rounding error.
    weakest: f64,
    least_sharpness: f64,
    /// First and last position, in samples, at which ridges are accepted.
    inner: [[f64; 2]; 3],
    taps: [Vec<Taps>; 2],
}

/// The crest at a node; its strength is NaN if values around it are missing.
pub(crate) type Node = Crest;

/// Largest number of evaluations along an edge. Regula falsi converges nearly as fast as the secant method: six reach
/// rounding if the slope is smooth.
const EVALUATIONS: usize = 12;
/// Largest slope accepted at a crossing, relative to the slope at the ends; more remains if the eigenvector jumps.
const LEFT: f64 = 1e-3;
/// Slopes that would vanish within this distance (in samples) count as zero.
const FLAT: f64 = 1e-6;
/// Accuracy of crossings, in samples.
const ENOUGH: f64 = 1e-9;
/// Axes with fewer samples have no margin.
const SHORT: usize = 6;
/// Distance on either side, in samples, at which values are compared with that on a crest.
const ASIDE: f64 = 0.75;

impl RidgeMesh {
    /// `None` if no value is finite.
    pub(crate) fn new(volume: &Volume<'_>, options: &RidgeOptions) -> Result<Option<Self>, ExtractionError> {
        options.check()?;
        let Some(known) = Known::new(volume) else { return Ok(None) };
        let axes = *known.spline.axes();
        let nodes = options.nodes(&axes)?;
        let steps = options.samples_per_cell as f64;
        let unit = [0, 1, 2].map(|d| options.cell[d] * volume.steps()[d]);
        let shortest = unit.iter().copied().fold(f64::INFINITY, f64::min);
        // Values are scaled to a largest magnitude between a half and 1.
        let rounding = options.rounding / (shortest * shortest);
        let taps = [0, 1].map(|d| (0..nodes[d]).map(|i| axes[d].taps(i as f64 / steps)).collect());
        let mut mesh = Self {
            known,
            nodes,
            steps,
            unit,
            bounds: RidgeBounds::default(),
            weakest: rounding,
            least_sharpness: options.least_sharpness,
            inner: axes.map(|a| inner(a, options.margin)),
            taps,
        };
        let range = mesh.known.range.map(|v| mesh.unscaled(v));
        mesh.bounds = RidgeBounds::new(options, range, mesh.unscaled(mesh.strongest()));
        mesh.weakest = rounding.max(mesh.scaled(mesh.bounds.strength));
        Ok(Some(mesh))
    }

    const fn planar(&self) -> bool {
        self.nodes[2] == 1
    }

    /// The shortest length of a sample.
    fn shortest(&self) -> f64 {
        self.unit.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn crest(&self, sample: [f64; 3]) -> Crest {
        Crest::of(&self.known.spline.jet(sample), self.unit, self.planar())
    }

    /// From nodes to samples of the spline.
    fn sample(&self, nodes: [f64; 3]) -> [f64; 3] {
        nodes.map(|v| v / self.steps)
    }

    /// From nodes to samples of the volume.
    pub(crate) fn in_volume(&self, nodes: [f64; 3]) -> [f64; 3] {
        let sample = self.sample(nodes);
        [0, 1, 2].map(|d| sample[d] + self.known.first[d] as f64)
    }

    /// A value or strength in the volume's unit.
    pub(crate) fn unscaled(&self, v: f64) -> f64 {
        math::scale_by_power_of_two(v, self.known.exponent)
    }

    fn scaled(&self, v: f64) -> f64 {
        math::scale_by_power_of_two(v, -self.known.exponent)
    }

    pub(crate) const fn bounds(&self) -> RidgeBounds {
        self.bounds
    }

    /// Whether a point in samples is far enough from missing samples and open borders.
    fn counts(&self, sample: [f64; 3]) -> bool {
        (0..3).all(|d| self.inner[d][0] <= sample[d] && sample[d] <= self.inner[d][1])
            && self.known.is_known(sample)
    }

    /// The largest strength of a sample with complete surroundings, 0 if no sample has them.
    fn strongest(&self) -> f64 {
        let axes = self.known.spline.axes();
        let [x, y] = [0, 1].map(|d| (0..axes[d].samples).map(|i| axes[d].taps(i as f64)).collect::<Vec<_>>());
        let in_plane = |k: usize| {
            let z = k as f64;
            let strengths = self.known.spline.plane(&x, &y, z, |i, j, jet| {
                let crest = Crest::of(&jet, self.unit, self.planar());
                if self.counts([i as f64, j as f64, z]) { crest.strength } else { 0.0 }
            });
            strengths.into_iter().fold(0.0, f64::max)
        };
        // A maximum does not depend on the order.
        (0..axes[2].samples).into_par_iter().map(in_plane).reduce(|| 0.0, f64::max)
    }

    /// The crossing of an edge whose ends have slopes of different sign, `b` aligned with `a`: its fraction of the
    /// edge, its position in samples, and the crest there.
    fn refined(&self, a: (&Crest, [f64; 3]), b: (&Crest, [f64; 3])) -> (f64, [f64; 3], Crest) {
        let on = |t: f64| self.sample([0, 1, 2].map(|d| a.1[d] + t * (b.1[d] - a.1[d])));
        let side = |t: f64| [0, 1, 2].map(|d| (1.0 - t) * a.0.across[d] + t * b.0.across[d]);
        // Regula falsi: the bracket always holds a change of sign, whatever the eigenvectors do between its ends.
        let (mut low, mut high) = ((0.0, a.0.slope), (1.0, b.0.slope));
        let mut best = if low.1.abs() <= high.1.abs() { (0.0, *a.0) } else { (1.0, *b.0) };
        let shortest = self.shortest();
        let mut moved = None;
        for _ in 0..EVALUATIONS {
            if best.1.slope.abs() <= ENOUGH * best.1.strength.abs() * shortest || high.0 - low.0 < 1e-12 {
                break;
            }
            let t = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let crest = self.crest(on(t)).towards(side(t));
            if crest.slope.abs() <= best.1.slope.abs() {
                best = (t, crest);
            }
            // The slope of an end kept twice in a row is halved (the Illinois rule).
            let lower = (crest.slope >= 0.0) == (a.0.slope >= 0.0);
            let share = if moved == Some(lower) { 0.5 } else { 1.0 };
            if lower {
                (low, high.1) = ((t, crest.slope), share * high.1);
            } else {
                (high, low.1) = ((t, crest.slope), share * low.1);
            }
            moved = Some(lower);
        }
        (best.0, on(best.0), best.1)
    }

    /// The fall of the value to both sides along the eigenvectors, relative to the fall that the strength alone
    /// predicts. Values are accurate to a higher order than slopes and curvatures, so this separates crests from
    /// artefacts of the interpolation.
    fn sharpness(&self, sample: [f64; 3], crest: &Crest) -> f64 {
        let step = [0, 1, 2].map(|d| crest.across[d] / self.unit[d]);
        let reach = ASIDE / dot(step, step).sqrt();
        let beyond = |across: [f64; 3], s: f64| [0, 1, 2].map(|d| sample[d] + s * across[d] / self.unit[d]);
        // The midpoint rule follows the eigenvectors where they turn.
        let beside = |s: f64| {
            let halfway = self.crest(beyond(crest.across, 0.5 * s)).towards(crest.across);
            self.known.spline.value(beyond(halfway.across, s))
        };
        (2.0 * crest.value - beside(reach) - beside(-reach)) / (reach * reach * crest.strength)
    }
}

/// The range of an axis without the margin at its open ends.
fn inner(axis: Axis, margin: usize) -> [f64; 2] {
    if axis.periodic || axis.samples < SHORT {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let margin = margin.min(axis.samples);
    [margin as f64, axis.samples as f64 - 1.0 - margin as f64]
}

impl Edges for RidgeMesh {
    type Node = Node;

    fn nodes(&self) -> [usize; 3] {
        self.nodes
    }

    fn layer(&self, k: usize) -> Vec<Node> {
        let z = k as f64 / self.steps;
        self.known.spline.plane(&self.taps[0], &self.taps[1], z, |i, j, jet| {
            let crest = Crest::of(&jet, self.unit, self.planar());
            let here = self.counts([i as f64 / self.steps, j as f64 / self.steps, z]);
            if here { crest } else { Crest { strength: f64::NAN, ..crest } }
        })
    }

    /// An edge is crossed if the slopes of its ends differ in sign once their eigenvectors are aligned. A slope of zero
    /// counts as positive along its node's own vector, so that the three edges of a triangle are consistent.
    fn crossing(&self, a: (&Node, [f64; 3]), b: (&Node, [f64; 3])) -> Crossing {
        if a.0.strength.is_nan() || b.0.strength.is_nan() {
            return Crossing::None;
        }
        let aligned = dot(a.0.across, b.0.across) >= 0.0;
        if (a.0.slope >= 0.0) == ((b.0.slope >= 0.0) == aligned) {
            return Crossing::None;
        }
        // Refining is costly: give up early if both ends are far too weak.
        if a.0.strength.max(b.0.strength) <= 0.5 * self.weakest {
            return Crossing::Rejected;
        }
        let other = b.0.towards(a.0.across);
        let (at, sample, crest) = self.refined(a, (&other, b.1));
        // A jump of the eigenvector also changes the sign of the slope; there the refined slope does not vanish.
        let steepest = a.0.slope.abs().max(b.0.slope.abs());
        let left = LEFT * steepest + FLAT * crest.strength * self.shortest();
        if !(crest.strength >= self.weakest
            && crest.value >= self.scaled(self.bounds.value)
            && crest.slope.abs() <= left)
            || crest.gap < self.least_sharpness * crest.strength
            || self.sharpness(sample, &crest) < self.least_sharpness
        {
            return Crossing::Rejected;
        }
        Crossing::At { at, known: [crest.value, crest.strength] }
    }

    fn side(&self, _: &Node) -> Option<bool> {
        None
    }
}
