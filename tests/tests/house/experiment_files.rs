//! The reference of experiment files is generated from the types that parse them.

use crate::forms::{Content, Default, Form, Forms, Key, Parts, path_of};
use crate::root;
use std::collections::VecDeque;
use std::fmt::Write as _;
use syn::Type;
use tigereye_core::Choice;
use tigereye_lines::{Axes, Family, Major};
use tigereye_render::{AxisNumbers, ColourMap, GlyphColour};
use tigereye_transport::{ENGINES, ScatteringRule, SharedWeights};
use tigereye_views::added::Added;

const PAGE: &str = "docs/reference/experiment-files.md";

const INTRODUCTION: &str = "# Experiment files

<!-- Generated from the types that parse the files by `TIGEREYE_BLESS=1 cargo test -p tigereye-tests --test house`. -->

An experiment is a file `NAME.ron` with one value, `(key: value, ...)`, in [RON](https://github.com/ron-rs/ron).
Texts are quoted, names of kinds are not; a kind with keys is written `Kind(key: value, ...)`, a list `[...]`, and a map
`{\"name\": value, ...}`. Keys with a default are optional. Unknown keys and numbers out of range are refused with their
line and column; `tigereye check NAME.ron` reports them without running anything. `tigereye field new NAME --experiment`
writes an experiment to start from.
";

/// The roots: heading, module and name of the type.
const ROOTS: [(&str, &str, &str); 4] = [
    ("The experiment", "experiment", "Experiment"),
    ("Field files, `NAME.field.ron`", "form::field_source", "FieldFile"),
    ("Scene files, `NAME.scene.ron`", "form::scene_file", "SceneFile"),
    ("Style files, for `--style`", "form::style", "StyleFile"),
];

/// Results of the forms' default functions, as written in a file.
const FUNCTIONS: [(&str, &str); 9] = [
    ("Fraction::one", "1"),
    ("Positive::one", "1"),
    ("anisotropy", "Anisotropy"),
    ("one", "1"),
    ("semi_axes", "Half"),
    ("thousand", "1000"),
    ("three", "3"),
    ("two", "2"),
    ("yes", "true"),
];

/// Defaults of types without a default variant.
const TYPES: [(&str, &str); 8] = [
    ("AxesChoice", "Usual"),
    ("DirectionCount", "32"),
    ("EngineChoice", "EightLobe"),
    ("bool", "false"),
    ("f64", "0"),
    ("u32", "0"),
    ("u64", "0"),
    ("usize", "0"),
];

fn names<T: Choice>() -> String {
    T::ALL.iter().map(|value| format!("`{}`", value.file_name())).collect::<Vec<_>>().join(", ")
}

/// The names of a choice, as written in a file.
fn names_of_choice(choice: &str) -> String {
    match choice {
        "Added" => names::<Added>(),
        "Axes" => names::<Axes>(),
        "AxisNumbers" => names::<AxisNumbers>(),
        "ColourMap" => names::<ColourMap>(),
        "Family" => names::<Family>(),
        "GlyphColour" => names::<GlyphColour>(),
        "Major" => names::<Major>(),
        "ScatteringRule" => names::<ScatteringRule>(),
        "SharedWeights" => names::<SharedWeights>(),
        _ => panic!("`Chosen<{choice}>`: add its names to `names_of_choice` in {}", file!()),
    }
}

fn default_of_choice(choice: &str) -> String {
    match choice {
        "Family" => Family::default().file_name(),
        "ScatteringRule" => ScatteringRule::default().file_name(),
        "SharedWeights" => SharedWeights::default().file_name(),
        _ => panic!("`Chosen<{choice}>` has a default: add it to `default_of_choice` in {}", file!()),
    }
}

/// `LightSource` as a heading: `Light source`.
fn heading(name: &str) -> String {
    let mut words = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            words.push(' ');
        }
        words.extend(if i > 0 { c.to_lowercase().collect::<Vec<_>>() } else { vec![c] });
    }
    words
}

fn anchor(name: &str) -> String {
    heading(name).to_lowercase().replace(' ', "-")
}

