//! Names of a file to ids, with every fault and every use.

use crate::fault::Faults;
use crate::form::{Finite, Place, Placed};
use crate::ids::{
    FieldId, FrameId, FtleId, GradientId, ImportanceId, LightId, MediumId, PulsesId, RunId, SliceId,
};
use crate::lights::sample_of;
use crate::media::{Media, NamedField};
use crate::medium::Medium;
use crate::runs::RunPlan;
use crate::runs::light::Kept;
use std::collections::BTreeMap;
use tigereye_core::{Cell, Directions, Grid};
use tigereye_fields::Expression;
use tigereye_render::Style;
use tigereye_scenes::shortest_path;
use tigereye_transport::StoppingRule;

/// A run as other parts of the file see it.
pub(crate) struct KnownRun {
    pub(crate) name: String,
    /// `None` where it has faults of its own.
    pub(crate) plan: Option<RunPlan>,
    /// Whether it is made, or of another scope.
    pub(crate) is_made: bool,
}

/// Hands out ids, and keeps what is asked for: faults, and what runs must keep of their steps.
///
/// Figures, tables and checks are resolved one after the other ([`Self::item`]). One that needs a run of another scope
/// is checked like any other and then left out.
pub(crate) struct Names<'a, 'f> {
    media: &'a Media,
    runs: &'a [KnownRun],
    /// Names of all fields, those among them that could not be made.
    declared: &'a [String],
    faults: &'a mut Faults<'f>,
    /// What is being resolved: `figure "name"`.
    user: String,
    /// Whether it needs a run that is not made.
    lacks_run: bool,
    /// What runs must keep for it.
    kept: BTreeMap<LightId, Kept>,
    /// The same for all that is not left out.
    kept_for_all: BTreeMap<LightId, Kept>,
}

impl<'a, 'f> Names<'a, 'f> {
    pub(crate) fn new(
        media: &'a Media,
        runs: &'a [KnownRun],
        declared: &'a [String],
        faults: &'a mut Faults<'f>,
    ) -> Self {
        Self {
            media,
            runs,
            declared,
            faults,
            user: String::new(),
            lacks_run: false,
            kept: BTreeMap::new(),
            kept_for_all: BTreeMap::new(),
        }
    }

    /// What every run of light must keep, as far as it was asked for.
    pub(crate) fn into_kept(self) -> BTreeMap<LightId, Kept> {
        self.kept_for_all
    }

    /// Resolves a figure's panel, a table's row or a check; `None` where it has faults, or needs a run that is not
    /// made.
    pub(crate) fn item<T>(
        &mut self,
        kind: &str,
        name: &str,
        resolve: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        self.user = format!("{kind} \"{name}\"");
        self.part(resolve)
    }

    /// The same for a part of an item that may be left out by itself.
    pub(crate) fn part<T>(&mut self, resolve: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let outer = (std::mem::take(&mut self.lacks_run), std::mem::take(&mut self.kept));
        let found = resolve(self);
        let is_kept = found.is_some() && !self.lacks_run;
        for (light, kept) in std::mem::take(&mut self.kept) {
            if is_kept {
                self.kept_for_all.entry(light).or_default().merge(&kept);
            }
        }
        (self.lacks_run, self.kept) = outer;
        found.filter(|_| is_kept)
    }

    /// Reports what is wrong with a value of the item.
    pub(crate) fn fault(&mut self, place: Place, problem: &str) {
        self.faults.at(place, &format!("{}: {problem}", self.user));
    }

    /// A field by its name.
    pub(crate) fn field(&mut self, name: &Placed<String>) -> Option<FieldId> {
        let found = self.media.fields.iter().position(|f| f.name == **name);
        if found.is_none() && !self.declared.contains(name) {
            let known = self.declared.join(", ");
            let problem = format!("{} names a field \"{name}\": expected one of {known}", self.user);
            self.faults.at(name.place(), &problem);
        }
        found.map(FieldId)
    }

