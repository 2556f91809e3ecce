//! Within a crate, too, arrows point one way: modules do not import each other in a circle.
//!
//! Every `use`, every path and every path within a macro is followed through re-exports to the module that defines what
//! it names. A child that takes a type of its parent, whose functions call the child, is a circle like any other: the
//! type belongs in a leaf of its own. Unit tests are not counted.

use crate::root;
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, UseTree, Visibility};

/// Where a module lies in its crate: `[]` is the root.
type ModulePath = Vec<String>;

/// What a module says about others.
#[derive(Default)]
struct Module {
    /// Names that it re-exports, with what they stand for.
    exports: BTreeMap<String, Vec<String>>,
    /// Names that it imports for itself and paths in its code, as written.
    uses: Vec<Vec<String>>,
}

/// The modules of a crate by their paths.
#[derive(Default)]
struct Crate(BTreeMap<ModulePath, Module>);

impl Crate {
    /// Reads the sources below `folder`, the `src` of a crate.
    fn read(folder: &Path) -> Self {
        let mut found = Self::default();
        for file in sources(folder) {
            let relative = file.strip_prefix(folder).expect("inside").with_extension("");
            let mut path: ModulePath = relative.iter().map(|p| p.to_string_lossy().into_owned()).collect();
            if path.last().is_some_and(|last| last == "mod")
                || matches!(&path[..], [root] if root == "lib" || root == "main")
            {
                path.pop();
            }
            if path.last().is_some_and(|last| last == "tests") {
                continue;
            }
            let text = std::fs::read_to_string(&file).expect("UTF-8 source");
            found.add(path, &syn::parse_file(&text).expect("Rust source").items);
        }
        found
    }

    fn add(&mut self, path: ModulePath, items: &[Item]) {
        let mut module = self.0.remove(&path).unwrap_or_default();
        for item in items {
            match item {
                Item::Mod(inner) => {
                    if let Some((_, items)) = inner.content.as_ref().filter(|_| !is_test(&inner.attrs)) {
                        self.add([&path[..], &[inner.ident.to_string()]].concat(), items);
                    }
                }
                Item::Use(import) if !is_test(&import.attrs) => {
                    let mut names = Vec::new();
                    spread(&import.tree, &mut Vec::new(), &mut names);
                    if matches!(import.vis, Visibility::Inherited) {
                        module.uses.extend(names.into_iter().map(|(_, path)| path));
                    } else {
                        module.exports.extend(names);
                    }
                }
                item => Paths(&mut module.uses).visit_item(item),
            }
        }
        self.0.insert(path, module);
    }

    /// The path from the crate's root that `path` stands for in `module`; none for other crates and names of its own.
    fn absolute(&self, module: &ModulePath, path: &[String]) -> Option<Vec<String>> {
        let mut base = module.clone();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => (base, rest) = (Vec::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {
                while let [first, after @ ..] = rest
                    && first == "super"
                {
                    base.pop();
                    rest = after;
                }
            }
            child if self.0.contains_key(&[&module[..], &[child.to_owned()]].concat()) => {}
            _ => return None,
        }
        base.extend(rest.iter().filter(|s| *s != "self").cloned());
        Some(base)
    }

    /// The module that defines what `path`, from the crate's root, names.
    fn home(&self, path: &[String], depth: usize) -> ModulePath {
        let mut module = ModulePath::new();
        for (i, segment) in path.iter().enumerate() {
            let child = [&module[..], std::slice::from_ref(segment)].concat();
            if self.0.contains_key(&child) {
                module = child;
                continue;
            }
            let meant = self.0.get(&module).and_then(|m| m.exports.get(segment));
            if let Some(meant) = meant.and_then(|m| self.absolute(&module, m)).filter(|_| depth < 20) {
                return self.home(&[&meant[..], &path[i + 1..]].concat(), depth + 1);
            }
            break;
        }
        module
    }

