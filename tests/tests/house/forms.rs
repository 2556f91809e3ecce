//! The types that parse experiment files, read from their source: fields, documentation and defaults.

use crate::root;
use proc_macro2::TokenTree;
use std::collections::BTreeMap;
use std::path::Path;
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, Fields, GenericArgument, Item, Lit, Meta, PathArguments, Type};

/// A type that a file is parsed into.
pub(crate) struct Form {
    pub(crate) doc: String,
    pub(crate) content: Content,
}

pub(crate) enum Content {
    /// Keys with their values, or values in brackets.
    Struct(Parts),
    Enum(Vec<Variant>),
    /// The kinds of a list such as `panels!`, each a form in its own file.
    Kinds(Vec<Kind>),
}

/// The contents of a value's brackets.
pub(crate) enum Parts {
    Nothing,
    Keys(Vec<Key>),
    Values(Vec<Type>),
}

pub(crate) struct Variant {
    pub(crate) name: String,
    pub(crate) doc: String,
    pub(crate) parts: Parts,
    pub(crate) is_default: bool,
}

pub(crate) struct Key {
    pub(crate) name: String,
    pub(crate) doc: String,
    pub(crate) value: Type,
    pub(crate) default: Default,
}

/// The value of a key that is omitted.
#[derive(Debug, PartialEq)]
pub(crate) enum Default {
    /// The key is required.
    Required,
    /// The default of its type.
    OfType,
    /// The result of a function.
    Function(String),
}

pub(crate) struct Kind {
    pub(crate) name: String,
    /// The module path of its form.
    pub(crate) module: String,
}

/// The forms of a crate by module path (`panels::glyphs`) and name.
pub(crate) struct Forms(BTreeMap<(String, String), Form>);

impl Forms {
    /// The forms of the crate `experiments`.
    pub(crate) fn of_experiments() -> Self {
        let mut forms = Self(BTreeMap::new());
        forms.read(&root().join("crates/experiments/src"), "");
        forms
    }

    fn read(&mut self, folder: &Path, module: &str) {
        for entry in std::fs::read_dir(folder).expect("a readable folder").flatten() {
            let path = entry.path();
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            let inner = if module.is_empty() { name.clone() } else { format!("{module}::{name}") };
            if path.is_dir() {
                self.read(&path, &inner);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let module = if name == "mod" || name == "lib" { module } else { &inner };
                let text = std::fs::read_to_string(&path).expect("UTF-8 source");
                for item in syn::parse_file(&text).expect("Rust source").items {
                    self.add(module, item);
                }
            }
        }
    }

    fn add(&mut self, module: &str, item: Item) {
        let (name, attributes, content) = match item {
            Item::Struct(s) if is_read(&s.attrs) => (s.ident, s.attrs, Content::Struct(parts(s.fields))),
            Item::Enum(e) if is_read(&e.attrs) => {
                let variants = e.variants.into_iter().map(|v| Variant {
                    name: v.ident.to_string(),
                    doc: doc(&v.attrs),
                    is_default: v.attrs.iter().any(|a| a.path().is_ident("default")),
                    parts: parts(v.fields),
                });
                (e.ident, e.attrs, Content::Enum(variants.collect()))
            }
            Item::Macro(list) => {
                let name = match list.mac.path.get_ident().map(ToString::to_string).as_deref() {
                    Some("runs") => "Run",
                    Some("panels") => "Panel",
                    Some("quantities") => "Quantity",
                    Some("tables") => "TableRows",
                    _ => return,
                };
                let content = Content::Kinds(kinds(module, list.mac.tokens.into_iter().collect()));
                let form = Form { doc: String::new(), content };
                self.0.insert((module.to_owned(), name.to_owned()), form);
                return;
            }
            _ => return,
        };
        let form = Form { doc: doc(&attributes), content };
        self.0.insert((module.to_owned(), name.to_string()), form);
    }

    /// The form that `name` refers to in `module`, with its own module: one defined there, or the only one of that name
    /// elsewhere.
    pub(crate) fn get(&self, module: &str, name: &str) -> Option<(&str, &Form)> {
        let own = self.0.get_key_value(&(module.to_owned(), name.to_owned()));
        let found = own.or_else(|| {
            let mut others = self.0.iter().filter(|((_, n), _)| n == name);
            let first = others.next()?;
            assert!(
                others.next().is_none(),
                "several types are called {name}: which one does {module} mean?"
            );
            Some(first)
        });
        found.map(|((module, _), form)| (module.as_str(), form))
    }
}

