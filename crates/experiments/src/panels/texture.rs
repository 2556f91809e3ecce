//! Noise smeared along an axis.

use crate::form::{AxesChoice, Chosen, Placed, StyleSource};
use crate::names::Names;
use crate::panels::additions::{PlannedAdditions, Shown};
use crate::panels::kind::{PANEL_PX, PanelKind, PlannedPanel};
use serde::Deserialize;
use tigereye_lines::{ConvolutionOptions, Family, Following, Major};
use tigereye_render::{Colours, TextureOptions};
use tigereye_views::added::{Added, Additions};
use tigereye_views::lic::{self, TextureRequest};

/// Noise smeared along an axis (line integral convolution).
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Texture {
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
    /// Smears along both axes, in proportion to their lengths (HyperLIC).
    #[serde(default)]
    hyper: bool,
    /// Heading of the panel.
    title: String,
    /// What is drawn over it, as `--overlay` of commands.
    #[serde(default)]
    overlays: Option<Placed<Vec<Chosen<Added>>>>,
    /// How it looks.
    #[serde(default)]
    style: Option<Placed<StyleSource>>,
}

impl PanelKind for Texture {
    fn style(&self) -> Option<&Placed<StyleSource>> {
        self.style.as_ref()
    }

    fn colours(&self) -> Colours {
        if self.hyper { Colours::Values } else { Colours::Kinds }
    }

    fn resolve(&self, names: &mut Names<'_, '_>) -> Option<PlannedPanel> {
        let field = names.field(&self.field)?;
        let named = names.named_field(field);
        let following = Following { axes: self.axes.ordered(self.major, &named.field), cell: named.cell };
        let (family, hyper) = (self.family.0, self.hyper);
        let of = Some(field);
        let added = PlannedAdditions::resolve(&self.overlays, of, Shown::Texture, names)?;
        let place = named.place();
        let panel = PlannedPanel::new(&self.title, move |drawing| {
            let field = &drawing.results.field(field).field;
            let longest = following.longer_side(field.grid()).ceil() as usize;
            // Whole pixels a sample, and at most eight samples a cell.
            let wanted = if drawing.alone { 2 * PANEL_PX } else { PANEL_PX } / longest;
            let pixels = wanted.div_ceil(8).max(1);
            let samples = (wanted / pixels).max(1);
            let options = ConvolutionOptions { samples, ..ConvolutionOptions::default() };
            let request = TextureRequest { following, family, hyper, options };
            let found = lic::texture(field, &request)?;
            let (title, cell_px) = (drawing.title.clone(), Some(samples * pixels));
            let style = drawing.style();
            let Additions { overlays, glyphs } = added.over(drawing.results, None)?;
            let options =
                TextureOptions { title, cell_px, style, overlays, glyphs, ..TextureOptions::default() };
            Ok(lic::picture(&found, field, &request, hyper, options)?)
        });
        Some(panel.placed(place))
    }
}
