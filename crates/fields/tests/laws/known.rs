//! The known answers and the facts that the generators declare.

use crate::{at, axis_difference, field, major_deg, same_ellipse};
use tigereye_core::{Cell, Field, Tensor2};
use tigereye_fields::{Known, Mirror, generators};

/// Largest difference of `A A^T`, which determines the ellipse; fields are of the order of one.
const SAME: f64 = 1e-11;

/// Largest error of directions (degrees), of numbers of turns, and of components relative to the tensor's largest.
const ROUNDING: f64 = 1e-9;

fn image(f: &Field<Tensor2>, mirror: Mirror) -> Field<Tensor2> {
    match mirror {
        Mirror::LeftRight => f.mirrored_x(),
        Mirror::UpDown => f.mirrored_y(),
        Mirror::QuarterTurn => f.quarter_turned(),
        Mirror::HalfTurn => f.quarter_turned().quarter_turned(),
    }
}

/// Why a field is not its own image; `None` if it is.
fn unlike(f: &Field<Tensor2>, mirror: Mirror) -> Option<String> {
    let image = image(f, mirror);
    if image.grid() != f.grid() {
        return Some(format!("{mirror:?} makes another size"));
    }
    let odd = f.iter().find(|(c, t)| !same_ellipse(t, image.at(*c), SAME));
    odd.map(|(c, t)| format!("{mirror:?} makes {:?} of {t:?} at ({}, {})", image.at(c), c.x, c.y))
}

/// Turns of the major axis along the boundary of the square of half side `reach` about the centre, counter-clockwise.
fn index(f: &Field<Tensor2>, reach: usize) -> f64 {
    let c = f.grid().centre();
    let side = 2 * reach;
    let (left, right, top, bottom) = (c.x - reach, c.x + reach, c.y - reach, c.y + reach);
    let mut rim = Vec::new();
    rim.extend((0..side).map(|k| (right, bottom - k)));
    rim.extend((0..side).map(|k| (right - k, top)));
    rim.extend((0..side).map(|k| (left, top + k)));
    rim.extend((0..side).map(|k| (left + k, bottom)));
    let angles: Vec<f64> = rim.iter().map(|&(x, y)| major_deg(&at(f, x, y))).collect();
    let turned: f64 = (0..angles.len())
        .map(|k| (angles[(k + 1) % angles.len()] - angles[k] + 90.0).rem_euclid(180.0) - 90.0)
        .sum();
    turned / 360.0
}

/// Why a known answer does not hold; `None` if it does.
fn contradiction(f: &Field<Tensor2>, known: &Known) -> Option<String> {
    match *known {
        Known::Symmetries(_, mirrors) => mirrors.iter().find_map(|&mirror| unlike(f, mirror)),
        Known::MajorAxis(_, [x, y], degrees) => {
            let found = major_deg(&at(f, x, y));
            let off = axis_difference(found, degrees) >= ROUNDING;
            off.then(|| format!("the axis points to {found} degrees"))
        }
        Known::Tensor(_, [x, y], expected) => {
            let found = at(f, x, y);
            let off = (found + expected.scaled(-1.0)).max_abs() > ROUNDING * expected.max_abs();
            off.then(|| format!("the tensor is {found:?}"))
        }
        Known::Circles(_, expected) => {
            let found = f.values().iter().filter(|t| same_ellipse(t, &Tensor2::IDENTITY, 1e-12)).count();
            (found != expected).then(|| format!("there are {found} of them"))
        }
        Known::Index(_, expected) => [10, 20].iter().find_map(|&reach| {
            let found = index(f, reach);
            let off = (found - expected).abs() >= ROUNDING;
            off.then(|| format!("{found} turns on the loop {reach} cells away"))
        }),
    }
}

