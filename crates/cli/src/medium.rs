//! What light runs through in a command: a tensor field or a scene.

use crate::args::light::ProfileArgs;
use crate::args::reading::ReadingArgs;
use crate::error::CliError;
use crate::files;
use crate::host::FileHost;
use crate::input::Input;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tigereye_core::{Cell, Directions, Field, Grid, ProfileRule, Surface, Tensor2, TransmissionField};
use tigereye_experiments::Medium;
use tigereye_experiments::scene::{PreparedScene, is_scene_file, light_fault, prepare};
use tigereye_input::Reading;
use tigereye_io::volume::PlaneGeometry;
use tigereye_transport::Light;
use tigereye_views::Placement;
use tigereye_views::total_anisotropy::ThinCells;

/// The scene of a file, and the names of all files it was read from.
pub(crate) fn read_scene(name: &str) -> Result<(PreparedScene, Vec<String>), CliError> {
    let text = files::read_text(Path::new(name))?;
    // Names in it are made relative to its folder, which leads from here.
    let host = FileHost::new(Some(PathBuf::from(".")), name.to_owned());
    let made = prepare(name, &text, &host);
    host.finish();
    let scene =
        made.map_err(|problems| CliError::Inputs(problems.iter().map(ToString::to_string).collect()))?;
    let mut opened = host.opened();
    opened.push(name.to_owned());
    Ok((scene, opened))
}

/// INPUT of commands that propagate.
#[derive(Debug)]
pub(crate) enum MediumInput {
    /// Tensors of a file or a generator.
    Tensors(Input),
    /// A scene, and the files it was read from.
    Scene(String, PreparedScene, Vec<String>),
}

impl MediumInput {
    /// Reads INPUT. What had to be assumed and what looks wrong goes to standard error.
    pub(crate) fn open(text: &str, reading: &ReadingArgs) -> Result<Self, CliError> {
        if !is_scene_file(text) {
            return Input::open_for_squares(text, reading).map(Self::Tensors);
        }
        if reading.reading() != Reading::default() {
            let problem = "is a scene, which has no tensors to read: expected no reading options";
            return Err(CliError::input(text, problem));
        }
        let (scene, files) = read_scene(text)?;
        for line in scene.remarks() {
            eprintln!("{text}: {line}");
        }
        Ok(Self::Scene(text.to_owned(), scene, files))
    }

    fn medium(&self) -> Medium<'_> {
        match self {
            Self::Tensors(input) => Medium::Tensors(&input.field),
            Self::Scene(_, scene, _) => Medium::Scene(scene),
        }
    }

    pub(crate) fn grid(&self) -> Grid {
        self.medium().grid()
    }

    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Tensors(input) => &input.name,
            Self::Scene(name, ..) => name,
        }
    }

    /// What pictures are headed with: a scene's own title.
    pub(crate) fn title(&self) -> &str {
        match self {
            Self::Tensors(input) => &input.name,
            Self::Scene(_, scene, _) => &scene.title,
        }
    }

    pub(crate) fn files(&self) -> &[String] {
        match self {
            Self::Tensors(input) => &input.files,
            Self::Scene(_, _, names) => names,
        }
    }

    /// Refuses outputs that are among the files that were read: the data would be gone.
    pub(crate) fn check_apart(&self, outputs: &[PathBuf]) -> Result<(), CliError> {
        files::check_apart(self.files(), outputs)
    }

    /// Hash of what determines the numbers, hex.
    pub(crate) fn blake3(&self) -> &str {
        match self {
            Self::Tensors(input) => &input.blake3,
            Self::Scene(_, scene, _) => &scene.blake3,
        }
    }

    /// How tensors become profiles, as asked for or as usual.
    pub(crate) fn rule(&self, asked: &ProfileArgs) -> Result<ProfileRule, CliError> {
        if let Self::Scene(..) = self {
            let refused = [
                (asked.normalization.is_some(), "--normalization"),
                (asked.total_anisotropy.is_some(), "--total-anisotropy"),
            ];
            if let Some((_, option)) = refused.iter().find(|(asked, _)| *asked) {
                let problem =
                    "cannot be set for a scene, whose crystals set their own: expected no such option";
                return Err(CliError::input(option, problem));
            }
        }
        Ok(asked.rule())
    }

    /// Adds the rule to the parameters of a run.
    pub(crate) fn insert_rule(&self, parameters: &mut Value, rule: ProfileRule) {
        match self {
            Self::Tensors(_) => {
                parameters["normalization"] = json!(rule.normalization.to_string());
                parameters["total_anisotropy"] = json!(rule.total_anisotropy.to_string());
            }
            Self::Scene(..) => parameters["normalization"] = json!("scene"),
        }
    }

    /// The totally anisotropic cells of a tensor field.
    pub(crate) fn thin_cells(&self, rule: ProfileRule) -> Option<ThinCells> {
        self.medium().tensors().and_then(|field| ThinCells::of(field, rule.total_anisotropy))
    }

    /// The tensor of a cell, if there are tensors.
    pub(crate) fn tensor(&self, cell: Cell) -> Option<&Tensor2> {
        self.medium().tensors().map(|field| field.at(cell))
    }

    pub(crate) fn transmission(
        &self,
        directions: Directions,
        rule: ProfileRule,
    ) -> Result<TransmissionField, CliError> {
        let made = self.medium().transmission(directions, rule);
        made.map_err(|e| CliError::input(self.name(), e))
    }

    /// Where its cells lie. A scene lies nowhere.
    pub(crate) const fn geometry(&self) -> &PlaneGeometry {
        match self {
            Self::Tensors(input) => &input.geometry,
            Self::Scene(..) => &PlaneGeometry::UNPLACED,
        }
    }

    /// The tensors, unless it is a scene.
    pub(crate) fn tensors(&self) -> Option<&Field<Tensor2>> {
        self.medium().tensors()
    }

    /// Cells without a tensor.
    pub(crate) fn masked(&self) -> Vec<Cell> {
        self.medium().masked()
    }

    /// Where its cells lie, for what is drawn.
    pub(crate) fn placement(&self) -> Placement {
        Placement::new(*self.geometry(), self.grid())
    }

    /// Unit of the coordinates, where the file states it.
    pub(crate) const fn unit(&self) -> Option<&'static str> {
        match self {
            Self::Tensors(input) => input.unit,
            Self::Scene(..) => None,
        }
    }

    /// The walls of a scene.
    pub(crate) fn surfaces(&self) -> Option<&Field<Option<Surface>>> {
        self.medium().scene().map(|scene| &scene.layout.surfaces)
    }

    /// Cells that send light back.
    pub(crate) fn reflecting(&self) -> usize {
        self.medium().scene().map_or(0, |scene| scene.layout.reflecting())
    }

    /// The lights a scene comes with.
    pub(crate) fn own_lights(&self, directions: Directions) -> Result<Vec<Light>, CliError> {
        let Some(scene) = self.medium().scene() else { return Ok(Vec::new()) };
        scene
            .lights_in(directions)
            .map_err(|faults| CliError::Inputs(faults.iter().map(ToString::to_string).collect()))
    }

    /// Refuses lights inside of walls.
    pub(crate) fn check_lights(&self, lights: &[Light]) -> Result<(), CliError> {
        let Some(scene) = self.medium().scene() else { return Ok(()) };
        match lights.iter().find_map(|light| light_fault(&scene.layout, light.cell)) {
            Some(problem) => Err(CliError::input("--light", problem)),
            None => Ok(()),
        }
    }
}
