//! What may be a mistake in a tensor field, and what is worth knowing, before light runs through it.

use tigereye_core::{Cell, Eigenvalues, Field, Svd, Symmetry, Tensor2, is_totally_anisotropic};
use tigereye_lines::ellipse_tensors;

/// Something that may be a mistake, or that is worth knowing.
#[derive(Clone, Debug, PartialEq)]
pub struct Oddity {
    /// Short name: `not-finite`, `outlier`, `nearly-symmetric`, `thin`, `zero`, `total-anisotropy`, `indefinite`,
    /// `negative`, `discontinuous`, `determinant`, `asymmetric`, `isotropic`.
    pub kind: &'static str,
    /// Whether it is rarely meant so. What fields of some kind always are (a stress field indefinite, a rotation times
    /// axes asymmetric) is a note.
    pub is_likely_mistake: bool,
    /// What it is and what follows, in a sentence.
    pub words: String,
    /// How many cells it concerns; pairs of neighbours for `discontinuous`.
    pub count: usize,
    /// The first of them, row by row.
    pub first: Option<Cell>,
}

/// Neighbours that differ by more than this fraction of the larger one, measured by their largest component, ...
const JUMP: f64 = 0.5;
/// ... are a discontinuity where the median of these differences is smaller by this factor.
const ABOVE_MEDIAN: f64 = 4.0;
/// Deviation of a determinant from 1 that is more than rounding of single precision.
const DETERMINANT: f64 = 1e-6;
/// Semi-axes that differ by less than this fraction count as equal.
const ISOTROPIC: f64 = 1e-6;
/// Cells of a symmetric field that are unlike all others in sign are noise or a wrong order of components up to this
/// share.
const FEW: f64 = 0.05;
/// A field whose components xy and yx differ by less than this fraction of the largest of them was meant to be
/// symmetric.
const NEARLY: f64 = 0.05;

/// Likely mistakes, then notes, the gravest first. A field without any has tensors that are symmetric, positive
/// definite and of determinant 1, and that change smoothly. Signs of eigenvalues are asked of symmetric tensors only.
#[must_use]
pub fn lint(field: &Field<Tensor2>) -> Vec<Oddity> {
    let mut found = oddities(field);
    found.sort_by_key(|oddity| !oddity.is_likely_mistake);
    found
}