    /// Who imports whom, and by which path.
    fn arrows(&self) -> BTreeMap<&ModulePath, BTreeMap<ModulePath, String>> {
        let of = |path, module: &Module| {
            let targets = module.uses.iter().filter_map(|used| {
                let home = self.home(&self.absolute(path, used)?, 0);
                (home != *path).then(|| (home, used.join("::")))
            });
            targets.collect()
        };
        self.0.iter().map(|(path, module)| (path, of(path, module))).collect()
    }

    /// The modules that `from` uses, and those that these use.
    fn below(&self, from: &ModulePath) -> BTreeSet<ModulePath> {
        let arrows = self.arrows();
        let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(module) = open.pop() {
            for next in arrows.get(&module).into_iter().flat_map(BTreeMap::keys) {
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        seen
    }

    /// Arrows that lead back to where they came from, a line each: they lie on circles.
    fn circles(&self) -> Vec<String> {
        let arrows = self.arrows();
        let below: BTreeMap<&ModulePath, BTreeSet<ModulePath>> =
            arrows.keys().map(|module| (*module, self.below(module))).collect();
        let reaches = |from: &ModulePath, to: &ModulePath| below.get(from).is_some_and(|b| b.contains(to));
        let mut found = Vec::new();
        for (from, targets) in &arrows {
            for (to, used) in targets.iter().filter(|(to, _)| reaches(to, from)) {
                found.push(format!("{} -> {} ({used})", name(from), name(to)));
            }
        }
        found
    }
}

fn name(path: &ModulePath) -> String {
    if path.is_empty() { "the root".to_owned() } else { path.join("::") }
}

/// All `.rs` files below `folder`.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a readable folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Whether `attributes` say `#[cfg(test)]`.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes
        .iter()
        .any(|a| matches!(&a.meta, Meta::List(l) if l.path.is_ident("cfg") && l.tokens.to_string() == "test"))
}

/// The names that `tree` brings, each with its path; a glob brings the path of its module.
fn spread(tree: &UseTree, above: &mut Vec<String>, names: &mut Vec<(String, Vec<String>)>) {
    let with = |above: &[String], last: &syn::Ident| [above, &[last.to_string()]].concat();
    match tree {
        UseTree::Path(path) => {
            above.push(path.ident.to_string());
            spread(&path.tree, above, names);
            above.pop();
        }
        UseTree::Name(leaf) if leaf.ident == "self" => {
            names.push((above.last().cloned().unwrap_or_default(), above.clone()));
        }
        UseTree::Name(leaf) => names.push((leaf.ident.to_string(), with(above, &leaf.ident))),
        UseTree::Rename(leaf) => names.push((leaf.rename.to_string(), with(above, &leaf.ident))),
        UseTree::Glob(_) => names.push(("*".to_owned(), above.clone())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| spread(tree, above, names)),
    }
}

/// Collects the paths of code that have more than one segment.
struct Paths<'a>(&'a mut Vec<Vec<String>>);

