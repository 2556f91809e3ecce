//! The light of every step, for an animation.

use tigereye_core::{Cell, Field};
use tigereye_render::{
    HeatOptions, HeatScale, MAX_ANIMATED_PIXELS, Pace, RenderError, Scene, animation, heat_map,
};

/// Largest number of frames.
const MAX_FRAMES: usize = 600;
/// Largest size of the frames kept, bytes.
const MAX_BYTES: usize = 512 << 20;

/// Energies of the cells after a selection of the steps.
///
/// If there are too many frames, every second one is dropped, repeatedly, so that the rest remain equally spaced.
#[derive(Clone, Debug)]
pub struct Reel {
    /// Steps from one frame to the next.
    every: usize,
    /// Steps added so far.
    seen: usize,
    most: usize,
    frames: Vec<(usize, Field<f64>)>,
}

impl Reel {
    /// An empty reel for fields of `cells` cells, which keeps every `every`-th step.
    #[must_use]
    pub fn new(cells: usize, every: usize) -> Self {
        let most = (MAX_BYTES / (8 * cells.max(1))).clamp(2, MAX_FRAMES);
        Self { every: every.max(1), seen: 0, most, frames: Vec::new() }
    }

    /// Number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len()
    }
    /// Whether there are no frames.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Adds the next step, beginning with the state before the first; `energies` of its cells (W) are only computed if
    /// it becomes a frame.
    pub fn add(&mut self, energies: impl FnOnce() -> Field<f64>) {
        if self.seen.is_multiple_of(self.every) {
            self.frames.push((self.seen, energies()));
        }
        if self.frames.len() > self.most {
            self.every *= 2;
            let every = self.every;
            self.frames.retain(|(step, _)| step.is_multiple_of(every));
        }
        self.seen += 1;
    }

    /// The frames whose step is a multiple of `every`, without those kept for another animation of the same steps; all
    /// of them if only one would remain.
    fn chosen(&self, every: usize) -> Vec<&(usize, Field<f64>)> {
        let some: Vec<_> = self.frames.iter().filter(|(step, _)| step.is_multiple_of(every.max(1))).collect();
        if some.len() > 1 { some } else { self.frames.iter().collect() }
    }

    /// The frames of every `every`-th step as an animated PNG, and their number: pictures with a common scale,
    /// `options` with a range of `decades` below the brightest cell that is not a source. If they have too many pixels
    /// in all, every second frame is dropped, repeatedly.
    ///
    /// # Errors
    /// As [`animation`].
    pub fn encoded(
        &self,
        options: &HeatOptions,
        decades: f64,
        every: usize,
    ) -> Result<(Vec<u8>, usize), RenderError> {
        let mut frames = self.chosen(every);
        let range = range_of(&frames, &options.sources, decades);
        if let Some(last) = frames.last() {
            let one = picture(last, options, decades, range);
            frames = fitting(frames, one.width_px * one.height_px);
        }
        let drawn = |i: usize| picture(frames[i], options, decades, range);
        Ok((animation(frames.len(), drawn, Pace::default())?, frames.len()))
    }
}

/// Every frame, or every second, fourth, ... of them, so that they have no more pixels than an animation may.
fn fitting<T>(mut frames: Vec<T>, pixels: f64) -> Vec<T> {
    while frames.len() > 2 && pixels * frames.len() as f64 > MAX_ANIMATED_PIXELS as f64 {
        frames = frames.into_iter().step_by(2).collect();
    }
    frames
}

/// The range from `decades` below the brightest cell of all frames, sources excluded, up to it.
fn range_of(frames: &[&(usize, Field<f64>)], sources: &[Cell], decades: f64) -> Option<(f64, f64)> {
    let brightest = |field: &Field<f64>| {
        let cells = field.iter().filter(|(cell, _)| !sources.contains(cell));
        cells.map(|(_, e)| *e).fold(0.0, f64::max)
    };
    let top = frames.iter().map(|(_, f)| brightest(f)).fold(0.0, f64::max);
    (top > 0.0).then(|| (top * tigereye_core::math::pow(10.0, -decades), top))
}

fn picture(
    (step, energy): &(usize, Field<f64>),
    options: &HeatOptions,
    decades: f64,
    range: Option<(f64, f64)>,
) -> Scene {
    let title = match options.title.as_str() {
        "" => format!("step {step}"),
        title => format!("{title}, step {step}"),
    };
    let scale = HeatScale::Logarithmic { decades };
    heat_map(energy, &HeatOptions { title, scale, range, ..options.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn light(energy: f64) -> Field<f64> {
        Field::from_fn(Grid::new(3, 2).expect("a grid"), |_| energy)
    }

    #[test]
    fn long_propagations_keep_frames_at_equal_distances() {
        let mut reel = Reel::new(6, 3);
        for step in 0..10_000 {
            reel.add(|| light(f64::from(step)));
        }
        let steps: Vec<usize> = reel.frames.iter().map(|(step, _)| *step).collect();
        assert!(reel.len() <= MAX_FRAMES && reel.len() > MAX_FRAMES / 2);
        assert!(steps.windows(2).all(|w| w[1] - w[0] == reel.every), "{:?}", &steps[..4]);
        assert_eq!((steps[0], reel.every % 3), (0, 0));
    }

    #[test]
    fn animations_of_the_same_steps_take_their_own_frames() {
        let mut reel = Reel::new(6, 2);
        (0..25).for_each(|step| reel.add(|| light(f64::from(step))));
        let steps = |every| reel.chosen(every).iter().map(|f| f.0).collect::<Vec<_>>();
        assert_eq!((reel.len(), steps(6)), (13, vec![0, 6, 12, 18, 24]));
        assert_eq!(steps(1000).len(), 13, "one frame alone is no animation");
    }

    #[test]
    fn frames_share_their_colours() {
        let mut reel = Reel::new(6, 1);
        reel.add(|| light(1.0));
        reel.add(|| light(1e-3));
        let frames = reel.chosen(1);
        let range = range_of(&frames, &[], 4.0);
        let [a, b] = [0, 1].map(|i| picture(frames[i], &HeatOptions::default(), 4.0, range));
        assert_eq!(a.title, "step 0");
        assert_ne!(a.items, b.items);
        let (bytes, count) = reel.encoded(&HeatOptions::default(), 4.0, 1).expect("an animation");
        assert!(count == 2 && !reel.is_empty() && bytes.starts_with(b"\x89PNG"));
    }

    #[test]
    fn animations_of_too_many_pixels_lose_frames() {
        let megapixels = |n: f64| n * f64::from(1 << 20);
        assert_eq!(fitting((0..40).collect(), megapixels(20.0)).len(), 40);
        assert_eq!(fitting((0..41).collect(), megapixels(40.0)), (0..41).step_by(2).collect::<Vec<_>>());
        assert_eq!(fitting((0..41).collect(), megapixels(1000.0)), [0, 32]);
    }
}
