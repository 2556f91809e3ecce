//! What light runs through: tensors or a scene.

use crate::scene::PreparedScene;
use tigereye_core::{Cell, Directions, Field, Grid, ProfileRule, Tensor2, TransmissionField};
use tigereye_input::provenance::hash_of_field;
use tigereye_scenes::{Fault, SceneError};

/// A field or a scene of an experiment.
#[derive(Clone, Copy, Debug)]
pub enum Medium<'a> {
    /// Tensors.
    Tensors(&'a Field<Tensor2>),
    /// Walls and crystals.
    Scene(&'a PreparedScene),
}

impl<'a> Medium<'a> {
    /// The cells.
    #[must_use]
    pub fn grid(self) -> Grid {
        match self {
            Self::Tensors(field) => field.grid(),
            Self::Scene(scene) => scene.scene.grid,
        }
    }

    /// The tensors, if it is made of them.
    #[must_use]
    pub const fn tensors(self) -> Option<&'a Field<Tensor2>> {
        match self {
            Self::Tensors(field) => Some(field),
            Self::Scene(_) => None,
        }
    }

    /// The scene, if it is one.
    #[must_use]
    pub const fn scene(self) -> Option<&'a PreparedScene> {
        match self {
            Self::Tensors(_) => None,
            Self::Scene(scene) => Some(scene),
        }
    }

    /// Cells without a tensor, which pictures show in grey; the walls of a scene are drawn as such.
    #[must_use]
    pub fn masked(self) -> Vec<Cell> {
        self.tensors().map_or_else(Vec::new, tigereye_views::masked)
    }

    /// What its cells do to light. A scene's crystals have a rule of their own.
    ///
    /// # Errors
    /// As [`TransmissionField::from_tensors`] and [`tigereye_scenes::Scene::transmission`].
    pub fn transmission(
        self,
        directions: Directions,
        rule: ProfileRule,
    ) -> Result<TransmissionField, SceneError> {
        match self {
            Self::Tensors(field) => TransmissionField::from_tensors(field, directions, rule)
                .map_err(|e| SceneError { part: None, fault: Fault::Core(e) }),
            Self::Scene(scene) => scene.transmission(directions),
        }
    }

    /// Hash of all that determines it, hex.
    #[must_use]
    pub fn blake3(self) -> String {
        match self {
            Self::Tensors(field) => hash_of_field(field),
            Self::Scene(scene) => scene.blake3.clone(),
        }
    }
}
