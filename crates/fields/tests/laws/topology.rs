//! Degenerate points.

use crate::{at, field};
use tigereye_core::Tensor2;

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
