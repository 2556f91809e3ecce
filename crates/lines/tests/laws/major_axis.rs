//! Which axis is major, by value and by magnitude.

use tigereye_core::{Field, Grid, Point, SplitMix64, Tensor2, Vector};
use tigereye_lines::{
    Axes, Family, Interpolated, LineEnd, LineOptions, Major, Topology, signed_ellipse_tensors, tensor_line,
};

/// Rounding of unit vectors.
const ROUNDING: f64 = 1e-12;

fn same(a: Vector, b: Vector) -> bool {
    a.cross(b).abs() < ROUNDING
}

fn along(t: &Tensor2, Vector { x, y, .. }: Vector) -> f64 {
    x * (t.xx() * x + t.xy() * y) + y * (t.yx() * x + t.yy() * y)
}

/// Tensors of all kinds, from a fixed sequence.
fn tensors() -> impl Iterator<Item = Tensor2> {
    let mut numbers = SplitMix64::new(11);
    let mut random = move || numbers.symmetric_unit();
    (0..500).map(move |i| {
        let (xx, xy, yx, yy) = (random(), random(), random(), random());
        Tensor2::new(xx, xy, if i % 2 == 0 { xy } else { yx }, yy)
    })
}

#[test]
fn symmetric_tensors_have_the_same_order_by_either_axes() {
    for t in tensors().step_by(2) {
        for major in [Major::Value, Major::Magnitude] {
            let [semi, eigen] =
                [Axes::HalfAxes, Axes::Eigenvectors].map(|a| a.by(major).of(&t, 0.0).expect("axes"));
            assert!(same(semi.axes[0], eigen.axes[0]) && same(semi.axes[1], eigen.axes[1]), "{t:?}");
            assert!((semi.contrast - eigen.contrast).abs() < ROUNDING);
            for (s, l) in semi.values.iter().zip(eigen.values) {
                assert!((s - l.abs()).abs() < ROUNDING, "{t:?}");
            }
            let [a, b] = eigen.values;
            assert!(if major == Major::Value { a >= b } else { a.abs() >= b.abs() }, "{t:?}");
        }
    }
}

#[test]
fn semi_axes_by_value_have_the_larger_normal_component_first() {
    for t in tensors() {
        let frame = Axes::HalfAxes.by(Major::Value).of(&t, 0.0).expect("axes");
        let [a, b] = frame.axes.map(|u| along(&t, u));
        assert!((a - b - frame.contrast).abs() < ROUNDING, "{t:?}: {a} {b} {}", frame.contrast);
        // The same two axes as by magnitude, in this order or the other.
        let usual = Axes::HalfAxes.of(&t, 0.0).expect("axes");
        let turned = !same(frame.axes[0], usual.axes[0]);
        assert!(same(frame.axes[usize::from(turned)], usual.axes[0]), "{t:?}");
        assert_eq!(turned, t.trace() < 0.0, "{t:?}");
        assert_eq!(frame.values, if turned { [usual.values[1], usual.values[0]] } else { usual.values });
    }
}

/// Tension and compression of the same size: two axes by value, a circle by magnitude.
#[test]
fn pure_shear_has_axes_by_value_only() {
    let t = Tensor2::symmetric(2.0, 0.0, -2.0);
    for axes in [Axes::HalfAxes, Axes::Eigenvectors] {
        let frame = axes.by(Major::Value).of(&t, 1e-3).expect("axes");
        assert!(same(frame.axes[0], Vector::new(1.0, 0.0)) && frame.contrast == 4.0, "{axes:?}");
        assert_eq!(axes.by(Major::Magnitude).of(&t, 1e-3), None, "{axes:?}");
    }
    // A trisector whose trace changes its sign along a line through the field: by value it has no effect.
    let field = Field::from_fn(Grid::new(21, 21).expect("a size"), |c| {
        let (x, y) = (c.x as f64 - 10.3, 10.2 - c.y as f64);
        Tensor2::symmetric(x + 0.5 * y, -y, -x + 0.5 * y)
    });
    let signed = signed_ellipse_tensors(&field);
    assert_eq!(signed, field);
    for axes in [Axes::HalfAxes, Axes::Eigenvectors] {
        let options = LineOptions::default();
        let by_value = Interpolated::new(&signed).with_axes(axes.by(Major::Value));
        let found = Topology::of(&by_value, &[Family::Major], &options);
        assert_eq!((found.points.len(), found.points[0].half_turns()), (1, -1), "{axes:?}");
        assert_eq!(found.separatrices.len(), 3, "{axes:?}");
        assert!(found.separatrices.iter().all(|s| s.line.ends[1] == LineEnd::Border), "{axes:?}");
    }
    // Minor lines run across the line of zero trace, major ones along it.
    let line = |axes: Axes, major| {
        let between = Interpolated::new(&field).with_axes(axes.by(major));
        let seed = Point::new(14.0, 6.0);
        let line = tensor_line(&between, seed, Family::Minor, &LineOptions::default(), &mut |_| true);
        line.ends
    };
    assert_eq!(line(Axes::HalfAxes, Major::Value), [LineEnd::Border; 2]);
    assert_eq!(line(Axes::Eigenvectors, Major::Value), [LineEnd::Border; 2]);
    // By magnitude the two axes swap there.
    assert!(line(Axes::Eigenvectors, Major::Magnitude).contains(&LineEnd::Degenerate));
    assert!(line(Axes::HalfAxes, Major::Magnitude).contains(&LineEnd::Degenerate));
}

/// The axes are continuous: a slight rotation in the tensor moves them slightly, except where they are degenerate.
#[test]
fn a_little_asymmetry_moves_axes_a_little() {
    for t in tensors().step_by(2) {
        let turned = t + Tensor2::new(0.0, -1e-9, 1e-9, 0.0);
        for ordered in [
            Axes::HalfAxes.by(Major::Value),
            Axes::HalfAxes.by(Major::Magnitude),
            Axes::Eigenvectors.by(Major::Value),
            Axes::Eigenvectors.by(Major::Magnitude),
        ] {
            let Some(frame) = ordered.of(&t, 1e-3) else { continue };
            let other = ordered.of(&turned, 0.0).expect("axes");
            let sine = frame.axes[0].cross(other.axes[0]);
            // A rotation of 1e-9 over the least contrast.
            assert!(sine.abs() < 1e-5, "{ordered:?} {t:?}: {sine}");
        }
    }
}

#[test]
fn dual_eigenvectors_have_one_order() {
    for major in [Major::Value, Major::Magnitude] {
        assert_eq!(Axes::DualEigenvectors.by(major), Axes::DualEigenvectors.into());
    }
}
