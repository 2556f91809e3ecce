//! The shortest way through a scene and the one that light shows.

use crate::runs::Results;
use crate::settings::Settings;
use tigereye_core::{Cell, Field};
use tigereye_scenes::{Path, brightest_path, climbing_steps, shortest_path, steps_to};

/// Ways from the first light of a run to a cell.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    pub(crate) shortest: Path,
    /// `None` where brightness has a summit on the way.
    pub(crate) brightest: Option<Path>,
}

impl Ways {
    /// `None` where the run is none of a scene, or there is no way.
    pub(crate) fn of(settings: &Settings, results: &Results, run: &str, to: (usize, usize)) -> Option<Self> {
        let LitScene { open, energy, light } = LitScene::of(settings, results, run)?;
        let end = Cell::new(to.0, to.1);
        Some(Self {
            shortest: shortest_path(&open, light, end)?,
            brightest: brightest_path(&energy, &open, end, light),
        })
    }

    /// Cells of one only.
    pub(crate) fn difference(&self) -> Option<usize> {
        let without = |a: &Path, b: &Path| a.iter().filter(|cell| !b.contains(cell)).count();
        let brightest = self.brightest.as_ref()?;
        Some(without(&self.shortest, brightest) + without(brightest, &self.shortest))
    }
}

/// A scene with light in it.
struct LitScene {
    open: Field<bool>,
    energy: Field<f64>,
    light: Cell,
}

impl LitScene {
    fn of(settings: &Settings, results: &Results, run: &str) -> Option<Self> {
        let (_, found) = settings.runs.iter().find(|(name, _)| name == run)?;
        let scene = settings.medium(found.field())?.scene()?;
        let result = results.lights.get(run)?;
        Some(Self { open: scene.open(), energy: result.last.energy(), light: *result.sources.first()? })
    }
}

/// Of the cells with a way to the first light of a run, the part from which the brightest way is a shortest one.
pub(crate) fn solved_part(settings: &Settings, results: &Results, run: &str) -> Option<f64> {
    let LitScene { open, energy, light } = LitScene::of(settings, results, run)?;
    let (shortest, brightest) = (steps_to(&open, light), climbing_steps(&energy, &open, light));
    let both = shortest.iter().filter(|(cell, _)| *cell != light);
    let solved: Vec<bool> =
        both.filter_map(|(cell, steps)| Some(*brightest.at(cell) == Some((*steps)?))).collect();
    (!solved.is_empty()).then(|| solved.iter().filter(|s| **s).count() as f64 / solved.len() as f64)
}