/// The entries of a generator's `known` that do not hold, one sentence each, or that it has none.
fn faults_of(name: &str, known: &[Known]) -> Vec<String> {
    let place = format!("in the `GENERATOR` of crates/fields/src/generators/{name}.rs");
    if known.is_empty() {
        return vec![format!(
            "the generator `{name}` has no known answer: add one, such as `Known::Symmetries(\"\", \
             &[Mirror::LeftRight])` or `Known::MajorAxis(\"size=13\", [0, 6], 90.0)`, to `known` {place}"
        )];
    }
    let fault = |answer: &Known| {
        let spec = match answer.arguments() {
            "" => name.to_owned(),
            arguments => format!("{name}:{arguments}"),
        };
        let why = contradiction(&field(&spec), answer)?;
        Some(format!("`{answer:?}` does not hold: {why}; mend it or the formula, {place}"))
    };
    known.iter().filter_map(fault).collect()
}

#[test]
fn known_answers_hold() {
    let faults: Vec<String> = generators().iter().flat_map(|g| faults_of(g.name, g.known)).collect();
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn wrong_answers_are_reported_with_what_is_found() {
    let wrong = [
        (Known::Symmetries("", &[Mirror::LeftRight, Mirror::UpDown]), "UpDown makes"),
        (Known::MajorAxis("size=41", [0, 0], 45.0), "the axis points to 135"),
        (Known::Tensor("", [0, 0], Tensor2::IDENTITY), "the tensor is"),
        (Known::Circles("", 7), "there are "),
        (Known::Index("size=41", 2.0), " turns on the loop 10 cells away"),
    ];
    for (known, words) in wrong {
        let told = faults_of("drain", &[known]);
        let [told] = &told[..] else { panic!("{known:?}: {told:?}") };
        assert!(told.contains(words) && told.contains("generators/drain.rs"), "{told}");
    }
    let told = faults_of("fan", &[]);
    assert!(
        told[0].contains("`fan` has no known answer") && told[0].contains("generators/fan.rs"),
        "{told:?}"
    );
}

/// The correction of a generator's facts about its fields, if they are wrong.
fn undeclared(name: &str, key: &str, declared: bool, odd: Option<(Cell, f64)>) -> Option<String> {
    let place = format!("in the `GENERATOR` of crates/fields/src/generators/{name}.rs");
    match odd {
        Some((c, x)) if declared => Some(format!(
            "the tensor of `{name}:size=31` at cell ({}, {}) has {x:.3e} for the fact `{key}`: write `{key}: false` {place}, or \
             mend its formula",
            c.x, c.y
        )),
        None if !declared => Some(format!(
            "all tensors of `{name}:size=31` have the fact `{key}`: write `{key}: true` {place}"
        )),
        _ => None,
    }
}

#[test]
fn declared_facts_hold() {
    let mut faults = Vec::new();
    for g in generators() {
        let f = field(&format!("{}:size=31", g.name));
        let odd = |x: fn(&Tensor2) -> f64, fits: fn(&Tensor2) -> bool| {
            f.iter().find(|(_, t)| !fits(t)).map(|(c, t)| (c, x(t)))
        };
        let one = odd(Tensor2::determinant, |t| (t.determinant() - 1.0).abs() < 1e-12);
        faults.extend(undeclared(g.name, "determinant_one", g.determinant_one, one));
        let symmetric = odd(Tensor2::asymmetry, |t| t.asymmetry() < 1e-14 * t.max_abs().max(1e-300));
        faults.extend(undeclared(g.name, "symmetric", g.symmetric, symmetric));
    }
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn a_wrong_fact_is_reported_with_the_right_one() {
    let at = Some((Cell::new(3, 4), 1.5));
    assert_eq!(undeclared("made_up", "symmetric", true, None), None);
    assert_eq!(undeclared("made_up", "symmetric", false, at), None);
    let told = undeclared("made_up", "determinant_one", true, at).expect("a fault");
    for words in
        ["`made_up:size=31` at cell (3, 4) has 1.500e0", "`determinant_one: false`", "generators/made_up.rs"]
    {
        assert!(told.contains(words), "{told}");
    }
    let told = undeclared("made_up", "symmetric", false, None).expect("a fault");
    assert!(told.contains("`symmetric: true`") && told.contains("generators/made_up.rs"), "{told}");
}
