//! Whether the steps, slices and cells that figures and checks mention exist, asked before anything is computed.

use crate::Medium;
use crate::settings::{GradientSettings, LightSettings, RunSettings, sample_of};
use crate::spec::{MapSource, Panel, ProfileSource, Quantity, RidgeSource, SeriesSource};
use tigereye_core::{Cell, Field, Grid, Tensor2};
use tigereye_fields::{Expression, ExpressionField};
use tigereye_scenes::shortest_path;
use tigereye_transport::StoppingRule;

/// What is known of an experiment before it runs.
pub(crate) struct Known<'a> {
    pub(crate) run: &'a dyn Fn(&str) -> Option<&'a RunSettings>,
    pub(crate) field: &'a dyn Fn(&str) -> Option<&'a Field<Tensor2>>,
    pub(crate) medium: &'a dyn Fn(&str) -> Option<Medium<'a>>,
}

/// Something that figures or checks mention and that does not exist.
pub(crate) struct Misplaced {
    /// How it is written in the file, to find its place.
    pub(crate) word: String,
    /// What is wrong with it.
    pub(crate) problem: String,
}

fn sorted(mut slices: Vec<usize>) -> Vec<usize> {
    slices.sort_unstable();
    slices.dedup();
    slices
}

fn reversed((from, to): (usize, usize)) -> Option<Misplaced> {
    let problem = || format!("the range from {from} to {to} is empty");
    (from > to).then(|| Misplaced { word: format!("({from}, {to})"), problem: problem() })
}

fn fault_of_expression(text: &str, variables: &[&str]) -> Option<Misplaced> {
    let fault = Expression::parse(text, variables).err()?;
    Some(Misplaced { word: format!("\"{text}\""), problem: format!("`{text}`: {fault}") })
}

