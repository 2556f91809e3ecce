//! The shortest way through a scene and the one that light shows.

use crate::runs::Results;
use crate::settings::Settings;
use tigereye_core::Cell;
use tigereye_scenes::{Path, brightest_path, shortest_path};

/// Ways from the first light of a run to a cell.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    pub(crate) shortest: Path,
    pub(crate) brightest: Path,
}

impl Ways {
    /// `None` where the run is none of a scene, or one of the ways does not exist.
    pub(crate) fn of(settings: &Settings, results: &Results, run: &str, to: (usize, usize)) -> Option<Self> {
        let (_, found) = settings.runs.iter().find(|(name, _)| name == run)?;
        let scene = settings.medium(found.field())?.scene()?;
        let light = results.lights.get(run)?;
        let (start, end) = (*light.sources.first()?, Cell::new(to.0, to.1));
        let open = scene.open();
        Some(Self {
            shortest: shortest_path(&open, start, end)?,
            brightest: brightest_path(&light.last.energy(), &open, end, start)?,
        })
    }

    /// Cells of one only.
    pub(crate) fn difference(&self) -> usize {
        let without = |a: &Path, b: &Path| a.iter().filter(|cell| !b.contains(cell)).count();
        without(&self.shortest, &self.brightest) + without(&self.brightest, &self.shortest)
    }
}
