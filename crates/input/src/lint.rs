//! What is odd about a tensor field, before light runs through it.

use tigereye_core::{Cell, Eigenvalues, Field, Svd, Symmetry, Tensor2, is_totally_anisotropic};
use tigereye_lines::ellipse_tensors;

/// Something that may be meant so, or not.
#[derive(Clone, Debug, PartialEq)]
pub struct Oddity {
    /// Short name: `not-finite`, `zero`, `total-anisotropy`, `indefinite`, `negative`, `discontinuous`, `determinant`,
    /// `asymmetric`, `isotropic`, `thin`.
    pub kind: &'static str,
    /// What it is and what follows, in a sentence.
    pub words: String,
    /// How many cells it concerns; pairs of neighbours for `discontinuous`.
    pub count: usize,
    /// The first of them, row by row.
    pub first: Option<Cell>,
}

/// Neighbours that differ by more than this part of the larger one, measured by their largest component, ...
const JUMP: f64 = 0.5;
/// ... are a discontinuity where the median of these differences is smaller by this factor.
const ABOVE_MEDIAN: f64 = 4.0;
/// Deviation of a determinant from 1 that is more than rounding of single precision.
const DETERMINANT: f64 = 1e-6;
/// Semi-axes that differ by less than this part are equal.
const ISOTROPIC: f64 = 1e-6;
/// Everything odd, the gravest first. A field without oddities has tensors that are symmetric, positive definite and of
/// determinant 1, and that change smoothly. Signs of eigenvalues are asked of symmetric tensors only.
#[must_use]
pub fn lint(field: &Field<Tensor2>) -> Vec<Oddity> {
    let cells = field.grid().cells();
    let of = |kind, test: &dyn Fn(&Tensor2) -> bool, words: &str| {
        let mut odd = field.iter().filter(|(_, t)| test(t)).map(|(cell, _)| cell);
        let first = odd.next()?;
        let count = 1 + odd.count();
        let share = 100.0 * count as f64 / cells as f64;
        Some(Oddity {
            kind,
            words: format!("{count} of {cells} cells ({share:.1} %) {words}"),
            count,
            first: Some(first),
        })
    };
    let regular = |t: &Tensor2| !t.is_zero() && t.is_finite();
    let isotropic = |t: &Tensor2| {
        let s = Svd::of(t).s;
        s[0] - s[1] <= ISOTROPIC * s[0]
    };
    let symmetry = Symmetry::of(field);
    let symmetric = |t: &Tensor2| symmetry.has_symmetric(t);
    let negative = |t: &Tensor2| Eigenvalues::of(t).negative() == 2;
    let found = [
        of("not-finite", &|t| !t.is_finite(), "are not finite: they cannot transmit light"),
        of("zero", &|t| t.is_zero(), "hold the zero tensor: they absorb all light"),
        of(
            "total-anisotropy",
            &|t| regular(t) && is_totally_anisotropic(t),
            "are totally anisotropic: light along one axis only, the other side absorbs",
        ),
        of(
            "indefinite",
            &|t| regular(t) && symmetric(t) && Eigenvalues::of(t).is_indefinite(),
            "have eigenvalues of both signs: light takes their magnitudes, and the pictures look positive",
        ),
        of(
            "negative",
            &|t| regular(t) && symmetric(t) && negative(t),
            "have negative eigenvalues only: light takes their magnitudes",
        ),
        jumps(field),
        of(
            "determinant",
            &|t| regular(t) && (t.determinant().abs() - 1.0).abs() > DETERMINANT,
            "have a determinant other than 1: with the normalisation `global` weak cells absorb, with `local` all \
             transmit alike",
        ),
        of(
            "asymmetric",
            &|t| regular(t) && !symmetric(t),
            "are not symmetric: light takes the ellipse they make of a circle, whose axes are no eigenvectors",
        ),
        of("isotropic", &|t| regular(t) && isotropic(t), "have no direction: light spreads from them evenly"),
        thin(field),
    ];
    found.into_iter().flatten().collect()
}