    pub(crate) fn named_field(&self, id: FieldId) -> &'a NamedField {
        self.media.field(id)
    }

    /// A run of any kind.
    pub(crate) fn run(&mut self, name: &Placed<String>) -> Option<RunId> {
        let found = self.runs.iter().position(|r| r.name == **name);
        if found.is_none() {
            let known = self.runs.iter().map(|r| r.name.as_str()).collect::<Vec<_>>().join(", ");
            let problem = format!("{} names a run \"{name}\": expected one of {known}", self.user);
            self.faults.at(name.place(), &problem);
        }
        found.map(RunId)
    }

    /// A run of a kind, by its name.
    fn run_of<T>(
        &mut self,
        name: &Placed<String>,
        kind: &str,
        id: fn(RunId) -> T,
        is_of_kind: impl Fn(&RunPlan) -> bool,
    ) -> Option<T> {
        let run = self.run(name)?;
        let known = &self.runs[run.0];
        // Its own faults are reported already.
        let plan = known.plan.as_ref()?;
        if !is_of_kind(plan) {
            let problem = format!(
                "{} takes \"{name}\" for a run of the kind {kind}, but it is a {}",
                self.user,
                plan.kind()
            );
            self.faults.at(name.place(), &problem);
            return None;
        }
        self.lacks_run |= !known.is_made;
        Some(id(run))
    }

    pub(crate) fn light(&mut self, name: &Placed<String>) -> Option<LightId> {
        self.run_of(name, "Light", LightId, |plan| matches!(plan, RunPlan::Light(_)))
    }

    pub(crate) fn gradient(&mut self, name: &Placed<String>) -> Option<GradientId> {
        self.run_of(name, "Gradient", GradientId, |plan| matches!(plan, RunPlan::Gradient(_)))
    }

    pub(crate) fn importance(&mut self, name: &Placed<String>) -> Option<ImportanceId> {
        self.run_of(name, "Importance", ImportanceId, |plan| matches!(plan, RunPlan::Importance(_)))
    }

    pub(crate) fn pulses(&mut self, name: &Placed<String>) -> Option<PulsesId> {
        self.run_of(name, "Pulses", PulsesId, |plan| matches!(plan, RunPlan::Pulses(_)))
    }

    pub(crate) fn ftle(&mut self, name: &Placed<String>) -> Option<FtleId> {
        self.run_of(name, "Ftle", FtleId, |plan| matches!(plan, RunPlan::Ftle(_)))
    }

    /// What a run keeps of its steps.
    fn keeps(&mut self, light: LightId) -> &mut Kept {
        self.kept.entry(light).or_default()
    }

    /// The state of a run of light after a step, which it will keep; the last where no step is named.
    pub(crate) fn frame(&mut self, run: &Placed<String>, step: Option<&Placed<usize>>) -> Option<FrameId> {
        let light = self.light(run)?;
        let Some(step) = step else { return Some(FrameId { light, step: None }) };
        self.step(light, step)?;
        self.keeps(light).frames.insert(**step);
        Some(FrameId { light, step: Some(**step) })
    }

    /// A run of light that will keep the radius of its energy at every step.
    pub(crate) fn light_with_radii(&mut self, run: &Placed<String>) -> Option<LightId> {
        let light = self.light(run)?;
        self.keeps(light).radii = true;
        Some(light)
    }

    /// A run of light that will keep every `every`-th step for an animation.
    pub(crate) fn light_with_reel(&mut self, run: &Placed<String>, every: usize) -> Option<LightId> {
        let light = self.light(run)?;
        self.keeps(light).merge(&Kept { reel_every: Some(every), ..Kept::default() });
        Some(light)
    }

    /// Checks that a run of a given number of steps gets to a step.
    pub(crate) fn step(&mut self, light: LightId, step: &Placed<usize>) -> Option<()> {
        let known = &self.runs[light.0.0];
        let Some(RunPlan::Light(plan)) = &known.plan else { return None };
        if let StoppingRule::Steps(n) = plan.setup.stopping.rule
            && **step > n
        {
            let problem = format!("step {step} of \"{}\", which ends after {n} steps", known.name);
            self.fault(step.key(), &problem);
            return None;
        }
        Some(())
    }

    fn plan(&self, run: RunId) -> Option<&'a RunPlan> {
        self.runs[run.0].plan.as_ref()
    }

    fn medium_of(&self, run: RunId) -> Option<MediumId> {
        self.plan(run).map(RunPlan::medium)
    }

    /// Cells of what a run goes through.
    pub(crate) fn grid(&self, run: RunId) -> Option<Grid> {
        self.medium_of(run).map(|id| self.media.medium(id).grid())
    }

    /// How pictures mark the axes of what a run goes through, where its file has coordinates.
    pub(crate) fn place(&self, run: RunId) -> Style {
        self.field_of(run).map_or_else(Style::default, |id| self.media.field(id).place())
    }

    /// The field that a run goes through; none where it is a scene.
    pub(crate) fn field_of(&self, run: RunId) -> Option<FieldId> {
        match self.medium_of(run)? {
            MediumId::Field(id) => Some(id),
            MediumId::Scene(_) => None,
        }
    }

    /// A cell of a run.
    pub(crate) fn cell_of(&mut self, run: RunId, cell: &Placed<(usize, usize)>) -> Option<Cell> {
        let grid = self.grid(run)?;
        self.cell(grid, **cell, cell.place())
    }

    /// A cell of a grid.
    pub(crate) fn cell(&mut self, grid: Grid, (x, y): (usize, usize), place: Place) -> Option<Cell> {
        let cell = Cell::new(x, y);
        if grid.contains(cell) {
            return Some(cell);
        }
        let (w, h) = (grid.width(), grid.height());
        self.fault(place, &format!("cell ({x}, {y}) lies outside of the {w} x {h} cells"));
        None
    }

    /// A range of columns or rows, both ends included; not empty.
    pub(crate) fn range(
        &mut self,
        range: &Placed<(usize, usize)>,
    ) -> Option<std::ops::RangeInclusive<usize>> {
        let (from, to) = **range;
        if from > to {
            self.fault(range.place(), &format!("the range from {from} to {to} is empty"));
            return None;
        }
        Some(from..=to)
    }

    /// A run of light through a scene.
    pub(crate) fn light_in_scene(&mut self, name: &Placed<String>) -> Option<LightId> {
        let light = self.light(name)?;
        if self.medium_of(light.0).is_some_and(|id| matches!(id, MediumId::Field(_))) {
            self.fault(
                name.place(),
                &format!("\"{name}\" runs through a field: paths are found through scenes"),
            );
            return None;
        }
        Some(light)
    }

    /// A run of light through a scene, and a cell with a path to its first light.
    pub(crate) fn path_to(
        &mut self,
        name: &Placed<String>,
        to: &Placed<(usize, usize)>,
    ) -> Option<(LightId, Cell)> {
        let light = self.light_in_scene(name)?;
        let cell = self.cell_of(light.0, to)?;
        let Some(RunPlan::Light(plan)) = self.plan(light.0) else { return None };
        let Medium::Scene(scene) = self.media.medium(plan.setup.medium) else { return None };
        let source = plan.lights.first()?.cell;
        if shortest_path(&scene.open(), source, cell).is_none() {
            let problem =
                format!("there is no path from the light of \"{name}\" to cell ({}, {})", to.0, to.1);
            self.fault(to.place(), &problem);
            return None;
        }
        Some((light, cell))
    }

    /// The angular sampling of a run.
    pub(crate) fn directions(&self, run: RunId) -> Option<Directions> {
        match self.plan(run)? {
            RunPlan::Light(plan) => Some(plan.setup.directions),
            RunPlan::Gradient(plan) => Some(plan.setup.directions),
            RunPlan::Importance(plan) => Some(plan.setup.directions),
            RunPlan::Pulses(plan) => Some(plan.setup.directions),
            RunPlan::Ftle(_) => None,
        }
    }

    /// The slices of a gradient, ascending; `None`: all.
    pub(crate) fn slices(&self, gradient: GradientId) -> Option<Vec<usize>> {
        let Some(RunPlan::Gradient(plan)) = self.plan(gradient.0) else { return None };
        let mut slices = plan.slices.clone()?;
        slices.sort_unstable();
        slices.dedup();
        Some(slices)
    }

    /// A direction of a gradient, which must be among its slices.
    pub(crate) fn slice(&mut self, run: &Placed<String>, deg: &Placed<Finite>) -> Option<SliceId> {
        let gradient = self.gradient(run)?;
        let sample = match sample_of(deg.get(), self.directions(gradient.0)?) {
            Ok(sample) => sample,
            Err(problem) => {
                self.fault(deg.key(), &problem);
                return None;
            }
        };
        self.sample(gradient, sample, deg.key(), &format!("the slice at {} degrees", deg.get()))
    }

    /// A sample of a gradient, which must be among its slices.
    pub(crate) fn sample(
        &mut self,
        gradient: GradientId,
        sample: usize,
        place: Place,
        what: &str,
    ) -> Option<SliceId> {
        let there = match self.slices(gradient) {
            Some(slices) => slices.contains(&sample),
            None => sample < self.directions(gradient.0)?.count(),
        };
        if there {
            return Some(SliceId { gradient, sample });
        }
        let problem = format!("{what} is not among the slices of \"{}\"", self.runs[gradient.0.0].name);
        self.fault(place, &problem);
        None
    }

    /// The sample of the pulses of a run in a direction.
    pub(crate) fn pulse_direction(&mut self, pulses: PulsesId, deg: &Placed<Finite>) -> Option<usize> {
        let Some(RunPlan::Pulses(plan)) = self.plan(pulses.0) else { return None };
        let found = sample_of(deg.get(), plan.setup.directions).ok();
        let found = found.filter(|sample| plan.pulses.iter().any(|(_, t)| t == sample));
        if found.is_none() {
            let name = &self.runs[pulses.0.0].name;
            let problem = format!("no pulse of \"{name}\" starts at {} degrees", deg.get());
            self.fault(deg.key(), &problem);
        }
        found
    }

    /// An expression in some variables.
    pub(crate) fn expression(&mut self, text: &Placed<String>, variables: &[&str]) -> Option<Expression> {
        match Expression::parse(text, variables) {
            Ok(expression) => Some(expression),
            Err(fault) => {
                let place = text.place().inside(fault.line, fault.column);
                self.fault(place, &format!("`{text}`: {}", fault.kind));
                None
            }
        }
    }
}