/// Whether a type derives `Deserialize` from its fields, not from another type.
fn is_read(attributes: &[Attribute]) -> bool {
    let says = |attribute: &Attribute, list: &str, word: &str| match &attribute.meta {
        Meta::List(l) => l.path.is_ident(list) && l.tokens.to_string().contains(word),
        _ => false,
    };
    attributes.iter().any(|a| says(a, "derive", "Deserialize"))
        && !attributes.iter().any(|a| says(a, "serde", "try_from"))
}

/// The documentation as one paragraph of Markdown: links between types become code.
fn doc(attributes: &[Attribute]) -> String {
    let mut lines = Vec::new();
    for attribute in attributes.iter().filter(|a| a.path().is_ident("doc")) {
        if let Meta::NameValue(pair) = &attribute.meta
            && let Expr::Lit(literal) = &pair.value
            && let Lit::Str(text) = &literal.lit
        {
            lines.push(text.value().trim().to_owned());
        }
    }
    lines.retain(|line| !line.is_empty());
    let text = lines.join(" ");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some((before, linked)) = rest.split_once("[`") {
        let Some((code, after)) = linked.split_once("`]") else { break };
        out += &format!("{before}`{code}`");
        rest = match after.strip_prefix('(').and_then(|target| target.split_once(')')) {
            Some((_, behind)) => behind,
            None => after,
        };
    }
    out + rest
}

fn parts(fields: Fields) -> Parts {
    match fields {
        Fields::Unit => Parts::Nothing,
        Fields::Unnamed(values) => Parts::Values(values.unnamed.into_iter().map(|f| f.ty).collect()),
        Fields::Named(fields) => {
            let key = |f: syn::Field| Key {
                name: f.ident.as_ref().expect("a name").to_string(),
                doc: doc(&f.attrs),
                default: default_of(&f.attrs),
                value: f.ty,
            };
            Parts::Keys(fields.named.into_iter().map(key).collect())
        }
    }
}

fn default_of(attributes: &[Attribute]) -> Default {
    for attribute in attributes.iter().filter(|a| a.path().is_ident("serde")) {
        let metas = attribute.parse_args_with(Punctuated::<Meta, syn::Token![,]>::parse_terminated);
        for meta in metas.expect("a list") {
            match meta {
                Meta::Path(path) if path.is_ident("default") => return Default::OfType,
                Meta::NameValue(pair) if pair.path.is_ident("default") => {
                    let Expr::Lit(literal) = &pair.value else { panic!("a name of a function") };
                    let Lit::Str(name) = &literal.lit else { panic!("a name of a function") };
                    return Default::Function(name.value());
                }
                _ => {}
            }
        }
    }
    Default::Required
}

/// The kinds in a list such as `module::Kind, module::{Kind, Kind}`; attributes are skipped.
fn kinds(parent: &str, tokens: Vec<TokenTree>) -> Vec<Kind> {
    let mut found = Vec::new();
    let (mut module, mut names_follow) = (String::new(), false);
    for token in tokens {
        match token {
            TokenTree::Ident(word) if names_follow => found.push((module.clone(), word.to_string())),
            TokenTree::Ident(word) => module = word.to_string(),
            TokenTree::Punct(mark) if mark.as_char() == ':' => names_follow = true,
            TokenTree::Punct(mark) if mark.as_char() == ',' => names_follow = false,
            TokenTree::Group(group) if names_follow => {
                let names = group.stream().into_iter().filter_map(|t| match t {
                    TokenTree::Ident(word) => Some(word.to_string()),
                    _ => None,
                });
                found.extend(names.map(|name| (module.clone(), name)));
            }
            _ => {}
        }
    }
    found.into_iter().map(|(module, name)| Kind { name, module: format!("{parent}::{module}") }).collect()
}

/// The name of a type and its arguments.
pub(crate) fn path_of(ty: &Type) -> (String, Vec<&Type>) {
    let Type::Path(path) = ty else { panic!("a type with a name") };
    let last = path.path.segments.last().expect("a name");
    let arguments = match &last.arguments {
        PathArguments::AngleBracketed(list) => list
            .args
            .iter()
            .filter_map(|a| match a {
                GenericArgument::Type(ty) => Some(ty),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    };
    (last.ident.to_string(), arguments)
}
