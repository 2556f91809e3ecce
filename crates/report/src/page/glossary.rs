//! The terms on the page, one sentence each.

use maud::{Markup, html};

use super::words::words;

const TERMS: [(&str, &str); 15] = [
    (
        "Tensor",
        "Here a 2 × 2 matrix in a cell, symmetric or not, that says how strongly something acts in each \
         direction.",
    ),
    (
        "Singular values",
        "The two semi-axes s₁ ≥ s₂ ≥ 0 of the ellipse into which the tensor turns the unit circle.",
    ),
    (
        "Transmission profile",
        "The radius of the tensor’s ellipse as a function of direction, scaled so that a cell never lets \
         out more light than came in: how readily light passes through the cell that way.",
    ),
    ("Radiant flux", "The amount of light handed from a cell to one neighbour in one step."),
    (
        "Lobe",
        "The shape in which light arrives in a neighbour, the positive half of a cosine around the \
         direction in which it travels, so that eight numbers describe all the light in a cell.",
    ),
    ("Isotropic", "The same in all directions; the ellipse is a circle."),
    ("Anisotropy", "How far the ellipse is from a circle, measured by the ratio s₁/s₂ of its semi-axes."),
    (
        "Total anisotropy",
        "The limit in which the ellipse is a line (s₂ = 0, or s₁/s₂ above 20) and light passes in just two \
         opposite directions.",
    ),
    (
        "LTG",
        "Light transport gradient: how much the final distribution of light changes when a flash is moved \
         by a cell in x or y or turned a little, summed over the whole field.",
    ),
    ("Ridge", "A curve of locally largest LTG, the sign of tensor lines that diverge or meet there."),
    (
        "FTLE",
        "Finite-time Lyapunov exponent: how fast neighbouring particles of a flow drift apart within a \
         given time, the model for the LTG, which itself is a difference and not an exponent.",
    ),
    (
        "Threshold",
        "Propagation stops once the total flux changes by less than this between two steps, so results \
         depend on it a little.",
    ),
    (
        "Stationary state",
        "The light that a further step no longer changes: what steps without end would lead to, free of any \
         threshold.",
    ),
    ("S", "The number of samples of the full circle of directions, a multiple of 8."),
    (
        "K",
        "The LTG compares the light of directions K samples to either side of a direction (`--omega-step`); by default \
         a twelfth of all samples, rounded up.",
    ),
];

/// The glossary.
pub(super) fn glossary() -> Markup {
    html! {
        section.glossary aria-labelledby="page--glossary" {
            h2 #page--glossary { "Glossary" }
            dl {
                @for (term, meaning) in TERMS { div { dt { (term) } dd { (words(meaning)) } } }
            }
        }
    }
}
