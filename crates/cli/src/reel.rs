//! The light of every step, for an animation.

use crate::error::CliError;
use tigereye_core::{Cell, Field, LightDistribution, Surface};
use tigereye_render::{HeatOptions, HeatScale, Pace, Scene, animation, heat_map};

/// Most frames.
const MAX_FRAMES: usize = 600;
/// Most bytes of what is kept for them.
const MAX_BYTES: usize = 512 << 20;
/// Decades below the brightest cell that is no light.
const DECADES: f64 = 4.0;

/// Energies of cells after some of the steps.
///
/// Where there are more steps than frames, every second frame goes, as often as it takes, so that the rest follow each other
/// at equal distances.
#[derive(Debug)]
pub(crate) struct Reel {
    /// Steps from one frame to the next.
    every: usize,
    /// Steps that were shown.
    seen: usize,
    most: usize,
    frames: Vec<(usize, Field<f64>)>,
}

impl Reel {
    /// An empty one for fields of so many cells.
    pub(crate) fn new(cells: usize) -> Self {
        let most = (MAX_BYTES / (8 * cells)).clamp(2, MAX_FRAMES);
        Self { every: 1, seen: 0, most, frames: Vec::new() }
    }

    /// The next step, or what is there before the first.
    pub(crate) fn add(&mut self, light: &LightDistribution) {
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

    /// The animation: one scale for all frames.
    pub(crate) fn encoded(
        &self,
        name: &str,
        title: &str,
        sources: &[Cell],
        walls: Option<&Field<Option<Surface>>>,
    ) -> Result<Vec<u8>, CliError> {
        let brightest = |field: &Field<f64>| {
            let cells = field.iter().filter(|(cell, _)| !sources.contains(cell));
            cells.map(|(_, e)| *e).fold(0.0, f64::max)
        };
        let top = self.frames.iter().map(|(_, f)| brightest(f)).fold(0.0, f64::max);
        let range = (top > 0.0).then(|| (top * tigereye_core::math::pow(10.0, -DECADES), top));
        let frames: Vec<Scene> = self
            .frames
            .iter()
            .map(|(step, energy)| {
                let options = HeatOptions {
                    title: format!("{title}, step {step}"),
                    quantity: "energy of a cell / W".to_owned(),
                    scale: HeatScale::Logarithmic { decades: DECADES },
                    range,
                    sources: sources.to_vec(),
                    walls: walls.cloned(),
                    ..HeatOptions::default()
                };
                heat_map(energy, &options)
            })
            .collect();
        animation(&frames, Pace::default()).map_err(|e| CliError::input(name, e))
    }
}
