//! Whether the steps, slices and cells that figures and checks mention exist, asked before anything is computed.

use crate::settings::{LightSettings, RunSettings, sample_of};
use crate::spec::{Panel, ProfileSource, Quantity, SeriesSource};
use tigereye_core::{Cell, Field, Grid, Tensor2};
use tigereye_transport::StoppingRule;

/// What is known of an experiment before it runs.
pub(crate) struct Known<'a> {
    pub(crate) run: &'a dyn Fn(&str) -> Option<&'a RunSettings>,
    pub(crate) field: &'a dyn Fn(&str) -> Option<&'a Field<Tensor2>>,
}

impl Known<'_> {
    /// The first fault of a panel; names that are unknown are reported elsewhere.
    pub(crate) fn fault_of_panel(&self, panel: &Panel) -> Option<String> {
        match panel {
            Panel::Overlay { run, step, .. } | Panel::Energy { run, step, .. } => self.step(run, *step),
            Panel::Slice { run, deg, .. } => self.slice(run, deg.get()),
            Panel::Polar { curves, .. } => curves.iter().find_map(|c| self.fault_of_curve(&c.source)),
            Panel::Chart { series, .. } => series.iter().find_map(|s| self.fault_of_series(s)),
            Panel::Glyphs { .. } | Panel::Orientation { .. } | Panel::Flat { .. } => None,
        }
    }

    fn fault_of_curve(&self, source: &ProfileSource) -> Option<String> {
        match source {
            ProfileSource::Emitter { .. } => None,
            ProfileSource::ConeWeight { neighbour, .. } => {
                (*neighbour > 7).then(|| format!("neighbour {neighbour}: expected 0 to 7"))
            }
            ProfileSource::Ellipse { field, cell } => self.cell((self.field)(field)?.grid(), *cell),
            ProfileSource::Light { run, cell, step } => {
                self.step(run, *step).or_else(|| self.cell_of(run, *cell))
            }
            ProfileSource::Windowed { run, cell } => self.cell_of(run, *cell),
        }
    }

    fn fault_of_series(&self, series: &SeriesSource) -> Option<String> {
        match series {
            SeriesSource::SliceRow { run, deg, row, .. } => {
                self.slice(run, deg.get()).or_else(|| self.cell_of(run, (0, *row)))
            }
            SeriesSource::Deviation { of, .. } => self.fault_of_series(of),
            _ => None,
        }
    }

    /// The first fault of a check's quantity.
    pub(crate) fn fault_of_quantity(&self, quantity: &Quantity) -> Option<String> {
        use Quantity as Q;
        match quantity {
            Q::MajorAxisDeg { field, cell } => self.cell((self.field)(field)?.grid(), *cell),
            Q::EnergyRatio { run, cell, over } => {
                self.cell_of(run, *cell).or_else(|| self.cell_of(run, *over))
            }
            Q::BoxShare { run, columns, rows } => self.cell_of(run, (columns.1, rows.1)),
            Q::FrontRoundness { run, step } => self.step(run, Some(*step)),
            Q::GradientAt { run, cell, sample } => {
                self.cell_of(run, *cell).or_else(|| self.sample(run, *sample, || format!("sample {sample}")))
            }
            Q::RidgeColumnError { run, deg, rows, .. } => {
                self.slice(run, deg.get()).or_else(|| self.cell_of(run, (0, rows.1)))
            }
            Q::RidgeContrast { run, deg, column, rows } => {
                self.slice(run, deg.get()).or_else(|| self.cell_of(run, (*column, rows.1)))
            }
            _ => None,
        }
    }

    fn cell(&self, grid: Grid, (x, y): (usize, usize)) -> Option<String> {
        let (w, h) = (grid.width(), grid.height());
        (!grid.contains(Cell::new(x, y)))
            .then(|| format!("cell ({x}, {y}) lies outside of the {w} x {h} cells"))
    }

    fn cell_of(&self, run: &str, cell: (usize, usize)) -> Option<String> {
        let scene = match (self.run)(run)? {
            RunSettings::Light(l) => &l.scene,
            RunSettings::Gradient(g) => &g.scene,
        };
        self.cell((self.field)(&scene.field)?.grid(), cell)
    }

    fn step(&self, run: &str, step: Option<usize>) -> Option<String> {
        let RunSettings::Light(LightSettings { frames, scene, .. }) = (self.run)(run)? else { return None };
        let step = step?;
        let is_last = scene.stopping.rule == StoppingRule::Steps(step);
        let fault = || format!("step {step} of \"{run}\" is not kept: add it to the run's `frames`");
        (!is_last && frames.binary_search(&step).is_err()).then(fault)
    }

    fn slice(&self, run: &str, deg: f64) -> Option<String> {
        let RunSettings::Gradient(g) = (self.run)(run)? else { return None };
        match sample_of(deg, g.scene.directions) {
            Ok(sample) => self.sample(run, sample, || format!("the slice at {deg} degrees")),
            Err(problem) => Some(problem),
        }
    }

    fn sample(&self, run: &str, sample: usize, what: impl Fn() -> String) -> Option<String> {
        let RunSettings::Gradient(g) = (self.run)(run)? else { return None };
        let missing = match &g.slices {
            Some(slices) => !slices.contains(&sample),
            None => sample >= g.scene.directions.count(),
        };
        missing.then(|| format!("{} is not among the slices of \"{run}\"", what()))
    }
}
