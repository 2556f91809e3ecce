//! Degenerate points: the major axis turns by index * 360 degrees on a loop around them.

use crate::{at, field, major_deg};
use tigereye_core::{Field, Tensor2};

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

#[test]
fn singular_points_have_their_index() {
    for (spec, expected) in [
        ("wedge", 0.5),
        ("trisector", -0.5),
        ("star", 1.0),
        ("inverse", -1.0),
        ("rings", 1.0),
        ("spiral", 1.0),
        ("y", 0.0),
    ] {
        for reach in [10, 20] {
            let found = index(&field(spec), reach);
            assert!((found - expected).abs() < 1e-9, "{spec}: index {found}, expected {expected}");
        }
    }
}

#[test]
fn degenerate_points_are_degenerate_and_positive() {
    for name in ["wedge", "trisector"] {
        let f = field(&format!("{name}:size=21,mean=1.5"));
        assert_eq!(at(&f, 10, 10), Tensor2::isotropic(1.5));
        assert_eq!(at(&f, 20, 10), Tensor2::symmetric(2.5, 0.0, 0.5));
        assert!(f.values().iter().all(|t| t.determinant() > 0.0 && (t.trace() - 3.0).abs() < 1e-15));
        let isotropic = f.values().iter().filter(|t| t.xy() == 0.0 && t.xx() == t.yy()).count();
        assert_eq!(isotropic, 1);
    }
    assert_eq!(at(&field("wedge:size=21"), 10, 0).xy(), 1.0);
    assert_eq!(at(&field("trisector:size=21"), 10, 0).xy(), -1.0);
}
