//! The shortest path through a scene and the one that light shows.

use crate::runs::light::Outcome;
use crate::unavailable::{OrUndefined, Unavailable};
use tigereye_core::{Cell, Field};
use tigereye_scenes::{Path, brightest_path, climbing_steps, shortest_path, steps_to};

/// Paths from the first light of a run to a cell.
#[derive(Clone, Debug)]
pub(crate) struct Paths {
    pub(crate) shortest: Path,
    /// `None` where brightness has a summit before the light.
    pub(crate) brightest: Option<Path>,
}

/// What the brightest path lacks.
pub(crate) const SUMMIT: &str = "there is no brightest path: a summit lies before the light";

impl Paths {
    pub(crate) fn of(light: &Outcome, to: Cell) -> Result<Self, Unavailable> {
        let LitScene { open, energy, source } = LitScene::of(light)?;
        let shortest = shortest_path(open, source, to).or_undefined("there is no path from the light")?;
        Ok(Self { shortest, brightest: brightest_path(&energy, open, to, source) })
    }

    pub(crate) fn brightest(&self) -> Result<&Path, Unavailable> {
        self.brightest.as_ref().or_undefined(SUMMIT)
    }

    /// Cells on exactly one of the two paths.
    pub(crate) fn difference(&self) -> Result<usize, Unavailable> {
        let without = |a: &Path, b: &Path| a.iter().filter(|cell| !b.contains(cell)).count();
        let brightest = self.brightest()?;
        Ok(without(&self.shortest, brightest) + without(brightest, &self.shortest))
    }
}

/// A scene with light in it.
struct LitScene<'a> {
    open: &'a Field<bool>,
    energy: Field<f64>,
    source: Cell,
}

impl<'a> LitScene<'a> {
    fn of(light: &'a Outcome) -> Result<Self, Unavailable> {
        let open = light.open.as_ref().or_undefined("the run goes through a field, not a scene")?;
        let source = *light.sources.first().or_undefined("the run has no light")?;
        Ok(Self { open, energy: light.last.energy(), source })
    }
}

/// The fraction of the cells with a path to the first light of a run whose brightest path is also a shortest one.
pub(crate) fn solved_part(light: &Outcome) -> Result<f64, Unavailable> {
    let LitScene { open, energy, source } = LitScene::of(light)?;
    let (shortest, brightest) = (steps_to(open, source), climbing_steps(&energy, open, source));
    let both = shortest.iter().filter(|(cell, _)| *cell != source);
    let solved: Vec<bool> =
        both.filter_map(|(cell, steps)| Some(*brightest.at(cell) == Some((*steps)?))).collect();
    let part = solved.iter().filter(|s| **s).count() as f64 / solved.len() as f64;
    (!solved.is_empty()).then_some(part).or_undefined("no cell has a path to the light")
}
