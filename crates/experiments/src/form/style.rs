//! How pictures look, in style files, figures and panels.

use super::chosen::Chosen;
use super::numbers::{Finite, Positive};
use super::placed::Placed;
use core::ops::RangeInclusive;
use serde::Deserialize;
use tigereye_render::{AxisNumbers, ColourMap, HeatScale, Length, Style, ValueRange};

/// A style file: how pictures of all kinds look.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct StyleFile {
    /// Version of the format: 1.
    pub(crate) format: Placed<u32>,
    /// What is chosen.
    pub(crate) style: Placed<StyleSource>,
}

/// How a picture looks; whatever is omitted is as the picture itself has it. A picture without a colour bar has no use
/// for the keys of colours, and figures and panels of experiments none for title and size.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct StyleSource {
    /// Heading.
    #[serde(default)]
    title: Option<String>,
    /// Colour map.
    #[serde(default)]
    colour_map: Option<Chosen<ColourMap>>,
    /// How values become colours.
    #[serde(default)]
    colour_scale: Option<ColourScale>,
    /// Values at the ends of the colour bar.
    #[serde(default)]
    range: Option<ColourRange>,
    /// Quantity and unit beside the colour bar.
    #[serde(default)]
    bar_label: Option<String>,
    /// Text below the horizontal axis.
    #[serde(default)]
    x_label: Option<String>,
    /// Text beside the vertical axis.
    #[serde(default)]
    y_label: Option<String>,
    /// What the axes are marked with: by default `File` in pictures of commands, `Cells` in experiments.
    #[serde(default)]
    coordinates: Option<Chosen<AxisNumbers>>,
    /// Unit of the file's coordinates.
    #[serde(default)]
    unit: Option<String>,
    /// What the legend calls cells without a tensor, which are grey; `no tensor` by default.
    #[serde(default)]
    masked_label: Option<String>,
    /// Width of the picture, millimetres.
    #[serde(default)]
    width_mm: Option<Positive>,
    /// Pixels per inch of a PNG; 192 by default.
    #[serde(default)]
    dpi: Option<Positive>,
    /// Size of axis numbers and legends, points; 8.25 by default.
    #[serde(default)]
    font_size_pt: Option<Positive>,
}

/// How values become colours.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum ColourScale {
    /// From the smallest to the largest value.
    Linear,
    /// Four decades below the largest value.
    Logarithmic,
    /// This many decades below it.
    Decades(Positive),
    /// Symmetric about 0.
    Diverging,
}

/// Values at the ends of a colour bar, the lower first.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub enum ColourRange {
    /// These values.
    Values(Finite, Finite),
    /// The values below which so many per cent of all values lie.
    Percentiles(Finite, Finite),
}

impl StyleSource {
    /// The style, or what is wrong with it.
    pub(crate) fn style(&self) -> Result<Style, String> {
        let range = self.range.map(ColourRange::range).transpose()?;
        Ok(Style {
            title: self.title.clone(),
            map: self.colour_map.map(|Chosen(map)| map),
            scale: self.colour_scale.map(ColourScale::scale),
            range,
            quantity: self.bar_label.clone(),
            x_name: self.x_label.clone(),
            y_name: self.y_label.clone(),
            numbers: self.coordinates.map(|Chosen(numbers)| numbers),
            unit: self.unit.clone(),
            coordinates: None,
            masked: self.masked_label.clone(),
            width: size("width_mm", self.width_mm, &Style::WIDTHS_MM)?.map(Length::Millimetres),
            font_pt: size("font_size_pt", self.font_size_pt, &Style::FONT_SIZES_PT)?,
            dpi: size("dpi", self.dpi, &Style::RESOLUTIONS_DPI)?,
        })
    }

    /// The first key that only single pictures have a use for.
    pub(crate) const fn of_single_pictures(&self) -> Option<&'static str> {
        match self {
            Self { title: Some(_), .. } => Some("title"),
            Self { width_mm: Some(_), .. } => Some("width_mm"),
            Self { dpi: Some(_), .. } => Some("dpi"),
            Self { font_size_pt: Some(_), .. } => Some("font_size_pt"),
            _ => None,
        }
    }
}

/// A size within its bounds.
fn size(key: &str, value: Option<Positive>, bounds: &RangeInclusive<f64>) -> Result<Option<f64>, String> {
    match value.map(Positive::get) {
        Some(v) if !bounds.contains(&v) => {
            Err(format!("{key} {v} is out of range: expected {} to {}", bounds.start(), bounds.end()))
        }
        value => Ok(value),
    }
}

impl ColourScale {
    const fn scale(self) -> HeatScale {
        match self {
            Self::Linear => HeatScale::Linear,
            Self::Logarithmic => HeatScale::USUAL_LOGARITHMIC,
            Self::Decades(decades) => HeatScale::Logarithmic { decades: decades.get() },
            Self::Diverging => HeatScale::Diverging,
        }
    }
}

impl ColourRange {
    fn range(self) -> Result<ValueRange, String> {
        let (range, low, high) = match self {
            Self::Values(a, b) => (ValueRange::Values(a.get(), b.get()), a.get(), b.get()),
            Self::Percentiles(a, b) => (ValueRange::Percentiles(a.get(), b.get()), a.get(), b.get()),
        };
        let shares = matches!(range, ValueRange::Percentiles(..));
        if low >= high || (shares && !(low >= 0.0 && high <= 100.0)) {
            let bounds = if shares { ", both from 0 to 100" } else { "" };
            return Err(format!(
                "the range from {low} to {high} is empty or impossible: expected the lower end first{bounds}"
            ));
        }
        Ok(range)
    }
}