/// Neighbours to the right and below that differ much, where most hardly do. Axes have no sign, and neither has a
/// tensor that is a rotation times its axes: ellipses are compared, not components.
fn jumps(field: &Field<Tensor2>) -> Option<Oddity> {
    let grid = field.grid();
    let ellipses = ellipse_tensors(field);
    let ellipse = |cell: Cell| ellipses.at(cell).components();
    let mut pairs = Vec::new();
    for cell in grid.iter() {
        // Directions 0 and 6: to the right and down.
        for neighbour in [grid.neighbour(cell, 0), grid.neighbour(cell, 6)].into_iter().flatten() {
            let (p, q) = (ellipse(cell), ellipse(neighbour));
            let largest = p.iter().chain(&q).fold(0.0, |m: f64, v| m.max(v.abs()));
            let off = p.iter().zip(&q).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            if largest > 0.0 && largest.is_finite() {
                pairs.push((off / largest, cell));
            }
        }
    }
    let mut sizes: Vec<f64> = pairs.iter().map(|p| p.0).collect();
    sizes.sort_by(f64::total_cmp);
    let median = *sizes.get(sizes.len() / 2)?;
    let mut odd = pairs.iter().filter(|(off, _)| *off > JUMP && *off > ABOVE_MEDIAN * median).map(|p| p.1);
    let first = odd.next()?;
    let count = 1 + odd.count();
    let words = format!(
        "{count} of {} pairs of neighbours differ by more than half, where the median is {:.0} %: the field is not smooth \
         there",
        pairs.len(),
        100.0 * median
    );
    Some(Oddity { kind: "discontinuous", words, count, first: Some(first) })
}

fn thin(field: &Field<Tensor2>) -> Option<Oddity> {
    let grid = field.grid();
    let words = format!(
        "the field is {} x {} cells: a gradient needs neighbours on both sides, so at least 3 x 3",
        grid.width(),
        grid.height()
    );
    (grid.width() < 3 || grid.height() < 3).then_some(Oddity {
        kind: "thin",
        words,
        count: grid.cells(),
        first: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    fn kinds(width: usize, tensor: impl Fn(Cell) -> Tensor2) -> Vec<(&'static str, usize)> {
        let field = Field::from_fn(Grid::new(width, 10).expect("a size"), tensor);
        lint(&field).into_iter().map(|o| (o.kind, o.count)).collect()
    }

    fn smooth(c: Cell) -> Tensor2 {
        let (angle, ratio) = (0.05 * c.x as f64, 2.0);
        Tensor2::from_eigen(angle, ratio, 1.0 / ratio)
    }

    #[test]
    fn smooth_positive_fields_of_determinant_one_are_not_odd() {
        assert_eq!(kinds(12, smooth), []);
    }

    #[test]
    fn every_oddity_is_found_and_counted() {
        let with = |odd: Tensor2| kinds(12, move |c| if c == Cell::new(4, 3) { odd } else { smooth(c) });
        let has = |found: &[(&str, usize)], kind: &str| found.contains(&(kind, 1));
        for (odd, kind) in [
            (Tensor2::ZERO, "zero"),
            (Tensor2::isotropic(f64::NAN), "not-finite"),
            (Tensor2::symmetric(1.0, 0.0, 0.0), "total-anisotropy"),
            (Tensor2::symmetric(2.0, 0.0, -0.5), "indefinite"),
            (Tensor2::symmetric(-2.0, 0.0, -0.5), "negative"),
            (Tensor2::symmetric(2.0, 0.0, 0.6), "determinant"),
            (Tensor2::new(2.0, 0.1, 0.0, 0.5), "asymmetric"),
            (Tensor2::IDENTITY, "isotropic"),
        ] {
            let found = with(odd);
            assert!(has(&found, kind), "{kind}: {found:?}");
        }
        assert!(kinds(2, smooth).iter().any(|f| f.0 == "thin"));
    }

    /// A step between two halves is one row of pairs; a sign that flips is none.
    #[test]
    fn jumps_are_between_ellipses() {
        let step = kinds(12, |c| Tensor2::from_eigen(if c.y < 5 { 0.0 } else { 1.5 }, 2.0, 0.5));
        assert_eq!(step, [("discontinuous", 12)]);
        let flipped = kinds(12, |c| {
            Tensor2::from_axes(if c.y < 5 { 0.3 } else { 0.3 + core::f64::consts::PI }, 2.0, 0.5)
        });
        assert!(!flipped.iter().any(|f| f.0 == "discontinuous"), "{flipped:?}");
        // A third is not a half, and strength does not matter.
        let third = kinds(12, |c| Tensor2::isotropic(if c.y < 5 { 1.0 } else { 0.7 }));
        assert!(!third.iter().any(|f| f.0 == "discontinuous"), "{third:?}");
        let strong = kinds(12, |c| Tensor2::isotropic(if c.y < 5 { 1e200 } else { 1e199 }));
        assert!(strong.contains(&("discontinuous", 12)), "{strong:?}");
        let white =
            kinds(12, |c| if (c.x + c.y) % 2 == 0 { Tensor2::IDENTITY } else { Tensor2::isotropic(9.0) });
        assert!(!white.iter().any(|f| f.0 == "discontinuous"), "all are: {white:?}");
    }
}
