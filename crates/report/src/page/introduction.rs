//! What the page shows, for someone who has not read the thesis.

use maud::{Markup, PreEscaped, html};

const FIELD: &str = "\
    A tensor field holds, at every point of a plane, a small matrix that says how strongly something acts \
    in each direction: stress in a part, diffusion in tissue, deformation in a flow. The thesis reproduced \
    here reads such a field by letting light run through it, the way the fibres in a tiger’s-eye stone \
    guide light along themselves and let little out sideways.";

const STEPS: [(&str, &str); 4] = [
    (
        "Tensor to ellipse.",
        "Each cell’s matrix becomes an ellipse: long where the tensor acts strongly, narrow across.",
    ),
    (
        "Ellipse to transmission.",
        "The ellipse’s radius in a direction says how readily light passes through the cell that way: its \
         transmission profile.",
    ),
    (
        "Light to eight neighbours.",
        "Light put into one cell is shared out among the eight cells around it as that profile says, then \
         from those to theirs, step by step, and nothing passed on is lost on the way, so energy is kept.",
    ),
    (
        "Comparison of neighbours.",
        "This is done for a flash of light from every cell in every direction, and each picture of light is \
         compared with those of the next cells and directions: how much they differ is the light transport \
         gradient (LTG), a field over x, y and direction.",
    ),
];

const RIDGES: &str = "\
    Where the LTG has a ridge, moving the lamp a little changes a lot about where its light ends up: there \
    the field’s lines diverge or meet, so the LTG does for tensor fields what the finite-time Lyapunov \
    exponent (FTLE) does for flows.";

const TENSOR_LINES: &str = "\
    The figures of the test fields have them too: curves that follow the major semi-axis of the tensors’ ellipses, \
    interpolated between the cells, evenly spaced and followed to the border. The thesis chose other seeds, so its curves \
    are others of the same family. Where it lays lines over light or over a gradient, this report has glyphs or a map of \
    the axis’ orientation beside them; the section on the classical methods has lines and gradients of the same fields.";

/// The method in a few sentences, beside a drawing of one cell.
pub(super) fn introduction() -> Markup {
    html! {
        section.introduction aria-labelledby="page--what" {
            div.words {
                h2 #page--what { "What this is" }
                p { (FIELD) }
                ol.steps { @for (lead, text) in STEPS { li { b { (lead) } " " (text) } } }
                p { (RIDGES) " " a href="#page--glossary" { "Terms are explained at the end." } }
            }
            (diagram())
        }
    }
}

/// A cell, its eight neighbours, its cones and its ellipse. Arrow widths and circle areas are the fluxes that
/// isotropic light has behind an ellipse with semi-axes 1 and 0.22 at 30 degrees.
fn diagram() -> Markup {
    html! {
        figure.diagram {
            (PreEscaped(include_str!("cell.svg")))
            figcaption {
                "One step for light that fills the middle cell evenly."
                ul.key {
                    li { span.swatch.tensor {} "transmission profile (the tensor’s ellipse)" }
                    li { span.swatch.side {} "goes to the side neighbour" }
                    li { span.swatch.corner {} "shared between corner and side neighbours" }
                    li { span.swatch.light {} "light on arrival, area by amount" }
                }
            }
        }
    }
}

/// How the tensor-line panels of the thesis are reproduced.
pub(super) fn about_tensor_lines() -> Markup {
    html! {
        section.note aria-labelledby="page--lines" {
            h2 #page--lines { "Where the thesis draws tensor lines" }
            p { (TENSOR_LINES) }
        }
    }
}
