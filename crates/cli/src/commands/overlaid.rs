//! What is drawn over the pictures of a command.

use crate::args::style::{OverlayArgs, OverlayName};
use crate::error::CliError;
use crate::files;
use tigereye_core::{Field, Tensor2};
use tigereye_io::{PolyData, vtp};
use tigereye_views::Placement;
use tigereye_views::added::{Added, AddedError, Additions, Scalars, additions, check, of_poly_data};

/// The option in messages.
const OPTION: &str = "--overlay";

/// What the options ask for, files read.
#[derive(Debug, Default)]
pub(super) struct Overlaid {
    kinds: Vec<Added>,
    files: Vec<(String, PolyData)>,
}

impl Overlaid {
    /// Reads the files.
    pub(super) fn read(args: &OverlayArgs) -> Result<Self, CliError> {
        let mut overlaid = Self::default();
        for name in &args.overlays {
            match name {
                OverlayName::Kind(kind) => overlaid.kinds.push(*kind),
                OverlayName::File(path) => {
                    let name = path.display().to_string();
                    let data = vtp::read(&files::read(path)?).map_err(|e| CliError::input(&name, e))?;
                    overlaid.files.push((name, data));
                }
            }
        }
        Ok(overlaid)
    }

    /// Refuses what such a picture cannot have, before anything is computed. `diagrams` fill every cell.
    pub(super) fn check(
        &self,
        placement: &Placement,
        has_tensors: bool,
        has_scalar: bool,
        diagrams: bool,
    ) -> Result<(), CliError> {
        check(&self.kinds, has_tensors, has_scalar, diagrams).map_err(|e| CliError::input(OPTION, e))?;
        if let Some((name, _)) = self.files.first()
            && !placement.geometry().is_placed()
        {
            return Err(CliError::input(&format!("{OPTION} {name}"), AddedError::Unplaced));
        }
        Ok(())
    }

    /// All of it for one picture.
    pub(super) fn additions(
        &self,
        field: Option<&Field<Tensor2>>,
        placement: &Placement,
        scalars: Option<Scalars<'_>>,
    ) -> Result<Additions, CliError> {
        let fault = |e: AddedError| CliError::input(OPTION, e);
        let mut found = additions(&self.kinds, field, placement.cell(), scalars).map_err(fault)?;
        for (name, data) in &self.files {
            found.overlays.extend(of_poly_data(data, placement, name).map_err(fault)?);
        }
        Ok(found)
    }
}