impl Known<'_> {
    /// The first fault of a panel; names that are unknown are reported elsewhere.
    pub(crate) fn fault_of_panel(&self, panel: &Panel) -> Option<Misplaced> {
        match panel {
            Panel::Overlay { run, step, .. } => self.step(run, *step),
            Panel::Energy { run, step, way_to, .. } => {
                self.step(run, *step).or_else(|| self.way(run, (*way_to)?))
            }
            Panel::Slice { run, deg, .. } => self.slice(run, deg.get()),
            Panel::Polar { curves, .. } => curves.iter().find_map(|c| self.fault_of_curve(&c.source)),
            Panel::Chart { series, .. } => series.iter().find_map(|s| self.fault_of_series(s)),
            Panel::Map { map, .. } => self.fault_of_map(map),
            Panel::Ridges { sources, .. } => sources.iter().find_map(|(_, s)| self.fault_of_ridges(s)),
            Panel::Glyphs { .. }
            | Panel::Orientation { .. }
            | Panel::Lines { .. }
            | Panel::Texture { .. }
            | Panel::Flat { .. } => None,
        }
    }

    fn fault_of_map(&self, map: &MapSource) -> Option<Misplaced> {
        match map {
            MapSource::Slice { run, deg } => self.slice(run, deg.get()),
            MapSource::Ftle { .. } | MapSource::Mean { .. } | MapSource::Maximum { .. } => None,
        }
    }

    fn fault_of_ridges(&self, source: &RidgeSource) -> Option<Misplaced> {
        match source {
            RidgeSource::Of(map) => self.fault_of_map(map),
            RidgeSource::EverySlice { .. } => None,
        }
    }

    fn fault_of_curve(&self, source: &ProfileSource) -> Option<Misplaced> {
        match source {
            ProfileSource::Emitter { .. } => None,
            ProfileSource::ConeWeight { neighbour, .. } => {
                let word = || format!("neighbour: {neighbour}");
                let problem = || format!("neighbour {neighbour}: expected 0 to 7");
                (*neighbour > 7).then(|| Misplaced { word: word(), problem: problem() })
            }
            ProfileSource::Ellipse { field, cell } => self.cell((self.field)(field)?.grid(), *cell),
            ProfileSource::Light { run, cell, step } => {
                self.step(run, *step).or_else(|| self.cell_of(run, *cell))
            }
            ProfileSource::Windowed { run, cell } => self.cell_of(run, *cell),
        }
    }

    fn fault_of_series(&self, series: &SeriesSource) -> Option<Misplaced> {
        match series {
            SeriesSource::SliceRow { run, deg, row, .. } => {
                self.slice(run, deg.get()).or_else(|| self.cell_of(run, (0, *row)))
            }
            SeriesSource::PulsesOverColumn { run, deg, .. } => self.pulse(run, deg.get()),
            SeriesSource::Deviation { of, from, .. } => {
                fault_of_expression(from, &["x"]).or_else(|| self.fault_of_series(of))
            }
            SeriesSource::Seconds { runs, .. } => runs.iter().find(|r| (self.run)(r).is_none()).map(|run| {
                Misplaced { word: format!("\"{run}\""), problem: format!("there is no run \"{run}\"") }
            }),
            SeriesSource::Formula { expression, .. } => fault_of_expression(expression, &["x"]),
            _ => None,
        }
    }

    /// The first fault of a check's quantity.
    pub(crate) fn fault_of_quantity(&self, quantity: &Quantity) -> Option<Misplaced> {
        use Quantity as Q;
        match quantity {
            Q::MajorAxisError { phi_deg, .. } => fault_of_expression(phi_deg, &ExpressionField::VARIABLES),
            Q::MajorAxisDeg { field, cell } => self.cell((self.field)(field)?.grid(), *cell),
            Q::EnergyOver { run, over, cell } => {
                self.cell_of(run, *cell).or_else(|| self.cell_of(over, *cell))
            }
            Q::WayLength { run, to } | Q::WayExcess { run, to } | Q::WayDifference { run, to } => {
                self.way(run, *to)
            }
            Q::ShortestWays { run } => self.scene_of(run),
            Q::EnergyRatio { run, cell, over } => {
                self.cell_of(run, *cell).or_else(|| self.cell_of(run, *over))
            }
            Q::BoxShare { run, columns, rows } => reversed(*columns)
                .or_else(|| reversed(*rows))
                .or_else(|| self.cell_of(run, (columns.1, rows.1))),
            Q::RingShare { range, .. } => (range.0 > range.1).then(|| Misplaced {
                word: "range:".to_owned(),
                problem: format!("the range from {} to {} is empty", range.0.get(), range.1.get()),
            }),
            Q::FrontRoundness { run, step } => self.step(run, Some(*step)),
            Q::GradientRatio { run, deg, cell, over } => self
                .slice(run, deg.get())
                .or_else(|| self.cell_of(run, *cell))
                .or_else(|| self.cell_of(run, *over)),
            Q::GradientAt { run, cell, sample } => {
                self.cell_of(run, *cell).or_else(|| self.sample(run, *sample, || format!("sample {sample}")))
            }
            Q::MapCorrelation { map, with } => self
                .fault_of_map(map)
                .or_else(|| self.fault_of_map(with))
                .or_else(|| self.same_size(map, with)),
            Q::RidgeDistance { of, from, .. } => {
                self.fault_of_ridges(of).or_else(|| self.fault_of_ridges(from))
            }
            Q::GradientDifference { run, from } => self.comparable(run, from),
            Q::RidgeColumnError { run, deg, rows, .. } => {
                let place = || self.slice(run, deg.get()).or_else(|| self.cell_of(run, (0, rows.1)));
                reversed(*rows).or_else(place)
            }
            Q::RidgeContrast { run, deg, column, rows } => {
                let place = || self.slice(run, deg.get()).or_else(|| self.cell_of(run, (*column, rows.1)));
                reversed(*rows).or_else(place)
            }
            _ => None,
        }
    }

    fn cell(&self, grid: Grid, (x, y): (usize, usize)) -> Option<Misplaced> {
        let (w, h) = (grid.width(), grid.height());
        let problem = || format!("cell ({x}, {y}) lies outside of the {w} x {h} cells");
        let outside = !grid.contains(Cell::new(x, y));
        outside.then(|| Misplaced { word: format!("({x}, {y})"), problem: problem() })
    }

    /// A run whose light has ways to be found.
    fn scene_of(&self, run: &str) -> Option<Misplaced> {
        let medium = (self.medium)((self.run)(run)?.field())?;
        let problem = || format!("\"{run}\" runs through a field: ways are found through scenes");
        let is_field = medium.scene().is_none();
        is_field.then(|| Misplaced { word: format!("\"{run}\""), problem: problem() })
    }

    /// The end of a way through a scene.
    fn way(&self, run: &str, to: (usize, usize)) -> Option<Misplaced> {
        let medium = (self.medium)((self.run)(run)?.field())?;
        let shut = || {
            let RunSettings::Light(LightSettings { lights, .. }) = (self.run)(run)? else { return None };
            let (x, y) = to;
            let way = shortest_path(&medium.scene()?.open(), lights.first()?.cell, Cell::new(x, y));
            let problem = || format!("there is no way from the light of \"{run}\" to cell ({x}, {y})");
            way.is_none().then(|| Misplaced { word: format!("({x}, {y})"), problem: problem() })
        };
        self.scene_of(run).or_else(|| self.cell(medium.grid(), to)).or_else(shut)
    }

    fn cell_of(&self, run: &str, cell: (usize, usize)) -> Option<Misplaced> {
        self.cell((self.medium)((self.run)(run)?.field())?.grid(), cell)
    }

    fn step(&self, run: &str, step: Option<usize>) -> Option<Misplaced> {
        let RunSettings::Light(LightSettings { frames, setup, .. }) = (self.run)(run)? else { return None };
        let step = step?;
        let is_last = setup.stopping.rule == StoppingRule::Steps(step);
        let problem = || format!("step {step} of \"{run}\" is not kept: add it to the run's `frames`");
        let missing = !is_last && frames.binary_search(&step).is_err();
        missing.then(|| Misplaced { word: format!("step: {step}"), problem: problem() })
    }

    fn slice(&self, run: &str, deg: f64) -> Option<Misplaced> {
        let RunSettings::Gradient(g) = (self.run)(run)? else { return None };
        let word = format!("deg: {deg}");
        match sample_of(deg, g.setup.directions) {
            Ok(sample) => {
                let missing = self.sample(run, sample, || format!("the slice at {deg} degrees"))?;
                Some(Misplaced { word, ..missing })
            }
            Err(problem) => Some(Misplaced { word, problem }),
        }
    }

    fn pulse(&self, run: &str, deg: f64) -> Option<Misplaced> {
        let RunSettings::Pulses(p) = (self.run)(run)? else { return None };
        let found = sample_of(deg, p.setup.directions);
        let missing = match found {
            Ok(sample) => p.pulses.iter().all(|(_, t)| *t != sample),
            Err(_) => true,
        };
        let problem = || format!("no pulse of \"{run}\" starts at {deg} degrees");
        missing.then(|| Misplaced { word: format!("deg: {deg}"), problem: problem() })
    }

    fn same_size(&self, map: &MapSource, with: &MapSource) -> Option<Misplaced> {
        let grid = |run: &str| Some((self.medium)((self.run)(run)?.field())?.grid());
        let problem = || format!("\"{}\" and \"{}\" differ in cells", map.run(), with.run());
        let same = grid(map.run())? == grid(with.run())?;
        (!same).then(|| Misplaced { word: format!("\"{}\"", with.run()), problem: problem() })
    }

    fn comparable(&self, run: &str, from: &str) -> Option<Misplaced> {
        let (RunSettings::Gradient(a), RunSettings::Gradient(b)) = ((self.run)(run)?, (self.run)(from)?)
        else {
            return None;
        };
        let grid = |g: &GradientSettings| (self.medium)(&g.setup.field).map(Medium::grid);
        let slices = |g: &GradientSettings| g.slices.clone().map(sorted);
        let same = grid(a)? == grid(b)? && a.setup.directions == b.setup.directions && slices(a) == slices(b);
        let problem = || format!("\"{run}\" and \"{from}\" differ in cells, directions or slices");
        (!same).then(|| Misplaced { word: format!("\"{from}\""), problem: problem() })
    }

    fn sample(&self, run: &str, sample: usize, what: impl Fn() -> String) -> Option<Misplaced> {
        let RunSettings::Gradient(g) = (self.run)(run)? else { return None };
        let missing = match &g.slices {
            Some(slices) => !slices.contains(&sample),
            None => sample >= g.setup.directions.count(),
        };
        let problem = || format!("{} is not among the slices of \"{run}\"", what());
        missing.then(|| Misplaced { word: format!("sample: {sample}"), problem: problem() })
    }
}