impl Visit<'_> for Paths<'_> {
    fn visit_path(&mut self, path: &syn::Path) {
        if path.leading_colon.is_none() && path.segments.len() > 1 {
            self.0.push(path.segments.iter().map(|s| s.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_item_mod(&mut self, inner: &syn::ItemMod) {
        if !is_test(&inner.attrs) {
            visit::visit_item_mod(self, inner);
        }
    }

    fn visit_item_use(&mut self, import: &syn::ItemUse) {
        let mut names = Vec::new();
        spread(&import.tree, &mut Vec::new(), &mut names);
        self.0.extend(names.into_iter().map(|(_, path)| path));
    }

    // `pub(super)` and `pub(in …)` say who may look in, not what is used.
    fn visit_visibility(&mut self, _: &Visibility) {}

    fn visit_macro(&mut self, call: &syn::Macro) {
        visit::visit_macro(self, call);
        from_tokens(call.tokens.clone(), self.0);
    }
}

/// The paths among the tokens of a macro.
fn from_tokens(tokens: TokenStream, paths: &mut Vec<Vec<String>>) {
    let mut path: Vec<String> = Vec::new();
    let mut colons = 0;
    let mut end = |path: &mut Vec<String>| {
        let whole = std::mem::take(path);
        if whole.len() > 1 {
            paths.push(whole);
        }
    };
    let mut groups = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(word) => {
                if colons != 2 {
                    end(&mut path);
                }
                path.push(word.to_string());
                colons = 0;
            }
            TokenTree::Punct(mark) if mark.as_char() == ':' && colons < 2 => colons += 1,
            other => {
                end(&mut path);
                colons = 0;
                if let TokenTree::Group(group) = other {
                    groups.push(group.stream());
                }
            }
        }
    }
    end(&mut path);
    for group in groups {
        from_tokens(group, paths);
    }
}

#[test]
fn modules_do_not_import_each_other_in_a_circle() {
    let crates = root().join("crates");
    let mut found = Vec::new();
    let mut modules = 0;
    for entry in std::fs::read_dir(crates).expect("the crates").flatten() {
        let read = Crate::read(&entry.path().join("src"));
        modules += read.0.len();
        let name = entry.file_name().to_string_lossy().into_owned();
        found.extend(read.circles().into_iter().map(|arrow| format!("crates/{name}: {arrow}")));
    }
    assert!(modules > 100, "only {modules} modules were read");
    assert!(found.is_empty(), "arrows on circles, to be broken by a leaf:\n{}\n", found.join("\n"));
}

/// Modules of the faster engines that the readable scheme must not use, and that must not use it.
const FASTER: [&str; 8] =
    ["kernel", "linear", "reduced", "scattering", "sectors", "pulses", "real", "window"];

#[test]
fn the_oracle_shares_nothing_with_the_engines_it_judges() {
    let crates = root().join("crates");
    let transport = Crate::read(&crates.join("transport/src"));
    let oracle: ModulePath = vec!["oracle".to_owned()];
    assert!(transport.0.contains_key(&oracle));
    let shared: Vec<String> = transport
        .below(&oracle)
        .iter()
        .filter(|m| FASTER.contains(&m.first().map_or("", String::as_str)))
        .map(name)
        .collect();
    assert!(shared.is_empty(), "the oracle uses {}", shared.join(", "));
    let text = std::fs::read_to_string(crates.join("transport/src/oracle.rs")).expect("the oracle");
    assert!(!text.contains("tigereye_simd"), "the oracle uses vectors");
    for module in FASTER {
        let module: ModulePath = vec![module.to_owned()];
        assert!(transport.0.contains_key(&module), "no module {}", name(&module));
        assert!(!transport.below(&module).contains(&oracle), "{} uses the oracle", name(&module));
    }
}

/// The crate of the given modules, with their texts.
fn made_of(modules: &[(&str, &str)]) -> Crate {
    let mut made = Crate::default();
    for (path, text) in modules {
        let path = path.split("::").filter(|s| !s.is_empty()).map(str::to_owned).collect();
        made.add(path, &syn::parse_file(text).expect("Rust source").items);
    }
    made
}

#[test]
fn a_child_that_uses_its_parent_is_found() {
    let circle = made_of(&[
        ("", "mod a;"),
        ("a", "mod b; pub struct T; fn f() { b::g(); }"),
        ("a::b", "use super::T; pub fn g(_: T) {}"),
    ]);
    assert_eq!(circle.circles(), ["a -> a::b (b::g)", "a::b -> a (super::T)"]);
}

#[test]
fn re_exports_are_followed_and_tests_are_not() {
    let modules = |t: &str| {
        made_of(&[
            ("", "mod a; pub use a::T;"),
            ("a", "mod b; mod t; pub use t::T; fn f() { b::g(); }"),
            ("a::t", t),
            ("a::b", "use crate::T; pub fn g(_: T) {}"),
        ])
    };
    assert_eq!(
        modules("pub struct T; #[cfg(test)] mod tests { use super::super::b::g; }").circles(),
        [""; 0]
    );
    let circle = modules("pub struct T; fn h() { println!(\"{}\", super::b::g()); }");
    assert_eq!(circle.circles(), ["a::b -> a::t (crate::T)", "a::t -> a::b (super::b::g)"]);
}