/// The page while it is written. Every type that is mentioned gets a section.
struct Page<'a> {
    forms: &'a Forms,
    text: String,
    /// Module and name of all types mentioned so far.
    mentioned: Vec<(String, String)>,
    /// Those of them whose sections are still to be written.
    waiting: VecDeque<(String, String)>,
}

impl Page<'_> {
    /// Describes the values of a type that is named in `module`.
    fn value(&mut self, module: &str, ty: &Type) -> String {
        if let Type::Tuple(tuple) = ty {
            let parts: Vec<String> = tuple.elems.iter().map(|t| self.value(module, t)).collect();
            return format!("({})", parts.join(", "));
        }
        if let Type::Array(array) = ty {
            return format!("[{}, ...]", self.value(module, &array.elem));
        }
        let (name, arguments) = path_of(ty);
        let inner = |page: &mut Self| page.value(module, arguments[0]);
        match name.as_str() {
            "Placed" | "Option" | "Box" => inner(self),
            "Vec" => format!("[{}, ...]", inner(self)),
            "Named" => format!("{{\"name\": {}, ...}}", inner(self)),
            "Chosen" => names_of_choice(&path_of(arguments[0]).0),
            "AxesChoice" => format!("`Usual`, {}", names::<Axes>()),
            "EngineChoice" => ENGINES.iter().map(|e| format!("`{}`", e.id())).collect::<Vec<_>>().join(", "),
            "String" => "text".to_owned(),
            "bool" => "`true`, `false`".to_owned(),
            "usize" | "u64" | "u32" => "whole number".to_owned(),
            "NonZeroUsize" => "whole number from 1".to_owned(),
            "f64" | "Finite" => "number".to_owned(),
            "Positive" => "number above 0".to_owned(),
            "NonNegative" => "number from 0".to_owned(),
            "Fraction" => "number from 0 to 1".to_owned(),
            "Ratio" => "number from 1 to 1e12".to_owned(),
            "Sigma" => "number from 0 to 100".to_owned(),
            "DirectionCount" => "multiple of 8".to_owned(),
            "Parameter" => "number, `true`, `false` or text".to_owned(),
            "Point" => "(number, number)".to_owned(),
            name => {
                let Some((home, _)) = self.forms.get(module, name) else {
                    panic!("`{name}`, named in {module}: describe its values in {}", file!())
                };
                let key = (home.to_owned(), name.to_owned());
                if !self.mentioned.contains(&key) {
                    self.mentioned.push(key.clone());
                    self.waiting.push_back(key);
                }
                format!("[{}](#{})", heading(name).to_lowercase(), anchor(name))
            }
        }
    }

    /// The default of a key, as written in a file; empty for a required key, `None` for an absent value.
    fn default(&self, module: &str, key: &Key) -> Option<String> {
        // The only tuples with a default are pairs of numbers.
        let is_tuple = matches!(key.value, Type::Tuple(_));
        let named = |key: &Key| path_of(&key.value).0;
        let value = match &key.default {
            Default::Required => return Some(String::new()),
            Default::Function(function) => {
                let known = FUNCTIONS.iter().find(|(f, _)| f == function);
                known
                    .unwrap_or_else(|| panic!("`{function}`: add its result to FUNCTIONS in {}", file!()))
                    .1
                    .to_owned()
            }
            Default::OfType if is_tuple => "(0, 0)".to_owned(),
            Default::OfType if ["Option", "Vec", "Named", "String"].contains(&named(key).as_str()) => {
                return None;
            }
            Default::OfType if named(key) == "Chosen" => {
                default_of_choice(&path_of(path_of(&key.value).1[0]).0)
            }
            Default::OfType => match TYPES.iter().find(|(ty, _)| *ty == named(key)) {
                Some((_, value)) => (*value).to_owned(),
                None => match self.forms.get(module, &named(key)).map(|(_, form)| &form.content) {
                    Some(Content::Enum(variants)) if variants.iter().any(|v| v.is_default) => {
                        variants.iter().find(|v| v.is_default).expect("one").name.clone()
                    }
                    _ => panic!("`{}` has a default: add it to TYPES in {}", named(key), file!()),
                },
            },
        };
        Some(format!("`{value}`"))
    }

    fn parts(&mut self, module: &str, parts: &Parts) {
        match parts {
            Parts::Nothing => {}
            Parts::Values(types) => {
                let values: Vec<String> = types.iter().map(|ty| self.value(module, ty)).collect();
                let _ = writeln!(
                    self.text,
                    "\n{}: {}.",
                    if values.len() == 1 { "Argument" } else { "Arguments" },
                    values.join(", ")
                );
            }
            Parts::Keys(keys) => {
                self.text += "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
                for key in keys {
                    let value = self.value(module, &key.value).replace('|', "\\|");
                    let default = self.default(module, key).unwrap_or_else(|| "none".to_owned());
                    let doc = key.doc.replace('|', "\\|");
                    let _ = writeln!(self.text, "| `{}` | {value} | {default} | {doc} |", key.name);
                }
            }
        }
    }

    fn form(&mut self, module: &str, form: &Form) {
        if !form.doc.is_empty() {
            let _ = writeln!(self.text, "\n{}", form.doc);
        }
        match &form.content {
            Content::Struct(parts) => self.parts(module, parts),
            Content::Enum(variants) if variants.iter().all(|v| !matches!(v.parts, Parts::Keys(_))) => {
                self.text += "\n| value | meaning |\n| --- | --- |\n";
                for variant in variants {
                    let written = match &variant.parts {
                        Parts::Values(types) => {
                            let values: Vec<String> = types.iter().map(|ty| self.value(module, ty)).collect();
                            format!("`{}`({})", variant.name, values.join(", "))
                        }
                        _ => format!("`{}`", variant.name),
                    };
                    let default = if variant.is_default { " The default." } else { "" };
                    let _ =
                        writeln!(self.text, "| {written} | {}{default} |", variant.doc.replace('|', "\\|"));
                }
            }
            Content::Enum(variants) => {
                for variant in variants {
                    let _ = writeln!(self.text, "\n`{}`: {}", variant.name, variant.doc);
                    self.parts(module, &variant.parts);
                }
            }
            Content::Kinds(_) => unreachable!("kinds are found by name"),
        }
    }

    /// Writes the section of a type.
    fn section(&mut self, module: &str, name: &str) {
        let forms = self.forms;
        let (_, form) = forms.get(module, name).expect("a form");
        match &form.content {
            Content::Kinds(kinds) => {
                for kind in kinds {
                    let _ = writeln!(self.text, "\n### `{}`", kind.name);
                    let (_, form) = forms.get(&kind.module, &kind.name).expect("a kind in its file");
                    self.form(&kind.module, form);
                }
            }
            _ => self.form(module, form),
        }
    }
}

