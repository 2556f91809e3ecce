//! The finite-time Lyapunov exponent of a field's lines.

use crate::form::{AxesChoice, Chosen, Placed, Positive, Scope};
use crate::host::Host;
use crate::ids::{FieldId, MediumId};
use crate::media::Media;
use crate::runs::digest::{FtleDigest, quantiles, rounded};
use crate::runs::error::RunError;
use crate::runs::setup::RunResolver;
use serde::Deserialize;
use serde_json::json;
use tigereye_core::{Cell, Field, Grid};
use tigereye_input::provenance::{hash_of_field, provenance, with_rows};
use tigereye_io::volume::PlaneGeometry;
use tigereye_io::{IoError, Rows, vti};
use tigereye_lines::{Family, Following, FtleOptions, Major};
use tigereye_report::DataFile;
use tigereye_views::{Placement, ftle, image};

/// Most samples a cell along each side: more show nothing.
const MAX_SAMPLES_A_CELL: usize = 16;

/// The finite-time Lyapunov exponent of the field's lines.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Ftle {
    /// Name of the field.
    field: Placed<String>,
    /// The axes that lines follow.
    #[serde(default)]
    axes: AxesChoice,
    /// Whether the major axis has the larger value or the larger magnitude.
    #[serde(default)]
    major: Option<Chosen<Major>>,
    /// Which of the two axes.
    #[serde(default)]
    family: Chosen<Family>,
    /// Length of the lines in each direction, in units of the shorter side of a cell.
    length: Positive,
    /// Samples per cell along each side.
    #[serde(default = "two")]
    samples: usize,
    /// When it runs.
    #[serde(default)]
    pub(crate) scope: Scope,
}

fn two() -> usize {
    2
}

/// Exponents, ready to be computed.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) field: FieldId,
    /// The axes that lines follow, over which cells.
    pub(crate) following: Following,
    family: Family,
    /// Length of the lines in each direction, in units of the shorter side of a cell.
    length: f64,
    /// Samples per cell along each side.
    samples: usize,
}

impl Ftle {
    pub(crate) fn resolve(&self, run: &mut RunResolver<'_, '_>) -> Option<Plan> {
        let MediumId::Field(field) = run.medium(&self.field)? else {
            run.fault(": a scene has no tensors: expected the name of a field");
            return None;
        };
        let samples = self.samples;
        if !(1..=MAX_SAMPLES_A_CELL).contains(&samples) {
            run.fault(&format!(": {samples} samples per cell: expected 1 to {MAX_SAMPLES_A_CELL}"));
            return None;
        }
        let named = run.media.field(field);
        let following = Following { axes: self.axes.ordered(self.major, &named.field), cell: named.cell };
        Some(Plan { field, following, family: self.family.0, length: self.length.get(), samples })
    }
}

/// The exponents, with their field and the axes that lines followed.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) field: FieldId,
    pub(crate) found: tigereye_lines::Ftle,
    pub(crate) following: Following,
}

impl Plan {
    pub(crate) const fn medium(&self) -> MediumId {
        MediumId::Field(self.field)
    }

    pub(crate) fn run(
        &self,
        name: &str,
        media: &Media,
        _memory_bytes: u64,
        host: &dyn Host,
    ) -> Result<Outcome, RunError> {
        if host.progress(name, 0, 0).is_break() {
            return Err(RunError::Interrupted);
        }
        let options = FtleOptions { length: self.length, samples: self.samples, ..FtleOptions::default() };
        let field = &media.field(self.field).field;
        let found = ftle::exponents(field, self.following, self.family, &options)
            .map_err(|source| RunError::Ftle { run: name.to_owned(), source })?;
        Ok(Outcome { field: self.field, found, following: self.following })
    }
}

impl Outcome {
    /// The larger exponents at the cells' own samples.
    pub(crate) fn at_cells(&self) -> Field<f64> {
        let (fine, samples) = (self.found.larger.grid(), self.found.samples);
        let n = |v: usize| (v - 1) / samples + 1;
        match Grid::new(n(fine.width()), n(fine.height())) {
            Ok(grid) => {
                Field::from_fn(grid, |c| *self.found.larger.at(Cell::new(samples * c.x, samples * c.y)))
            }
            Err(_) => self.found.larger.clone(),
        }
    }

    pub(crate) fn work(&self) -> Vec<(&'static str, u64)> {
        let lines = self.found.larger.values().iter().filter(|v| v.is_finite()).count();
        vec![("lines", 2 * lines as u64)]
    }

    pub(crate) fn digest(&self) -> FtleDigest {
        let found = &self.found;
        let finite: Vec<f64> = found.larger.values().iter().copied().filter(|v| v.is_finite()).collect();
        FtleDigest {
            samples: found.samples,
            lines: 2 * finite.len(),
            left: rounded(found.left),
            quantiles: quantiles(finite),
        }
    }

    /// Both exponents as image data.
    pub(crate) fn data(
        &self,
        plan: &Plan,
        name: &str,
        command: &str,
        media: &Media,
    ) -> Result<DataFile, IoError> {
        let named = media.field(plan.field);
        let parameters = json!({
            "field": named.name,
            "axes": plan.following.axes.axes().name(),
            "major": plan.following.axes.major().name(),
            "family": plan.family.name(),
            "length": plan.length,
            "samples": plan.samples,
        });
        let story = provenance(command, &with_rows(parameters, Rows::Upwards), &hash_of_field(&named.field));
        let spacing = PlaneGeometry::UNPLACED.with_spacing(self.found.cell.sides());
        let placement = Placement::new(spacing, named.field.grid());
        let arrays = [("FTLE", &self.found.larger), ("FTLE_smaller", &self.found.smaller)];
        let image = image(&arrays, [self.found.samples; 2], &placement, &story);
        Ok(DataFile { name: format!("{name}.vti"), bytes: vti::write(&image)? })
    }
}
