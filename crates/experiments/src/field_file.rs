//! Beginnings of field files and of experiments made from them.

use tigereye_fields::Generator;

/// Extension of files that hold a field; other `.ron` files below `experiments/` are experiments.
pub const EXTENSION: &str = ".field.ron";

/// Whether a name can be that of a file and of an experiment.
#[must_use]
pub fn is_name(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    !name.is_empty() && name.len() <= 60 && name.chars().all(fits) && !name.starts_with('-')
}

/// A field file to begin with: a saddle, whose lines part in the middle, with every key explained.
#[must_use]
pub fn template(name: &str) -> String {
    format!(
        r#"// A tensor field. Look at it with
//     tigereye field show {name}{EXTENSION} -o {name}.png
// and list likely mistakes in it with
//     tigereye field lint {name}{EXTENSION}
// Every command takes this file where it takes a generator: tigereye ltg {name}{EXTENSION} -o {name}.vti
(
    format: 1,
    title: "{name}",
    // Where it comes from: a paper with its equation, a measurement, or what it is to show.
    source: "",
    // The ellipse of every cell: a semi-axis of length s1 in direction phi, one of length s2 across it.
    //
    // Such a tensor is a rotation times its semi-axes, so it is not symmetric; light only sees the ellipse.
    //
    // Formulas know
    //     x, y       place, -1 to 1 from rim to rim, y up
    //     r, theta   distance from the middle and angle about it, radians
    //     i, j, n    column, row (0 on top), number of columns
    // and + - * / ^, if(r < 0.5, u, v), pi, and functions such as sin, atan2, exp, sqrt, abs, min and max.
    field: Axes(
        width: 51,
        height: 51,
        // Direction of the first semi-axis, radians counter-clockwise from the right.
        phi: "-theta",
        // Equal lengths in the middle, where there is no direction; four to one further out. The product is 1
        // everywhere, so no cell transmits more than another.
        s1: "1 + min(1, 4*r)",
        s2: "1/(1 + min(1, 4*r))",
    ),
    // Instead, the four components in the frame x right, y up:
    //     field: Components(width: 51, height: 51, xx: "1 + x^2", xy: "x*y", yx: "x*y", yy: "1 + y^2"),
    // a generator with other parameters:
    //     field: Generator(name: "inverse", parameters: {{"size": 51, "anisotropy": 4}}),
    // or a data file:
    //     field: File(path: "tensors.nii.gz", order: "dipy", slice: "z=30"),
)
"#
    )
}

/// An experiment with the field of `NAME.field.ron` in the same folder.
#[must_use]
pub fn experiment_template(name: &str) -> String {
    let head = format!(
        r#"// An experiment with the field of {name}{EXTENSION}. Run it with
//     tigereye run {name}.ron --out {name}-results
// In a folder below experiments/ of the project both files are found by `tigereye reproduce`, the tests and the
// gallery.
"#
    );
    head + &experiment(name, "", &format!(r#"File(path: "{name}{EXTENSION}")"#), UNIT_DETERMINANT)
}

/// An experiment that shows a generator with its default parameters.
#[must_use]
pub fn generator_template(generator: &Generator) -> String {
    let name = generator.name;
    let head = format!(
        r#"// An experiment with the generator `{name}`. Run it with
//     tigereye run {name}.ron --out {name}-results
// In a folder below experiments/ of the project it is found by `tigereye reproduce`, the tests and the gallery.
"#
    );
    let check = if generator.determinant_one { UNIT_DETERMINANT } else { LIGHT_MADE };
    head + &experiment(name, generator.source, &format!(r#"Generator(name: "{name}")"#), check)
}

/// A check of a field whose semi-axes are each other's inverse; `NAME` stands for the field's name.
const UNIT_DETERMINANT: &str = r#"(
            name: "no cell transmits more than another",
            quantity: DeterminantError(field: "NAME"),
            expect: AtMost(1e-12),
            basis: "both semi-axes are each other's inverse",
        )"#;

/// A check that holds for any field.
const LIGHT_MADE: &str = r#"(
            name: "steps of light",
            quantity: Steps(run: "light"),
            expect: Near(60, 0),
            basis: "as many as the run asks for",
        )"#;

fn experiment(name: &str, source: &str, field: &str, check: &str) -> String {
    let check = check.replace("NAME", name);
    format!(
        r#"(
    format: 1,
    title: "{name}",
    source: {source:?},
    section: "More fields",
    claim: "What the figures are to support.",
    look_for: "What to look at, for someone who does not know the field.",
    fields: {{
        "{name}": {field},
    }},
    runs: {{
        "light": Light(
            field: "{name}",
            lights: [(cell: (25, 40), profile: Isotropic(1))],
            stop: Steps(60),
        ),
        "gradient": Gradient(field: "{name}", directions: 16, slices_deg: [90]),
    }},
    figures: [
        (
            name: "{name}",
            caption: "The tensors, the light of one cell, and the gradient for pulses sent upwards.",
            panels: [
                Glyphs(field: "{name}", title: "tensor field"),
                Energy(run: "light", decades: 4, title: "light of one cell"),
                Slice(run: "gradient", deg: 90, title: "light transport gradient, 90 degrees"),
            ],
        ),
    ],
    checks: [
        {check},
    ],
)
"#
    )
}
