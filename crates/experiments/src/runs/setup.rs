//! What runs of light share, and how they are resolved.

use crate::fault::Faults;
use crate::form::{Chosen, DirectionCount, NormalizationRule, Place, Placed, Stop, TotalAnisotropyRule};
use crate::ids::{FieldId, MediumId};
use crate::media::Media;
use crate::medium::Medium;
use crate::runs::error::RunError;
use serde_json::{Value, json};
use tigereye_core::{Choice, Directions, ProfileRule, TransmissionField};
use tigereye_input::provenance::{provenance, with_rows};
use tigereye_io::Rows;
use tigereye_io::volume::PlaneGeometry;
use tigereye_transport::{ScatteringRule, Scheme, SharedWeights, Stopping};
use tigereye_views::total_anisotropy::ThinCells;

/// What runs of light, gradients and pulses share.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    /// What light goes through.
    pub(crate) medium: MediumId,
    /// Angular sampling.
    pub(crate) directions: Directions,
    /// How tensors become transmission profiles.
    pub(crate) rule: ProfileRule,
    /// Cone weights of the overlap.
    pub(crate) weights: SharedWeights,
    /// How a cell scatters light that arrives from several sides.
    pub(crate) scattering: ScatteringRule,
    /// When each propagation ends.
    pub(crate) stopping: Stopping,
}

impl Setup {
    /// Weights, lobes and scattering.
    pub(crate) fn scheme(&self) -> Scheme {
        Scheme::new(self.directions, self.weights).with_scattering(self.scattering)
    }

    /// What the cells do to light.
    pub(crate) fn transmission(&self, run: &str, medium: Medium<'_>) -> Result<TransmissionField, RunError> {
        let failed = |source| RunError::Field { run: run.to_owned(), source };
        medium.transmission(self.directions, self.rule).map_err(failed)
    }

    /// The totally anisotropic cells of the field.
    pub(crate) fn thin_cells(&self, medium: Medium<'_>) -> Option<ThinCells> {
        medium.tensors().and_then(|field| ThinCells::of(field, self.rule.total_anisotropy))
    }

    /// How a result came about: the parameters that all have and those of its kind.
    pub(crate) fn story(&self, command: &str, media: &Media, own: Value) -> String {
        let mut parameters = json!({
            "field": media.name(self.medium),
            "directions": self.directions.count(),
            "stop": self.stopping.rule.name(),
            "threshold": self.stopping.rule.threshold(),
            "max_iterations": self.stopping.max_iterations,
            "weights": self.weights.file_name(),
            "scattering": self.scattering.word(),
        });
        match self.medium {
            MediumId::Scene(_) => parameters["normalization"] = json!("scene"),
            MediumId::Field(_) => {
                parameters["normalization"] = json!(self.rule.normalization.to_string());
                parameters["total_anisotropy"] = json!(self.rule.total_anisotropy.to_string());
            }
        }
        if let (Some(all), Value::Object(own)) = (parameters.as_object_mut(), own) {
            all.extend(own);
        }
        let parameters = with_rows(parameters, Rows::of_results(&PlaneGeometry::UNPLACED));
        provenance(command, &parameters, &media.medium(self.medium).blake3())
    }
}

/// Resolves one run.
pub(crate) struct RunResolver<'a, 'f> {
    pub(crate) name: &'a Placed<String>,
    pub(crate) media: &'a Media,
    /// Names of all fields and scenes that the file has, those among them that could not be made.
    pub(crate) declared: &'a [String],
    pub(crate) faults: &'a mut Faults<'f>,
}

impl RunResolver<'_, '_> {
    /// Reports what is wrong with the run.
    pub(crate) fn fault(&mut self, problem: &str) {
        self.fault_at(None, problem);
    }

    /// The same, of one of its values.
    pub(crate) fn fault_at(&mut self, place: Option<Place>, problem: &str) {
        let place = place.unwrap_or(self.name.place());
        self.faults.at(place, &format!("run \"{}\"{problem}", self.name));
    }

    /// The field or scene of a name.
    pub(crate) fn medium(&mut self, name: &Placed<String>) -> Option<MediumId> {
        let field = self.media.fields.iter().position(|f| f.name == **name);
        let scene = || self.media.scenes.iter().position(|(n, _)| *n == **name);
        let found = field.map(|i| MediumId::Field(FieldId(i))).or_else(|| scene().map(MediumId::Scene));
        if found.is_none() && !self.declared.contains(name) {
            let known = self.declared.join(", ");
            let problem = format!("run \"{}\" names a field \"{name}\": expected one of {known}", self.name);
            self.faults.at(name.place(), &problem);
        }
        found
    }

    /// What a run of light says of its field and its scheme.
    pub(crate) fn setup(
        &mut self,
        field: &Placed<String>,
        directions: DirectionCount,
        (normalization, total_anisotropy): (NormalizationRule, TotalAnisotropyRule),
        weights: Chosen<SharedWeights>,
        scattering: Chosen<ScatteringRule>,
        stop: Stop,
    ) -> Option<Setup> {
        let medium = self.medium(field)?;
        if matches!(medium, MediumId::Scene(_)) {
            if normalization != NormalizationRule::default() {
                self.fault(": a scene's crystals have a normalisation of their own, in the scene's file");
                return None;
            }
            if total_anisotropy != TotalAnisotropyRule::default() {
                self.fault(": `total_anisotropy` is for fields, and scenes are as published: expected none");
                return None;
            }
        }
        let total_anisotropy =
            total_anisotropy.rule().map_err(|problem| self.fault(&format!(": {problem}"))).ok()?;
        Some(Setup {
            medium,
            directions: directions.0,
            rule: ProfileRule { normalization: normalization.normalization(), total_anisotropy },
            weights: weights.0,
            scattering: scattering.0,
            stopping: stop.stopping(scattering.0),
        })
    }
}
