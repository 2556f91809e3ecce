//! The fields and scenes of an experiment.

use crate::ids::{FieldId, MediumId};
use crate::medium::Medium;
use crate::scene::PreparedScene;
use tigereye_core::{CellShape, Field, Tensor2};
use tigereye_io::volume::PlaneGeometry;
use tigereye_render::Style;
use tigereye_views::Placement;

/// A field with its name.
#[derive(Clone, Debug)]
pub(crate) struct NamedField {
    /// Its name in the file.
    pub(crate) name: String,
    /// The tensors.
    pub(crate) field: Field<Tensor2>,
    /// The shape of its cells.
    pub(crate) cell: CellShape,
    /// Where they lie.
    pub(crate) geometry: PlaneGeometry,
    /// Unit of the coordinates, where the file states it.
    pub(crate) unit: Option<&'static str>,
}

impl NamedField {
    /// How pictures mark its axes, where its file has coordinates.
    pub(crate) fn place(&self) -> Style {
        let coordinates = Placement::new(self.geometry, self.field.grid()).coordinates();
        Style { coordinates, unit: self.unit.map(str::to_owned), ..Style::default() }
    }
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Media {
    /// Fields in the order of the file.
    pub(crate) fields: Vec<NamedField>,
    /// Scenes by their names in the order of the file.
    pub(crate) scenes: Vec<(String, PreparedScene)>,
}

impl Media {
    pub(crate) fn field(&self, id: FieldId) -> &NamedField {
        &self.fields[id.0]
    }

    pub(crate) fn medium(&self, id: MediumId) -> Medium<'_> {
        match id {
            MediumId::Field(id) => Medium::Tensors(&self.field(id).field),
            MediumId::Scene(i) => Medium::Scene(&self.scenes[i].1),
        }
    }

    pub(crate) fn name(&self, id: MediumId) -> &str {
        match id {
            MediumId::Field(id) => &self.field(id).name,
            MediumId::Scene(i) => &self.scenes[i].0,
        }
    }
}
