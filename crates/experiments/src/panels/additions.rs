//! Lines, ridges, glyphs and topology over panels of something else.

use crate::form::{Chosen, Placed};
use crate::ids::FieldId;
use crate::names::Names;
use crate::results::Results;
use crate::unavailable::Unavailable;
use tigereye_core::CellShape;
use tigereye_views::added::{Added, Additions, Scalars, additions, check};

/// What a panel shows, as far as it decides on what may be drawn over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// A scalar.
    Scalar,
    /// A texture, which has no ridges.
    Texture,
    /// Diagrams that fill the cells, of light whose energy has ridges.
    Diagrams,
}

/// What is drawn over a panel, names looked up.
pub(crate) struct PlannedAdditions {
    wanted: Vec<Added>,
    field: Option<FieldId>,
}

impl PlannedAdditions {
    /// Over a panel of a field, or of none; `None` where something is wrong, which is reported.
    pub(crate) fn resolve(
        wanted: &Option<Placed<Vec<Chosen<Added>>>>,
        field: Option<FieldId>,
        shown: Shown,
        names: &mut Names<'_, '_>,
    ) -> Option<Self> {
        let Some(list) = wanted else { return Some(Self { wanted: Vec::new(), field }) };
        let wanted: Vec<Added> = list.iter().map(|Chosen(added)| *added).collect();
        match check(&wanted, field.is_some(), shown != Shown::Texture, shown == Shown::Diagrams) {
            Ok(()) => Some(Self { wanted, field }),
            Err(problem) => {
                names.fault(list.place(), &problem.to_string());
                None
            }
        }
    }

    /// All of it.
    pub(crate) fn over(
        &self,
        results: &Results<'_>,
        scalars: Option<Scalars<'_>>,
    ) -> Result<Additions, Unavailable> {
        let named = self.field.map(|id| results.field(id));
        let cell = named.map_or(CellShape::SQUARE, |named| named.cell);
        Ok(additions(&self.wanted, named.map(|named| &named.field), cell, scalars)?)
    }
}
