//! The figures of an experiment.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use super::Pictures;
use super::words::words;
use crate::PictureSummary;
use crate::links::{address, path};

/// Up to this width in pixels three figures share a row.
const SMALL_PX: f64 = 400.0;

/// Up to this width in pixels two figures share a row; half a page shows them nearly at full size.
const MEDIUM_PX: f64 = 660.0;

/// All figures, one to three in a row.
pub(super) fn figures(slug: &str, figures: &[PictureSummary], pictures: &Pictures<'_>) -> Markup {
    html! {
        @if !figures.is_empty() {
            div.figures { @for f in figures { (figure(slug, f, pictures)) } }
        }
    }
}

fn figure(slug: &str, figure: &PictureSummary, pictures: &Pictures<'_>) -> Markup {
    let path_of = |extension: &str| path(slug, &format!("{}.{extension}", figure.name));
    let address_of = |extension: &str| address(&path_of(extension));
    let pngs = pictures(&path_of("png")).unwrap_or_default();
    let inside = |png: &Vec<u8>| format!("data:image/png;base64,{}", STANDARD.encode(png));
    let panels = if figure.panels.len() == pngs.len() { &figure.panels[..] } else { &[] };
    let class = if panels.is_empty() { size_class(figure.width_px) } else { "large" };
    html! {
        figure.(class) style={ "--width:" (figure.width_px.round()) "px" } {
            a.plate.panels[!panels.is_empty()] href=(address_of("svg")) {
                @for (panel, png) in panels.iter().zip(&pngs) {
                    (image(&inside(png), &panel.alt, [panel.width_px, panel.height_px]))
                }
                @if panels.is_empty() {
                    @let source = pngs.first().map_or_else(|| address_of("png"), inside);
                    (image(&source, &figure.alt, [figure.width_px, figure.height_px]))
                }
            }
            figcaption {
                (words(&figure.caption))
                " "
                span.files {
                    "Full size: "
                    a href=(address_of("svg")) { "SVG" }
                    ", "
                    a href=(address_of("png")) { "PNG" }
                    @if figure.frames > 0 {
                        ", "
                        a href=(address_of("apng")) { "animation" }
                    }
                }
            }
            @if figure.frames > 0 {
                // Moves only for those who ask, and is fetched only then.
                details.animation {
                    summary { "Watch the " (figure.frames) " frames" }
                    img src=(address_of("apng")) loading="lazy" alt={ "Animation. " (figure.caption) };
                }
            }
        }
    }
}

fn image(source: &str, alt: &str, size_px: [f64; 2]) -> Markup {
    let [width, height] = size_px.map(|side| side.round() as u32);
    html! { img src=(source) alt=(alt) width=(width) height=(height) style={ "--width:" (width) "px" }; }
}

fn size_class(width_px: f64) -> &'static str {
    if width_px <= SMALL_PX {
        "small"
    } else if width_px <= MEDIUM_PX {
        "medium"
    } else {
        "large"
    }
}
