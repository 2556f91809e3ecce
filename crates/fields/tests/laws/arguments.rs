//! Names, values and errors of generators' arguments.

use crate::field;
use proptest::prelude::*;
use tigereye_fields::{Arguments, FieldError, ParameterKind, find, generate, generators, parse_spec};

/// Names that commands, experiments and readers rely on. A new generator need not stand here.
const LASTING: &str = "absorb bow cantilever cone corner cross_x diag_drain double_gyre drain drain_alt drain_old flamant \
    gyre helix inverse isotropic kirsch point_load random rings sink spiral star step trisector v wedge x y";

#[test]
fn names_are_kept() {
    for name in LASTING.split(' ') {
        assert!(find(name).is_some(), "{name}");
    }
}

#[test]
fn every_generator_is_described() {
    for g in generators() {
        for (key, text) in [("summary", g.summary), ("source", g.source)] {
            assert!(
                !text.is_empty(),
                "generator `{0}`: say its `{key}` in the `GENERATOR` of {0}.rs",
                g.name
            );
        }
        let mut names: Vec<&str> = g.parameters().map(|p| p.name).collect();
        assert_eq!(names[..3], ["size", "width", "height"]);
        names.sort_unstable();
        assert!(names.windows(2).all(|w| w[0] != w[1]), "{}: a parameter twice", g.name);
        for p in g.parameters() {
            assert!(!p.help.is_empty(), "{0}.rs: parameter `{1}` needs its `help`", g.name, p.name);
            assert_eq!(p.kind.parse(&p.default_text()), Some(p.default), "{}.{}: default", g.name, p.name);
        }
    }
}

#[test]
fn every_parameter_reaches_the_ends_of_its_range() {
    for g in generators() {
        for p in g.own_parameters {
            let values: Vec<String> = match p.kind {
                // The largest numbers of steps and points only cost time.
                ParameterKind::Integer { min, max } => vec![min.to_string(), max.min(1000).to_string()],
                ParameterKind::Real { min, max } => vec![min.to_string(), max.to_string()],
                ParameterKind::Flag => vec!["true".into(), "false".into()],
                ParameterKind::Choice(words) => words.iter().map(|w| (*w).to_owned()).collect(),
            };
            for value in values {
                let f = field(&format!("{}:size=5,{}={value}", g.name, p.name));
                assert_eq!(f.first_non_finite(), None, "{}: {}={value}", g.name, p.name);
            }
        }
    }
}

#[test]
fn sides_default_to_size_and_size_to_51() {
    for (spec, width, height) in [
        ("star", 51, 51),
        ("star:size=13", 13, 13),
        ("star:width=13", 13, 51),
        ("star:size=7,height=9", 7, 9),
        ("star:height=9,width=2,size=7", 2, 9),
    ] {
        let grid = field(spec).grid();
        assert_eq!((grid.width(), grid.height()), (width, height), "{spec}");
    }
}

#[test]
fn settings_tell_what_was_resolved() {
    let arguments = Arguments::new().with("size", 7).with("total", true);
    let settings = find("rings").expect("rings").resolve(&arguments).expect("settings");
    let texts: Vec<String> =
        settings.iter().map(|(p, v)| format!("{}={}", p.name, p.kind.format(v))).collect();
    assert_eq!(texts.join(","), "size=7,width=7,height=7,anisotropy=10,total=true");
    assert_eq!(settings.value("anisotropy"), Some(10.0));
    assert_eq!(settings.value("nonsense"), None);
}

#[test]
fn specifications_are_read_and_written_alike() {
    for text in ["inverse", "inverse:size=51,anisotropy=4", "a:b=c"] {
        assert_eq!(parse_spec(text).expect("a specification").to_string(), text);
    }
    let loose = parse_spec(" inverse : size = 51 , anisotropy=4 ").expect("a specification");
    assert_eq!(loose.to_string(), "inverse:size=51,anisotropy=4");
}

/// The message of what is wrong with a specification.
fn message(spec: &str) -> String {
    let result = parse_spec(spec).and_then(|s| generate(&s.name, &s.arguments));
    result.expect_err(spec).to_string()
}

#[test]
fn errors_say_what_was_expected() {
    for (spec, expected) in [
        ("invers", "there is no field `invers`, did you mean `inverse`?"),
        ("qqq", "there is no field `qqq`"),
        (
            "rings:totl=true",
            "field `rings` has no parameter `totl`: expected size, width, height, anisotropy, total",
        ),
        (
            "rings:anisotropy=thick",
            "parameter `anisotropy` of field `rings` is `thick`: expected a number from 1 to 1000000",
        ),
        (
            "rings:anisotropy=0.5",
            "parameter `anisotropy` of field `rings` is `0.5`: expected a number from 1 to 1000000",
        ),
        ("rings:size=0", "parameter `size` of field `rings` is `0`: expected an integer from 1 to 4096"),
        (
            "rings:size=5000",
            "parameter `size` of field `rings` is `5000`: expected an integer from 1 to 4096",
        ),
        ("rings:size=5.5", "parameter `size` of field `rings` is `5.5`: expected an integer from 1 to 4096"),
        ("rings:total=yes", "parameter `total` of field `rings` is `yes`: expected true or false"),
        ("helix:plane=zx", "parameter `plane` of field `helix` is `zx`: expected one of xy, xz, yz"),
        ("x:size=5,size=6", "parameter `size` is given twice"),
        ("x:size", "`size` in `x:size` is not a parameter: expected NAME or NAME:key=value,key=value"),
        ("x:", "`` in `x:` is not a parameter: expected NAME or NAME:key=value,key=value"),
        ("x:size=", "`size=` in `x:size=` is not a parameter: expected NAME or NAME:key=value,key=value"),
        ("", "`` in `` is not a parameter: expected NAME or NAME:key=value,key=value"),
        (":size=5", "`` in `:size=5` is not a parameter: expected NAME or NAME:key=value,key=value"),
    ] {
        assert_eq!(message(spec), expected, "{spec}");
    }
}

#[test]
fn infinities_and_nan_are_refused() {
    for value in ["nan", "NaN", "inf", "-inf", "infinity", "1e999"] {
        for key in ["anisotropy", "size"] {
            let error = generate("star", &Arguments::new().with(key, value)).expect_err(value);
            assert!(matches!(error, FieldError::InvalidValue { .. }), "{key}={value}: {error}");
        }
    }
}

proptest! {
    #[test]
    fn no_specification_panics(text in "\\PC{0,40}") {
        let _ = parse_spec(&text).and_then(|s| generate(&s.name, &s.arguments));
    }

    #[test]
    fn no_value_panics(k in 0..generators().len(), key in 0..14_usize, value in "-?[0-9]{1,3}(\\.[0-9]{1,3})?(e-?[0-9]{1,3})?") {
        let generator = generators()[k];
        let mut arguments = Arguments::new().with("size", 3);
        if let Some(p) = generator.own_parameters.get(key).filter(|p| !["steps", "points"].contains(&p.name)) {
            arguments = arguments.with(p.name, &value);
        }
        if let Ok(field) = generate(generator.name, &arguments) {
            prop_assert_eq!(field.first_non_finite(), None, "{} {:?}", generator.name, arguments);
        }
    }
}
