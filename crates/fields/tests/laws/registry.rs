//! A generator is one file and one line: messages name what is missing and how to add it.

use std::collections::BTreeMap;
use std::path::Path;
use tigereye_fields::generators;

const FOLDER: &str = "crates/fields/src/generators";
/// Texts of source files by their names without extension.
type Sources = BTreeMap<String, String>;

/// The sources of a folder of this crate.
fn sources(folder: &str) -> Sources {
    let mut found = Sources::new();
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).expect(folder) {
        let path = entry.expect(folder).path();
        if path.extension().is_some_and(|e| e == "rs") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            found.insert(name, std::fs::read_to_string(&path).expect("UTF-8 source"));
        }
    }
    found
}

/// What each file in the folder of generators lacks, a sentence each. `registered` are the names of the generators in
/// the order of their lines.
fn faults_of_files(files: &Sources, registered: &[&str]) -> Vec<String> {
    let mut faults = Vec::new();
    let list = files.get("mod").map_or("", String::as_str);
    for (name, text) in files {
        let path = format!("{FOLDER}/{name}.rs");
        let is_generator = text.contains("const GENERATOR: Generator");
        if !is_generator && name != "mod" && !list.contains(&format!("mod {name};")) {
            faults.push(format!(
                "{path} has no constant `GENERATOR`: begin with a copy of the example in docs/guide/add-a-field.md, \"By one Rust file\""
            ));
        }
        if is_generator && !list.contains(&format!("    {name},\n")) {
            let before = registered.iter().rfind(|r| **r < name.as_str());
            let place = before.map_or("first".to_owned(), |b| format!("after `{b},`"));
            faults.push(format!(
                "{path} is not registered: add the line `{name},` to the list `generators!` in {FOLDER}/mod.rs, {place}"
            ));
        }
        if is_generator
            && !(text.starts_with("//! ") && (text.contains("```text") || text.contains("//! Formula:")))
        {
            faults.push(format!(
                "{path} does not say its formula: begin it with `//! Name: what it shows.` and a ```text block with a sketch \
                 and the formula, as in {FOLDER}/drain.rs"
            ));
        }
    }
    faults
}

/// What the generators' own names lack, a sentence each.
fn faults_of_names(files: &Sources, registered: &[&str]) -> Vec<String> {
    let mut faults = Vec::new();
    for name in registered.iter().filter(|n| !files.contains_key(**n)) {
        faults.push(format!(
            "the generator `{name}` has no file {FOLDER}/{name}.rs: give the `name` in its `GENERATOR` the name of its file"
        ));
    }
    for pair in registered.windows(2).filter(|pair| pair[0] >= pair[1]) {
        faults.push(format!(
            "`{}` must not stand after `{}`, because names are searched in alphabetical order: move its line in the list \
             `generators!` of {FOLDER}/mod.rs up",
            pair[1], pair[0]
        ));
    }
    faults
}

#[test]
fn generators_are_registered_and_described() {
    let registered: Vec<&str> = generators().iter().map(|g| g.name).collect();
    let files = sources("src/generators");
    let mut faults = faults_of_files(&files, &registered);
    faults.extend(faults_of_names(&files, &registered));
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

const COMPLETE: &str =
    "//! Fan: lines that lean.\n//! ```text\n//! \\|/\n//! ```\npub(crate) const GENERATOR: Generator = ";

fn made_up(files: &[(&str, &str)]) -> Sources {
    files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
}

/// The only fault contains all of `words`.
#[track_caller]
fn one_fault(faults: &[String], words: &[&str]) {
    let [fault] = faults else { panic!("expected one fault, found {faults:#?}") };
    for word in words {
        assert!(fault.contains(word), "`{fault}` does not say `{word}`");
    }
}

#[test]
fn a_complete_generator_lacks_nothing() {
    let list = "mod curve;\ngenerators! {\n    fan,\n}\n";
    let files = made_up(&[("fan", COMPLETE), ("curve", "//! Help."), ("mod", list)]);
    assert_eq!(faults_of_files(&files, &["fan"]), [""; 0]);
    assert_eq!(faults_of_names(&files, &["fan"]), [""; 0]);
}

#[test]
fn unregistered_files_name_the_missing_line() {
    let list = "generators! {\n    drain,\n    gyre,\n}\n";
    let files = made_up(&[("drain", COMPLETE), ("gyre", COMPLETE), ("fan", COMPLETE), ("mod", list)]);
    let faults = faults_of_files(&files, &["drain", "gyre"]);
    one_fault(
        &faults,
        &["generators/fan.rs is not registered", "`fan,`", "generators/mod.rs", "after `drain,`"],
    );
    let files = made_up(&[("fan", COMPLETE), ("mod", "generators! {\n}\n")]);
    one_fault(&faults_of_files(&files, &[]), &["`fan,`", "mod.rs, first"]);
}

#[test]
fn files_without_a_generator_name_an_example() {
    let files = made_up(&[("fan", "//! Fan.\n"), ("mod", "")]);
    one_fault(
        &faults_of_files(&files, &[]),
        &["generators/fan.rs has no constant `GENERATOR`", "docs/guide/add-a-field.md"],
    );
}

#[test]
fn missing_formulas_name_their_file() {
    let files = made_up(&[("fan", "//! Fan.\nconst GENERATOR: Generator"), ("mod", "    fan,\n")]);
    one_fault(&faults_of_files(&files, &["fan"]), &["generators/fan.rs", "formula", "```text", "drain.rs"]);
}

#[test]
fn a_name_unlike_its_file_is_reported() {
    let files = made_up(&[("fan", COMPLETE), ("mod", "    fan,\n")]);
    one_fault(&faults_of_names(&files, &["fen"]), &["`fen` has no file", "generators/fen.rs", "`name`"]);
}

#[test]
fn lines_out_of_order_name_the_one_to_move() {
    let files = made_up(&[("fan", COMPLETE), ("gyre", COMPLETE)]);
    one_fault(&faults_of_names(&files, &["gyre", "fan"]), &["`fan` must not stand after `gyre`", "mod.rs"]);
}
