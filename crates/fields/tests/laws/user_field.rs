//! Fields defined by formulas.

use crate::{at, field};
use tigereye_core::{Tensor2, math};
use tigereye_fields::{ExpressionErrorKind, ExpressionField, FieldError, Form, MAX_SIDE};

fn axes(width: usize, height: usize, [phi, s1, s2]: [&str; 3]) -> ExpressionField {
    let [phi, s1, s2] = [phi, s1, s2].map(str::to_owned);
    ExpressionField { width, height, form: Form::Axes { phi, s1, s2 } }
}

fn components(width: usize, height: usize, texts: [&str; 4]) -> ExpressionField {
    let [xx, xy, yx, yy] = texts.map(str::to_owned);
    ExpressionField { width, height, form: Form::Components { xx, xy, yx, yy } }
}

#[test]
fn variables_are_the_position() {
    let f = components(5, 3, ["x", "y", "i", "j"]).build().expect("a field");
    assert_eq!(at(&f, 0, 0), Tensor2::new(-1.0, 1.0, 0.0, 0.0));
    assert_eq!(at(&f, 4, 0), Tensor2::new(1.0, 1.0, 4.0, 0.0));
    assert_eq!(at(&f, 3, 2), Tensor2::new(0.5, -1.0, 3.0, 2.0));
    let f = components(5, 3, ["n", "r", "theta", "pi"]).build().expect("a field");
    assert_eq!(at(&f, 4, 0), Tensor2::new(5.0, 2.0_f64.sqrt(), math::FRAC_PI_4, math::PI));
    assert_eq!(at(&f, 0, 1), Tensor2::new(5.0, 1.0, math::PI, math::PI));
}

#[test]
fn a_single_cell_lies_in_the_middle() {
    let f = components(1, 1, ["x", "y", "r", "theta"]).build().expect("a field");
    assert_eq!(at(&f, 0, 0), Tensor2::ZERO);
}

#[test]
fn formulas_can_rebuild_generators() {
    let wedge = components(21, 21, ["2 + x", "y", "y", "2 - x"]).build().expect("a field");
    let difference = |a: &Tensor2, b: &Tensor2| (*a + b.scaled(-1.0)).max_abs();
    for (cell, t) in field("wedge:size=21").iter() {
        assert!(difference(t, wedge.at(cell)) < 1e-15);
    }
    let star = axes(13, 13, ["theta", "if(r == 0, 1, sqrt(4))", "if(r == 0, 1, 1/sqrt(4))"]);
    let star = star.build().expect("a field");
    for (cell, t) in field("star:size=13,anisotropy=4").iter() {
        assert!(difference(t, star.at(cell)) < 1e-14, "{cell:?}");
    }
}

#[test]
fn errors_name_the_expression_and_the_place() {
    let error = axes(3, 3, ["theta", "1 +\n  foo", "1"]).build().expect_err("unknown name");
    assert_eq!(
        error.to_string(),
        "expression `s1`: line 2, column 3: unknown name `foo`; variables: x, y, i, j, n, r, theta"
    );
    let FieldError::Expression { expression: "s1", error } = error else { panic!("{error}") };
    assert!(matches!(error.kind, ExpressionErrorKind::UnknownName { .. }));

    let error = components(3, 3, ["1", "0", "0", "1/r"]).build().expect_err("infinite");
    assert_eq!(error.to_string(), "expression `yy` = `1/r` is inf in cell (1, 1): expected a finite number");
    let error = axes(3, 3, ["0", "1", "sqrt(y)"]).build().expect_err("NaN below the middle");
    assert!(matches!(error, FieldError::NonFiniteValue { expression: "s2", x: 0, y: 2, .. }), "{error}");
}

#[test]
fn semi_axes_are_lengths() {
    let error = axes(3, 3, ["0", "1", "y"]).build().expect_err("negative");
    assert_eq!(
        error.to_string(),
        "expression `s2` = `y` is -1 in cell (0, 2): a semi-axis has a length of at least 0"
    );
    assert!(axes(3, 3, ["0", "0", "0"]).build().expect("zero tensors").values().iter().all(Tensor2::is_zero));
}

#[test]
fn impossible_sizes_are_refused() {
    for (width, height) in [(0, 3), (3, 0), (MAX_SIDE + 1, 1), (usize::MAX, usize::MAX)] {
        let error = axes(width, height, ["0", "1", "1"]).build().expect_err("a size");
        assert_eq!(error, FieldError::Side { width, height });
    }
}
