//! The light of every step, for an animation.

use tigereye_core::{Field, LightDistribution};
use tigereye_render::{HeatOptions, HeatScale, Pace, RenderError, Scene, animation, heat_map};

/// Most frames.
const MAX_FRAMES: usize = 600;
/// Most bytes of what is kept for them.
const MAX_BYTES: usize = 512 << 20;
/// Energies of cells after some of the steps.
///
/// Where there are more steps than frames, every second frame goes, as often as it takes, so that the rest follow each other
/// at equal distances.
#[derive(Clone, Debug)]
pub struct Reel {
    /// Steps from one frame to the next.
    every: usize,
    /// Steps that were shown.
    seen: usize,
    most: usize,
    frames: Vec<(usize, Field<f64>)>,
}

impl Reel {
    /// An empty one for fields of so many cells, of every `every`-th step.
    #[must_use]
    pub fn new(cells: usize, every: usize) -> Self {
        let most = (MAX_BYTES / (8 * cells.max(1))).clamp(2, MAX_FRAMES);
        Self { every: every.max(1), seen: 0, most, frames: Vec::new() }
    }

    /// Frames it has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len()
    }
    /// Whether it has none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// The next step, or what is there before the first.
    pub fn add(&mut self, light: &LightDistribution) {
        if self.seen.is_multiple_of(self.every) {
            self.frames.push((self.seen, light.energy()));
        }
        if self.frames.len() > self.most {
            self.every *= 2;
            let every = self.every;
            self.frames.retain(|(step, _)| step.is_multiple_of(every));
        }
        self.seen += 1;
    }

    /// Leaves out frames whose step is no multiple of `every`, and so those that another animation of the same steps wants.
    #[must_use]
    pub fn thinned(mut self, every: usize) -> Self {
        let every = every.max(1);
        if self.frames.iter().filter(|(step, _)| step.is_multiple_of(every)).count() > 1 {
            self.frames.retain(|(step, _)| step.is_multiple_of(every));
        }
        self
    }

    /// The frames as pictures of one scale: `options` with a range of `decades` below the brightest cell that is no light.
    #[must_use]
    pub fn pictures(&self, options: &HeatOptions, decades: f64) -> Vec<Scene> {
        let brightest = |field: &Field<f64>| {
            let cells = field.iter().filter(|(cell, _)| !options.sources.contains(cell));
            cells.map(|(_, e)| *e).fold(0.0, f64::max)
        };
        let top = self.frames.iter().map(|(_, f)| brightest(f)).fold(0.0, f64::max);
        let range = (top > 0.0).then(|| (top * tigereye_core::math::pow(10.0, -decades), top));
        let picture = |(step, energy): &(usize, Field<f64>)| {
            let title = match options.title.as_str() {
                "" => format!("step {step}"),
                title => format!("{title}, step {step}"),
            };
            let scale = HeatScale::Logarithmic { decades };
            heat_map(energy, &HeatOptions { title, scale, range, ..options.clone() })
        };
        self.frames.iter().map(picture).collect()
    }

    /// The same as an animated PNG.
    ///
    /// # Errors
    /// As [`animation`].
    pub fn encoded(&self, options: &HeatOptions, decades: f64) -> Result<Vec<u8>, RenderError> {
        animation(&self.pictures(options, decades), Pace::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::{Directions, Grid};

    fn light(energy: f64) -> LightDistribution {
        let grid = Grid::new(3, 2).expect("a grid");
        let d = Directions::new(8).expect("directions");
        LightDistribution::new(d, vec![energy; 8 * 6], Field::from_fn(grid, |_| [0.0; 8]))
    }

    #[test]
    fn long_propagations_keep_frames_at_equal_distances() {
        let mut reel = Reel::new(6, 3);
        for step in 0..10_000 {
            reel.add(&light(f64::from(step)));
        }
        let steps: Vec<usize> = reel.frames.iter().map(|(step, _)| *step).collect();
        assert!(reel.len() <= MAX_FRAMES && reel.len() > MAX_FRAMES / 2);
        assert!(steps.windows(2).all(|w| w[1] - w[0] == reel.every), "{:?}", &steps[..4]);
        assert_eq!((steps[0], reel.every % 3), (0, 0));
    }

    #[test]
    fn animations_of_the_same_steps_take_their_own_frames() {
        let mut reel = Reel::new(6, 2);
        (0..25).for_each(|step| reel.add(&light(f64::from(step))));
        let steps = |every| reel.clone().thinned(every).frames.iter().map(|f| f.0).collect::<Vec<_>>();
        assert_eq!((reel.len(), steps(6)), (13, vec![0, 6, 12, 18, 24]));
        assert_eq!(steps(1000).len(), 13, "one frame alone is no animation");
    }

    #[test]
    fn frames_share_their_colours() {
        let mut reel = Reel::new(6, 1);
        reel.add(&light(1.0));
        reel.add(&light(1e-3));
        let pictures = reel.pictures(&HeatOptions::default(), 4.0);
        assert_eq!(pictures[0].title, "step 0");
        assert_ne!(pictures[0].items, pictures[1].items);
        assert!(!reel.is_empty());
    }
}