fn oddities(field: &Field<Tensor2>) -> Vec<Oddity> {
    let cells = field.grid().cells();
    let of = |kind, test: &dyn Fn(&Tensor2) -> bool, words: &str| {
        let mut odd = field.iter().filter(|(_, t)| test(t)).map(|(cell, _)| cell);
        let first = odd.next()?;
        let count = 1 + odd.count();
        let share = 100.0 * count as f64 / cells as f64;
        Some(Oddity {
            kind,
            is_likely_mistake: false,
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
    let likely = |oddity: Option<Oddity>, is_likely: &dyn Fn(usize) -> bool| {
        oddity.map(|o| Oddity { is_likely_mistake: is_likely(o.count), ..o })
    };
    // Signs of a field that is positive definite elsewhere, or negative definite altogether.
    let signed = field.values().iter().filter(|t| regular(t) && Eigenvalues::of(t).negative() > 0).count();
    let few = (signed as f64) <= FEW * cells as f64 && symmetry.is_symmetric();
    let all = (signed as f64) >= (1.0 - FEW) * cells as f64 && symmetry.is_symmetric();
    let found = [
        likely(of("not-finite", &|t| !t.is_finite(), "are not finite: they cannot transmit light"), &|_| {
            true
        }),
        outliers(field),
        nearly_symmetric(field),
        likely(of("zero", &|t| t.is_zero(), "hold the zero tensor: they absorb all light"), &|n| n == cells),
        of(
            "total-anisotropy",
            &|t| regular(t) && is_totally_anisotropic(t),
            "are totally anisotropic: they transmit along one axis only, and the border of these regions shows in light \
             and gradients (--total-anisotropy)",
        ),
        likely(
            of(
                "indefinite",
                &|t| regular(t) && symmetric(t) && Eigenvalues::of(t).is_indefinite(),
                "have eigenvalues of both signs, of which light uses the magnitudes",
            ),
            &|_| few,
        ),
        likely(
            of(
                "negative",
                &|t| regular(t) && symmetric(t) && negative(t),
                "have negative eigenvalues only, of which light uses the magnitudes",
            ),
            &|n| few || all && n as f64 >= (1.0 - FEW) * cells as f64,
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
            "are not symmetric: light uses the ellipse into which they map a circle, whose axes are not the eigenvectors",
        ),
        of("isotropic", &|t| regular(t) && isotropic(t), "have no direction: light spreads evenly from them"),
        thin(field),
    ];
    found.into_iter().flatten().collect()
}

/// Neighbours to the right and below that differ much, where most hardly do. Axes have no sign, and neither has a
/// tensor that is a rotation times its axes: ellipses are compared, not components.
fn jumps(field: &Field<Tensor2>) -> Option<Oddity> {
    let grid = field.grid();
    let ellipses = ellipse_tensors(field);
    let mut pairs = Vec::new();
    for cell in grid.iter() {
        // Directions 0 and 6: to the right and down.
        for neighbour in [grid.neighbour(cell, 0), grid.neighbour(cell, 6)].into_iter().flatten() {
            pairs.extend(difference(ellipses.at(cell), ellipses.at(neighbour)).map(|off| (off, cell)));
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
    Some(Oddity { kind: "discontinuous", is_likely_mistake: false, words, count, first: Some(first) })
}

/// Part of the larger one by which the ellipses of two cells differ, measured by their largest component; `None` where
/// both are zero or one is not finite.
fn difference(p: &Tensor2, q: &Tensor2) -> Option<f64> {
    let (p, q) = (p.components(), q.components());
    let largest = p.iter().chain(&q).fold(0.0, |m: f64, v| m.max(v.abs()));
    let off = p.iter().zip(&q).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    (largest > 0.0 && largest.is_finite()).then(|| off / largest)
}

/// Cells that differ much from all eight around them, which hardly differ from each other. In the middle of a vortex or
/// a star they do.
fn outliers(field: &Field<Tensor2>) -> Option<Oddity> {
    let grid = field.grid();
    let ellipses = ellipse_tensors(field);
    let is_outlier = |cell: &Cell| {
        let around: Vec<&Tensor2> =
            (0..8).filter_map(|k| grid.neighbour(*cell, k)).map(|c| ellipses.at(c)).collect();
        let differs = |a: &Tensor2, b: &Tensor2| difference(a, b).unwrap_or(0.0);
        around.len() == 8
            && around.iter().all(|other| differs(ellipses.at(*cell), other) > JUMP)
            && around.iter().all(|a| around.iter().all(|b| differs(a, b) < JUMP / ABOVE_MEDIAN))
    };
    let mut odd = grid.iter().filter(is_outlier);
    let first = odd.next()?;
    let count = 1 + odd.count();
    let words = format!(
        "{count} single cells differ by more than half from all their neighbours, which agree with each other"
    );
    Some(Oddity { kind: "outlier", is_likely_mistake: true, words, count, first: Some(first) })
}

/// A field whose components xy and yx differ by little, but by more than rounding.
fn nearly_symmetric(field: &Field<Tensor2>) -> Option<Oddity> {
    if Symmetry::of(field).is_symmetric() {
        return None;
    }
    let largest = field.values().iter().fold(0.0, |m: f64, t| m.max(t.xy().abs()).max(t.yx().abs()));
    let off = field.values().iter().fold(0.0, |m: f64, t| m.max((t.xy() - t.yx()).abs()));
    if !(largest.is_finite() && off < NEARLY * largest) {
        return None;
    }
    let odd: Vec<Cell> = field.iter().filter(|(_, t)| t.xy() != t.yx()).map(|(cell, _)| cell).collect();
    let words = format!(
        "the components xy and yx differ by up to {:.1} % of the largest of them, so lines follow semi-axes, not \
         eigenvectors: expected equal ones, or a field that is not meant to be symmetric",
        100.0 * off / largest
    );
    let (count, first) = (odd.len(), odd.first().copied());
    Some(Oddity { kind: "nearly-symmetric", is_likely_mistake: true, words, count, first })
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
        is_likely_mistake: true,
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
            (Tensor2::isotropic(40.0), "outlier"),
        ] {
            let found = with(odd);
            assert!(has(&found, kind), "{kind}: {found:?}");
        }
        assert!(kinds(2, smooth).iter().any(|f| f.0 == "thin"));
    }

    fn mistakes(tensor: impl Fn(Cell) -> Tensor2) -> Vec<&'static str> {
        let field = Field::from_fn(Grid::new(12, 10).expect("a size"), tensor);
        lint(&field).into_iter().filter(|o| o.is_likely_mistake).map(|o| o.kind).collect()
    }

    /// Kinds of fields are no mistakes: stresses, rotations times axes, holes, thin tensors.
    #[test]
    fn what_is_rarely_meant_comes_first_and_apart() {
        let at = |odd: Tensor2| mistakes(move |c| if c == Cell::new(4, 3) { odd } else { smooth(c) });
        assert_eq!(at(Tensor2::ZERO), ["outlier"]);
        assert_eq!(at(Tensor2::isotropic(f64::NAN)), ["not-finite"]);
        assert_eq!(at(Tensor2::symmetric(2.0, 0.0, -0.5)), ["indefinite"]);
        assert_eq!(mistakes(|c| if c.x < 4 { Tensor2::ZERO } else { smooth(c) }), Vec::<&str>::new());
        assert_eq!(mistakes(|c| Tensor2::from_eigen(0.05 * c.x as f64, 2.0, -0.5)), Vec::<&str>::new());
        assert_eq!(mistakes(|c| Tensor2::from_axes(0.05 * c.x as f64, 2.0, 0.5)), Vec::<&str>::new());
        assert_eq!(mistakes(|c| Tensor2::from_eigen(0.05 * c.x as f64, -2.0, -0.5)), ["negative"]);
        assert_eq!(mistakes(|_| Tensor2::ZERO), ["zero"]);
        let tilted = |c| smooth(c) + Tensor2::new(0.0, 0.01, -0.01, 0.0);
        assert_eq!(mistakes(tilted), ["nearly-symmetric"]);
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