/// The page.
fn page() -> String {
    let forms = Forms::of_experiments();
    let mut page = Page {
        forms: &forms,
        text: INTRODUCTION.to_owned(),
        mentioned: Vec::new(),
        waiting: VecDeque::new(),
    };
    for (title, module, name) in ROOTS {
        let _ = writeln!(page.text, "\n## {title}");
        page.section(module, name);
        while let Some((module, name)) = page.waiting.pop_front() {
            let _ = writeln!(page.text, "\n## {}", heading(&name));
            page.section(&module, &name);
        }
    }
    page.text
}

#[test]
fn the_reference_of_experiment_files_matches_the_types() {
    let path = root().join(PAGE);
    let page = page();
    if std::env::var_os("TIGEREYE_BLESS").is_some() {
        std::fs::write(&path, &page).expect("a page that can be written");
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == page, "{PAGE} is stale: TIGEREYE_BLESS=1 regenerates it");
    for words in
        ["### `Gradient`", "### `RingShare`", "### `Texture`", "| `look_for` | text |", "### `Runtimes`"]
    {
        assert!(page.contains(words), "the page lacks {words}");
    }
}

/// Every key and kind needs a description in the page.
#[test]
fn every_key_and_kind_is_explained() {
    let empty: Vec<String> =
        page().lines().filter(|l| l.starts_with('|') && l.ends_with("|  |")).map(str::to_owned).collect();
    assert!(empty.is_empty(), "without documentation:\n{}", empty.join("\n"));
}
